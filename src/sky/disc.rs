//! Optical depth of the air in front of the discs of sun and moon above the eye's level. It is a function of the sine
//! of elevation over a short interval that contains the visible disc, so that a pixel of the sky needs no integral
//! along its path.
//!
//! # Model
//! Refraction lifts a disc by less than 0.6 degrees. The light of each point of the disc passes through the air in the
//! direction in which the point is seen. Within the interval the logarithm of the depth is a cubic polynomial in the
//! square root of the relative position. It passes through four depths of the reference (`reference::ray`).
//!
//! # Error
//! The relative error of the transmittance is below 0.5 % anywhere on a disc of the sun's size, and below 6 % on a disc
//! of 11 degrees (test). The test counts a transmittance below 0.1 % as 0.1 % on the former disc, and one below 10 % as
//! 10 % on the latter.

use super::{
    reference::ray::Ray,
    uniforms::{AirUniform, LampUniform},
};

/// Largest lift by refraction, rad.
const LIFT: f64 = 0.0105;
/// Sine of elevation above which the lift is less than the interval's margin.
const NOT_LIFTED: f64 = 0.2;
/// Tolerances of the interval. The first is its margin beyond the disc on both sides. The second is the largest sum of
/// the changes of the lamp's sine of elevation and of its radius, rad, for which the interval is kept.
const ROOM: (f64, f64) = (2e-3, 1e-3);
/// Change of altitude after which the depth is computed again: a share of the altitude plus a number of m.
const CLIMB: (f64, f64) = (1e-3, 1.0);
/// Smallest depth, which keeps the logarithm finite.
const LEAST: f64 = 1e-9;

/// Optical depth in front of a lamp's disc.
#[derive(Clone, Copy)]
pub(super) struct DiscDepth {
    /// Inputs for which the depth was computed: air, altitude, and sine of elevation and angular radius of the lamp.
    air: AirUniform,
    altitude_m: f64,
    sine: f64,
    radius: f64,
    /// Sine of elevation at which the interval begins.
    from: f64,
    /// Reciprocal of the interval's length.
    scale: f64,
    /// Coefficients of the logarithm of the depth, by degree and wavelength.
    terms: [[f64; 3]; 4],
}

impl DiscDepth {
    /// Computes the depth in front of a lamp's disc with a sine of elevation and an angular radius, rad.
    pub fn new(air: &AirUniform, altitude_m: f64, sine: f64, radius: f64) -> Self {
        let medium = air.medium();
        let lift = if sine < NOT_LIFTED { LIFT } else { 0.0 };
        let from = (sine - radius - ROOM.0).clamp(0.0, 1.0);
        let to = (sine + radius + lift + ROOM.0).min(1.0);
        let span = (to - from).max(ROOM.0);
        let log = |i: usize| {
            let ray = Ray::new(&medium, altitude_m, from + span * (i as f64 / 3.0).powi(2));
            let columns = if altitude_m < medium.top_m { ray.columns_to_space(&medium) } else { [0.0; 3] };
            medium.optical_depth(&columns).map(|depth| depth.max(LEAST).ln())
        };
        let at: [[f64; 3]; 4] = std::array::from_fn(log);
        // Cubic polynomial through values at 0, 1/3, 2/3 and 1.
        const FIT: [[f64; 4]; 4] =
            [[1.0, 0.0, 0.0, 0.0], [-5.5, 9.0, -4.5, 1.0], [9.0, -22.5, 18.0, -4.5], [-4.5, 13.5, -13.5, 4.5]];
        let terms = FIT.map(|row| std::array::from_fn(|c| (0..4).map(|i| row[i] * at[i][c]).sum()));
        Self { air: *air, altitude_m, sine, radius, from, scale: 1.0 / span, terms }
    }

    /// Whether the stored depth is still accurate enough for these inputs.
    pub fn serves(&self, air: &AirUniform, altitude_m: f64, sine: f64, radius: f64) -> bool {
        self.air == *air
            && (self.sine - sine).abs() + (self.radius - radius).abs() <= ROOM.1
            && (self.altitude_m - altitude_m).abs() <= CLIMB.0 * altitude_m + CLIMB.1
    }

    pub fn write(&self, lamp: &mut LampUniform) {
        (lamp.depth_from, lamp.depth_scale) = (self.from as f32, self.scale as f32);
        lamp.depth = self.terms.map(|[a, b, c]| [a as f32, b as f32, c as f32, 0.0]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{planet::Planet, sky::reference::medium::Medium};

    /// The distances of sun and moon change continuously, and with them the sizes of their discs.
    #[test]
    fn the_depth_of_a_disc_is_reused_while_the_disc_hardly_changes() {
        let air = AirUniform::of(&Planet::earth());
        let depth = DiscDepth::new(&air, 50.0, 0.5, 0.00465);
        assert!(depth.serves(&air, 50.0, 0.5, 0.00465 * (1.0 + 1e-11)), "a moment later");
        assert!(depth.serves(&air, 50.0, 0.5004, 0.005));
        assert!(!depth.serves(&air, 50.0, 0.5004, 0.0054), "by place and size together");
        assert!(!depth.serves(&air, 50.0, 0.5, 0.1));
    }

    #[test]
    fn the_air_before_a_disc_is_that_of_its_height() {
        let planet = Planet::earth();
        let (air, medium) = (AirUniform::of(&planet), Medium::of(&planet));
        let mut worst = [0.0f64; 2];
        for (radius, at) in [(0.00465, 0), (0.1, 1)] {
            for altitude_m in [0.0, 100.0, 3000.0, 12e3, 90e3, 4e5] {
                for sine in [-0.01, -0.002, 0.0, 0.004, 0.01, 0.03, 0.1, 0.19, 0.21, 0.5, 0.9, 0.999] {
                    let depth = DiscDepth::new(&air, altitude_m, sine, radius);
                    for k in -10..=10 {
                        // Refraction lifts the disc near the horizon.
                        let lift = if sine < 0.03 { 0.009 } else { 0.0 };
                        let seen: f64 = sine + lift + radius * f64::from(k) / 10.0;
                        if !(0.0..=1.0).contains(&seen) {
                            continue;
                        }
                        let x = ((seen - depth.from) * depth.scale).clamp(0.0, 1.0).sqrt();
                        let ray = Ray::new(&medium, altitude_m, seen);
                        let columns = if altitude_m < medium.top_m { ray.columns_to_space(&medium) } else { [0.0; 3] };
                        for (c, exact) in medium.optical_depth(&columns).into_iter().enumerate() {
                            let log = (0..4).rev().fold(0.0, |sum, i| sum * x + depth.terms[i][c]);
                            let (drawn, exact) = ((-log.exp()).exp(), (-exact).exp());
                            worst[at] = worst[at].max((drawn - exact).abs() / exact.max([1e-3, 0.1][at]));
                        }
                    }
                }
            }
        }
        println!("transmittance: off by {:.4} before the sun, {:.4} before a disc of 11 degrees", worst[0], worst[1]);
        assert!(worst[0] < 5e-3 && worst[1] < 0.06, "{worst:?}");
    }
}
