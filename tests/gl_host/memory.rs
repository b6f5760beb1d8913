//! Memory that runs out: an allocation that the driver refuses gives an error that says so, nothing is lost, and frames
//! that fit are drawn as before. The limit applies to the whole process, so each case runs in a process of its own.

use std::ptr::null_mut;

use welkin::capi::{device::*, frame::*, status::*, texture::*, view::*};

use welkin::gpu::gl::GlMode;
use welkin_support::{
    c_scene::{
        init,
        limited::{MIB, in_a_process, is_limited, leave},
        message, ok,
        own::{Own, Size, different, still_frame, wet_scene},
    },
    egl::{Api, Window},
};

use crate::SIZE;
use crate::{
    canvas::{Canvas, wet_picture},
    capi::device,
    host::Host,
};

/// Creates textures until one is refused. Returns them.
fn fill(device: *mut wk_device, desc: &wk_texture_desc) -> Vec<*mut wk_texture> {
    let mut made = Vec::new();
    for _ in 0..4096 {
        let mut texture = null_mut();
        // SAFETY: live pointers.
        let status = unsafe { wk_texture_create(device, desc, &mut texture) };
        if status != WK_OK {
            assert_eq!(status, WK_ERROR_OUT_OF_MEMORY, "after {}: {}", made.len(), message());
            assert!(texture.is_null());
            return made;
        }
        made.push(texture);
    }
    panic!("the driver gives {} of {} x {}", made.len(), desc.width, desc.height);
}

fn runs_out(backends: wk_backend_flags) {
    let mut own = Own::new(backends);
    if !is_limited(own.device) {
        return own.destroy();
    }
    let scene = wet_scene(own.device);
    let before = own.wet_picture(scene.view, 1, SIZE, WK_STAGE_ALL, |_, _| ());
    leave(Some(512 * MIB));
    let desc = init::<wk_texture_desc>("wk_texture_desc");
    let huge = wk_texture_desc { width: 16384, height: 16384, format: WK_FORMAT_RGBA16_FLOAT, ..desc };
    assert_eq!(fill(own.device, &huge).len(), 0);
    let many = fill(own.device, &wk_texture_desc { width: 2048, height: 2048, ..desc });
    assert!(!many.is_empty() && many.len() < 40, "{}", many.len());
    // SAFETY: live handles with the sizes given.
    unsafe {
        many.iter().for_each(|t| ok(wk_texture_destroy(*t)));
        ok(wk_device_get_status(own.device));
    }
    // Reading needs memory of the GPU and of the process; either may run out first.
    let large = wk_texture_desc { width: 8192, height: 7168, ..desc };
    let mut texture = null_mut();
    // SAFETY: live handles with the sizes given.
    unsafe {
        leave(None);
        ok(wk_texture_create(own.device, &large, &mut texture));
        let mut room = vec![7_u8; 4 * 8192 * 7168];
        for mib in [100, 300] {
            leave(Some(mib * MIB));
            let status = wk_texture_read(texture, room.as_mut_ptr().cast(), room.len(), 4 * 8192);
            assert_eq!(status, WK_ERROR_OUT_OF_MEMORY, "{mib} MiB: {}", message());
            assert!(room.iter().all(|b| *b == 7), "after a failure no output was written");
        }
        leave(None);
        ok(wk_texture_read(texture, room.as_mut_ptr().cast(), room.len(), 4 * 8192));
        assert!(room.iter().all(|b| *b == 0));
        ok(wk_texture_destroy(texture));
        leave(Some(512 * MIB));
    }
    let after = own.wet_picture(scene.view, 2, SIZE, WK_STAGE_ALL, |_, _| ());
    leave(None);
    let again = own.wet_picture(scene.view, 3, SIZE, WK_STAGE_ALL, |_, _| ());
    for picture in [after, again] {
        assert_eq!(different(&picture, &before, 6), 0);
    }
    scene.destroy();
    own.destroy();
}

#[test]
fn textures_that_do_not_fit_are_refused_on_an_own_vulkan_device() {
    if in_a_process("memory::textures_that_do_not_fit_are_refused_on_an_own_vulkan_device") {
        runs_out(WK_BACKEND_VULKAN);
    }
}

#[test]
fn textures_that_do_not_fit_are_refused_on_an_own_opengl_device() {
    if in_a_process("memory::textures_that_do_not_fit_are_refused_on_an_own_opengl_device") {
        runs_out(WK_BACKEND_GL);
    }
}

/// Records a frame whose target leaves no memory for Welkin's own textures.
fn frame_runs_out(backends: wk_backend_flags) {
    let mut own = Own::new(backends);
    if !is_limited(own.device) {
        return own.destroy();
    }
    let scene = wet_scene(own.device);
    let wanted = own.wet_picture(scene.view, 9, SIZE, WK_STAGE_ALL, |_, _| ());
    let second = wet_scene(own.device);
    let size = (8192, 8192);
    let desc = wk_texture_desc { width: size.0, height: size.1, ..init("wk_texture_desc") };
    let mut large = null_mut();
    // SAFETY: live pointers.
    ok(unsafe { wk_texture_create(own.device, &desc, &mut large) });
    let target = wk_own_target { color: large, ..init("wk_own_target") };
    let frame = wk_frame { target: (&raw const target).cast(), ..still_frame(1, size) };
    leave(Some(200 * MIB));
    for view in [scene.view, second.view] {
        // SAFETY: live handles.
        let status = unsafe { wk_view_record(view, &frame, WK_STAGE_ALL) };
        assert_eq!(status, WK_ERROR_OUT_OF_MEMORY, "{}", message());
        // The frame can be recorded again, now or when there is memory. SAFETY: live handles.
        let status = unsafe { wk_view_record(view, &frame, WK_STAGE_ALL) };
        assert_eq!(status, WK_ERROR_OUT_OF_MEMORY, "{}", message());
    }
    leave(None);
    // SAFETY: live handles.
    unsafe {
        ok(wk_device_get_status(own.device));
        ok(wk_texture_destroy(large));
    }
    // Neither view lost anything: the first had drawn before, the second had nothing yet.
    for (scene, id) in [(&scene, 10), (&second, 9)] {
        let got = own.wet_picture(scene.view, id, SIZE, WK_STAGE_ALL, |_, _| ());
        assert_eq!(different(&got, &wanted, 6), 0, "frame {id}: {:?} {:?}", got[0], wanted[0]);
    }
    scene.destroy();
    second.destroy();
    own.destroy();
}

#[test]
fn a_frame_that_does_not_fit_is_refused_on_an_own_vulkan_device() {
    if in_a_process("memory::a_frame_that_does_not_fit_is_refused_on_an_own_vulkan_device") {
        frame_runs_out(WK_BACKEND_VULKAN);
    }
}

#[test]
fn a_frame_that_does_not_fit_is_refused_on_an_own_opengl_device() {
    if in_a_process("memory::a_frame_that_does_not_fit_is_refused_on_an_own_opengl_device") {
        frame_runs_out(WK_BACKEND_GL);
    }
}

#[test]
fn a_frame_that_does_not_fit_is_refused_in_an_opengl_host() {
    if !in_a_process("memory::a_frame_that_does_not_fit_is_refused_in_an_opengl_host") {
        return;
    }
    for (api, mode) in [(Api::Core(3, 3), GlMode::Shared), (Api::Compatibility(4, 5), GlMode::HostContext)] {
        let host = Host::new(api, Window::None, mode);
        let device = device(&host);
        if !is_limited(device) {
            // SAFETY: a live handle.
            ok(unsafe { wk_device_destroy(device) });
            continue;
        }
        let scene = wet_scene(device);
        let wanted = wet_picture(&host, &scene, 1, SIZE, WK_STAGE_ALL, |_| ());
        let large: Size = (4096, 4096);
        let canvas = Canvas::new(&host.gl, large);
        let target = canvas.target();
        let frame = wk_frame { target: (&raw const target).cast(), ..still_frame(2, large) };
        leave(Some(48 * MIB));
        for _ in 0..2 {
            // SAFETY: live handles; the host's context is current.
            let status = unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) };
            assert_eq!(status, WK_ERROR_OUT_OF_MEMORY, "{mode:?}: {}", message());
        }
        leave(None);
        canvas.delete(&host.gl);
        let got = wet_picture(&host, &scene, 3, SIZE, WK_STAGE_ALL, |_| ());
        assert_eq!(different(&got, &wanted, 6), 0, "{mode:?}");
        scene.destroy();
        // SAFETY: a live handle.
        ok(unsafe { wk_device_destroy(device) });
    }
}
