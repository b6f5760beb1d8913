//! Wind and rain: query results are consistent with each other and the same after saving and loading; errors name wrong
//! input.

use std::ptr::{null, null_mut};

use welkin::capi::{
    conditions::*, query::*, status::*, timeline::*, weather::*, weather_kinds::*, wind::*, wind_field::*, wind_grid::*,
};

use super::world::{World, init, message, resealed};

const MAST: [f64; 3] = [0.0, 0.0, 10.0];

fn storm(from_deg: f64) -> wk_weather {
    wk_weather {
        visibility_m: 1000.0,
        precipitation_kind: WK_PRECIPITATION_RAIN,
        precipitation_rate_mm_h: 20.0,
        wind_speed_m_s: 12.0,
        wind_from_deg: from_deg,
        ..init("wk_weather")
    }
}

#[track_caller]
fn wind(world: &World, at: [f64; 3], time_s: f64) -> wk_wind {
    let mut out = init::<wk_wind>("wk_wind");
    // SAFETY: live pointers.
    assert_eq!(unsafe { wk_context_get_wind_at(world.context, &at, time_s, &mut out) }, WK_OK, "{}", message());
    out
}

#[track_caller]
fn refused(status: wk_status, wanted: &str) {
    assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{wanted}: {}", message());
    assert!(message().contains(wanted), "{wanted}: {}", message());
}

fn saved(world: &World) -> Vec<u8> {
    let mut size = 0;
    // SAFETY: live pointers, and `size` bytes.
    unsafe {
        assert_eq!(wk_context_save(world.context, null_mut(), 0, &mut size), WK_OK);
        let mut state = vec![0_u8; size];
        assert_eq!(wk_context_save(world.context, state.as_mut_ptr().cast(), size, &mut size), WK_OK);
        state
    }
}

#[test]
fn schemes_and_methods_of_a_wind_field_are_chosen_and_wrong_ones_refused_by_name() {
    let world = World::new();
    // SAFETY: live pointers.
    let set = |field: &wk_wind_field| unsafe { wk_context_set_wind_field(world.context, field, 100.0) };
    let small = wk_wind_field { cells: [8; 3], ..init("wk_wind_field") };
    let relaxed = wk_wind_field { pressure: WK_WIND_PRESSURE_RELAXATION, ..small };
    for good in [
        wk_wind_field { scheme: WK_WIND_SCHEME_MACCORMACK, ..small },
        wk_wind_field { scheme: WK_WIND_SCHEME_SEMI_LAGRANGIAN, most_iterations: 1000, ..small },
        relaxed,
        wk_wind_field { most_iterations: 1_000_000, relaxation: [1.9, 0.5], ..relaxed },
    ] {
        assert_eq!(set(&good), WK_OK, "{}", message());
    }
    let state = saved(&world);
    for (bad, wanted) in [
        (
            wk_wind_field { scheme: 3, ..small },
            "wind_field.scheme must be one of WK_WIND_SCHEME_REFLECTION, WK_WIND_SCHEME_MACCORMACK",
        ),
        (wk_wind_field { pressure: 2, ..small }, "wind_field.pressure must be one of WK_WIND_PRESSURE_MULTIGRID"),
        (wk_wind_field { most_iterations: 1001, ..small }, "wind_field.most_iterations must be in [0, 1000]"),
        (wk_wind_field { most_iterations: 1_000_001, ..relaxed }, "wind_field.most_iterations must be in [0, 1000000]"),
        (wk_wind_field { relaxation: [1.7, 2.0], ..relaxed }, "wind_field.relaxation[1] must be in (0, 2), or both 0"),
        (wk_wind_field { relaxation: [0.0, 1.1], ..relaxed }, "wind_field.relaxation[0] must be in (0, 2), or both 0"),
        (wk_wind_field { reserved1: 1, ..small }, "wind_field.reserved1 must be 0"),
    ] {
        refused(set(&bad), wanted);
        assert!(saved(&world) == state, "{wanted}");
    }
}

#[test]
fn air_goes_as_far_as_the_wind_says_through_updates_and_a_save() {
    let (a, b) = (World::new(), World::new());
    let (west, south) = (storm(270.0), storm(180.0));
    // SAFETY: live pointers.
    unsafe {
        for world in [&a, &b] {
            assert_eq!(wk_context_set_weather(world.context, &west, 0.0, 0.0), WK_OK);
            assert_eq!(wk_context_set_weather(world.context, &south, 50.0, 30.0), WK_OK);
        }
    }
    let h = 1e-3;
    for t in [1.0, 49.0, 55.5, 79.0, 200.0, 1e6] {
        let (before, now, after) = (wind(&a, MAST, t - h), wind(&a, MAST, t), wind(&a, MAST, t + h));
        for i in 0..3 {
            let slope = (after.displacement_m[i] - before.displacement_m[i]) / (2.0 * h);
            assert!((slope - now.velocity_m_s[i]).abs() < 1e-3, "{t}: {slope} {}", now.velocity_m_s[i]);
        }
    }
    let late = wind(&a, MAST, 300.0);
    assert!((late.mean_m_s[1] - 12.0).abs() < 1e-9 && late.mean_m_s[0].abs() < 1e-9, "a south wind blows north");
    assert!(late.displacement_m[0] > 400.0 && late.displacement_m[1] > 2000.0, "{:?}", late.displacement_m);
    assert!((0.1..0.3).contains(&(late.gust_deviation_m_s / 12.0)));
    assert!(wind(&a, [0.0, 0.0, 2.0], 300.0).mean_m_s[1] < 10.0 && wind(&a, [0.0; 3], 300.0).mean_m_s == [0.0; 3]);
    // One channel updates every second, another only once; a third loads the saved state. SAFETY: live pointers.
    unsafe {
        for second in 0..=120 {
            assert_eq!(wk_context_update(a.context, f64::from(second)), WK_OK);
        }
        assert_eq!(wk_context_update(b.context, 120.0), WK_OK);
        let c = World::new();
        let mut size = 0;
        assert_eq!(wk_context_save(a.context, null_mut(), 0, &mut size), WK_OK);
        let mut state = vec![0_u8; size];
        assert_eq!(wk_context_save(a.context, state.as_mut_ptr().cast(), size, &mut size), WK_OK);
        assert_eq!(wk_context_load(c.context, state.as_ptr().cast(), size), WK_OK, "{}", message());
        for world in [&a, &b, &c] {
            assert_eq!(wind(world, MAST, 300.0).displacement_m, late.displacement_m, "to the last bit");
        }
        // An impossible drift is refused even with a correct checksum.
        let text = String::from_utf8(state).unwrap();
        let line = text.lines().find(|l| l.starts_with("drifted")).expect("the drift is saved");
        for damaged in ["drifted = [80.0, nan, 0.0, 0.0]", "drifted = [79.0, 0.0, 0.0, 0.0]"] {
            let bad = resealed(&text.replacen(line, damaged, 1));
            assert_eq!(wk_context_load(c.context, bad.as_ptr().cast(), bad.len()), WK_ERROR_PARSE, "{damaged}");
            assert!(message().contains("drifted must be"), "{}", message());
        }
    }
}

#[test]
fn rain_is_the_weathers_and_falls_the_way_it_says() {
    let world = World::new();
    let get = |at: &[f64; 3], time_s: f64| {
        let mut out = init::<wk_rainfall>("wk_rainfall");
        // SAFETY: live pointers.
        let status = unsafe { wk_context_get_rainfall_at(world.context, at, time_s, &mut out) };
        assert_eq!(status, WK_OK, "{}", message());
        out
    };
    let dry = get(&MAST, 0.0);
    assert_eq!((dry.rate_mm_h, dry.number_per_m3, dry.fall_velocity_m_s), (0.0, 0.0, [0.0; 3]));
    let mut conditions = init::<wk_conditions>("wk_conditions");
    // SAFETY: live pointers.
    unsafe {
        assert_eq!(wk_context_set_weather(world.context, &storm(270.0), 10.0, 0.0), WK_OK);
        assert_eq!(wk_context_get_conditions(world.context, &MAST, 20.0, &mut conditions), WK_OK);
    }
    let rain = get(&MAST, 20.0);
    assert!((rain.rate_mm_h / 20.0 - 1.0).abs() < 1e-3, "{}", rain.rate_mm_h);
    assert!((rain.extinction_per_m / conditions.precipitation_extinction_per_m - 1.0).abs() < 0.01);
    assert!((1.2..2.2).contains(&rain.median_volume_diameter_mm) && rain.mean_diameter_mm < 0.7);
    let blows = wind(&world, MAST, 20.0).velocity_m_s;
    let fall = rain.fall_velocity_m_s;
    assert!((fall[0] - blows[0]).abs() + (fall[1] - blows[1]).abs() < 1e-9, "{fall:?} in {blows:?}");
    // Half of the water falls in drops above about 2 mm.
    assert!((-7.0..-5.5).contains(&fall[2]), "{fall:?}");
    let above_cloud = get(&[0.0, 0.0, 15_000.0], 20.0);
    assert_eq!(above_cloud.number_per_m3, 0.0);
    assert_eq!((rain.ice_mm_h, rain.stones_per_m3, rain.stones_per_m2_s), (0.0, 0.0, 0.0));
    let hail = wk_weather { precipitation_kind: WK_PRECIPITATION_HAIL, ..storm(270.0) };
    // SAFETY: live pointers.
    unsafe { assert_eq!(wk_context_set_weather(world.context, &hail, 40.0, 0.0), WK_OK) };
    let hail = get(&MAST, 50.0);
    assert!((hail.ice_mm_h / 20.0 - 1.0).abs() < 1e-3 && hail.rate_mm_h == 0.0, "{}", hail.ice_mm_h);
    assert!((0.2..5.0).contains(&hail.stones_per_m3) && (6.0..20.0).contains(&hail.stone_diameter_mm));
    assert!(hail.stones_per_m2_s > 6.0 * hail.stones_per_m3 && hail.stone_extinction_per_m > 5e-5);
    // SAFETY: live pointers.
    unsafe {
        let mut out = init::<wk_rainfall>("wk_rainfall");
        let context = world.context;
        refused(wk_context_get_rainfall_at(context, null(), 0.0, &mut out), "position_m must not be NULL");
        refused(
            wk_context_get_rainfall_at(context, &MAST, f64::NAN, &mut out),
            "time_s must be in [-10000000000, 10000000000] s, got NaN",
        );
        refused(wk_context_get_rainfall_at(context, &MAST, 0.0, null_mut()), "out_rainfall must not be NULL");
        let mut out = init::<wk_wind>("wk_wind");
        refused(wk_context_get_wind_at(context, null(), 0.0, &mut out), "position_m must not be NULL");
        refused(
            wk_context_get_wind_at(context, &[0.0, f64::NAN, 0.0], 0.0, &mut out),
            "position_m must be finite and within 1e12 m",
        );
        refused(wk_context_get_wind_at(context, &MAST, 1e11, &mut out), "time_s must be in");
        refused(wk_context_get_wind_at(context, &MAST, 0.0, null_mut()), "out_wind must not be NULL");
        assert_eq!(wk_context_update(context, 30.0), WK_OK);
        refused(wk_context_get_wind_at(context, &MAST, 5.0, &mut out), "time_s must be at least 10");
        assert_eq!(out.mean_m_s, [0.0; 3], "nothing is written");
    }
}

#[test]
fn surfaces_are_rained_on_by_their_slope_size_and_speed() {
    let world = World::new();
    // SAFETY: live pointers.
    unsafe { assert_eq!(wk_context_set_weather(world.context, &storm(270.0), 0.0, 0.0), WK_OK) };
    let of = |normal, velocity_m_s, area_m2| wk_rain_surface { position_m: MAST, normal, velocity_m_s, area_m2 };
    let (up, west) = ([0.0, 0.0, 3.0], [-1.0, 0.0, 0.0]);
    let still = [0.0; 3];
    let blows = wind(&world, MAST, 7.0).velocity_m_s;
    let list = [
        of(up, still, 2.0),
        of([0.0, 0.0, -1.0], still, 2.0),
        of(west, still, 1.0),
        of([1.0, 0.0, 0.0], still, 1.0),
        of(west, blows, 1.0),
        of(west, [blows[0] - 25.0, 0.0, 0.0], 1.0),
    ];
    let zero = wk_rain_on { rate_mm_h: 0.0, drops_per_s: 0.0 };
    let sizes = [size_of::<wk_rain_surface>() as u32, size_of::<wk_rain_on>() as u32];
    let get = |list: &[wk_rain_surface], time_s: f64, on: &mut [wk_rain_on]| {
        // SAFETY: live pointers with the sizes given.
        unsafe {
            let count = list.len() as u32;
            wk_context_get_rain_on_at(world.context, list.as_ptr(), count, sizes[0], time_s, on.as_mut_ptr(), sizes[1])
        }
    };
    let mut on = [zero; 6];
    assert_eq!(get(&list, 7.0, &mut on), WK_OK, "{}", message());
    let mut rain = init::<wk_rainfall>("wk_rainfall");
    // SAFETY: live pointers.
    unsafe { assert_eq!(wk_context_get_rainfall_at(world.context, &MAST, 7.0, &mut rain), WK_OK) };
    assert!((on[0].rate_mm_h / 20.0 - 1.0).abs() < 1e-3);
    assert!((on[0].drops_per_s / (2.0 * rain.drops_per_m2_s) - 1.0).abs() < 1e-12);
    assert_eq!((on[1].rate_mm_h, on[3].rate_mm_h), (0.0, 0.0), "from below and from the lee");
    assert!((on[2].drops_per_s / (rain.number_per_m3 * blows[0]) - 1.0).abs() < 1e-3);
    assert!(on[4].drops_per_s < 1e-6, "what goes with the wind is not met by it");
    assert!((on[5].rate_mm_h / (rain.liquid_g_m3 * 25.0 * 3.6) - 1.0).abs() < 1e-3);
    let mut kept = [zero; 1];
    for (bad, wanted) in [
        (of([0.0; 3], still, 1.0), "surfaces[0].normal must be finite and longer"),
        (of([f64::NAN, 0.0, 1.0], still, 1.0), "surfaces[0].normal must be finite and longer"),
        (of(up, [0.0, 0.0, 2000.0], 1.0), "surfaces[0].velocity_m_s[2] must be in"),
        (of(up, still, -1.0), "surfaces[0].area_m2 must be in"),
        (of(up, still, f64::INFINITY), "surfaces[0].area_m2 must be in [0, 1000000] m^2, got inf"),
        (
            wk_rain_surface { position_m: [0.0, 0.0, 1e10], ..list[0] },
            "surfaces[0].position_m must be at an altitude in",
        ),
    ] {
        refused(get(&[bad], 7.0, &mut kept), wanted);
    }
    refused(get(&list[..1], f64::NAN, &mut kept), "time_s must be in [-10000000000, 10000000000] s, got NaN");
    // SAFETY: wrong pointers are refused before they are read.
    unsafe {
        let call =
            |p, count, size, on, on_size| wk_context_get_rain_on_at(world.context, p, count, size, 7.0, on, on_size);
        refused(call(null(), 1, sizes[0], kept.as_mut_ptr(), sizes[1]), "surfaces must not be NULL");
        refused(call(list.as_ptr(), 70_000, sizes[0], kept.as_mut_ptr(), sizes[1]), "count must be at most");
        refused(call(list.as_ptr(), 1, 24, kept.as_mut_ptr(), sizes[1]), "surface_size must be at least 80");
        refused(call(list.as_ptr(), 1, sizes[0], null_mut(), sizes[1]), "on must not be NULL");
        refused(call(list.as_ptr(), 1, sizes[0], kept.as_mut_ptr(), 8), "on_size must be at least 16");
        assert_eq!(call(null(), 0, 0, null_mut(), 0), WK_OK);
    }
    assert_eq!(kept[0].rate_mm_h, 0.0, "nothing is written");
}

#[test]
fn patches_of_fog_go_with_the_air() {
    let world = World::new();
    let fog = wk_weather {
        visibility_m: 400.0,
        fog_kind: WK_FOG_PATCHES,
        relative_humidity: 1.0,
        wind_speed_m_s: 3.0,
        wind_from_deg: 240.0,
        ..init("wk_weather")
    };
    // SAFETY: live pointers.
    unsafe { assert_eq!(wk_context_set_weather(world.context, &fog, 0.0, 0.0), WK_OK, "{}", message()) };
    let through = |at: [f64; 3], time_s: f64| {
        let segment = wk_segment { from_m: at, to_m: [at[0] + 60.0, at[1] + 10.0, at[2]] };
        let mut between = wk_between { transmittance: [0.0; 3], visibility_m: 0.0 };
        let sizes = [size_of::<wk_segment>(), size_of::<wk_between>()].map(|s| s as u32);
        // SAFETY: live pointers with the sizes given.
        unsafe {
            let status =
                wk_context_get_between_at(world.context, &segment, 1, sizes[0], time_s, &mut between, sizes[1]);
            assert_eq!(status, WK_OK, "{}", message());
        }
        between.transmittance[1]
    };
    let mut changed = 0.0f64;
    for t in [0.5, 20.0, 333.0, 1e5] {
        let d = wind(&world, MAST, t).displacement_m;
        for x in 0..8 {
            let at = [f64::from(x) * 70.0, 40.0, 1.5];
            let there = [at[0] + d[0], at[1] + d[1], at[2]];
            let (was, is) = (through(at, 0.0), through(there, t));
            assert!((is / was - 1.0).abs() < 1e-6, "{t} {x}: {was} then {is}");
            changed = changed.max((through(at, t) / was - 1.0).abs());
            let next = through(at, t + 0.02);
            assert!((next / through(at, t) - 1.0).abs() < 0.02, "no jump from frame to frame");
        }
    }
    assert!(changed > 0.2, "a standing place sees them pass: {changed}");
}

#[test]
fn a_wind_that_varies_in_space_comes_through_and_goes_again() {
    let world = World::new();
    let before = wind(&world, MAST, 0.0);
    let velocities: Vec<f32> = (0..8).flat_map(|_| [3.0, -4.0, 5.0]).collect();
    let grid = wk_wind_grid {
        origin_m: [-10.0, -10.0, 0.0],
        cell_m: [20.0, 20.0, 20.0],
        kind: WK_WIND_GRID_ADDED,
        velocities_m_s: velocities.as_ptr(),
        velocity_count: 8,
        ..init("wk_wind_grid")
    };
    // SAFETY, for all: live pointers.
    let set = |grid: &wk_wind_grid| unsafe { wk_context_set_wind_grid(world.context, grid) };
    assert_eq!(set(&grid), WK_OK, "{}", message());
    let there = wind(&world, MAST, 0.0);
    assert_eq!([0, 1, 2].map(|i| there.velocity_m_s[i] - before.velocity_m_s[i]), [3.0, -4.0, 5.0]);
    let beside = [10.5, 0.0, 10.0];
    assert_eq!(wind(&world, beside, 0.0).velocity_m_s, before.velocity_m_s);
    refused(set(&wk_wind_grid { velocity_count: 7, ..grid }), "wind_grid.velocity_count must be 8");
    refused(set(&wk_wind_grid { nodes: [2, 2, 33], ..grid }), "wind_grid.nodes[2] must be");
    refused(set(&wk_wind_grid { velocities_m_s: null(), ..grid }), "wind_grid.velocities_m_s must not be NULL");
    assert_eq!(wind(&world, MAST, 0.0).velocity_m_s, there.velocity_m_s, "an error changes nothing");
    assert_eq!(unsafe { wk_context_set_wind_grid(world.context, null()) }, WK_OK);
    assert_eq!(wind(&world, MAST, 0.0).velocity_m_s, before.velocity_m_s);
}
