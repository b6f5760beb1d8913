//! How much flakes stand out of a picture, in closed form, for the planner.
//!
//! Flakes are thrown at random, so the variance of what they hide from pixel to pixel is the sum of their squared
//! covers (Campbell 1909). A flake that hides an area A, drawn L long and w wide at a distance r, hides on the mean A /
//! ((L + w) w) of that; n / k a volume, each standing for k, make (n / k) (k A)^2 / ((L + w) w) dr. The mean square of
//! a disc's chords is 32 / (3 pi^2) = 1.08 times the square of their mean. Unlike drops flakes are summed over
//! distances, since a farther shell's stand for more.

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

/// Panels of the sum over distances.
const PANELS: usize = 24;

/// Variance from pixel to pixel of the share that flakes hide, for a camera whose pixels span an angle (rad) and before
/// which they move `along_m` across the line of sight during the exposure.
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
    /// For a camera; the light is exposed, and passed through what the picture has been.
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

    /// Returns the change that flakes make to pixel number `i` of a picture without flakes, over the pixel's luminance
    /// and a hundredth of white, beside what the veil in their place adds. `picture` and `hidden` are its luminance
    /// without flakes and the optical depth of what they hide.
    pub fn change(&self, i: usize, ndc: DVec2, [picture, hidden]: [f64; 2]) -> [f32; MOST_RUNGS - 1] {
        let [flakes, contrast] = self.seen.at(i, ndc, picture, |d| flake_radiance(&self.light, d));
        [(flakes - hidden * contrast) as f32, 0.0, 0.0]
    }
}
