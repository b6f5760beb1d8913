//! Leaps in time: updates in several calls lead to the same state, whatever is set meanwhile, and pictures show the
//! state as far as it has advanced.

use std::time::Duration;

use glam::DVec3;
use welkin::{
    Status,
    context::{Context, GivenDirection},
    fog::Law,
    ground::GroundCell,
    ground::GroundGrid,
    rain::RainArea,
    sky::sun::Utc,
    weather::{Weather, Wind},
};

use crate::{
    host::Host,
    terrain::{grid, put_terrain, rain, roof, simulated},
};

const STEP_S: f64 = 10.0;

/// Showers on the terrain, an area over a part of it, a roof.
fn day(host: &Host) -> Context {
    let mut context = simulated(host);
    let clear = Weather { wind: Wind::of(6.0, 200.0), ..Weather::preset("clear").unwrap() };
    for hour in 0..3 {
        let start_s = f64::from(hour) * 7200.0;
        context.set_weather(&rain(8.0, 4.0), start_s + 100.0, 137.0).unwrap();
        context.set_weather(&clear, start_s + 2000.0, 61.0).unwrap();
    }
    put_terrain(&mut context);
    context
}

fn cells(context: &Context) -> Vec<GroundCell> {
    context.ground_cells().unwrap().collect()
}

/// Sets everything on which the water depends to other values.
fn set_other(context: &mut Context, with_grid: bool) {
    context.set_shelters(&[roof([5.0, 10.0, 3.0], [6.0, 6.0, 0.2])]).unwrap();
    context.set_rain_areas(&[RainArea { rate_mm_h: 90.0, at_s: context.time_s(), ..RainArea::default() }]).unwrap();
    context.set_sun(Some(GivenDirection { azimuth_deg: 200.0, elevation_deg: 70.0 })).unwrap();
    context.set_clock(Utc(1.7e9), 0.0).unwrap();
    context.set_fog_law(Some(Law::Clear)).unwrap();
    context.set_weather(&rain(30.0, 9.0), context.time_s(), 30.0).unwrap();
    if with_grid {
        let heights_m = grid().heights_m.iter().rev().copied().collect();
        context.set_ground_grid(Some(GroundGrid { heights_m, ..grid() })).unwrap();
    }
}

#[test]
fn any_division_into_calls_gives_the_same_state_whatever_is_set_meanwhile() {
    let host = Host::new();
    for with_grid in [false, true] {
        let mut whole = day(&host);
        whole.update(20_005.0).unwrap();
        set_other(&mut whole, with_grid);
        whole.update(20_700.0).unwrap();
        for most_us in [0, 300, 20_000] {
            let most = Duration::from_micros(most_us);
            let mut parts = day(&host);
            let mut calls = 0;
            while parts.update_within(20_005.0, most).unwrap() == Status::Pending {
                calls += 1;
                if calls == 1 {
                    set_other(&mut parts, with_grid);
                }
            }
            if calls == 0 {
                set_other(&mut parts, with_grid);
            }
            // Each call takes at least one step, and exactly one if it has no time.
            assert!(calls <= 2000 && (most_us > 0 || calls == 1999), "{calls}");
            while parts.update_within(20_700.0, most).unwrap() == Status::Pending {}
            assert!(cells(&parts) == cells(&whole), "{most_us} us, {calls} calls");
            assert_eq!(parts.ground_water(), whole.ground_water(), "{most_us} us, {calls} calls");
            assert_eq!(parts.state_hash().unwrap(), whole.state_hash().unwrap(), "{most_us} us, {calls} calls");
        }
    }
}

#[test]
fn while_steps_remain_the_state_is_shown_as_far_as_it_has_advanced() {
    let host = Host::new();
    let (mut context, mut behind) = (day(&host), day(&host));
    let at = DVec3::new(6.0, 12.0, 0.0);
    assert_eq!(context.state_time_s(), 0.0);
    for i in 1..=120 {
        assert_eq!(context.update_within(7000.0, Duration::ZERO).unwrap(), Status::Pending);
        assert_eq!((context.time_s(), context.state_time_s()), (7000.0, f64::from(i) * STEP_S));
    }
    // The weather is that of the new time, the water that of the state.
    behind.update(1200.0).unwrap();
    assert_eq!(context.ground_water(), behind.ground_water());
    assert!(cells(&context) == cells(&behind) && context.ground_at(at).unwrap() == behind.ground_at(at).unwrap());
    assert!(context.rain_at(at, 7000.0).is_ok());
    // While steps remain no state can be saved, a later time is not reached, an earlier one is refused, and a load ends
    // the update.
    for e in [context.save().unwrap_err(), context.state_hash().unwrap_err()] {
        assert!(
            e.status == Status::WrongOrder
                && e.to_string().contains("wk_context_update")
                && e.to_string().contains("7000")
        );
    }
    assert_eq!(context.update_within(9000.0, Duration::ZERO).unwrap(), Status::Pending);
    assert_eq!((context.time_s(), context.state_time_s()), (7000.0, 1210.0));
    assert_eq!(context.update(6999.0).unwrap_err().status, Status::WrongOrder);
    let mut other = day(&host);
    other.update_within(7000.0, Duration::ZERO).unwrap();
    other.load(&behind.save().unwrap()).unwrap();
    assert_eq!(other.save().unwrap(), behind.save().unwrap());
    assert_eq!(other.state_time_s(), 1200.0);
    // The later time is reached in the end.
    context.update(9000.0).unwrap();
    behind.update(9000.0).unwrap();
    assert_eq!((context.time_s(), context.state_time_s()), (9000.0, 9000.0));
    assert!(cells(&context) == cells(&behind));
    assert_eq!(context.state_hash().unwrap(), behind.state_hash().unwrap());
    // The same time again changes nothing.
    let revision = context.ground_revision();
    assert_eq!(context.update_within(9000.0, Duration::ZERO).unwrap(), Status::Ok);
    assert_eq!(context.ground_revision(), revision);
}

#[test]
fn a_leap_of_more_than_a_day_begins_a_day_before_its_end() {
    let host = Host::new();
    let (a_day, rainy) = (86_400.0, rain(20.0, 3.0));
    // After a long leap the earlier wetness does not matter, for level ground and for the terrain.
    let leapt = |from: &Weather, to_s: f64| {
        let mut context = simulated(&host);
        context.set_weather(from, 0.0, 0.0).unwrap();
        context.set_ground_grid(Some(grid())).unwrap();
        context.update(3600.0).unwrap();
        let calm = Weather { relative_humidity: 1.0, wind: Wind::of(0.0, 0.0), ..Weather::default() };
        context.set_weather(&calm, 3600.0, 0.0).unwrap();
        context.update(to_s).unwrap();
        context
    };
    let dry = Weather::preset("clear").unwrap();
    let [wet, never] = [&rainy, &dry].map(|from| leapt(from, 3600.0 + a_day + 1.0));
    assert!(cells(&wet) == cells(&never) && wet.ground_water() == never.ground_water());
    let [wet, never] = [&rainy, &dry].map(|from| leapt(from, 3600.0 + a_day));
    assert!(cells(&wet) != cells(&never), "a day is simulated as a whole");
    // Leaps that end a few seconds apart begin at the same time.
    let ends = [0.0, 1.0, 7.0].map(|s| {
        let mut context = leapt(&rainy, 200_000.0 + s);
        context.update(200_007.0).unwrap();
        (cells(&context), context.ground_water())
    });
    assert!(ends[0] == ends[1] && ends[0] == ends[2]);
}
