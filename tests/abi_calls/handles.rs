//! NULL, dead, foreign and wrong-kind handles in every handle parameter.

use std::collections::BTreeSet;
use std::ffi::c_void;
use std::ptr::{null, null_mut};

use welkin::capi::{
    abi, air::*, area::*, cloud_map::*, cloud_shadow::*, clouds::*, conditions::*, context::*, device::*,
    environment::*, fog_law::*, frame::*, ground::*, ground_grid::*, ground_texture::*, light::*, lightning::*,
    occluder::*, plan::*, query::*, radiance::*, rain::*, region::*, sea::*, sky::*, snow::*, snowpack::*, soil::*,
    stars::*, status::*, surface::*, terrain::*, texture::*, timeline::*, veil::*, view::*, vulkan::*, wind::*,
    wind_field::*, wind_grid::*, windscreen::*,
};

use super::world::{World, init, message, next_frame};

/// A call with a handle in one parameter and everything else valid or not reached.
struct Case {
    function: &'static str,
    parameter: &'static str,
    /// NULL means "nothing" there and is not an error.
    null_is_fine: bool,
    call: Box<dyn Fn(*mut c_void) -> wk_status>,
}

fn case(
    function: &'static str,
    parameter: &'static str,
    null_is_fine: bool,
    call: impl Fn(*mut c_void) -> wk_status + 'static,
) -> Case {
    Case { function, parameter, null_is_fine, call: Box::new(call) }
}

/// Lists one case for each function. Outputs are NULL where the handle is checked first.
fn cases(view: *mut wk_view) -> Vec<Case> {
    // SAFETY, for all: the handle is what is tested; other pointers are NULL or live.
    vec![
        case("wk_device_destroy", "device", true, |h| unsafe { wk_device_destroy(h.cast()) }),
        case("wk_device_get_status", "device", false, |h| unsafe { wk_device_get_status(h.cast()) }),
        case("wk_device_get_caps", "device", false, |h| unsafe { wk_device_get_caps(h.cast(), null_mut()) }),
        case("wk_device_forget_vulkan_image", "device", false, |h| unsafe {
            wk_device_forget_vulkan_image(h.cast(), 1)
        }),
        case("wk_texture_create", "device", false, |h| unsafe { wk_texture_create(h.cast(), null(), null_mut()) }),
        case("wk_texture_destroy", "texture", true, |h| unsafe { wk_texture_destroy(h.cast()) }),
        case("wk_texture_write", "texture", false, |h| unsafe { wk_texture_write(h.cast(), null(), 0, 0) }),
        case("wk_texture_read", "texture", false, |h| unsafe { wk_texture_read(h.cast(), null_mut(), 0, 0) }),
        case("wk_surface_create", "device", false, |h| unsafe { wk_surface_create(h.cast(), null(), null_mut()) }),
        case("wk_surface_destroy", "surface", true, |h| unsafe { wk_surface_destroy(h.cast()) }),
        case("wk_surface_configure", "surface", false, |h| unsafe { wk_surface_configure(h.cast(), null()) }),
        case("wk_surface_acquire", "surface", false, |h| unsafe { wk_surface_acquire(h.cast()) }),
        case("wk_surface_present", "surface", false, |h| unsafe { wk_surface_present(h.cast()) }),
        case("wk_context_create", "device", false, |h| unsafe { wk_context_create(h.cast(), null(), null_mut()) }),
        case("wk_context_destroy", "context", true, |h| unsafe { wk_context_destroy(h.cast()) }),
        case("wk_context_build_sky", "context", false, |h| unsafe { wk_context_build_sky(h.cast(), None, null_mut()) }),
        case("wk_context_set_sun", "context", false, |h| unsafe { wk_context_set_sun(h.cast(), null()) }),
        case("wk_context_set_moon", "context", false, |h| unsafe { wk_context_set_moon(h.cast(), null()) }),
        case("wk_context_set_weather", "context", false, |h| unsafe {
            wk_context_set_weather(h.cast(), null(), 0.0, 0.0)
        }),
        case("wk_context_set_clock", "context", false, |h| unsafe { wk_context_set_clock(h.cast(), 0.0, 0.0) }),
        case("wk_context_set_exposure", "context", false, |h| unsafe { wk_context_set_exposure(h.cast(), 0, 0.0) }),
        case("wk_context_set_tone_curve", "context", false, |h| unsafe { wk_context_set_tone_curve(h.cast(), 0) }),
        case("wk_context_set_planet", "context", false, |h| unsafe { wk_context_set_planet(h.cast(), null()) }),
        case("wk_context_set_sky_settings", "context", false, |h| unsafe {
            wk_context_set_sky_settings(h.cast(), null())
        }),
        case("wk_context_update", "context", false, |h| unsafe { wk_context_update(h.cast(), 0.0) }),
        case("wk_context_get_state_time", "context", false, |h| unsafe {
            wk_context_get_state_time(h.cast(), null_mut())
        }),
        case("wk_context_save", "context", false, |h| unsafe { wk_context_save(h.cast(), null_mut(), 0, null_mut()) }),
        case("wk_context_load", "context", false, |h| unsafe { wk_context_load(h.cast(), null(), 0) }),
        case("wk_context_state_hash", "context", false, |h| unsafe { wk_context_state_hash(h.cast(), null_mut()) }),
        case("wk_context_set_lights", "context", false, |h| unsafe { wk_context_set_lights(h.cast(), null(), 0, 0) }),
        case("wk_context_get_lying_snow", "context", false, |h| unsafe {
            wk_context_get_lying_snow(h.cast(), null(), 0, 0, null_mut(), 0)
        }),
        case("wk_context_take_snow", "context", false, |h| unsafe {
            wk_context_take_snow(h.cast(), null(), 0.0, null_mut())
        }),
        case("wk_context_press_snow", "context", false, |h| unsafe { wk_context_press_snow(h.cast(), null()) }),
        case("wk_context_accumulate", "context", false, |h| unsafe { wk_context_accumulate(h.cast(), 1.0) }),
        case("wk_context_get_ground", "context", false, |h| unsafe {
            wk_context_get_ground(h.cast(), null(), null_mut())
        }),
        case("wk_context_set_rain_areas", "context", false, |h| unsafe {
            wk_context_set_rain_areas(h.cast(), null(), 0, 0)
        }),
        case("wk_context_set_weather_regions", "context", false, |h| unsafe {
            wk_context_set_weather_regions(h.cast(), null(), 0, 0)
        }),
        case("wk_context_set_shelters", "context", false, |h| unsafe {
            wk_context_set_shelters(h.cast(), null(), 0, 0)
        }),
        case("wk_context_set_wind_field", "context", false, |h| unsafe {
            wk_context_set_wind_field(h.cast(), null(), 0.0)
        }),
        case("wk_context_get_wind_field_report", "context", false, |h| unsafe {
            wk_context_get_wind_field_report(h.cast(), null_mut())
        }),
        case("wk_context_set_wind_grid", "context", false, |h| unsafe { wk_context_set_wind_grid(h.cast(), null()) }),
        case("wk_context_set_cloud_map", "context", false, |h| unsafe { wk_context_set_cloud_map(h.cast(), null()) }),
        case("wk_context_set_cloud_model", "context", false, |h| unsafe { wk_context_set_cloud_model(h.cast(), 0) }),
        case("wk_context_set_default_surface_class", "context", false, |h| unsafe {
            wk_context_set_default_surface_class(h.cast(), 0)
        }),
        case("wk_context_set_ground_grid", "context", false, |h| unsafe {
            wk_context_set_ground_grid(h.cast(), null())
        }),
        case("wk_context_get_ground_cells", "context", false, |h| unsafe {
            wk_context_get_ground_cells(h.cast(), null_mut(), 0, 0, null_mut())
        }),
        case("wk_context_get_ground_texture", "context", false, |h| unsafe {
            wk_context_get_ground_texture(h.cast(), null_mut())
        }),
        case("wk_context_get_terrain_texture", "context", false, |h| unsafe {
            wk_context_get_terrain_texture(h.cast(), null(), null_mut())
        }),
        case("wk_context_set_terrain", "context", false, |h| unsafe { wk_context_set_terrain(h.cast(), null()) }),
        case("wk_context_set_terrain_tile", "context", false, |h| unsafe {
            wk_context_set_terrain_tile(h.cast(), null())
        }),
        case("wk_context_update_terrain", "context", false, |h| unsafe { wk_context_update_terrain(h.cast(), null()) }),
        case("wk_context_remove_terrain_tile", "context", false, |h| unsafe {
            wk_context_remove_terrain_tile(h.cast(), 0, 0)
        }),
        case("wk_context_set_soil", "context", false, |h| unsafe { wk_context_set_soil(h.cast(), null()) }),
        case("wk_context_add_soil_tool", "context", false, |h| unsafe {
            wk_context_add_soil_tool(h.cast(), null(), null(), null_mut())
        }),
        case("wk_context_move_soil_tool", "context", false, |h| unsafe {
            wk_context_move_soil_tool(h.cast(), 1, null())
        }),
        case("wk_context_end_soil_tool", "context", false, |h| unsafe { wk_context_end_soil_tool(h.cast(), 1) }),
        case("wk_context_get_soil_tool", "context", false, |h| unsafe {
            wk_context_get_soil_tool(h.cast(), 1, null_mut())
        }),
        case("wk_context_get_soil_resistance", "context", false, |h| unsafe {
            wk_context_get_soil_resistance(h.cast(), 1, null(), null_mut())
        }),
        case("wk_context_bring_soil", "context", false, |h| unsafe {
            wk_context_bring_soil(h.cast(), null(), 0, 0.0, null_mut())
        }),
        case("wk_context_get_soil_points", "context", false, |h| unsafe {
            wk_context_get_soil_points(h.cast(), null(), 0, 0, null_mut(), 0)
        }),
        case("wk_context_get_soil_changes", "context", false, |h| unsafe {
            wk_context_get_soil_changes(h.cast(), 0, null_mut(), 0, 0, null_mut())
        }),
        case("wk_context_get_soil_cells", "context", false, |h| unsafe {
            wk_context_get_soil_cells(h.cast(), null(), null(), null(), null_mut(), 0, 0)
        }),
        case("wk_context_get_soil_balance", "context", false, |h| unsafe {
            wk_context_get_soil_balance(h.cast(), null_mut())
        }),
        case("wk_context_get_terrain_revision", "context", false, |h| unsafe {
            wk_context_get_terrain_revision(h.cast(), null_mut())
        }),
        case("wk_context_get_terrain_at", "context", false, |h| unsafe {
            wk_context_get_terrain_at(h.cast(), null(), 0, 0, null_mut(), 0)
        }),
        case("wk_context_set_terrain_drawing", "context", false, |h| unsafe {
            wk_context_set_terrain_drawing(h.cast(), null())
        }),
        case("wk_context_get_terrain_water", "context", false, |h| unsafe {
            wk_context_get_terrain_water(h.cast(), 0, 0, null_mut(), 0, 0, null_mut())
        }),
        case("wk_context_set_occluder_maps", "context", false, |h| unsafe {
            wk_context_set_occluder_maps(h.cast(), null(), 0, 0)
        }),
        case("wk_context_set_lightning", "context", false, |h| unsafe { wk_context_set_lightning(h.cast(), null()) }),
        case("wk_context_trigger_flash", "context", false, |h| unsafe { wk_context_trigger_flash(h.cast(), null()) }),
        case("wk_context_get_flashes", "context", false, |h| unsafe {
            wk_context_get_flashes(h.cast(), null(), 0.0, 1.0, 1e3, null_mut(), 0, 0, null_mut())
        }),
        case("wk_context_get_flash_light", "context", false, |h| unsafe {
            wk_context_get_flash_light(h.cast(), null(), 0.0, 0.0, null_mut())
        }),
        case("wk_context_set_sea", "context", false, |h| unsafe { wk_context_set_sea(h.cast(), null()) }),
        case("wk_context_set_sea_hulls", "context", false, |h| unsafe {
            wk_context_set_sea_hulls(h.cast(), null(), 0, 0)
        }),
        case("wk_context_set_sea_regions", "context", false, |h| unsafe {
            wk_context_set_sea_regions(h.cast(), null(), 0, 0)
        }),
        case("wk_context_get_sea_at", "context", false, |h| unsafe {
            wk_context_get_sea_at(h.cast(), null(), 0, 0, 0.0, 0.0, null_mut(), 0)
        }),
        case("wk_context_get_sea_state", "context", false, |h| unsafe {
            wk_context_get_sea_state(h.cast(), 0.0, null_mut())
        }),
        case("wk_context_set_stars", "context", false, |h| unsafe { wk_context_set_stars(h.cast(), null()) }),
        case("wk_context_set_fog_law", "context", false, |h| unsafe { wk_context_set_fog_law(h.cast(), null()) }),
        case("wk_context_get_conditions", "context", false, |h| unsafe {
            wk_context_get_conditions(h.cast(), null(), 0.0, null_mut())
        }),
        case("wk_context_get_air", "context", false, |h| unsafe {
            wk_context_get_air(h.cast(), null(), 0.0, null_mut())
        }),
        case("wk_context_get_wind_at", "context", false, |h| unsafe {
            wk_context_get_wind_at(h.cast(), null(), 0.0, null_mut())
        }),
        case("wk_context_get_rainfall_at", "context", false, |h| unsafe {
            wk_context_get_rainfall_at(h.cast(), null(), 0.0, null_mut())
        }),
        case("wk_context_get_rain_on_at", "context", false, |h| unsafe {
            wk_context_get_rain_on_at(h.cast(), null(), 0, 0, 0.0, null_mut(), 0)
        }),
        case("wk_context_get_cloud_slabs", "context", false, |h| unsafe {
            wk_context_get_cloud_slabs(h.cast(), null(), 0.0, null_mut(), 0, 0, null_mut())
        }),
        case("wk_context_get_sun", "context", false, |h| unsafe { wk_context_get_sun(h.cast(), null(), null_mut()) }),
        case("wk_context_get_moon", "context", false, |h| unsafe { wk_context_get_moon(h.cast(), null(), null_mut()) }),
        case("wk_context_get_sun_share", "context", false, |h| unsafe {
            wk_context_get_sun_share(h.cast(), null(), 0.0, null_mut())
        }),
        case("wk_context_get_sun_at", "context", false, |h| unsafe {
            wk_context_get_sun_at(h.cast(), null(), 0.0, null_mut())
        }),
        case("wk_context_get_moon_at", "context", false, |h| unsafe {
            wk_context_get_moon_at(h.cast(), null(), 0.0, null_mut())
        }),
        case("wk_context_get_light_at", "context", false, |h| unsafe {
            wk_context_get_light_at(h.cast(), null(), 0, 0, 0.0, null_mut(), 0)
        }),
        case("wk_context_get_between_at", "context", false, |h| unsafe {
            wk_context_get_between_at(h.cast(), null(), 0, 0, 0.0, null_mut(), 0)
        }),
        case("wk_context_get_light", "context", false, |h| unsafe {
            wk_context_get_light(h.cast(), null(), 0, 0, null_mut(), 0)
        }),
        case("wk_context_get_between", "context", false, |h| unsafe {
            wk_context_get_between(h.cast(), null(), 0, 0, null_mut(), 0)
        }),
        case("wk_context_get_sky_radiance", "context", false, |h| unsafe {
            wk_context_get_sky_radiance(h.cast(), null(), null(), 0, 0, null_mut(), 0)
        }),
        case("wk_context_get_sky_radiance_at", "context", false, |h| unsafe {
            wk_context_get_sky_radiance_at(h.cast(), null(), null(), 0, 0, 0.0, null_mut(), 0)
        }),
        case("wk_context_get_ambient", "context", false, |h| unsafe {
            wk_context_get_ambient(h.cast(), null(), null_mut())
        }),
        case("wk_context_get_ambient_at", "context", false, |h| unsafe {
            wk_context_get_ambient_at(h.cast(), null(), 0.0, null_mut())
        }),
        case("wk_context_get_visibility_at", "context", false, |h| unsafe {
            wk_context_get_visibility_at(h.cast(), null(), null(), 0.0, null_mut())
        }),
        case("wk_context_get_limiting_magnitude_at", "context", false, |h| unsafe {
            wk_context_get_limiting_magnitude_at(h.cast(), null(), 0.0, null_mut())
        }),
        case("wk_context_get_frame_light", "context", false, |h| unsafe {
            wk_context_get_frame_light(h.cast(), null(), null_mut())
        }),
        case("wk_view_create", "context", false, |h| unsafe { wk_view_create(h.cast(), null(), null_mut()) }),
        case("wk_view_destroy", "view", true, |h| unsafe { wk_view_destroy(h.cast()) }),
        case("wk_view_record", "view", false, |h| unsafe { wk_view_record(h.cast(), null(), 1) }),
        case("wk_view_prepare", "view", false, |h| unsafe {
            wk_view_prepare(h.cast(), null(), null(), 0, null(), 0, 0, 0.0)
        }),
        case("wk_view_get_environment", "view", false, |h| unsafe { wk_view_get_environment(h.cast(), null_mut()) }),
        case("wk_view_get_cloud_shadows", "view", false, |h| unsafe {
            wk_view_get_cloud_shadows(h.cast(), null_mut())
        }),
        case("wk_view_get_frame_textures", "view", false, |h| unsafe {
            wk_view_get_frame_textures(h.cast(), null_mut())
        }),
        case("wk_view_get_costs", "view", false, |h| unsafe {
            wk_view_get_costs(h.cast(), null_mut(), 0, 0, null_mut())
        }),
        case("wk_view_set_rain", "view", false, |h| unsafe { wk_view_set_rain(h.cast(), null()) }),
        case("wk_view_set_snow", "view", false, |h| unsafe { wk_view_set_snow(h.cast(), null()) }),
        case("wk_view_set_clouds", "view", false, |h| unsafe { wk_view_set_clouds(h.cast(), null()) }),
        case("wk_view_set_budget", "view", false, |h| unsafe { wk_view_set_budget(h.cast(), null()) }),
        case("wk_view_report_time", "view", false, |h| unsafe { wk_view_report_time(h.cast(), 1.0) }),
        case("wk_view_save_plan", "view", false, |h| unsafe { wk_view_save_plan(h.cast(), null_mut(), 0, null_mut()) }),
        case("wk_view_load_plan", "view", false, |h| unsafe { wk_view_load_plan(h.cast(), null(), 0) }),
        case("wk_view_get_plan", "view", false, |h| unsafe { wk_view_get_plan(h.cast(), null_mut()) }),
        case("wk_view_get_part_plan", "view", false, |h| unsafe {
            wk_view_get_part_plan(h.cast(), WK_PART_AIR, null_mut())
        }),
        case("wk_view_set_windscreen", "view", false, |h| unsafe { wk_view_set_windscreen(h.cast(), null()) }),
        case("wk_view_get_windscreen_report", "view", false, |h| unsafe {
            wk_view_get_windscreen_report(h.cast(), null_mut())
        }),
        case("wk_view_get_report", "view", false, |h| unsafe { wk_view_get_report(h.cast(), null_mut()) }),
        case("wk_view_record", "frame.target.color", true, move |h| record(view, |t| t.color = h.cast())),
        case("wk_view_record", "frame.target.depth", true, move |h| record(view, |t| t.depth = h.cast())),
        case("wk_view_record", "frame.target.mask", true, move |h| record(view, |t| t.mask = h.cast())),
        case("wk_view_record", "frame.target.surface", true, move |h| record(view, |t| t.surface = h.cast())),
    ]
}

/// Records PREPARE with one handle of the target set.
fn record(view: *mut wk_view, set: impl Fn(&mut wk_own_target)) -> wk_status {
    let mut target = init::<wk_own_target>("wk_own_target");
    set(&mut target);
    let frame = wk_frame { frame_id: next_frame(), target: (&raw const target).cast(), ..init("wk_frame") };
    // SAFETY: live pointers.
    unsafe { wk_view_record(view, &frame, WK_STAGE_PREPARE) }
}

#[test]
fn wrong_handles_are_named_and_never_followed() {
    let world = World::new();
    let dead = {
        let other = World::new();
        [other.device.cast::<c_void>(), other.context.cast(), other.view.cast(), other.texture.cast()]
    };
    let live: [(&str, *mut c_void); 4] = [
        ("wk_device", world.device.cast()),
        ("wk_context", world.context.cast()),
        ("wk_view", world.view.cast()),
        ("wk_texture", world.texture.cast()),
    ];
    let on_stack = [0_u64; 4];
    for case in cases(world.view) {
        let mut bad: Vec<(String, *mut c_void)> = vec![
            ("an address".into(), (&raw const on_stack).cast_mut().cast()),
            ("an odd number".into(), 0x55 as *mut c_void),
            ("all bits".into(), usize::MAX as *mut c_void),
        ];
        bad.extend(dead.iter().map(|&h| ("dead".to_owned(), h)));
        // `device` takes a wk_device, `frame.target.color` a wk_texture.
        let noun = case.parameter.rsplit('.').next().expect("a name");
        let own = match noun {
            "color" | "depth" | "mask" => "wk_texture".to_owned(),
            other => format!("wk_{other}"),
        };
        bad.extend(live.iter().filter(|l| l.0 != own).map(|l| (l.0.to_owned(), l.1)));
        if !case.null_is_fine {
            bad.push(("NULL".into(), null_mut()));
        }
        for (what, handle) in bad {
            let status = (case.call)(handle);
            let text = message();
            let named = format!("{}: {} must be a live {own}", case.function, case.parameter);
            assert_eq!(status, WK_ERROR_BAD_HANDLE, "{} with {what}: {text}", case.function);
            assert!(text.starts_with(&named), "{} with {what}: {text}", case.function);
        }
        if case.null_is_fine {
            assert_eq!((case.call)(null_mut()), WK_OK, "{} with NULL: {}", case.function, message());
        }
    }
}

/// Functions that take no handle.
const WITHOUT: &[&str] = &[
    "wk_status_name",
    "wk_last_error_message",
    "wk_last_error_field",
    "wk_version",
    "wk_weather_from_preset",
    "wk_get_preset",
    "wk_weather_from_metar",
    "wk_weather_from_metar_with",
    "wk_fog_law_cull_distance",
    "wk_visibility_cull_distance",
    "wk_utc_from_calendar",
    "wk_get_veil_snippet",
    "wk_get_ground_snippet",
    "wk_get_cloud_shadow_snippet",
    "wk_set_log_callback",
    "wk_device_create",
    "wk_device_create_for_window",
    "wk_device_create_vulkan",
    "wk_device_create_opengl",
];

#[test]
fn every_function_is_in_the_table() {
    let covered: BTreeSet<&str> = cases(null_mut()).iter().map(|c| c.function).chain(WITHOUT.iter().copied()).collect();
    let all: BTreeSet<&str> = abi::functions().iter().copied().filter(|f| !f.ends_with("_init")).collect();
    assert_eq!(all.difference(&covered).collect::<Vec<_>>(), Vec::<&&str>::new(), "functions without a line");
}

#[test]
fn a_texture_of_another_device_is_refused() {
    let (world, other) = (World::new(), World::new());
    let status = record(world.view, |t| t.color = other.texture);
    assert_eq!(status, WK_ERROR_BAD_HANDLE);
    assert!(message().contains("frame.target.color must belong to the view's own device"), "{}", message());
}
