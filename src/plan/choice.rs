//! Options in a gauged picture, and the choice among them: within the tolerance the least work, and if that takes too
//! long what is missed least.

use super::{
    estimate::{Estimate, Estimator},
    governor::{GaveWay, Governor, WorkAmount},
    parts::{Ladder, MOST_PARTS, MOST_STEPS, Part, Set},
    search::{Free, Search, least_missed},
};

/// Leaving out takes a tenth more certainty than staying out, so that a picture at the border does not flicker.
const CERTAINTY: f64 = 0.9;

/// Demands on a picture.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Asked {
    pub tolerance: Option<f64>,
    pub milliseconds: Option<f64>,
    /// How much each part matters.
    pub importance: [f64; MOST_PARTS],
    /// Parts that may not be chosen about, by all of their steps, and the steps of them that are taken.
    pub pinned: (Set, Set),
}

/// Everything that one gauge told, until the next.
pub(super) struct Choices {
    pub ladder: Ladder,
    pub estimator: Estimator,
    search: Search,
    /// Work of the picture with everything.
    pub all: WorkAmount,
    /// Error of the picture after this step and those above it, and nothing else.
    pub worth: [Estimate; MOST_STEPS],
    /// Steps of the parts that are there.
    there: Set,
    /// Steps that keep the tolerance with the least work.
    cheapest: Option<Set>,
}

impl Choices {
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

    /// Takes a picture that the estimator has seen: its work, the steps of what is there, what is asked, and what is
    /// left out now.
    pub fn take(&mut self, all: WorkAmount, there: Set, governor: &Governor, asked: &Asked, previous: Set) {
        (self.all, self.there) = (all, there);
        let Self { ladder, estimator, search, worth, .. } = self;
        for part in 0..ladder.parts.len() {
            for (rung, step) in ladder.steps(part).enumerate() {
                worth[step] = estimator.estimate(ladder, ladder.set(part, rung + 1));
            }
        }
        let free = Free { ladder, steps: there & !asked.pinned.0, pinned: asked.pinned.1 };
        self.cheapest = match asked.tolerance {
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

    /// The steps to take, where those of `previous` are taken now.
    pub fn choose(&self, governor: &Governor, asked: &Asked, previous: Set) -> (Set, GaveWay) {
        let now = self.all.without(previous);
        let fits = |set: Set| governor.fits(&self.all.without(set), asked.milliseconds, &now);
        if let Some(set) = self.cheapest.filter(|s| fits(*s)) {
            return (set, GaveWay::Nothing);
        }
        let free = Free { ladder: &self.ladder, steps: self.there & !asked.pinned.0, pinned: asked.pinned.1 };
        let work = |set: Set| governor.work(&self.all.without(set));
        let (set, fits) = least_missed(free, work, |set| self.loss(set, asked), fits);
        (set, if fits { GaveWay::Tolerance } else { GaveWay::Time })
    }

    /// Returns how much is missed of a picture: what its parts are worth in it times how much they matter.
    fn loss(&self, set: Set, asked: &Asked) -> f64 {
        let of = |part: usize| match self.ladder.rung(set, part) {
            0 => 0.0,
            rung => asked.importance[part] * self.worth[self.ladder.steps(part).start + rung - 1].p95,
        };
        (0..self.ladder.parts.len()).map(of).sum()
    }
}
