//! Contrast of a black target against the fog behind it, and the light of nearly level directions over dark ground.

use glam::DVec3;
use welkin::fog::reference::{FogModel, fog_along};
use welkin::fog::{FogLight, Law, Phase, koschmieder_extinction_per_m};
use welkin::scene::depth::RANGE_SKY_M;

use super::light::{GROUND, droplet_case, model};
use super::path::{EARTH_M, slab, view};
use super::slab;

fn light(elevation_deg: f64, sun: f64, sky: f64) -> FogLight {
    let (s, c) = elevation_deg.to_radians().sin_cos();
    FogLight {
        to_sun: DVec3::new(c, 0.0, s),
        sun_irradiance: [sun; 3],
        sky_irradiance: [sky; 3],
        ground_albedo: [0.15; 3],
    }
}

fn along(m: &FogModel, azimuth: f64, mu: f64, range: f64) -> [f64; 2] {
    let s = (1.0 - mu * mu).sqrt();
    let f = fog_along(m, DVec3::ZERO, DVec3::new(s * azimuth.cos(), s * azimuth.sin(), mu), range, range);
    [f.radiance.y, f.transmittance.y]
}

/// A black board against the same ray continued through the fog shows Koschmieder's contrast, e^(-sigma d), within a
/// tenth or within a step of an 8-bit picture: high and low sun and overcast, looking level, up and down, also where
/// the ground falls away below the station's.
#[test]
fn a_black_board_keeps_koschmieders_contrast() {
    let lights = [light(50.0, 0.8, 0.15), light(6.0, 0.4, 0.06), light(40.0, 0.0, 0.3)];
    for v in [50.0, 150.0, 400.0] {
        let sigma = koschmieder_extinction_per_m(v);
        // First case: the eye is in the middle of deep fog. Second case: the eye is just above the ground, and some
        // boards stand in a hollow below it. Below the known ground the light field is only an estimate.
        for (ground, eye, allowed) in [(-1.0, 0.5, [0.1, 0.006]), (0.0, 0.02, [0.2, 0.05])] {
            for light in lights {
                let top = 2.0 * v;
                let view = welkin::fog::Viewpoint { ground_m: ground * v, ..view(eye * v, EARTH_M) };
                let m = FogModel::new(&Law::Layer(slab(v, -1e4, top, 0.2 * top)), &light, &view).unwrap();
                for azimuth in [0.9f64, 1.6, 3.1] {
                    for degrees in [-5.0f64, -2.0, -1.0, 0.0, 1.0, 2.0, 5.0] {
                        let mu = degrees.to_radians().sin();
                        for share in [0.2, 0.5, 1.0, 4.0 / 3.0, 2.0] {
                            let d = share * v;
                            let [board, t] = along(&m, azimuth, mu, d);
                            let [behind, _] = along(&m, azimuth, mu, d + 4.0 * v);
                            let koschmieder = (-sigma * d).exp();
                            let contrast = (behind - board) / behind;
                            let name =
                                format!("V {v} ground {ground} {degrees} deg, azimuth {azimuth}, {d} m, {light:?}");
                            assert!((t / koschmieder - 1.0).abs() < 1e-3, "{name}: T {t} of {koschmieder}");
                            assert!(
                                (contrast - koschmieder).abs() < allowed[0] * koschmieder + allowed[1],
                                "{name}: contrast {contrast} of {koschmieder}"
                            );
                        }
                    }
                }
            }
        }
    }
}

/// In nearly level directions and near the ground the radiance changes within degrees from dark to bright, as adding
/// and doubling computes it. The fog below the eye is as deep as a hand's height up to a tower's.
#[test]
fn light_near_the_level_follows_adding_and_doubling() {
    let phase = Phase::Droplets { diameter_um: 15.0 };
    let (cut, scale) = droplet_case(phase);
    let (x, _) = slab::gauss();
    let mut logs = Vec::new();
    for total in [0.5, 1.2, 4.0] {
        for (mu0, light) in [(0.2f64, [0.5, 0.1]), (0.9, [0.85, 0.15]), (0.5, [0.0, 0.3])] {
            for below in [0.034, 0.12, 0.4] {
                let share = 1.0 - below / total;
                let (above, below) = (scale * total * share, scale * below);
                let case = slab::Case {
                    moments: &cut,
                    albedo: 1.0,
                    above,
                    below,
                    mu0,
                    sun: light[0],
                    sky: light[1],
                    ground: GROUND,
                };
                let truth = case.solve(&[1.6]);
                let m = model(total, share, mu0, light, phase);
                for (i, &x) in x.iter().enumerate().take(5) {
                    for (mu, want, behind) in
                        [(x, truth.down[0][i], m.sky_radiance.y), (-x, truth.up[0][i], m.ground_radiance.y)]
                    {
                        let [l, t] = along(&m, 1.6, mu, RANGE_SKY_M);
                        logs.push(((l + t * behind) / want).ln());
                    }
                }
            }
        }
    }
    let n = logs.len() as f64;
    let bias = logs.iter().sum::<f64>() / n;
    let spread = (logs.iter().map(|l| l * l).sum::<f64>() / n).sqrt();
    println!("near the level: bias {bias:+.3}, rms {spread:.3}");
    assert!(bias.abs() < 0.05 && spread < 0.12, "bias {bias} rms {spread}");
}
