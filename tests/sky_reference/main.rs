//! The sky's f64 reference against published values, against sums by other methods, and against finer grids of its own.

// Loops over the three wavelengths of several triples at once are clearest with an index.
#![allow(clippy::needless_range_loop)]

mod edges;
mod golden;
mod laws;
mod spectrum;

use welkin::sky::planet::Planet;
use welkin::sky::reference::{Options, Orders, Reference, Resolution, View};
use welkin_support::accept;

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

/// Solution on the default grid, on which laws must hold already.
fn solve(planet: &Planet, orders: Orders) -> Reference {
    Reference::solve(planet, &Options { orders, ..Options::default() }).unwrap()
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

/// A resolution and finer ones to compare with: usually a coarse one, and one half as fine again. With `WELKIN_ACCEPT`
/// it is the finest resolution, with each of its sizes doubled in turn. The sum of these differences is not less than
/// the difference with all sizes doubled at once, which would take an hour.
fn resolutions() -> (Resolution, Vec<Resolution>) {
    if !accept() {
        let base = Resolution { altitudes: 10, sun_angles: 30, zeniths: 10, azimuths: 9, ..Resolution::QUICK };
        let fine = Resolution { altitudes: 15, sun_angles: 45, zeniths: 15, azimuths: 14, panel_points: 8, ..base };
        return (base, vec![fine]);
    }
    let base = Resolution::FINE;
    let fine = vec![
        Resolution { altitudes: 2 * base.altitudes, ..base },
        Resolution { sun_angles: 2 * base.sun_angles, ..base },
        Resolution { zeniths: 2 * base.zeniths, ..base },
        Resolution { azimuths: 2 * base.azimuths, ..base },
        Resolution { panel_points: 2 * base.panel_points, ..base },
    ];
    (base, fine)
}

#[test]
fn solution_holds_at_doubled_resolution() {
    let (base, finer) = resolutions();
    let threads = if accept() { 2 } else { 1 };
    // Each further order is smoother than the one before, so three of them show what the sizes of the tables cost.
    let orders = Orders::Exactly(3);
    let at = |resolution| {
        Reference::solve(&golden(), &Options { resolution, threads, orders, ..Options::default() }).unwrap()
    };
    let base = at(base);
    let (mut sum, mut worst): (f64, f64) = (0.0, 0.0);
    for resolution in finer {
        let errors = differences(&base, &at(resolution));
        let n = errors.len();
        println!(
            "{resolution:?}: 95 % below {:.3} %, worst {:.3} %",
            errors[n * 95 / 100] * 100.0,
            errors[n - 1] * 100.0
        );
        (sum, worst) = (sum + errors[n * 95 / 100], worst.max(errors[n - 1]));
    }
    let (allowed_p95, allowed_worst) = if accept() { (0.003, 0.02) } else { (0.01, 0.25) };
    assert!(sum < allowed_p95 && worst < allowed_worst, "95 % below {sum}, worst {worst}");
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
