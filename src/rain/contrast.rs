//! How much the streaks of rain stand out of a picture, in closed form: for the planner, and for whoever asks what
//! drops are worth.
//!
//! Streaks are thrown at random, so the variance of what they hide from pixel to pixel is the sum of their squared
//! covers (Campbell 1909). A drop of diameter D at distance r, drawn L long and w wide (its own width, or what is left
//! of a pixel), hides on the mean its disc over L w of it, across as the chords of a disc, whose mean square is 32 / (3
//! pi^2) = 1.08 times the square of their mean; as many as n a volume r^2 dr make 1.08 n disc^2 / ((L + w) w) dr. With
//! w = D near the eye and w = a r beyond, its integral has a closed form: each doubling of the distance adds as much as
//! the one before.
//!
//! A contrast gain g makes of a streak that hides c one that hides 1 - (1 - c)^g.

use glam::{DVec2, DVec3};

use super::{classes::Classes, light::DropLight};
use crate::{
    particles::{LEAST_PIXELS, StreakCamera, StreakContrast},
    plan::parts::MOST_RUNGS,
    stage::Tone,
};

/// Largest share of the contrast of streaks that cones miss. Their error over that of a veil without any is a tenth of
/// it in the lab's chart (docs/lab/rain.csv: 0.20 % of 2.65 %), where single streaks near the eye hardly count.
const CONES_MISS: f64 = 0.3;

/// Variance from pixel to pixel of the share that drops between two distances (m) hide, for a camera whose pixels span
/// an angle (rad) and before which drops move `along_m` across the line of sight during the exposure, with a contrast
/// gain.
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
        // Up to here it is wider than a pixel.
        let wide = (d / a).clamp(near_m, far_m);
        let antiderivative = |r: f64| libm::log(r / (l + a * r)) / (a * l);
        let beyond = antiderivative(far_m) - antiderivative(wide);
        // Of those that are drawn wider than they are, the one in the middle of the doublings stands for all.
        let w = a * (wide * far_m).sqrt();
        let sum = (wide - near_m) / ((l + d) * d) * gained(d / (l + d), gain).powi(2)
            + beyond * gained(d * d / ((l + w) * w), gain).powi(2);
        1.08 * flux / speed * disc * disc * sum
    };
    classes.flux.iter().filter(|c| c.1 > 0.0).map(|c| of(*c)).sum()
}

/// How many times as much a streak hides that hides `cover` without a gain.
fn gained(cover: f64, gain: f64) -> f64 {
    if gain == 1.0 { 1.0 } else { (1.0 - (1.0 - cover.min(1.0)).powf(gain)) / cover }
}

/// Between which drops are counted, m: where near ones have faded, and up to where they are drawn.
const COUNTED_M: (f64, f64) = (0.2, super::cones::BANDS_M[super::cones::CONES]);

/// Change of a picture by its streaks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Streaks {
    seen: StreakContrast,
    light: DropLight,
}

impl Streaks {
    /// For a camera; the light is exposed, and passed through what the picture has been.
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

    /// Returns the change of pixel number `i` of a picture with cones in place of drops, and without streaks, over its
    /// luminance and a hundredth of white, beside what the veil in their place adds. `picture` and `hidden` are its
    /// luminance without streaks and the optical depth of what they hide.
    pub fn change(&self, i: usize, ndc: DVec2, [picture, hidden]: [f64; 2]) -> [f32; MOST_RUNGS - 1] {
        let [streaks, contrast] = self.seen.at(i, ndc, picture, |d| self.light.radiance(d));
        // On the mean they bring their own light.
        [(CONES_MISS * streaks) as f32, (streaks - hidden * contrast) as f32, 0.0]
    }
}
