//! Optical depth of the layer along rays: closed form against quadrature, flat and on the curved planet.

use glam::DVec3;
use welkin::fog::reference::{FogModel, falling_path, layer_depth_above, layer_path, layer_rise};
use welkin::fog::{FallingLayer, FogLayer, FogLight, Law, Phase, Profile, Viewpoint, koschmieder_extinction_per_m};

pub const EARTH_M: f64 = 6.371e6;

/// Noon light of a clear day, in units of the sun's irradiance.
pub fn noon() -> FogLight {
    FogLight {
        to_sun: DVec3::new(0.3, 0.5, 0.812_403_8).normalize(),
        sun_irradiance: [0.80, 0.78, 0.70],
        sky_irradiance: [0.08, 0.12, 0.20],
        ground_albedo: [0.12, 0.15, 0.10],
    }
}

pub fn view(altitude_m: f64, planet_radius_m: f64) -> Viewpoint {
    Viewpoint { planet_radius_m, ..Viewpoint::flat(altitude_m) }
}

pub fn slab(visibility_m: f64, base: f64, top: f64, soft: f64) -> FogLayer {
    FogLayer {
        profile: Profile::Slab { base_m: base, top_m: top, base_softness_m: soft, top_softness_m: soft },
        ..FogLayer::ground_fog(koschmieder_extinction_per_m(visibility_m), top, soft)
    }
}

pub fn exponential(visibility_m: f64, scale: f64) -> FogLayer {
    FogLayer {
        profile: Profile::Exponential { reference_m: 0.0, scale_height_m: scale },
        phase: Phase::HenyeyGreenstein { g: 0.7 },
        ..slab(visibility_m, 0.0, 1.0, 0.0)
    }
}

pub fn model(layer: FogLayer, view: &Viewpoint) -> FogModel {
    FogModel::new(&Law::Layer(layer), &noon(), view).unwrap()
}

/// Extinction at altitude h by the definition of the profile.
fn extinction(layer: &FogLayer, h: f64) -> f64 {
    let ramp = |x: f64, soft: f64| if soft > 0.0 { (x / soft + 0.5).clamp(0.0, 1.0) } else { f64::from(x > 0.0) };
    layer.extinction_per_m
        * match layer.profile {
            Profile::Slab { base_m, top_m, base_softness_m, top_softness_m } => {
                ramp(h - base_m, base_softness_m) * ramp(top_m - h, top_softness_m)
            }
            Profile::Exponential { reference_m, scale_height_m } => (-(h - reference_m) / scale_height_m).exp(),
        }
}

/// Midpoint sum over the exact circle (no expansion of any kind), denser at both ends, fine enough for 1e-4.
fn quadrature(layer: &FogLayer, radius: f64, h0: f64, mu: f64, t: f64) -> f64 {
    let n = 100_000;
    let altitude = |s: f64| {
        if radius.is_infinite() {
            return h0 + mu * s;
        }
        let r0 = radius + h0;
        ((r0 + mu * s).powi(2) + (1.0 - mu * mu) * s * s).sqrt() - radius
    };
    let step = std::f64::consts::PI / n as f64;
    let point = |x: f64| (0.5 * t * (1.0 - x.cos()), 0.5 * t * x.sin() * step);
    (0..n).map(|i| point((i as f64 + 0.5) * step)).map(|(s, ds)| extinction(layer, altitude(s)) * ds).sum()
}

fn layers() -> Vec<FogLayer> {
    vec![
        slab(150.0, -1e4, 60.0, 20.0),
        slab(1000.0, -1e4, 200.0, 0.0),
        slab(5000.0, 100.0, 400.0, 120.0),
        slab(50_000.0, 20.0, 1500.0, 300.0),
        slab(30.0, 0.0, 2.0, 1.0),
        exponential(2000.0, 50.0),
        exponential(20_000.0, 1200.0),
    ]
}

#[test]
fn transmittance_is_that_of_quadrature_on_the_curved_planet_and_the_flat_one() {
    let mut worst = 0.0f64;
    for layer in layers() {
        for radius in [EARTH_M, f64::INFINITY] {
            for h0 in [1.7, 50.0, 210.0, 3000.0] {
                for mu in [-1.0f64, -0.3, -0.02, -0.004, -0.0005, 0.0, 0.0007, 0.01, 0.2, 1.0] {
                    for t in [10.0, 150.0, 3e3, 4e4, 1.5e5] {
                        // There is no air below the sea.
                        if h0 + layer_rise(1.0 / (radius + h0), mu, t) < -200.0 {
                            continue;
                        }
                        let m = model(layer, &view(h0, radius));
                        let got = (-layer_path(&m, h0, mu, t).depth).exp();
                        let want = (-quadrature(&layer, radius, h0, mu, t)).exp();
                        let error = (got - want).abs() / want.max(1e-3);
                        worst = worst.max(error);
                        assert!(error < 0.004, "{layer:?} radius {radius} h {h0} mu {mu} t {t}: {got} of {want}");
                    }
                }
            }
        }
    }
    println!("largest relative error of T: {worst:.2e}");
}

/// Precipitation is a slab without a lower end, whatever fog lies in it.
#[test]
fn precipitation_is_that_of_quadrature_beside_any_fog() {
    for (top_m, soft_m) in [(650.0, 100.0), (150.0, 100.0), (2050.0, 100.0), (300.0, 1.0)] {
        let alone = slab(3000.0, -1e4, top_m - 0.5 * soft_m, soft_m);
        let falling = FallingLayer { liquid_per_m: 0.0, solid_per_m: alone.extinction_per_m, top_m, soft_m };
        for (radius, h0) in
            [EARTH_M, f64::INFINITY].into_iter().flat_map(|r| [1.7, 240.0, 600.0, 3000.0].map(|h| (r, h)))
        {
            for mu in [-1.0f64, -0.3, -0.02, -0.0005, 0.0, 0.0007, 0.2, 1.0] {
                for t in [10.0, 3e3, 4e4] {
                    if h0 + layer_rise(1.0 / (radius + h0), mu, t) < -200.0 {
                        continue;
                    }
                    let want = quadrature(&alone, radius, h0, mu, t);
                    for fog in [None, Some(slab(150.0, 100.0, 260.0, 20.0)), Some(exponential(2000.0, 50.0))] {
                        let m = FogModel::of_weather(fog.as_ref(), &falling, &noon(), &view(h0, radius)).unwrap();
                        let got = falling_path(&m, h0, mu, t).depth;
                        let error = ((-got).exp() - (-want).exp()).abs() / (-want).exp().max(1e-3);
                        assert!(error < 0.004, "{falling:?} radius {radius} h {h0} mu {mu} t {t}: {got} of {want}");
                    }
                }
            }
        }
        let above = FogModel::of_weather(None, &falling, &noon(), &view(0.0, f64::INFINITY)).unwrap();
        let want = alone.extinction_per_m * (top_m - 0.5 * soft_m);
        assert!((layer_depth_above(&above, 0.0) / want - 1.0).abs() < 1e-9);
    }
}

#[test]
fn the_depth_above_is_the_integral_of_the_profile() {
    for layer in layers() {
        let m = model(layer, &view(0.0, f64::INFINITY));
        for h in [-50.0, 0.0, 1.2, 55.0, 60.0, 130.0, 390.0, 1480.0, 2000.0] {
            let top = 20_000.0;
            let n = 400_000;
            let dz = (top - h) / f64::from(n);
            let want: f64 = (0..n).map(|i| extinction(&layer, h + (f64::from(i) + 0.5) * dz) * dz).sum();
            let got = layer_depth_above(&m, h);
            assert!(
                (got - want).abs() < 2e-4 * want + layer.extinction_per_m * dz,
                "{layer:?} at {h}: {got} of {want}"
            );
        }
    }
}

#[test]
fn a_flat_layer_keeps_five_percent_at_the_visibility() {
    for v in [1.0, 50.0, 150.0, 1e3, 5e3, 5e4, 1e6] {
        let m = model(slab(v, -1e4, 1e4, 0.0), &view(2.0, f64::INFINITY));
        let t = (-layer_path(&m, 2.0, 0.0, v).depth).exp();
        assert!((t - 0.05).abs() < 1e-9, "V {v}: {t}");
    }
}

/// Crossing the top must not show: transmittance to a far post as the camera rises through it has no step and no
/// kink that an 8-bit picture could show.
#[test]
fn crossing_the_top_is_continuous() {
    let layer = slab(150.0, -1e4, 20.0, 4.0);
    let mut last = None;
    for i in 0..4000 {
        let h = 15.0 + 0.0025 * f64::from(i);
        let m = model(layer, &view(h, EARTH_M));
        for (j, mu) in [-0.05f64, -0.001, 0.0, 0.03].into_iter().enumerate() {
            let t = (-layer_path(&m, h, mu, 300.0).depth).exp();
            let row = last.get_or_insert([[f64::NAN; 4]; 1]);
            if row[0][j].is_finite() {
                assert!((t - row[0][j]).abs() < 0.004, "h {h} mu {mu}: from {} to {t}", row[0][j]);
            }
            row[0][j] = t;
        }
    }
}
