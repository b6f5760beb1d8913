//! The sea through the C interface.

use std::ptr::null;

use super::world::{World, init, message};
use welkin::capi::{sea::*, status::*, terrain::*, timeline::*, weather::*};

const SIZE: u32 = size_of::<wk_sea_point>() as u32;
const STRIDE: u32 = size_of::<wk_sea_region>() as u32;
const SQUARE: [[f64; 2]; 4] = [[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0]];

fn set(world: &World, sea: &wk_sea) -> wk_status {
    // SAFETY: live pointers.
    unsafe { wk_context_set_sea(world.context, sea) }
}

fn points<const N: usize>(world: &World, places: &[[f64; 3]; N], time_s: f64) -> [wk_sea_point; N] {
    // SAFETY: plain numbers.
    let mut points: [wk_sea_point; N] = unsafe { std::mem::zeroed() };
    // SAFETY: live pointers with the counts given.
    let status = unsafe {
        let to = points.as_mut_ptr();
        wk_context_get_sea_at(world.context, places.as_ptr(), N as u32, 24, time_s, 0.0, to, SIZE)
    };
    assert_eq!(status, WK_OK, "{}", message());
    points
}

fn state(world: &World, time_s: f64) -> wk_sea_state {
    let mut state = init("wk_sea_state");
    // SAFETY: live pointers.
    assert_eq!(unsafe { wk_context_get_sea_state(world.context, time_s, &mut state) }, WK_OK, "{}", message());
    state
}

/// A sea of a height and a period.
fn tall(height_m: f64, period_s: f64) -> wk_sea {
    let has = WK_SEA_HAS_HEIGHT | WK_SEA_HAS_PEAK_PERIOD;
    wk_sea { has, significant_height_m: height_m, peak_period_s: period_s, ..init("wk_sea") }
}

#[test]
fn a_sea_answers_points_and_statistics_at_any_time() {
    let world = World::new();
    let mut none = init("wk_sea_state");
    // SAFETY: live pointers.
    let before = unsafe { wk_context_get_sea_state(world.context, 0.0, &mut none) };
    assert_eq!((before, message().contains("has no sea")), (WK_ERROR_WRONG_ORDER, true));
    assert_eq!(set(&world, &tall(2.1, 6.2)), WK_OK, "{}", message());
    let s = state(&world, 500.0);
    assert!((s.significant_height_m - 2.1).abs() < 1e-9 && (s.peak_period_s / 6.2 - 1.0).abs() < 3e-3);
    assert!((s.highest_in_hour_m / 2.1 - 1.82).abs() < 0.02 && (s.attenuation_per_m[1] - 0.072).abs() < 1e-12);
    let places = [[0.0, 0.0, 50.0], [1e6, -1e6, 0.0], [12.5, 7.0, -3.0]];
    let first = points(&world, &places, 1e7);
    for (p, at) in first.iter().zip(places) {
        assert!(p.has_water == 1 && p.height_m != 0.0 && p.height_error_m < 0.01 && p.depth_m > 3990.0);
        let [x, y, z] = p.surface_m;
        assert!([x, y] == at[..2] && (z - p.height_m).abs() < 1e-9, "a flat world at sea level: {z} {}", p.height_m);
        assert!((p.normal.iter().map(|v| v * v).sum::<f64>() - 1.0).abs() < 1e-12);
    }
    // A query of the past does not change later results. A list of places with a larger stride gives the same bits.
    let _ = points(&world, &places, -40.0);
    let apart = places.map(|p| [p[0], p[1], p[2], f64::NAN]);
    // SAFETY: plain numbers; live pointers with the counts given.
    let again = unsafe {
        let mut again: [wk_sea_point; 3] = std::mem::zeroed();
        let to = again.as_mut_ptr();
        let status = wk_context_get_sea_at(world.context, apart.as_ptr().cast(), 3, 32, 1e7, 0.0, to, SIZE);
        assert_eq!(status, WK_OK, "{}", message());
        again
    };
    for (a, b) in first.iter().zip(&again) {
        assert_eq!((a.height_m, a.velocity_m_s, a.foam), (b.height_m, b.velocity_m_s, b.foam));
    }
    // SAFETY: live.
    assert_eq!(unsafe { wk_context_set_sea(world.context, null()) }, WK_OK);
    // SAFETY: live pointers.
    assert_eq!(unsafe { wk_context_get_sea_state(world.context, 0.0, &mut none) }, WK_ERROR_WRONG_ORDER);
}

#[test]
fn a_single_wave_has_the_height_and_period_that_were_set() {
    let world = World::new();
    let wave = wk_sea_wave { height_m: 1.0, length_m: 100.0, from_deg: 270.0, ..init("wk_sea_wave") };
    let calm = wk_sea { has: WK_SEA_HAS_SEA_STATE, waves: &wave, wave_count: 1, ..init("wk_sea") };
    assert_eq!(set(&world, &calm), WK_OK, "{}", message());
    let period_s = (2.0 * std::f64::consts::PI * 100.0 / 9.81_f64).sqrt();
    // A crest does not move sideways from its place at rest. Heights are raised by k a^2 / 2, so that their mean is 0.
    let raised = 0.5 * 2.0 * std::f64::consts::PI / 100.0 * 0.25;
    for (x, time_s, height) in [
        (0.0, 0.0, 0.5),
        (50.0, 0.0, -0.5),
        (100.0, 10.0 * period_s, 0.5),
        (25.0, 0.25 * period_s, 0.5),
        (0.0, 0.5 * period_s, -0.5),
    ] {
        let [p] = points(&world, &[[x, 33.0, 0.0]], time_s);
        assert!((p.height_m - height - raised).abs() < 2e-3, "{x} {time_s}: {}", p.height_m);
    }
    let s = state(&world, 0.0);
    assert!((s.significant_height_m - 2.0_f64.sqrt()).abs() < 1e-9 && (s.highest_in_hour_m - 1.0).abs() < 1e-9);
    assert!((s.peak_period_s / period_s - 1.0).abs() < 1e-6 && (s.mean_from_deg - 270.0).abs() < 1e-9);
    // The wave is now given by its period and runs from the north; the query is a quarter of a period later. Floes of
    // 60 m reduce its height by the factor 2 J1(x) / x with x = 1.885.
    let timed = wk_sea_wave { height_m: 1.0, period_s, phase_deg: 90.0, ..init("wk_sea_wave") };
    let ice = WK_SEA_HAS_SEA_STATE | WK_SEA_HAS_ICE;
    let icy = wk_sea { has: ice, ice_cover: 1.0, ice_floe_m: 60.0, ice_width_m: 0.0, waves: &timed, ..calm };
    assert_eq!(set(&world, &icy), WK_OK, "{}", message());
    let [p] = points(&world, &[[5e4, 0.0, 0.0]], 0.25 * period_s);
    assert!((p.height_m - 0.5 * 0.6175).abs() < 0.01, "{}", p.height_m);
}

#[test]
fn regions_are_dry_or_calm_or_have_their_level() {
    let world = World::new();
    assert_eq!(set(&world, &tall(2.0, 7.0)), WK_OK, "{}", message());
    let plain = wk_sea_region { corners_m: SQUARE.as_ptr(), corner_count: 4, ..init("wk_sea_region") };
    let hull = wk_sea_region { velocity_m_s: [10.0, 0.0], ..plain };
    let sheltered = WK_SEA_REGION_SHELTERED;
    let harbour = wk_sea_region { kind: sheltered, center_m: [500.0, 0.0, 0.0], wave_share: 0.1, ..plain };
    let lake = wk_sea_region {
        kind: WK_SEA_REGION_LAKE,
        center_m: [0.0, 700.0, 0.0],
        level_m: 41.0,
        depth_m: 6.0,
        wave_share: 0.0,
        ..plain
    };
    // SAFETY: live pointers; what is refused is not read beyond its count.
    let set_regions = |regions: &[wk_sea_region], count: u32| unsafe {
        wk_context_set_sea_regions(world.context, regions.as_ptr(), count, STRIDE)
    };
    let places = [[0.0, 0.0, 9.0], [500.0, 0.0, 0.0], [0.0, 700.0, 0.0], [100.0, 0.0, 0.0]];
    let open = points(&world, &places, 0.0);
    assert_eq!(set_regions(&[hull, harbour, lake], 3), WK_OK, "{}", message());
    let [deck, calm, pond, out] = points(&world, &places, 0.0);
    // A hull is dry, but its region still reports the height of the water around it.
    assert_eq!((deck.has_water, deck.height_m, deck.surface_m), (0, open[0].height_m, open[0].surface_m));
    assert!(deck.height_m != 0.0 && open[0].has_water == 1);
    assert_eq!((pond.height_m, pond.depth_m, pond.velocity_m_s), (41.0, 6.0, [0.0; 3]));
    assert_eq!((out.height_m, calm.has_water), (open[3].height_m, 1));
    assert!(calm.height_m.abs() < 0.3 && calm.height_error_m < 0.005, "{} {}", calm.height_m, open[1].height_m);
    // Ten seconds later the hull is 100 m farther east.
    let later = points(&world, &places, 10.0);
    assert_eq!((later[0].has_water, later[3].has_water), (1, 0));
    let bow = [[-20.0, -20.0], [20.0, 20.0], [20.0, -20.0], [-20.0, 20.0]];
    for (bad, wanted) in [
        (
            wk_sea_region { corners_m: bow.as_ptr(), ..hull },
            "regions[1].corners_m must be those of an outline that does",
        ),
        (wk_sea_region { corner_count: 2, ..hull }, "regions[1].corner_count must be in [3, 64]"),
        (wk_sea_region { corner_count: 65, ..hull }, "regions[1].corner_count must be at most 64"),
        (wk_sea_region { corners_m: null(), ..hull }, "regions[1].corners_m must not be NULL"),
        (
            wk_sea_region { velocity_m_s: [0.0, 61.0], ..hull },
            "regions[1].velocity_m_s must be a velocity of at most 60",
        ),
        (wk_sea_region { depth_m: f64::NAN, ..lake }, "regions[1].depth_m must be finite and in [0.1, 12000], got NaN"),
        (wk_sea_region { center_m: [2e12, 0.0, 0.0], ..lake }, "regions[1].center_m must be"),
        (wk_sea_region { kind: 3, ..lake }, "regions[1].kind must be one of"),
    ] {
        assert_eq!(set_regions(&[harbour, bad], 2), WK_ERROR_INVALID_ARGUMENT, "{wanted}");
        assert!(message().contains(wanted), "{wanted}: {}", message());
    }
    assert_eq!(set_regions(&[hull; 65], 65), WK_ERROR_INVALID_ARGUMENT);
    assert!(message().contains("at most 64"), "{}", message());
    assert_eq!(points(&world, &places, 0.0)[0].has_water, 0, "what stood goes on");
    assert_eq!(set_regions(&[hull; 64], 64), WK_OK, "{}", message());
    // Water inside regions alone.
    assert_eq!(set(&world, &wk_sea { flags: WK_SEA_ONLY_IN_REGIONS, ..tall(2.0, 7.0) }), WK_OK);
    assert_eq!(set_regions(&[lake], 1), WK_OK, "{}", message());
    assert_eq!(points(&world, &places, 0.0).map(|p| p.has_water), [0, 0, 1, 0]);
}

#[test]
fn ground_above_the_surface_is_dry() {
    let world = World::new();
    assert_eq!(set(&world, &wk_sea { level_m: 2.0, has: WK_SEA_HAS_SEA_STATE, ..init("wk_sea") }), WK_OK);
    // A beach that rises eastwards from -1.5 m; its last column is water by class, whatever its height.
    let heights: Vec<f32> = (0..1024).map(|i| -1.5 + 0.25 * (i % 32) as f32).collect();
    let classes: Vec<u8> = (0..1024).map(|i| if i % 32 == 31 { 5 } else { 1 }).collect();
    let terrain = wk_terrain { tile_cells: 32, cell_m: 2.0, ..init("wk_terrain") };
    let tile = wk_terrain_cells {
        heights_m: heights.as_ptr(),
        height_count: 1024,
        surface_classes: classes.as_ptr(),
        surface_class_count: 1024,
        ..init("wk_terrain_cells")
    };
    // SAFETY: live pointers.
    unsafe {
        assert_eq!(wk_context_set_terrain(world.context, &terrain), WK_OK, "{}", message());
        assert_eq!(wk_context_set_terrain_tile(world.context, &tile), WK_OK, "{}", message());
    }
    let at = |x: f64| points(&world, &[[x, 32.0, 0.0]], 0.0)[0];
    let (wet, shore, wood, basin) = (at(8.0), at(26.0), at(40.0), at(62.0));
    assert_eq!((wet.height_m, wet.has_water), (2.0, 1));
    assert!(
        (wet.depth_m - 2.5).abs() < 1e-6 && (shore.depth_m - 0.25).abs() < 1e-6,
        "{} {}",
        wet.depth_m,
        shore.depth_m
    );
    assert_eq!((wood.has_water, basin.has_water, basin.depth_m), (0, 1, 4000.0));
}

#[test]
fn faults_are_named_as_in_the_header_and_change_nothing() {
    let world = World::new();
    assert_eq!(set(&world, &tall(2.0, 7.0)), WK_OK, "{}", message());
    let before = points(&world, &[[3.0, 4.0, 0.0]], 9.0)[0].height_m;
    let base = || init::<wk_sea>("wk_sea");
    let swell = |height_m, period_s| wk_sea_swell { height_m, period_s, ..init("wk_sea_swell") };
    let (still, steep) = (swell(1.0, 0.0), swell(3.0, 4.0));
    let with = |swell: &wk_sea_swell| wk_sea { has: WK_SEA_HAS_SWELLS, swells: swell, swell_count: 1, ..base() };
    let wave = |length_m, period_s| wk_sea_wave { height_m: 1.0, length_m, period_s, ..init("wk_sea_wave") };
    let (both, neither, short) = (wave(50.0, 5.0), wave(0.0, 0.0), wave(5.0, 0.0));
    let alone = |wave: &wk_sea_wave| wk_sea { waves: wave, wave_count: 1, ..base() };
    let sources = WK_SEA_HAS_HEIGHT | WK_SEA_HAS_BEAUFORT;
    for (bad, wanted) in [
        (tall(6.0, 5.0), "sea.significant_height_m must be at most 2.60"),
        (with(&still), "sea.swells[0].period_s must be in [1, 30]"),
        (with(&steep), "sea.swells[0].height_m must be at most 1.66"),
        (wk_sea { depth_m: f64::NAN, ..base() }, "sea.depth_m must be finite and in [0.5, 12000], got NaN"),
        (wk_sea { has: WK_SEA_HAS_SEA_STATE, sea_state: 10, ..base() }, "sea.sea_state must be in [0, 9]"),
        (wk_sea { has: WK_SEA_HAS_SEA_STATE, sea_state: 300, ..base() }, "sea.sea_state must be in [0, 9]"),
        (wk_sea { has: WK_SEA_HAS_BEAUFORT, beaufort: 13.0, ..base() }, "sea.beaufort must be in [0, 12]"),
        (wk_sea { has: sources, ..base() }, "sea.has must be at most one of WK_SEA_HAS_HEIGHT"),
        (wk_sea { has: WK_SEA_HAS_PEAK_PERIOD, ..base() }, "sea.has must be with WK_SEA_HAS_HEIGHT where"),
        (wk_sea { has: WK_SEA_HAS_FETCH, ..base() }, "sea.fetch_m must be in [10, 2"),
        (wk_sea { has: WK_SEA_HAS_CLARITY, ..base() }, "sea.clarity_percent must be in [41.1, 98.1]"),
        (wk_sea { has: WK_SEA_HAS_ICE, ice_cover: 2.0, ..base() }, "sea.ice_cover must be in [0, 1]"),
        (
            wk_sea { has: WK_SEA_HAS_WIND_SEA_FROM, wind_sea_from_deg: 400.0, ..base() },
            "sea.wind_sea_from_deg must be in",
        ),
        (wk_sea { tide_amplitude_m: -1.0, ..base() }, "sea.tide_amplitude_m must be in [0, 10]"),
        (wk_sea { water_type: 8, ..base() }, "sea.water_type must be one of WK_WATER_TYPE_I"),
        (wk_sea { swell_count: 5, ..with(&steep) }, "sea.swell_count must be at most 4"),
        (wk_sea { wave_count: 17, ..alone(&short) }, "sea.wave_count must be at most 16"),
        (alone(&both), "sea.waves[0].period_s must be 0 where sea.waves[0].length_m is set"),
        (alone(&neither), "sea.waves[0].period_s must be 0 where"),
        (alone(&short), "sea.waves[0].height_m must be at most 0.7100 m"),
    ] {
        assert_eq!(set(&world, &bad), WK_ERROR_INVALID_ARGUMENT, "{wanted}");
        assert!(message().contains(wanted), "{wanted}: {}", message());
    }
    let place = [[0.0, 0.0, 0.0], [0.0, 0.0, 2e9]];
    // SAFETY: plain numbers.
    let mut out: [wk_sea_point; 2] = unsafe { std::mem::zeroed() };
    let mut ask = |count: u32, position_size: u32, time_s: f64, shortest_m: f64| {
        let to = out.as_mut_ptr();
        // SAFETY: live pointers with the counts given.
        let status = unsafe {
            let from = place.as_ptr();
            wk_context_get_sea_at(world.context, from, count, position_size, time_s, shortest_m, to, SIZE)
        };
        (status, message(), out[0].has_water)
    };
    for ((status, text, written), wanted) in [
        (ask(2, 24, 0.0, 0.0), "positions_m[1] must be at an altitude"),
        (ask(1, 16, 0.0, 0.0), "position_size must be at least 24"),
        (ask(1, 24, f64::NAN, 0.0), "time_s must be"),
        (ask(1, 24, 0.0, -1.0), "shortest_wave_m must be in [0, 10"),
        (ask(65_537, 24, 0.0, 0.0), "count must be at most 65536"),
    ] {
        assert_eq!((status, written), (WK_ERROR_INVALID_ARGUMENT, 0), "{wanted}: {text}");
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
    assert_eq!(points(&world, &[[3.0, 4.0, 0.0]], 9.0)[0].height_m, before, "nothing has changed");
}

#[test]
fn sea_settings_override_the_sea_of_the_weather() {
    let world = World::new();
    let weather = wk_weather {
        has: WK_WEATHER_HAS_SWELL | WK_WEATHER_HAS_SEA_WAVE_HEIGHT,
        sea_significant_wave_height_m: 1.5,
        swell_height_m: 2.0,
        swell_period_s: 12.0,
        swell_from_deg: 200.0,
        ..init("wk_weather")
    };
    // SAFETY: live pointers.
    assert_eq!(unsafe { wk_context_set_weather(world.context, &weather, 0.0, 0.0) }, WK_OK, "{}", message());
    assert_eq!(set(&world, &init("wk_sea")), WK_OK, "{}", message());
    assert!((state(&world, 10.0).significant_height_m - 2.5).abs() < 1e-9);
    assert_eq!(set(&world, &wk_sea { has: WK_SEA_HAS_SWELLS, ..init("wk_sea") }), WK_OK, "{}", message());
    assert!((state(&world, 10.0).significant_height_m - 1.5).abs() < 1e-9, "no swell");
    assert_eq!(set(&world, &tall(0.75, 4.0)), WK_OK, "{}", message());
    let height_m = state(&world, 10.0).significant_height_m;
    assert!((height_m - 0.75_f64.hypot(2.0)).abs() < 1e-9, "{height_m}");
}

#[test]
fn hulls_raise_wakes_that_a_hull_in_a_dry_region_does_not_feel() {
    let world = World::new();
    let calm = wk_sea { has: WK_SEA_HAS_SEA_STATE, sea_state: 0, ..init("wk_sea") };
    assert_eq!(set(&world, &calm), WK_OK, "{}", message());
    let stride = size_of::<wk_sea_hull>() as u32;
    let set_hulls = |hulls: &[wk_sea_hull]| unsafe {
        // SAFETY: the list is as long as it says.
        wk_context_set_sea_hulls(world.context, hulls.as_ptr(), hulls.len() as u32, stride)
    };
    // Heads north from the origin; 100 s later it is 600 m away.
    let hull = wk_sea_hull { speed_m_s: 6.0, ..init("wk_sea_hull") };
    assert_eq!(set_hulls(&[hull]), WK_OK, "{}", message());
    let places = [[0.0, 600.0, 0.0], [0.0, 612.0, 0.0], [0.0, 540.0, 0.0], [20.0, 540.0, 0.0], [0.0, 700.0, 0.0]];
    let [_, bow, wash, beside, ahead] = points(&world, &places, 100.0);
    assert!(wash.foam > 0.1 && beside.foam < 0.01 && beside.height_m.abs() > 0.02, "{} {}", wash.foam, beside.height_m);
    assert!(bow.height_m != 0.0 && ahead.height_m == 0.0 && ahead.normal == [0.0, 0.0, 1.0], "{}", ahead.height_m);
    let dry = wk_sea_region {
        corners_m: SQUARE.as_ptr(),
        corner_count: 4,
        velocity_m_s: [0.0, 6.0],
        ..init("wk_sea_region")
    };
    // SAFETY: live pointers.
    assert_eq!(unsafe { wk_context_set_sea_regions(world.context, &dry, 1, STRIDE) }, WK_OK, "{}", message());
    let [middle, bow, ..] = points(&world, &places, 100.0);
    assert_eq!((middle.has_water, middle.height_m, bow.height_m), (0, 0.0, 0.0));
    for (bad, wanted) in [
        (wk_sea_hull { length_m: 0.5, ..hull }, "hulls[1].length_m must be in [1, 500] m, got 0.5"),
        (wk_sea_hull { beam_m: f64::NAN, ..hull }, "hulls[1].beam_m must be finite and in [0.2, 100]"),
        (wk_sea_hull { draught_m: 31.0, ..hull }, "hulls[1].draught_m must be in [0.05, 30] m"),
        (wk_sea_hull { speed_m_s: 61.0, ..hull }, "hulls[1].speed_m_s must be in [0, 60] m/s, got 61"),
        (wk_sea_hull { turn_deg_s: -91.0, ..hull }, "hulls[1].turn_deg_s must be in [-90, 90]"),
        (wk_sea_hull { heading_deg: 361.0, ..hull }, "hulls[1].heading_deg must be in [-360, 360]"),
        (wk_sea_hull { at_s: 1e11, ..hull }, "hulls[1].at_s must be in"),
        (wk_sea_hull { position_m: [2e12, 0.0, 0.0], ..hull }, "hulls[1].position_m must be"),
        (hull, "hulls[1].id must be unlike those of the hulls before it"),
    ] {
        let bad = wk_sea_hull { id: u32::from(!wanted.contains("unlike")), ..bad };
        assert_eq!(set_hulls(&[hull, bad]), WK_ERROR_INVALID_ARGUMENT, "{wanted}");
        assert!(message().contains(wanted), "{wanted}: {}", message());
    }
    assert_eq!(set_hulls(&[hull; 65]), WK_ERROR_INVALID_ARGUMENT);
    assert!(message().contains("at most 64"), "{}", message());
    assert_eq!(points(&world, &places, 100.0)[3].height_m, beside.height_m, "what stood goes on");
    assert_eq!(set_hulls(&[]), WK_OK, "{}", message());
    // The wake of what has left stays for a while.
    assert!(points(&world, &places, 10.0)[0].height_m == 0.0);
}
