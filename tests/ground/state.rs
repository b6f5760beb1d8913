//! The ground's water over time: the same with updates of any length, kept by a saved state, and gone after drying.

use glam::DVec3;
use welkin::{
    Status,
    context::{Context, ContextDesc, GivenDirection},
    frame::Stages,
    ground::GroundModel,
    ground::SurfaceClass,
    weather::Weather,
};

use crate::host::{Host, ground, look, resealed};

fn context(host: &Host, model: GroundModel) -> Context {
    let desc = ContextDesc { ground: model, seed: 7, ..ContextDesc::default() };
    let mut context = Context::new(host.device.clone(), host.context.shared().clone(), desc).unwrap();
    context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg: 40.0 })).unwrap();
    context.set_default_surface_class(SurfaceClass::Paved);
    context
}

/// Rain from 100 s on for half an hour, then sun and wind.
fn shower(host: &Host) -> Context {
    let mut context = context(host, GroundModel::Simulated);
    context.set_weather(&Weather::preset("rain").unwrap(), 100.0, 137.0).unwrap();
    let mut after = Weather::preset("clear").unwrap();
    after.wind.speed_m_s = 6.0;
    context.set_weather(&after, 1900.0, 61.0).unwrap();
    context
}

#[test]
fn steps_of_any_size_come_to_the_same_water() {
    let host = Host::new();
    let at = DVec3::new(3.0, 4.0, 0.0);
    let mut whole = shower(&host);
    let mut by_step = [0.7, 7.0, 59.9, 1000.0].map(|dt| (dt, shower(&host)));
    for end in [150.0, 1905.0, 1930.0, 1955.0, 4000.0, 9000.0] {
        whole.update(end).unwrap();
        for (dt, context) in &mut by_step {
            while context.time_s() < end {
                context.update((context.time_s() + *dt).min(end)).unwrap();
            }
            assert_eq!(context.ground_at(at).unwrap(), whole.ground_at(at).unwrap(), "steps of {dt} s to {end} s");
            assert_eq!(context.state_hash().unwrap(), whole.state_hash().unwrap(), "steps of {dt} s to {end} s");
        }
        // An update to the same time changes nothing.
        let now = whole.ground_water();
        whole.update(end).unwrap();
        assert_eq!(whole.ground_water(), now);
    }
}

#[test]
fn a_saved_ground_goes_on_as_if_nothing_had_been() {
    let host = Host::new();
    let mut first = shower(&host);
    first.update(1234.5).unwrap();
    let saved = first.save().unwrap();
    first.update(1294.5).unwrap();
    let mut second = context(&host, GroundModel::Simulated);
    second.load(&saved).unwrap();
    assert!(second.ground_water().unwrap().film_mm > 0.1);
    second.update(1294.5).unwrap();
    assert_eq!(first.ground_water(), second.ground_water());
    assert_eq!(first.save().unwrap(), second.save().unwrap());
    let mut reported = context(&host, GroundModel::Reported);
    let e = reported.load(&saved).unwrap_err();
    assert!(e.status == Status::InvalidArgument && e.to_string().contains("ground_model"), "{e}");
    let text = String::from_utf8(saved).unwrap();
    let broken = text.replacen("film_mm = ", "film_mm = -", 1);
    let e = second.load(&resealed(&broken)).unwrap_err();
    assert!(text != broken && e.status == Status::Parse && e.to_string().contains("ground must be"), "{e}");
    // A context without simulation saves nothing about the ground.
    assert!(!String::from_utf8(reported.save().unwrap()).unwrap().contains("film_mm"));
    assert!(reported.ground_water().is_none());
}

#[test]
fn a_shower_wets_the_ground_and_the_sun_dries_it() {
    let host = Host::new();
    let mut context = shower(&host);
    let level = DVec3::new(1.0, 2.0, 0.0);
    assert_eq!(context.ground_at(level).unwrap().water_mm, 0.0);
    context.update(1800.0).unwrap();
    let wet = context.ground_at(level).unwrap();
    assert!(wet.wetness > 0.85 && wet.puddles > 0.05 && (0.2..1.5).contains(&wet.film_mm), "{wet:?}");
    // When the last drop has fallen it only dries.
    context.update(1970.0).unwrap();
    let (mut last, mut hours) = (context.ground_water().unwrap(), 0.0);
    while last.total_mm() > 0.0 && hours < 48.0 {
        context.update(context.time_s() + 313.0).unwrap();
        let now = context.ground_water().unwrap();
        assert!(now.film_mm <= last.film_mm && now.total_mm() < last.total_mm(), "{now:?} {last:?}");
        assert!(now.cover().0 <= last.cover().0);
        (last, hours) = (now, hours + 313.0 / 3600.0);
    }
    assert!((0.5..40.0).contains(&hours), "{hours} h");
    // Deepest in the hollows.
    let places = (0..400).map(|i| DVec3::new(f64::from(i) * 0.3, 5.0, 0.0));
    let mut again = shower(&host);
    again.update(1800.0).unwrap();
    let under = places.filter(|p| again.ground_at(*p).unwrap().in_puddle).count() as f64 / 400.0;
    assert!((under - wet.puddles).abs() < 0.15, "{under} {}", wet.puddles);
    // Without paved ground no puddles are drawn, and queries find none.
    again.set_default_surface_class(SurfaceClass::Unspecified);
    for i in 0..400 {
        let at = again.ground_at(DVec3::new(f64::from(i) * 0.3, 5.0, 0.0)).unwrap();
        assert!(!at.in_puddle && at.water_mm == at.film_mm && at.film_mm > 0.2, "{at:?}");
    }
}

#[test]
fn leaps_in_time_are_quick_and_finite() {
    let host = Host::new();
    let mut context = shower(&host);
    for t in [1e6, 1e6 + 1.0, 1e8, 1e10] {
        let start = std::time::Instant::now();
        context.update(t).unwrap();
        assert!(start.elapsed().as_secs_f64() < 20.0, "{t}: {:?}", start.elapsed());
        let water = context.ground_water().unwrap();
        assert!(water.total_mm().is_finite() && water.total_mm() >= 0.0, "{t}: {water:?}");
    }
}

#[test]
fn wet_ground_stays_in_the_picture_when_the_rain_has_ended() {
    let mut host = Host::new();
    let eye = DVec3::new(0.0, 0.0, 2.0);
    let camera = look(eye, 0.0, -40.0, 0.8);
    let [mut simulated, mut reported] = [GroundModel::Simulated, GroundModel::Reported].map(|m| context(&host, m));
    let mut shown = |context: Context| {
        host.context = context;
        let pixels = host.shoot(camera, Stages::SURFACE, |d| ground(eye, d, [2000.0; 3]));
        pixels.iter().map(|p| p[1]).sum::<f32>() / pixels.len() as f32
    };
    for context in [&mut simulated, &mut reported] {
        context.set_weather(&Weather::preset("rain").unwrap(), 0.0, 0.0).unwrap();
        context.set_weather(&Weather::preset("clear").unwrap(), 1800.0, 0.0).unwrap();
        context.update(1900.0).unwrap();
    }
    assert_eq!(shown(reported), 2000.0);
    assert!(shown(simulated) < 1900.0);
}
