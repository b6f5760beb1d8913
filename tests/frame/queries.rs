//! Queries against each other, against known light, and against the drawn picture.

use glam::DVec3;
use welkin::{
    context::{ContextDesc, GivenDirection},
    sky::SkySettings,
    weather::{Fog, FogKind, Lofted, LoftedKind, Precipitation, PrecipitationKind, Weather},
};
use welkin_support::frame_host::Host;

fn host() -> Host {
    Host::new(wgpu::TextureFormat::Rgba16Float)
}

#[test]
fn a_context_says_how_its_sky_is_drawn() {
    let mut host = host();
    assert_eq!(host.context.sky_settings().unwrap(), welkin_support::coarse_sky::coarse_sky());
    let other = SkySettings { orders: 3, ..welkin_support::coarse_sky::coarse_sky() };
    host.context.set_sky_settings(&other).unwrap();
    assert_eq!(host.context.sky_settings().unwrap(), other);
    assert!(host.context.set_sky_settings(&SkySettings { orders: 0, ..other }).is_err());
    assert_eq!(host.context.sky_settings().unwrap(), other, "a refusal changes nothing");
}

#[test]
fn visibility_between_two_points_is_the_reported_one() {
    let mut host = host();
    for (i, v) in [150.0, 1500.0, 8000.0, 30_000.0].into_iter().enumerate() {
        let fog = if v < 1000.0 { FogKind::Fog } else { FogKind::None };
        let weather = Weather { visibility_m: v, fog: Fog::of(fog), ..Weather::default() };
        host.context.set_weather(&weather, i as f64, 0.0).unwrap();
        host.context.update(i as f64).unwrap();
        let between = host.context.between(DVec3::new(0.0, 0.0, 1.0), DVec3::new(0.0, v, 1.0), i as f64).unwrap();
        // The planet curves below the level line: at 30 km its end is 70 m up, in thinner haze.
        assert!((between.visibility_m / v - 1.0).abs() < 0.05, "{v}: {between:?}");
        assert!((between.transmittance[1] / 0.05 - 1.0).abs() < 0.15, "{v}: {between:?}");
    }
}

/// Above a bank of fog rain has the same extinction as without fog, and it does not make the fog deeper.
#[test]
fn rain_falls_through_fog_and_above_it() {
    let mut host = host();
    let fog =
        Weather { visibility_m: 150.0, fog: Fog { top_m: Some(60.0), ..Fog::of(FogKind::Fog) }, ..Weather::default() };
    let rain = Weather { precipitation: Precipitation::of(PrecipitationKind::Rain, 5.0), ..fog.clone() };
    let mut through = [[0.0; 2]; 2];
    let mut extinction = 0.0;
    for (i, weather) in [fog, rain].into_iter().enumerate() {
        let t = i as f64;
        host.context.set_weather(&weather, t, 0.0).unwrap();
        host.context.update(t).unwrap();
        extinction = host.context.conditions_at(DVec3::Z, t).unwrap().precipitation.extinction_per_m();
        through[i] = [120.0, 2.0].map(|height| {
            let from = DVec3::new(0.0, 0.0, height);
            host.context.between(from, from + DVec3::Y * 500.0, t).unwrap().transmittance[1].ln()
        });
    }
    let [above, inside] = [0, 1].map(|k| through[1][k] - through[0][k]);
    assert!((above / (-500.0 * extinction) - 1.0).abs() < 0.01, "rain takes {above} of {}", -500.0 * extinction);
    // The reported visibility is that through both.
    assert!(inside.abs() < 0.01 * through[0][1].abs(), "{through:?}");
}

/// Compares with the sum of the optical depths of short pieces of the way, each queried alone.
#[test]
fn a_black_object_is_seen_as_far_as_a_plain_sum_of_the_way_leaves_5_percent() {
    let mut host = host();
    let mist = Weather { visibility_m: 2000.0, fog: Fog::of(FogKind::Mist), ..Weather::default() };
    let shallow = Weather { visibility_m: 9000.0, fog: Fog::of(FogKind::Shallow), ..Weather::default() };
    let inside = Weather { fog: Fog { visibility_inside_m: Some(150.0), top_m: Some(60.0), ..shallow.fog }, ..shallow };
    let rain = Weather {
        visibility_m: 1500.0,
        precipitation: Precipitation { kind: PrecipitationKind::Rain, rate_mm_h: 20.0, ..Default::default() },
        ..Weather::default()
    };
    for (i, weather) in [mist, inside, rain].into_iter().enumerate() {
        let t = i as f64;
        host.context.set_weather(&weather, t, 0.0).unwrap();
        host.context.update(t).unwrap();
        for up in [0.0, 0.05, 0.4, 1.0, -0.3] {
            let from = DVec3::new(10.0, -20.0, if up < 0.0 { 300.0 } else { 1.5 });
            let unit = DVec3::new(0.0, f64::sqrt(1.0 - up * up), up);
            let seen = host.context.visibility_toward(from, unit, t).unwrap();
            // The way is cut into 200 pieces; where nothing hides the object, 8 km stand for it.
            let whole = seen.min(8000.0);
            let piece = |k: i32| {
                let at = |k: i32| from + unit * (whole * f64::from(k) / 200.0);
                -host.context.between(at(k), at(k + 1), t).unwrap().transmittance[1].ln()
            };
            // Downwards, the pieces end at the ground, if that is nearer.
            let pieces = if up < 0.0 { (200.0 * (300.0 / 0.3 / whole).min(1.0)) as i32 } else { 200 };
            let depth: f64 = (0..pieces).map(piece).sum();
            let left = (-depth).exp();
            let is_right = if seen.is_finite() { (depth / 3.0 - 1.0).abs() < 0.02 } else { left > 0.05 };
            assert!(is_right, "{i} {up}: {seen} m, {left} left of it");
        }
        let level = host.context.visibility_toward(DVec3::Z * 1.5, DVec3::Y, t).unwrap();
        let stated = [2000.0, 150.0, 1500.0][i];
        assert!((level / stated - 1.0).abs() < 0.05, "{i}: {level} of {stated}");
        let slanted = host.context.visibility_toward(DVec3::Z, DVec3::Y * 1.1, t).unwrap_err().to_string();
        assert!(slanted.starts_with("direction must be a unit vector"), "{slanted}");
    }
}

/// A moonless night in common air shows stars to magnitude 5.5, the middle of the day none but Venus; fog takes two
/// magnitudes or more.
#[test]
fn the_faintest_star_follows_sky_and_clouds() {
    let mut host = host();
    let limit = |host: &mut Host, weather: &Weather, elevation_deg: f64| {
        host.context.set_weather(weather, 0.0, 0.0).unwrap();
        host.context.set_sun(Some(GivenDirection { azimuth_deg: 90.0, elevation_deg })).unwrap();
        host.context.set_moon(Some(GivenDirection { azimuth_deg: 90.0, elevation_deg: -60.0 })).unwrap();
        host.context.limiting_magnitude(DVec3::ZERO, 0.0).unwrap()
    };
    let clear = Weather::default();
    let [night, dusk, day] = [-40.0, -8.0, 50.0].map(|e| limit(&mut host, &clear, e));
    assert!((5.2..6.5).contains(&night), "{night}");
    assert!((-5.0..-2.0).contains(&day), "{day}");
    assert!(day + 3.0 < dusk && dusk + 1.0 < night, "{day} {dusk} {night}");
    let hidden = Weather { visibility_m: 100.0, fog: Fog::of(FogKind::Fog), ..Weather::default() };
    let fog = limit(&mut host, &hidden, -40.0);
    assert!(fog + 2.0 < night, "{fog} in fog, {night} without");
}

#[test]
fn ambient_light_agrees_with_the_light_on_level_ground() {
    let mut host = host();
    for elevation_deg in [60.0, 20.0] {
        host.context.set_sun(Some(GivenDirection { azimuth_deg: 90.0, elevation_deg })).unwrap();
        let light = host.context.light_at(DVec3::ZERO, 0.0).unwrap();
        let sh = host.context.ambient_at(DVec3::ZERO, 0.0).unwrap();
        let pi = std::f32::consts::PI;
        let level = |up: f32| {
            pi * sh[0][1] * 0.282_095
                + up * 2.0 * pi / 3.0 * sh[2][1] * 0.488_603
                + pi / 4.0 * sh[6][1] * 0.315_392 * 2.0
        };
        let want = light.arriving.sky_lux[1] as f32;
        assert!((level(1.0) / want - 1.0).abs() < 0.25, "{elevation_deg}: {} against {want} lux", level(1.0));
        assert!(sh[3][1] > 0.0, "the sky is brighter towards the sun in the east");
    }
}

/// Under a layer without direct light a host must not cast shadows, and its ground gets the light that the layer's own
/// solution transmits. Above the layer no light is lost.
#[test]
fn fog_and_dust_take_the_sun_from_the_ground() {
    let mut host = host();
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 90.0, elevation_deg: 50.0 })).unwrap();
    let mut light = |weather: &Weather, up: f64| {
        host.context.set_weather(weather, 0.0, 0.0).unwrap();
        host.context.light_at(DVec3::new(0.0, 0.0, up), 0.0).unwrap().arriving
    };
    let clear = light(&Weather::default(), 2.0);
    let deep = Fog { top_m: Some(400.0), ..Fog::of(FogKind::Fog) };
    let fog = Weather { visibility_m: 150.0, fog: deep, ..Weather::default() };
    let (under, above) = (light(&fog, 2.0), light(&fog, 900.0));
    let share = under.total_lux / above.total_lux;
    // 6 or so optical depths of droplets reflect about a third (truth: the slab table) and take no colour.
    assert!((0.45..0.75).contains(&share) && under.sun_lux[1] < 0.3 * above.sun_lux[1], "{share} {under:?}");
    assert!(above.sun_lux[1] > 0.8 * clear.sun_lux[1], "{above:?} {clear:?}");
    let dust = Weather { visibility_m: 400.0, lofted: Lofted::of(LoftedKind::BlowingDust), ..Weather::default() };
    let storm = light(&dust, 2.0);
    let share = storm.total_lux / clear.total_lux;
    assert!((0.02..0.3).contains(&share) && storm.sun_lux[1] < 0.05 * clear.sun_lux[1], "{share} {storm:?}");
    assert!(storm.sky_lux[0] > 2.0 * storm.sky_lux[2], "dust lets red through: {storm:?}");
}

#[test]
fn a_saved_context_goes_on_alike_and_channels_agree() {
    let mut a = host();
    let fog = Weather { visibility_m: 300.0, fog: Fog::of(FogKind::Fog), ..Weather::default() };
    a.context.set_weather(&fog, 5.0, 60.0).unwrap();
    a.context.update(20.0).unwrap();
    let state = a.context.save().unwrap();
    let mut b = host();
    assert_ne!(a.context.state_hash().unwrap(), b.context.state_hash().unwrap());
    b.context.load(&state).unwrap();
    for host in [&mut a, &mut b] {
        host.context.update(40.0).unwrap();
    }
    assert_eq!(a.context.state_hash().unwrap(), b.context.state_hash().unwrap());
    assert_eq!(
        a.context.conditions_at(DVec3::ZERO, 50.0).unwrap(),
        b.context.conditions_at(DVec3::ZERO, 50.0).unwrap()
    );
    let before = b.context.state_hash().unwrap();
    for damaged in [&state[..20], b"nonsense".as_slice(), &[0xff, 0xfe]] {
        assert!(b.context.load(damaged).is_err());
    }
    assert_eq!(b.context.state_hash().unwrap(), before, "a refused load changes nothing");
    assert!(b.context.update(30.0).is_err(), "time does not run back");
    assert!(b.context.set_weather(&fog, 10.0, 0.0).is_err(), "the past cannot be changed");
    assert!(ContextDesc::default().world.validate().is_ok());
}

/// A query about a future or past time returns, bit for bit, what the context returns or returned at that time.
#[test]
fn every_time_answers_as_the_present_did_or_will() {
    let at = DVec3::new(300.0, -200.0, 40.0);
    let far = at + DVec3::new(50.0, 900.0, 5.0);
    let mut host = host();
    host.context.set_sun(None).unwrap();
    let rain = Weather { visibility_m: 3000.0, fog: Fog::of(FogKind::Mist), ..Weather::default() };
    host.context.set_weather(&rain, 1000.0, 3600.0).unwrap();
    let times = [0.0, 999.0, 1800.0, 4000.0, 40_000.0];
    let answers = |host: &Host| {
        times.map(|t| {
            let c = &host.context;
            (c.conditions_at(at, t).unwrap(), c.light_at(at, t).unwrap(), c.between(at, far, t).unwrap())
        })
    };
    let foreseen = answers(&host);
    for (t, (conditions, light, between)) in times.iter().zip(foreseen) {
        host.context.update(*t).unwrap();
        let c = &host.context;
        assert_eq!(c.conditions_at(at, c.time_s()).unwrap(), conditions, "{t}");
        assert_eq!(c.light_at(at, c.time_s()).unwrap(), light, "{t}");
        assert_eq!(c.between(at, far, c.time_s()).unwrap(), between, "{t}");
        if *t < 4600.0 {
            assert_eq!(answers(&host), foreseen, "asked at {t}");
        }
    }
    let [dawn, .., night] = foreseen.map(|f| f.1.arriving.total_lux);
    assert!(dawn > 1e4 && night < 100.0, "time moves the sun: {dawn} and {night} lux");
    assert!(foreseen[0].2.visibility_m > 2.0 * foreseen[4].2.visibility_m, "and the weather");
}

#[test]
fn times_and_places_without_an_answer_are_refused_by_name() {
    let mut host = host();
    host.context.set_weather(&Weather { visibility_m: 900.0, ..Weather::default() }, 10.0, 20.0).unwrap();
    host.context.update(100.0).unwrap();
    let c = &host.context;
    let ask = |at: DVec3, t: f64| {
        let to = DVec3::new(0.0, 10.0, 0.0);
        [c.conditions_at(at, t).err(), c.light_at(at, t).err(), c.between(at, to, t).err(), c.scene_at(at, t).err()]
    };
    // The change was over at 30 s and is forgotten: from there on the answer is known.
    assert_eq!(ask(DVec3::ZERO, 30.0), [None, None, None, None]);
    for t in [29.9, -1.0, f64::NAN, f64::INFINITY, -1.1e10, 1.1e10] {
        for refused in ask(DVec3::ZERO, t) {
            let message = refused.unwrap().to_string();
            assert!(message.starts_with("time_s must be"), "{t}: {message}");
        }
    }
    for refused in ask(DVec3::Z * 2e9, 50.0) {
        let message = refused.unwrap().to_string();
        assert!(message.contains("must be at an altitude in"), "{message}");
    }
    assert!(
        c.between(DVec3::ZERO, DVec3::Z * 2e9, 50.0)
            .unwrap_err()
            .to_string()
            .starts_with("to must be at an altitude in")
    );
}
