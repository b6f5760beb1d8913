//! Queries: results agree with those of the Rust interface, and lists are checked before anything is written.

use std::ffi::CStr;
use std::ptr::{null, null_mut};

use welkin::capi::{
    conditions::*, context::*, fog_law::*, frame::*, query::*, radiance::*, snowpack::*, stars::*, status::*,
    timeline::*, view::*, weather::*, weather_kinds::*,
};

use super::world::{World, init, message, update};

const EYE: [f64; 3] = [0.0, 0.0, 2.0];

#[track_caller]
fn refused(status: wk_status, wanted: &str) {
    assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{wanted}: {}", message());
    assert!(message().contains(wanted), "{wanted}: {}", message());
}

#[test]
fn kinds_of_snow_are_apart_and_add_up() {
    let world = World::new();
    let kinds =
        [WK_PRECIPITATION_SNOW, WK_PRECIPITATION_SNOW_GRAINS, WK_PRECIPITATION_ICE_CRYSTALS, WK_PRECIPITATION_RAIN];
    for (i, precipitation_kind) in kinds.into_iter().enumerate() {
        let weather =
            wk_weather { temperature_c: -8.0, precipitation_kind, precipitation_rate_mm_h: 2.0, ..init("wk_weather") };
        let time_s = 100.0 * i as f64;
        let mut c = init::<wk_conditions>("wk_conditions");
        let mut half = c;
        // SAFETY: live pointers.
        unsafe {
            assert_eq!(wk_context_set_weather(world.context, &weather, time_s, 10.0), WK_OK, "{}", message());
            assert_eq!(wk_context_get_conditions(world.context, &EYE, time_s + 50.0, &mut c), WK_OK);
            assert_eq!(wk_context_get_conditions(world.context, &EYE, time_s + 5.0, &mut half), WK_OK);
        }
        let of = |c: &wk_conditions| [c.snow_flakes_mm_h, c.snow_grains_mm_h, c.ice_crystals_mm_h];
        let expected: [f64; 3] = std::array::from_fn(|k| if k == i { c.snow_mm_h } else { 0.0 });
        assert_eq!(of(&c), expected, "{i}");
        assert_eq!(c.snow_mm_h > 0.0, i < 3, "{i}");
        // During the change from one kind to the next both fall.
        let (both, sum) = (of(&half), of(&half).iter().sum::<f64>());
        assert!((sum - half.snow_mm_h).abs() < 1e-12, "{both:?}");
        if (1..3).contains(&i) {
            assert!(both[i] > 0.0 && both[i - 1] > 0.0, "{both:?}");
        }
    }
}

#[test]
fn conditions_follow_the_weather_and_its_transition() {
    let world = World::new();
    let layers = [
        wk_cloud_layer { cover: 0.5, base_m: 900.0, ..init("wk_cloud_layer") },
        wk_cloud_layer { cover: 1.0, base_m: 3000.0, ..init("wk_cloud_layer") },
    ];
    let rain = wk_weather {
        visibility_m: 4000.0,
        precipitation_kind: WK_PRECIPITATION_RAIN,
        precipitation_rate_mm_h: 5.0,
        wind_speed_m_s: 8.0,
        wind_from_deg: 270.0,
        clouds: layers.as_ptr(),
        cloud_count: 2,
        ..init("wk_weather")
    };
    let at = |time_s: f64| {
        let mut conditions = init::<wk_conditions>("wk_conditions");
        // SAFETY: live pointers.
        let status = unsafe { wk_context_get_conditions(world.context, &EYE, time_s, &mut conditions) };
        assert_eq!(status, WK_OK, "{}", message());
        conditions
    };
    // SAFETY: live pointers.
    assert_eq!(unsafe { wk_context_set_weather(world.context, &rain, 100.0, 60.0) }, WK_OK, "{}", message());
    assert!((at(0.0).visibility_m / 40_000.0 - 1.0).abs() < 1e-6);
    assert_eq!(at(0.0).rain_mm_h, 0.0);
    let (half, whole) = (at(130.0), at(200.0));
    assert!(half.rain_mm_h > 1.0 && half.rain_mm_h < whole.rain_mm_h);
    assert!((whole.visibility_m / 4000.0 - 1.0).abs() < 1e-6 && (whole.wind_east_m_s - 8.0).abs() < 1e-9);
    let mut slabs = [wk_cloud_slab { ..unsafe { std::mem::zeroed() } }; 16];
    let size = size_of::<wk_cloud_slab>() as u32;
    let mut count = 0;
    // SAFETY: live pointers with the sizes given.
    unsafe {
        let get = |room: *mut wk_cloud_slab, capacity, count: *mut u32| {
            wk_context_get_cloud_slabs(world.context, &EYE, 200.0, room, capacity, size, count)
        };
        assert_eq!(get(null_mut(), 0, &mut count), WK_OK);
        assert!(count >= 2);
        refused(get(slabs.as_mut_ptr(), 1, &mut count), "capacity must be at least");
        assert_eq!(slabs[0].cover, 0.0);
        assert_eq!(get(slabs.as_mut_ptr(), 16, &mut count), WK_OK);
        assert!(slabs[..count as usize].iter().all(|s| s.cover > 0.0 && s.optical_depth > 0.0));
        let status = wk_context_get_cloud_slabs(world.context, &EYE, 0.0, slabs.as_mut_ptr(), 16, 8, &mut count);
        refused(status, "slab_size must be at least 64");
        let mut c = init::<wk_conditions>("wk_conditions");
        refused(wk_context_get_conditions(world.context, null(), 0.0, &mut c), "position_m must not be NULL");
        refused(
            wk_context_get_conditions(world.context, &[0.0, f64::NAN, 0.0], 0.0, &mut c),
            "position_m must be finite and within 1e12 m of the world's origin, got",
        );
        refused(
            wk_context_get_conditions(world.context, &EYE, f64::NAN, &mut c),
            "time_s must be in [-10000000000, 10000000000] s, got NaN",
        );
        assert_eq!(c.visibility_m, 0.0, "nothing is written");
    }
}

#[test]
fn the_sun_is_where_the_host_puts_it_or_where_the_almanac_has_it() {
    let world = World::new();
    let mut sun = init::<wk_celestial>("wk_celestial");
    let mut moon = sun;
    let given = wk_given_direction { azimuth_deg: 200.0, elevation_deg: 30.0, ..init("wk_given_direction") };
    // SAFETY: live pointers.
    unsafe {
        assert_eq!(wk_context_get_sun(world.context, &EYE, &mut sun), WK_OK);
        // 10:00 UTC on midsummer at 50 N, 10 E: high in the south-east.
        assert!((50.0..64.0).contains(&sun.elevation_deg) && (120.0..175.0).contains(&sun.azimuth_deg));
        assert!(sun.apparent_elevation_deg > sun.elevation_deg && sun.illuminance_lux[1] > 1e5);
        assert_eq!(wk_context_set_sun(world.context, &given), WK_OK);
        assert_eq!(wk_context_get_sun(world.context, &EYE, &mut sun), WK_OK);
        assert!((sun.azimuth_deg - 200.0).abs() < 1e-9 && (sun.elevation_deg - 30.0).abs() < 1e-9);
        assert_eq!(wk_context_get_moon(world.context, &EYE, &mut moon), WK_OK);
        assert!(moon.illuminance_lux[1] < 1.0 && (0.0..=1.0).contains(&moon.lit));
        refused(wk_context_get_sun(world.context, null(), &mut sun), "position_m must not be NULL");
    }
}

/// Results of the four queries that take a time.
struct Answers {
    sun: wk_celestial,
    moon: wk_celestial,
    light: wk_ground_light,
    between: wk_between,
}

fn ask_at(context: *const wk_context, time_s: f64, out: &mut Answers) -> [wk_status; 4] {
    let segment = wk_segment { from_m: EYE, to_m: [0.0, 500.0, 2.0] };
    let sizes = [size_of::<wk_ground_light>(), size_of::<wk_segment>(), size_of::<wk_between>()].map(|s| s as u32);
    // SAFETY: live pointers with the sizes given.
    unsafe {
        [
            wk_context_get_sun_at(context, &EYE, time_s, &mut out.sun),
            wk_context_get_moon_at(context, &EYE, time_s, &mut out.moon),
            wk_context_get_light_at(context, &EYE, 1, 24, time_s, &mut out.light, sizes[0]),
            wk_context_get_between_at(context, &segment, 1, sizes[1], time_s, &mut out.between, sizes[2]),
        ]
    }
}

#[test]
fn every_query_answers_for_other_times_too() {
    let world = World::new();
    let context = world.context;
    let mut got = Answers {
        sun: init("wk_celestial"),
        moon: init("wk_celestial"),
        light: wk_ground_light { sun_lux: [0.0; 3], moon_lux: [0.0; 3], sky_lux: [0.0; 3], total_lux: 0.0 },
        between: wk_between { transmittance: [0.0; 3], visibility_m: 0.0 },
    };
    let fog = wk_weather { visibility_m: 400.0, fog_kind: WK_FOG_FOG, relative_humidity: 1.0, ..init("wk_weather") };
    // SAFETY: live pointers.
    unsafe { assert_eq!(wk_context_set_weather(context, &fog, 100.0, 0.0), WK_OK, "{}", message()) };
    let evening = 10.0 * 3600.0; // 20:00 UTC at 10 E, half an hour after sunset
    assert_eq!(ask_at(context, evening, &mut got), [WK_OK; 4], "{}", message());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e11] {
        assert_eq!(ask_at(context, bad, &mut got), [WK_ERROR_INVALID_ARGUMENT; 4], "{bad}");
        assert!(message().contains("time_s must be"), "{bad}: {}", message());
    }
    assert!((-6.0..-2.0).contains(&got.sun.elevation_deg), "what is refused writes nothing: {}", got.sun.elevation_deg);
    assert!(got.light.total_lux < 2000.0 && got.between.visibility_m < 500.0, "{}", got.between.visibility_m);
    let evening_lux = got.light.total_lux;
    // SAFETY: a live handle.
    unsafe { assert_eq!(wk_context_update(context, 200.0), WK_OK) };
    assert_eq!(ask_at(context, 99.0, &mut got), [WK_ERROR_INVALID_ARGUMENT; 4]);
    assert!(message().contains("time_s must be at least 100"), "{}", message());
    assert_eq!(ask_at(context, 200.0, &mut got), [WK_OK; 4]);
    assert!(got.light.total_lux > 5.0 * evening_lux, "noon is brighter");
    let (mut here, mut there) = (init::<wk_conditions>("wk_conditions"), init("wk_conditions"));
    // SAFETY: live pointers.
    unsafe {
        refused(wk_context_get_conditions(context, &EYE, 99.0, &mut here), "time_s must be at least 100");
        refused(
            wk_context_get_conditions(context, &[0.0, 0.0, 2e9], 200.0, &mut here),
            "position_m must be at an altitude in",
        );
        assert_eq!(here.visibility_m, 0.0, "nothing is written");
        // Without weather regions the weather is the same everywhere.
        assert_eq!(wk_context_get_conditions(context, &EYE, 200.0, &mut here), WK_OK);
        assert_eq!(wk_context_get_conditions(context, &[1e4, 5e3, 800.0], 200.0, &mut there), WK_OK);
    }
    assert_eq!((here.visibility_m, here.temperature_c), (there.visibility_m, there.temperature_c));
}

#[test]
fn batches_answer_all_or_nothing() {
    let world = World::new();
    let places = [EYE, [0.0, 0.0, 2000.0], [1e4, -2e4, 10.0]];
    let zero = wk_ground_light { sun_lux: [0.0; 3], moon_lux: [0.0; 3], sky_lux: [0.0; 3], total_lux: 0.0 };
    let mut lights = [zero; 3];
    let (step, size) = (24, size_of::<wk_ground_light>() as u32);
    // SAFETY: live pointers with the sizes given.
    unsafe {
        let get = |places: &[[f64; 3]], lights: &mut [wk_ground_light]| {
            let count = places.len() as u32;
            wk_context_get_light(world.context, places.as_ptr(), count, step, lights.as_mut_ptr(), size)
        };
        assert_eq!(get(&places, &mut lights), WK_OK, "{}", message());
        assert!(lights.iter().all(|l| l.total_lux > 1e4 && l.total_lux < 2e5), "{:?}", lights.map(|l| l.total_lux));
        let mut untouched = [zero; 3];
        let bad = [EYE, [0.0, 0.0, f64::INFINITY], EYE];
        refused(get(&bad, &mut untouched), "positions_m[1] must be finite and within 1e12 m");
        assert_eq!(untouched[0].total_lux, 0.0);
        let many = wk_context_get_light(world.context, places.as_ptr(), 70_000, step, lights.as_mut_ptr(), size);
        refused(many, "count must be at most 65536");
        let narrow = wk_context_get_light(world.context, places.as_ptr(), 3, 16, lights.as_mut_ptr(), size);
        refused(narrow, "position_size must be at least 24 and a multiple of 8, got 16");
        let narrow = wk_context_get_light(world.context, places.as_ptr(), 3, step, lights.as_mut_ptr(), 8);
        refused(narrow, "light_size must be at least 80");
        let none = wk_context_get_light(world.context, null(), 3, step, lights.as_mut_ptr(), size);
        refused(none, "positions_m must not be NULL");
        let none = wk_context_get_light(world.context, places.as_ptr(), 3, step, null_mut(), size);
        refused(none, "lights must not be NULL");
        assert_eq!(wk_context_get_light(world.context, null(), 0, 0, null_mut(), 0), WK_OK);
    }
}

#[test]
fn lying_snow_is_answered_at_all_places_or_none() {
    let world = World::new();
    let weather = wk_weather { surface_snow_depth_m: 0.2, temperature_c: -5.0, ..init("wk_weather") };
    let untouched = wk_lying_snow {
        depth_m: 9.0,
        mass_kg_m2: 9.0,
        density_kg_m3: 9.0,
        wetness: 9.0,
        albedo: 9.0,
        cover: 9.0,
        surface_m: [9.0; 3],
        friction: 9,
        reserved0: 9,
    };
    let mut snow = [untouched; 3];
    // SAFETY: live pointers with the sizes given.
    unsafe {
        assert_eq!(wk_context_set_weather(world.context, &weather, 0.0, 0.0), WK_OK, "{}", message());
        let get = |places: &[[f64; 3]; 3], snow: &mut [wk_lying_snow; 3]| {
            let size = size_of::<wk_lying_snow>() as u32;
            wk_context_get_lying_snow(world.context, places.as_ptr(), 3, 24, snow.as_mut_ptr(), size)
        };
        refused(get(&[EYE, EYE, [0.0, f64::NAN, 0.0]], &mut snow), "positions_m[2] must be finite");
        assert!(snow.iter().all(|s| s.depth_m == 9.0 && s.friction == 9), "nothing is written");
        assert_eq!(get(&[EYE; 3], &mut snow), WK_OK, "{}", message());
    }
    assert!(snow.iter().all(|s| (s.depth_m - 0.2).abs() < 1e-3), "{:?}", snow.map(|s| s.depth_m));
}

#[test]
fn the_sky_answers_towards_all_directions_or_none() {
    let world = World::new();
    let directions = [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.0, 0.9998, 0.0], [0.0, -0.6, -0.8]];
    let zero = wk_sky_radiance { radiance_cd_m2: [0.0; 3] };
    let (step, size) = (24, size_of::<wk_sky_radiance>() as u32);
    let mut seen = [zero; 4];
    // SAFETY: live pointers with the sizes given.
    unsafe {
        let get = |directions: &[[f64; 3]], seen: &mut [wk_sky_radiance]| {
            let (count, out) = (directions.len() as u32, seen.as_mut_ptr());
            wk_context_get_sky_radiance(world.context, &EYE, directions.as_ptr(), count, step, out, size)
        };
        assert_eq!(get(&directions, &mut seen), WK_OK, "{}", message());
        assert!(seen.iter().flat_map(|s| s.radiance_cd_m2).all(|v| v > 100.0 && v < 1e5), "a sky by day");
        let mut untouched = [zero; 4];
        for bad in [[0.0, 0.0, 0.9], [0.0; 3], [f64::NAN, 0.0, 0.0], [1e300, 0.0, 0.0]] {
            let status = get(&[directions[0], bad], &mut untouched);
            refused(status, "directions[1] must be a unit vector (east, north, up)");
        }
        assert_eq!(untouched[0].radiance_cd_m2, [0.0; 3]);
        let (first, out) = (directions.as_ptr(), seen.as_mut_ptr());
        let ask = |at, first, count, step, out, size| {
            wk_context_get_sky_radiance(world.context, at, first, count, step, out, size)
        };
        refused(ask(null(), first, 4, step, out, size), "position_m must not be NULL");
        refused(ask(&EYE, null(), 4, step, out, size), "directions must not be NULL");
        refused(ask(&EYE, first, 4, step, null_mut(), size), "radiances must not be NULL");
        refused(ask(&EYE, first, 4, 16, out, size), "direction_size must be at least 24 and a multiple of 8, got 16");
        refused(ask(&EYE, first, 4, step, out, 16), "radiance_size must be at least 24");
        refused(ask(&EYE, first, 70_000, step, out, size), "count must be at most 65536");
        assert_eq!(ask(&EYE, null(), 0, 0, null_mut(), 0), WK_OK);
        let mut later = [zero; 4];
        let at = |time_s, out: &mut [wk_sky_radiance; 4]| {
            wk_context_get_sky_radiance_at(world.context, &EYE, first, 4, step, time_s, out.as_mut_ptr(), size)
        };
        assert_eq!(at(0.0, &mut later), WK_OK, "{}", message());
        assert_eq!(later.map(|s| s.radiance_cd_m2), seen.map(|s| s.radiance_cd_m2));
        refused(at(f64::NAN, &mut later), "time_s");
    }
}

#[test]
fn visibility_between_points_is_that_of_the_weather() {
    let world = World::new();
    let fog = wk_weather { visibility_m: 400.0, fog_kind: WK_FOG_FOG, relative_humidity: 1.0, ..init("wk_weather") };
    let segment = |distance: f64| wk_segment { from_m: EYE, to_m: [0.0, distance, 2.0] };
    let segments = [segment(400.0), segment(100.0), segment(5.0)];
    let mut between = [wk_between { transmittance: [0.0; 3], visibility_m: 0.0 }; 3];
    let sizes = (size_of::<wk_segment>() as u32, size_of::<wk_between>() as u32);
    // SAFETY: live pointers with the sizes given.
    unsafe {
        assert_eq!(wk_context_set_weather(world.context, &fog, 0.0, 0.0), WK_OK, "{}", message());
        let get = |segments: &[wk_segment], between: &mut [wk_between]| {
            let count = segments.len() as u32;
            wk_context_get_between(world.context, segments.as_ptr(), count, sizes.0, between.as_mut_ptr(), sizes.1)
        };
        assert_eq!(get(&segments, &mut between), WK_OK, "{}", message());
        // At the visibility 5 % is left (the haze thins a little with height, so not exactly).
        assert!((between[0].transmittance[1] - 0.05).abs() < 1e-3, "{:?}", between[0].transmittance);
        assert!((between[2].visibility_m / 400.0 - 1.0).abs() < 0.01, "{}", between[2].visibility_m);
        assert!(between[0].transmittance[1] < between[1].transmittance[1]);
        refused(get(&[segment(0.0)], &mut between), "segments[0].to_m must be at least a millimetre");
        refused(get(&[segment(f64::NAN)], &mut between), "segments[0].to_m must be finite and within 1e12 m");
    }
}

#[test]
fn ambient_light_is_that_of_a_place_and_a_time() {
    let world = World::new();
    let mut ambient = init::<wk_ambient>("wk_ambient");
    // SAFETY: live pointers.
    unsafe {
        refused(wk_context_get_ambient(world.context, null(), &mut ambient), "position_m must not be NULL");
        refused(wk_context_get_ambient(world.context, &EYE, null_mut()), "out_ambient must not be NULL");
        assert_eq!(wk_context_get_ambient(world.context, &EYE, &mut ambient), WK_OK, "{}", message());
    }
    assert!(ambient.sh9.iter().all(|v| v.is_finite()));
    let mut then = init::<wk_ambient>("wk_ambient");
    // SAFETY: live pointers.
    unsafe {
        let now = 0.0;
        assert_eq!(wk_context_get_ambient_at(world.context, &EYE, now, &mut then), WK_OK, "{}", message());
        assert_eq!(then.sh9, ambient.sh9);
        // Twelve hours later.
        assert_eq!(wk_context_get_ambient_at(world.context, &EYE, now + 43_200.0, &mut then), WK_OK, "{}", message());
        refused(wk_context_get_ambient_at(world.context, &EYE, f64::NAN, &mut then), "time_s must be");
    }
    assert_ne!(then.sh9, ambient.sh9);
}

#[test]
fn visibility_and_faintest_star_are_asked_for_with_a_place_and_a_time() {
    let world = World::new();
    let (context, level, mut out) = (world.context, [0.6, 0.8, 0.0], -1.0);
    // SAFETY: live pointers.
    unsafe {
        refused(wk_context_get_visibility_at(context, null(), &level, 0.0, &mut out), "position_m must not be NULL");
        refused(wk_context_get_visibility_at(context, &EYE, null(), 0.0, &mut out), "direction must not be NULL");
        refused(
            wk_context_get_visibility_at(context, &EYE, &level, 0.0, null_mut()),
            "out_visibility_m must not be NULL",
        );
        refused(
            wk_context_get_visibility_at(context, &EYE, &[1.0; 3], 0.0, &mut out),
            "direction must be a unit vector",
        );
        refused(wk_context_get_visibility_at(context, &EYE, &level, f64::NAN, &mut out), "time_s must be");
        refused(wk_context_get_limiting_magnitude_at(context, null(), 0.0, &mut out), "position_m must not be NULL");
        refused(wk_context_get_limiting_magnitude_at(context, &EYE, 0.0, null_mut()), "out_magnitude must not be NULL");
        assert_eq!(out, -1.0, "nothing was written");
        assert_eq!(wk_context_get_visibility_at(context, &EYE, &level, 0.0, &mut out), WK_OK, "{}", message());
        assert!(out > 100.0, "{out}");
        assert_eq!(wk_context_get_limiting_magnitude_at(context, &EYE, 0.0, &mut out), WK_OK, "{}", message());
        assert!((-7.0..8.0).contains(&out), "{out}");
    }
}

#[test]
fn the_light_for_a_frame_is_in_the_units_and_colour_space_of_the_frame() {
    let world = World::new();
    let noon = wk_given_direction { azimuth_deg: 90.0, elevation_deg: 30.0, ..init("wk_given_direction") };
    let night = wk_given_direction { elevation_deg: -40.0, ..noon };
    let light = |color_space, unit| {
        let mut light = init::<wk_frame_light>("wk_frame_light");
        let frame = wk_frame { color_space, cd_m2_per_unit: unit, position_m: EYE, ..init("wk_frame") };
        // SAFETY: live pointers.
        assert_eq!(unsafe { wk_context_get_frame_light(world.context, &frame, &mut light) }, WK_OK, "{}", message());
        light
    };
    // SAFETY: live pointers.
    assert_eq!(unsafe { wk_context_set_sun(world.context, &noon) }, WK_OK);
    let mut arriving = [wk_ground_light { sun_lux: [0.0; 3], moon_lux: [0.0; 3], sky_lux: [0.0; 3], total_lux: 0.0 }];
    let size = size_of::<wk_ground_light>() as u32;
    // SAFETY: live pointers with the sizes given.
    unsafe { assert_eq!(wk_context_get_light(world.context, &EYE, 1, 24, arriving.as_mut_ptr(), size), WK_OK) };
    let scene = light(WK_COLOR_SCENE_LINEAR, 50.0);
    for i in 0..3 {
        let close = |a: f64, lux: f64| (a * std::f64::consts::PI * 50.0 / lux - 1.0).abs() < 1e-9;
        assert!(close(scene.direct[i], arriving[0].sun_lux[i]) && close(scene.ambient[i], arriving[0].sky_lux[i]));
    }
    // East is x, up is z.
    let [x, y, z] = scene.direction;
    assert!((x - 0.75_f64.sqrt()).abs() < 1e-6 && y.abs() < 1e-6 && (z - 0.5).abs() < 1e-6, "{:?}", scene.direction);
    let linear = light(WK_COLOR_DISPLAY_LINEAR, 1.0);
    let encoded = light(WK_COLOR_DISPLAY_SRGB, 1.0);
    for i in 0..3 {
        // A grey card in shade and in the sun, by the exponential curve that a context begins with.
        let grey = |lux: f64| 1.0 - (-linear.exposure * 0.18 * lux / std::f64::consts::PI).exp();
        let (sky, sun) = (arriving[0].sky_lux[i], arriving[0].sun_lux[i]);
        assert!((0.18 * linear.ambient[i] - grey(sky)).abs() < 1e-9);
        assert!((0.18 * (linear.ambient[i] + linear.direct[i]) - grey(sky + sun)).abs() < 1e-9);
        let srgb = |v: f64| 1.055 * v.powf(1.0 / 2.4) - 0.055;
        assert!((srgb(0.18) * encoded.ambient[i] - srgb(grey(sky))).abs() < 1e-9);
        assert!((srgb(0.18) * (encoded.ambient[i] + encoded.direct[i]) - srgb(grey(sky + sun))).abs() < 1e-9);
        // Neither black nor burnt out: a legacy host can use it as it is.
        let shown = srgb(0.18) * (encoded.ambient[i] + encoded.direct[i]);
        assert!((0.25..=0.9).contains(&shown), "{shown}");
        assert!(linear.ambient_below[i] > 0.0 && linear.ambient_below[i] < linear.ambient[i] + linear.direct[i]);
    }
    // SAFETY: live pointers.
    unsafe {
        assert_eq!(wk_context_set_sun(world.context, &night), WK_OK);
        let mut light = init::<wk_frame_light>("wk_frame_light");
        let wrong = wk_frame { cd_m2_per_unit: 0.0, ..init("wk_frame") };
        refused(
            wk_context_get_frame_light(world.context, &wrong, &mut light),
            "frame.cd_m2_per_unit must be in [1e-9, 1e9]",
        );
    }
    assert_eq!(light(WK_COLOR_SCENE_LINEAR, 1.0).direct[1].max(0.1), 0.1, "no sun below the horizon");
}

#[test]
fn fog_laws_of_older_systems_are_checked_and_say_how_far_they_reach() {
    let world = World::new();
    let linear = wk_fog_law { curve: WK_FOG_CURVE_LINEAR, start_m: 100.0, end_m: 900.0, ..init("wk_fog_law") };
    let mut distance = 0.0;
    // SAFETY: live pointers.
    unsafe {
        assert_eq!(wk_context_set_fog_law(world.context, &linear), WK_OK, "{}", message());
        assert_eq!(wk_context_set_fog_law(world.context, null()), WK_OK);
        let wrong = wk_fog_law { end_m: 50.0, ..linear };
        refused(wk_context_set_fog_law(world.context, &wrong), "fog_law.end_m must be above start_m");
        let wrong = wk_fog_law { has: WK_FOG_LAW_HAS_COLOR, color: [0.0, -1.0, 0.0], ..linear };
        refused(wk_context_set_fog_law(world.context, &wrong), "fog_law.color must be in");
        assert_eq!(wk_fog_law_cull_distance(&linear, &mut distance), WK_OK);
        assert!((distance - (900.0 - 800.0 / 255.0)).abs() < 1e-9);
        assert_eq!(wk_fog_law_cull_distance(&init("wk_fog_law"), &mut distance), WK_OK);
        assert!(distance.is_infinite());
        assert_eq!(wk_visibility_cull_distance(1000.0, &mut distance), WK_OK);
        assert!((distance - 1000.0 * 255_f64.ln() / 20_f64.ln()).abs() < 1e-6);
        refused(
            wk_visibility_cull_distance(f64::NAN, &mut distance),
            "visibility_m must be in [1, 1000000] m, got NaN",
        );
        refused(wk_visibility_cull_distance(0.5, &mut distance), "visibility_m must be in [1, 1000000] m");
        refused(wk_visibility_cull_distance(10.0, null_mut()), "out_distance_m must not be NULL");
        refused(wk_fog_law_cull_distance(null(), &mut distance), "fog_law must not be NULL");
    }
}

#[test]
fn only_frames_with_the_measure_flag_have_costs() {
    let world = World::new();
    let zero = wk_effect_cost { effect: 99, reserved0: 9, name: null(), ms: -1.0 };
    let (mut costs, size, mut count) = ([zero; 16], size_of::<wk_effect_cost>() as u32, 77);
    let mut report = init::<wk_report>("wk_report");
    let record = |frame_id, flags| {
        let target = wk_own_target { color: world.texture, ..init("wk_own_target") };
        let projection = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.1, 0.0];
        let flags = flags | WK_FRAME_DEPTH_REVERSED;
        let frame = wk_frame { frame_id, flags, projection, target: (&raw const target).cast(), ..init("wk_frame") };
        // SAFETY: live pointers.
        unsafe { assert_eq!(wk_view_record(world.view, &frame, WK_STAGE_ALL), WK_OK, "{}", message()) };
    };
    // SAFETY: live pointers with the sizes given.
    unsafe {
        let view = world.view;
        record(1, 0);
        assert_eq!(wk_view_get_report(view, &mut report), WK_OK);
        assert_eq!((report.has & WK_REPORT_HAS_MS, report.ms), (0, 0.0));
        assert_eq!(wk_view_get_costs(view, costs.as_mut_ptr(), 16, size, &mut count), WK_OK, "{}", message());
        assert_eq!((count, costs[0].effect), (0, 99));
        record(2, WK_FRAME_MEASURE);
        assert_eq!(wk_view_get_report(view, &mut report), WK_OK);
        assert!(report.has & WK_REPORT_HAS_MS != 0 && report.ms > 0.0);
        assert_eq!(wk_view_get_costs(view, null_mut(), 0, 0, &mut count), WK_OK, "{}", message());
        let all = welkin::frame::CostItem::ALL.len() as u32;
        assert_eq!(count, all);
        refused(
            wk_view_get_costs(view, costs.as_mut_ptr(), all - 1, size, &mut count),
            &format!("capacity must be at least {all}"),
        );
        refused(wk_view_get_costs(view, null_mut(), all, size, &mut count), "costs must not be NULL");
        refused(wk_view_get_costs(view, costs.as_mut_ptr(), 16, 8, &mut count), "cost_size must be at least 24");
        refused(wk_view_get_costs(view, costs.as_mut_ptr(), 16, size, null_mut()), "out_count must not be NULL");
        assert_eq!(costs[0].effect, 99, "nothing is written");
        assert_eq!(wk_view_get_costs(view, costs.as_mut_ptr(), 16, size, &mut count), WK_OK, "{}", message());
        for (i, cost) in costs[..all as usize].iter().enumerate() {
            assert_eq!((cost.effect, cost.reserved0), (i as u32, 0));
            assert!(!CStr::from_ptr(cost.name).is_empty() && cost.ms >= 0.0);
        }
        let (composition, hand_over) = (costs[WK_EFFECT_COMPOSITION as usize], costs[WK_EFFECT_HAND_OVER as usize]);
        assert_eq!(CStr::from_ptr(hand_over.name), c"hand-over");
        assert!(composition.ms > 0.0 && hand_over.ms > 0.0 && costs[WK_EFFECT_VEIL as usize].ms == 0.0);
        let sum = costs[..all as usize].iter().map(|c| c.ms).sum::<f64>();
        assert!(sum <= 1.001 * report.ms, "{sum} of {}", report.ms);
    }
}

#[test]
fn simulated_ground_is_asked_for_its_water() {
    use welkin::capi::ground::*;
    let world = World::new();
    let simulation = wk_simulation_desc { ground_model: WK_GROUND_SIMULATED, ..init("wk_simulation_desc") };
    let desc = wk_context_desc { next: (&raw const simulation).cast(), ..init("wk_context_desc") };
    let (mut context, mut ground) = (null_mut(), init::<wk_ground>("wk_ground"));
    // SAFETY: live pointers.
    unsafe {
        assert_eq!(wk_context_create(world.device, &desc, &mut context), WK_OK, "{}", message());
        let weather = wk_weather {
            precipitation_kind: WK_PRECIPITATION_RAIN,
            precipitation_rate_mm_h: 5.0,
            ..init("wk_weather")
        };
        assert_eq!(wk_context_set_weather(context, &weather, 0.0, 0.0), WK_OK, "{}", message());
        update(context, 600.0);
        assert_eq!(wk_context_get_ground(context, &[1.0, 2.0, 0.0], &mut ground), WK_OK, "{}", message());
        assert!(ground.film_mm > 0.2 && ground.water_mm >= ground.film_mm && ground.wetness > 0.8);
        assert_eq!(ground.in_puddle == 1, ground.water_mm > ground.film_mm);
        refused(
            wk_context_get_ground(context, &[f64::NAN, 0.0, 0.0], &mut ground),
            "position_m must be finite and within 1e12 m",
        );
        assert_eq!(wk_context_destroy(context), WK_OK);
    }
}
