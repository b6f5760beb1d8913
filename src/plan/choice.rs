//! Choice of the steps to take in a gauged picture. A step leads from one rung of a part down to the next, so each step
//! taken saves work. The choice is the set of steps with the least work within the tolerance or, if the picture with
//! that set takes too long, the set with the least loss within the time.

use super::{
    estimate::{Estimate, Estimator},
    governor::{GaveWay, Governor, WorkAmount},
    parts::{Ladder, MOST_PARTS, MOST_STEPS, Part, Set},
    search::{Free, Search, least_missed},
};

/// Share of the tolerance within which a new set of steps must stay. The present set may use the whole tolerance. A
/// picture whose error is close to the tolerance then does not flicker.
const CERTAINTY: f64 = 0.9;

/// Demands on a picture.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PlanDemands {
    /// Largest error, (0, 1].
    pub tolerance: Option<f64>,
    /// Longest time of the weather in a frame, ms.
    pub milliseconds: Option<f64>,
    /// Importance of each part.
    pub importance: [f64; MOST_PARTS],
    /// Two sets of steps that the choice does not change: all steps of the pinned parts, and the steps of these parts
    /// that are taken.
    pub pinned: (Set, Set),
}

/// Findings of one gauge, valid until the next.
pub(super) struct Choices {
    /// Steps of all parts.
    pub ladder: Ladder,
    /// Changes at the gauged pixels, from which errors are estimated.
    pub estimator: Estimator,
    /// Buffers of the search.
    search: Search,
    /// Work of the picture with everything.
    pub all: WorkAmount,
    /// Error of the picture for each step, if only that step and the steps above it in its part are taken.
    pub worth: [Estimate; MOST_STEPS],
    /// Steps of the parts that are present.
    there: Set,
    /// Set of steps that keeps the tolerance with the least work; `None` if no set keeps it. Without a tolerance, the
    /// steps of the pinned parts that are taken.
    cheapest: Option<Set>,
}

impl Choices {
    /// Creates the choices for a list of parts, without findings.
    pub fn new(parts: &'static [Part]) -> Self {
        Self {
            ladder: Ladder::new(parts),
            estimator: Estimator::new(0),
            search: Search::default(),
            all: WorkAmount::default(),
            worth: [Estimate::default(); MOST_STEPS],
            there: 0,
            cheapest: None,
        }
    }

    /// Takes the findings about a gauged picture. The estimator already has the picture's pixels. `all` is the
    /// picture's work with everything, `there` the steps of the parts that are present, `demands` the host's demands,
    /// and `previous` the steps taken now.
    pub fn take(&mut self, all: WorkAmount, there: Set, governor: &Governor, demands: &PlanDemands, previous: Set) {
        (self.all, self.there) = (all, there);
        let Self { ladder, estimator, search, worth, .. } = self;
        for part in 0..ladder.parts.len() {
            for (rung, step) in ladder.steps(part).enumerate() {
                worth[step] = estimator.estimate(ladder, ladder.set(part, rung + 1));
            }
        }
        let free = Free { ladder, steps: there & !demands.pinned.0, pinned: demands.pinned.1 };
        self.cheapest = match demands.tolerance {
            None => Some(free.pinned),
            Some(tolerance) => search.cheapest(
                free,
                |set| governor.work(&all.without(set)),
                |set| {
                    let certain = if set == previous { 1.0 } else { CERTAINTY };
                    estimator.estimate(ladder, set).strain(certain * tolerance)
                },
            ),
        };
    }

    /// Chooses the steps to take, and says which limit they break, if any. `previous` are the steps taken now.
    pub fn choose(&self, governor: &Governor, demands: &PlanDemands, previous: Set) -> (Set, GaveWay) {
        let now = self.all.without(previous);
        let fits = |set: Set| governor.fits(&self.all.without(set), demands.milliseconds, &now);
        if let Some(set) = self.cheapest.filter(|s| fits(*s)) {
            return (set, GaveWay::Nothing);
        }
        let free = Free { ladder: &self.ladder, steps: self.there & !demands.pinned.0, pinned: demands.pinned.1 };
        let work = |set: Set| governor.work(&self.all.without(set));
        let (set, fits) = least_missed(free, work, |set| self.loss(set, demands), fits);
        (set, if fits { GaveWay::Tolerance } else { GaveWay::Time })
    }

    /// Returns the loss of a picture: the sum over parts of their error at their rung, times their importance.
    fn loss(&self, set: Set, demands: &PlanDemands) -> f64 {
        let of = |part: usize| match self.ladder.rung(set, part) {
            0 => 0.0,
            rung => demands.importance[part] * self.worth[self.ladder.steps(part).start + rung - 1].p95,
        };
        (0..self.ladder.parts.len()).map(of).sum()
    }
}
