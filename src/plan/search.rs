//! Search for the steps to take: the set that saves the most work within a tolerance, or the set with the least loss
//! within the time.
//!
//! If there are few sets of steps, all are tried. Otherwise the search within a tolerance tries a limited number of
//! sets in order of increasing work, and the first one that keeps the tolerance is the best. If none of these keeps it,
//! steps are added one at a time to the few best sets, and then exchanged as long as that saves more. The number of
//! trials grows with the square of the number of steps. The search within the time takes the step with the least loss
//! for the work that it saves, one step after another, until the picture fits.

use std::{cmp::Reverse, collections::BinaryHeap};

use super::parts::{Ladder, Set};

/// Number of sets up to which all are tried.
const WHOLE: usize = 64;
/// Number of trials in order of increasing work, divided by the square of the number of steps.
const TRIALS: usize = 3;
/// Number of sets to which further steps are added, by each of the two criteria of [`Search::downwards`].
const FRONT: usize = 3;
/// Strain (share of the tolerance that a set uses up) above which changes by other parts are not expected to
/// compensate.
const MOST_STRAIN: f64 = 3.0;
/// Amount added to each strain, so that a set without strain is not infinitely good.
const LEAST_STRAIN: f64 = 0.1;

/// Steps that the search may take, beside those of the pinned parts.
#[derive(Clone, Copy)]
pub(super) struct Free<'a> {
    /// Steps of all parts.
    pub ladder: &'a Ladder,
    /// Steps that may be taken: for each part all of its steps, or none.
    pub steps: Set,
    /// Steps of pinned parts that are taken.
    pub pinned: Set,
}

impl Free<'_> {
    /// Returns the parts with free steps.
    fn parts(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.ladder.parts.len()).filter(|p| self.steps & self.ladder.whole(*p) != 0)
    }

    /// Returns the number of different sets.
    fn sets(&self) -> usize {
        self.parts().map(|p| self.ladder.steps(p).len() + 1).product()
    }

    /// Visits every set once.
    fn each(&self, mut visit: impl FnMut(Set)) {
        for i in 0..self.sets() {
            let (mut i, mut set) = (i, self.pinned);
            for part in self.parts() {
                let rungs = self.ladder.steps(part).len() + 1;
                set = self.ladder.with(set, part, i % rungs);
                i /= rungs;
            }
            visit(set);
        }
    }

    /// Returns the set with one more step of a part, if the part has one.
    fn lower(&self, set: Set, part: usize) -> Option<Set> {
        let rung = self.ladder.rung(set, part);
        (rung < self.ladder.steps(part).len()).then(|| self.ladder.with(set, part, rung + 1))
    }

    /// Returns the set with every step that may be taken, and those of the pinned parts.
    fn all(&self) -> Set {
        self.pinned | self.steps
    }
}

/// Candidate set: its work as bits (which are in the order of the works, as no work is negative), its steps, and the
/// first part that may still be raised in it.
type Next = Reverse<(u64, Set, usize)>;

/// A set, the work that it saves, and its strain: the share of the tolerance that it uses up.
type Tried = (Set, f64, f64);

/// Buffers of the search, reused between calls.
#[derive(Default)]
pub(super) struct Search {
    /// Sets to try next, those of least work first.
    next: BinaryHeap<Next>,
    /// Sets to which a further step is added.
    front: Vec<Tried>,
    /// Sets tried with one further step.
    tried: Vec<Tried>,
}

impl Search {
    /// Finds the set of least work that keeps a tolerance. Such a set has a strain of at most 1. `None` if no such set
    /// was found.
    pub fn cheapest(
        &mut self,
        free: Free<'_>,
        work: impl Fn(Set) -> f64,
        mut strain: impl FnMut(Set) -> f64,
    ) -> Option<Set> {
        if free.sets() <= WHOLE {
            let mut best = None;
            free.each(|set| {
                let this = work(set);
                if best.is_none_or(|(least, _)| this < least) && strain(set) <= 1.0 {
                    best = Some((this, set));
                }
            });
            return best.map(|b| b.1);
        }
        let steps = free.steps.count_ones() as usize;
        if let Some(found) = self.upwards(free, TRIALS * steps * steps, &work, &mut strain) {
            return Some(found);
        }
        let best = self.downwards(free, &work, &mut strain)?;
        Some(exchanged(free, best, &work, &mut strain))
    }

    /// Tries sets in order of increasing work, and returns the first that keeps the tolerance.
    fn upwards(
        &mut self,
        free: Free<'_>,
        trials: usize,
        work: &impl Fn(Set) -> f64,
        strain: &mut impl FnMut(Set) -> f64,
    ) -> Option<Set> {
        let next = |set: Set, from: usize| Reverse((work(set).max(0.0).to_bits(), set, from));
        self.next.clear();
        self.next.push(next(free.all(), 0));
        for _ in 0..trials {
            let Reverse((_, set, from)) = self.next.pop()?;
            if strain(set) <= 1.0 {
                return Some(set);
            }
            // Parts are raised in the order of the list, so that no set is met twice.
            for part in free.parts().filter(|p| *p >= from) {
                let rung = free.ladder.rung(set, part);
                if rung > 0 {
                    self.next.push(next(free.ladder.with(set, part, rung - 1), part));
                }
            }
        }
        None
    }

    /// Adds one step at a time to several sets at once: to the sets that save most, and to the sets that save most
    /// relative to their strain. The strain may exceed 1 on the way, since the change by another part may compensate.
    /// Returns the set of least work among those that kept the tolerance.
    fn downwards(
        &mut self,
        free: Free<'_>,
        work: &impl Fn(Set) -> f64,
        strain: &mut impl FnMut(Set) -> f64,
    ) -> Option<Set> {
        let everything = work(free.pinned);
        let mut best = (strain(free.pinned) <= 1.0).then_some((everything, free.pinned));
        self.front.clear();
        self.front.push((free.pinned, 0.0, 0.0));
        for _ in 0..free.steps.count_ones() {
            self.tried.clear();
            for (set, ..) in &self.front {
                for lower in free.parts().filter_map(|p| free.lower(*set, p)) {
                    if self.tried.iter().all(|t| t.0 != lower) {
                        self.tried.push((lower, everything - work(lower), strain(lower)));
                    }
                }
            }
            for (set, saves, strain) in &self.tried {
                let this = everything - saves;
                if *strain <= 1.0 && best.is_none_or(|(least, _)| this < least) {
                    best = Some((this, *set));
                }
            }
            self.front.clear();
            let keys: [fn(&Tried) -> f64; 2] = [
                |t| if t.2 <= 1.0 { t.1 } else { -t.2 },
                |t| if t.2 <= MOST_STRAIN { t.1 / (t.2 + LEAST_STRAIN) } else { -t.2 },
            ];
            for key in keys {
                self.tried.sort_by(|a, b| key(b).total_cmp(&key(a)));
                let rest = self.tried.len().min(FRONT);
                self.front.extend(self.tried.drain(..rest));
            }
        }
        best.map(|b| b.1)
    }
}

/// Takes one step after another: each time the one that saves most within the tolerance.
fn greedy(free: Free<'_>, start: Set, work: &impl Fn(Set) -> f64, strain: &mut impl FnMut(Set) -> f64) -> Set {
    let mut set = start;
    loop {
        let lower =
            free.parts().filter_map(|p| free.lower(set, p)).filter(|s| work(*s) < work(set) && strain(*s) <= 1.0);
        match lower.min_by(|a, b| work(*a).total_cmp(&work(*b))) {
            Some(lower) => set = lower,
            None => return set,
        }
    }
}

/// Gives steps of one part back so that steps of other parts fit, as long as the exchange saves more work.
fn exchanged(free: Free<'_>, start: Set, work: &impl Fn(Set) -> f64, strain: &mut impl FnMut(Set) -> f64) -> Set {
    let mut best = start;
    for part in free.parts() {
        for rung in 0..free.ladder.rung(best, part) {
            let given_back = free.ladder.with(best, part, rung);
            let mut other = given_back;
            // Other parts first, so that the same step is not taken again at once.
            let rest = Free { steps: free.steps & !free.ladder.whole(part), ..free };
            other = greedy(rest, other, work, strain);
            other = greedy(free, other, work, strain);
            if work(other) < work(best) && strain(other) <= 1.0 {
                best = other;
                break;
            }
        }
    }
    best
}

/// Finds the set with the least loss that fits, or the set of least work if none fits. Returns the set, and whether it
/// fits. With many sets the search is greedy, so that the loss may be a little above the least.
pub(super) fn least_missed(
    free: Free<'_>,
    work: impl Fn(Set) -> f64,
    loss: impl Fn(Set) -> f64,
    fits: impl Fn(Set) -> bool,
) -> (Set, bool) {
    if free.sets() <= WHOLE {
        let mut best: Option<(f64, Set)> = None;
        free.each(|set| {
            let this = loss(set);
            if best.is_none_or(|(least, _)| this < least) && fits(set) {
                best = Some((this, set));
            }
        });
        return best.map_or_else(|| (cheapest_of_all(free, &work), false), |b| (b.1, true));
    }
    let mut set = free.pinned;
    while !fits(set) {
        let price = |lower: &Set| (loss(*lower) - loss(set)) / (work(set) - work(*lower)).max(1e-12);
        let best = free.parts().filter_map(|p| free.lower(set, p)).min_by(|a, b| price(a).total_cmp(&price(b)));
        match best {
            Some(lower) => set = lower,
            None => return (set, false),
        }
    }
    // Later steps may have made earlier ones unnecessary: as long as there is time, the step whose return lowers the
    // loss most is given back.
    loop {
        let raised = |p: usize| Some(free.ladder.with(set, p, free.ladder.rung(set, p).checked_sub(1)?));
        let back = free.parts().filter_map(raised).filter(|s| fits(*s)).min_by(|a, b| loss(*a).total_cmp(&loss(*b)));
        match back.filter(|s| loss(*s) < loss(set)) {
            Some(back) => set = back,
            None => return (set, true),
        }
    }
}

/// Finds the set with the least work; of sets with equal work, the one that draws more.
fn cheapest_of_all(free: Free<'_>, work: &impl Fn(Set) -> f64) -> Set {
    let mut best = (work(free.pinned), free.pinned);
    free.each(|set| {
        if work(set) < best.0 {
            best = (work(set), set);
        }
    });
    best.1
}

#[cfg(test)]
mod tests {
    use super::super::{
        estimate::Estimator,
        parts::{MOST_STEPS, Part, Worth},
    };
    use super::*;
    use crate::chance::RandomStream;

    const fn part(rungs: &'static [&'static str]) -> Part {
        Part { name: "part", rungs, importance: 0.5, worth: Worth::Composed(0) }
    }

    const TWO: Part = part(&["all", "none"]);
    const THREE: Part = part(&["all", "some", "none"]);
    /// Lists of up to ten parts.
    const LISTS: [&[Part]; 5] = [
        &[TWO; 6],
        &[TWO, TWO, TWO, TWO, TWO, THREE, TWO],
        &[TWO; 8],
        &[TWO, THREE, TWO, TWO, THREE, TWO, TWO, TWO, THREE],
        &[TWO; 10],
    ];

    /// A picture whose parts brighten or darken some of its pixels, a lower rung more than the one above.
    fn picture(ladder: &Ladder, random: &mut RandomStream) -> (Estimator, Vec<f64>) {
        let steps = ladder.len();
        let mut estimator = Estimator::new(400);
        let amplitudes: Vec<[f64; 3]> = (0..ladder.parts.len())
            .map(|_| {
                let sign = if random.unit() < 0.6 { 1.0 } else { -1.0 };
                [sign * 0.06 * random.unit().powi(3), random.unit(), 0.2 + 0.8 * random.unit()]
            })
            .collect();
        for _ in 0..400 {
            let mut changes = [0.0; MOST_STEPS];
            for (part, [amplitude, spread, share]) in amplitudes.iter().enumerate() {
                let here = if random.unit() < *share { amplitude * (1.0 - spread * random.unit()) } else { 0.0 };
                let (from, count) = (ladder.steps(part).start, ladder.steps(part).len());
                for step in 0..count {
                    changes[from + step] = (here * (step + 1) as f64 / count as f64) as f32;
                }
            }
            estimator.see(changes);
        }
        (estimator, (0..steps).map(|_| 0.02 + random.unit()).collect())
    }

    /// Finds the best set by trying all.
    fn whole(free: Free<'_>, work: impl Fn(Set) -> f64, mut strain: impl FnMut(Set) -> f64) -> Set {
        let mut best = (work(free.pinned), free.pinned);
        free.each(|set| {
            if work(set) < best.0 && strain(set) <= 1.0 {
                best = (work(set), set);
            }
        });
        best.1
    }

    #[test]
    fn five_hundred_searches_save_nearly_what_the_best_set_saves_and_never_break_the_tolerance() {
        let (mut worst, mut most, mut random) = (1.0f64, 0.0f64, RandomStream::seeded(3));
        for case in 0..500 {
            let ladder = Ladder::new(LISTS[case % LISTS.len()]);
            let (mut estimator, saves) = picture(&ladder, &mut random);
            let total: f64 = 1.0 + saves.iter().sum::<f64>();
            let work =
                |set: Set| total - (0..saves.len()).filter(|i| set & (1 << i) != 0).map(|i| saves[i]).sum::<f64>();
            let tolerance = [0.005, 0.01, 0.02, 0.05][case / 5 % 4];
            let free = Free { ladder: &ladder, steps: (1 << ladder.len()) - 1, pinned: 0 };
            let best = whole(free, work, |set| estimator.estimate(&ladder, set).strain(tolerance));
            let mut trials = 0;
            let found = Search::default()
                .cheapest(free, work, |set| {
                    trials += 1;
                    estimator.estimate(&ladder, set).strain(tolerance)
                })
                .expect("nothing left out keeps every tolerance");
            assert!(estimator.estimate(&ladder, found).keeps(tolerance), "case {case}");
            let (saved, could) = (total - work(found), total - work(best));
            if could > 0.0 {
                worst = worst.min(saved / could);
            }
            most = most.max(trials as f64 / (ladder.len() * ladder.len()) as f64);
        }
        println!(
            "at worst {:.1} % of the best saving; at most {most:.1} trials for the square of the steps",
            100.0 * worst
        );
        assert!(worst >= 0.98, "{worst}");
        assert!(most <= 8.0, "{most}");
    }

    #[test]
    fn pinned_parts_stay_and_parts_that_are_not_there_are_never_taken() {
        let ladder = Ladder::new(LISTS[1]);
        let free = Free { ladder: &ladder, steps: ladder.whole(0) | ladder.whole(5), pinned: ladder.set(2, 1) };
        let work = |set: Set| 10.0 - f64::from(set.count_ones());
        let found = Search::default().cheapest(free, work, |_| 0.0).unwrap();
        assert_eq!(found, free.pinned | free.steps);
        assert_eq!(Search::default().cheapest(free, work, |_| 2.0), None);
        let (missed, fits) = least_missed(free, work, |set| f64::from(set.count_ones()), |set| work(set) <= 8.0);
        assert!(fits && missed & free.pinned == free.pinned && missed.count_ones() == 2, "{missed:b}");
    }

    #[test]
    fn within_a_budget_little_more_is_lost_than_with_the_best_set() {
        let mut random = RandomStream::seeded(9);
        let (mut sum, mut best_sum) = (0.0, 0.0);
        for case in 0..500 {
            let ladder = Ladder::new(LISTS[case % LISTS.len()]);
            let steps = ladder.len();
            let (saves, losses): (Vec<f64>, Vec<f64>) =
                (0..steps).map(|_| (0.05 + random.unit(), random.unit())).unzip();
            let sum_of = |v: &[f64], set: Set| (0..steps).filter(|i| set & (1 << i) != 0).map(|i| v[i]).sum::<f64>();
            let total: f64 = saves.iter().sum();
            let (work, loss) = (|set: Set| total - sum_of(&saves, set), |set: Set| sum_of(&losses, set));
            let budget = total * (0.2 + 0.7 * random.unit());
            let free = Free { ladder: &ladder, steps: (1 << steps) - 1, pinned: 0 };
            let (found, fits) = least_missed(free, work, loss, |set| work(set) <= budget);
            assert!(fits && work(found) <= budget, "case {case}");
            let mut least = f64::INFINITY;
            free.each(|set| {
                if work(set) <= budget {
                    least = least.min(loss(set));
                }
            });
            (sum, best_sum) = (sum + loss(found), best_sum + least);
        }
        println!("missed {:.1} % more than the least, on the mean", 100.0 * (sum / best_sum - 1.0));
        assert!(sum <= 1.1 * best_sum, "{sum} {best_sum}");
        let none = Ladder::new(LISTS[0]);
        let free = Free { ladder: &none, steps: 0b111111, pinned: 0 };
        assert_eq!(least_missed(free, |s| 10.0 - f64::from(s.count_ones()), |_| 0.0, |_| false), (0b111111, false));
    }
}
