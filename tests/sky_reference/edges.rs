//! Cases in which such methods fail: extreme media, altitudes from below the ground to far out, twilight, the horizon.

use welkin::sky::planet::Planet;
use welkin::sky::reference::{Options, Orders, Reference, Resolution, View};

use super::{golden, hazy, solve};

/// Small grids: these tests look for broken values, not for exact ones.
fn coarse(planet: &Planet, orders: Orders) -> Reference {
    let resolution =
        Resolution { altitudes: 6, sun_angles: 14, zeniths: 6, azimuths: 4, panel_points: 3, haze_directions: (9, 5) };
    Reference::solve(planet, &Options { orders, resolution, ..Options::default() }).unwrap()
}

fn edge_media() -> Vec<(String, Planet)> {
    let earth = Planet::earth();
    let mut media =
        vec![("thick".to_owned(), earth.with_air_scaled(1e4)), ("none".to_owned(), earth.with_air_scaled(0.0))];
    let mut ozone = earth;
    ozone.rayleigh.scattering_per_m = [0.0; 3];
    (ozone.mie.scattering_per_m, ozone.mie.extinction_per_m) = ([0.0; 3], [0.0; 3]);
    media.push(("ozone only".to_owned(), ozone));
    for h in [0.0, 0.01, 1.0, 1e6] {
        let mut flat = earth;
        (flat.rayleigh.scale_height_m, flat.mie.scale_height_m) = (h, h);
        media.push((format!("H = {h} m"), flat));
    }
    for g in [0.9999, -0.9999, 0.0] {
        let mut peaked = earth;
        peaked.mie.asymmetry_g = g;
        media.push((format!("g = {g}"), peaked));
    }
    let mut small = earth;
    (small.bottom_radius_m, small.top_radius_m, small.rayleigh.scale_height_m) = (1e3, 2e6, 2e5);
    media.push(("a ball of air on a pebble".to_owned(), small));
    let mut no_ozone_width = earth;
    (no_ozone_width.absorption.half_width_m, no_ozone_width.sun_angular_radius_deg) = (0.0, 0.0);
    media.push(("ozone of no width".to_owned(), no_ozone_width));
    media
}

#[test]
fn edge_media_and_altitudes_give_numbers_and_no_negative_light() {
    for (name, planet) in edge_media() {
        let truth = coarse(&planet, Orders::Exactly(3));
        for altitude in [-100.0, -1.0, 0.0, 1e-6, 1.7, 5e3, 1e5 - 1e-6, 1e5, 1e5 + 1e-6, 4e5, 1e7] {
            for sun in [0.0, 60.0, 90.0, 93.0, 110.0, 180.0] {
                for (view, azimuth) in [(0.0, 0.0), (sun, 0.0), (90.0, 180.0), (90.1, 77.0), (112.9, 0.0), (180.0, 0.0)]
                {
                    let view = View::degrees(altitude, sun, view, azimuth);
                    let far = truth.radiance(&view).unwrap();
                    let near = truth.aerial(&view, 1234.5).unwrap();
                    for v in far.radiance.iter().chain(&near.radiance) {
                        assert!(v.is_finite() && *v >= 0.0, "{name} {view:?}: {v}");
                    }
                    for v in far.transmittance.iter().chain(&near.transmittance) {
                        assert!((0.0..=1.0).contains(v), "{name} {view:?}: {v}");
                    }
                }
            }
        }
        for (altitude, sun) in [(-100.0, 40.0), (0.0, 90.0), (1e7, 100.0)] {
            let e = truth.irradiance(altitude, f64::to_radians(sun)).unwrap();
            assert!(e.direct.iter().chain(&e.sky).all(|v| v.is_finite() && *v >= 0.0), "{name}: {e:?}");
        }
    }
}

#[test]
fn nothing_scatters_where_there_is_nothing() {
    let truth = coarse(&Planet::earth().with_air_scaled(0.0), Orders::Exactly(3));
    let view = View::degrees(0.0, 30.0, 70.0, 0.0);
    let along = truth.radiance(&view).unwrap();
    assert_eq!((along.radiance, along.transmittance), ([0.0; 3], [1.0; 3]));
    let e = truth.irradiance(0.0, 0.0).unwrap();
    assert_eq!((e.direct, e.sky), (Planet::earth().solar_irradiance, [0.0; 3]));
}

#[test]
fn white_ground_under_thick_air_converges() {
    let mut planet = Planet { solar_irradiance: [1.0; 3], ground_albedo: [1.0; 3], ..Planet::earth() };
    (planet.mie.scattering_per_m, planet.mie.extinction_per_m) = ([2e-3; 3], [2e-3; 3]);
    let truth = coarse(&planet, Orders::Converged { tolerance: 0.02, limit: 200 });
    assert!(truth.tail() < 0.02 && truth.orders() < 100, "{} orders, tail {}", truth.orders(), truth.tail());
    let longer = coarse(&planet, Orders::Converged { tolerance: 3e-3, limit: 200 });
    for view in [0.0, 60.0, 88.0] {
        let view = View::degrees(1.0, 40.0, view, 30.0);
        let (a, b) = (truth.radiance(&view).unwrap().radiance, longer.radiance(&view).unwrap().radiance);
        for c in 0..3 {
            assert!((a[c] / b[c] - 1.0).abs() < 2e-3 && a[c] < 1.0, "{a:?} {b:?}");
        }
    }
}

#[test]
fn twilight_falls_without_a_step() {
    for planet in [golden(), hazy()] {
        let truth = solve(&planet, Orders::Exactly(4));
        let at =
            |tenths: i32| truth.radiance(&View::degrees(1.0, f64::from(tenths) / 10.0, 0.0, 0.0)).unwrap().radiance;
        let mut before = at(850);
        let mut slope = [None; 3];
        for tenths in 851..=1050 {
            let now = at(tenths);
            for c in 0..3 {
                let fall = now[c] / before[c];
                assert!(fall < 1.0 && fall > 0.8, "sun {}: {fall}", f64::from(tenths) / 10.0);
                // The slope of the logarithm changes slowly: no steps at the grid's nodes.
                let step = slope[c].map_or(0.0, |s: f64| (fall.ln() - s).abs());
                let allowed = if tenths < 1000 { 0.025 } else { 0.06 };
                assert!(step < allowed, "sun {}: kink {step}", f64::from(tenths) / 10.0);
                slope[c] = Some(fall.ln());
            }
            before = now;
        }
    }
}

#[test]
fn horizon_has_no_seam() {
    let truth = solve(&Planet { solar_irradiance: [1.0; 3], ..Planet::earth() }, Orders::Exactly(3));
    for altitude in [1.7, 500.0, 12_000.0] {
        let r = truth.planet().bottom_radius_m;
        let horizon = 90.0 + (r / (r + altitude)).acos().to_degrees();
        for sun in [30.0, 85.0, 91.0] {
            let view = |d: f64| View::degrees(altitude, sun, horizon + d, 40.0);
            let at = |d: f64| truth.aerial(&view(d), 1e9).unwrap();
            // Above the horizon the light itself changes evenly. Below it the path shortens like a square root, so the
            // light divided by one minus the transmittance changes evenly.
            for side in [-1.0, 1.0] {
                let even = |d: f64, c: usize| {
                    let along = at(d);
                    along.radiance[c] / if side > 0.0 { 1.0 - along.transmittance[c] } else { 1.0 }
                };
                for i in 0..40 {
                    let d = side * (f64::from(i) * 2.5e-3 + 5e-4);
                    for c in 0..3 {
                        let jump = (even(d + side * 2.5e-3, c) / even(d, c) - 1.0).abs();
                        assert!(jump < 0.04, "h {altitude} sun {sun} at {d:.4}: {jump}");
                    }
                }
            }
            // The ray that just misses the ground, cut where the ray that just hits it ends, gives the same light.
            let (above, below) = (view(-1e-9), at(1e-9));
            assert!(below.ground && !at(-1e-9).ground);
            let cut = (altitude * (2.0 * r + altitude)).sqrt();
            let above = truth.aerial(&above, cut).unwrap();
            for c in 0..3 {
                assert!((above.radiance[c] / below.radiance[c] - 1.0).abs() < 2e-3, "h {altitude} sun {sun}");
                assert!((above.transmittance[c] / below.transmittance[c] - 1.0).abs() < 2e-3, "h {altitude} sun {sun}");
            }
        }
    }
}

#[test]
fn altitude_zero_and_the_top_are_no_seams() {
    let truth = solve(&hazy(), Orders::Exactly(3));
    let at = |h: f64, view: f64| truth.radiance(&View::degrees(h, 70.0, view, 50.0)).unwrap().radiance;
    for (h, view) in [(0.0, 20.0), (0.0, 89.0), (1e5, 170.0), (1e5, 110.0)] {
        let (a, b) = (at(h - 1e-3, view), at(h + 1e-3, view));
        for c in 0..3 {
            assert!((a[c] / b[c] - 1.0).abs() < 1e-5, "{h} {view}: {a:?} {b:?}");
        }
    }
    let (a, b) = (at(-100.0, 60.0), at(0.0, 60.0));
    assert!((0..3).all(|c| (a[c] / b[c] - 1.0).abs() < 0.05), "{a:?} {b:?}");
}

#[test]
fn wrong_numbers_are_refused_by_name() {
    let truth = coarse(&golden(), Orders::Exactly(1));
    let good = View::degrees(1.0, 60.0, 85.0, 0.0);
    let cases = [
        (View { altitude_m: f64::NAN, ..good }, "altitude_m"),
        (View { sun_zenith: -0.1, ..good }, "sun_zenith"),
        (View { view_zenith: 3.2, ..good }, "view_zenith"),
        (View { azimuth: f64::INFINITY, ..good }, "azimuth"),
    ];
    for (view, name) in cases {
        assert!(truth.radiance(&view).unwrap_err().to_string().contains(name));
    }
    assert!(truth.aerial(&good, -1.0).unwrap_err().to_string().contains("distance_m"));
    for (options, name) in [
        (Options { orders: Orders::Exactly(0), ..Options::default() }, "orders"),
        (
            Options { orders: Orders::Converged { tolerance: f64::NAN, limit: 9 }, ..Options::default() },
            "orders.tolerance",
        ),
        (Options { threads: 0, ..Options::default() }, "threads"),
        (Options { disc_strips: 0, ..Options::default() }, "disc_strips"),
        (
            Options { resolution: Resolution { zeniths: 1, ..Resolution::QUICK }, ..Options::default() },
            "resolution.zeniths",
        ),
    ] {
        assert!(Reference::solve(&golden(), &options).err().unwrap().to_string().contains(name));
    }
}
