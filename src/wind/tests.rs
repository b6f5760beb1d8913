//! Tests of the wind against its definition: displacement is the integral of velocity through every change of the
//! timeline, and gusts have the stated strength, length and spectrum.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::*;
use crate::weather::{Conditions, Timeline, Weather, derive};

fn of(speed: f64, from_deg: f64) -> Conditions {
    derive(&Weather { wind: crate::weather::Wind::of(speed, from_deg), ..Weather::default() }).unwrap()
}

fn varying(speed: f64, from_deg: f64, range: (f64, f64)) -> Conditions {
    let wind = crate::weather::Wind { variable_deg: Some(range), ..crate::weather::Wind::of(speed, from_deg) };
    derive(&Weather { wind, ..Weather::default() }).unwrap()
}

/// Creates a timeline with the first `count` of ten changes: overlapping transitions, cuts, calms, turns and variable
/// directions.
fn changes(count: usize) -> Timeline {
    let mut t = Timeline::new(of(4.0, 270.0));
    let changes = [
        (of(12.0, 180.0), -40.0, 20.0),
        (of(6.0, 200.0), 0.0, 0.0),
        (of(12.0, 180.0), 100.0, 60.0),
        (of(2.0, 300.0), 130.0, 90.0),
        (of(20.0, 10.0), 140.0, 0.0),
        (varying(6.0, 90.0, (30.0, 150.0)), 200.0, 30.0),
        (of(0.0, 0.0), 210.0, 200.0),
        (varying(3.0, 90.0, (0.0, 360.0)), 215.0, 10.0),
        (varying(5.0, 250.0, (210.0, 280.0)), 300.0, 100.0),
        (of(15.0, 70.0), 350.0, 25.0),
    ];
    for (weather, start, transition) in &changes[..count.min(changes.len())] {
        t.change(*weather, *start, *transition).unwrap();
    }
    t
}

fn velocity(wind: &Wind, timeline: &Timeline, t: f64) -> DVec2 {
    wind.blowing(timeline, Drift::ZERO, t).velocity_m_s()
}

fn displacement(wind: &Wind, timeline: &Timeline, t: f64) -> DVec2 {
    wind.blowing(timeline, Drift::ZERO, t).drift.displacement_m
}

#[test]
fn displacement_is_the_integral_of_velocity_through_every_change() {
    let (wind, timeline) = (Wind::new(5), changes(99));
    assert_eq!(displacement(&wind, &Timeline::new(of(4.0, 270.0)), 0.0), DVec2::ZERO);
    // Intervals of the midpoint rule that end at the cuts, so that no step contains one.
    for (from, to) in [(-60.0, 0.0), (0.0, 100.0), (100.0, 140.0), (140.0, 320.0), (320.0, 600.0)] {
        let n = 6000;
        let h = (to - from) / f64::from(n);
        let sum: DVec2 = (0..n).map(|i| velocity(&wind, &timeline, from + (f64::from(i) + 0.5) * h) * h).sum();
        let way = displacement(&wind, &timeline, to) - displacement(&wind, &timeline, from);
        assert!((way - sum).length() < 1e-4 * (to - from), "{from} to {to}: {way} against {sum}");
    }
    // The mean wind equals the wind of the conditions.
    for i in 0..800 {
        let t = f64::from(i) - 100.0;
        let b = wind.blowing(&timeline, Drift::ZERO, t);
        let c = timeline.at(t).wind;
        assert!((b.mean_m_s - DVec2::new(c.east_m_s, c.north_m_s)).length() < 1e-12, "{t}");
    }
}

#[test]
fn nothing_is_thrown_by_a_gust_or_a_storm_at_any_time() {
    let wind = Wind::new(9);
    for late in [0.0, 1e6, 1e9] {
        let mut timeline = Timeline::new(of(3.0, 0.0));
        timeline.change(of(30.0, 90.0), late + 0.5, 0.0).unwrap();
        timeline.change(of(5.0, 270.0), late + 2.0, 3.0).unwrap();
        timeline.change(varying(8.0, 200.0, (100.0, 300.0)), late + 4.0, 1.0).unwrap();
        let dt = 1.0 / 60.0;
        for i in 0..600 {
            let (a, b) = (late + f64::from(i) * dt, late + f64::from(i + 1) * dt);
            let moved = displacement(&wind, &timeline, b) - displacement(&wind, &timeline, a);
            let fastest = (0..=8)
                .map(|k| velocity(&wind, &timeline, a + (b - a) * f64::from(k) / 8.0).length())
                .fold(0.0, f64::max);
            // The second term allows for rounding: 64-bit numbers near 1e10 m are 2 um apart.
            assert!(moved.length() <= fastest * (b - a) * 1.001 + 1e-14 * late * 30.0, "{a}: {moved} at {fastest} m/s");
        }
    }
}

#[test]
fn only_a_cut_makes_the_wind_jump() {
    let (wind, timeline) = (Wind::new(6), changes(99));
    let step = 1e-5;
    for event in [-40.0, -20.0, 100.0, 130.0, 200.0, 210.0, 215.0, 225.0, 300.0, 350.0, 375.0, 400.0, 410.0] {
        let jump = velocity(&wind, &timeline, event + step) - velocity(&wind, &timeline, event - step);
        assert!(jump.length() < 3e-3, "{event}: {jump}");
    }
    let cut = velocity(&wind, &timeline, 140.0) - velocity(&wind, &timeline, 140.0 - step);
    assert!(cut.length() > 5.0);
}

#[test]
fn steps_saves_and_forgetting_change_no_bit() {
    let wind = Wind::new(77);
    let whole = changes(99);
    for times in [vec![1000.0], (0..2000).map(|i| f64::from(i) * 0.5).collect(), vec![33.0, 131.0, 222.0, 222.0, 407.5]]
    {
        let (mut timeline, mut kept) = (changes(99), Drift::ZERO);
        for &now in &times {
            kept = kept.kept(&wind, &timeline, now);
            timeline.advance(now);
            for ahead in [0.0, 3.7, 61.0, 500.0] {
                let got = wind.blowing(&timeline, kept, now + ahead);
                assert_eq!(got, wind.blowing(&whole, Drift::ZERO, now + ahead), "at {now} for {ahead} s ahead");
            }
        }
        assert!(kept.time_s > 370.0 && kept.path_m > 1000.0);
    }
    // A later change leaves the displacement before it unchanged.
    let (few, more) = (changes(4), changes(5));
    assert_eq!(displacement(&wind, &few, 139.0), displacement(&wind, &more, 139.0));
}

#[test]
fn a_change_of_visibility_alone_leaves_the_wind_as_it_was() {
    let wind = Wind::new(2);
    let calm_air = Timeline::new(of(7.0, 100.0));
    let mut foggy = calm_air.clone();
    let fog = Weather { visibility_m: 200.0, wind: crate::weather::Wind::of(7.0, 100.0), ..Weather::default() };
    foggy.change(derive(&fog).unwrap(), 50.0, 400.0).unwrap();
    for t in [40.0, 200.0, 449.0, 5000.0] {
        assert!((displacement(&wind, &calm_air, t) - displacement(&wind, &foggy, t)).length() < 1e-9, "{t}");
        assert!((velocity(&wind, &calm_air, t) - velocity(&wind, &foggy, t)).length() < 1e-9, "{t}");
    }
}

/// Returns the gusts along (x) and across (y) a west wind of `speed` m/s, at `n` times `step` s apart, m/s.
fn samples(seed: u64, speed: f64, n: usize, step: f64) -> Vec<DVec2> {
    let (wind, timeline) = (Wind::new(seed), Timeline::new(of(speed, 270.0)));
    (0..n).map(|i| wind.blowing(&timeline, Drift::ZERO, i as f64 * step).gust_m_s).collect()
}

#[test]
fn turbulence_is_as_strong_as_stated() {
    for speed in [2.0, 10.0, 30.0] {
        let intensity = of(speed, 0.0).wind.turbulence_intensity;
        let gusts = samples(3, speed, 40_000, 3.0 * 10.0 / speed);
        let n = gusts.len() as f64;
        let mean = gusts.iter().sum::<DVec2>() / n;
        let deviation = |f: fn(&DVec2) -> f64| (gusts.iter().map(|g| f(g) * f(g)).sum::<f64>() / n).sqrt() / speed;
        assert!(mean.length() < 0.01 * speed, "{mean}");
        assert!((deviation(|g| g.x) / intensity - 1.0).abs() < 0.03, "{}", deviation(|g| g.x));
        assert!((deviation(|g| g.y) / intensity / 0.8 - 1.0).abs() < 0.03, "{}", deviation(|g| g.y));
    }
}

#[test]
fn gusts_have_the_published_spectrum() {
    let (speed, step, n) = (10.0, 0.25, 1 << 13);
    let intensity = of(speed, 270.0).wind.turbulence_intensity;
    // Variance in each octave of frequency by the discrete Fourier transform, as a mean over the seeds.
    let bands: Vec<(f64, f64)> = (0..6).map(|i| (0.01 * f64::from(1 << i), 0.02 * f64::from(1 << i))).collect();
    let mut found = vec![[0.0; 2]; bands.len()];
    let seeds = 6;
    for seed in 0..seeds {
        let gusts = samples(seed, speed, n, step);
        let length = n as f64 * step;
        for (band, found) in bands.iter().zip(&mut found) {
            for k in (band.0 * length) as usize..(band.1 * length) as usize {
                let mut sum = [DVec2::ZERO; 2];
                for (i, g) in gusts.iter().enumerate() {
                    let (sin, cos) = (TAU * (k * i % n) as f64 / n as f64).sin_cos();
                    sum = [sum[0] + DVec2::new(cos, sin) * g.x, sum[1] + DVec2::new(cos, sin) * g.y];
                }
                for (f, s) in found.iter_mut().zip(sum) {
                    *f += 2.0 * s.length_squared() / (n * n) as f64 / seeds as f64;
                }
            }
        }
    }
    // Expected variance: that of Kaimal's spectrum in each octave, normalised to wavelengths of 8 m to 3 km. `below` is
    // the integral of the spectrum over frequency, but for a constant.
    for (axis, (length, deviation)) in [(56.7, 1.0), (18.9, 0.8)].into_iter().enumerate() {
        let below = |f: f64| -(1.0 + 6.0 * f * length / speed).powf(-2.0 / 3.0);
        let whole = below(speed / 8.0) - below(speed / 3000.0);
        for (band, found) in bands.iter().zip(&found) {
            let wanted = (below(band.1) - below(band.0)) / whole * (deviation * intensity * speed).powi(2);
            let ratio = found[axis] / wanted;
            assert!((0.6..1.6).contains(&ratio), "axis {axis}, {band:?} Hz: {ratio} of Kaimal's");
        }
    }
}

#[test]
fn the_highest_gust_of_ten_minutes_is_the_reported_one() {
    for speed in [6.0, 12.0, 20.0] {
        let report = of(speed, 270.0).wind.gust_m_s;
        let windows = 60;
        let mut sum = 0.0;
        for seed in 0..windows {
            let gusts = samples(1000 + seed, speed, 2400, 0.25);
            let mean_3_s = |w: &[DVec2]| w.iter().map(|g| g.x).sum::<f64>() / w.len() as f64;
            sum += gusts.windows(12).map(mean_3_s).fold(f64::MIN, f64::max) / windows as f64;
        }
        assert!(
            (sum / (report - speed) - 1.0).abs() < 0.15,
            "{speed} m/s: gusts by {sum}, reported {}",
            report - speed
        );
    }
}

#[test]
fn a_varying_wind_turns_within_its_range_and_goes_less_far() {
    for (range, half) in [((60.0, 120.0), 30.0), ((0.0, 180.0), 90.0), ((0.0, 360.0), 180.0)] {
        let (wind, timeline) = (Wind::new(4), Timeline::new(varying(5.0, 90.0, range)));
        let directions: Vec<f64> = (0..5000)
            .map(|i| {
                let b = wind.blowing(&timeline, Drift::ZERO, f64::from(i) * 1.7);
                let v = b.mean_m_s + b.turned_m_s;
                assert!((v.length() - 5.0).abs() < 1e-6, "the wind turns, it does not slacken: {v}");
                b.mean_m_s.angle_to(v).to_degrees()
            })
            .collect();
        let widest = directions.iter().fold(0.0f64, |w, d| w.max(d.abs()));
        assert!(widest <= half + 1e-6 && widest > 0.99 * half, "{half}: {widest}");
        let gone = displacement(&wind, &timeline, 1e6).length() / 5e6;
        // Mean of the wind's unit vector while its direction swings sinusoidally by `half` to each side: `J0(half)`.
        let expected = libm::j0(half.to_radians()).abs();
        assert!((gone - expected).abs() < 1e-3, "{half}: {gone} against {expected}");
    }
}

#[test]
fn seeds_differ_and_a_seed_is_the_same_everywhere() {
    let timeline = changes(99);
    assert_ne!(displacement(&Wind::new(1), &timeline, 500.0), displacement(&Wind::new(2), &timeline, 500.0));
    let d = displacement(&Wind::new(1), &timeline, 500.0);
    let expected = [0xc09a_c9f4_1046_fbf9, 0xc08a_dd25_c1c8_773c];
    assert_eq!([d.x.to_bits(), d.y.to_bits()], expected, "{d}: a channel on another machine would differ");
}

#[test]
fn the_wind_rises_with_height_and_rests_on_the_ground() {
    let (wind, timeline) = (Wind::new(8), Timeline::new(of(8.0, 270.0)));
    let (b, profile) = (wind.blowing(&timeline, Drift::ZERO, 12.0), timeline.at(0.0).wind);
    let at = |h: f64| b.at_height(&profile, h);
    assert!((at(10.0).velocity_m_s.truncate() - velocity(&wind, &timeline, 12.0)).length() < 1e-12);
    let expected = 8.0 * (2.0f64 / 0.03).ln() / (10.0f64 / 0.03).ln();
    assert!((at(2.0).mean_m_s.x - expected).abs() < 1e-12 && (at(2.0).mean_m_s.y).abs() < 1e-9);
    // The standard deviation of gusts is the same at all heights, but on the ground the wind is 0.
    assert_eq!(at(80.0).gust_deviation_m_s, at(10.0).gust_deviation_m_s);
    assert!((at(10.0).gust_deviation_m_s / 8.0 - profile.turbulence_intensity).abs() < 1e-12);
    for h in [-5.0, 0.0, 0.03] {
        assert_eq!(at(h).velocity_m_s, DVec3::ZERO, "{h}");
    }
    let steps = (0..2000).map(|i| at(f64::from(i) * 0.05).velocity_m_s);
    assert!(steps.clone().zip(steps.skip(1)).all(|(a, b)| (a - b).length() < 2.5));
    let calm = wind.blowing(&Timeline::new(of(0.0, 0.0)), Drift::ZERO, 50.0);
    assert_eq!(calm.at_height(&of(0.0, 0.0).wind, 10.0).velocity_m_s, DVec3::ZERO);
    assert_eq!(calm.drift.displacement_m, DVec2::ZERO);
}
