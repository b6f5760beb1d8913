//! The sea as a host queries it: over updates, at all times, after saving and loading, and with refused values.

use glam::DVec3;
use welkin::{
    Status,
    context::Context,
    sea::{SeaPoint, SeaSettings, SeaSwell, WindSea},
    weather::{Weather, Wind},
};

use crate::host::Host;

fn points(context: &Context, time_s: f64) -> Vec<SeaPoint> {
    let places: Vec<DVec3> = (0..8).map(|i| DVec3::new(1e5 + 71.0 * f64::from(i), -3e5, 4.0)).collect();
    let mut out = vec![SeaPoint::default(); places.len()];
    context.sea_at(&places, time_s, 0.0, &mut out).unwrap();
    out
}

fn blowing(speed: f64, from_deg: f64) -> Weather {
    Weather { wind: Wind::of(speed, from_deg), ..Weather::default() }
}

/// A context whose weather changes twice within the first hours.
fn changing(host: &Host) -> Context {
    let mut context = host.context();
    context.set_weather(&blowing(5.0, 250.0), 0.0, 0.0).unwrap();
    context.set_sea(Some(SeaSettings { fetch_m: Some(3e5), ..SeaSettings::default() })).unwrap();
    context.set_weather(&blowing(17.0, 300.0), 600.0, 900.0).unwrap();
    context.set_weather(&blowing(8.0, 200.0), 9000.0, 600.0).unwrap();
    context
}

#[test]
fn updates_leave_the_sea_of_every_time_as_it_is() {
    let host = Host::new();
    let (ahead, mut often, mut once) = (changing(&host), changing(&host), changing(&host));
    let wanted: Vec<_> = [9700.0, 20_000.0, 1e6].iter().map(|t| points(&ahead, *t)).collect();
    for step in 1..=97 {
        often.update(100.0 * f64::from(step)).unwrap();
    }
    once.update(9700.0).unwrap();
    for context in [&often, &once] {
        let found: Vec<_> = [9700.0, 20_000.0, 1e6].iter().map(|t| points(context, *t)).collect();
        assert_eq!(found, wanted);
    }
    assert_eq!(often.state_hash(), once.state_hash());
    // The waves of the gale are still there: a context that begins with the present wind has lower ones.
    let mut late = host.context();
    late.set_weather(&blowing(8.0, 200.0), 0.0, 0.0).unwrap();
    late.set_sea(often.sea().cloned()).unwrap();
    let height = |context: &Context| context.sea_statistics(9700.0).unwrap().significant_height_m;
    assert!(height(&often) > 1.02 * height(&late), "{} {}", height(&often), height(&late));
}

#[test]
fn saved_seas_go_on_bit_for_bit() {
    let host = Host::new();
    let mut context = changing(&host);
    context.update(9700.0).unwrap();
    let wanted = points(&context, 12_345.0);
    let state = context.save().unwrap();
    let mut other = host.context();
    assert_eq!(other.sea(), None);
    other.load(&state).unwrap();
    assert_eq!((other.sea(), points(&other, 12_345.0)), (context.sea(), wanted));
    assert_eq!(other.state_hash(), context.state_hash());
    // All settings come back.
    let swell = SeaSwell { height_m: 1.0, period_s: 11.0, from_deg: 20.0, spread_deg: Some(9.0) };
    for wind_sea in [
        WindSea::SeaState(3),
        WindSea::Beaufort(4.5),
        WindSea::Height { significant_m: 2.0, peak_period_s: Some(8.0), gamma: None },
    ] {
        let settings = SeaSettings { wind_sea, swells: Some(vec![swell]), level_m: -1.5, ..SeaSettings::default() };
        context.set_sea(Some(settings.clone())).unwrap();
        other.load(&context.save().unwrap()).unwrap();
        assert_eq!(other.sea(), Some(&settings));
        assert_eq!(points(&other, 5e4), points(&context, 5e4));
    }
}

#[test]
fn faults_are_named_and_change_nothing() {
    let mut context = Host::new().context();
    let mut out = [SeaPoint::default(); 1];
    let asked = |context: &Context, out: &mut [SeaPoint], time_s: f64, shortest_m: f64| {
        context.sea_at(&[DVec3::ZERO], time_s, shortest_m, out).map_err(|e| (e.status, e.field().map(str::to_owned)))
    };
    assert_eq!(asked(&context, &mut out, 0.0, 0.0), Err((Status::WrongOrder, None)));
    assert_eq!(context.sea_statistics(0.0).unwrap_err().status, Status::WrongOrder);
    context.set_sea(Some(SeaSettings::default())).unwrap();
    let invalid = |field: &str| Err((Status::InvalidArgument, Some(field.to_owned())));
    assert_eq!(asked(&context, &mut out, f64::NAN, 0.0), invalid("time_s"));
    assert_eq!(asked(&context, &mut out, 0.0, -1.0), invalid("shortest_wave_m"));
    assert_eq!(asked(&context, &mut [], 0.0, 0.0), invalid("points"));
    let nowhere = [DVec3::ZERO, DVec3::new(f64::NAN, 0.0, 0.0)];
    let e = context.sea_at(&nowhere, 0.0, 0.0, &mut [SeaPoint::default(); 2]).unwrap_err();
    assert!(e.field().is_some_and(|field| field.starts_with("positions[1]")), "{e}");
    let steep = WindSea::Height { significant_m: 10.0, peak_period_s: Some(4.0), gamma: None };
    let e = context.set_sea(Some(SeaSettings { wind_sea: steep, ..SeaSettings::default() })).unwrap_err();
    assert_eq!((e.status, e.field()), (Status::InvalidArgument, Some("wind_sea.significant_m")), "{e}");
    assert_eq!(context.sea(), Some(&SeaSettings::default()));
    assert_eq!(out[0], SeaPoint::default());
}
