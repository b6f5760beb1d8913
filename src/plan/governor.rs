//! The governor: which parts to leave out so that the weather keeps its time, and its tolerance if it can.
//!
//! A picture's time is taken as proportional to its work, by a factor that reported times correct: the median of the last
//! five. What a part costs beside a plain pixel differs from machine to machine; whenever a part comes or goes, the step
//! in the reported times corrects its share, so that a part which is dearer here than it was where the constants were
//! measured does not come back into a picture that has no time for it.
//!
//! Under a budget the set of parts with the least perceived loss that fits is left out: loss is what a part is worth in
//! this picture times how much its effect matters to those who look. More is drawn again only when it would leave room to
//! spare, so that a load at the border does not swing.

use super::parts::{Estimate, PARTS};

/// How much parts matter to viewers, in the order of [`Part::ALL`](super::Part::ALL): air between things and fog as the
/// atmosphere on objects, 0.9, the sky 0.2, rain 0.7 (importance weights of the experiment in the machinery trainer's thesis).
pub const IMPORTANCE: [f64; PARTS] = [0.9, 0.9, 0.2, 0.7, 0.7];

/// Sets of parts.
pub(super) const SETS: usize = 1 << PARTS;

/// More is drawn again where it would take no more than this share of the budget.
const ROOM: f64 = 0.85;

/// What had to give way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GaveWay {
    /// Nothing: what was asked holds, by the estimates.
    #[default]
    Nothing,
    /// The tolerance: the time allows no better picture.
    Tolerance,
    /// Time, and the tolerance: even with every part left out, or with the parts that are pinned, the picture takes longer
    /// than the budget.
    Time,
}

/// Work of a picture, in pixels with none of the parts: those pixels, what each part adds that is drawn, and the air before
/// the fog, where both are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Amount {
    pub pixels: f64,
    pub parts: [f64; PARTS],
    pub before_fog: f64,
}

impl Amount {
    /// Without the parts of `set` (bit i is `Part::ALL[i]`).
    pub fn without(mut self, set: usize) -> Self {
        (0..PARTS).filter(|i| set & (1 << i) != 0).for_each(|i| self.parts[i] = 0.0);
        if set & 0b011 != 0 {
            self.before_fog = 0.0;
        }
        self
    }

    /// All of it, by the constants.
    pub fn total(&self) -> f64 {
        self.weighed(&[1.0; PARTS])
    }

    fn weighed(&self, ratios: &[f64; PARTS]) -> f64 {
        self.pixels + ratios[0] * self.before_fog + (0..PARTS).map(|i| ratios[i] * self.parts[i]).sum::<f64>()
    }
}

/// A set of parts that might be left out.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Choice {
    /// Whether all of its parts are there to be left out.
    pub possible: bool,
    /// Error of the picture without them.
    pub error: Estimate,
    /// The same weighed by importance.
    pub loss: f64,
    /// Work of the picture without them.
    pub amount: Amount,
}

/// A host's timer may answer so many frames late: that many reports after a part came or went say nothing yet.
const LATE: u32 = 4;
/// Reports that are remembered.
const SEEN: usize = 5;
/// No part costs more, or less than its inverse, of what the constants say.
const MOST_RATIO: f64 = 8.0;
/// A step of the times that is this share of the picture's is half believed: smaller ones drown in noise.
const HALF_BELIEVED: f64 = 0.1;

/// Times as reported, and what they say of this machine.
#[derive(Clone, Copy, Debug)]
pub(super) struct Governor {
    /// Milliseconds of a unit of work.
    recent: [f64; SEEN],
    reports: usize,
    /// What the parts cost here over what the constants say.
    ratios: [f64; PARTS],
    /// The set that was absent at the last report, and how many reports it has been.
    absent: usize,
    since: u32,
    /// Before parts came or went: the set then absent, and what a unit of work took.
    before: Option<(usize, f64)>,
}

impl Default for Governor {
    fn default() -> Self {
        Self { recent: [0.0; SEEN], reports: 0, ratios: [1.0; PARTS], absent: 0, since: 0, before: None }
    }
}

impl Governor {
    /// A frame took so long; everything in it would be `all`, and the parts of `absent` were left out.
    pub fn report(&mut self, ms: f64, all: &Amount, absent: usize) {
        if absent != self.absent {
            let from = self.before.map_or(self.absent, |b| b.0);
            self.before = self.ms_per_work().filter(|_| from != absent).map(|k| (from, k));
            (self.absent, self.since) = (absent, 0);
        }
        self.since += 1;
        if self.before.is_some() && self.since <= LATE {
            return;
        }
        let work = all.without(absent).weighed(&self.ratios);
        if work > 0.0 {
            self.recent[self.reports % SEEN] = ms / work;
            self.reports += 1;
        }
        if self.since >= LATE + SEEN as u32
            && let Some((from, k)) = self.before.take()
        {
            self.learn(all, (from, k), (absent, self.median()));
        }
    }

    /// Parts came or went between two sets with these times a unit of work: were it not for them the times would be one.
    fn learn(&mut self, all: &Amount, (from, k_from): (usize, f64), (to, k_to): (usize, f64)) {
        let time = |set: usize, k: f64| k * all.without(set).weighed(&self.ratios);
        // With the parts and without; where some come while others go, neither is told apart.
        let (more, less, parts) = match (from & !to, to & !from) {
            (0, gone) => (time(from, k_from), time(to, k_to), gone),
            (come, 0) => (time(to, k_to), time(from, k_from), come),
            _ => return,
        };
        let rest = all.without(from | to).weighed(&self.ratios);
        let theirs = all.without(from & to).weighed(&self.ratios) - rest;
        if !(theirs > 0.0 && rest > 0.0 && less > 0.0) {
            return;
        }
        let found = (rest * (more / less - 1.0) / theirs).clamp(0.5, 2.0);
        let factor = 1.0 + (found - 1.0) * theirs / (theirs + HALF_BELIEVED * rest);
        let before = all.without(to).weighed(&self.ratios);
        for i in (0..PARTS).filter(|i| parts & (1 << i) != 0 && all.parts[*i] > 0.0) {
            self.ratios[i] = (self.ratios[i] * factor).clamp(1.0 / MOST_RATIO, MOST_RATIO);
        }
        let after = all.without(to).weighed(&self.ratios);
        self.recent.iter_mut().for_each(|k| *k *= before / after);
    }

    /// Milliseconds of a unit of work, as before parts came or went while that still settles; `None` before a report.
    fn ms_per_work(&self) -> Option<f64> {
        match self.before {
            Some((_, k)) => Some(k),
            None => (self.reports > 0).then(|| self.median()),
        }
    }

    /// Of the last reports, so that a slow frame or two change nothing; of an even number the lower one.
    fn median(&self) -> f64 {
        let mut sorted = self.recent;
        let seen = &mut sorted[..self.reports.clamp(1, SEEN)];
        seen.sort_by(f64::total_cmp);
        seen[(seen.len() - 1) / 2]
    }

    /// What a picture of so much work should take, ms; `None` before the first report.
    pub fn ms(&self, amount: &Amount) -> Option<f64> {
        self.ms_per_work().map(|k| k * amount.weighed(&self.ratios))
    }

    /// What of a budget a choice does not keep.
    pub fn judge(&self, choice: &Choice, tolerance: Option<f64>, budget_ms: Option<f64>) -> GaveWay {
        match (budget_ms, self.ms(&choice.amount)) {
            (Some(budget), Some(ms)) if ms > budget => GaveWay::Time,
            _ if tolerance.is_some_and(|t| !choice.error.keeps(t)) => GaveWay::Tolerance,
            _ => GaveWay::Nothing,
        }
    }

    /// The set to leave out, as an index into `choices`; `before` is the one left out now.
    pub fn choose(
        &self,
        choices: &[Choice; SETS],
        tolerance: Option<f64>,
        budget_ms: Option<f64>,
        before: usize,
    ) -> (usize, GaveWay) {
        let work = |c: &Choice| c.amount.weighed(&self.ratios);
        let fits = |c: &Choice| match (budget_ms, self.ms(&c.amount)) {
            (Some(budget), Some(ms)) => {
                let more = work(c) > work(&choices[before]);
                ms <= if more { ROOM * budget } else { budget }
            }
            _ => true,
        };
        let keeps = |i: usize, c: &Choice| match tolerance {
            Some(t) => c.error.keeps(if i == before { t } else { super::parts::CERTAINTY * t }),
            None => i == 0,
        };
        let of = |wanted: &dyn Fn(usize, &Choice) -> bool, key: &dyn Fn(&Choice) -> f64| {
            let all = choices.iter().enumerate().filter(|(i, c)| c.possible && wanted(*i, c));
            all.min_by(|a, b| key(a.1).total_cmp(&key(b.1))).map(|(i, _)| i)
        };
        if let Some(i) = of(&|i, c| fits(c) && keeps(i, c), &work) {
            return (i, GaveWay::Nothing);
        }
        if let Some(i) = of(&|_, c| fits(c), &|c| c.loss) {
            return (i, GaveWay::Tolerance);
        }
        (of(&|_, _| true, &work).unwrap_or(0), GaveWay::Time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With no rain.
    fn five(v: [f64; 3]) -> [f64; PARTS] {
        [v[0], v[1], v[2], 0.0, 0.0]
    }

    /// Air, fog and sky worth so much, on a picture of work 1 + their work.
    fn choices(worth: [f64; 3], parts: [f64; 3]) -> [Choice; SETS] {
        let parts = five(parts);
        std::array::from_fn(|set| {
            let left = |i: &usize| set & (1 << i) != 0;
            let sum = |v: [f64; 3]| (0..3).filter(left).map(|i| v[i]).sum::<f64>();
            let p95 = sum(worth);
            Choice {
                possible: set < 8,
                error: Estimate { p95, bound: p95, worst: p95 },
                loss: (0..3).filter(left).map(|i| IMPORTANCE[i] * worth[i]).sum(),
                amount: Amount { pixels: 1.0, parts, before_fog: 0.0 }.without(set),
            }
        })
    }

    #[test]
    fn a_load_that_doubles_and_halves_is_settled_soon_and_once() {
        let choices = choices([0.05, 0.3, 0.02], [0.4, 0.5, 0.2]);
        let mut governor = Governor::default();
        let (mut set, mut switches) = (0, Vec::new());
        // A fake clock: 4 ms a unit of work, twice that from frame 30 to 89, with noise of 2 %.
        for frame in 0..150 {
            let load = if (30..90).contains(&frame) { 8.0 } else { 4.0 };
            let noise = 1.0 + 0.02 * (f64::from(frame) * 1.7).sin();
            governor.report(load * noise * choices[set].amount.total(), &choices[0].amount, set);
            let (now, gave_way) = governor.choose(&choices, None, Some(10.0), set);
            if now != set {
                switches.push(frame);
                set = now;
            }
            assert_eq!(gave_way == GaveWay::Nothing, set == 0, "{frame}");
        }
        // Down and up again in two or three steps each, as the median follows, and never back and forth.
        assert!((2..=5).contains(&switches.len()), "{switches:?}");
        assert!(switches.iter().all(|f| (30..40).contains(f) || (90..100).contains(f)), "{switches:?}");
    }

    #[test]
    fn a_load_at_the_border_does_not_swing() {
        let choices = choices([0.05, 0.3, 0.02], [0.4, 0.5, 0.2]);
        let mut governor = Governor::default();
        let (mut set, mut switches) = (0, 0);
        for frame in 0..400 {
            let load = 4.76 * (1.0 + 0.03 * (f64::from(frame) * 0.37).sin());
            governor.report(load * choices[set].amount.total(), &choices[0].amount, set);
            let now = governor.choose(&choices, None, Some(10.0), set).0;
            switches += u32::from(now != set);
            set = now;
        }
        assert!(switches <= 1, "{switches}");
    }

    #[test]
    fn least_loss_for_the_time_goes_first_and_what_gave_way_is_said() {
        let choices = choices([0.05, 0.3, 0.02], [0.4, 0.5, 0.2]);
        let mut governor = Governor::default();
        governor.report(21.0, &choices[0].amount, 0);
        // Everything 21 ms; without sky 19, air 17, both 15, fog 16, everything left out 10.
        let at = |ms, tolerance| governor.choose(&choices, tolerance, Some(ms), 0);
        assert_eq!(at(25.0, None), (0b000, GaveWay::Nothing));
        assert_eq!(at(19.5, None), (0b100, GaveWay::Tolerance));
        assert_eq!(at(15.5, None), (0b101, GaveWay::Tolerance));
        assert_eq!(at(9.0, None), (0b111, GaveWay::Time));
        assert_eq!(at(19.5, Some(0.03)), (0b100, GaveWay::Nothing));
        assert_eq!(at(15.5, Some(0.03)), (0b101, GaveWay::Tolerance));
        assert_eq!(governor.choose(&choices, Some(0.1), None, 0), (0b101, GaveWay::Nothing), "no more than is asked");
    }

    #[test]
    fn a_slow_frame_or_two_change_nothing() {
        let choices = choices([0.05, 0.3, 0.02], [0.4, 0.5, 0.2]);
        let mut governor = Governor::default();
        for ms in [4.0, 4.0, 4.0, 40.0, 4.0, 4.0, 4.0, 4.0, 40.0, 40.0, 4.0, 4.0] {
            governor.report(ms * choices[0].amount.total(), &choices[0].amount, 0);
            assert_eq!(governor.choose(&choices, None, Some(10.0), 0).0, 0);
        }
    }

    #[test]
    fn a_part_that_is_not_there_learns_nothing_from_another_that_comes_with_it() {
        let clear = Amount { pixels: 1.0, parts: five([0.4, 0.0, 0.05]), before_fog: 0.0 };
        let mut governor = Governor::default();
        (0..20).for_each(|_| governor.report(clear.without(0b011).total(), &clear, 0b011));
        (0..20).for_each(|_| governor.report(1.5 * clear.total(), &clear, 0));
        assert!(governor.ratios[0] > 1.1 && governor.ratios[1] == 1.0, "{:?}", governor.ratios);
    }

    /// Uniform in [0, 1): SplitMix64.
    fn chance(state: &mut u64) -> f64 {
        *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = *state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A machine whose parts cost other shares of a pixel than the constants say, with a timer that answers late.
    struct Machine {
        ms: f64,
        ratios: [f64; PARTS],
        late: usize,
        noise: f64,
        drawn: Vec<usize>,
    }

    impl Machine {
        fn frame(&mut self, all: &Amount, absent: usize, random: &mut u64) -> Option<f64> {
            self.drawn.push(absent);
            let frame = self.drawn.len().checked_sub(1 + self.late)?;
            let noise = 1.0 + self.noise * (2.0 * chance(random) - 1.0);
            Some(self.ms * noise * all.without(self.drawn[frame]).weighed(&self.ratios))
        }
    }

    #[test]
    fn a_part_that_is_dearer_here_than_where_it_was_measured_does_not_swing() {
        // Everything 19.9 ms of 19: by the constants air would leave enough room to come back.
        let choices = choices([0.05, 0.3, 0.02], [0.41, 0.17, 0.0]);
        let mut machine =
            Machine { ms: 10.0, ratios: [2.0, 1.0, 1.0, 1.0, 1.0], late: 2, noise: 0.02, drawn: Vec::new() };
        let (mut governor, mut random, mut set, mut switches) = (Governor::default(), 7, 0, Vec::new());
        for frame in 0..300 {
            if let Some(ms) = machine.frame(&choices[0].amount, set, &mut random) {
                governor.report(ms, &choices[0].amount, set);
            }
            let now = governor.choose(&choices, None, Some(19.0), set).0;
            if now != set {
                switches.push((frame, now));
                set = now;
            }
        }
        assert!(switches.len() == 1 && switches[0].1 == 1, "{switches:?}");
    }

    #[test]
    fn times_are_predicted_within_a_quarter_on_machines_unlike_the_one_that_was_measured() {
        let (mut settled, mut stepped) = (Vec::new(), Vec::new());
        for seed in 0..64 {
            let mut random = seed;
            let mut between = |low: f64, high: f64| low + (high - low) * chance(&mut random);
            let ratios = [0; PARTS].map(|_| between(0.5, 2.0));
            let (ms, late) = (between(0.2, 30.0), between(0.0, 4.99) as usize);
            let mut machine = Machine { ms, ratios, late, noise: 0.05, drawn: Vec::new() };
            let mut governor = Governor::default();
            // Every part comes and goes in a hundred frames each, under scenes with more or less of it.
            for step in 0..12 {
                let objects = between(0.3, 0.9);
                let parts = five([0.4 * objects, 0.27, 0.07 * (1.0 - objects)]);
                let all = Amount { pixels: 1.0, parts, before_fog: 0.4 };
                let absent = [0, 1, 0, 2, 0, 5, 0, 3, 7, 0, 1, 3][step];
                for frame in 0..24 {
                    let truth = ms * all.without(absent).weighed(&ratios);
                    if let Some(said) = governor.ms(&all.without(absent)) {
                        let error = (said / truth - 1.0).abs();
                        if frame >= 12 {
                            settled.push(error)
                        } else if step > 3 && frame == 0 {
                            stepped.push(error)
                        }
                    }
                    if let Some(ms) = machine.frame(&all, absent, &mut random_of(seed, step, frame)) {
                        governor.report(ms, &all, absent);
                    }
                }
            }
        }
        let beyond = |errors: &[f64]| errors.iter().filter(|e| **e > 0.25).count() as f64 / errors.len() as f64;
        assert!(settled.len() > 7000 && settled.iter().all(|e| *e <= 0.06), "{}", beyond(&settled));
        assert!(beyond(&stepped) == 0.0, "{} of {}", beyond(&stepped), stepped.len());
    }

    fn random_of(seed: u64, step: usize, frame: usize) -> u64 {
        seed * 1_000_003 + step as u64 * 1009 + frame as u64
    }
}
