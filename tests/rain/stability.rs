//! Rain under all that a simulator may do: storms, pauses, jumps of time, far places, fast cameras. Drops stay finite,
//! and their number has neither bursts nor gaps.

use glam::{DVec2, DVec3};
use welkin::{
    frame::Stages,
    rain::{
        Classes, RainModel, RainSettings,
        cones::{BANDS_M, CONES},
        lattice::{self, SHELLS},
    },
    weather::derive,
};
use welkin_support::rain_scene::{Host, rain};

use crate::drops::{depth_to, mean, through, white};

const RATES: [f64; 4] = [0.0, 0.3, 20.0, 500.0];
const WINDS: [f64; 3] = [0.0, 20.0, 80.0];

/// Expected number of a shell's drops in a view of these tangents, as a share of the shell's drops, weighted by the
/// share of each that is shown.
fn expected_share(shell: usize, tangent: DVec2) -> f64 {
    let side = lattice::side_m(shell);
    let (n, m) = (60, 400);
    // Solid angle of the picture, as a sum over parts of its plane at distance 1.
    let part = |i: i32, half: f64| (2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0) * half;
    let mut angle = 0.0;
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let r2: f64 = 1.0 + part(i, tangent.x).powi(2) + part(j, tangent.y).powi(2);
        angle += 4.0 * tangent.x * tangent.y / f64::from(n * n) / (r2 * r2.sqrt());
    }
    let h = 0.5 * side / f64::from(m);
    let radial: f64 =
        (0..m).map(|k| (f64::from(k) + 0.5) * h).map(|r| lattice::shell_share(shell, r) * r * r * h).sum();
    angle * radial / side.powi(3)
}

/// Drops of each shell in view, each counted by the share of it that is shown. Fails unless all are finite.
fn in_view(classes: &Classes, eye: DVec3, air: DVec3, t: f64, tangent: DVec2) -> [f64; SHELLS] {
    let mut counts = [0.0; SHELLS];
    for drop in lattice::drops(classes, 11, eye, air, t) {
        let p = drop.position_m;
        assert!(p.is_finite() && p.abs().max_element() <= 16.0, "{drop:?}");
        if p.y > 0.0 && p.x.abs() < tangent.x * p.y && p.z.abs() < tangent.y * p.y {
            counts[drop.id.0 as usize] += drop.share;
        }
    }
    counts
}

#[test]
fn no_step_of_time_and_no_place_makes_a_burst_or_a_gap() {
    let mut host = Host::new((16, 16));
    let tangent = DVec2::new(0.8, 0.5);
    let shares: [f64; SHELLS] = std::array::from_fn(|s| expected_share(s, tangent));
    let steps = [0.0, 1e-4, 1.0 / 60.0, 0.3, 1.0, 10.0, 1e6];
    let (mut looked, mut worst) = (0, 0.0f64);
    for (i, (rate, wind)) in RATES.iter().flat_map(|r| WINDS.map(|w| (*r, w))).enumerate() {
        let start = 2e6 * i as f64;
        let weather = rain(rate, wind);
        host.context.set_weather(&weather, start, 5.0).unwrap();
        let classes = Classes::new(&derive(&weather).unwrap().precipitation, 1.0, 8000);
        for (place, speed) in [(0.0, 0.0), (1e7, 0.0), (-1e7, 300.0)] {
            let mut t = start;
            for (k, dt) in steps.iter().enumerate() {
                t += dt;
                let eye = DVec3::new(place + speed * (t - start), place, 300.0);
                let air = host.context.wind_displacement(t).unwrap();
                let seen = in_view(&classes, eye, air, t, tangent);
                for s in 0..SHELLS {
                    let wanted = f64::from(classes.per_shell) * shares[s];
                    let off = (seen[s] - wanted).abs() / wanted.sqrt().max(1.0);
                    (looked, worst) = (looked + 1, worst.max(off));
                    assert!(
                        off < 5.0,
                        "{rate} mm/h, {wind} m/s, {place} m, step {k}, shell {s}: {} of {wanted}",
                        seen[s]
                    );
                }
                // Paused: the drops are the same.
                assert_eq!(seen, in_view(&classes, eye, air, t, tangent));
            }
        }
    }
    println!("{looked} counts, {worst:.1} standard deviations off at most");
}

#[test]
fn pictures_of_storms_far_places_and_fast_cameras_are_finite_and_as_dense_as_any() {
    let mut host = white((160, 90));
    let mut t = 0.0;
    for model in [RainModel::Drops, RainModel::Automatic] {
        host.view.set_rain(RainSettings { model, most_drops: Some(60_000), ..RainSettings::default() }).unwrap();
        t = storms(&mut host, t, model);
    }
    // All stages together, lit by day.
    host.velocity_m_s = DVec3::new(0.0, 300.0, 0.0);
    host.draw(|_, _| [10.0; 3]);
    host.record(Stages::ALL).unwrap();
    assert!(host.pixels().iter().flatten().all(|v| v.is_finite() && *v >= 0.0));
}

/// Draws every rain rate in every wind from the time `t` on, at far places and from a fast camera, and checks the
/// optical depth of the drops. Returns the time at the end, s.
fn storms(host: &mut Host, mut t: f64, model: RainModel) -> f64 {
    let wall = host.boxes[0];
    for (i, (rate, wind)) in RATES.iter().flat_map(|r| WINDS.map(|w| (*r, w))).enumerate() {
        let weather = rain(rate, wind);
        t += 10.0;
        host.context.set_weather(&weather, t, 0.0).unwrap();
        let classes = Classes::new(&derive(&weather).unwrap().precipitation, 1.0, 60_000);
        let wanted = match model {
            RainModel::Automatic => 0.5 * classes.extinction_per_m * (BANDS_M[CONES] - BANDS_M[0]),
            _ => depth_to(&classes, 400.0),
        };
        for (place, speed) in [(0.0, 0.0), (1e7, 0.0), (-1e7, 300.0)] {
            let eye = DVec3::new(place, place, 300.0);
            host.look(eye, DVec3::Y);
            host.boxes[0].center_m = wall.center_m + DVec3::new(place, place, 0.0);
            host.velocity_m_s = DVec3::X * speed;
            let mut seen = Vec::new();
            for dt in [0.0, 0.0, 1.0 / 60.0, 10.0, 1e6] {
                t += dt;
                host.context.update(t).unwrap();
                let picture = through(host);
                // A value may exceed white by one step of half floats.
                let off = picture.iter().find(|v| !(0.0..=1.001).contains(*v));
                assert!(off.is_none(), "{rate} {wind} {place}: {off:?}");
                seen.push(mean(&picture));
            }
            assert_eq!(seen[0], seen[1], "paused");
            let depths: Vec<f64> = seen[1..].iter().map(|s| -s.ln()).collect();
            println!("{i}: {rate} mm/h, {wind} m/s, at {place} m, {speed} m/s: {depths:.4?} of {wanted:.4}");
            for depth in depths {
                let near = depth > 0.5 * wanted && depth < 1.6 * wanted;
                assert!(near || (depth - wanted).abs() < 2e-3, "{rate} {wind} {place} {speed}: {depth} of {wanted}");
            }
        }
    }
    host.boxes[0] = wall;
    t
}
