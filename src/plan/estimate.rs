//! Estimate of the error of a picture without some of its parts, from the pixels that the gauge saw.
//!
//! The *error* is defined as everywhere in the crate: the 95th percentile over pixels of |Y' - Y| / (Y + 0.01 white)
//! after exposure. A tolerance also bounds the worst pixel, to [`WORST`] times the tolerance. So a far ridge keeps its
//! haze even if it fills only a twentieth of the picture.

use super::parts::{Ladder, MOST_STEPS, Set};

/// Largest error of the worst pixel, in multiples of the tolerance.
pub const WORST: f64 = 10.0;

/// Error of a picture from which parts were left out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// 95th percentile over the gauged pixels.
    pub p95: f64,
    /// Upper end of the one-sided 95 % confidence interval of that percentile over all pixels.
    pub bound: f64,
    /// Largest error of a gauged pixel.
    pub worst: f64,
}

impl Estimate {
    /// Whether the error is within a tolerance.
    pub fn keeps(&self, tolerance: f64) -> bool {
        self.strain(tolerance) <= 1.0
    }

    /// Returns the share of a tolerance that the error uses up; above 1 it exceeds the tolerance.
    pub(super) fn strain(&self, tolerance: f64) -> f64 {
        (self.bound / tolerance).max(self.worst / (WORST * tolerance))
    }
}

/// Number of estimates that are cached until the next gauge.
const KEPT: usize = 8;

/// Findings of the gauge about a picture, and the estimates from them. The buffers are reused between calls.
pub(super) struct Estimator {
    /// Relative change (Y' - Y) / (Y + 0.01 white) at each pixel due to each step, taken together with the steps above
    /// it.
    changes: Vec<[f32; MOST_STEPS]>,
    /// Errors of the pixels in one estimate.
    scratch: Vec<f32>,
    /// Cached estimates, each with the set of steps that it is for.
    kept: [(Set, Estimate); KEPT],
    /// Number of estimates cached so far; modulo [`KEPT`] it is the index of the next one.
    next: usize,
}

impl Estimator {
    /// Creates an estimator with room for `pixels` pixels.
    pub fn new(pixels: usize) -> Self {
        let kept = [(0, Estimate::default()); KEPT];
        Self { changes: Vec::with_capacity(pixels), scratch: Vec::with_capacity(pixels), kept, next: 0 }
    }

    /// Reserves room for `pixels` pixels.
    pub fn reserve(&mut self, pixels: usize) {
        self.changes.reserve(pixels);
        self.scratch.reserve(pixels);
    }

    /// Begins another picture: forgets all pixels and estimates.
    pub fn clear(&mut self) {
        self.changes.clear();
        self.kept.fill((0, Estimate::default()));
    }

    /// Adds a pixel, with its relative change due to each step.
    pub fn see(&mut self, changes: [f32; MOST_STEPS]) {
        self.changes.push(changes);
    }

    /// Estimates the error of a picture that takes the steps of `set`.
    pub fn estimate(&mut self, ladder: &Ladder, set: Set) -> Estimate {
        if set == 0 || self.changes.is_empty() {
            return Estimate::default();
        }
        if let Some((_, known)) = self.kept.iter().find(|k| k.0 == set) {
            return *known;
        }
        // The change due to the lowest step taken of a part is that of all the steps taken of this part.
        let mut lowest = [0; MOST_STEPS];
        let mut count = 0;
        for part in 0..ladder.parts.len() {
            let rung = ladder.rung(set, part);
            if rung > 0 {
                lowest[count] = ladder.steps(part).start + rung - 1;
                count += 1;
            }
        }
        self.scratch.clear();
        self.scratch.extend(self.changes.iter().map(|change| {
            let sum: f32 = lowest[..count].iter().map(|s| change[*s]).sum();
            if sum.is_finite() { sum.abs() } else { f32::MAX }
        }));
        let found = percentile(&mut self.scratch);
        self.kept[self.next % KEPT] = (set, found);
        self.next += 1;
        found
    }
}

/// Returns the 95th percentile of errors with its confidence bound, and the largest error. Reorders `errors`.
fn percentile(errors: &mut [f32]) -> Estimate {
    let n = errors.len();
    // Share of the errors between the rank of the 95th percentile and the rank `high`. The error at `high` is, with a
    // confidence of 95 %, at least the 95th percentile of the population (normal approximation of the binomial).
    let spread = 1.645 * (0.95 * 0.05 / n as f64).sqrt();
    let rank = |share: f64| ((share * n as f64).ceil() as usize).clamp(1, n) - 1;
    let (low, high) = (rank(0.95), rank((0.95 + spread).min(1.0)));
    let (_, p95, above) = errors.select_nth_unstable_by(low, f32::total_cmp);
    let p95 = f64::from(*p95);
    let worst = above.iter().copied().fold(p95 as f32, f32::max);
    let bound = match high.checked_sub(low + 1) {
        Some(beyond) if beyond < above.len() => f64::from(*above.select_nth_unstable_by(beyond, f32::total_cmp).1),
        _ => p95,
    };
    Estimate { p95, bound, worst: f64::from(worst) }
}

#[cfg(test)]
mod tests {
    use super::super::parts::{Part, Worth};
    use super::*;

    const fn part(name: &'static str, rungs: &'static [&'static str]) -> Part {
        Part { name, rungs, importance: 0.5, worth: Worth::Composed(0) }
    }

    const PARTS: [Part; 2] = [part("a", &["all", "none"]), part("b", &["all", "some", "none"])];

    fn seen(pixels: usize, change: impl Fn(usize) -> [f32; 3]) -> Estimator {
        let mut estimator = Estimator::new(pixels);
        for i in 0..pixels {
            let mut all = [0.0; MOST_STEPS];
            all[..3].copy_from_slice(&change(i));
            estimator.see(all);
        }
        estimator
    }

    #[test]
    fn the_bound_lies_above_the_percentile_and_the_worst_pixel_is_reported() {
        let ladder = Ladder::new(&PARTS);
        let e = seen(2000, |i| [i as f32 / 2000.0, 0.0, 0.0]).estimate(&ladder, 1);
        assert!((e.p95 - 0.95).abs() < 1e-3 && e.bound > 0.956 && e.bound < 0.96 && e.worst > 0.99, "{e:?}");
        let ridge = seen(2000, |i| [if i < 60 { 0.5 } else { 0.0 }, 0.0, 0.0]).estimate(&ladder, 1);
        assert!(ridge.p95 == 0.0 && !ridge.keeps(0.02) && ridge.keeps(0.06), "a far ridge keeps its haze: {ridge:?}");
        assert!(!seen(100, |_| [f32::NAN, 0.0, 0.0]).estimate(&ladder, 1).keeps(1.0));
        assert_eq!(
            Estimator::new(0).estimate(&ladder, 1),
            Estimate::default(),
            "a picture under the mask needs nothing"
        );
    }

    #[test]
    fn opposite_changes_cancel_only_where_they_meet_and_the_lowest_rung_counts() {
        let ladder = Ladder::new(&PARTS);
        let mut both = seen(2000, |_| [0.3, 0.1, -0.3]);
        assert_eq!(both.estimate(&ladder, 0b111).worst, 0.0);
        assert!((both.estimate(&ladder, 0b011).p95 - 0.4).abs() < 1e-6);
        assert!((both.estimate(&ladder, 0b110).p95 - 0.3).abs() < 1e-6);
        let mut apart = seen(2000, |i| if i < 1000 { [0.3, 0.0, 0.0] } else { [0.0, 0.0, -0.3] });
        assert!((apart.estimate(&ladder, 0b111).p95 - 0.3).abs() < 1e-6);
    }

    #[test]
    fn another_picture_has_other_estimates() {
        let ladder = Ladder::new(&PARTS);
        let mut estimator = seen(10, |_| [0.3, 0.0, 0.0]);
        assert!(estimator.estimate(&ladder, 1).p95 > 0.2);
        estimator.clear();
        (0..10).for_each(|_| estimator.see([0.0; MOST_STEPS]));
        assert_eq!(estimator.estimate(&ladder, 1).p95, 0.0);
    }
}
