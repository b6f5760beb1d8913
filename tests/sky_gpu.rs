//! The drawn sky against published numbers and against the reference in f64.

use welkin::gpu::{Device, DeviceOptions};
use welkin::light::luminance;
use welkin::sky::probe::{Probe, Question, Ray};
use welkin::sky::reference::{Options, Reference, Resolution, View};
use welkin::sky::spectral::{Conversion, SpectralSet};
use welkin::sky::{Planet, SkyModel, SkySettings};
use welkin_support::accept;

fn golden_planet() -> Planet {
    Planet::from_toml(include_str!("../examples/data/planet_golden.toml")).unwrap()
}

fn probe(model: SkyModel, planet: &Planet) -> Probe {
    let device = Device::headless(&DeviceOptions::default()).unwrap();
    Probe::new(&device, &SkySettings::with_model(model), planet).unwrap()
}

/// Sun's and view's zenith angles in degrees, azimuth 0, observer 1 m up, and the radiance of Bruneton's reference.
const GOLDEN: [(f64, f64, [f32; 3]); 5] = [
    (60.0, 0.0, [2.0240e-2, 1.1083e-2, 6.4186e-3]),
    (60.0, 85.0, [0.11143, 0.09987, 0.07861]),
    (80.0, 85.0, [0.09454, 0.14420, 0.16550]),
    (90.0, 0.0, [2.039e-3, 1.934e-3, 1.723e-3]),
    (95.0, 0.0, [4.45e-5, 4.48e-5, 4.35e-5]),
];

/// Largest relative error to the golden table with the sun up, and with it at 95 degrees.
fn golden_errors(model: SkyModel) -> (f32, f32) {
    let mut probe = probe(model, &golden_planet());
    let mut worst = (0.0f32, 0.0f32);
    for (sun, view, expected) in GOLDEN {
        let ray = Ray::at(f64::to_radians(view), 0.0, 0.0);
        let a = probe.under_sun(Question::Sky, 1.0, f64::to_radians(sun), &[ray]).unwrap()[0];
        let off: Vec<f32> = (0..3).map(|i| a.radiance[i] / expected[i] - 1.0).collect();
        println!("{model:?} sun {sun} view {view}: {:?} {off:.4?}", a.radiance);
        let largest = off.iter().fold(0.0f32, |m, e| m.max(e.abs()));
        let slot = if sun > 90.0 { &mut worst.1 } else { &mut worst.0 };
        *slot = slot.max(largest);
    }
    worst
}

#[test]
fn default_model_meets_the_golden_table() {
    let (day, twilight) = golden_errors(SkyModel::Directional);
    assert!(day < 0.03 && twilight < 0.1, "{day} {twilight}");
}

/// Altitudes and directions at which no table of the model has a node: altitude, then view zenith angles in degrees.
const PLACES: [(f64, &[f64]); 4] = [
    (1.0, &[3.0, 47.0, 76.0, 86.0, 89.6]),
    (2000.0, &[12.0, 84.0, 90.4, 96.0, 150.0]),
    (12_000.0, &[33.0, 88.0, 92.5, 97.0, 135.0]),
    (200_000.0, &[102.8, 103.6, 105.0, 120.0, 175.0]),
];

/// Relative errors of radiance, each with its place, sorted, and the largest of transmittance, over sky and aerial
/// rays.
fn errors(planet: &Planet, settings: &SkySettings) -> (Vec<(f64, String)>, f64) {
    let options = Options { disc_strips: 3, ..Default::default() };
    let truth = Reference::solve(planet, &options).unwrap();
    let device = Device::headless(&DeviceOptions::default()).unwrap();
    let mut probe = Probe::new(&device, settings, planet).unwrap();
    let (mut errors, mut worst) = (Vec::new(), 0.0f64);
    for (altitude, views) in PLACES {
        for sun in [14.0, 52.0, 78.0, 87.0, 91.5, 95.0] {
            for distance in [0.0, 700.0, 15_000.0, 80_000.0] {
                if altitude > 1e5 && distance > 0.0 {
                    continue;
                }
                let places: Vec<(f64, f64)> =
                    views.iter().flat_map(|v| [5.0, 70.0, 172.0].map(|azimuth| (*v, azimuth))).collect();
                let ray = |(v, a): &(f64, f64)| Ray::at(v.to_radians(), a.to_radians(), distance);
                let rays: Vec<Ray> = places.iter().map(ray).collect();
                let question = if distance > 0.0 { Question::Aerial } else { Question::Sky };
                let drawn = probe.under_sun(question, altitude, f64::to_radians(sun), &rays).unwrap();
                for ((zenith, azimuth), drawn) in places.iter().zip(drawn) {
                    let view = View::degrees(altitude, sun, *zenith, *azimuth);
                    let along =
                        if distance > 0.0 { truth.aerial(&view, distance) } else { truth.radiance(&view) }.unwrap();
                    for c in 0..3 {
                        let error = (f64::from(drawn.radiance[c]) / along.radiance[c].max(1e-8) - 1.0).abs();
                        let place = if error > 0.2 {
                            format!(
                                "from {altitude} m, sun at {sun}, view at {zenith} from the zenith, {azimuth} from the sun, \
                                 {distance} m far, channel {c}: {:.2e} per unit irradiance",
                                along.radiance[c]
                            )
                        } else {
                            String::new()
                        };
                        errors.push((error, place));
                        if along.transmittance[c] > 0.01 {
                            worst = worst.max((f64::from(drawn.transmittance[c]) / along.transmittance[c] - 1.0).abs());
                        }
                    }
                }
            }
        }
    }
    errors.sort_by(|a, b| a.0.total_cmp(&b.0));
    (errors, worst)
}

/// The documented errors: median, 95th percentile and worst of radiance, worst of transmittance.
fn holds_against_the_reference(name: &str, planet: &Planet, documented: [f64; 4]) {
    let (errors, transmittance) = errors(planet, &SkySettings::default());
    let at = |share: f64| errors[(errors.len() as f64 * share) as usize].0;
    let (worst, place) = errors.last().expect("rays");
    let found = [at(0.5), at(0.95), *worst, transmittance];
    println!("{name}: median, p95, worst, transmittance {found:.5?}; worst {place}");
    for (found, documented) in found.iter().zip(documented) {
        assert!(*found < documented, "{name}: {found} is above the documented {documented}; worst {place}");
        // A documented error that has become much smaller must be updated.
        assert!(*found > 0.7 * documented, "{name}: {found} is far below the documented {documented}");
    }
}

#[test]
fn default_model_follows_the_reference_in_clear_air() {
    holds_against_the_reference("golden", &golden_planet(), [0.003, 0.016, 0.8, 1e-4]);
}

#[test]
fn default_model_follows_the_reference_with_ozone() {
    holds_against_the_reference("earth", &Planet::earth(), [0.0035, 0.018, 0.4, 5e-4]);
}

fn hazy_planet() -> Planet {
    let mut hazy = golden_planet();
    hazy.mie.extinction_per_m = [5e-5; 3];
    hazy.mie.scattering_per_m = [4.5e-5; 3];
    hazy
}

#[test]
fn default_model_follows_the_reference_in_haze() {
    holds_against_the_reference("haze", &hazy_planet(), [0.0035, 0.024, 0.8, 7e-4]);
}

/// Least value of every number of [`SkySettings`].
const LEAST: SkySettings = SkySettings {
    model: SkyModel::Directional,
    wavelengths: 3,
    orders: 3,
    suns: 16,
    altitudes: 8,
    zeniths: 4,
    azimuths: 3,
    rule_zeniths: 3,
    rule_azimuths: 3,
    build_panels: 1,
    sky_azimuths: 8,
    sky_above: 8,
    sky_below: 8,
    sky_panels: 1,
    air_azimuths: 4,
    air_above: 4,
    air_below: 4,
    air_slices: 4,
    air_panels: 1,
    march_cells: 1,
};

type Field = fn(&mut SkySettings) -> &mut u32;

#[test]
fn coarsest_settings_still_draw_a_sky_and_coarser_ones_are_refused() {
    for planet in [golden_planet(), Planet::earth(), hazy_planet()] {
        let (errors, worst) = errors(&planet, &LEAST);
        let at = |share: f64| errors[(errors.len() as f64 * share) as usize].0;
        println!("least: median {:.4} p95 {:.4}", at(0.5), at(0.95));
        assert!(at(0.5) < 0.1 && at(0.95) < 0.6 && worst < 1e-3, "{} {} {worst}", at(0.5), at(0.95));
    }
    let below: [(&str, Field); 18] = [
        ("orders", |s| &mut s.orders),
        ("suns", |s| &mut s.suns),
        ("altitudes", |s| &mut s.altitudes),
        ("zeniths", |s| &mut s.zeniths),
        ("azimuths", |s| &mut s.azimuths),
        ("rule_zeniths", |s| &mut s.rule_zeniths),
        ("rule_azimuths", |s| &mut s.rule_azimuths),
        ("build_panels", |s| &mut s.build_panels),
        ("sky_azimuths", |s| &mut s.sky_azimuths),
        ("sky_above", |s| &mut s.sky_above),
        ("sky_below", |s| &mut s.sky_below),
        ("sky_panels", |s| &mut s.sky_panels),
        ("air_azimuths", |s| &mut s.air_azimuths),
        ("air_above", |s| &mut s.air_above),
        ("air_below", |s| &mut s.air_below),
        ("air_slices", |s| &mut s.air_slices),
        ("air_panels", |s| &mut s.air_panels),
        ("march_cells", |s| &mut s.march_cells),
    ];
    for (name, field) in below {
        let mut settings = LEAST;
        let least = *field(&mut settings);
        *field(&mut settings) -= 1;
        let message = settings.check().unwrap_err().to_string();
        assert!(message.contains(&format!("{name} must be in [{least}, ")), "{message}");
    }
}

#[test]
fn isotropic_model_shows_its_known_error() {
    let (day, _) = golden_errors(SkyModel::IsotropicTables);
    assert!(day > 0.025 && day < 0.08, "{day}");
}

#[test]
fn source_systems_table_lacks_what_is_scattered_twice() {
    let (day, _) = golden_errors(SkyModel::Table3d);
    assert!(day > 0.2 && day < 0.6, "{day}");
}

#[test]
fn brute_force_meets_the_golden_table() {
    let (day, twilight) = golden_errors(SkyModel::BruteForce);
    assert!(day < 0.03 && twilight < 0.1, "{day} {twilight}");
}

#[test]
fn transmittance_is_that_of_direct_quadrature() {
    let mut probe = probe(SkyModel::Table3d, &golden_planet());
    let ray = Ray::at(f64::to_radians(85.0), 1.0, 0.0);
    let t = probe.under_sun(Question::Sky, 1.0, 1.0, &[ray]).unwrap()[0].transmittance;
    for (a, b) in t.iter().zip([0.06437, 0.23805, 0.43356]) {
        assert!((a / b - 1.0).abs() < 5e-4, "{t:?}");
    }
}

/// Directions over the whole sphere that stand for equal solid angles, dense enough to sum a sky.
fn sphere() -> Vec<Ray> {
    let n = 48;
    let mut rays = Vec::new();
    for i in 0..2 * n {
        for j in 0..n {
            let mu: f64 = (f64::from(i) + 0.5) / f64::from(n) - 1.0;
            rays.push(Ray::at(mu.acos(), (f64::from(j) + 0.5) * std::f64::consts::TAU / f64::from(n), 0.0));
        }
    }
    rays
}

#[test]
fn light_for_the_host_is_the_light_that_is_drawn() {
    drawn_light_is_the_hosts(&golden_planet(), &SkySettings::default());
}

#[test]
fn light_of_a_spectral_set_is_the_light_that_is_drawn() {
    drawn_light_is_the_hosts(&golden_planet(), &SkySettings { wavelengths: 6, ..SkySettings::default() });
}

fn drawn_light_is_the_hosts(planet: &Planet, settings: &SkySettings) {
    let device = Device::headless(&DeviceOptions::default()).unwrap();
    let mut probe = Probe::new(&device, settings, planet).unwrap();
    let light = probe.tables().read_light().unwrap();
    let rays = sphere();
    let share = 4.0 * std::f32::consts::PI / rays.len() as f32;
    for (altitude, sun) in [(0.0, 0.3), (2000.0, 1.2), (12_000.0, 1.5), (0.0, 1.6)] {
        let drawn = probe.under_sun(Question::Irradiance, altitude, sun, &rays[..1]).unwrap()[0].transmittance;
        let known = light.irradiance(altitude, sun.cos());
        let sh = light.sh9(altitude, [sun.sin(), 0.0, sun.cos()]);
        let turned = light.sh9(altitude, [0.0, sun.sin(), sun.cos()]);
        // The same sum over the drawn sky and ground.
        let sky = probe.under_sun(Question::Sky, altitude, sun, &rays).unwrap();
        let ground = probe.under_sun(Question::Ground, altitude, sun, &rays).unwrap();
        for (c, known) in known.iter().enumerate() {
            let sum = |f: &dyn Fn([f32; 3]) -> f32| -> f32 {
                let seen = rays.iter().zip(sky.iter().zip(&ground));
                seen.map(|(r, (a, b))| f(r.direction.map(|v| v as f32)) * (a.radiance[c] + b.radiance[c])).sum::<f32>()
                    * share
            };
            let level = sum(&|d| d[2].max(0.0));
            assert!((known / drawn[c] - 1.0).abs() < 0.01, "{altitude} {sun}: {known} {}", drawn[c]);
            assert!((level / drawn[c] - 1.0).abs() < 0.03, "{altitude} {sun}: {level} {}", drawn[c]);
            for (i, own) in [
                (0, sum(&|_| 0.282_094_8)),
                (2, sum(&|d| 0.488_602_5 * d[2])),
                (3, sum(&|d| 0.488_602_5 * d[0])),
                (6, sum(&|d| 0.315_391_6 * (3.0 * d[2] * d[2] - 1.0))),
                (7, sum(&|d| 1.092_548_4 * d[0] * d[2])),
                (8, sum(&|d| 0.546_274_2 * (d[0] * d[0] - d[1] * d[1]))),
            ] {
                assert!((own - sh[i][c]).abs() < 0.03 * sh[0][c], "{altitude} {sun} {i}: {own} {}", sh[i][c]);
            }
            assert!((turned[1][c] - sh[3][c]).abs() < 1e-6 && (turned[8][c] + sh[8][c]).abs() < 1e-6);
        }
    }
}

/// Error of the worst channel over the luminance, rms over the skies that `settings` draw, against `exact`.
fn colour_error(planet: &Planet, wavelengths: u32, exact: &[[f64; 3]]) -> f64 {
    let device = Device::headless(&DeviceOptions::default()).unwrap();
    let settings = SkySettings { wavelengths, ..SkySettings::default() };
    let mut probe = Probe::new(&device, &settings, planet).unwrap();
    let conversion = Conversion::of(planet);
    let rays: Vec<Ray> = colour_views().iter().map(|(v, a)| Ray::at(v.to_radians(), a.to_radians(), 0.0)).collect();
    let mut squares = Vec::new();
    for sun in COLOUR_SUNS {
        for a in probe.under_sun(Question::Sky, 1.0, sun.to_radians(), &rays).unwrap() {
            let transfers = std::array::from_fn(|c| f64::from(a.radiance[c]) / planet.solar_irradiance[c]);
            let (seen, want) = (conversion.rec709(&transfers), exact[squares.len()]);
            let off = |c: usize| ((seen[c] - want[c]) / luminance(&want)).abs();
            squares.push(off(0).max(off(1)).max(off(2)).powi(2));
        }
    }
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

const COLOUR_SUNS: [f64; 4] = [30.0, 60.0, 85.0, 90.0];

fn colour_views() -> Vec<(f64, f64)> {
    [3.0, 30.0, 60.0, 80.0, 88.0].iter().flat_map(|view| [10.0, 90.0, 170.0].map(|azimuth| (*view, azimuth))).collect()
}

#[test]
fn a_spectral_set_draws_the_colours_that_many_wavelengths_have() {
    let planet = Planet::earth();
    // The whole comparison runs only with `WELKIN_ACCEPT`: it needs a planet for every three wavelengths.
    let long = accept();
    let (many, some, allowed) = if long { (40, 15, 0.01) } else { (15, 9, 0.024) };
    let set = SpectralSet::new(many).unwrap();
    let coarse = Resolution {
        altitudes: 16,
        sun_angles: 40,
        zeniths: 14,
        azimuths: 8,
        panel_points: 4,
        haze_directions: (19, 10),
    };
    let resolution = if long { Options::default().resolution } else { coarse };
    let options = Options { resolution, ..Options::default() };
    let truths: Vec<_> = set.planets(&planet).iter().map(|p| Reference::solve(p, &options).unwrap()).collect();
    let mut exact = Vec::new();
    for sun in COLOUR_SUNS {
        for (view, azimuth) in colour_views() {
            let view = View::degrees(1.0, sun, view, azimuth);
            let triples: Vec<_> = truths.iter().map(|t| t.radiance(&view).unwrap().radiance).collect();
            exact.push(set.rec709_of_triples(&triples).unwrap());
        }
    }
    let [three, more] = [3, some].map(|count| colour_error(&planet, count, &exact));
    println!("worst channel, rms: 3 wavelengths {three:.4}, {some} {more:.4}");
    assert!(three > 0.05 && more < allowed, "{three} {more}");
    assert!(long || three < 0.06, "{three}");
}
