//! Reference of the shaders of snow, in f64: the light that a flake scatters, and the sky that it passes on.

use glam::DVec3;

use crate::moment::LightAround;

/// Asymmetry of what a flake's ice scatters beside diffraction.
///
/// Aggregates of ice crystals have an asymmetry of about 0.77 in visible light (Raisanen et al. 2015 fit 0.78 to
/// measurements of blowing snow). Half of what a large particle takes from a beam is diffraction, straight on: (0.77 -
/// 0.5) / 0.5 is left for the rest.
pub const ASYMMETRY: f64 = 0.54;

/// Returns the light that a flake scatters of a beam at the cosine `c`, 1 straight on; 4 pi on the whole. Ice takes
/// next to nothing of visible light.
pub fn flake_phase(c: f64) -> f64 {
    let g = ASYMMETRY;
    (1.0 - g * g) / (1.0 + g * g - 2.0 * g * c).powf(1.5)
}

/// The share of what surrounds a flake above the horizon in what it sends along a ray that rises by a sine `z`:
/// [`flake_phase`] over a half space. By the Legendre series of both, 1/2 + (3/4) g z - (7/16) g^3 P3(z), cut there;
/// within 0.02 of the integral.
pub fn flake_sky_share(z: f64) -> f64 {
    0.5 + z * (0.50835 - 0.17222 * z * z)
}

/// Radiance of a flake seen along the unit vector `d`, without lamps.
pub fn flake_radiance(light: &LightAround, d: DVec3) -> DVec3 {
    light.below.lerp(light.above, flake_sky_share(d.z))
        + light.sun * (flake_phase(d.dot(light.to_sun)) / (4.0 * std::f64::consts::PI))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flake_gives_back_all_light_and_half_a_space_is_its_share_of_it() {
        let n = 400;
        let mid = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
        let whole: f64 = (0..n * 20).map(|i| flake_phase(-1.0 + 2.0 * (f64::from(i) + 0.5) / f64::from(n * 20))).sum();
        assert!((whole / f64::from(n * 20) - 1.0).abs() < 1e-4);
        for z in [-1.0, -0.6, -0.2, 0.0, 0.3, 0.7, 1.0f64] {
            let d = DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
            let mut sum = 0.0;
            for i in 0..n {
                let up = mid(i);
                let level = (1.0 - up * up).sqrt();
                for j in 0..n {
                    let (sin, cos) = libm::sincos(std::f64::consts::TAU * mid(j));
                    sum += flake_phase(d.dot(DVec3::new(level * cos, level * sin, up)));
                }
            }
            let share = 0.5 * sum / f64::from(n * n);
            assert!((flake_sky_share(z) - share).abs() < 0.02, "{z}: {} of {share}", flake_sky_share(z));
        }
        let even = LightAround { above: DVec3::ONE, below: DVec3::ONE, sun: DVec3::ZERO, to_sun: DVec3::Z };
        assert!((flake_radiance(&even, DVec3::new(0.6, 0.0, 0.8)) - DVec3::ONE).length() < 1e-12);
    }
}
