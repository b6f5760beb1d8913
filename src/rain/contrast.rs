//! Contrast that the streaks of rain add to a picture, in closed form. The plan estimates from it how much drops change
//! a picture.
//!
//! Streaks lie at random places, so the variance of the covered share from pixel to pixel is the sum of their squared
//! covers (Campbell 1909). A drop of diameter D at distance r moves by L during the exposure. Its streak has the length
//! L + w and the width w, where w is the larger of D and a minimum width in pixels. The mean cover over the streak is c
//! = (pi D^2 / 4) / ((L + w) w). Across the streak the cover follows the chords of a disc, whose mean square is 32 / (3
//! pi^2) = 1.08 times the square of their mean. For n drops per cubic metre the variance is therefore
//!
//! ```text
//! integral of 1.08 n (pi D^2 / 4)^2 / ((L + w) w) dr.
//! ```
//!
//! With w = D near the eye and w = a r farther away, where a is the angle of the minimum width, the integral has a
//! closed form: each doubling of the distance adds as much as the one before.
//!
//! A contrast gain g raises a streak's cover from c to 1 - (1 - c)^g.

use glam::{DVec2, DVec3};

use super::{classes::Classes, light::DropLight};
use crate::{
    particles::{LEAST_PIXELS, StreakCamera, StreakContrast},
    plan::parts::MOST_RUNGS,
    stage::Tone,
};

/// Largest share of the streaks' contrast that cones miss. In the lab's chart the error of cones is a tenth of that of
/// rain without streaks (docs/lab/rain.csv: 0.21 % against 2.60 %), but single streaks near the eye hardly affect that
/// chart's error.
const CONES_MISS: f64 = 0.3;

/// Returns the variance, from pixel to pixel, of the share of a pixel that is covered by the drops between two
/// distances (m). `pixel_angle` is the angle of a pixel, rad, `along_m` the distance that drops move across the line of
/// sight during the exposure, m, and `gain` the contrast gain.
pub fn cover_variance(
    classes: &Classes,
    pixel_angle: f64,
    (along_m, gain): (f64, f64),
    (near_m, far_m): (f64, f64),
) -> f64 {
    let a = (LEAST_PIXELS * pixel_angle).max(1e-9);
    let l = along_m.max(1e-4);
    let of = |(diameter_mm, speed, flux): (f64, f64, f64)| {
        let d = 1e-3 * diameter_mm;
        let disc = std::f64::consts::FRAC_PI_4 * d * d;
        // Distance up to which the drop is wider than the least width.
        let wide = (d / a).clamp(near_m, far_m);
        let antiderivative = |r: f64| libm::log(r / (l + a * r)) / (a * l);
        let beyond = antiderivative(far_m) - antiderivative(wide);
        // Width of all drops beyond `wide`, which are drawn wider than they are. It is taken at the geometric mean of
        // `wide` and `far_m`.
        let w = a * (wide * far_m).sqrt();
        let sum = (wide - near_m) / ((l + d) * d) * gained(d / (l + d), gain).powi(2)
            + beyond * gained(d * d / ((l + w) * w), gain).powi(2);
        1.08 * flux / speed * disc * disc * sum
    };
    classes.flux.iter().filter(|c| c.1 > 0.0).map(|c| of(*c)).sum()
}

/// Returns the factor by which the gain g raises a streak's cover c: (1 - (1 - c)^g) / c.
fn gained(cover: f64, gain: f64) -> f64 {
    if gain == 1.0 { 1.0 } else { (1.0 - (1.0 - cover.min(1.0)).powf(gain)) / cover }
}

/// Smallest and largest distance of the drops that are taken into account, m. At about the smallest, near drops have
/// faded in. At the largest, the cones end.
const COUNTED_M: (f64, f64) = (0.2, super::cones::BANDS_M[super::cones::CONES]);

/// Change that streaks make to a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Streaks {
    seen: StreakContrast,
    light: DropLight,
}

impl Streaks {
    /// Creates the change for a camera. `light` includes the exposure; `tone` maps it to the picture's values.
    pub fn new(
        (classes, wind_m_s): (&Classes, DVec3),
        shot: &StreakCamera<'_>,
        (light, tone): (DropLight, Tone),
        lamps: bool,
    ) -> Self {
        let fall = DVec3::Z * classes.flux[classes.flux.len() / 2].1;
        let pixel = shot.rays.pixel_angle(shot.height);
        let variance = |along_m: f64| cover_variance(classes, pixel, (along_m, shot.gain), COUNTED_M);
        Self { seen: StreakContrast::new(shot, wind_m_s - fall, variance, (tone, lamps)), light }
    }

    /// Returns the changes of pixel `i` with cones instead of drops and with no streaks at all, relative to the pixel's
    /// luminance plus a hundredth of white. The light that the fog adds in place of the streaks is not included.
    /// `picture` is the luminance without streaks, `hidden` the optical depth of the streaks.
    pub fn change(&self, i: usize, ndc: DVec2, [picture, hidden]: [f64; 2]) -> [f32; MOST_RUNGS - 1] {
        let [streaks, contrast] = self.seen.at(i, ndc, picture, |d| self.light.radiance(d));
        // Subtracts, for no streaks at all, the mean light that the streaks add.
        [(CONES_MISS * streaks) as f32, (streaks - hidden * contrast) as f32, 0.0]
    }
}
