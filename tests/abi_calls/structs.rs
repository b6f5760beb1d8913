//! Every input struct: each float NaN and infinite, each enumeration unknown, each reserved field set, sizes of other
//! versions, foreign types and extensions. The table of fields comes from the library; another test compares it with
//! C's view.

use std::collections::BTreeSet;
use std::ffi::c_void;
use std::ptr::{null, null_mut};

use welkin::capi::{
    abi, air::*, area::*, cloud_map::*, cloud_shadow::*, clouds::*, conditions::*, context::*, device::*,
    environment::*, fog_law::*, frame::*, ground::*, ground_grid::*, ground_texture::*, light::*, lightning::*,
    occluder::*, opengl::*, plan::*, query::*, rain::*, region::*, report::*, sea::*, sky::*, snow::*, snowpack::*,
    soil::*, stars::*, status::*, surface::*, terrain::*, texture::*, timeline::*, veil::*, view::*, vulkan::*,
    weather::*, wind::*, wind_field::*, wind_grid::*, windscreen::*,
};

use super::world::{Bytes, World, init, message, next_frame};

/// A call that reads the struct at the pointer before it does anything else.
struct Case {
    structure: &'static str,
    parameter: &'static str,
    null_is_default: bool,
    call: Box<dyn Fn(*mut c_void) -> wk_status>,
}

fn case(
    structure: &'static str,
    parameter: &'static str,
    null_is_default: bool,
    call: impl Fn(*mut c_void) -> wk_status + 'static,
) -> Case {
    Case { structure, parameter, null_is_default, call: Box::new(call) }
}

fn cases(world: &World) -> Vec<Case> {
    let (device, context, view) = (world.device, world.context, world.view);
    // SAFETY, for all: the struct is what is tested, other pointers are live.
    vec![
        case("wk_device_desc", "desc", true, |p| {
            let mut out = null_mut();
            let status = unsafe { wk_device_create(p.cast(), &mut out) };
            kept(status, out);
            unsafe { wk_device_destroy(out) };
            status
        }),
        case("wk_texture_desc", "desc", false, move |p| {
            let mut out = null_mut();
            let status = unsafe { wk_texture_create(device, p.cast(), &mut out) };
            kept(status, out);
            unsafe { wk_texture_destroy(out) };
            status
        }),
        case("wk_context_desc", "desc", true, move |p| {
            let mut out = null_mut();
            let status = unsafe { wk_context_create(device, p.cast(), &mut out) };
            kept(status, out);
            unsafe { wk_context_destroy(out) };
            status
        }),
        case("wk_given_direction", "direction", true, move |p| unsafe { wk_context_set_sun(context, p.cast()) }),
        case("wk_view_desc", "desc", true, move |p| {
            let mut out = null_mut();
            let status = unsafe { wk_view_create(context, p.cast(), &mut out) };
            kept(status, out);
            unsafe { wk_view_destroy(out) };
            status
        }),
        case("wk_frame", "frame", false, move |p| {
            // A frame records each stage once. If this frame has been recorded, another frame comes in between, so that
            // frame_id's bytes, which are also under test, need no change.
            let at = p.cast::<wk_frame>();
            let status = unsafe { wk_view_record(view, at, WK_STAGE_PREPARE) };
            if status == WK_ERROR_WRONG_ORDER {
                unsafe { record_again(view) };
                return unsafe { wk_view_record(view, at, WK_STAGE_PREPARE) };
            }
            status
        }),
        case("wk_own_target", "frame.target", true, move |p| {
            let frame = wk_frame { frame_id: next_frame(), target: p, ..init("wk_frame") };
            unsafe { wk_view_record(view, &frame, WK_STAGE_PREPARE) }
        }),
        case("wk_weather", "weather", false, move |p| unsafe { wk_context_set_weather(context, p.cast(), 0.0, 0.0) }),
        case("wk_weather_overrides", "wk_weather_overrides", true, move |p| {
            let weather = wk_weather { next: p, ..init("wk_weather") };
            unsafe { wk_context_set_weather(context, &weather, 0.0, 0.0) }
        }),
        case("wk_cloud_layer", "weather.clouds[0]", true, move |p| {
            // In a list of one element the stride is not used, so it may be as large as the sizes that are tried.
            let weather = wk_weather { clouds: p.cast(), cloud_count: 1, cloud_stride: 2 << 20, ..init("wk_weather") };
            unsafe { wk_context_set_weather(context, &weather, 0.0, 0.0) }
        }),
        case("wk_metar", "out_metar", true, |p| {
            let mut weather = init("wk_weather");
            unsafe {
                wk_weather_from_metar(
                    c"LBBG 041600Z 12012KT CAVOK 20/10 Q1013".as_ptr(),
                    null_mut(),
                    0,
                    0,
                    &mut weather,
                    p.cast(),
                )
            }
        }),
        case("wk_metar_options", "options", true, |p| {
            let mut weather = init("wk_weather");
            let report = c"LBBG 041600Z 12012KT CAVOK 20/10 Q1013".as_ptr();
            unsafe { wk_weather_from_metar_with(report, p.cast(), null_mut(), 0, 0, &mut weather, null_mut()) }
        }),
        case("wk_shelter", "shelters[0]", true, move |p| unsafe {
            wk_context_set_shelters(context, p.cast(), 1, 1 << 24)
        }),
        case("wk_shelter_shape", "wk_shelter_shape", true, move |p| {
            let shelter = wk_shelter { next: p, ..init("wk_shelter") };
            unsafe { wk_context_set_shelters(context, &shelter, 1, size_of::<wk_shelter>() as u32) }
        }),
        case("wk_rain_area", "areas[0]", true, move |p| unsafe {
            wk_context_set_rain_areas(context, p.cast(), 1, 1 << 24)
        }),
        case("wk_weather_region", "regions[0]", true, move |p| unsafe {
            wk_context_set_weather_regions(context, p.cast(), 1, 1 << 24)
        }),
        case("wk_occluder_map", "maps[0]", true, move |p| unsafe {
            wk_context_set_occluder_maps(context, p.cast(), 1, 1 << 24)
        }),
        case("wk_light", "lights[0]", true, move |p| unsafe { wk_context_set_lights(context, p.cast(), 1, 1 << 24) }),
        case("wk_wind_field", "wind_field", true, move |p| unsafe {
            wk_context_set_wind_field(context, p.cast(), 0.0)
        }),
        case("wk_wind_field_report", "out_report", false, move |p| unsafe {
            wk_context_get_wind_field_report(context, p.cast())
        }),
        case("wk_wind_grid", "wind_grid", true, move |p| unsafe { wk_context_set_wind_grid(context, p.cast()) }),
        case("wk_cloud_map", "cloud_map", true, move |p| unsafe { wk_context_set_cloud_map(context, p.cast()) }),
        case("wk_ground_grid", "ground_grid", true, move |p| unsafe { wk_context_set_ground_grid(context, p.cast()) }),
        case("wk_terrain", "terrain", true, move |p| unsafe { wk_context_set_terrain(context, p.cast()) }),
        case("wk_terrain_drawing", "terrain_drawing", true, move |p| unsafe {
            wk_context_set_terrain_drawing(context, p.cast())
        }),
        case("wk_terrain_cells", "terrain_cells", false, move |p| unsafe {
            wk_context_update_terrain(context, p.cast())
        }),
        case("wk_soil", "soil", true, move |p| unsafe { wk_context_set_soil(context, p.cast()) }),
        case("wk_soil_kind", "soil.own_kinds[0]", true, move |p| {
            let soil = wk_soil { own_kind_count: 1, own_kinds: p.cast(), own_kind_stride: 1 << 24, ..init("wk_soil") };
            unsafe { wk_context_set_soil(context, &soil) }
        }),
        case("wk_soil_tool", "shape", false, move |p| unsafe {
            wk_context_add_soil_tool(context, p.cast(), &init("wk_soil_pose"), &mut 0)
        }),
        case("wk_soil_pose", "pose", false, move |p| unsafe { wk_context_move_soil_tool(context, 1, p.cast()) }),
        case("wk_soil_tool_report", "out_report", false, move |p| unsafe {
            wk_context_get_soil_tool(context, 1, p.cast())
        }),
        case("wk_soil_blade", "blade", false, move |p| unsafe {
            wk_context_get_soil_resistance(context, 1, p.cast(), &mut init("wk_cutting_force"))
        }),
        case("wk_cutting_force", "out_force", false, move |p| unsafe {
            wk_context_get_soil_resistance(context, 1, &init("wk_soil_blade"), p.cast())
        }),
        case("wk_soil_balance", "out_balance", false, move |p| unsafe {
            wk_context_get_soil_balance(context, p.cast())
        }),
        case("wk_rain", "rain", true, move |p| unsafe { wk_view_set_rain(view, p.cast()) }),
        case("wk_snow", "snow", true, move |p| unsafe { wk_view_set_snow(view, p.cast()) }),
        case("wk_clouds", "clouds", true, move |p| unsafe { wk_view_set_clouds(view, p.cast()) }),
        case("wk_lightning", "lightning", true, move |p| unsafe { wk_context_set_lightning(context, p.cast()) }),
        case("wk_flash_trigger", "flash", true, move |p| unsafe { wk_context_trigger_flash(context, p.cast()) }),
        case("wk_flash_light", "out_light", false, move |p| unsafe {
            wk_context_get_flash_light(context, &ORIGIN, 0.0, 0.0, p.cast())
        }),
        case("wk_sea", "sea", true, move |p| unsafe { wk_context_set_sea(context, p.cast()) }),
        case("wk_sea_swell", "sea.swells[0]", true, move |p| {
            let (swells, swell_stride) = (p.cast(), 2 << 20);
            let sea = wk_sea { has: WK_SEA_HAS_SWELLS, swells, swell_count: 1, swell_stride, ..init("wk_sea") };
            unsafe { wk_context_set_sea(context, &sea) }
        }),
        case("wk_sea_wave", "sea.waves[0]", true, move |p| {
            let sea = wk_sea { waves: p.cast(), wave_count: 1, wave_stride: 2 << 20, ..init("wk_sea") };
            unsafe { wk_context_set_sea(context, &sea) }
        }),
        case("wk_sea_region", "regions[0]", true, move |p| unsafe {
            wk_context_set_sea_regions(context, p.cast(), 1, 1 << 24)
        }),
        case("wk_sea_hull", "hulls[0]", true, move |p| unsafe {
            wk_context_set_sea_hulls(context, p.cast(), 1, 1 << 24)
        }),
        case("wk_sea_state", "out_state", false, move |p| unsafe { wk_context_get_sea_state(context, 0.0, p.cast()) }),
        case("wk_stars", "stars", true, move |p| unsafe { wk_context_set_stars(context, p.cast()) }),
        case("wk_fog_law", "fog_law", true, move |p| unsafe { wk_context_set_fog_law(context, p.cast()) }),
        case("wk_sky_settings", "wk_sky_settings", true, move |p| {
            let desc = wk_context_desc { next: p, ..init("wk_context_desc") };
            let mut out = null_mut();
            let status = unsafe { wk_context_create(device, &desc, &mut out) };
            kept(status, out);
            unsafe { wk_context_destroy(out) };
            status
        }),
        case("wk_sky_settings", "settings", true, move |p| unsafe { wk_context_set_sky_settings(context, p.cast()) }),
        case("wk_simulation_desc", "wk_simulation_desc", true, move |p| {
            let desc = wk_context_desc { next: p, ..init("wk_context_desc") };
            let mut out = null_mut();
            let status = unsafe { wk_context_create(device, &desc, &mut out) };
            kept(status, out);
            unsafe { wk_context_destroy(out) };
            status
        }),
        case("wk_snow_strip", "strip", false, move |p| unsafe { wk_context_press_snow(context, p.cast()) }),
        case("wk_ground", "out_ground", false, move |p| unsafe { wk_context_get_ground(context, &ORIGIN, p.cast()) }),
        case("wk_air", "out_air", false, move |p| unsafe { wk_context_get_air(context, &ORIGIN, 0.0, p.cast()) }),
        case("wk_conditions", "out_conditions", false, move |p| unsafe {
            wk_context_get_conditions(context, &ORIGIN, 0.0, p.cast())
        }),
        case("wk_wind", "out_wind", false, move |p| unsafe { wk_context_get_wind_at(context, &ORIGIN, 0.0, p.cast()) }),
        case("wk_rainfall", "out_rainfall", false, move |p| unsafe {
            wk_context_get_rainfall_at(context, &ORIGIN, 0.0, p.cast())
        }),
        case("wk_celestial", "out_sun", false, move |p| unsafe { wk_context_get_sun(context, &ORIGIN, p.cast()) }),
        case("wk_frame_light", "out_light", false, move |p| unsafe {
            wk_context_get_frame_light(context, &init("wk_frame"), p.cast())
        }),
        case("wk_ambient", "out_ambient", false, move |p| unsafe {
            wk_context_get_ambient(context, &ORIGIN, p.cast())
        }),
        case("wk_ambient", "out_ambient", false, move |p| unsafe {
            wk_context_get_ambient_at(context, &ORIGIN, 0.0, p.cast())
        }),
        case("wk_environment", "out_environment", false, move |p| unsafe { wk_view_get_environment(view, p.cast()) }),
        case("wk_cloud_shadows", "out_shadows", false, move |p| unsafe { wk_view_get_cloud_shadows(view, p.cast()) }),
        case("wk_frame_textures", "out_textures", false, move |p| unsafe {
            wk_view_get_frame_textures(view, p.cast())
        }),
        case("wk_ground_texture", "out_texture", false, move |p| unsafe {
            wk_context_get_ground_texture(context, p.cast())
        }),
        case("wk_ground_texture", "out_texture", false, move |p| unsafe {
            wk_context_get_terrain_texture(context, &ORIGIN, p.cast())
        }),
        case("wk_budget", "budget", true, move |p| unsafe { wk_view_set_budget(view, p.cast()) }),
        case("wk_part_wish", "budget.wishes[0]", true, move |p| {
            let budget = wk_budget { wish_count: 1, wishes: p.cast(), wish_stride: 2 << 20, ..init("wk_budget") };
            unsafe { wk_view_set_budget(view, &budget) }
        }),
        case("wk_plan", "out_plan", false, move |p| unsafe { wk_view_get_plan(view, p.cast()) }),
        case("wk_part_plan", "out_part", false, move |p| unsafe { wk_view_get_part_plan(view, WK_PART_FOG, p.cast()) }),
        case("wk_report", "out_report", false, move |p| unsafe { wk_view_get_report(view, p.cast()) }),
        case("wk_windscreen", "windscreen", true, move |p| unsafe { wk_view_set_windscreen(view, p.cast()) }),
        case("wk_wiper_arm", "windscreen.arms[0]", true, move |p| {
            let screen = wk_windscreen { arm_count: 1, arms: p.cast(), arm_stride: 2 << 20, ..init("wk_windscreen") };
            unsafe { wk_view_set_windscreen(view, &screen) }
        }),
        case("wk_windscreen_report", "out_report", false, move |p| unsafe {
            wk_view_get_windscreen_report(view, p.cast())
        }),
        case("wk_caps", "out_caps", false, move |p| unsafe { wk_device_get_caps(device, p.cast()) }),
        case("wk_window", "window", false, |p| unsafe {
            wk_device_create_for_window(null(), p.cast(), &mut null_mut())
        }),
        case("wk_opengl_host_desc", "desc", false, |p| unsafe { wk_device_create_opengl(p.cast(), &mut null_mut()) }),
        case("wk_vulkan_host_desc", "desc", false, |p| unsafe { wk_device_create_vulkan(p.cast(), &mut null_mut()) }),
    ]
}

const ORIGIN: [f64; 3] = [0.0; 3];

/// Structs that are plain values of lists, or that need a window or a host. Other tests cover them.
const ELSEWHERE: &[&str] = &[
    "wk_surface_config",
    "wk_cloud_slab",
    "wk_flash",
    "wk_ground_light",
    "wk_ground_cell",
    "wk_terrain_point",
    "wk_soil_point",
    "wk_soil_change",
    "wk_lying_snow",
    "wk_sea_point",
    "wk_segment",
    "wk_between",
    "wk_sky_radiance",
    "wk_rain_on",
    "wk_rain_surface",
    "wk_opengl_image",
    "wk_opengl_target",
    "wk_vulkan_image",
    "wk_vulkan_semaphore",
    "wk_vulkan_target",
    "wk_effect_cost",
];

/// Records a frame with a new number, so that any other number then begins a new frame.
unsafe fn record_again(view: *mut wk_view) {
    let frame = wk_frame { frame_id: next_frame() + 1, ..init("wk_frame") };
    assert_eq!(unsafe { wk_view_record(view, &frame, WK_STAGE_PREPARE) }, WK_OK, "{}", message());
}

/// Checks that a create call writes its out-parameter if and only if it succeeds.
fn kept<T>(status: wk_status, out: *mut T) {
    assert_eq!(status == WK_OK, !out.is_null(), "{}", message());
}

/// Calls with changed bytes and expects an error that begins with the parameter's name.
fn refused(case: &Case, what: &str, bytes: &mut Bytes, names: &str, status: wk_status) {
    let before = bytes.words().to_vec();
    let got = (case.call)(bytes.ptr());
    let text = message();
    assert_eq!(got, status, "{} {what}: {text}", case.structure);
    assert!(text.contains(names), "{} {what}: {names:?} is not in {text:?}", case.structure);
    assert_eq!(before, bytes.words(), "{} {what}: something was written", case.structure);
}

#[test]
fn every_struct_has_a_line() {
    let world = World::new();
    let covered: BTreeSet<&str> = cases(&world).iter().map(|c| c.structure).chain(ELSEWHERE.iter().copied()).collect();
    let all: BTreeSet<&str> = abi::structs().iter().map(|s| s.0).collect();
    assert_eq!(all.difference(&covered).collect::<Vec<_>>(), Vec::<&&str>::new(), "structs without a line");
}

#[test]
fn floats_that_are_no_numbers_are_named() {
    let world = World::new();
    let mut tried = 0;
    for case in cases(&world).iter().filter(|c| !c.parameter.starts_with("out_")) {
        for (_, field, offset, wide, count) in abi::floats().into_iter().filter(|f| f.0 == case.structure) {
            for i in 0..count {
                let name = if count > 1 { format!("{field}[{i}]") } else { field.to_owned() };
                let name = format!("{}.{name} must be finite", case.parameter);
                for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    let mut bytes = Bytes::of(case.structure, 0);
                    if wide {
                        bytes.put(offset + 8 * i, bad);
                    } else {
                        bytes.put(offset + 4 * i, bad as f32);
                    }
                    refused(case, "float", &mut bytes, &name, WK_ERROR_INVALID_ARGUMENT);
                    tried += 1;
                }
            }
        }
    }
    assert!(tried > 100, "{tried}");
}

#[test]
fn unknown_constants_and_reserved_fields_are_named() {
    let world = World::new();
    for case in cases(&world).iter().filter(|c| !c.parameter.starts_with("out_")) {
        for (_, field, offset, wide) in abi::constants().into_iter().filter(|f| f.0 == case.structure) {
            let mut bytes = Bytes::of(case.structure, 0);
            if wide {
                bytes.put(offset, 1_u64 << 63);
            } else {
                bytes.put(offset, 0x8000_0000_u32);
            }
            let name = format!("{}.{field} must be", case.parameter);
            refused(case, field, &mut bytes, &name, WK_ERROR_INVALID_ARGUMENT);
        }
    }
}

#[test]
fn sizes_of_other_versions_are_understood_or_refused() {
    let world = World::new();
    for case in &cases(&world) {
        let plain = (case.call)(Bytes::of(case.structure, 0).ptr());
        let name = format!("{}.struct_size must be sizeof({})", case.parameter, case.structure);
        for wrong in [0_u32, 1, 8, 17, 1 << 20] {
            let mut bytes = Bytes::of(case.structure, 64);
            bytes.put(0, wrong);
            refused(case, "size", &mut bytes, &name, WK_ERROR_INVALID_ARGUMENT);
        }
        // Zero in the fields of a later version changes nothing; a value that is not zero requests something unknown.
        let mut later = Bytes::of(case.structure, 64);
        later.put(0, (later.size + 32) as u32);
        let size = later.size;
        assert_eq!((case.call)(later.ptr()), plain, "{} later: {}", case.structure, message());
        let mut later = Bytes::of(case.structure, 64);
        later.put(0, (size + 32) as u32);
        later.put(size + 24, 1_u8);
        let beyond = format!("{} has a field beyond", case.parameter);
        refused(case, "later", &mut later, &beyond, WK_ERROR_UNSUPPORTED);
        // A struct of an earlier version ends at an earlier field; the missing fields have their defaults.
        let fields = abi::structs().into_iter().find(|s| s.0 == case.structure).expect("known").3;
        for (field, offset, _) in fields.iter().skip(3) {
            let mut earlier = Bytes::of(case.structure, 0);
            earlier.put(0, *offset as u32);
            assert_eq!((case.call)(earlier.ptr()), plain, "{} up to {field}: {}", case.structure, message());
        }
    }
}

#[test]
fn foreign_structs_and_extensions_are_refused() {
    let world = World::new();
    // An extension is recognised by its type alone, which the next test covers.
    for case in cases(&world).iter().filter(|c| !c.parameter.starts_with("wk_")) {
        let mut bytes = Bytes::of(case.structure, 0);
        bytes.put(4, 999_u32);
        let name = format!("{}.struct_type must be WK_STRUCT_TYPE_", case.parameter);
        refused(case, "type", &mut bytes, &name, WK_ERROR_INVALID_ARGUMENT);
        let mut extension = Bytes::of("wk_view_desc", 0);
        let mut bytes = Bytes::of(case.structure, 0);
        bytes.put(8, extension.ptr());
        let name = format!("{}.next holds an extension of type", case.parameter);
        refused(case, "extension", &mut bytes, &name, WK_ERROR_UNSUPPORTED);
        let mut bytes = Bytes::of(case.structure, 8);
        // SAFETY: inside the words.
        let odd = unsafe { bytes.ptr().cast::<u8>().add(1) }.cast();
        assert_eq!((case.call)(odd), WK_ERROR_INVALID_ARGUMENT);
        let name = format!("{} must be aligned to 8 bytes", case.parameter);
        assert!(message().contains(&name), "{}", message());
        if !case.null_is_default {
            assert_eq!((case.call)(null_mut()), WK_ERROR_INVALID_ARGUMENT, "{}", case.structure);
            let name = format!("{} must not be NULL", case.parameter);
            assert!(message().contains(&name), "{}", message());
        }
    }
}

#[test]
fn extension_chains_are_walked_with_care() {
    let world = World::new();
    let set = |next: *const c_void| {
        let weather = wk_weather { next, ..init("wk_weather") };
        // SAFETY: live pointers.
        (unsafe { wk_context_set_weather(world.context, &weather, 0.0, 0.0) }, message())
    };
    let mut a = init::<wk_weather_overrides>("wk_weather_overrides");
    let b = Box::into_raw(Box::new(a));
    assert_eq!(set((&raw const a).cast()).0, WK_OK);
    a.next = b.cast();
    let (status, text) = set((&raw const a).cast());
    assert_eq!(
        (status, text.contains("weather.next holds two extensions of type 19")),
        (WK_ERROR_INVALID_ARGUMENT, true)
    );
    // A cycle of extensions does not lead to an endless loop. SAFETY: `b` is ours.
    unsafe { (*b).next = (&raw const a).cast() };
    assert_eq!(set((&raw const a).cast()).0, WK_ERROR_INVALID_ARGUMENT);
    a.next = null();
    a.struct_type = 999;
    let (status, text) = set((&raw const a).cast());
    assert_eq!((status, text.contains("weather.next holds an extension of type 999")), (WK_ERROR_UNSUPPORTED, true));
    let (status, text) = set(std::ptr::dangling::<u8>().cast());
    assert_eq!((status, text.contains("weather.next must be aligned")), (WK_ERROR_INVALID_ARGUMENT, true));
    // SAFETY: made above.
    drop(unsafe { Box::from_raw(b) });
}

#[test]
fn missing_places_for_answers_are_named() {
    let world = World::new();
    let t = init::<wk_texture_desc>("wk_texture_desc");
    // SAFETY: live pointers and NULL.
    let answers = unsafe {
        [
            ("out_device", wk_device_create(null(), null_mut()), message()),
            ("out_device", wk_device_create_for_window(null(), null(), null_mut()), message()),
            ("out_device", wk_device_create_opengl(null(), null_mut()), message()),
            ("out_device", wk_device_create_vulkan(null(), null_mut()), message()),
            ("out_texture", wk_texture_create(world.device, &t, null_mut()), message()),
            ("out_surface", wk_surface_create(world.device, null(), null_mut()), message()),
            ("out_context", wk_context_create(world.device, null(), null_mut()), message()),
            ("out_view", wk_view_create(world.context, null(), null_mut()), message()),
        ]
    };
    for (name, status, text) in answers {
        assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{name}: {text}");
        assert!(text.contains(&format!(": {name} must not be NULL")), "{name}: {text}");
    }
}

type Snippet = unsafe extern "C" fn(wk_shading_language, *mut *const std::ffi::c_char) -> wk_status;

#[test]
fn snippets_are_texts_and_their_language_is_checked() {
    let mut text = null();
    // SAFETY: live pointers.
    unsafe {
        for (get, name) in [
            (wk_get_veil_snippet as Snippet, "welkin_veil("),
            (wk_get_ground_snippet, "welkin_ground("),
            (wk_get_cloud_shadow_snippet, "welkin_cloud_shadow("),
        ] {
            for (language, word) in [(WK_SHADING_GLSL, "vec3 "), (WK_SHADING_WGSL, "fn ")] {
                assert_eq!(get(language, &mut text), WK_OK);
                let text = std::ffi::CStr::from_ptr(text).to_str().unwrap();
                assert!(text.contains(word) && text.contains(name), "{text}");
            }
            assert_eq!(get(2, &mut text), WK_ERROR_INVALID_ARGUMENT);
            assert!(message().contains("language must be one of WK_SHADING_GLSL, WK_SHADING_WGSL"), "{}", message());
            assert_eq!(get(0, null_mut()), WK_ERROR_INVALID_ARGUMENT);
        }
    }
}

#[test]
fn stages_are_checked() {
    let world = World::new();
    let frame = init::<wk_frame>("wk_frame");
    for bad in [0_u32, 128, u32::MAX] {
        // SAFETY: live pointers.
        let status = unsafe { wk_view_record(world.view, &frame, bad) };
        assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{bad:#x}");
        assert!(message().contains("stages must be"), "{}", message());
    }
}

#[test]
fn depth_access_and_diagnostic_pictures_are_checked() {
    let world = World::new();
    let texture = |format| {
        let desc = wk_texture_desc { width: 8, height: 8, format, ..init("wk_texture_desc") };
        let mut texture = null_mut();
        // SAFETY: live pointers.
        assert_eq!(unsafe { wk_texture_create(world.device, &desc, &mut texture) }, WK_OK, "{}", message());
        texture
    };
    let (color, depth) = (texture(WK_FORMAT_RGBA8_UNORM), texture(WK_FORMAT_R32_FLOAT));
    let record = |depth_access, depth| {
        let target = wk_own_target { color, depth, ..init("wk_own_target") };
        let target = (&raw const target).cast();
        let frame = wk_frame { frame_id: next_frame(), depth_access, target, ..init("wk_frame") };
        // SAFETY: live pointers.
        (unsafe { wk_view_record(world.view, &frame, WK_STAGE_SURFACE) }, message())
    };
    assert_eq!(record(WK_DEPTH_ACCESS_READ, depth).0, WK_OK, "{}", message());
    let frame = |diagnostic| wk_frame { frame_id: next_frame(), diagnostic, ..init("wk_frame") };
    // SAFETY: live pointers.
    let status = |diagnostic| unsafe { wk_view_record(world.view, &frame(diagnostic), WK_STAGE_PREPARE) };
    assert!((WK_DIAGNOSTIC_NONE..=WK_DIAGNOSTIC_WIND).all(|diagnostic| status(diagnostic) == WK_OK));
    assert_eq!(status(WK_DIAGNOSTIC_WIND + 1), WK_ERROR_INVALID_ARGUMENT);
    assert!(
        message().contains("frame.diagnostic must be one of WK_DIAGNOSTIC_NONE, WK_DIAGNOSTIC_DISTANCE"),
        "{}",
        message()
    );
    for (access, depth, status, wanted) in [
        (2, depth, WK_ERROR_INVALID_ARGUMENT, "frame.depth_access must be one of WK_DEPTH_ACCESS_READ, WK_DEPTH_"),
        (1, null_mut(), WK_ERROR_INVALID_ARGUMENT, "frame.depth_access must be read only where the frame has no depth"),
        (
            1,
            depth,
            WK_ERROR_UNSUPPORTED,
            "frame.target.depth.format: R32Float, which cannot be written as depth_access",
        ),
    ] {
        let (got, text) = record(access, depth);
        assert!(got == status && text.contains(wanted), "{wanted}: {got} {text}");
    }
    // SAFETY: live handles.
    unsafe {
        assert_eq!(wk_texture_destroy(color), WK_OK);
        assert_eq!(wk_texture_destroy(depth), WK_OK);
    }
}
