//! Falling snow as a host sees it: where flakes are drawn, how much they hide, where none fall. One binary, so that it
//! links once.

use glam::DVec3;
use welkin::{
    context::GivenDirection,
    frame::Stages,
    gpu::{Device, DeviceOptions},
    rain::Shelter,
    scene::{Camera, HostLight},
    snow::{
        SnowModel, SnowSettings,
        flakes::FlakeSizes,
        lattice::{self, Flake, Flakes},
    },
    weather::{Precipitation, PrecipitationKind, Weather, hydrometeors::snow_extinction_per_m},
};
use welkin_support::rain_scene::{Host, NEAR_M, upright};

/// Radiance of the host's picture: far above the light of flakes at night, within the range of half floats.
const WHITE: f64 = 3e4;
const MOST: u32 = 20_000;
const LN_20: f64 = 2.995_732_273_553_991;

fn snow(kind: PrecipitationKind, rate_mm_h: f64, wind_m_s: f64) -> Weather {
    // Extinction of the snow, in air with a visibility of 20 km.
    let extinction = snow_extinction_per_m(rate_mm_h) + LN_20 / 20_000.0;
    let mut weather = Weather {
        precipitation: Precipitation::of(kind, rate_mm_h),
        visibility_m: LN_20 / extinction,
        temperature_c: -1.0,
        ..Weather::default()
    };
    weather.wind.speed_m_s = wind_m_s;
    weather.wind.from_deg = 270.0;
    weather
}

fn settings(model: SnowModel) -> SnowSettings {
    SnowSettings { model, most_flakes: Some(MOST), ..SnowSettings::default() }
}

/// A host at night, when flakes only hide and give no light.
fn night(size: (u32, u32), weather: &Weather) -> Host {
    let mut host = Host::new(size);
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg: -40.0 })).unwrap();
    host.context.set_weather(weather, 0.0, 0.0).unwrap();
    host.context.update(100.0).unwrap();
    host
}

/// Share of light that each pixel lets through in a view of a white world; the sky is black.
fn through(host: &mut Host, settings: SnowSettings) -> Vec<f64> {
    host.view.set_snow(settings).unwrap();
    host.draw(|_, _| [WHITE; 3]);
    host.record(Stages::PREPARE.with(Stages::MEDIUM).with(Stages::PARTICLES)).unwrap();
    host.pixels().iter().map(|p| f64::from(p[1]) / WHITE).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn deviation(values: &[f64]) -> f64 {
    let m = mean(values);
    (values.iter().map(|v| (v - m).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}

/// Deviation of the difference from each pixel to the one beside it.
fn roughness(values: &[f64]) -> f64 {
    deviation(&values.windows(2).map(|pair| pair[0] - pair[1]).collect::<Vec<_>>())
}

/// Flakes of a host's view.
fn flakes(host: &Host) -> (Flakes, Vec<Flake>) {
    let scene = host.context.scene_at(host.camera.position, host.context.time_s()).unwrap();
    let c = &scene.conditions;
    let factor = welkin::rain::drops::factor_in(&c.air, c.air.station_altitude_m);
    let of = Flakes::new(&FlakeSizes::new(&c.precipitation, c.air.temperature_c, factor), 1.0, MOST);
    let place = DVec3::new(scene.map_m[0], scene.map_m[1], scene.place.altitude_m);
    let moved = host.context.wind_displacement(host.context.time_s()).unwrap();
    let moved = DVec3::new(moved[0], moved[1], 0.0);
    let list = lattice::flakes(&of, 11, place, moved, host.context.time_s()).collect();
    (of, list)
}

#[test]
fn nothing_runs_when_no_snow_falls() {
    let mut host = night((64, 36), &snow(PrecipitationKind::None, 0.0, 2.0));
    host.draw(|_, _| [WHITE; 3]);
    host.record(Stages::ALL.without(Stages::TONE)).unwrap();
    let clear = *host.view.report();
    assert_eq!((clear.snow.flakes, clear.snow.flakes_to_m), (0, 0.0));
    host.context.set_weather(&snow(PrecipitationKind::Snow, 1.0, 2.0), 100.0, 0.0).unwrap();
    host.view.set_snow(settings(SnowModel::Automatic)).unwrap();
    host.context.update(101.0).unwrap();
    host.record(Stages::ALL.without(Stages::TONE)).unwrap();
    let falling = *host.view.report();
    assert!(falling.snow.flakes > 1000 && falling.snow.flakes <= MOST && falling.snow.flakes_to_m >= 2.0);
    host.view.set_snow(settings(SnowModel::Veil)).unwrap();
    host.record(Stages::ALL.without(Stages::TONE)).unwrap();
    assert_eq!(host.view.report().snow.flakes, 0);
    assert_eq!(host.view.report().passes + 1, falling.passes, "flakes are one pass more than a veil");
}

#[test]
fn near_flakes_hide_what_the_extinction_hides_at_any_size_of_picture() {
    for (kind, rate) in [(PrecipitationKind::Snow, 2.0), (PrecipitationKind::SnowGrains, 0.5)] {
        let mut lets = Vec::new();
        for size in [(96, 54), (288, 162)] {
            let mut host = night(size, &snow(kind, rate, 3.0));
            // The camera looks down on the ground, which is farther than flakes reach.
            host.look(DVec3::new(0.0, 0.0, 30.0), DVec3::new(0.0, 1.0, -3.0));
            let veil = mean(&through(&mut host, settings(SnowModel::Veil)));
            let mut drawn = Vec::new();
            for i in 0..6 {
                host.context.update(100.0 + 3.7 * f64::from(i)).unwrap();
                drawn.push(mean(&through(&mut host, settings(SnowModel::Flakes))));
            }
            let (lost, by_flakes) = (1.0 - veil, 1.0 - mean(&drawn));
            assert!(lost > 0.02, "{kind:?}: {lost}");
            assert!((by_flakes / lost - 1.0).abs() < 0.04, "{kind:?} {size:?}: {by_flakes} of {lost}");
            lets.push(by_flakes);
        }
        assert!((lets[0] / lets[1] - 1.0).abs() < 0.04, "{kind:?}: {lets:?}");
    }
}

#[test]
fn flakes_are_where_the_reference_has_them() {
    let mut host = night((480, 270), &snow(PrecipitationKind::Snow, 2.0, 4.0));
    host.context.update(1234.5).unwrap();
    host.look(DVec3::new(3.0, -5.0, 30.0), DVec3::new(0.3, 1.0, -0.8));
    let sharp = SnowSettings { shutter_s: 1e-4, ..settings(SnowModel::Flakes) };
    let seen = through(&mut host, sharp);
    let bare = through(&mut host, settings(SnowModel::Veil));
    let (_, list) = flakes(&host);
    let (mut looked, mut found) = (0, 0);
    let clip = host.camera.projection * glam::DMat4::from_mat3(host.camera.rotation());
    for flake in list.iter().filter(|f| f.share > 0.99 && f.diameter_m / f.position_m.length() > 0.004) {
        let p = clip * flake.position_m.extend(1.0);
        let ndc = p.truncate() / p.w;
        if p.w <= 0.0 || ndc.x.abs() > 0.98 || ndc.y.abs() > 0.98 {
            continue;
        }
        let at = |v: f64, n: u32| (v * f64::from(n)) as usize;
        let (x, y) = (at(0.5 + 0.5 * ndc.x, 480), at(0.5 - 0.5 * ndc.y, 270));
        looked += 1;
        // The flake's ice may lie one pixel beside.
        let dark = (y.saturating_sub(1)..=y + 1).flat_map(|y| (x.saturating_sub(1)..=x + 1).map(move |x| y * 480 + x));
        let dark = dark.filter(|i| *i < seen.len()).map(|i| 1.0 - seen[i] / bare[i]).fold(f64::MIN, f64::max);
        found += u32::from(dark > 0.25);
    }
    assert!(looked >= 20 && f64::from(found) > 0.93 * f64::from(looked), "{found} of {looked}");
}

/// Flakes listed by compute shaders draw the same picture as every flake drawn without them.
#[test]
fn the_list_draws_what_all_flakes_draw() {
    type Scene = (&'static str, fn(&mut Host));
    let scenes: [Scene; 4] = [
        ("looking up in a gale", |h| {
            h.context.set_weather(&snow(PrecipitationKind::Snow, 2.0, 15.0), 200.0, 0.0).unwrap();
            h.context.update(201.0).unwrap();
            h.look(DVec3::new(3.0, -5.0, 1.7), DVec3::new(0.3, 1.0, 0.4));
        }),
        ("130 degrees wide", |h| {
            let eye = DVec3::new(3.0, -5.0, 1.7);
            h.camera = Camera::look_to(eye, DVec3::Y, DVec3::Z, 1.75, 16.0 / 9.0, NEAR_M);
        }),
        ("beside a box", |h| h.context.set_shelters(&[upright([3.0, -2.0, 4.0], [1.0, 2.0, 0.1])]).unwrap()),
        ("before a lamp", |h| {
            let lamp = HostLight {
                position_m: DVec3::new(2.0, -5.0, 2.0),
                direction: DVec3::Y,
                intensity_cd: [300_000.0; 3],
                inner_deg: 10.0,
                outer_deg: 30.0,
            };
            h.context.set_lights(&[lamp]).unwrap();
        }),
    ];
    for backends in [DeviceOptions::default().backends, wgpu::Backends::GL] {
        let mut hosts = [true, false].map(|force_tier0| {
            let options = DeviceOptions { backends, force_tier0, ..DeviceOptions::default() };
            let mut host = Host::on(Device::headless(&options).unwrap(), (240, 135));
            assert_eq!(host.device.caps().tier, u32::from(!force_tier0));
            host.context.set_sun(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg: -40.0 })).unwrap();
            host
        });
        let mut before = Vec::new();
        for (what, set) in scenes {
            let [all, listed] = hosts.each_mut().map(|host| {
                set(host);
                through(host, SnowSettings::default())
            });
            let off: Vec<f64> = listed.iter().zip(&all).map(|(a, b)| (a - b).abs()).collect();
            let apart = off.iter().filter(|off| **off > 2e-3).count();
            println!("{backends:?}, {what}: {:.1e} apart on the mean, {apart} pixels of {}", mean(&off), off.len());
            assert!(mean(&off) < 2e-5 && apart * 500 < off.len(), "{backends:?}, {what}: {} {apart}", mean(&off));
            assert_ne!(before, listed, "{what} shows in the picture");
            before = listed;
        }
    }
}

#[test]
fn no_flake_falls_under_a_roof() {
    let mut host = night((160, 90), &snow(PrecipitationKind::Snow, 3.0, 0.0));
    host.look(DVec3::new(0.0, 0.0, 1.7), DVec3::new(0.0, 1.0, -0.15));
    // Pixels of the lower half, which is ground.
    let sharp = SnowSettings { shutter_s: 1e-4, ..settings(SnowModel::Flakes) };
    let rough = |host: &mut Host| roughness(&through(host, sharp)[45 * 160..]);
    let open = rough(&mut host);
    let roof = [upright([0.0, 0.0, 6.0], [30.0, 30.0, 0.2])];
    host.context.set_shelters(&roof).unwrap();
    let under = rough(&mut host);
    assert!(open > 5e-3 && under < 0.02 * open, "{under} of {open}");
    // Wind from the west blows flakes under the roof's western edge, as far as they fall slantwise.
    host.context.set_weather(&snow(PrecipitationKind::Snow, 3.0, 12.0), 101.0, 0.0).unwrap();
    host.context.update(200.0).unwrap();
    let edge: [Shelter; 1] = [upright([8.0, 0.0, 4.0], [10.0, 30.0, 0.2])];
    host.context.set_shelters(&edge).unwrap();
    let blown = rough(&mut host);
    assert!(blown > 0.3 * open, "{blown} of {open}");
}

#[test]
fn flakes_keep_their_size_straight_up_and_straight_down() {
    let calm = snow(PrecipitationKind::Snow, 2.0, 0.0);
    let mut host = night((160, 90), &calm);
    let contrast = |host: &mut Host, forward: DVec3| {
        let (mut sum, n) = (0.0, 8);
        for i in 0..n {
            host.context.update(host.context.time_s() + 5.0 + f64::from(i)).unwrap();
            host.camera = {
                let up = if forward.x == 0.0 && forward.y == 0.0 { DVec3::Y } else { DVec3::Z };
                let aspect = f64::from(host.size.0) / f64::from(host.size.1);
                welkin::scene::Camera::look_to(DVec3::new(0.0, 0.0, 60.0), forward, up, 0.9, aspect, NEAR_M)
            };
            // A wall all around.
            host.boxes =
                vec![upright([0.0, 0.0, 100.0], [200.0, 200.0, 1.0]), upright([0.0, 60.0, 60.0], [200.0, 1.0, 200.0])];
            let seen = through(host, SnowSettings { shutter_s: 1e-3, ..settings(SnowModel::Flakes) });
            assert!(seen.iter().all(|v| v.is_finite()));
            sum += deviation(&seen).powi(2) / f64::from(n);
        }
        sum.sqrt()
    };
    let level = contrast(&mut host, DVec3::Y);
    for forward in [DVec3::Z, DVec3::NEG_Z] {
        let steep = contrast(&mut host, forward);
        assert!((steep / level - 1.0).abs() < 0.25, "{forward}: {steep} of {level}");
    }
}

#[test]
fn more_flakes_reach_farther_and_change_no_mean() {
    let mut host = night((192, 108), &snow(PrecipitationKind::Snow, 1.0, 2.0));
    host.look(DVec3::new(0.0, 0.0, 40.0), DVec3::new(0.0, 1.0, -2.0));
    let mut seen = Vec::new();
    for most in [10_000, 100_000] {
        let all = SnowSettings { most_flakes: Some(most), ..settings(SnowModel::Flakes) };
        seen.push((mean(&through(&mut host, all)), host.view.report().snow.flakes_to_m));
    }
    assert!(seen[1].1 > seen[0].1, "{seen:?}");
    assert!((seen[0].0 - seen[1].0).abs() < 0.1 * (1.0 - seen[0].0), "{seen:?}");
}

#[test]
fn sleet_is_rain_and_snow_in_one_layer() {
    let mut host = night((128, 72), &snow(PrecipitationKind::Sleet, 4.0, 2.0));
    host.look(DVec3::new(0.0, 0.0, 30.0), DVec3::new(0.0, 1.0, -3.0));
    let both = through(&mut host, settings(SnowModel::Flakes));
    let report = *host.view.report();
    assert!(report.rain.drops > 0 && report.snow.flakes > 0);
    let rain_alone = through(&mut host, settings(SnowModel::Veil));
    let [both_rough, rain_rough] = [&both, &rain_alone].map(|seen| roughness(seen));
    assert!(both_rough > 2.0 * rain_rough, "{both_rough} {rain_rough}");
    let lost = [mean(&both), mean(&rain_alone)].map(|m| 1.0 - m);
    assert!((lost[0] / lost[1] - 1.0).abs() < 0.1, "{lost:?}");
}

#[test]
fn settings_outside_of_their_range_are_refused_by_name_and_change_nothing() {
    let mut host = night((64, 36), &snow(PrecipitationKind::Snow, 1.0, 2.0));
    for (bad, field) in [
        (SnowSettings { shutter_s: 0.0, ..SnowSettings::default() }, "snow.shutter_s"),
        (SnowSettings { shutter_s: f64::NAN, ..SnowSettings::default() }, "snow.shutter_s"),
        (SnowSettings { most_flakes: Some(10), ..SnowSettings::default() }, "snow.most_flakes"),
    ] {
        let e = host.view.set_snow(bad).unwrap_err();
        assert!(e.to_string().contains(field), "{e}");
    }
    host.draw(|_, _| [WHITE; 3]);
    host.record(Stages::ALL.without(Stages::TONE)).unwrap();
    assert!(host.view.report().snow.flakes > MOST);
}
