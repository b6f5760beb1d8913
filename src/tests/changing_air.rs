//! Tables of the sky while the weather's air changes to one that is known ahead.

use std::sync::Arc;

use crate::{
    gpu::{Device, DeviceOptions},
    planet::Planet,
    sky::{AirChange, Observer, SkyModel, SkySettings, SkyTables, SkyVolume, TablesProgress},
};

fn hazy(extinction_per_m: f64) -> Planet {
    let mut planet = Planet::earth();
    planet.mie.extinction_per_m = [extinction_per_m; 3];
    planet.mie.scattering_per_m = [0.9 * extinction_per_m; 3];
    planet
}

/// Extinctions of clear air, and of the haze that a visibility of 5 km means, 1/m.
const CLEAR: f64 = 3e-5;
const HAZE: f64 = 6e-4;

/// Tables and an observer's tables, followed frame by frame.
struct Sky {
    device: Arc<Device>,
    tables: SkyTables,
    volume: SkyVolume,
    share: f32,
}

impl Sky {
    /// Creates the tables of the first planet.
    fn new(backends: wgpu::Backends, settings: &SkySettings, share: f32, first: &Planet) -> Self {
        let device = Device::headless(&DeviceOptions { backends, ..DeviceOptions::default() }).expect("a device");
        let tables = SkyTables::new(&device, settings).expect("tables");
        let volume = SkyVolume::new(&tables).expect("a volume");
        let mut sky = Self { device, tables, volume, share };
        while sky.follow(first, first).0.done < 1.0 {}
        sky
    }

    /// Draws a frame. Returns its progress, and whether the observer's tables were drawn.
    fn follow(&mut self, now: &Planet, ahead: &Planet) -> (TablesProgress, bool) {
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        let change = AirChange { now, ahead };
        let progress = self.tables.update_along(&mut encoder, change, self.share).expect("an update");
        let observer = Observer::under_sun(now, 10.0, 1.2);
        let drawn = self.volume.prepare(&mut encoder, &self.tables, &observer).expect("tables of an observer");
        self.device.submit_and_wait(encoder).expect("a submission");
        (progress, drawn)
    }

    /// Light of a sun at a sine of 0.4 on the ground.
    fn light(&self) -> f64 {
        f64::from(self.tables.read_light().expect("light").irradiance(0.0, 0.4)[1])
    }
}

fn coarse() -> SkySettings {
    let base = SkySettings::with_model(SkyModel::Directional);
    SkySettings { suns: 40, altitudes: 12, zeniths: 9, azimuths: 6, rule_azimuths: 6, orders: 4, ..base }
}

/// Light of freshly built tables.
fn exact(extinction_per_m: f64) -> f64 {
    Sky::new(wgpu::Backends::PRIMARY, &coarse(), 1.0, &hazy(extinction_per_m)).light()
}

/// Haze of a change from `from` to `to`, at a share of it.
fn mixed(from: f64, to: f64, share: f64) -> Planet {
    hazy(from + crate::numerics::smooth(share) * (to - from))
}

#[test]
fn a_change_that_is_known_ahead_takes_a_draft_and_one_build_at_its_end() {
    let mut sky = Sky::new(wgpu::Backends::NOOP, &SkySettings::default(), 1.0 / 80.0, &hazy(CLEAR));
    let before = sky.tables.builds();
    let (frames, ahead) = (600, hazy(HAZE));
    let mut worked = 0;
    for i in 1..=frames {
        let now = mixed(CLEAR, HAZE, f64::from(i) / f64::from(frames));
        worked += u32::from(sky.follow(&now, &ahead).0.work > 0.0);
    }
    assert!(worked < 16 && sky.tables.builds() == before, "{worked} frames build, and only the draft");
    let after: Vec<_> = (0..120).map(|_| sky.follow(&ahead, &ahead)).collect();
    let done = after.iter().position(|(p, _)| p.done == 1.0).expect("whole tables within two seconds");
    assert!((100..120).contains(&done) && sky.tables.builds() == before + 1, "{done}");
    assert!(after[done + 1..].iter().all(|(p, drawn)| p.work == 0.0 && !drawn));
}

#[test]
fn a_change_in_steps_of_the_host_is_followed_as_before() {
    let mut sky = Sky::new(wgpu::Backends::NOOP, &SkySettings::default(), 1.0 / 80.0, &hazy(CLEAR));
    for i in 1..=600 {
        let now = mixed(CLEAR, HAZE, f64::from(i) / 600.0);
        sky.follow(&now, &now);
    }
    let shown = sky.tables.planet().expect("a planet").mie.extinction_per_m[0];
    assert!(shown > 0.5 * HAZE, "the tables lag behind, but come along: {shown}");
}

#[test]
fn the_light_goes_evenly_from_one_air_to_the_other_and_arrives_where_a_fresh_build_is() {
    let mut sky = Sky::new(wgpu::Backends::PRIMARY, &coarse(), 1.0 / 20.0, &hazy(CLEAR));
    let mut lights = vec![sky.light()];
    let at = |i: u32| mixed(CLEAR, HAZE, f64::from(i) / 200.0);
    for i in 1..=200 {
        // Half of the change is known ahead, as with a change of 10 s.
        sky.follow(&at(i), &at((i + 100).min(200)));
        lights.push(sky.light());
    }
    let ahead = hazy(HAZE);
    for _ in 0..60 {
        sky.follow(&ahead, &ahead);
        lights.push(sky.light());
    }
    let whole = lights[lights.len() - 1] - lights[0];
    assert_eq!(lights[lights.len() - 1], exact(HAZE));
    assert!((whole / lights[0]).abs() > 0.05, "haze shows: {lights:?}");
    let jump = lights.windows(2).map(|w| (w[1] / w[0] - 1.0).abs()).fold(0.0, f64::max);
    assert!(jump < 0.03, "{jump}: {lights:?}");
    // During the change two errors add up: the mix takes light as linear in optical depth, and the tables lag by the
    // time of a build.
    for (i, most) in [(50, 0.25), (150, 0.25)] {
        let off = lights[i] / exact(at(i as u32).mie.extinction_per_m[0]) - 1.0;
        println!("at {} % of the change: {:.2} %", i / 2, 100.0 * off);
        assert!(off.abs() < most, "{i}: {off}");
    }
}

#[test]
fn a_change_that_stops_on_its_way_or_turns_is_followed_without_a_jump() {
    let mut sky = Sky::new(wgpu::Backends::PRIMARY, &coarse(), 1.0 / 20.0, &hazy(CLEAR));
    let mut lights = vec![sky.light()];
    for i in 1..=100 {
        sky.follow(&mixed(CLEAR, HAZE, f64::from(i) / 200.0), &hazy(HAZE));
        lights.push(sky.light());
    }
    // The change stops half-way.
    let half = mixed(CLEAR, HAZE, 0.5);
    for _ in 0..80 {
        sky.follow(&half, &half);
        lights.push(sky.light());
    }
    let stopped = lights[lights.len() - 1];
    assert_eq!(stopped, exact(half.mie.extinction_per_m[0]));
    // The change continues, and half-way through the rest it turns towards clear air over a snow-white ground.
    let ends = [half, hazy(HAZE), Planet { ground_albedo: [0.8; 3], ..hazy(CLEAR) }];
    let between = |from: &Planet, to: &Planet, share: f64| {
        let mut planet = *from;
        for i in 0..3 {
            for (value, end) in [
                (&mut planet.mie.extinction_per_m[i], to.mie.extinction_per_m[i]),
                (&mut planet.mie.scattering_per_m[i], to.mie.scattering_per_m[i]),
                (&mut planet.ground_albedo[i], to.ground_albedo[i]),
            ] {
                *value += share * (end - *value);
            }
        }
        planet
    };
    let mut now = half;
    for i in 1..=50 {
        now = between(&ends[0], &ends[1], f64::from(i) / 100.0);
        sky.follow(&now, &ends[1]);
        lights.push(sky.light());
    }
    for i in 1..=100 {
        let turned = between(&now, &ends[2], f64::from(i) / 100.0);
        sky.follow(&turned, &ends[2]);
        lights.push(sky.light());
    }
    for _ in 0..80 {
        sky.follow(&ends[2], &ends[2]);
        lights.push(sky.light());
    }
    let mut fresh = Sky::new(wgpu::Backends::PRIMARY, &coarse(), 1.0, &ends[2]);
    fresh.follow(&ends[2], &ends[2]);
    assert_eq!(lights[lights.len() - 1], fresh.light());
    let (least, most) = lights.iter().fold((f64::MAX, f64::MIN), |(a, b), l| (a.min(*l), b.max(*l)));
    let jump = lights.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
    println!("largest step {:.2} % of the range", 100.0 * jump / (most - least));
    assert!(jump < 0.08 * (most - least), "{jump} of {least} to {most}");
}
