//! Contrast that flakes add to a picture, in closed form, for the plan.
//!
//! Flakes lie at random places, so the variance of the covered share from pixel to pixel is the sum of their squared
//! covers (Campbell 1909). A flake that covers the area A at the distance r moves by L during the exposure. It is drawn
//! with the width w and the length L + w. Its mean cover is c = A / ((L + w) w). Across the streak the cover follows
//! the chords of a disc, whose mean square is 32 / (3 pi^2) = 1.08 times the square of their mean. Of n flakes per
//! cubic metre, n / k are drawn, and each of these represents k. The variance is therefore
//!
//! ```text
//! integral of 1.08 (n / k) (k A)^2 / ((L + w) w) dr.
//! ```
//!
//! The formula is summed over the classes of flakes and over the shells. The term of a shell is multiplied by the
//! square of the share that the shell shows at r. The integral is computed numerically, unlike that of drops, because k
//! grows from shell to shell.

use glam::{DVec2, DVec3};

use super::{
    lattice::{CLASSES, Flakes, NEAREST_M, SHELLS, SPEED_UNIT, shell_share},
    reference::flake_radiance,
};
use crate::{
    falling::flakes::seen_area_m2,
    moment::LightAround,
    particles::{LEAST_PIXELS, StreakCamera, StreakContrast},
    plan::parts::MOST_RUNGS,
    stage::Tone,
};

/// Number of panels of the sum over distances, which are evenly spaced in their logarithm.
const PANELS: usize = 24;

/// Returns the variance from pixel to pixel of the share of a pixel that flakes cover. `pixel_angle` is the angle of a
/// pixel, rad; `along_m` is the motion of flakes across the line of sight during the exposure, m.
pub fn cover_variance(flakes: &Flakes, pixel_angle: f64, along_m: f64) -> f64 {
    let step = libm::log(flakes.reach_m().max(NEAREST_M) / NEAREST_M) / PANELS as f64;
    let at = |panel: usize| {
        let r = NEAREST_M * libm::exp((panel as f64 + 0.5) * step);
        let of = |k: usize| {
            let d = f64::from(flakes.table[k][0]);
            let area = seen_area_m2(1e3 * d);
            let w = d.max(LEAST_PIXELS * pixel_angle * r);
            let hides = (0..flakes.shells.min(SHELLS)).map(|s| {
                let share = shell_share(s, r);
                f64::from(flakes.weight[k][s]) * share * share
            });
            1.08 * flakes.number_per_m3[k] * area * area / ((along_m + w) * w) * hides.sum::<f64>()
        };
        (0..CLASSES).map(of).sum::<f64>() * r * step
    };
    (0..PANELS).map(at).sum()
}

/// Contrast of the flakes in a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FlakeContrast {
    seen: StreakContrast,
    light: LightAround,
}

impl FlakeContrast {
    /// Creates the contrast for a camera. `light` includes the exposure; `tone` maps it to the picture's values.
    /// `lamps` says whether there are lamps, which may make flakes arbitrarily bright.
    pub fn new(
        (flakes, wind_m_s): (&Flakes, DVec3),
        shot: &StreakCamera<'_>,
        (light, tone): (LightAround, Tone),
        lamps: bool,
    ) -> Self {
        let fall = DVec3::Z * (f64::from(flakes.table[CLASSES / 3][1]) * SPEED_UNIT);
        let pixel = shot.rays.pixel_angle(shot.height);
        let variance = |along_m: f64| cover_variance(flakes, pixel, along_m);
        Self { seen: StreakContrast::new(shot, wind_m_s - fall, variance, (tone, lamps)), light }
    }

    /// Returns the change of pixel `i` if flakes are left out, as the first number. It is relative to the pixel's
    /// luminance plus a hundredth of white. The light that the fog adds in place of the flakes is not included.
    /// `picture` is the luminance without flakes, `hidden` the optical depth of the flakes.
    pub fn change(&self, i: usize, ndc: DVec2, [picture, hidden]: [f64; 2]) -> [f32; MOST_RUNGS - 1] {
        let [flakes, contrast] = self.seen.at(i, ndc, picture, |d| flake_radiance(&self.light, d));
        [(flakes - hidden * contrast) as f32, 0.0, 0.0]
    }
}
