//! Halo of 22 degrees that ice crystals make around the sun or moon, in f64. `shaders/clouds/halo.wgsl` has the same
//! formulas.
//!
//! # Model
//! Light that enters one side of a hexagonal crystal and leaves through the next side but one is refracted as by a
//! prism of 60 degrees. For refractive index n the deflection is at least 2 asin(n / 2) - 60 degrees (Minnaert 1954,
//! section 134), and little more for most of the light. Over randomly oriented crystals the light begins with a step at
//! that angle. Beyond the step it falls off nearly exponentially, to 1/e in 4.1 degrees; the test traces light through
//! prisms. Ice refracts blue more than red, so the halo is red inside. The sun's disc blurs the step.
//!
//! Rough crystals make no halo. In cirrus with a visible halo 37 % of the crystals were smooth (Forster and Mayer
//! 2022), and one cirrus in four had a halo (Forster et al. 2017). Here a fifth of the crystals are smooth. Half of
//! what a crystal scatters is diffracted around it and goes nearly straight on (Babinet). 39 % of the light that falls
//! on the sides of a long prism goes into the halo.
//!
//! Only light that is scattered once shows the halo.

use std::f64::consts::PI;

use super::transport::Scattering;

use crate::numerics::smooth;

/// Refractive index of ice at 610, 550 and 460 nm (Warren and Brandt 2008, table 1, to three digits).
const INDEX: [f64; 3] = [1.309, 1.311, 1.315];
/// Angle over which the light falls to 1/e, rad.
const FALL_RAD: f64 = 0.0716;
/// Angular radius of the disc that blurs the step, rad.
const DISC_RAD: f64 = 0.0047;
/// Share of the light scattered by ice that goes into the halo: a fifth of the crystals, half of their light, 39 % of
/// that.
pub const SHARE: f64 = 0.2 * 0.5 * 0.39;

/// Returns the smallest deflection by a prism of 60 degrees, rad.
pub fn least_turn(index: f64) -> f64 {
    2.0 * (0.5 * index).asin() - PI / 3.0
}

/// Returns the phase function of the halo's light alone, 1/sr, at a scattering angle, rad.
pub fn phase(index: f64, angle: f64) -> f64 {
    let first = least_turn(index);
    // Integral of exp(-(angle - first) / fall) over the sphere.
    let all = 2.0 * PI * FALL_RAD * (first.sin() + FALL_RAD * first.cos()) / (1.0 + FALL_RAD * FALL_RAD);
    let begun = ((angle - first) / (2.0 * DISC_RAD) + 0.5).clamp(0.0, 1.0);
    smooth(begun) * (-(angle - first).max(0.0) / FALL_RAD).exp() / all
}

/// Returns the amount that the halo adds to the phase function of ice without the forward peak, 1/sr, for red, green
/// and blue, at this cosine of the scattering angle. It is negative away from the halo.
pub fn excess(scattering: &Scattering, cosine: f64) -> [f64; 3] {
    let angle = cosine.clamp(-1.0, 1.0).acos();
    let smooth = scattering.smooth_phase(1.0 - cosine);
    INDEX.map(|index| SHARE * (phase(index, angle) / (1.0 - scattering.forward) - smooth))
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3, Vec3Swizzles};

    use super::*;
    use crate::{chance::RandomStream, gpu::shader};

    const SIDES: usize = 6;

    fn side(k: usize) -> DVec2 {
        DVec2::from_angle(k as f64 * PI / 3.0)
    }

    /// Returns the transmittance of an ice surface for unpolarised light (Fresnel).
    fn through(cos_in: f64, cos_out: f64, n: f64) -> f64 {
        let (s, p) = ((cos_in - n * cos_out) / (cos_in + n * cos_out), (cos_out - n * cos_in) / (cos_out + n * cos_in));
        1.0 - 0.5 * (s * s + p * p)
    }

    /// Traces light of direction `d` that enters side `k` of a long hexagonal prism at a place of it, from -1/2 to 1/2.
    /// Returns the deflection and the weight if the light leaves through the next side but one.
    fn turned(d: DVec3, k: usize, place: f64, n: f64) -> Option<(f64, f64)> {
        let normal = side(k).extend(0.0);
        let cos_in = -d.dot(normal);
        let inside = (1.0 - (1.0 - cos_in * cos_in) / (n * n)).sqrt();
        let t = d / n + normal * (cos_in / n - inside);
        let at = side(k) + side(k).perp() * place * 2.0 / 3f64.sqrt();
        let way = |j: usize| (1.0 - at.dot(side(j))) / t.truncate().dot(side(j)).max(1e-12);
        let leaves = (0..SIDES).filter(|j| *j != k).min_by(|i, j| way(*i).total_cmp(&way(*j)))?;
        let normal = side(leaves).extend(0.0);
        let (cos_out, between) = (t.dot(normal), (leaves + SIDES - k) % SIDES);
        let sine2 = n * n * (1.0 - cos_out * cos_out);
        if !(between == 2 || between == 4) || sine2 >= 1.0 {
            return None;
        }
        let free = (1.0 - sine2).sqrt();
        let out = n * t + normal * (free - n * cos_out);
        let weight = cos_in * through(cos_in, inside, n) * through(free, cos_out, n);
        Some((out.dot(d).clamp(-1.0, 1.0).acos(), weight))
    }

    #[test]
    fn light_through_prisms_turned_in_all_ways_falls_off_so() {
        const BIN_RAD: f64 = 0.0087;
        let (n, mut chance) = (INDEX[1], RandomStream::new(3, 0));
        let (mut bins, mut halo, mut all) = ([0.0; 40], 0.0, 0.0);
        for _ in 0..400_000 {
            let (up, azimuth) = (2.0 * chance.even() - 1.0, 2.0 * PI * chance.even());
            let d = (DVec2::from_angle(azimuth) * (1.0 - up * up).sqrt()).extend(up);
            for k in (0..SIDES).filter(|k| d.xy().dot(side(*k)) < 0.0) {
                all -= d.xy().dot(side(k));
                if let Some((angle, weight)) = turned(d, k, chance.even() - 0.5, n) {
                    halo += weight;
                    let bin = ((angle - least_turn(n)) / BIN_RAD) as usize;
                    if let Some(b) = bins.get_mut(bin) {
                        *b += weight;
                    }
                }
            }
        }
        println!("halo: {:.3} of what falls on the sides", halo / all);
        assert!((halo / all - 0.39).abs() < 0.005, "{}", halo / all);
        for (i, weight) in bins.iter().enumerate().take(17) {
            let angle = least_turn(n) + (i as f64 + 0.5) * BIN_RAD;
            let followed = weight / (halo * 2.0 * PI * angle.sin() * BIN_RAD);
            let said = phase(n, angle.max(least_turn(n) + DISC_RAD));
            println!("{:.1} degrees: {followed:.3} followed, {said:.3} said", angle.to_degrees());
            assert!((said / followed - 1.0).abs() < 0.12, "{angle}: {followed} {said}");
        }
    }

    #[test]
    fn the_halo_is_red_inside_and_neither_adds_nor_takes_light() {
        let [red, green, blue] = INDEX.map(|n| least_turn(n).to_degrees());
        assert!((21.6..21.9).contains(&red) && red < green && green < blue && blue < 22.4, "{red} {green} {blue}");
        let n = 200_000;
        let sum = |index| {
            let at = |i: i32| (f64::from(i) + 0.5) / f64::from(n) * PI;
            (0..n).map(|i| phase(index, at(i)) * at(i).sin()).sum::<f64>() * 2.0 * PI * PI / f64::from(n)
        };
        for index in INDEX {
            assert!((sum(index) - 1.0).abs() < 0.01, "{index}: {}", sum(index));
        }
    }

    #[test]
    fn the_shader_has_the_same_numbers() {
        let text = shader::assemble("clouds/march_view.wgsl").unwrap();
        let all = |n: f64| {
            let first = least_turn(n);
            2.0 * PI * FALL_RAD * (first.sin() + FALL_RAD * first.cos()) / (1.0 + FALL_RAD * FALL_RAD)
        };
        let [r, g, b] = INDEX.map(least_turn);
        for line in [
            format!("const HALO_FROM: vec3f = vec3f({r:.5}, {g:.5}, {b:.5});"),
            format!("const HALO_FALL: f32 = {FALL_RAD};"),
            format!("const HALO_DISC: f32 = {DISC_RAD};"),
            format!("const HALO_SHARE: f32 = {SHARE:.3};"),
            format!(
                "const HALO_MOST: vec3f = vec3f({:.4}, {:.4}, {:.4});",
                1.0 / all(INDEX[0]),
                1.0 / all(INDEX[1]),
                1.0 / all(INDEX[2])
            ),
        ] {
            assert!(text.contains(&line), "{line}");
        }
    }
}
