//! A device that is lost under a host: what every call then answers, and that all of it can be destroyed.

use std::ptr::{null, null_mut};

use welkin::capi::{abi, context::*, device::*, frame::*, status::*, texture::*, timeline::*, veil::*, view::*};

use super::{Scene, init, message};

/// Loses the device as a driver's reset would, and asks of everything that reaches it; a host's of its `shaders` too.
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
        // What needs no GPU may go on, but in no other way.
        let (mut hash, mut bytes) = (0, 0);
        let check = |what: &str, status: wk_status| {
            assert!(matches!(status, WK_OK | WK_ERROR_DEVICE_LOST), "{what}: {status} {}", message());
        };
        check("update", wk_context_update(scene.context, 60.0));
        check("hash", wk_context_state_hash(scene.context, &mut hash));
        check("save", wk_context_save(scene.context, null_mut(), 0, &mut bytes));
    }
}
