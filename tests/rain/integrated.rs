//! Drops integrated in time, as a host sees them: the same rain as the drops without a state, however time and camera
//! move.

use glam::DVec3;
use welkin::{
    Status,
    context::GivenDirection,
    flow::{WindFieldDesc, WindFieldMode},
    frame::Stages,
    gpu::{Device, DeviceOptions},
    rain::{RainModel, RainSettings},
    wind::{WindGrid, WindGridKind},
};
use welkin_support::rain_scene::{Host, rain, upright};

use crate::drops::{mean, through, white};

fn draws(host: &mut Host, model: RainModel) {
    host.view.set_rain(RainSettings { model, most_drops: Some(60_000), ..RainSettings::default() }).unwrap();
}

fn day(size: (u32, u32)) -> Host {
    let mut host = white(size);
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 180.0, elevation_deg: 50.0 })).unwrap();
    host
}

/// Light of the drops before a black wall.
fn picture(host: &mut Host) -> Vec<f64> {
    host.draw(|_, _| [0.0; 3]);
    host.record(Stages::PREPARE.with(Stages::PARTICLES)).unwrap();
    host.pixels().iter().map(|p| f64::from(p[1])).collect()
}

#[test]
fn drops_begin_where_the_lattice_has_them_and_go_on_covering_as_much() {
    let mut host = day((160, 90));
    for (i, (rate, wind)) in [(2.0, 3.0), (20.0, 8.0), (100.0, 15.0)].into_iter().enumerate() {
        let t = 100.0 * (i + 1) as f64;
        host.context.set_weather(&rain(rate, wind), t, 0.0).unwrap();
        host.context.update(t).unwrap();
        draws(&mut host, RainModel::Drops);
        let without = picture(&mut host);
        draws(&mut host, RainModel::Integrated);
        let with = picture(&mut host);
        let apart = without.iter().zip(&with).map(|(a, b)| (a - b).abs()).sum::<f64>();
        assert!(apart < 0.02 * without.iter().sum::<f64>(), "{rate} mm/h: {apart}");
        let mut seen = [0.0; 2];
        for k in 1..=24 {
            host.context.update(t + f64::from(k) / 6.0).unwrap();
            // The drops are stepped in every frame; every fourth frame is measured.
            seen[1] += mean(&picture(&mut host)) * f64::from(u8::from(k % 4 == 0));
            if k % 4 == 0 {
                draws(&mut host, RainModel::Drops);
                seen[0] += mean(&picture(&mut host));
                draws(&mut host, RainModel::Integrated);
            }
        }
        println!("{rate} mm/h: {:.4} of the drops without a state", seen[1] / seen[0]);
        assert!((seen[1] / seen[0] - 1.0).abs() < 0.1, "{rate} mm/h: {seen:?}");
    }
}

#[test]
fn neither_pauses_jumps_nor_fast_cameras_make_bursts_or_gaps() {
    let mut host = day((240, 135));
    let weather = rain(50.0, 10.0);
    host.context.set_weather(&weather, 5.0, 0.0).unwrap();
    host.context.update(5.0).unwrap();
    draws(&mut host, RainModel::Integrated);
    let usual: f64 = (0..12)
        .map(|k| {
            host.context.update(5.0 + 0.4 * f64::from(k)).unwrap();
            mean(&picture(&mut host))
        })
        .sum::<f64>()
        / 12.0;
    let (mut t, mut eye) = (10.0, DVec3::new(0.0, 0.0, 300.0));
    let before = picture(&mut host);
    assert_eq!(before, picture(&mut host), "while time stands, so do the drops");
    let mut each = Vec::new();
    for dt in [0.0, 1.0 / 60.0, 0.5, 1.0, 10.0, 1e6, 1.0 / 60.0, 1.0 / 60.0, 1.0 / 60.0] {
        t += dt;
        // At 300 m/s along the wall.
        eye.x += 300.0 * f64::min(dt, 1.0);
        host.boxes[0].center_m.x = eye.x;
        host.context.update(t).unwrap();
        host.look(eye, DVec3::Y);
        let light = mean(&picture(&mut host));
        each.push(light / usual);
    }
    println!("{each:.3?}");
    assert!(each.iter().all(|l| (0.75..1.3).contains(l)), "{each:?}");
}

/// Wind that rises and turns aside in front of a wall.
fn updraught() -> WindGrid {
    let nodes = [16u32, 16, 16];
    let count = nodes.iter().product::<u32>() as usize;
    WindGrid {
        origin: DVec3::new(-15.0, -15.0, 285.0),
        cell_m: DVec3::splat(2.0),
        nodes,
        kind: WindGridKind::Added,
        velocities_m_s: vec![[12.0, 0.0, 9.0]; count],
    }
}

#[test]
fn a_wind_that_varies_in_space_bends_drops_and_is_that_of_the_query() {
    let mut host = day((240, 135));
    host.context.set_weather(&rain(50.0, 0.0), 5.0, 0.0).unwrap();
    host.context.update(5.0).unwrap();
    let there = DVec3::new(0.0, 0.0, 300.0);
    let still = host.context.wind_at(there, 5.0).unwrap();
    host.context.set_wind_grid(Some(updraught())).unwrap();
    let blown = host.context.wind_at(there, 5.0).unwrap();
    assert_eq!(blown.velocity_m_s - still.velocity_m_s, DVec3::new(12.0, 0.0, 9.0));
    assert_eq!(
        host.context.wind_at(there + DVec3::Z * 20.0, 5.0).unwrap(),
        host.context.wind_at(there + DVec3::X * 40.0 + DVec3::Z * 20.0, 5.0).unwrap()
    );
    host.context.set_wind_grid(Some(WindGrid { kind: WindGridKind::Whole, ..updraught() })).unwrap();
    assert_eq!(host.context.wind_at(there, 5.0).unwrap().velocity_m_s, DVec3::new(12.0, 0.0, 9.0));
    // The streaks are slanted: pixels are alike along the slant and not across it.
    let (w, h) = (host.size.0 as usize, host.size.1 as usize);
    let lean = |host: &mut Host| {
        let p = picture(host);
        let along = |dx: usize, dy: usize| -> f64 {
            (0..h - dy)
                .flat_map(|y| (0..w - dx).map(move |x| (x, y)))
                .map(|(x, y)| p[y * w + x] * p[(y + dy) * w + x + dx])
                .sum()
        };
        along(3, 0) / along(0, 3)
    };
    draws(&mut host, RainModel::Integrated);
    let bent = lean(&mut host);
    host.context.set_wind_grid(None).unwrap();
    draws(&mut host, RainModel::Drops);
    let upright = lean(&mut host);
    println!("{bent} against {upright}");
    assert!(bent > 2.0 * upright, "{bent} against {upright}");
    let bad = WindGrid { nodes: [16, 16, 40], ..updraught() };
    assert!(host.context.set_wind_grid(Some(bad)).unwrap_err().to_string().contains("wind_grid.nodes[2]"));
}

#[test]
fn a_wind_field_bends_drops_round_a_house_and_comes_back_with_the_state() {
    let mut host = day((160, 90));
    host.context.set_weather(&rain(50.0, 9.0), 1.0, 0.0).unwrap();
    // The lee lies downwind of the house, half its length behind it.
    let house = upright([0.0, 0.0, 6.0], [8.0, 8.0, 6.0]);
    host.context.set_shelters(&[house]).unwrap();
    let field = WindFieldDesc { cells: [24, 24, 10], mode: WindFieldMode::Running, ..WindFieldDesc::default() };
    host.context.set_wind_field(Some(&field), 1.0).unwrap();
    host.context.update(1.0).unwrap();
    let carrying = host.context.carrying_wind(1.0).unwrap();
    let lee = carrying.normalize() * 14.0 + DVec3::Z * 4.0;
    let far = carrying.normalize() * 400.0 + DVec3::Z * 4.0;
    let falls = |host: &Host, p: DVec3| host.context.rain_at(p, 1.0).unwrap().fall_velocity_m_s;
    let (behind, open) = (falls(&host, lee), falls(&host, far));
    println!("behind the house {behind:.2}, in the open {open:.2}");
    assert!(behind.truncate().dot(carrying.truncate()) < 0.5 * open.truncate().dot(carrying.truncate()));
    let report = host.context.wind_field_report().unwrap();
    assert_eq!((report.time_s, report.begun_s, report.step_s), (1.0, 1.0, 0.5));
    // With the house in front of the camera other drops are drawn.
    host.look(lee, DVec3::new(0.3, 1.0, 0.0));
    draws(&mut host, RainModel::Integrated);
    let with = picture(&mut host);
    host.context.update(1.3).unwrap();
    let bent = picture(&mut host);
    let state = host.context.save().unwrap();
    let mut other = day((160, 90));
    other.context.load(&state).unwrap();
    assert_eq!(other.context.state_hash().unwrap(), host.context.state_hash().unwrap());
    assert_eq!(falls(&other, lee), falls(&host, lee));
    [&mut host, &mut other].into_iter().for_each(|h| h.context.update(2.6).unwrap());
    assert_eq!(other.context.state_hash().unwrap(), host.context.state_hash().unwrap());
    // A wind grid of the host replaces the field; without the grid the field applies again.
    host.context.set_wind_grid(Some(WindGrid { origin: DVec3::splat(-15.0), ..updraught() })).unwrap();
    assert!(falls(&host, DVec3::Z * 14.0).z > 0.0);
    host.context.set_wind_grid(None).unwrap();
    assert!(falls(&host, DVec3::Z * 14.0).z < 0.0);
    assert!(mean(&with) > 0.0 && with != bent);
}

#[test]
fn a_cab_stays_dry_in_any_wind() {
    let mut host = white((160, 90));
    host.context.set_weather(&rain(30.0, 5.0), 1.0, 0.0).unwrap();
    host.context.set_wind_grid(Some(updraught())).unwrap();
    draws(&mut host, RainModel::Integrated);
    host.boxes = vec![upright([0.0, 2.0, 300.0], [50.0, 1e-3, 50.0])];
    for k in 0..6 {
        host.context.update(1.0 + 0.2 * f64::from(k)).unwrap();
        host.context.set_shelters(&[]).unwrap();
        assert!(through(&mut host).iter().any(|v| *v < 0.99), "it rains");
        host.context.set_shelters(&[upright([0.0, 0.0, 300.0], [4.0; 3])]).unwrap();
        assert!(through(&mut host).iter().all(|v| *v == 1.0));
    }
}

#[test]
fn a_device_without_compute_refuses_them_by_name() {
    let device = Device::headless(&DeviceOptions { force_tier0: true, ..DeviceOptions::default() }).unwrap();
    let mut host = Host::on(device, (32, 32));
    let asked = RainSettings { model: RainModel::Integrated, ..RainSettings::default() };
    let e = host.view.set_rain(asked).unwrap_err();
    assert!(e.status == Status::Unsupported && e.to_string().contains("rain.model"), "{e}");
    for model in [RainModel::Cones, RainModel::Drops, RainModel::Veil] {
        host.view.set_rain(RainSettings { model, ..asked }).unwrap();
        host.context.set_weather(&rain(9.0, 3.0), host.context.time_s() + 1.0, 0.0).unwrap();
        host.context.update(host.context.time_s() + 1.0).unwrap();
        host.draw(|_, _| [10.0; 3]);
        host.record(Stages::ALL).unwrap();
    }
}
