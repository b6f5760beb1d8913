//! Curtains of rain, and the mean of a wave of a pattern along a ray.

use glam::DVec3;

use crate::light::sinc;

/// Half-length of a path over which a wave of a pattern fades to one half, in units of its wavelength / (2 pi):
/// `PATCH_ROW` of `shaders/fog/patterns.wgsl`.
pub(super) const PATCH_ROW: f64 = 8.0;
/// Number of plane waves in the curtains' pattern.
pub const CURTAIN_WAVES: usize = 8;
/// Distance from the eye at which curtains begin, m. Nearer rain is drawn as single drops or cones. This is
/// `CURTAIN_START` of `shaders/fog/patterns.wgsl`.
pub const CURTAIN_START_M: f64 = 30.0;

/// Curtains of rain. The extinction is that of even precipitation times (1 + `amount` x the sum of the waves' cosines).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curtains {
    /// Amplitude of each wave relative to the extinction of all that falls; 0 without curtains.
    pub amount: f64,
    /// Wave vectors (east, north, up), 1/m, and phases at the camera, rad.
    pub waves: [(DVec3, f64); CURTAIN_WAVES],
}

impl Curtains {
    /// Even rain, without curtains.
    pub const NONE: Self = Self { amount: 0.0, waves: [(DVec3::ZERO, 0.0); CURTAIN_WAVES] };

    /// Returns two numbers for the ray between two distances: the change of the optical depth by curtains, relative to
    /// that of even rain, and the variance of this change over all places. Both include only the stretch of the ray
    /// beyond [`CURTAIN_START_M`].
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

    /// Returns the optical depth with curtains where even rain has `depth`. Half the variance v of the depth is added,
    /// so that the mean transmittance over all places, and with it the visibility, equals that of even rain. For a
    /// normally distributed depth x with the mean m, mean(exp(-x)) = exp(v / 2 - m).
    pub fn depth(&self, depth: f64, (added, variance): (f64, f64)) -> f64 {
        (depth * (1.0 + added)).max(0.0) + 0.5 * depth * depth * variance
    }
}

/// Returns the mean of a wave's cosine along a ray between the distances `middle` - `half` and `middle` + `half`, m.
/// Also returns the amplitude of this mean.
pub(super) fn wave_mean(
    (wave, phase): (DVec3, f64),
    origin: DVec3,
    direction: DVec3,
    middle: f64,
    half: f64,
) -> (f64, f64) {
    let along = wave.dot(direction);
    let x = along * half;
    // Rows of the pattern do not go on for ever: a long ray along one row meets others, so the wave fades with length.
    let size = sinc(x) * PATCH_ROW / (PATCH_ROW + wave.length() * half);
    ((phase + wave.dot(origin) + along * middle).cos() * size, size)
}
