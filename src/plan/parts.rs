//! Which parts of the weather a picture needs: chosen from what each is worth in that very picture.
//!
//! The gauge (`gauge.rs`) says, at a grid of the picture's pixels, how the luminance would change without a part.
//! Parts are left out as long as the whole change stays within the tolerance, those first that save most work.
//!
//! *Error* is that of the whole library: |Y' - Y| / (Y + 0.01 white) after exposure, its 95th percentile over pixels. A
//! tolerance also bounds the worst pixel, by [`WORST`] times as much: a far ridge in a twentieth of the picture keeps
//! its haze.

/// Part of the weather that a view may leave out of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Part {
    /// Air and haze between the camera and what the host drew.
    Air,
    /// Fog, mist, dust and what falls, as a layer.
    Fog,
    /// The clear sky above the horizon, behind clouds: left out, a closed deck hides it.
    Sky,
    /// Streaks and splashes of rain: left out, all rain is a veil. Without fog too, nothing of it is drawn.
    Rain,
    /// Each drop near the camera by itself, and splashes: left out, cones stand for them.
    Drops,
}

/// Number of parts.
pub const PARTS: usize = Part::ALL.len();
/// Those that the gauge draws with and without; of streaks it sees what the veil in their place would add, the rest of what they
/// are worth is known in closed form.
pub(super) const GAUGED: usize = 3;

impl Part {
    /// All, in the order of every list here.
    pub const ALL: [Self; 5] = [Self::Air, Self::Fog, Self::Sky, Self::Rain, Self::Drops];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Air => "air",
            Self::Fog => "fog",
            Self::Sky => "sky",
            Self::Rain => "rain",
            Self::Drops => "drops",
        }
    }
}

/// Why a part is drawn or not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reason {
    /// The host pinned the plan.
    Pinned,
    /// No tolerance was given: everything is drawn.
    #[default]
    EverythingAsked,
    /// This picture has not been gauged yet, or may not depend on earlier ones: everything is drawn.
    NotGauged,
    /// The weather has none of it, or the stages recorded do not draw it.
    Absent,
    /// Without it the error would be beyond the tolerance.
    Needed,
    /// The error without it is within the tolerance.
    WithinTolerance,
    /// The time allows no more.
    OutOfTime,
}

impl Reason {
    /// In a few words.
    pub const fn text(self) -> &'static std::ffi::CStr {
        match self {
            Self::Pinned => c"the host pinned it",
            Self::EverythingAsked => c"no tolerance was given",
            Self::NotGauged => c"this picture has not been gauged yet",
            Self::Absent => c"there is none of it",
            Self::Needed => c"without it the error would be beyond the tolerance",
            Self::WithinTolerance => c"the error without it is within the tolerance",
            Self::OutOfTime => c"the time allows no more",
        }
    }
}

/// The worst pixel may err by so many times the tolerance of the 95th percentile.
pub const WORST: f64 = 10.0;

/// Error of a picture from which parts were left out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// 95th percentile over the gauged pixels.
    pub p95: f64,
    /// Upper end of the one-sided 95 % confidence interval of that percentile over all pixels.
    pub bound: f64,
    /// The worst gauged pixel.
    pub worst: f64,
}

impl Estimate {
    /// Whether it keeps a tolerance.
    pub fn keeps(&self, tolerance: f64) -> bool {
        self.bound <= tolerance && self.worst <= WORST * tolerance
    }
}

/// Leaving out takes a tenth more certainty than staying out, so that a picture at the border does not flicker.
pub(super) const CERTAINTY: f64 = 0.9;

/// What a gauge saw at one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Change of luminance without each part.
    pub change: [f32; PARTS],
    /// Whether the host drew there (1), did not (-1), or keeps the pixel for itself (0).
    pub kind: f32,
    /// Luminance with everything but drops, 1 = white.
    pub luminance: f32,
    /// Optical depth of what drops hide on the mean.
    pub hidden: f32,
}

/// Whether a set of parts can be left out where those of `present` are there: without streaks there are no near drops.
pub(super) fn is_possible(set: usize, present: &[bool; PARTS]) -> bool {
    let [rain, drops] = [Part::Rain, Part::Drops].map(|p| 1 << p as usize);
    let there = (0..PARTS).all(|i| set & (1 << i) == 0 || present[i]);
    there && (set & rain == 0 || set & drops != 0 || !present[Part::Drops as usize])
}

/// Estimates the error of leaving out sets of parts; holds its memory between calls.
pub(super) struct Estimator {
    scratch: Vec<f32>,
}

impl Estimator {
    pub fn new(samples: usize) -> Self {
        Self { scratch: Vec::with_capacity(samples) }
    }

    /// The error of leaving out the parts of `set` (bit i is `Part::ALL[i]`).
    pub fn estimate(&mut self, samples: &[Sample], set: usize) -> Estimate {
        self.scratch.clear();
        // Cones are no worse where there are none.
        let set = if set & (1 << Part::Rain as usize) != 0 { set & !(1 << Part::Drops as usize) } else { set };
        for s in samples.iter().filter(|s| s.kind != 0.0) {
            let change: f32 = (0..PARTS).filter(|i| set & (1 << i) != 0).map(|i| s.change[i]).sum();
            self.scratch.push(if change.is_finite() { change.abs() } else { f32::MAX });
        }
        let n = self.scratch.len();
        if n == 0 || set == 0 {
            return Estimate::default();
        }
        // The order statistic above which a binomial count of 5 % falls in 95 % of draws.
        let spread = 1.645 * (0.95 * 0.05 / n as f64).sqrt();
        let rank = |share: f64| ((share * n as f64).ceil() as usize).clamp(1, n) - 1;
        let (low, high) = (rank(0.95), rank((0.95 + spread).min(1.0)));
        let (_, p95, above) = self.scratch.select_nth_unstable_by(low, f32::total_cmp);
        let p95 = f64::from(*p95);
        let worst = above.iter().copied().fold(p95 as f32, f32::max);
        let bound = match high.checked_sub(low + 1) {
            Some(beyond) if beyond < above.len() => f64::from(*above.select_nth_unstable_by(beyond, f32::total_cmp).1),
            _ => p95,
        };
        Estimate { p95, bound, worst: f64::from(worst) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::governor::{Amount, Choice, Governor};
    use super::*;

    /// The set that a tolerance leaves out.
    fn choose(samples: &[Sample], present: [bool; 3], work: [f64; 3], tolerance: f64) -> usize {
        let mut estimator = Estimator::new(2000);
        let with_rain = |v: [bool; 3]| [v[0], v[1], v[2], false, false];
        let work = [work[0], work[1], work[2], 0.0, 0.0];
        let choices = std::array::from_fn(|set| Choice {
            possible: is_possible(set, &with_rain(present)),
            error: estimator.estimate(samples, set),
            loss: 0.0,
            amount: Amount { pixels: 6.0, parts: work, before_fog: 0.0 }.without(set),
        });
        Governor::default().choose(&choices, Some(tolerance), None, 0).0
    }

    fn picture(changes: impl Fn(usize) -> [f32; 3]) -> Vec<Sample> {
        (0..2000)
            .map(|i| (i, changes(i)))
            .map(|(i, c)| Sample {
                change: [c[0], c[1], c[2], 0.0, 0.0],
                kind: if i % 2 == 0 { 1.0 } else { -1.0 },
                luminance: 0.2,
                hidden: 0.0,
            })
            .collect()
    }

    #[test]
    fn what_saves_most_is_left_out_while_the_error_allows_it() {
        let even = picture(|_| [0.01, 0.015, 0.0]);
        let left_out = |tolerance| choose(&even, [true; 3], [1.0, 3.0, 0.5], tolerance);
        assert_eq!(left_out(0.005), 0b100, "the sky is worth nothing here");
        assert_eq!(left_out(0.012), 0b101);
        assert_eq!(left_out(0.02), 0b110, "fog saves more than air");
        assert_eq!(left_out(0.03), 0b111);
        assert_eq!(choose(&even, [true, false, true], [1.0; 3], 0.03), 0b101, "what is not there saves nothing");
        assert_eq!(choose(&[], [true; 3], [1.0; 3], 0.1), 0b111, "a picture under the mask needs nothing");
    }

    #[test]
    fn opposite_changes_cancel_only_where_they_meet() {
        let both = picture(|_| [0.3, -0.3, 0.0]);
        assert_eq!(choose(&both, [true; 3], [1.0; 3], 0.01) & 0b11, 0b11);
        let apart = picture(|i| if i < 1000 { [0.3, 0.0, 0.0] } else { [0.0, -0.3, 0.0] });
        assert_eq!(choose(&apart, [true; 3], [1.0; 3], 0.01) & 0b11, 0);
    }

    #[test]
    fn the_bound_lies_above_the_percentile_and_a_few_pixels_cannot_be_ruined() {
        let ramp = picture(|i| [i as f32 / 2000.0, 0.0, 0.0]);
        let e = Estimator::new(2000).estimate(&ramp, 1);
        assert!((e.p95 - 0.95).abs() < 1e-3 && e.bound > 0.956 && e.bound < 0.96 && e.worst > 0.99, "{e:?}");
        let ridge = picture(|i| [if i < 60 { 0.5 } else { 0.0 }, 0.0, 0.0]);
        assert!(Estimator::new(2000).estimate(&ridge, 1).p95 == 0.0);
        assert_eq!(choose(&ridge, [true, false, false], [1.0; 3], 0.02), 0, "a far ridge keeps its haze");
        assert_eq!(choose(&ridge, [true, false, false], [1.0; 3], 0.06), 1);
        let broken = picture(|_| [f32::NAN, 0.0, 0.0]);
        assert_eq!(choose(&broken, [true, false, false], [1.0; 3], 1.0), 0);
    }

    #[test]
    fn masked_pixels_do_not_count() {
        let mut half = picture(|i| [if i < 1000 { 0.5 } else { 0.0 }, 0.0, 0.0]);
        half[..1000].iter_mut().for_each(|s| s.kind = 0.0);
        assert_eq!(Estimator::new(2000).estimate(&half, 1), Estimate::default());
    }
}
