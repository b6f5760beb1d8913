//! Curtains of rain, and the mean of a pattern's wave along a ray.

use glam::DVec3;

use crate::light::sinc;

/// Half of a path on which a wave of a pattern fades to a half, in its length / 2 pi: `PATCH_ROW` of
/// `shaders/fog/patterns.wgsl`.
pub(super) const PATCH_ROW: f64 = 8.0;
/// Number of plane waves in the curtains' pattern.
pub const CURTAIN_WAVES: usize = 8;
/// Distance from the eye at which curtains begin, m: what is nearer is drawn drop by drop or nearly so. `CURTAIN_START`
/// of `shaders/fog/patterns.wgsl`.
pub const CURTAIN_START_M: f64 = 30.0;

/// Curtains of rain: the extinction of what falls is that of even rain times 1 + `amount` times the sum of the waves'
/// cosines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curtains {
    /// Amplitude of each wave over the extinction of all that falls; 0 for none.
    pub amount: f64,
    /// Wave vectors (east, north, up), 1/m, and phases at the camera, rad.
    pub waves: [(DVec3, f64); CURTAIN_WAVES],
}

impl Curtains {
    /// Even rain.
    pub const NONE: Self = Self { amount: 0.0, waves: [(DVec3::ZERO, 0.0); CURTAIN_WAVES] };

    /// Returns what they add between two distances of a ray, relative to what an even layer has there, and the variance
    /// of that over all places. In both only what lies beyond [`CURTAIN_START_M`] counts.
    pub fn mean(&self, origin: DVec3, direction: DVec3, first: f64, last: f64) -> (f64, f64) {
        let start = first.max(CURTAIN_START_M);
        if last <= start {
            return (0.0, 0.0);
        }
        let (middle, half) = (0.5 * (start + last), 0.5 * (last - start));
        let part = self.amount * (last - start) / (last - first);
        let (mut sum, mut squares) = (0.0, 0.0);
        for wave in &self.waves {
            let (value, size) = wave_mean(*wave, origin, direction, middle, half);
            (sum, squares) = (sum + value, squares + size * size);
        }
        (part * sum, 0.5 * part * part * squares)
    }

    /// The optical depth that even rain of `depth` shows with them. On the mean over all places as much of the light
    /// behind is left as even rain leaves, so signs are seen as far: the mean of e^-x of a normal x is e^(v/2) above
    /// that of its mean.
    pub fn depth(&self, depth: f64, (added, variance): (f64, f64)) -> f64 {
        (depth * (1.0 + added)).max(0.0) + 0.5 * depth * depth * variance
    }
}

/// Mean of a wave's cosine along a ray, and how large it may be there.
pub(super) fn wave_mean(
    (wave, phase): (DVec3, f64),
    origin: DVec3,
    direction: DVec3,
    middle: f64,
    half: f64,
) -> (f64, f64) {
    let along = wave.dot(direction);
    let x = along * half;
    // No row goes on for ever: a ray along one meets others after some.
    let size = sinc(x) * PATCH_ROW / (PATCH_ROW + wave.length() * half);
    ((phase + wave.dot(origin) + along * middle).cos() * size, size)
}
