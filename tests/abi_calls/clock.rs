//! The clock at leap days and at the ends of days and years: sun and moon move on without a jump.

use welkin::capi::{conditions::*, query::*, status::*, timeline::*, weather::*};

use super::world::{World, init, message};

const DAY_S: f64 = 86_400.0;

fn utc([year, month, day, hour, minute]: [i32; 5], second: f64) -> Result<f64, String> {
    let [month, day, hour, minute] = [month, day, hour, minute].map(|n| n as u32);
    let mut utc_s = f64::NAN;
    // SAFETY: a live pointer.
    match unsafe { wk_utc_from_calendar(year, month, day, hour, minute, second, &mut utc_s) } {
        WK_OK => Ok(utc_s),
        status => {
            assert_eq!(status, WK_ERROR_INVALID_ARGUMENT);
            assert!(utc_s.is_nan(), "what is refused writes nothing");
            Err(message())
        }
    }
}

fn midnight(year: i32, month: i32, day: i32) -> f64 {
    utc([year, month, day, 0, 0], 0.0).unwrap()
}

#[test]
fn leap_days_are_there_in_leap_years_alone() {
    for year in [-2000, -4, 0, 4, 1600, 1972, 2000, 2024, 2028, 2400, 5996] {
        let day = midnight(year, 2, 29);
        assert!(
            (day - midnight(year, 2, 28) - DAY_S).abs() < 1e-3 && (midnight(year, 3, 1) - day - DAY_S).abs() < 1e-3
        );
        assert!((midnight(year + 1, 1, 1) - midnight(year, 1, 1) - 366.0 * DAY_S).abs() < 1e-3, "{year}");
    }
    for year in [-1999, -100, 1, 1700, 1800, 1900, 2023, 2026, 2100, 2200, 5900] {
        let refused = utc([year, 2, 29, 12, 0], 0.0).expect_err("no leap year");
        assert!(refused.contains("wk_utc_from_calendar"), "{refused}");
        assert!((midnight(year, 3, 1) - midnight(year, 2, 28) - DAY_S).abs() < 1e-3, "{year}");
        assert!((midnight(year + 1, 1, 1) - midnight(year, 1, 1) - 365.0 * DAY_S).abs() < 1e-3, "{year}");
    }
    for [month, day] in [[4, 31], [6, 31], [1, 32], [1, 0], [0, 1], [13, 1], [2, 30]] {
        assert!(utc([2024, month, day, 0, 0], 0.0).is_err(), "{month}-{day}");
    }
}

#[test]
fn days_and_years_end_where_the_next_begin() {
    // Unix time by its definition (POSIX.1-2017, 4.16).
    for (date, unix) in [
        ([1970, 1, 1], 0.0),
        ([2000, 1, 1], 946_684_800.0),
        ([2000, 2, 29], 951_782_400.0),
        ([2026, 12, 31], 1_798_675_200.0),
        ([2027, 1, 1], 1_798_761_600.0),
        ([1969, 12, 31], -DAY_S),
    ] {
        let got = midnight(date[0], date[1], date[2]);
        assert!((got - unix).abs() < 1e-3, "{date:?}: {got}");
    }
    for [year, month, day, y, m, d] in
        [[2026, 12, 31, 2027, 1, 1], [1999, 12, 31, 2000, 1, 1], [2024, 2, 28, 2024, 2, 29], [2024, 2, 29, 2024, 3, 1]]
    {
        let last = utc([year, month, day, 23, 59], 59.0).unwrap();
        assert!((midnight(y, m, d) - last - 1.0).abs() < 1e-3, "{year}-{month}-{day}");
    }
    for [hour, minute] in [[24, 0], [23, 60]] {
        assert!(utc([2026, 1, 1, hour, minute], 0.0).is_err(), "{hour}:{minute}");
    }
    assert!(utc([2026, 1, 1, 0, 0], -0.5).is_err() && utc([2026, 1, 1, 0, 0], 61.0).is_err());
}

#[test]
fn sun_and_moon_go_on_over_midnight_the_leap_day_and_the_years_end() {
    let world = World::new();
    let seams = [[2027, 1, 1], [2000, 1, 1], [2024, 2, 29], [2024, 3, 1], [2026, 6, 21], [1900, 3, 1], [1970, 1, 1]];
    for [year, month, day] in seams {
        // SAFETY: live pointers.
        unsafe { assert_eq!(wk_context_set_clock(world.context, midnight(year, month, day), 0.0), WK_OK) };
        let at = |time_s: f64| {
            let mut both = [init::<wk_celestial>("wk_celestial"), init("wk_celestial")];
            // SAFETY: live pointers.
            unsafe {
                assert_eq!(
                    wk_context_get_sun_at(world.context, &[0.0; 3], time_s, &mut both[0]),
                    WK_OK,
                    "{}",
                    message()
                );
                assert_eq!(wk_context_get_moon_at(world.context, &[0.0; 3], time_s, &mut both[1]), WK_OK);
            }
            both.map(|b| (b.direction, b.illuminance_lux))
        };
        let mut last = at(-10.0);
        for i in -9..=10 {
            let now = at(f64::from(i));
            for (which, (before, after)) in last.iter().zip(&now).enumerate() {
                let step = (0..3).map(|k| (after.0[k] - before.0[k]).powi(2)).sum::<f64>().sqrt().to_degrees();
                // The sky turns by 15.04 seconds of arc a second, times the cosine of the declination: 0.84 at least.
                assert!((0.0033..0.0043).contains(&step), "{year}-{month}-{day} {i} s, {which}: {step} degrees");
                let change = (0..3).map(|k| (after.1[k] / before.1[k] - 1.0).abs()).fold(0.0, f64::max);
                assert!(change < 1e-4, "{year}-{month}-{day} {i} s, {which}: light changes by {change}");
            }
            last = now;
        }
    }
}

/// Weather and light on the ground, second by second over the end of a day: nothing jumps, and a change of weather
/// proceeds as at any other hour.
#[test]
fn the_timeline_and_the_light_go_on_over_the_calendars_seams() {
    let answers_around = |utc_s: f64| {
        let world = World::new();
        let (from, to) = (
            wk_weather { visibility_m: 2000.0, temperature_c: 3.0, ..init("wk_weather") },
            wk_weather { visibility_m: 20_000.0, temperature_c: 12.0, ..init("wk_weather") },
        );
        let mut answers = Vec::new();
        // SAFETY: live pointers with the sizes given.
        unsafe {
            assert_eq!(wk_context_set_weather(world.context, &from, 0.0, 0.0), WK_OK, "{}", message());
            assert_eq!(wk_context_set_weather(world.context, &to, 1000.0, 600.0), WK_OK, "{}", message());
            // Midnight falls in the middle of the change.
            assert_eq!(wk_context_set_clock(world.context, utc_s, 1300.0), WK_OK, "{}", message());
            for i in 0..=20 {
                let time_s = 1290.0 + f64::from(i);
                let mut now = init::<wk_conditions>("wk_conditions");
                let mut light: [wk_ground_light; 1] = std::mem::zeroed();
                let size = size_of::<wk_ground_light>() as u32;
                let at = [0.0; 3];
                assert_eq!(wk_context_get_conditions(world.context, &at, time_s, &mut now), WK_OK, "{}", message());
                let got = wk_context_get_light_at(world.context, &at, 1, 24, time_s, light.as_mut_ptr(), size);
                assert_eq!(got, WK_OK, "{}", message());
                answers.push((now.visibility_m, now.temperature_c, light[0].total_lux + 1.0));
            }
        }
        answers
    };
    let noon = answers_around(midnight(2026, 5, 5) + 0.5 * DAY_S);
    for [year, month, day] in [[2024, 2, 29], [2024, 3, 1], [2027, 1, 1], [2000, 1, 1], [2100, 3, 1]] {
        let seam = answers_around(midnight(year, month, day));
        for (i, pair) in seam.windows(2).enumerate() {
            let change = |a: f64, b: f64| (b / a - 1.0).abs();
            let worst =
                change(pair[0].0, pair[1].0).max(change(pair[0].1, pair[1].1)).max(change(pair[0].2, pair[1].2));
            assert!(worst < 0.02, "{year}-{month}-{day}, step {i}: {pair:?}");
        }
        for (a, b) in seam.iter().zip(&noon) {
            assert_eq!((a.0, a.1), (b.0, b.1), "the weather does not ask the calendar");
        }
        assert!(seam[0].0 < seam[20].0, "{seam:?}");
    }
}
