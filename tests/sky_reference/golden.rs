//! Published radiances and transmittances, and order 2 by a nested sum.

use std::f64::consts::PI;

use welkin::sky::planet::Planet;
use welkin::sky::reference::grid::zenith_rule;
use welkin::sky::reference::march::{Cutting, march};
use welkin::sky::reference::medium::{Medium, mie_phase, rayleigh_phase};
use welkin::sky::reference::quadrature::Gauss;
use welkin::sky::reference::ray::Ray;
use welkin::sky::reference::sun::sun_transmittance;
use welkin::sky::reference::{Options, Orders, Reference, Resolution, View};

use super::{accept, golden};

fn solve(planet: &Planet, orders: Orders) -> Reference {
    let resolution = if accept() { Resolution::FINE } else { Resolution::QUICK };
    Reference::solve(planet, &Options { orders, resolution, ..Options::default() }).unwrap()
}

/// Radiance table of the CPU reference of Bruneton's 2017 implementation, 4 orders: sun and view zenith angles, values
/// at 440, 520 and 600 nm.
const TABLE: [(f64, f64, [f64; 3]); 5] = [
    (60.0, 0.0, [2.0240e-2, 1.1083e-2, 6.4186e-3]),
    (60.0, 85.0, [0.11143, 0.09987, 0.07861]),
    (80.0, 85.0, [0.09454, 0.14420, 0.16550]),
    (90.0, 0.0, [2.039e-3, 1.934e-3, 1.723e-3]),
    (95.0, 0.0, [4.45e-5, 4.48e-5, 4.35e-5]),
];

/// The published program integrates every ray in 50 trapezoid steps. The last integral by the same rule, with the air's
/// light at each step from our solution, shows how much of the difference is due to that rule.
fn by_fifty_trapezoids(truth: &Reference, view: &View) -> [f64; 3] {
    let medium = Medium::of(truth.planet());
    let ray = Ray::new(&medium, view.altitude_m, view.view_zenith.cos());
    let (start, end, _) = ray.in_air(&medium).unwrap();
    let (mu_s, r) = (view.sun_zenith.cos(), ray.radius_m());
    let nu = ray.mu * mu_s + view.view_zenith.sin() * view.sun_zenith.sin() * view.azimuth.cos();
    let step = (end - start) / 50.0;
    let mut out = [0.0; 3];
    for i in 0..=50 {
        let s = start + step * f64::from(i);
        let h = ray.altitude_at(s).min(medium.top_m - 2.0);
        let there = medium.bottom_m + h;
        let (mu, mu_s) = ((r * ray.mu + s) / there, (r * mu_s + s * nu) / there);
        let (mu, mu_s) = (mu.clamp(-1.0, 1.0), mu_s.clamp(-1.0, 1.0));
        let sines = ((1.0 - mu * mu) * (1.0 - mu_s * mu_s)).max(0.0).sqrt();
        let azimuth = if sines > 1e-9 { ((nu - mu * mu_s) / sines).clamp(-1.0, 1.0).acos() } else { 0.0 };
        let here = View { altitude_m: h, sun_zenith: mu_s.acos(), view_zenith: mu.acos(), azimuth };
        let metre = truth.aerial(&here, 1.0).unwrap().radiance;
        let t = medium.transmittance(&ray.columns(&medium, start, s));
        let w = if i == 0 || i == 50 { 0.5 } else { 1.0 };
        (0..3).for_each(|c| out[c] += w * step * t[c] * metre[c]);
    }
    out
}

#[test]
fn golden_radiance_at_four_orders() {
    let truth = solve(&golden(), Orders::Exactly(4));
    for (sun, view, values) in TABLE {
        let view = View::degrees(1.0, sun, view, 0.0);
        let exact = truth.radiance(&view).unwrap().radiance;
        let theirs = by_fifty_trapezoids(&truth, &view);
        for c in 0..3 {
            let (error, by_rule) = (exact[c] / values[c] - 1.0, theirs[c] / values[c] - 1.0);
            println!(
                "sun {sun} {:?} {c}: exact {:+.2} %, by their rule {:+.2} %",
                view.view_zenith,
                error * 100.0,
                by_rule * 100.0
            );
            let (allowed, allowed_by_rule) = if sun > 90.0 { (0.05, 0.05) } else { (0.027, 0.02) };
            assert!(error.abs() < allowed, "sun {sun} channel {c}: {exact:?} against {values:?}");
            assert!(by_rule.abs() < allowed_by_rule, "sun {sun} channel {c}: {theirs:?} against {values:?}");
        }
    }
}

#[test]
fn golden_transmittance_to_four_digits() {
    let truth = solve(&golden(), Orders::Exactly(1));
    let t = truth.aerial(&View::degrees(1.0, 60.0, 85.0, 0.0), 1e9).unwrap().transmittance;
    for (t, exact) in t.iter().zip([0.06437, 0.23805, 0.43356]) {
        assert!((t - exact).abs() < 6e-6, "{t} {exact}");
    }
}

/// Order 2 by a nested sum that uses none of the solver's grids, interpolations and treatments of phase functions.
fn second_order(planet: &Planet, first: &Reference, view: &View, n: usize, points: usize) -> [f64; 3] {
    let medium = Medium::of(planet);
    let (mu, mu_s) = (view.view_zenith.cos(), view.sun_zenith.cos());
    let nu = mu * mu_s + view.view_zenith.sin() * view.sun_zenith.sin() * view.azimuth.cos();
    let ray = Ray::new(&medium, view.altitude_m, mu);
    let (start, end, _) = ray.in_air(&medium).unwrap();
    let (marks, rule) = (medium.panel_altitudes(), Gauss::new(points));
    let mut samples = Vec::new();
    let cutting = Cutting { altitudes_m: &marks, rule: &rule, panel_depth: 2.0 };
    march(&ray, &medium, &cutting, (start, end), &[], &mut samples);
    let mut out = [0.0; 3];
    for s in &samples {
        let r = medium.bottom_m + s.altitude_m;
        // Local frame with the view in the xz plane.
        let mu_s = (ray.radius_m() * mu_s + s.distance_m * nu) / r;
        let sine = (1.0 - s.mu * s.mu).sqrt();
        let sx = (nu - s.mu * mu_s) / sine;
        let sy = (1.0 - mu_s * mu_s - sx * sx).max(0.0).sqrt();
        for (c, w) in zenith_rule(&medium, s.altitude_m, &Gauss::new(n / 2), &Gauss::new(n)) {
            for j in 0..2 * n {
                let (sin_a, cos_a) = ((j as f64 + 0.5) * PI / n as f64).sin_cos();
                let across = (1.0 - c * c).sqrt();
                let to_sun = across * (cos_a * sx + sin_a * sy) + c * mu_s;
                let sines = across * (1.0 - mu_s * mu_s).max(0.0).sqrt();
                let azimuth = if sines > 1e-9 { ((to_sun - c * mu_s) / sines).clamp(-1.0, 1.0).acos() } else { 0.0 };
                let from = View { altitude_m: s.altitude_m, sun_zenith: mu_s.acos(), view_zenith: c.acos(), azimuth };
                let mut light = first.radiance(&from).unwrap().radiance;
                let incoming = Ray::new(&medium, s.altitude_m, c);
                if let Some(d) = incoming.distance_to_ground() {
                    let t = medium.transmittance(&incoming.columns(&medium, 0.0, d));
                    let mu_s_ground = (r * mu_s + d * to_sun) / medium.bottom_m;
                    let sun = sun_transmittance(&medium, 0.0, mu_s_ground);
                    (0..3)
                        .for_each(|k| light[k] += t[k] * planet.ground_albedo[k] / PI * mu_s_ground.max(0.0) * sun[k]);
                }
                let turn = across * cos_a * sine + c * s.mu;
                let (gas, haze) = (rayleigh_phase(turn), mie_phase(turn, medium.asymmetry_g));
                let w = w * PI / n as f64;
                (0..3).for_each(|k| out[k] += w * light[k] * (s.gas[k] * gas + s.haze[k] * haze));
            }
        }
    }
    out
}

#[test]
fn second_order_agrees_with_a_nested_sum() {
    let planet = golden();
    let (one, two) = (solve(&planet, Orders::Exactly(1)), solve(&planet, Orders::Exactly(2)));
    let (n, points, allowed) = if accept() { (24, 5, 0.003) } else { (10, 2, 0.015) };
    for (sun, view, azimuth) in [(60.0, 80.0, 0.0), (85.0, 60.0, 120.0), (92.0, 70.0, 0.0)] {
        let view = View::degrees(100.0, sun, view, azimuth);
        let (a, b) = (one.radiance(&view).unwrap().radiance, two.radiance(&view).unwrap().radiance);
        let nested = second_order(&planet, &one, &view, n, points);
        for c in 0..3 {
            let error = (b[c] - a[c]) / nested[c] - 1.0;
            println!("sun {sun} channel {c}: {:+.3} %", 100.0 * error);
            assert!(error.abs() < allowed, "sun {sun} channel {c}: {} {}", b[c] - a[c], nested[c]);
        }
    }
}
