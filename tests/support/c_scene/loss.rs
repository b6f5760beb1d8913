//! Loss of a device in use: how every call then responds, and that all objects can still be destroyed.

use std::ptr::{null, null_mut};

use welkin::capi::{
    abi, conditions::*, context::*, device::*, frame::*, occluder::*, query::*, rain::*, status::*, texture::*,
    timeline::*, veil::*, view::*, weather::*,
};

use super::{Scene, init, message, ok};

/// Loses the device as a driver reset would, and checks every call that uses it; if `shaders`, also the veil for the
/// host's shaders.
pub fn lose_and_ask(device: *mut wk_device, scene: &Scene, frame: &wk_frame, shaders: bool) {
    abi::lose_in_next_call();
    // SAFETY: live handles, locals with the sizes given.
    unsafe {
        assert_eq!(wk_device_get_status(device), WK_ERROR_DEVICE_LOST, "{}", message());
        let (mut context, mut view, mut texture) = (null_mut(), null_mut(), null_mut());
        let mut veil = init::<wk_frame_textures>("wk_frame_textures");
        let size = init::<wk_texture_desc>("wk_texture_desc");
        let check = |what: &str, status: wk_status| {
            assert_eq!(status, WK_ERROR_DEVICE_LOST, "{what}: {}", message());
            assert!(message().contains("the device is lost"), "{what}: {}", message());
        };
        check("status", wk_device_get_status(device));
        check("record", wk_view_record(scene.view, frame, WK_STAGE_ALL));
        check("prepare", wk_view_record(scene.view, frame, WK_STAGE_PREPARE));
        check("context", wk_context_create(device, null(), &mut context));
        check("view", wk_view_create(scene.context, null(), &mut view));
        check("sky", wk_context_build_sky(scene.context, None, null_mut()));
        check("texture", wk_texture_create(device, &size, &mut texture));
        if shaders {
            check("veil", wk_view_get_frame_textures(scene.view, &mut veil));
        }
        assert!(context.is_null() && view.is_null() && texture.is_null() && veil.light == 0);
        let (mut ambient, here) = (init::<wk_ambient>("wk_ambient"), [0.0, 0.0, 2.0]);
        check("maps", wk_context_set_occluder_maps(scene.context, null(), 0, 0));
        check("ambient", wk_context_get_ambient(scene.context, &here, &mut ambient));
    }
    save_and_go_on(scene);
}

/// Checks the header's promise for a lost device: weather, time, queries and state continue to work, and a context on
/// another device can load the state.
fn save_and_go_on(scene: &Scene) {
    let (mut before, mut after, mut size) = (0, 0, 0);
    let mut conditions = init::<wk_conditions>("wk_conditions");
    // SAFETY: numbers alone.
    let mut light = unsafe { std::mem::zeroed::<wk_ground_light>() };
    let (here, weather) = ([0.0, 0.0, 2.0], wk_weather { visibility_m: 1234.0, ..init("wk_weather") });
    // SAFETY: live handles, locals with the sizes given.
    unsafe {
        ok(wk_context_update(scene.context, 60.0));
        ok(wk_context_set_weather(scene.context, &weather, 60.0, 0.0));
        ok(wk_context_update(scene.context, 120.0));
        ok(wk_context_get_conditions(scene.context, &here, 120.0, &mut conditions));
        assert!((conditions.visibility_m - 1234.0).abs() < 1.0, "{}", conditions.visibility_m);
        let row = size_of::<[f64; 3]>() as u32;
        ok(wk_context_get_light(scene.context, &here, 1, row, &mut light, size_of::<wk_ground_light>() as u32));
        ok(wk_context_set_shelters(scene.context, null(), 0, 0));
        ok(wk_view_set_rain(scene.view, null()));
        ok(wk_context_state_hash(scene.context, &mut before));
        ok(wk_context_save(scene.context, null_mut(), 0, &mut size));
        let mut state = vec![0_u8; size];
        ok(wk_context_save(scene.context, state.as_mut_ptr().cast(), size, &mut size));
        ok(wk_context_load(scene.context, state.as_ptr().cast(), size));
        let desc = wk_device_desc { backends: WK_BACKEND_NOOP, ..init("wk_device_desc") };
        let mut device = null_mut();
        ok(wk_device_create(&desc, &mut device));
        let next = Scene::new(device);
        ok(wk_context_load(next.context, state.as_ptr().cast(), size));
        ok(wk_context_state_hash(next.context, &mut after));
        assert_eq!(before, after);
        next.destroy();
        ok(wk_device_destroy(device));
    }
}
