//! The governor: which parts to leave out so that the weather keeps its time, and its tolerance if it can.
//!
//! A picture's time is taken as proportional to its work, by a factor that reported times correct. Under a budget the set
//! of parts with the least perceived loss that fits is left out: loss is what a part is worth in this picture times how
//! much its effect matters to those who look. More is drawn again only when it would leave room to spare, so that a load
//! at the border does not swing.

use super::parts::Estimate;

/// How much parts matter to viewers, in the order of [`Part::ALL`](super::Part::ALL): air between things and fog as the
/// atmosphere on objects, 0.9, the sky 0.2 (importance weights of the experiment in the machinery trainer's thesis).
pub const IMPORTANCE: [f64; 3] = [0.9, 0.9, 0.2];

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
    /// Time, and the tolerance: even with every part left out the picture takes longer than the budget.
    Time,
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
    pub work: f64,
}

/// Times as reported, and what they say a unit of work takes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Governor {
    recent: [f64; 3],
    reports: usize,
}

impl Governor {
    /// A frame of so much work took so long.
    pub fn report(&mut self, ms: f64, work: f64) {
        if work > 0.0 {
            self.recent[self.reports % 3] = ms / work;
            self.reports += 1;
        }
    }

    /// Milliseconds of a unit of work: the median of the last three reports, so that one slow frame changes nothing.
    pub fn ms_per_work(&self) -> Option<f64> {
        let [a, b, c] = self.recent;
        match self.reports {
            0 => None,
            1 => Some(a),
            2 => Some(a.min(b)),
            _ => Some(a.max(b).min(a.min(b).max(c))),
        }
    }

    /// The set to leave out, as an index into `choices`; `before` is the one left out now.
    pub fn choose(
        &self,
        choices: &[Choice; 8],
        tolerance: Option<f64>,
        budget_ms: Option<f64>,
        before: usize,
    ) -> (usize, GaveWay) {
        let fits = |c: &Choice| match (budget_ms, self.ms_per_work()) {
            (Some(budget), Some(k)) => {
                let more = c.work > choices[before].work;
                k * c.work <= if more { ROOM * budget } else { budget }
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
        if let Some(i) = of(&|i, c| fits(c) && keeps(i, c), &|c| c.work) {
            return (i, GaveWay::Nothing);
        }
        if let Some(i) = of(&|_, c| fits(c), &|c| c.loss) {
            return (i, GaveWay::Tolerance);
        }
        (of(&|_, _| true, &|c| c.work).unwrap_or(0), GaveWay::Time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Air, fog and sky worth so much, on a picture of work 1 + their work.
    fn choices(worth: [f64; 3], work: [f64; 3]) -> [Choice; 8] {
        std::array::from_fn(|set| {
            let left = |i: &usize| set & (1 << i) != 0;
            let sum = |v: [f64; 3]| (0..3).filter(left).map(|i| v[i]).sum::<f64>();
            let p95 = sum(worth);
            Choice {
                possible: true,
                error: Estimate { p95, bound: p95, worst: p95 },
                loss: (0..3).filter(left).map(|i| IMPORTANCE[i] * worth[i]).sum(),
                work: 1.0 + work.iter().sum::<f64>() - sum(work),
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
            governor.report(load * noise * choices[set].work, choices[set].work);
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
            governor.report(load * choices[set].work, choices[set].work);
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
        governor.report(10.0, 1.0);
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
    fn one_slow_frame_changes_nothing() {
        let choices = choices([0.05, 0.3, 0.02], [0.4, 0.5, 0.2]);
        let mut governor = Governor::default();
        for ms in [4.0, 4.0, 40.0, 4.0, 4.0] {
            governor.report(ms * choices[0].work, choices[0].work);
            assert_eq!(governor.choose(&choices, None, Some(10.0), 0).0, 0);
        }
    }
}
