//! The governor: predicts the time of a picture on this machine from the times that the host reports.
//!
//! The time of a picture is modelled as its work times a factor, the median of the last five reported times per unit of
//! work. The rooms' constants (`StepWork`) give the work of each part relative to a plain pixel, but the true ratio
//! differs from machine to machine. Whenever parts appear while none disappears, or the reverse, the change in the
//! reported times corrects the cost of these parts. A part that is dearer on this machine than the constants say
//! therefore does not return into a picture that has no time for it.
//!
//! A part returns only if the picture with it is predicted to take at most [`ROOM`] of the budget. The part therefore
//! does not come and go in every frame of a picture whose time is close to the budget.

use super::parts::{MOST_STEPS, Set};

/// Largest share of the budget that the predicted time may take for a picture with more work than the present one.
const ROOM: f64 = 0.85;

/// Limit of the budget that could not be kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GaveWay {
    /// None: by the estimates the picture keeps all limits.
    #[default]
    Nothing,
    /// The tolerance: the time or the pinned parts allow no better picture. If the budget has no tolerance, parts are
    /// left out to keep the time.
    Tolerance,
    /// The time, and perhaps the tolerance too: the picture takes longer than the budget even if every part that the
    /// host did not pin is at its last rung.
    Time,
}

/// Work of a picture: the sum of the pixels themselves, the work that each step saves, and the extra work of two parts
/// drawn together. The unit is the work of one pixel in which no part is drawn. A step leads from one rung of a part
/// down to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct WorkAmount {
    /// Number of pixels.
    pub pixels: f64,
    /// Work that taking each step saves; 0 for a step that has been taken.
    pub steps: [f64; MOST_STEPS],
    /// Extra work of two parts while both are drawn in full: the index of each part's first step in `steps`, and the
    /// work. On this machine it is multiplied by the cost ratio of the first of these two steps.
    pub together: ([usize; 2], f64),
}

impl WorkAmount {
    /// Returns the amount that is left once the steps of `set` are taken.
    pub fn without(mut self, set: Set) -> Self {
        (0..MOST_STEPS).filter(|i| set & (1 << i) != 0).for_each(|i| self.steps[i] = 0.0);
        if self.together.0.iter().any(|i| set & (1 << i) != 0) {
            self.together.1 = 0.0;
        }
        self
    }

    /// Returns the whole work with the rooms' constants alone: every cost ratio is 1.
    pub fn total(&self) -> f64 {
        self.weighed(&[1.0; MOST_STEPS])
    }

    /// Returns the whole work, with that of each step multiplied by its ratio.
    fn weighed(&self, ratios: &[f64; MOST_STEPS]) -> f64 {
        let steps = self.steps.iter().zip(ratios).map(|(w, r)| w * r).sum::<f64>();
        self.pixels + ratios[self.together.0[0]] * self.together.1 + steps
    }
}

/// Number of reports that are ignored after a part came or went, since a host's timer may answer this many frames late.
const LATE: u32 = 4;
/// Number of reports that are kept.
const SEEN: usize = 5;
/// Largest ratio of a part's cost on this machine to the cost that the constants give; its inverse is the smallest
/// ratio.
const MOST_RATIO: f64 = 8.0;
/// Constant h in the weight x / (x + h) of a correction, where x = work of the changed parts / work of the rest of the
/// picture. The weight is 0.5 at x = h, and less for smaller parts, whose times drown in noise.
const HALF_BELIEVED: f64 = 0.1;

/// Reported times, and the costs on this machine that follow from them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Governor {
    /// Recent times for a unit of work, ms.
    recent: [f64; SEEN],
    /// Number of frame times recorded so far.
    reports: usize,
    /// Ratios of the work that steps save on this machine to the work that the constants give.
    ratios: [f64; MOST_STEPS],
    /// Steps that were taken at the last report.
    absent: Set,
    /// Number of reports since `absent` changed.
    since: u32,
    /// Steps taken before the last change of parts, and the time for a unit of work then. `None` once that change has
    /// settled.
    before: Option<(Set, f64)>,
}

impl Default for Governor {
    fn default() -> Self {
        Self { recent: [0.0; SEEN], reports: 0, ratios: [1.0; MOST_STEPS], absent: 0, since: 0, before: None }
    }
}

impl Governor {
    /// Records the time of a frame, ms. `all` is its work with all parts drawn in full; `absent` is the set of steps
    /// that were taken in it.
    pub fn report(&mut self, ms: f64, all: &WorkAmount, absent: Set) {
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

    /// Corrects the costs of the parts by which the sets `from` and `to` differ. `k_from` and `k_to` are the times for
    /// a unit of work with each set, ms; with correct costs they would be equal.
    ///
    /// Let p be the work of these parts, r that of the rest, and t_with and t_without the times of the picture with and
    /// without them. If the true work is c p, then t_with / t_without = (r + c p) / r. This gives
    /// c = r (t_with / t_without - 1) / p, clamped to \[0.5, 2\]. The ratios of the parts are multiplied by
    /// 1 + (c - 1) p / (p + [`HALF_BELIEVED`] r).
    fn learn(&mut self, all: &WorkAmount, (from, k_from): (Set, f64), (to, k_to): (Set, f64)) {
        let time = |set: Set, k: f64| k * all.without(set).weighed(&self.ratios);
        // Times with the parts and without them. If some parts come while others go, their costs cannot be told apart.
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
        for i in (0..MOST_STEPS).filter(|i| parts & (1 << i) != 0 && all.steps[*i] > 0.0) {
            self.ratios[i] = (self.ratios[i] * factor).clamp(1.0 / MOST_RATIO, MOST_RATIO);
        }
        let after = all.without(to).weighed(&self.ratios);
        self.recent.iter_mut().for_each(|k| *k *= before / after);
    }

    /// Returns the time for a unit of work, ms. Until a change of parts has settled, it is the time before the change.
    /// `None` before the first report.
    fn ms_per_work(&self) -> Option<f64> {
        match self.before {
            Some((_, k)) => Some(k),
            None => (self.reports > 0).then(|| self.median()),
        }
    }

    /// Returns the median of the last reports, so that a slow frame or two have no effect. For an even number of
    /// reports it is the lower of the two in the middle.
    fn median(&self) -> f64 {
        let mut sorted = self.recent;
        let seen = &mut sorted[..self.reports.clamp(1, SEEN)];
        seen.sort_by(f64::total_cmp);
        seen[(seen.len() - 1) / 2]
    }

    /// Returns the predicted time of a picture of this work, ms; `None` before the first report.
    pub fn ms(&self, amount: &WorkAmount) -> Option<f64> {
        self.ms_per_work().map(|k| k * amount.weighed(&self.ratios))
    }

    /// Returns the work of a picture by the costs on this machine.
    pub fn work(&self, amount: &WorkAmount) -> f64 {
        amount.weighed(&self.ratios)
    }

    /// Whether the predicted time of a picture is within a budget of time. A picture with more work than the present
    /// one must be within the share [`ROOM`] of the budget, so that the choice does not change back and forth.
    pub fn fits(&self, amount: &WorkAmount, budget_ms: Option<f64>, now: &WorkAmount) -> bool {
        match (budget_ms, self.ms(amount)) {
            (Some(budget), Some(ms)) => {
                let more = self.work(amount) > self.work(now);
                ms <= if more { ROOM * budget } else { budget }
            }
            _ => true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{
        choice::{Choices, PlanDemands},
        parts::{Part, Worth},
    };
    use super::*;
    use crate::chance::RandomStream;

    const fn part(importance: f64) -> Part {
        Part { name: "part", rungs: &["all", "none"], importance, worth: Worth::Composed(0) }
    }

    /// List of three parts: air, fog and sky.
    const PARTS: [Part; 3] = [part(0.9), part(0.9), part(0.2)];

    fn steps(v: [f64; 3]) -> [f64; MOST_STEPS] {
        std::array::from_fn(|i| v.get(i).copied().unwrap_or(0.0))
    }

    /// A picture of one pixel.
    struct Picture {
        choices: Choices,
        worth: [f64; 3],
        all: WorkAmount,
    }

    impl Picture {
        /// Creates a picture of work 1 plus that of its `parts`; `worth` is the error without each of them.
        fn new(worth: [f64; 3], parts: [f64; 3]) -> Self {
            let all = WorkAmount { pixels: 1.0, steps: steps(parts), ..WorkAmount::default() };
            Self { choices: Choices::new(&PARTS), worth, all }
        }

        fn choose(&mut self, governor: &Governor, tolerance: Option<f64>, ms: f64, previous: Set) -> (Set, GaveWay) {
            self.choices.estimator.clear();
            self.choices.estimator.see(steps(self.worth).map(|v| v as f32));
            let mut demands = PlanDemands { tolerance, milliseconds: Some(ms), ..PlanDemands::default() };
            demands.importance[..3].copy_from_slice(&PARTS.map(|p| p.importance));
            self.choices.take(self.all, 0b111, governor, &demands, previous);
            self.choices.choose(governor, &demands, previous)
        }
    }

    #[test]
    fn a_load_that_doubles_and_halves_is_settled_soon_and_once() {
        let mut picture = Picture::new([0.05, 0.3, 0.02], [0.4, 0.5, 0.2]);
        let mut governor = Governor::default();
        let (mut set, mut switches) = (0, Vec::new());
        // A fake clock: 4 ms a unit of work, twice that from frame 30 to 89, with noise of 2 %.
        for frame in 0..150 {
            let load = if (30..90).contains(&frame) { 8.0 } else { 4.0 };
            let noise = 1.0 + 0.02 * (f64::from(frame) * 1.7).sin();
            governor.report(load * noise * picture.all.without(set).total(), &picture.all, set);
            let (now, gave_way) = picture.choose(&governor, None, 10.0, set);
            if now != set {
                switches.push(frame);
                set = now;
            }
            assert_eq!(gave_way == GaveWay::Nothing, set == 0, "{frame}");
        }
        // The set changes at most five times: parts go as the median follows, and come back, without oscillation.
        assert!((2..=5).contains(&switches.len()), "{switches:?}");
        assert!(switches.iter().all(|f| (30..40).contains(f) || (90..100).contains(f)), "{switches:?}");
    }

    #[test]
    fn a_load_at_the_border_does_not_swing() {
        let mut picture = Picture::new([0.05, 0.3, 0.02], [0.4, 0.5, 0.2]);
        let mut governor = Governor::default();
        let (mut set, mut switches) = (0, 0);
        for frame in 0..400 {
            let load = 4.76 * (1.0 + 0.03 * (f64::from(frame) * 0.37).sin());
            governor.report(load * picture.all.without(set).total(), &picture.all, set);
            let now = picture.choose(&governor, None, 10.0, set).0;
            switches += u32::from(now != set);
            set = now;
        }
        assert!(switches <= 1, "{switches}");
    }

    #[test]
    fn parts_of_least_loss_for_their_time_go_first_and_the_limit_that_gave_way_is_reported() {
        let mut picture = Picture::new([0.05, 0.3, 0.02], [0.4, 0.5, 0.2]);
        let mut governor = Governor::default();
        governor.report(21.0, &picture.all, 0);
        // Times: everything 21 ms; without sky 19, without air 17, without both 15, without fog 16, without all 10.
        let mut at = |ms, tolerance| picture.choose(&governor, tolerance, ms, 0);
        assert_eq!(at(25.0, None), (0b000, GaveWay::Nothing));
        assert_eq!(at(19.5, None), (0b100, GaveWay::Tolerance));
        assert_eq!(at(15.5, None), (0b101, GaveWay::Tolerance));
        assert_eq!(at(9.0, None), (0b111, GaveWay::Time));
        assert_eq!(at(19.5, Some(0.03)), (0b100, GaveWay::Nothing));
        assert_eq!(at(15.5, Some(0.03)), (0b101, GaveWay::Tolerance));
        assert_eq!(at(1000.0, Some(0.1)), (0b101, GaveWay::Nothing), "no more than is asked");
    }

    #[test]
    fn a_slow_frame_or_two_change_nothing() {
        let mut picture = Picture::new([0.05, 0.3, 0.02], [0.4, 0.5, 0.2]);
        let mut governor = Governor::default();
        for ms in [4.0, 4.0, 4.0, 40.0, 4.0, 4.0, 4.0, 4.0, 40.0, 40.0, 4.0, 4.0] {
            governor.report(ms * picture.all.total(), &picture.all, 0);
            assert_eq!(picture.choose(&governor, None, 10.0, 0).0, 0);
        }
    }

    #[test]
    fn the_ratio_of_an_absent_part_does_not_change() {
        let clear = WorkAmount { pixels: 1.0, steps: steps([0.4, 0.0, 0.05]), ..WorkAmount::default() };
        let mut governor = Governor::default();
        (0..20).for_each(|_| governor.report(clear.without(0b011).total(), &clear, 0b011));
        (0..20).for_each(|_| governor.report(1.5 * clear.total(), &clear, 0));
        assert!(governor.ratios[0] > 1.1 && governor.ratios[1] == 1.0, "{:?}", governor.ratios);
    }

    /// A machine whose parts cost other shares of a pixel than the constants say, and whose timer answers late.
    struct Machine {
        ms: f64,
        ratios: [f64; MOST_STEPS],
        late: usize,
        noise: f64,
        drawn: Vec<Set>,
    }

    impl Machine {
        fn frame(&mut self, all: &WorkAmount, absent: Set, random: &mut RandomStream) -> Option<f64> {
            self.drawn.push(absent);
            let frame = self.drawn.len().checked_sub(1 + self.late)?;
            let noise = 1.0 + self.noise * (2.0 * random.unit() - 1.0);
            Some(self.ms * noise * all.without(self.drawn[frame]).weighed(&self.ratios))
        }
    }

    #[test]
    fn a_part_that_is_dearer_here_than_where_it_was_measured_does_not_swing() {
        // Everything takes 19.9 ms of a budget of 19. By the constants there would be enough room for air to return.
        let mut picture = Picture::new([0.05, 0.3, 0.02], [0.41, 0.17, 0.0]);
        let mut machine = Machine { ms: 10.0, ratios: steps([2.0, 1.0, 1.0]), late: 2, noise: 0.02, drawn: Vec::new() };
        let (mut governor, mut random, mut set, mut switches) =
            (Governor::default(), RandomStream::seeded(7), 0, Vec::new());
        for frame in 0..300 {
            if let Some(ms) = machine.frame(&picture.all, set, &mut random) {
                governor.report(ms, &picture.all, set);
            }
            let now = picture.choose(&governor, None, 19.0, set).0;
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
            let mut random = RandomStream::seeded(seed);
            let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
            let ratios = steps([0; 3].map(|_| between(0.5, 2.0)));
            let (ms, late) = (between(0.2, 30.0), between(0.0, 4.99) as usize);
            let mut machine = Machine { ms, ratios, late, noise: 0.05, drawn: Vec::new() };
            let mut governor = Governor::default();
            // Every part comes and goes, with 24 frames for each set, in scenes with different shares of objects.
            for step in 0..12 {
                let objects = between(0.3, 0.9);
                let steps = steps([0.4 * objects, 0.27, 0.07 * (1.0 - objects)]);
                let all = WorkAmount { pixels: 1.0, steps, together: ([0, 1], 0.4) };
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

    fn random_of(seed: u64, step: usize, frame: usize) -> RandomStream {
        RandomStream::seeded(seed * 1_000_003 + step as u64 * 1009 + frame as u64)
    }
}
