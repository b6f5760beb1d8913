//! Limits: a value beyond a limit is refused with the parameter's name in the header, a value at a limit is accepted
//! everywhere, and a call for several places writes nothing if one of them is invalid.

use std::ffi::{CString, c_char, c_void};
use std::ptr::{null, null_mut};

use welkin::capi::{
    area::*, conditions::*, context::*, fog_law::*, frame::*, ground::*, query::*, radiance::*, report::*, stars::*,
    status::*, timeline::*, view::*, weather::*, wind::*,
};

use super::world::{World, init, message, next_frame};

/// Calls every query that takes a place. Returns the name of the place's parameter, the status and the message of each.
fn ask(world: &World, at: [f64; 3]) -> Vec<(&'static str, wk_status, String)> {
    let (context, mut answers) = (world.context, Vec::new());
    let mut take = |name, status| answers.push((name, status, message()));
    let near = [at[0], at[1], at[2] * (1.0 - 1e-9) + 1.0];
    // SAFETY: live handles, locals with the sizes given.
    unsafe {
        let mut conditions = init::<wk_conditions>("wk_conditions");
        take("position_m", wk_context_get_conditions(context, &at, 0.0, &mut conditions));
        let mut count = 0;
        take("position_m", wk_context_get_cloud_slabs(context, &at, 0.0, null_mut(), 0, 64, &mut count));
        let mut light = init::<wk_celestial>("wk_celestial");
        take("position_m", wk_context_get_sun(context, &at, &mut light));
        take("position_m", wk_context_get_sun_at(context, &at, 0.0, &mut light));
        take("position_m", wk_context_get_moon(context, &at, &mut light));
        take("position_m", wk_context_get_moon_at(context, &at, 0.0, &mut light));
        let mut lit: [wk_ground_light; 1] = std::mem::zeroed();
        let size = size_of::<wk_ground_light>() as u32;
        take("positions_m[0]", wk_context_get_light(context, &at, 1, 24, lit.as_mut_ptr(), size));
        take("positions_m[0]", wk_context_get_light_at(context, &at, 1, 24, 0.0, lit.as_mut_ptr(), size));
        let mut between: [wk_between; 1] = std::mem::zeroed();
        let sizes = [size_of::<wk_segment>() as u32, size_of::<wk_between>() as u32];
        let segment = wk_segment { from_m: at, to_m: near };
        let way = |s: &wk_segment, b: &mut [wk_between; 1]| {
            wk_context_get_between_at(context, s, 1, sizes[0], 0.0, b.as_mut_ptr(), sizes[1])
        };
        take("segments[0].from_m", way(&segment, &mut between));
        let mut wind = init::<wk_wind>("wk_wind");
        take("position_m", wk_context_get_wind_at(context, &at, 0.0, &mut wind));
        let mut rainfall = init::<wk_rainfall>("wk_rainfall");
        take("position_m", wk_context_get_rainfall_at(context, &at, 0.0, &mut rainfall));
        let up = wk_rain_surface { position_m: at, normal: [0.0, 0.0, 1.0], velocity_m_s: [0.0; 3], area_m2: 1.0 };
        let mut on: [wk_rain_on; 1] = std::mem::zeroed();
        let sizes = [size_of::<wk_rain_surface>() as u32, size_of::<wk_rain_on>() as u32];
        let landed = wk_context_get_rain_on_at(context, &up, 1, sizes[0], 0.0, on.as_mut_ptr(), sizes[1]);
        take("surfaces[0].position_m", landed);
        let mut ground = init::<wk_ground>("wk_ground");
        take("position_m", wk_context_get_ground(context, &at, &mut ground));
        let mut seen: [wk_sky_radiance; 1] = std::mem::zeroed();
        let size = size_of::<wk_sky_radiance>() as u32;
        let (up, out) = ([0.0, 0.0, 1.0], seen.as_mut_ptr());
        take("position_m", wk_context_get_sky_radiance(context, &at, &up, 1, 24, out, size));
        take("position_m", wk_context_get_sky_radiance_at(context, &at, &up, 1, 24, 0.0, out, size));
        let mut ambient = init::<wk_ambient>("wk_ambient");
        take("position_m", wk_context_get_ambient(context, &at, &mut ambient));
        take("position_m", wk_context_get_ambient_at(context, &at, 0.0, &mut ambient));
        let (mut visibility_m, mut magnitude) = (0.0, 0.0);
        take("position_m", wk_context_get_visibility_at(context, &at, &up, 0.0, &mut visibility_m));
        take("position_m", wk_context_get_limiting_magnitude_at(context, &at, 0.0, &mut magnitude));
        assert!(visibility_m >= 0.0 && magnitude < 30.0, "{at:?}: {visibility_m} {magnitude}");
        let frame = wk_frame { frame_id: next_frame(), position_m: at, ..init("wk_frame") };
        take("frame.position_m", wk_view_record(world.view, &frame, WK_STAGE_PREPARE));
        let finite = |values: &[f64]| assert!(values.iter().all(|v| v.is_finite()), "{at:?}: {values:?}");
        finite(&lit[0].sky_lux);
        finite(&between[0].transmittance);
        finite(&light.direction);
        finite(&wind.velocity_m_s);
        finite(&ambient.sh9);
        finite(&seen[0].radiance_cd_m2);
    }
    answers
}

#[test]
fn an_impossible_place_is_named_as_in_the_header() {
    let world = World::new();
    let far = [[0.0, 0.0, 2e9], [0.0, 0.0, -2e4], [1e308, 0.0, 0.0], [0.0, -1e308, 10.0], [2e12, 0.0, 0.0]];
    for at in far {
        for (name, status, text) in ask(&world, at) {
            assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{name} {at:?}: {text}");
            assert!(text.contains(&format!(": {name} must be ")), "{name} {at:?}: {text}");
        }
    }
    let segment = wk_segment { from_m: [0.0; 3], to_m: [0.0, 0.0, 2e9] };
    let areas = [wk_rain_area { center_m: [0.0, 0.0, 2e9], ..init("wk_rain_area") }];
    // SAFETY: live handles, locals with the sizes given.
    unsafe {
        let mut between: [wk_between; 1] = std::mem::zeroed();
        let sizes = [size_of::<wk_segment>() as u32, size_of::<wk_between>() as u32];
        let status = wk_context_get_between(world.context, &segment, 1, sizes[0], between.as_mut_ptr(), sizes[1]);
        assert!(status == WK_ERROR_INVALID_ARGUMENT && message().contains(": segments[0].to_m must"), "{}", message());
        let stride = size_of::<wk_rain_area>() as u32;
        let status = wk_context_set_rain_areas(world.context, areas.as_ptr(), 1, stride);
        assert!(status == WK_ERROR_INVALID_ARGUMENT && message().contains(": areas[0].center_m must"), "{}", message());
    }
}

/// The lowest and the highest altitude are accepted all over the Earth, even with rounded coordinates.
#[test]
fn the_ends_of_the_altitudes_are_places_everywhere() {
    let mut world = World::new();
    let [a, e2] = [6_378_137.0_f64, 6.694_379_990_141_4e-3];
    for kind in [WK_WORLD_ECEF, WK_WORLD_TANGENT, WK_WORLD_FLAT] {
        for latitude_deg in [-90.0, -33.1, 0.0, 47.2, 81.9] {
            for longitude_deg in [-84.2, 0.0, 123.4] {
                for altitude_m in [-1e4, 1e9] {
                    let (sp, cp) = f64::to_radians(latitude_deg).sin_cos();
                    let (sl, cl) = f64::to_radians(longitude_deg).sin_cos();
                    let n = a / (1.0 - e2 * sp * sp).sqrt();
                    let r = (n + altitude_m) * cp;
                    let at = match kind {
                        WK_WORLD_ECEF => [r * cl, r * sl, (n * (1.0 - e2) + altitude_m) * sp],
                        _ => [0.0; 3],
                    };
                    // SAFETY: live handles and locals.
                    unsafe {
                        assert_eq!(wk_view_destroy(world.view), WK_OK);
                        assert_eq!(wk_context_destroy(world.context), WK_OK);
                        let desc = wk_context_desc {
                            world_kind: kind,
                            latitude_deg,
                            longitude_deg,
                            altitude_m,
                            ..init("wk_context_desc")
                        };
                        let made = wk_context_create(world.device, &desc, &mut world.context);
                        assert_eq!(made, WK_OK, "{}", message());
                        let made = wk_view_create(world.context, &init("wk_view_desc"), &mut world.view);
                        assert_eq!(made, WK_OK, "{}", message());
                    }
                    for (name, status, text) in ask(&world, at) {
                        let beside = name.starts_with("segments");
                        assert!(status == WK_OK || beside, "{kind} {latitude_deg} {longitude_deg}: {name}: {text}");
                    }
                }
            }
        }
    }
}

#[test]
fn calendars_end_where_the_almanac_does_and_know_leap_seconds() {
    let of = |year, month, day, hour, minute, second| {
        let mut utc_s = f64::NAN;
        // SAFETY: a live local.
        let status = unsafe { wk_utc_from_calendar(year, month, day, hour, minute, second, &mut utc_s) };
        if status == WK_OK { Ok(utc_s) } else { Err(message()) }
    };
    assert_eq!(of(1970, 1, 1, 0, 0, 0.0), Ok(0.0));
    assert_eq!(of(2000, 2, 29, 12, 0, 0.5), Ok(951_825_600.5));
    assert_eq!(of(1900, 3, 1, 0, 0, 0.0), Ok(-2_203_891_200.0));
    assert_eq!(of(2026, 6, 21, 10, 0, 0.0), Ok(1_782_036_000.0));
    // Unix time of the leap second at the end of 2016 is that of the second after it.
    assert_eq!(of(2016, 12, 31, 23, 59, 60.25), of(2017, 1, 1, 0, 0, 0.25));
    assert!(of(-2000, 1, 1, 0, 0, 0.0).is_ok() && of(6000, 12, 31, 23, 59, 59.0).is_ok());
    for (date, name) in [
        (of(6001, 1, 1, 0, 0, 0.0), "year must be in [-2000, 6000]"),
        (of(-2001, 12, 31, 0, 0, 0.0), "year must"),
        (of(i32::MAX, 1, 1, 0, 0, 0.0), "year must"),
        (of(2026, 0, 1, 0, 0, 0.0), "month must be in [1, 12]"),
        (of(2026, u32::MAX, 1, 0, 0, 0.0), "month must"),
        (of(2026, 2, 29, 0, 0, 0.0), "day must be in [1, 28]"),
        (of(1900, 2, 29, 0, 0, 0.0), "day must be in [1, 28]"),
        (of(2026, 4, 31, 0, 0, 0.0), "day must be in [1, 30]"),
        (of(2026, 1, 0, 0, 0, 0.0), "day must"),
        (of(2026, 1, 1, 24, 0, 0.0), "hour must be in [0, 23]"),
        (of(2026, 1, 1, 0, 60, 0.0), "minute must be in [0, 59]"),
        (of(2026, 1, 1, 12, 30, 60.0), "second must be in [0, 60)"),
        (of(2026, 1, 1, 23, 59, 61.0), "second must"),
        (of(2026, 1, 1, 23, 59, -0.5), "second must"),
        (of(2026, 1, 1, 0, 0, f64::NAN), "second must"),
    ] {
        assert!(date.as_ref().is_err_and(|e| e.contains(&format!(": {name}"))), "{name}: {date:?}");
    }
}

/// Every date of the years that the almanac knows is a day after the one before.
#[test]
fn days_of_the_calendar_follow_each_other() {
    let mut last = f64::NEG_INFINITY;
    for year in -2000..=6000 {
        for month in 1..=12 {
            for day in [1, 28, 29, 30, 31] {
                let mut utc_s = 0.0;
                // SAFETY: a live local.
                if unsafe { wk_utc_from_calendar(year, month, day, 0, 0, 0.0, &mut utc_s) } == WK_OK {
                    let days = (utc_s - last) / 86_400.0;
                    assert!(days == 1.0 || days == 27.0 || last < -1e300, "{year}-{month}-{day}: {days}");
                    last = utc_s;
                }
            }
        }
    }
}

#[test]
fn start_times_have_the_range_of_update_times() {
    let world = World::new();
    let weather = init::<wk_weather>("wk_weather");
    // SAFETY: live handles and locals.
    unsafe {
        let set = |start| wk_context_set_weather(world.context, &weather, start, 10.0);
        for beyond in [1.000_001e10, 1e12, -1.000_001e10] {
            assert_eq!(set(beyond), WK_ERROR_INVALID_ARGUMENT);
            assert!(message().contains(": start_time_s must be in [-10000000000, 10000000000] s"), "{}", message());
        }
        assert_eq!(set(1e10), WK_OK, "{}", message());
        // Light cannot be queried at a time that the clock cannot show.
        assert_eq!(wk_context_set_clock(world.context, 1.27e11, 0.0), WK_OK, "{}", message());
        let mut sun = init::<wk_celestial>("wk_celestial");
        assert_eq!(wk_context_get_sun_at(world.context, &[0.0; 3], 1e10, &mut sun), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains(": time_s must be a time at which the context's clock"), "{}", message());
    }
}

#[test]
fn a_law_without_a_curve_is_checked_all_the_same() {
    let world = World::new();
    let clear = wk_fog_law { curve: WK_FOG_CURVE_CLEAR, ..init("wk_fog_law") };
    // SAFETY: live handles and locals.
    unsafe {
        assert_eq!(wk_context_set_fog_law(world.context, &clear), WK_OK, "{}", message());
        for (law, name) in [
            (wk_fog_law { density_per_m: -1.0, ..clear }, "fog_law.density_per_m"),
            (wk_fog_law { start_m: -1.0, ..clear }, "fog_law.start_m"),
            (wk_fog_law { end_m: 2e9, ..clear }, "fog_law.end_m"),
            (wk_fog_law { sky_band: 4.0, ..clear }, "fog_law.sky_band"),
            (wk_fog_law { has: WK_FOG_LAW_HAS_COLOR, color: [-1.0; 3], ..clear }, "fog_law.color"),
            (wk_fog_law { curve: WK_FOG_CURVE_EXPONENTIAL, end_m: 2e9, ..clear }, "fog_law.end_m"),
            (wk_fog_law { curve: WK_FOG_CURVE_LINEAR, density_per_m: 11.0, ..clear }, "fog_law.density_per_m"),
        ] {
            let mut distance_m = -1.0;
            assert_eq!(wk_context_set_fog_law(world.context, &law), WK_ERROR_INVALID_ARGUMENT, "{name}");
            assert!(message().contains(&format!(": {name} must be in [")), "{name}: {}", message());
            assert_eq!(wk_fog_law_cull_distance(&law, &mut distance_m), WK_ERROR_INVALID_ARGUMENT, "{name}");
            assert_eq!(distance_m, -1.0);
        }
    }
}

#[test]
fn stars_are_refused_by_name() {
    let world = World::new();
    let plain = wk_stars { flags: WK_STARS_OWN | WK_STARS_TURNED, ..init("wk_stars") };
    let lists = [[0.0, 91.0, 1.0, 6000.0], [10.0, 20.0, 40.0, 6000.0], [10.0, 20.0, 4.0, 0.0]];
    // SAFETY: live handles and locals.
    unsafe {
        assert_eq!(wk_context_set_stars(world.context, &plain), WK_OK, "{}", message());
        let of = |list: &[f64; 4]| wk_stars { stars: list.as_ptr(), star_count: 1, ..plain };
        for (stars, words) in [
            (of(&lists[0]), "stars.stars[1] must be in [-90, 90]"),
            (of(&lists[1]), "stars.stars[2] must be in [-30, 30]"),
            (of(&lists[2]), "stars.stars[3] must be in ["),
            (wk_stars { star_count: 1, ..plain }, "stars.stars must not be NULL"),
            (wk_stars { star_count: 2_000_000, ..of(&lists[0]) }, "stars.star_count must be at most 1000000"),
            (wk_stars { airglow: 11.0, ..plain }, "stars.airglow must be in [0, 10]"),
            (wk_stars { celestial_to_world: [1.0; 9], ..plain }, "stars.celestial_to_world must be a rotation"),
            (wk_stars { flags: 8, ..plain }, "stars.flags"),
        ] {
            assert_eq!(wk_context_set_stars(world.context, &stars), WK_ERROR_INVALID_ARGUMENT, "{words}");
            assert!(message().contains(words), "{words}: {}", message());
        }
        assert_eq!(wk_context_set_stars(world.context, null()), WK_OK);
    }
}

/// All places are checked before any result is written.
#[test]
fn no_result_is_written_where_one_of_several_cannot_be() {
    // SAFETY: live locals; what is misaligned is refused before it is written to.
    unsafe {
        let odd = |p: *mut u64| p.wrapping_byte_add(1);
        let (mut first, mut second) = (7_u64, 7_u64);
        let [name, text] = [&raw mut first, &raw mut second];
        assert_eq!(wk_get_preset(0, name.cast::<*const c_char>(), odd(text).cast()), WK_ERROR_INVALID_ARGUMENT);
        assert!((first, second) == (7, 7) && message().contains("out_description"), "{}", message());
        assert_eq!(wk_get_preset(0, odd(name).cast(), text.cast::<*const c_char>()), WK_ERROR_INVALID_ARGUMENT);
        assert!((first, second) == (7, 7) && message().contains("out_name"), "{}", message());
        let mut parts = [7_u32; 2];
        let [major, minor] = [0, 1].map(|i| parts.as_mut_ptr().wrapping_add(i));
        assert_eq!(wk_version(major, minor, odd(text).cast()), WK_ERROR_INVALID_ARGUMENT);
        assert!(parts == [7, 7] && message().contains("patch"), "{}", message());
        let (mut layers, mut weather) =
            ([init::<wk_cloud_layer>("wk_cloud_layer"); 16], init::<wk_weather>("wk_weather"));
        weather.visibility_m = 77.0;
        layers[0].base_m = 77.0;
        let mut metar = wk_metar { struct_size: 1, ..init("wk_metar") };
        let report = c"METAR EGLL 060850Z 21006KT 4500 -DZ OVC006 11/10 Q1009";
        let size = size_of::<wk_cloud_layer>() as u32;
        let read = wk_weather_from_metar(report.as_ptr(), layers.as_mut_ptr(), 16, size, &mut weather, &mut metar);
        assert_eq!((read, weather.visibility_m, layers[0].base_m), (WK_ERROR_INVALID_ARGUMENT, 77.0, 77.0));
        let read = wk_weather_from_metar(report.as_ptr(), layers.as_mut_ptr(), 0, size, &mut weather, null_mut());
        assert_eq!((read, weather.visibility_m), (WK_ERROR_INVALID_ARGUMENT, 77.0), "{}", message());
    }
}

/// An area with the values of its INIT macro is accepted at any time; it has moved with the wind since time 0.
#[test]
fn a_default_rain_area_is_accepted_whatever_has_been_forgotten() {
    let world = World::new();
    let windy = wk_weather { wind_speed_m_s: 5.0, wind_from_deg: 270.0, ..init("wk_weather") };
    let areas = [wk_rain_area { semi_axes_m: [1000.0; 2], ..init("wk_rain_area") }];
    let stride = size_of::<wk_rain_area>() as u32;
    // SAFETY: live handles and locals.
    unsafe {
        assert_eq!(wk_context_set_weather(world.context, &windy, 0.0, 60.0), WK_OK);
        assert_eq!(wk_context_update(world.context, 600.0), WK_OK);
        let set = |areas: &[wk_rain_area; 1]| wk_context_set_rain_areas(world.context, areas.as_ptr(), 1, stride);
        assert_eq!(set(&areas), WK_OK, "{}", message());
        let mut wind = init::<wk_wind>("wk_wind");
        assert_eq!(wk_context_get_wind_at(world.context, &[0.0; 3], 600.0, &mut wind), WK_OK);
        let rate = |x: f64, y: f64| {
            let mut rainfall = init::<wk_rainfall>("wk_rainfall");
            let status = wk_context_get_rainfall_at(world.context, &[x, y, 2.0], 600.0, &mut rainfall);
            assert_eq!(status, WK_OK, "{}", message());
            rainfall.rate_mm_h
        };
        let [east, north, _] = wind.displacement_m;
        assert!(east > 2000.0 && (rate(east, north) - 10.0).abs() < 1e-3, "{east} {}", rate(east, north));
        assert_eq!(rate(0.0, 0.0), 0.0);
        let forgotten = [wk_rain_area { at_s: 30.0, ..areas[0] }];
        assert_eq!(set(&forgotten), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains(": areas[0].at_s must be 0, or at least 60 s"), "{}", message());
    }
}

/// Errors quote only the beginning of a host's text.
#[test]
fn errors_of_texts_are_short() {
    let world = World::new();
    let long = "k".repeat(5000);
    let texts = [
        format!("{long} = = 1"),
        format!("{long} = 1"),
        format!("[{long}]\na = 1"),
        format!("version = 1\ntimeline = \"{long}"),
        format!("[rayleigh]\nscattering_per_m = \"{long}\""),
        format!("version = 2\n[sky]\nmodel = \"{long}\""),
        format!("# timeline 0123456789abcdef\nversion = 1\nbase = \"{long}\""),
        "[".repeat(3000),
    ];
    let short = |what: &str, text: &str| {
        let says = message();
        assert!(!says.is_empty() && says.len() < 700, "{what} of {text:.40}...: {} bytes: {says}", says.len());
    };
    for text in &texts {
        let c_text = CString::new(text.as_str()).unwrap();
        // SAFETY: live handles and locals.
        unsafe {
            let desc = wk_context_desc { planet_toml: c_text.as_ptr(), ..init("wk_context_desc") };
            let mut context = null_mut();
            assert!(wk_context_create(world.device, &desc, &mut context) < 0 && context.is_null());
            short("planet", text);
            let bytes: *const c_void = text.as_ptr().cast();
            assert!(wk_context_load(world.context, bytes, text.len()) < 0);
            short("state", text);
            assert!(welkin::capi::plan::wk_view_load_plan(world.view, bytes, text.len()) < 0);
            short("plan", text);
            let mut weather = init::<wk_weather>("wk_weather");
            assert!(wk_weather_from_metar(c_text.as_ptr(), null_mut(), 0, 0, &mut weather, null_mut()) < 0);
            short("METAR", text);
            assert!(wk_weather_from_preset(c_text.as_ptr(), null_mut(), 0, 0, &mut weather) < 0);
            short("preset", text);
        }
    }
}
