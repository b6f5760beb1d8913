//! Light from a drop: the images of sky and ground in it, small and upside down, and the light of sun or moon through
//! it.

use std::f64::consts::PI;

use glam::DVec3;

pub use crate::moment::LightAround as DropLight;

/// Returns the phase function of a drop, whose integral over all directions is 4 pi. `c` is the cosine of the
/// scattering angle: 1 for light from straight behind the drop. The function is 0.93 h(0.9) + 0.07 h(-0.35) with the
/// lobe h(g) = (1 - g^2) / (1 + g^2 - 2 g c)^1.5 of Henyey and Greenstein (1941). The first lobe is that of the rays
/// through the sphere, the second that of the backward share that makes rainbows. The asymmetry is 0.93 x 0.9 - 0.07 x
/// 0.35 = 0.81. `drop_phase` in `shaders/rain/phase.wgsl` computes the same in f32.
pub fn phase(c: f64) -> f64 {
    let lobe = |g: f64| (1.0 - g * g) / (1.0 + g * g - 2.0 * g * c).powf(1.5);
    0.93 * lobe(0.9) + 0.07 * lobe(-0.35)
}

/// Returns the share of light from above the horizon in a drop seen along a ray whose sine of elevation is `z`: 0.5 +
/// sign(z) 0.4415 (1 - (1 - |z|)^2.5). The rest is light from below the horizon.
///
/// Most of a drop's disc shows the surroundings near the ray's own direction, upside down: half of the disc turns rays
/// by less than 26 degrees, its rim by 83 degrees. A drop slightly above the horizon therefore already shows more sky
/// than ground. The formula is fitted to rays refracted and reflected by the laws of Snell and Fresnel, within 0.01
/// (`tests/rain/photometry.rs`). `sky_share` in `shaders/rain/phase.wgsl` computes the same in f32.
pub fn sky_share(z: f64) -> f64 {
    let level = 1.0 - z.abs().min(1.0);
    0.5 + z.signum() * 0.4415 * (1.0 - level * level * level.sqrt())
}

impl DropLight {
    /// Returns the radiance of a drop seen along the unit vector `d`, without lamps.
    pub fn radiance(&self, d: DVec3) -> DVec3 {
        self.below.lerp(self.above, sky_share(d.z)) + self.sun * (phase(d.dot(self.to_sun)) / (4.0 * PI))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drop_scatters_all_that_it_does_not_let_by() {
        let n = 20_000;
        let sum: f64 =
            (0..n).map(|i| phase(-1.0 + 2.0 * (f64::from(i) + 0.5) / f64::from(n))).sum::<f64>() / f64::from(n);
        assert!((sum - 1.0).abs() < 1e-3, "{sum}");
    }
}
