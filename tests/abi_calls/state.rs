//! Saved states: they contain everything that decides what a context shows, are restored completely or not at all, and
//! are distinguished by a format number.

use std::{
    ffi::{CString, c_void},
    path::Path,
    ptr::null_mut,
};

use welkin::capi::{
    area::*, cloud_map::*, clouds::*, conditions::*, context::*, fog_law::*, ground::*, ground_grid::*, light::*,
    lightning::*, query::*, rain::*, region::*, sea::*, stars::*, status::*, timeline::*, weather::*, weather_kinds::*,
    wind::*, wind_field::*, wind_grid::*,
};

use super::world::{World, init, message, update};

/// Number of the format that is written now.
const FORMAT: u32 = 2;
const FIXTURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/abi_calls/states");

/// A context that is destroyed at the end of its scope.
struct Own(*mut wk_context);

impl Own {
    fn new(world: &World, desc: &wk_context_desc) -> Self {
        let mut context = null_mut();
        // SAFETY: live pointers.
        assert_eq!(unsafe { wk_context_create(world.device, desc, &mut context) }, WK_OK, "{}", message());
        Self(context)
    }

    /// Creates a context that simulates the ground.
    fn simulated(world: &World) -> Self {
        let simulation = wk_simulation_desc { ground_model: WK_GROUND_SIMULATED, ..init("wk_simulation_desc") };
        let next = (&raw const simulation).cast();
        Self::new(world, &wk_context_desc { next, seed: 7, ..init("wk_context_desc") })
    }

    fn hash(&self) -> u64 {
        let mut hash = 0;
        // SAFETY: live pointers.
        assert_eq!(unsafe { wk_context_state_hash(self.0, &mut hash) }, WK_OK, "{}", message());
        hash
    }

    fn save(&self) -> Vec<u8> {
        let mut size = 0;
        // SAFETY: live pointers with the sizes given.
        unsafe {
            assert_eq!(wk_context_save(self.0, null_mut(), 0, &mut size), WK_OK, "{}", message());
            let mut state = vec![0; size];
            assert_eq!(wk_context_save(self.0, state.as_mut_ptr().cast(), size, &mut size), WK_OK, "{}", message());
            state
        }
    }

    fn load(&self, state: &[u8]) -> wk_status {
        // SAFETY: a live handle, and as many bytes.
        unsafe { wk_context_load(self.0, state.as_ptr().cast(), state.len()) }
    }
}

impl Drop for Own {
    fn drop(&mut self) {
        // SAFETY: live.
        assert_eq!(unsafe { wk_context_destroy(self.0) }, WK_OK);
    }
}

fn ok(status: wk_status) {
    assert_eq!(status, WK_OK, "{}", message());
}

/// Function that calls a setter with a value that a new context does not have.
type Set = unsafe fn(*mut wk_context);

unsafe fn set_rain(context: *mut wk_context) {
    let rain = wk_weather {
        precipitation_kind: WK_PRECIPITATION_RAIN,
        precipitation_rate_mm_h: 12.0,
        visibility_m: 4000.0,
        wind_speed_m_s: 6.0,
        ..init("wk_weather")
    };
    // SAFETY, here and below: live pointers with the sizes given.
    ok(unsafe { wk_context_set_weather(context, &rain, 100.0, 300.0) });
}

unsafe fn set_clock(context: *mut wk_context) {
    ok(unsafe { wk_context_set_clock(context, 1.7e9, 5.0) });
}

unsafe fn set_sun(context: *mut wk_context) {
    let sun = wk_given_direction { azimuth_deg: 140.0, elevation_deg: 40.0, ..init("wk_given_direction") };
    ok(unsafe { wk_context_set_sun(context, &sun) });
}

unsafe fn set_moon(context: *mut wk_context) {
    let moon = wk_given_direction { azimuth_deg: -90.0, elevation_deg: 10.0, ..init("wk_given_direction") };
    ok(unsafe { wk_context_set_moon(context, &moon) });
}

unsafe fn set_exposure(context: *mut wk_context) {
    ok(unsafe { wk_context_set_exposure(context, WK_EXPOSURE_EV100, 13.0) });
}

unsafe fn set_tone_curve(context: *mut wk_context) {
    ok(unsafe { wk_context_set_tone_curve(context, WK_TONE_FILMIC) });
}

/// The text of a planet that is not the default one.
fn other_planet() -> CString {
    CString::new(welkin::sky::Planet::earth().with_air_scaled(1.01).to_toml()).unwrap()
}

unsafe fn set_planet(context: *mut wk_context) {
    ok(unsafe { wk_context_set_planet(context, other_planet().as_ptr()) });
}

unsafe fn set_fog_law(context: *mut wk_context) {
    let law = wk_fog_law { curve: WK_FOG_CURVE_LINEAR, has: WK_FOG_LAW_HAS_COLOR, ..init("wk_fog_law") };
    ok(unsafe { wk_context_set_fog_law(context, &law) });
}

unsafe fn set_ground_grid(context: *mut wk_context) {
    let mut heights = [0.0f32; 25];
    heights[12] = -0.2;
    let grid = wk_ground_grid {
        origin_m: [-4.0, -4.0, 0.0],
        cell_m: 2.0,
        nodes: [5, 5],
        heights_m: heights.as_ptr(),
        height_count: 25,
        ..init("wk_ground_grid")
    };
    ok(unsafe { wk_context_set_ground_grid(context, &grid) });
}

unsafe fn set_lights(context: *mut wk_context) {
    let lights = [init("wk_light"), wk_light { inner_deg: 3.0, ..init("wk_light") }];
    ok(unsafe { wk_context_set_lights(context, lights.as_ptr(), 2, size_of::<wk_light>() as u32) });
}

unsafe fn set_rain_areas(context: *mut wk_context) {
    let area = wk_rain_area { center_m: [900.0, 400.0, 0.0], ..init("wk_rain_area") };
    ok(unsafe { wk_context_set_rain_areas(context, &area, 1, size_of::<wk_rain_area>() as u32) });
}

unsafe fn set_weather_regions(context: *mut wk_context) {
    let region = wk_weather_region { has: WK_WEATHER_PART_WIND, ..init("wk_weather_region") };
    ok(unsafe { wk_context_set_weather_regions(context, &region, 1, size_of::<wk_weather_region>() as u32) });
}

unsafe fn set_shelters(context: *mut wk_context) {
    let mut shape = wk_shelter_shape { plane_count: 1, ..init("wk_shelter_shape") };
    shape.planes[..4].copy_from_slice(&[0.0, 0.6, 0.8, 0.5]);
    let next = (&raw const shape).cast::<c_void>();
    let shelters = [
        wk_shelter { center_m: [1.0, 2.0, 3.0], next, ..init("wk_shelter") },
        wk_shelter { velocity_m_s: [9.0, 0.0, 0.0], ..init("wk_shelter") },
    ];
    ok(unsafe { wk_context_set_shelters(context, shelters.as_ptr(), 2, size_of::<wk_shelter>() as u32) });
}

unsafe fn set_sea(context: *mut wk_context) {
    let swells = [wk_sea_swell { height_m: 1.5, period_s: 11.0, spread_deg: 8.0, ..init("wk_sea_swell") }];
    let waves = [wk_sea_wave { height_m: 0.5, period_s: 7.0, phase_deg: 90.0, ..init("wk_sea_wave") }];
    let sea = wk_sea {
        has: WK_SEA_HAS_BEAUFORT | WK_SEA_HAS_FETCH | WK_SEA_HAS_SWELLS | WK_SEA_HAS_CLARITY | WK_SEA_HAS_ICE,
        flags: WK_SEA_WITHOUT_WHITECAPS | WK_SEA_ONLY_IN_REGIONS,
        level_m: 0.5,
        depth_m: 30.0,
        tide_amplitude_m: 1.25,
        fetch_m: 8e4,
        beaufort: 5.5,
        clarity_percent: 77.5,
        ice_cover: 0.25,
        swells: swells.as_ptr(),
        swell_count: 1,
        waves: waves.as_ptr(),
        wave_count: 1,
        ..init("wk_sea")
    };
    ok(unsafe { wk_context_set_sea(context, &sea) });
}

unsafe fn set_sea_regions(context: *mut wk_context) {
    let corners = [[-8.0, -20.0], [8.0, -20.0], [0.0, 25.0]];
    let region = wk_sea_region { corners_m: corners.as_ptr(), corner_count: 3, ..init("wk_sea_region") };
    let regions = [
        wk_sea_region { velocity_m_s: [3.0, -4.0], turn_deg_s: 0.5, ..region },
        wk_sea_region { kind: WK_SEA_REGION_LAKE, level_m: 31.5, wave_share: 0.25, ..region },
    ];
    ok(unsafe { wk_context_set_sea_regions(context, regions.as_ptr(), 2, size_of::<wk_sea_region>() as u32) });
}

unsafe fn set_sea_hulls(context: *mut wk_context) {
    let hull = wk_sea_hull { speed_m_s: 6.0, turn_deg_s: 2.0, ..init("wk_sea_hull") };
    let set = |hulls: &[wk_sea_hull]| {
        let stride = size_of::<wk_sea_hull>() as u32;
        // SAFETY: the list is as long as it says.
        ok(unsafe { wk_context_set_sea_hulls(context, hulls.as_ptr(), hulls.len() as u32, stride) });
    };
    set(&[hull, wk_sea_hull { id: 9, length_m: 80.0, ..hull }]);
    // One goes on with its track, the other leaves its waves.
    set(&[wk_sea_hull { position_m: [50.0, 20.0, 0.0], heading_deg: 40.0, at_s: 20.0, ..hull }]);
}

unsafe fn set_stars(context: *mut wk_context) {
    let turn = [0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let flags = WK_STARS_TURNED | WK_STARS_NO_PLANETS;
    let stars = wk_stars { flags, celestial_to_world: turn, airglow: 1.5, ..init("wk_stars") };
    ok(unsafe { wk_context_set_stars(context, &stars) });
}

unsafe fn set_lightning(context: *mut wk_context) {
    let (cells, masts) = ([1.0, 2.0, 3.0, 400.0, 5.5], [7.0, 8.0, 90.0]);
    let lightning = wk_lightning {
        flags: WK_LIGHTNING_RATE,
        flicker: WK_FLICKER_LIMITED,
        flashes_per_minute: 2.5,
        cell_count: 1,
        mast_count: 1,
        cells: cells.as_ptr(),
        masts: masts.as_ptr(),
        ..init("wk_lightning")
    };
    ok(unsafe { wk_context_set_lightning(context, &lightning) });
}

unsafe fn trigger_flash(context: *mut wk_context) {
    let flash = wk_flash_trigger { time_s: 9.0, peak_ka: 20.0, strokes: 2, ..init("wk_flash_trigger") };
    ok(unsafe { wk_context_trigger_flash(context, &flash) });
}

unsafe fn set_wind_field(context: *mut wk_context) {
    let field = wk_wind_field { cells: [8, 16, 8], mode: WK_WIND_FIELD_RUNNING, ..init("wk_wind_field") };
    // The field begins later, because a running field makes a large state (src/flow/held/tests.rs).
    ok(unsafe { wk_context_set_wind_field(context, &field, 100.0) });
}

unsafe fn set_wind_grid(context: *mut wk_context) {
    let velocities = [[1.5f32, -0.0, 0.25]; 8];
    let grid = wk_wind_grid {
        kind: WK_WIND_GRID_ADDED,
        velocities_m_s: velocities.as_ptr().cast(),
        velocity_count: 8,
        ..init("wk_wind_grid")
    };
    ok(unsafe { wk_context_set_wind_grid(context, &grid) });
}

unsafe fn set_default_surface_class(context: *mut wk_context) {
    ok(unsafe { wk_context_set_default_surface_class(context, WK_SURFACE_CLASS_PAVED) });
}

unsafe fn set_cloud_model(context: *mut wk_context) {
    ok(unsafe { wk_context_set_cloud_model(context, WK_CLOUD_MODEL_DECK) });
}

unsafe fn set_cloud_map(context: *mut wk_context) {
    let cover = [0.0f32, 0.25, 1.0, 1.0, 0.1, 0.0];
    let map = wk_cloud_map { cells: [3, 2], cover: cover.as_ptr(), cover_count: 6, ..init("wk_cloud_map") };
    ok(unsafe { wk_context_set_cloud_map(context, &map) });
}

unsafe fn set_time(context: *mut wk_context) {
    ok(unsafe { wk_context_update(context, 7.25) });
}

unsafe fn set_all(context: *mut wk_context) {
    SETTERS[..24].iter().for_each(|(_, set)| unsafe { set(context) });
}

/// Every function that changes what a context shows.
const SETTERS: [(&str, Set); 26] = [
    ("wk_context_set_clock", set_clock),
    ("wk_context_set_cloud_map", set_cloud_map),
    ("wk_context_set_cloud_model", set_cloud_model),
    ("wk_context_set_default_surface_class", set_default_surface_class),
    ("wk_context_set_exposure", set_exposure),
    ("wk_context_set_fog_law", set_fog_law),
    ("wk_context_set_ground_grid", set_ground_grid),
    ("wk_context_set_lightning", set_lightning),
    ("wk_context_set_lights", set_lights),
    ("wk_context_set_moon", set_moon),
    ("wk_context_set_planet", set_planet),
    ("wk_context_set_rain_areas", set_rain_areas),
    ("wk_context_set_sea", set_sea),
    ("wk_context_set_sea_hulls", set_sea_hulls),
    ("wk_context_set_sea_regions", set_sea_regions),
    ("wk_context_set_shelters", set_shelters),
    ("wk_context_set_stars", set_stars),
    ("wk_context_set_sun", set_sun),
    ("wk_context_set_tone_curve", set_tone_curve),
    ("wk_context_set_weather", set_rain),
    ("wk_context_set_weather_regions", set_weather_regions),
    ("wk_context_set_wind_field", set_wind_field),
    ("wk_context_set_wind_grid", set_wind_grid),
    ("wk_context_trigger_flash", trigger_flash),
    ("wk_context_update", set_time),
    ("all at once", set_all),
];

/// Functions whose values a state does not contain, as the header says: images, which each channel has for itself; sky
/// settings; and tiles, whose heights the host sets before it loads (their water: tests/ground/tiles.rs, their soil:
/// tests/soil), and how they are drawn.
const NOT_STATE: [&str; 6] = [
    "wk_context_set_occluder_maps",
    "wk_context_set_sky_settings",
    "wk_context_set_soil",
    "wk_context_set_terrain",
    "wk_context_set_terrain_drawing",
    "wk_context_set_terrain_tile",
];

#[test]
fn what_any_setter_sets_is_in_the_hash_and_comes_back_with_the_state() {
    let world = World::new();
    let symbols = include_str!("../abi/symbols.txt").lines();
    for name in symbols.filter(|s| s.starts_with("wk_context_set_")) {
        let known = SETTERS.iter().any(|(of, _)| *of == name) || NOT_STATE.contains(&name);
        assert!(known, "{name} has no line here: what it sets must be in the hash and in the state");
    }
    let fresh = || Own::simulated(&world);
    let plain = fresh();
    for (name, set) in SETTERS {
        let context = fresh();
        // SAFETY: live.
        unsafe { set(context.0) };
        assert_ne!(context.hash(), plain.hash(), "{name} is not in the hash");
        let state = context.save();
        let second = fresh();
        assert_eq!(second.load(&state), WK_OK, "{name}: {}", message());
        assert_eq!(second.hash(), context.hash(), "{name} does not come back");
        assert!(second.save() == state, "{name} does not come back");
        // A load removes what was set before.
        assert_eq!(second.load(&plain.save()), WK_OK, "{name}: {}", message());
        assert_eq!(second.hash(), plain.hash(), "{name} stays behind");
    }
}

#[test]
fn a_state_of_another_place_or_kind_is_refused_by_name() {
    let world = World::new();
    let desc = || init::<wk_context_desc>("wk_context_desc");
    let own = Own::new(&world, &desc());
    let (state, hash) = (own.save(), own.hash());
    let simulation = wk_simulation_desc { ground_model: WK_GROUND_SIMULATED, ..init("wk_simulation_desc") };
    for (other, name) in [
        (wk_context_desc { latitude_deg: 50.5, ..desc() }, "latitude_deg (50.0 in the state, 50.5 here)"),
        (wk_context_desc { longitude_deg: -10.0, ..desc() }, "longitude_deg (10.0 in the state, -10.0 here)"),
        (wk_context_desc { altitude_m: 3.0, ..desc() }, "altitude_m"),
        (wk_context_desc { grid_bearing_deg: 1.0, ..desc() }, "grid_bearing_deg"),
        (wk_context_desc { world_kind: WK_WORLD_TANGENT, ..desc() }, "world_kind"),
        (wk_context_desc { world_kind: WK_WORLD_ECEF, ..desc() }, "world_kind"),
        (wk_context_desc { axes: WK_AXES_Y_UP, ..desc() }, "axes"),
        (wk_context_desc { seed: 1, ..desc() }, "seed"),
        (wk_context_desc { next: (&raw const simulation).cast(), ..desc() }, "ground_model"),
    ] {
        let context = Own::new(&world, &other);
        let before = context.hash();
        assert_ne!(before, hash, "{name} is not in the hash");
        assert_eq!(context.load(&state), WK_ERROR_INVALID_ARGUMENT, "{name}");
        assert!(message().contains(name), "{name}: {}", message());
        assert_eq!(context.hash(), before, "{name}: a refused state changes nothing");
    }
    // The error names every fixed value that differs. Values that a state restores may differ.
    let other = wk_context_desc { latitude_deg: 0.0, seed: 9, ..desc() };
    assert_eq!(Own::new(&world, &other).load(&state), WK_ERROR_INVALID_ARGUMENT);
    assert!(message().contains("latitude_deg") && message().contains("seed"), "{}", message());
    let planet = other_planet();
    let other = wk_context_desc {
        exposure_value: 1.0,
        utc_at_zero_s: 0.0,
        tone_curve: WK_TONE_FILMIC,
        planet_toml: planet.as_ptr(),
        ..desc()
    };
    let context = Own::new(&world, &other);
    assert_ne!(context.hash(), hash);
    ok(context.load(&state));
    assert_eq!(context.hash(), hash);
}

#[test]
fn one_byte_changed_anywhere_is_refused_and_so_is_any_cut() {
    let world = World::new();
    let (first, second) = (Own::simulated(&world), Own::simulated(&world));
    // SAFETY: live.
    unsafe { set_all(first.0) };
    let state = first.save();
    let before = second.hash();
    for at in 0..state.len() {
        let mut bad = state.clone();
        bad[at] ^= 1 << (at * 5 % 8);
        assert_eq!(second.load(&bad), WK_ERROR_PARSE, "byte {at}");
    }
    for cut in (0..state.len()).step_by(7) {
        assert_eq!(second.load(&state[..cut]), WK_ERROR_PARSE, "cut at {cut}");
    }
    assert_eq!(second.load(&[state.as_slice(), b"\n"].concat()), WK_ERROR_PARSE, "longer");
    assert_eq!(second.hash(), before, "a refused state changes nothing");
    ok(second.load(&state));
    assert_eq!(second.hash(), first.hash());
}

/// Returns query results of a context with everything set, in the order of the file beside the state.
fn answers(context: *mut wk_context, time_s: f64) -> Vec<(&'static str, f64)> {
    let at = [0.5; 3];
    let (mut now, mut ground, mut wind) = (init::<wk_conditions>("wk_conditions"), init("wk_ground"), init("wk_wind"));
    let (mut sun, mut moon) = (init::<wk_celestial>("wk_celestial"), init("wk_celestial"));
    let mut rain = init::<wk_rainfall>("wk_rainfall");
    // SAFETY: live pointers.
    unsafe {
        ok(wk_context_get_conditions(context, &at, time_s, &mut now));
        ok(wk_context_get_ground(context, &at, &mut ground));
        ok(wk_context_get_wind_at(context, &at, time_s, &mut wind));
        ok(wk_context_get_sun_at(context, &at, time_s, &mut sun));
        ok(wk_context_get_moon_at(context, &at, time_s, &mut moon));
        ok(wk_context_get_rainfall_at(context, &[900.0, 400.0, 0.0], time_s, &mut rain));
    }
    vec![
        ("visibility_m", now.visibility_m),
        ("temperature_c", now.temperature_c),
        ("rain_mm_h", now.rain_mm_h),
        ("cloud_cover", now.cloud_cover),
        ("water_mm", ground.water_mm),
        ("film_mm", ground.film_mm),
        ("wetness", ground.wetness),
        ("surface_class", f64::from(ground.surface_class)),
        ("wind_east_m_s", wind.velocity_m_s[0]),
        ("wind_north_m_s", wind.velocity_m_s[1]),
        ("wind_up_m_s", wind.velocity_m_s[2]),
        ("sun_east", sun.direction[0]),
        ("sun_up", sun.direction[2]),
        ("moon_east", moon.direction[0]),
        ("area_rate_mm_h", rain.rate_mm_h),
        ("area_extinction_per_m", rain.extinction_per_m),
    ]
}

/// Loads a committed state of each format that was ever written. `WELKIN_BLESS=1` writes the state of the present
/// format anew. That is right only until a release has written this format: afterwards, a state that no longer loads
/// needs a new format number.
#[test]
fn states_of_older_formats_load_or_are_refused_by_their_number() {
    let world = World::new();
    let context = Own::simulated(&world);
    // SAFETY: live.
    unsafe { set_all(context.0) };
    update(context.0, 1234.5);
    let own = Path::new(FIXTURES).join(format!("format{FORMAT}.state"));
    if std::env::var_os("WELKIN_BLESS").is_some() {
        std::fs::write(&own, context.save()).unwrap();
    }
    let kept = std::fs::read(&own).unwrap();
    let (second, third) = (Own::simulated(&world), Own::simulated(&world));
    let wanted = "what is new must mean at its default what there was before";
    assert_eq!(second.load(&kept), WK_OK, "{wanted}: {}", message());
    ok(third.load(&second.save()));
    assert!(third.save() == second.save());
    // The loaded context has the values that were set when the state was written, and continues.
    let mut ground = init::<wk_ground>("wk_ground");
    let mut wind = init::<wk_wind>("wk_wind");
    // SAFETY: live pointers.
    unsafe {
        ok(wk_context_get_ground(second.0, &[0.0; 3], &mut ground));
        ok(wk_context_get_wind_at(second.0, &[0.5; 3], 1234.5, &mut wind));
    }
    assert!(ground.in_puddle == 1 && ground.water_mm > 5.0, "{}", ground.water_mm);
    assert!((0.2..0.3).contains(&wind.velocity_m_s[2]), "the wind grid's updraught: {:?}", wind.velocity_m_s);
    // Its query results are those that were stored when the state was written.
    let found = answers(second.0, 1234.5);
    let path = Path::new(FIXTURES).join(format!("format{FORMAT}.answers"));
    if std::env::var_os("WELKIN_BLESS").is_some() {
        std::fs::write(&path, found.iter().map(|(name, value)| format!("{name} {value:?}\n")).collect::<String>())
            .unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap();
    assert_eq!(written.lines().count(), found.len());
    for (line, (name, value)) in written.lines().zip(&found) {
        let (of, wanted) = line.split_once(' ').unwrap();
        let wanted: f64 = wanted.parse().unwrap();
        assert!(of == *name && (value - wanted).abs() <= 1e-9 * wanted.abs(), "{name}: {value}, was {line}");
    }
    update(second.0, 2000.0);
    let before = second.hash();
    // The old state contains no planet and no tone curve, so it loads only into a context with the same ones.
    let others: [(&str, Set); 2] = [("planet_toml", set_planet), ("tone_curve", set_tone_curve)];
    for (name, set) in others {
        let other = Own::simulated(&world);
        // SAFETY: live.
        unsafe { set(other.0) };
        assert_eq!(other.load(&kept), WK_ERROR_INVALID_ARGUMENT, "{name}");
        assert!(message().contains(name), "{name}: {}", message());
    }
    for old in 1..FORMAT {
        let state = std::fs::read(Path::new(FIXTURES).join(format!("format{old}.state"))).unwrap();
        assert_eq!(second.load(&state), WK_ERROR_PARSE);
        let wanted = format!("it is of format {old}, this version of Welkin reads format {FORMAT} alone");
        assert!(message().contains(&wanted), "{}", message());
    }
    let newer = String::from_utf8(kept).unwrap().replacen("welkin state 2 ", "welkin state 3 ", 1);
    assert_eq!(second.load(newer.as_bytes()), WK_ERROR_PARSE);
    assert!(message().contains("it is of format 3"), "{}", message());
    assert_eq!(second.hash(), before);
}

#[test]
fn a_leap_is_answered_with_pending_until_all_steps_are_done() {
    let world = World::new();
    let context = Own::simulated(&world);
    let side = 128u32;
    let heights: Vec<f32> = (0..side * side).map(|i| (i.wrapping_mul(2_654_435_761) >> 20) as f32 * 1e-4).collect();
    let grid = wk_ground_grid {
        nodes: [side; 2],
        heights_m: heights.as_ptr(),
        height_count: side * side,
        ..init("wk_ground_grid")
    };
    let state_time = || {
        let mut state_time_s = f64::NAN;
        // SAFETY: live pointers.
        ok(unsafe { wk_context_get_state_time(context.0, &mut state_time_s) });
        state_time_s
    };
    let (mut calls, mut last) = (0, 0.0);
    // SAFETY, for all: live pointers.
    unsafe {
        set_rain(context.0);
        ok(wk_context_set_ground_grid(context.0, &grid));
        let end_s = 20_000.0;
        // Two thousand steps of 16 384 cells take longer than 50 ms on any machine.
        while wk_context_update(context.0, end_s) == WK_PENDING {
            calls += 1;
            let now = state_time();
            assert!(now >= last + 10.0 && now < end_s, "at least a step a call: {last} {now}");
            last = now;
            let mut size = 0;
            assert_eq!(wk_context_save(context.0, null_mut(), 0, &mut size), WK_ERROR_WRONG_ORDER);
            assert!(message().contains("wk_context_update has answered WK_OK"), "{}", message());
            let mut hash = 0;
            assert_eq!(wk_context_state_hash(context.0, &mut hash), WK_ERROR_WRONG_ORDER);
            assert_eq!(wk_context_update(context.0, end_s - 1.0), WK_ERROR_WRONG_ORDER, "time does not run back");
        }
        assert!(calls > 0);
        assert_eq!((state_time(), wk_context_update(context.0, end_s)), (end_s, WK_OK));
        let mut ground = init::<wk_ground>("wk_ground");
        ok(wk_context_get_ground(context.0, &[50.0, 50.0, 0.0], &mut ground));
        assert!(ground.wetness > 0.5, "{}", ground.wetness);
    }
    assert_ne!(context.hash(), 0);
}
