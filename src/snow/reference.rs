//! Reference of the snow shaders, in f64: the light that a flake scatters, from beams and from the sky and ground.

use glam::DVec3;

use crate::moment::LightAround;

/// Asymmetry of the scattering by a flake's ice, without diffraction.
///
/// Aggregates of ice crystals have an asymmetry of about 0.77 in visible light (Raisanen et al. 2015 fit 0.78 to
/// measurements of blowing snow). Half of the extinction of a large particle is diffraction, which goes straight on.
/// The rest therefore has an asymmetry of (0.77 - 0.5) / 0.5.
pub const ASYMMETRY: f64 = 0.54;

/// Returns the phase function of a flake, whose integral over all directions is 4 pi: (1 - g^2) / (1 + g^2 - 2 g c)^1.5
/// (Henyey and Greenstein 1941) with g = [`ASYMMETRY`]. `c` is the cosine of the scattering angle: 1 is straight on.
/// Absorption is left out, because ice absorbs next to no visible light.
pub fn flake_phase(c: f64) -> f64 {
    let g = ASYMMETRY;
    (1.0 - g * g) / (1.0 + g * g - 2.0 * g * c).powf(1.5)
}

/// Returns the weight of the sky, against the ground, in the light of a flake that is seen along a ray whose sine of
/// elevation is `z`: the integral of [`flake_phase`] over the upper hemisphere, divided by 4 pi. Its Legendre series is
/// `1/2 + (3/4) g z - (7/16) g^3 P3(z) + ..`, with P3(z) = (5 z^3 - 3 z) / 2. The sum of the terms up to P3, which is
/// returned, is within 0.02 of the weight.
pub fn flake_sky_share(z: f64) -> f64 {
    0.5 + z * (0.50835 - 0.17222 * z * z)
}

/// Returns the radiance of a flake seen along the unit vector `d`, without lamps.
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
