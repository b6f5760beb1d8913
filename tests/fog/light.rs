//! Error of the radiance in the layer against adding and doubling.

use glam::DVec3;
use welkin::fog::reference::{FogModel, fog_along};
use welkin::fog::{FogLayer, FogLight, Law, Phase, Profile, Viewpoint};
use welkin::light::phase::{PhaseLobes, lobes_phase};
use welkin::scene::depth::RANGE_SKY_M;

use super::slab::{self, Case, N};

const AZIMUTHS: [f64; 4] = [0.0, 0.6, 1.6, 3.1];
pub const GROUND: f64 = 0.15;
const SIGMA: f64 = 0.01;

/// A layer of optical depth `depth`, lit by (sun, sky) with the sun at the zenith cosine `mu0`, seen from the height
/// `share` of it.
pub fn model(depth: f64, share: f64, mu0: f64, [sun, sky]: [f64; 2], phase: Phase) -> FogModel {
    let top = depth / SIGMA;
    let layer = FogLayer {
        extinction_per_m: SIGMA,
        angstrom: 0.0,
        albedo: [1.0; 3],
        profile: Profile::Slab { base_m: -1.0, top_m: top, base_softness_m: 0.0, top_softness_m: 0.0 },
        phase,
        patches: None,
    };
    let light = FogLight {
        to_sun: DVec3::new((1.0 - mu0 * mu0).sqrt(), 0.0, mu0),
        sun_irradiance: [sun; 3],
        sky_irradiance: [sky; 3],
        ground_albedo: [GROUND; 3],
    };
    FogModel::new(&Law::Layer(layer), &light, &Viewpoint::flat(top * (1.0 - share))).unwrap()
}

/// Legendre moments of droplets' phase function by quadrature.
fn droplet_moments(lobes: &PhaseLobes) -> Vec<f64> {
    let n = 100_000;
    let (lo, hi) = ((1e-9f64).ln(), 2f64.ln());
    let mut out = vec![0.0; 2 * N + 1];
    for i in 0..n {
        let v = (lo + (hi - lo) * (i as f64 + 0.5) / n as f64).exp();
        let c = 1.0 - v;
        let w = lobes_phase(lobes, 1.0, v) * 2.0 * std::f64::consts::PI * v * (hi - lo) / n as f64;
        let (mut p0, mut p1) = (1.0, c);
        out[0] += w;
        for (l, o) in out.iter_mut().enumerate().skip(1) {
            *o += w * p1;
            let lf = l as f64;
            (p0, p1) = (p1, ((2.0 * lf + 1.0) * c * p1 - lf * p0) / (lf + 1.0));
        }
    }
    out
}

/// Moments of droplets without the forward peak that the reference cannot carry (delta-M), and the depth that is left.
pub fn droplet_case(phase: Phase) -> (Vec<f64>, f64) {
    let full = droplet_moments(&PhaseLobes::new(&phase));
    let f = full[2 * N];
    (full[..2 * N].iter().map(|c| (c - f) / (1.0 - f)).collect(), 1.0 - f)
}

struct Errors {
    all: Vec<f64>,
    means: Vec<f64>,
}

impl Errors {
    fn at(&self, share: f64) -> f64 {
        let mut v: Vec<f64> = self.all.iter().map(|e| e.abs()).collect();
        v.sort_by(f64::total_cmp);
        v[((v.len() - 1) as f64 * share) as usize]
    }

    fn mean_worst(&self) -> f64 {
        self.means.iter().fold(0.0, |a: f64, e| a.max(e.abs()))
    }
}

/// Relative errors of radiance over directions more than 8 degrees off the sun, and of the mean over directions.
fn errors(phase: Phase, moments: &[f64], scale: f64) -> Errors {
    let (x, _) = slab::gauss();
    let mut out = Errors { all: Vec::new(), means: Vec::new() };
    for depth in [0.3, 1.0, 4.0, 16.0] {
        for (mu0, light) in [(0.2f64, [0.5, 0.1]), (0.5, [0.75, 0.15]), (0.9, [0.85, 0.15])] {
            for share in [0.5, 0.95] {
                let (above, below) = (scale * depth * share, scale * depth * (1.0 - share));
                let case =
                    Case { moments, albedo: 1.0, above, below, mu0, sun: light[0], sky: light[1], ground: GROUND };
                let truth = case.solve(&AZIMUTHS);
                let m = model(depth, share, mu0, light, phase);
                let (mut sum_got, mut sum_want) = (0.0, 0.0);
                for (k, phi) in AZIMUTHS.iter().enumerate() {
                    for i in (1..N).step_by(3) {
                        for up in [1.0, -1.0] {
                            let mu = x[i] * up;
                            let s = (1.0 - mu * mu).sqrt();
                            let view = DVec3::new(s * phi.cos(), s * phi.sin(), mu);
                            if view.dot(m.to_sun) > 0.99 {
                                continue;
                            }
                            let f = fog_along(&m, DVec3::ZERO, view, RANGE_SKY_M, RANGE_SKY_M);
                            let behind = if up > 0.0 { m.sky_radiance } else { m.ground_radiance };
                            let got = f.radiance.x + f.transmittance.x * behind.x;
                            let want = if up > 0.0 { truth.down[k][i] } else { truth.up[k][i] };
                            out.all.push(got / want - 1.0);
                            sum_got += got;
                            sum_want += want;
                        }
                    }
                }
                out.means.push(sum_got / sum_want - 1.0);
            }
        }
    }
    out
}

/// Errors that a two-stream source with the true first scattering reaches. In pictures they are less visible than an
/// error of the visibility by a tenth.
#[test]
fn radiance_in_haze_follows_adding_and_doubling() {
    let e = errors(Phase::HenyeyGreenstein { g: 0.85 }, &slab::henyey_greenstein(0.85), 1.0);
    println!("haze: median {:.3}, 95 % {:.3}, mean over directions {:.3}", e.at(0.5), e.at(0.95), e.mean_worst());
    assert!(e.at(0.5) < 0.04 && e.at(0.95) < 0.19 && e.mean_worst() < 0.12);
}

/// Droplets: the reference truncates the forward peak it cannot carry (delta-M), which shows only near the sun.
#[test]
fn radiance_in_droplets_follows_adding_and_doubling() {
    let phase = Phase::Droplets { diameter_um: 15.0 };
    let (cut, scale) = droplet_case(phase);
    let e = errors(phase, &cut, scale);
    println!("droplets: median {:.3}, 95 % {:.3}, mean over directions {:.3}", e.at(0.5), e.at(0.95), e.mean_worst());
    assert!(e.at(0.5) < 0.045 && e.at(0.95) < 0.19 && e.mean_worst() < 0.12);
}

/// No glow: away from the sun, the level view is never much brighter than a white surface turned to the light; no
/// blackening: nor much darker than a layer of its depth transmits.
#[test]
fn fog_neither_glows_nor_blackens() {
    for depth in [0.3, 1.0, 4.0, 16.0, 64.0] {
        for (mu0, light) in [(0.02f64, [0.1, 0.03]), (0.2, [0.5, 0.1]), (0.9, [0.85, 0.15])] {
            for share in [0.02, 0.5, 0.98] {
                let m = model(depth, share, mu0, light, Phase::Droplets { diameter_um: 15.0 });
                let white = (light[0] + light[1]) / std::f64::consts::PI;
                for phi in [0.8, 1.6, 3.1] {
                    let l = |mu: f64| {
                        let s = (1.0 - mu * mu).sqrt();
                        let view = DVec3::new(s * f64::cos(phi), s * f64::sin(phi), mu);
                        fog_along(&m, DVec3::ZERO, view, RANGE_SKY_M, RANGE_SKY_M)
                    };
                    let level = l(0.0);
                    let name = format!("depth {depth} mu0 {mu0} share {share} azimuth {phi}: {level:?}, white {white}");
                    assert!(level.radiance.x < 1.3 * white, "{name}");
                    let through = (light[0] * mu0 + light[1]) / std::f64::consts::PI / (1.0 + depth * share);
                    assert!(level.radiance.x > 0.18 * through, "{name}");
                }
            }
        }
    }
}

#[test]
fn light_scales_with_what_comes_in_and_night_is_dark() {
    let at = |light: [f64; 2]| {
        let m = model(4.0, 0.9, 0.4, light, Phase::Droplets { diameter_um: 15.0 });
        fog_along(&m, DVec3::ZERO, DVec3::Y, RANGE_SKY_M, RANGE_SKY_M).radiance.x
    };
    assert!((at([1e-6, 2e-7]) / at([1.0, 0.2]) - 1e-6).abs() < 1e-15);
    assert_eq!(at([0.0, 0.0]), 0.0);
}
