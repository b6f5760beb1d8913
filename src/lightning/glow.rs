//! Glow around a flash, in f64: the reference of `shaders/between/flash.wgsl`.

use std::f64::consts::PI;

#[cfg(test)]
use super::query::TAKES;
use super::sources::LightSource;

/// Reflectance of the clouds' base for light of a flash below it.
const BASE_REFLECTS: f64 = 0.8;
/// Asymmetry of the phase function of air and rain: `FLASH_ASYMMETRY` of `shaders/between/flash.wgsl`.
#[cfg(test)]
const ASYMMETRY: f64 = 0.75;

/// Returns the luminous intensity, cd, of the visible side of the clouds in the light of a source: `k` of the shader.
/// Seen from below, it is the light that leaves through the base, or that the base reflects. Seen from above, it is the
/// light that leaves through the top; the top reflects none.
pub(super) fn from_clouds_cd(source: &LightSource, from_below: bool) -> f64 {
    match (source.is_hidden(), from_below) {
        (true, true) => source.flux_lm * source.down_share / (2.0 * PI * PI),
        (true, false) => source.flux_lm * (1.0 - source.down_share) / (2.0 * PI * PI),
        (false, true) => source.flux_lm / (4.0 * PI) * BASE_REFLECTS / PI,
        (false, false) => 0.0,
    }
}

/// Returns the luminance of the visible side of the clouds, cd/m2. `h` is the distance of a source from this side, `r`
/// the distance along it, and `k` the intensity, cd.
#[cfg(test)]
fn on_clouds(k: f64, h: f64, r: f64) -> f64 {
    k * h / (r * r + h * h).powf(1.5)
}

/// Returns the luminance, cd/m2, of the light that air with `scattering_per_m` between the eye and the distance `range`
/// scatters once towards the eye. The source of 1 cd lies at the distance `along` in the ray's direction and `h` beside
/// the ray, m. `steps` is the number of samples of the angle.
#[cfg(test)]
fn in_air(scattering_per_m: f64, (along, h): (f64, f64), range: f64, steps: u32) -> f64 {
    let phase = |c: f64| {
        let d = 1.0 + ASYMMETRY * ASYMMETRY - 2.0 * ASYMMETRY * c;
        (1.0 - ASYMMETRY * ASYMMETRY) / (4.0 * PI * d.powf(1.5))
    };
    let first = (-along / h).atan();
    let whole = ((range - along) / h).atan() - first;
    let one = |k: u32| {
        // Samples are denser at the near end, where light is hardly turned.
        let t = (f64::from(k) + 0.5) / f64::from(steps);
        let u = first + whole * t * t;
        2.0 * t * phase(-u.sin()) * (-TAKES * scattering_per_m * (along + h * u.tan() + h / u.cos())).exp()
    };
    (0..steps).map(one).sum::<f64>() * whole / f64::from(steps) / h * scattering_per_m
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The integral of the base's light is the flux that leaves through the base.
    #[test]
    fn the_clouds_base_sends_the_light_that_leaves_by_it() {
        let source = LightSource { flux_lm: 1e9, depth_m: 800.0, down_share: 0.9, ..LightSource::default() };
        let k = from_clouds_cd(&source, true);
        let (step, mut sum) = (10.0, 0.0);
        for i in 0..200_000 {
            let r = (f64::from(i) + 0.5) * step;
            sum += PI * on_clouds(k, source.depth_m, r) * 2.0 * PI * r * step;
        }
        assert!((sum / 0.9e9 - 1.0).abs() < 0.01, "{sum}");
        let up = from_clouds_cd(&source, false);
        assert!((up / k - 0.1 / 0.9).abs() < 1e-9);
    }

    /// Four samples of the angle are within 10 % of a fine sum, near the flash and away from it.
    #[test]
    fn four_samples_are_enough_for_the_airs_glow() {
        for (along, h, range) in
            [(3000.0, 300.0, 1e4), (3000.0, 2000.0, 1e4), (1000.0, 100.0, 900.0), (-2000.0, 1500.0, 2e4)]
        {
            for scattering in [1e-5, 1e-4, 1e-3] {
                let [few, many] = [4, 4000].map(|n| in_air(scattering, (along, h), range, n));
                assert!((few / many - 1.0).abs() < 0.1, "{along} {h} {scattering}: {few} of {many}");
            }
        }
    }
}
