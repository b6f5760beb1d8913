//! Altitudes of Earth-centred worlds are above mean sea level where the host gives its height, otherwise above the
//! ellipsoid.

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc},
    rain::RainArea,
    scene::{Place, WorldFrame, WorldKind},
    weather::{Fog, FogKind, Weather},
};

use crate::whole::context_of;

/// Sea level above the ellipsoid, m: as at Frankfurt.
const GEOID_M: f64 = 47.8;
const ORIGIN: Place = Place { latitude_deg: 50.0, longitude_deg: 10.0, altitude_m: 0.0 };

/// Fog of 200 m up to 10 m over the sea.
fn fog() -> Weather {
    let fog = Fog { kind: FogKind::Shallow, top_m: Some(10.0), visibility_inside_m: Some(200.0), coverage: Some(1.0) };
    Weather { visibility_m: 17_000.0, fog, ..Weather::default() }
}

fn context(kind: WorldKind, geoid_height_m: f64) -> Context {
    let world = WorldFrame { kind, origin: ORIGIN, geoid_height_m, ..WorldFrame::default() };
    let mut context = context_of(ContextDesc { world, ..ContextDesc::default() });
    context.set_weather(&fog(), 0.0, 0.0).unwrap();
    context
}

/// Transmittance of a horizontal way of 100 m at 2 m over the sea, which lies `geoid_height_m` above the ellipsoid.
fn through(context: &Context, geoid_height_m: f64) -> f64 {
    let at = |altitude_m: f64| match context.world().kind {
        WorldKind::Ecef => Place { altitude_m: altitude_m + geoid_height_m, ..ORIGIN }.to_ecef(),
        _ => DVec3::new(0.0, 0.0, altitude_m),
    };
    let from = at(2.0);
    let east = context.world().frame_at(from).world_to_enu.transpose() * DVec3::X;
    let between = context.between(from, from + 100.0 * east, 0.0).unwrap();
    // Above its top the fog has ended in all worlds alike.
    let clear = context.between(at(30.0), at(30.0) + 100.0 * east, 0.0).unwrap();
    assert!(clear.transmittance[1] > 0.9, "{clear:?}");
    between.transmittance[1]
}

#[test]
fn shallow_fog_lies_on_the_sea_of_an_earth_centred_world() {
    let flat = through(&context(WorldKind::Flat, 0.0), 0.0);
    // 200 m of visibility: exp(-3.0 / 2) (Koschmieder 1924).
    assert!((0.15..0.3).contains(&flat), "{flat}");
    for geoid_height_m in [-30.0, 0.0, GEOID_M] {
        let found = through(&context(WorldKind::Ecef, geoid_height_m), geoid_height_m);
        assert!((found - flat).abs() < 1e-3 * flat, "{found} over a geoid of {geoid_height_m} m, {flat} over a plane");
    }
    // Taken for an altitude, the height above the ellipsoid is above the fog.
    let lost = through_ignored();
    assert!(lost > 0.9, "{lost}");
}

fn through_ignored() -> f64 {
    let context = context(WorldKind::Ecef, 0.0);
    let from = Place { altitude_m: 2.0 + GEOID_M, ..ORIGIN }.to_ecef();
    let east = context.world().frame_at(from).world_to_enu.transpose() * DVec3::X;
    context.between(from, from + 100.0 * east, 0.0).unwrap().transmittance[1]
}

#[test]
fn rain_ends_at_the_altitude_of_its_cloud() {
    let mut context = context(WorldKind::Ecef, GEOID_M);
    context.set_weather(&Weather::default(), 0.0, 0.0).unwrap();
    let at = |altitude_m: f64| Place { altitude_m: altitude_m + GEOID_M, ..ORIGIN }.to_ecef();
    let area = RainArea { center_m: at(0.0).to_array(), top_m: 1000.0, ..RainArea::default() };
    context.set_rain_areas(&[area]).unwrap();
    let rate = |altitude_m: f64| context.rain_at(at(altitude_m), 0.0).unwrap().rate_mm_h;
    assert!(rate(980.0) > 0.0 && rate(1020.0) == 0.0, "{} {}", rate(980.0), rate(1020.0));
}

#[test]
fn a_state_loads_only_with_its_geoid_height_and_states_without_one_have_none() {
    let [none, some] = [0.0, GEOID_M].map(|geoid_m| context(WorldKind::Ecef, geoid_m));
    let (of_none, of_some) = (none.save().unwrap(), some.save().unwrap());
    assert!(!String::from_utf8(of_none.clone()).unwrap().contains("geoid"), "states of before know no geoid");
    assert_ne!(none.state_hash().unwrap(), some.state_hash().unwrap());
    context(WorldKind::Ecef, 0.0).load(&of_none).unwrap();
    context(WorldKind::Ecef, GEOID_M).load(&of_some).unwrap();
    for (mut context, state) in [(none, of_some), (some, of_none)] {
        let e = context.load(&state).unwrap_err().to_string();
        assert!(e.contains("geoid_height_m"), "{e}");
    }
}
