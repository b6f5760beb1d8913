//! The sky's f64 truth against published values, against sums done another way, and against itself.

// The three wavelengths of several triples at once read best by index.
#![allow(clippy::needless_range_loop)]

mod edges;
mod golden;
mod laws;
mod spectrum;

use welkin::sky::planet::Planet;
use welkin::sky::reference::{Options, Orders, Reference, Resolution, View};

/// The long variants run with WELKIN_ACCEPT=1.
fn accept() -> bool {
    std::env::var("WELKIN_ACCEPT").is_ok_and(|v| v == "1")
}

fn resolution() -> Resolution {
    if accept() { Resolution::FINE } else { Resolution::QUICK }
}

fn golden() -> Planet {
    Planet::from_toml(include_str!("../../examples/data/planet_golden.toml")).unwrap()
}

/// The Earth with sun 1 and haze of 12 km visibility.
fn hazy() -> Planet {
    let mut planet = Planet { solar_irradiance: [1.0; 3], ..Planet::earth() };
    planet.mie.extinction_per_m = [2.5e-4; 3];
    planet.mie.scattering_per_m = [2.3e-4; 3];
    planet
}

fn solve(planet: &Planet, orders: Orders) -> Reference {
    Reference::solve(planet, &Options { orders, resolution: resolution(), ..Options::default() }).unwrap()
}

/// Views from the ground to space, all round, day and twilight.
fn many_views() -> Vec<View> {
    let mut views = Vec::new();
    for altitude in [1.0, 2000.0, 12_000.0, 200_000.0] {
        for sun in [0.0, 30.0, 60.0, 75.0, 85.0, 90.0, 93.0, 96.0] {
            for view in [0.0, 45.0, 80.0, 88.0, 89.5, 90.5, 92.0, 100.0, 105.0, 135.0] {
                for azimuth in [0.0, 60.0, 120.0, 180.0] {
                    views.push(View::degrees(altitude, sun, view, azimuth));
                }
            }
        }
    }
    views
}

/// Sorted relative differences over the views where the light is above a millionth of the sun's.
fn differences(a: &Reference, b: &Reference) -> Vec<f64> {
    let mut out = Vec::new();
    for view in many_views() {
        let (a, b) = (a.radiance(&view).unwrap().radiance, b.radiance(&view).unwrap().radiance);
        out.extend((0..3).filter(|c| b[*c] > 1e-6).map(|c| (a[c] / b[c] - 1.0).abs()));
    }
    out.sort_by(f64::total_cmp);
    out
}

#[test]
fn converged_solution_holds_at_doubled_resolution() {
    // Everyday: a coarse solution and one half as fine again. Accepted: the finest one and its double.
    let coarse = Resolution { altitudes: 10, sun_angles: 30, zeniths: 10, azimuths: 9, ..Resolution::QUICK };
    let (base, times) = if accept() { (Resolution::FINE, 2.0) } else { (coarse, 1.5) };
    let finer = |n: usize| (n as f64 * times).round() as usize;
    let double = Resolution {
        altitudes: finer(base.altitudes),
        sun_angles: finer(base.sun_angles),
        zeniths: finer(base.zeniths),
        azimuths: finer(base.azimuths),
        panel_points: finer(base.panel_points),
        haze_directions: base.haze_directions,
    };
    let planets: &[Planet] = if accept() { &[golden(), hazy()] } else { &[golden()] };
    for planet in planets {
        let at = |resolution| {
            let (threads, orders) = if accept() { (2, Options::default().orders) } else { (1, Orders::Exactly(3)) };
            Reference::solve(planet, &Options { resolution, threads, orders, ..Options::default() }).unwrap()
        };
        let errors = differences(&at(base), &at(double));
        let n = errors.len();
        let rms = (errors.iter().map(|e| e * e).sum::<f64>() / n as f64).sqrt();
        let (p95, worst) = (errors[n * 95 / 100], errors[n - 1]);
        println!("{n} values: rms {:.3} %, 95 % below {:.3} %, worst {:.3} %", rms * 100.0, p95 * 100.0, worst * 100.0);
        let (allowed_p95, allowed_worst) = if accept() { (0.003, 0.02) } else { (0.01, 0.25) };
        assert!(p95 < allowed_p95 && worst < allowed_worst);
    }
}

#[test]
fn answers_do_not_depend_on_the_number_of_threads() {
    let resolution = Resolution { altitudes: 5, sun_angles: 10, zeniths: 5, azimuths: 4, ..Resolution::QUICK };
    let at = |threads| Reference::solve(&hazy(), &Options { resolution, threads, ..Options::default() }).unwrap();
    let (one, three) = (at(1), at(3));
    for view in many_views().iter().step_by(7) {
        assert_eq!(one.radiance(view).unwrap(), three.radiance(view).unwrap());
    }
}
