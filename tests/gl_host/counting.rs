//! A host that calls Welkin while its rendering is conditional or one of its queries is active, with Welkin in the
//! host's own context and in a second one.

use std::{
    ffi::{CStr, c_char, c_void},
    ptr::null_mut,
};

use glow::HasContext;
use welkin::capi::{device::*, frame::*, opengl::*, status::*, view::*};
use welkin::gpu::gl::GlMode;
use welkin_support::{
    c_scene::{Scene, assert_same, init, message, ok, own_picture},
    egl::{Api, Window, function},
};

use crate::{
    SIZE,
    capi::{device, picture, target},
    frame,
    host::{Host, get_proc},
    images::{framebuffer, image_of, texture},
};

/// Begins conditional rendering by a query that counted nothing: nothing is drawn until its end.
fn begin_nothing(host: &Host) -> glow::Query {
    // SAFETY: the host's context is current.
    unsafe {
        let query = host.gl.create_query().unwrap();
        host.gl.begin_query(glow::SAMPLES_PASSED, query);
        host.gl.end_query(glow::SAMPLES_PASSED);
        function::<unsafe extern "system" fn(u32, u32)>("glBeginConditionalRender")(query.0.get(), 0x8E13);
        assert_eq!(host.gl.get_error(), glow::NO_ERROR);
        query
    }
}

/// Ends conditional rendering, and checks that it was still active.
fn end_nothing(host: &Host, query: glow::Query) {
    // SAFETY: the host's context is current.
    unsafe {
        assert_eq!(host.gl.get_error(), glow::NO_ERROR);
        function::<unsafe extern "system" fn()>("glEndConditionalRender")();
        assert_eq!(host.gl.get_error(), glow::NO_ERROR, "conditional rendering was active still");
        host.gl.delete_query(query);
    }
}

unsafe extern "system" fn refuse_to_begin(_: u32, _: u32) {
    // SAFETY: no arguments; if none was begun this raises GL_INVALID_OPERATION and does nothing else.
    unsafe { function::<unsafe extern "system" fn()>("glEndConditionalRender")() };
}

/// A driver that refuses to begin conditional rendering at any time, so that a trial does not tell whether it is
/// active.
unsafe extern "C" fn without_trials(user: *mut c_void, name: *const c_char) -> *const c_void {
    // SAFETY: Welkin passes NUL-terminated names.
    match unsafe { CStr::from_ptr(name) }.to_bytes() {
        b"glBeginConditionalRender" => refuse_to_begin as *const c_void,
        // SAFETY: as above.
        _ => unsafe { get_proc(user, name) },
    }
}

/// Requests a device on the host's context.
fn create(host: &Host) -> (wk_status, *mut wk_device) {
    let desc = wk_opengl_host_desc {
        get_proc: Some(get_proc),
        user: (&raw const *host.contexts).cast_mut().cast(),
        mode: WK_OPENGL_HOST_CONTEXT,
        ..init("wk_opengl_host_desc")
    };
    let mut device = null_mut();
    // SAFETY: the callbacks are those of the host, whose contexts outlive the device.
    (unsafe { wk_device_create_opengl(&desc, &mut device) }, device)
}

#[test]
fn a_frame_inside_a_conditional_render_is_refused_and_the_next_one_is_right() {
    let wanted = own_picture(SIZE, 0.001, 1);
    for api in [Api::Core(3, 3), Api::Compatibility(4, 5)] {
        let host = Host::new(api, Window::None, GlMode::HostContext);
        let color = image_of(texture(&host.gl, glow::RGBA8));
        let depth = image_of(texture(&host.gl, glow::DEPTH_COMPONENT32F));
        let fbo = framebuffer(&host.gl, color, Some(depth));
        let target = target(color, depth);
        let query = begin_nothing(&host);
        let (status, _) = create(&host);
        assert_eq!(status, WK_ERROR_WRONG_ORDER, "{}", message());
        assert!(message().contains("glEndConditionalRender"), "{}", message());
        end_nothing(&host, query);
        let device = device(&host);
        let scene = Scene::new(device);
        // The first frame, which would build the tables.
        let query = begin_nothing(&host);
        let frame = wk_frame { target: (&raw const target).cast(), ..frame(0) };
        // SAFETY: live handles.
        let status = unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) };
        assert_eq!(status, WK_ERROR_WRONG_ORDER, "{}", message());
        assert!(message().contains("glEndConditionalRender"), "{}", message());
        end_nothing(&host, query);
        let _ = picture(&host, &scene, fbo, &target, 1);
        let got = picture(&host, &scene, fbo, &target, 2);
        assert_same(&got, &wanted, 3);
        scene.destroy();
        // SAFETY: a live handle.
        ok(unsafe { wk_device_destroy(device) });
    }
}

/// The first texel of the table shows that it was not drawn.
#[test]
fn tables_that_were_never_drawn_are_detected_without_a_trial() {
    let wanted = own_picture(SIZE, 0.001, 1);
    let host = Host::new(Api::Core(4, 5), Window::None, GlMode::HostContext);
    let color = image_of(texture(&host.gl, glow::RGBA8));
    let depth = image_of(texture(&host.gl, glow::DEPTH_COMPONENT32F));
    let fbo = framebuffer(&host.gl, color, Some(depth));
    let target = target(color, depth);
    let desc = wk_opengl_host_desc {
        get_proc: Some(without_trials),
        user: (&raw const *host.contexts).cast_mut().cast(),
        mode: WK_OPENGL_HOST_CONTEXT,
        ..init("wk_opengl_host_desc")
    };
    let mut device = null_mut();
    // SAFETY: the callbacks are those of the host, whose contexts outlive the device.
    ok(unsafe { wk_device_create_opengl(&desc, &mut device) });
    let scene = Scene::new(device);
    let query = begin_nothing(&host);
    for id in 0..2 {
        let frame = wk_frame { target: (&raw const target).cast(), ..frame(id) };
        // SAFETY: live handles.
        let status = unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) };
        assert_eq!(status, WK_ERROR_WRONG_ORDER, "{}", message());
        assert!(message().contains("first table") && message().contains("glEndConditionalRender"), "{}", message());
    }
    end_nothing(&host, query);
    let _ = picture(&host, &scene, fbo, &target, 2);
    let got = picture(&host, &scene, fbo, &target, 3);
    assert_same(&got, &wanted, 3);
    scene.destroy();
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
}

#[test]
fn a_query_counts_none_of_welkins_samples() {
    for (api, mode, target_name) in [
        (Api::Core(4, 5), GlMode::HostContext, glow::SAMPLES_PASSED),
        (Api::Core(3, 3), GlMode::HostContext, glow::ANY_SAMPLES_PASSED),
        (Api::Compatibility(4, 5), GlMode::HostContext, glow::PRIMITIVES_GENERATED),
        (Api::Es(3, 0), GlMode::HostContext, glow::ANY_SAMPLES_PASSED_CONSERVATIVE),
        (Api::Core(4, 5), GlMode::Shared, glow::SAMPLES_PASSED),
    ] {
        let host = Host::new(api, Window::None, mode);
        let color = image_of(texture(&host.gl, glow::RGBA8));
        let depth = image_of(texture(&host.gl, glow::DEPTH_COMPONENT32F));
        let target = target(color, depth);
        let device = device(&host);
        let scene = Scene::new(device);
        let frame = |id| wk_frame { target: (&raw const target).cast(), ..frame(id) };
        // SAFETY: live handles; the host's context is current.
        unsafe {
            let query = host.gl.create_query().unwrap();
            host.gl.begin_query(target_name, query);
            let status = wk_view_record(scene.view, &frame(0), WK_STAGE_ALL);
            if mode == GlMode::Shared {
                assert_eq!(status, WK_OK, "{}", message());
            } else {
                assert_eq!(status, WK_ERROR_WRONG_ORDER, "{}", message());
                assert!(message().contains("glEndQuery") && message().contains("GL_"), "{}", message());
            }
            host.gl.end_query(target_name);
            assert_eq!(host.gl.get_query_parameter_u32(query, glow::QUERY_RESULT), 0, "{api:?} {mode:?}");
            host.gl.delete_query(query);
            ok(wk_view_record(scene.view, &frame(1), WK_STAGE_ALL));
            assert_eq!(host.gl.get_error(), glow::NO_ERROR);
            scene.destroy();
            ok(wk_device_destroy(device));
        }
    }
}
