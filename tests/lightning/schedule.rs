//! Flashes in a host's queries.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    Status,
    context::{Context, ContextDesc},
    frame::Shared,
    lightning::{FlashEvent, FlashKind, FlashTrigger, LightningSettings, StormCell},
    rain::{Planes, Shelter},
    scene::{Axes, Place, WorldFrame, WorldKind},
    weather::Weather,
};

use crate::device;

fn context(world: WorldFrame) -> Context {
    let shared = Arc::new(Shared::new(&device()).unwrap());
    Context::new(device(), shared, ContextDesc { world, seed: 7, ..ContextDesc::default() }).unwrap()
}

fn stormy() -> Context {
    let mut context = context(WorldFrame::default());
    context.set_weather(&Weather::preset("thunderstorm").unwrap(), 0.0, 0.0).unwrap();
    context
}

const HERE: DVec3 = DVec3::new(300.0, -200.0, 2.0);

fn hour(context: &Context) -> Vec<FlashEvent> {
    context.flashes_near(HERE, (0.0, 3600.0), 20_000.0).unwrap()
}

#[test]
fn channels_agree_and_time_may_run_back() {
    let (mut one, other) = (stormy(), stormy());
    let all = hour(&one);
    // 3 a minute in each square of 20 km: about 3534 within 50 km.
    let wide = one.flashes_near(HERE, (0.0, 3600.0), 50_000.0).unwrap().len() as f64;
    let expected = 180.0 * std::f64::consts::PI * 50.0 * 50.0 / 400.0;
    assert!((wide / expected - 1.0).abs() < 0.12, "{wide} of {expected}");
    assert_eq!(all, hour(&other));
    let back: Vec<FlashEvent> = (0..36)
        .rev()
        .flat_map(|i| {
            let mut part =
                other.flashes_near(HERE, (f64::from(i) * 100.0, f64::from(i + 1) * 100.0), 20_000.0).unwrap();
            part.reverse();
            part
        })
        .collect();
    assert_eq!(all.iter().rev().copied().collect::<Vec<_>>(), back);
    one.update(1800.0).unwrap();
    assert_eq!(all, hour(&one), "the present does not matter");
    assert!(all.iter().any(|f| f.kind == FlashKind::ToGround) && all.iter().any(|f| f.kind == FlashKind::InCloud));
    let mut ids: Vec<u64> = all.iter().map(|f| f.id).collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), all.len(), "each has a number of its own");
}

#[test]
fn the_weather_decides_whether_it_flashes_and_the_host_may() {
    let mut fair = context(WorldFrame::default());
    assert!(hour(&fair).is_empty());
    let report = Weather::from_metar("METAR EDDL 121150Z 24010KT 5000 TSRA BKN025CB 20/18 Q1008").unwrap();
    fair.set_weather(&report.weather, 600.0, 0.0).unwrap();
    let all = hour(&fair);
    assert!(!all.is_empty() && all.iter().all(|f| f.time_s >= 600.0), "thunder begins with the report");
    let set = |rate| LightningSettings { flashes_per_minute: Some(rate), ..LightningSettings::default() };
    fair.set_lightning(set(0.0)).unwrap();
    assert!(hour(&fair).is_empty());
    fair.set_lightning(set(9.0)).unwrap();
    let many = hour(&fair);
    assert!(all.iter().all(|f| many.contains(f)), "another rate moves none");
    let cell = StormCell { position: DVec3::new(5000.0, 0.0, 0.0), radius_m: 500.0, flashes_per_minute: 6.0 };
    fair.set_lightning(LightningSettings { cells: vec![cell], ..LightningSettings::default() }).unwrap();
    let own = hour(&fair);
    assert!((300..420).contains(&own.len()), "{}", own.len());
    assert!(
        own.iter().filter(|f| f.kind == FlashKind::ToGround).all(|f| (f.position - cell.position).length() < 3000.0)
    );
}

#[test]
fn thunder_comes_after_its_way_through_the_air() {
    for celsius in [-10.0, 25.0] {
        let mut context = context(WorldFrame::default());
        let weather = Weather { temperature_c: celsius, ..Weather::preset("thunderstorm").unwrap() };
        context.set_weather(&weather, 0.0, 0.0).unwrap();
        for f in &hour(&context)[..100] {
            let delay = f.distance_m / (331.3 + 0.606 * celsius);
            assert!((f.thunder_delay_s - delay).abs() < 1e-3 && f.distance_m > 0.0, "{f:?}");
            let to = f.position - HERE;
            assert!(f.distance_m <= to.length() + 1e-6 && f.direction.dot(to.normalize()) > 1.0 - 1e-9);
        }
    }
}

fn roof(center: DVec3, half_size_m: DVec3) -> Shelter {
    Shelter {
        center_m: center,
        axes: glam::DMat3::IDENTITY,
        half_size_m,
        velocity_m_s: DVec3::ZERO,
        planes: Planes::NONE,
    }
}

/// A hall of 600 by 600 m in a cell: no flash ends inside it, and a flash that would strike the ground below strikes
/// its roof.
#[test]
fn no_flash_strikes_inside_a_shelter() {
    let half = DVec3::new(300.0, 300.0, 10.0);
    let hall = roof(DVec3::new(0.0, 0.0, 10.0), half);
    let cell = StormCell { position: DVec3::ZERO, radius_m: 250.0, flashes_per_minute: 60.0 };
    let mut context = context(WorldFrame::default());
    context.set_lightning(LightningSettings { cells: vec![cell], ..LightningSettings::default() }).unwrap();
    let strikes = |context: &Context| -> Vec<DVec3> {
        let all = hour(context);
        all.iter().filter(|f| f.kind == FlashKind::ToGround).map(|f| f.position).collect()
    };
    let inside = |p: &DVec3| ((*p - hall.center_m).abs() - half).max_element() < -1e-6;
    let within = |p: &DVec3| p.truncate().abs().max_element() < 299.9;
    let open = strikes(&context);
    assert!(open.iter().filter(|p| within(p)).count() > 300);
    context.set_shelters([&hall]).unwrap();
    let sheltered = strikes(&context);
    assert_eq!(sheltered.iter().filter(|p| inside(p)).count(), 0);
    assert!(sheltered.iter().filter(|p| within(p)).all(|p| p.z > 19.9), "the roof takes them");
    // A flash that the host triggers inside the hall ends on its roof, too.
    let flash = FlashTrigger {
        time_s: 5.0,
        position: DVec3::new(10.0, 20.0, 1.0),
        kind: FlashKind::ToGround,
        peak_ka: Some(30.0),
        strokes: Some(3),
    };
    context.trigger_flash(&flash).unwrap();
    let all = context.flashes_near(DVec3::ZERO, (4.9999, 5.0001), 5000.0).unwrap();
    let own = all.iter().find(|f| f.time_s == 5.0).expect("the flash");
    assert!((own.position.z - 20.0).abs() < 1e-6 && own.strokes == 3 && (own.peak_ka - 30.0).abs() < 1e-9, "{own:?}");
}

#[test]
fn masts_draw_flashes() {
    let cell = StormCell { position: DVec3::ZERO, radius_m: 400.0, flashes_per_minute: 60.0 };
    let mast = DVec3::new(50.0, 0.0, 50.0);
    let mut context = context(WorldFrame::default());
    context.set_lightning(LightningSettings { cells: vec![cell], masts: vec![mast], ..Default::default() }).unwrap();
    let all: Vec<DVec3> = hour(&context).iter().filter(|f| f.kind == FlashKind::ToGround).map(|f| f.position).collect();
    let struck = all.iter().filter(|p| (**p - mast).length() < 1e-6).count();
    // Circles of 10 m in a ring of 300 m, where the mast does not reach.
    let ring = all.iter().filter(|p| (300.0..330.0).contains(&(p.truncate() - mast.truncate()).length())).count();
    let circles = (330.0f64.powi(2) - 300.0f64.powi(2)) / 100.0;
    assert!(struck as f64 > 10.0 * ring as f64 / circles && struck > 20, "{struck}, {ring} over {circles}");
}

#[test]
fn triggered_flashes_and_settings_are_saved_and_hashed() {
    let mut one = stormy();
    let hash = one.state_hash().unwrap();
    let flash = FlashTrigger {
        time_s: 12.0,
        position: DVec3::new(1000.0, 500.0, 0.0),
        kind: FlashKind::ToGround,
        peak_ka: None,
        strokes: None,
    };
    one.trigger_flash(&flash).unwrap();
    let with_flash = one.state_hash().unwrap();
    assert_ne!(hash, with_flash);
    let settings = LightningSettings {
        flashes_per_minute: Some(4.5),
        cells: vec![StormCell { position: DVec3::X, radius_m: 10.0, flashes_per_minute: 2.0 }],
        masts: vec![DVec3::new(1.0, 2.0, 30.0)],
        limits_flicker: true,
    };
    one.set_lightning(settings.clone()).unwrap();
    assert_ne!(with_flash, one.state_hash().unwrap());
    let state = one.save().unwrap();
    let mut other = context(WorldFrame::default());
    other.load(&state).unwrap();
    assert_eq!(other.lightning(), &settings);
    assert_eq!(one.state_hash().unwrap(), other.state_hash().unwrap());
    assert_eq!(hour(&one), hour(&other));
    let strikes = hour(&one);
    let own = strikes.iter().find(|f| f.time_s == 12.0).expect("the triggered flash");
    assert!((own.position - flash.position).length() < 1e-6, "it strikes where it was wanted");
    // A triggered flash is kept until its thunder has been heard; a trigger in the past is refused.
    other.update(100.0).unwrap();
    assert_eq!(other.trigger_flash(&flash).unwrap_err().status, Status::WrongOrder);
    assert!(hour(&other).iter().any(|f| f.time_s == 12.0));
    other.update(140.0).unwrap();
    assert!(hour(&other).iter().all(|f| f.time_s != 12.0));
    for _ in 0..64 {
        other.trigger_flash(&FlashTrigger { time_s: 200.0, ..flash }).unwrap();
    }
    assert!(other.trigger_flash(&FlashTrigger { time_s: 200.0, ..flash }).unwrap_err().to_string().contains("flash"));
}

#[test]
fn worlds_of_all_kinds_have_flashes_where_their_host_wants_them() {
    let origin = Place { latitude_deg: 51.0, longitude_deg: 7.0, altitude_m: 0.0 };
    for (kind, axes) in [
        (WorldKind::Flat, Axes::YUp),
        (WorldKind::Tangent, Axes::ZUp),
        (WorldKind::Tangent, Axes::YUp),
        (WorldKind::Ecef, Axes::ZUp),
    ] {
        let world = WorldFrame { kind, axes, origin, grid_bearing_deg: 20.0, ..WorldFrame::default() };
        let mut context = context(world);
        let position = match kind {
            WorldKind::Ecef => origin.to_ecef(),
            _ => DVec3::new(
                2000.0,
                if axes == Axes::YUp { 5.0 } else { 700.0 },
                if axes == Axes::YUp { 700.0 } else { 5.0 },
            ),
        };
        let trigger = FlashTrigger { time_s: 1.0, position, kind: FlashKind::ToGround, peak_ka: None, strokes: None };
        context.trigger_flash(&trigger).unwrap();
        let all = context.flashes_near(position, (0.0, 2.0), 100.0).unwrap();
        assert_eq!(all.len(), 1);
        assert!((all[0].position - position).length() < 0.5, "{kind:?} {:?} {position:?}", all[0].position);
        // The light comes from above.
        let light = context.lightning_at(position + DVec3::X, 1.0 + 1e-4, 0.0).unwrap();
        assert!(light.direction.z > 0.4 && light.level_lux > 0.0, "{kind:?} {light:?}");
    }
}

#[test]
fn light_falls_with_distance_and_its_mean_is_that_of_its_moments() {
    let mut context = context(WorldFrame::default());
    let strikes = DVec3::new(0.0, 3000.0, 0.0);
    let flash = FlashTrigger {
        time_s: 1.0,
        position: strikes,
        kind: FlashKind::ToGround,
        peak_ka: Some(30.0),
        strokes: Some(1),
    };
    context.trigger_flash(&flash).unwrap();
    let lux =
        |at: DVec3, time_s: f64, exposure_s: f64| context.lightning_at(at, time_s, exposure_s).unwrap().facing_lux[1];
    assert_eq!(lux(DVec3::ZERO, 0.5, 0.0), 0.0, "before it");
    let near = lux(DVec3::new(0.0, 0.0, 2.0), 1.016, 1.0 / 60.0);
    // 870 J/m over 5 km at 163 lm/W in a sixtieth of a second at 3 to 6 km: some hundred lux.
    assert!((50.0..2000.0).contains(&near), "{near}");
    assert!(lux(DVec3::new(0.0, -9000.0, 2.0), 1.016, 1.0 / 60.0) < 0.3 * near);
    let moments: f64 = (0..20_000).map(|i| lux(DVec3::Z, 0.95 + (f64::from(i) + 0.5) * 5e-6, 0.0)).sum::<f64>() * 5e-6;
    let mean = lux(DVec3::Z, 1.05, 0.1) * 0.1;
    assert!((moments / mean - 1.0).abs() < 0.02, "{moments} {mean}");
}

#[test]
fn bad_questions_are_refused_by_name() {
    let mut context = stormy();
    let says = |e: welkin::Error, name: &str| assert!(e.to_string().contains(name), "{e}");
    says(context.flashes_near(DVec3::NAN, (0.0, 1.0), 1.0).unwrap_err(), "position");
    says(context.flashes_near(HERE, (f64::NAN, 1.0), 1.0).unwrap_err(), "from_s");
    says(context.flashes_near(HERE, (0.0, 3601.0), 1.0).unwrap_err(), "until_s");
    says(context.flashes_near(HERE, (0.0, -1.0), 1.0).unwrap_err(), "until_s");
    says(context.flashes_near(HERE, (0.0, 1.0), 6e4).unwrap_err(), "most_distance_m");
    says(context.lightning_at(HERE, f64::INFINITY, 0.0).unwrap_err(), "time_s");
    says(context.lightning_at(HERE, 0.0, 2.0).unwrap_err(), "exposure_s");
    let before = context.lightning().clone();
    let bad = LightningSettings { flashes_per_minute: Some(-1.0), ..LightningSettings::default() };
    says(context.set_lightning(bad).unwrap_err(), "lightning.flashes_per_minute");
    assert_eq!(context.lightning(), &before);
}
