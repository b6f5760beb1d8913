//! Strict drivers of OpenGL ES below 3.2: they have functions of later versions only under the names of their
//! extensions.

use std::{
    cell::{Cell, RefCell},
    ffi::{CStr, c_char, c_void},
    ptr::null_mut,
};

use welkin::capi::{device::*, opengl::*, status::*};
use welkin::gpu::gl::GlMode;
use welkin_support::{
    c_scene::{Scene, assert_same, init, message, ok, own_picture},
    egl::{Api, Window, function, proc_address},
};

use crate::{
    SIZE,
    capi::{picture, target},
    host::{Host, make_current},
    images::{framebuffer, image_of, texture},
};

/// Functions that came with OpenGL ES 3.2, and those that came with 3.1 (Khronos' registry, gl.xml), that wgpu and
/// Welkin may request.
const SINCE_3_2: &[&str] = &[
    "glBlendBarrier",
    "glBlendEquationSeparatei",
    "glBlendEquationi",
    "glBlendFuncSeparatei",
    "glBlendFunci",
    "glColorMaski",
    "glCopyImageSubData",
    "glDebugMessageCallback",
    "glDebugMessageControl",
    "glDebugMessageInsert",
    "glDisablei",
    "glDrawElementsBaseVertex",
    "glDrawElementsInstancedBaseVertex",
    "glDrawRangeElementsBaseVertex",
    "glEnablei",
    "glFramebufferTexture",
    "glGetDebugMessageLog",
    "glGetGraphicsResetStatus",
    "glGetObjectLabel",
    "glGetObjectPtrLabel",
    "glIsEnabledi",
    "glMinSampleShading",
    "glObjectLabel",
    "glObjectPtrLabel",
    "glPatchParameteri",
    "glPopDebugGroup",
    "glPushDebugGroup",
    "glReadnPixels",
    "glTexBuffer",
    "glTexBufferRange",
    "glTexStorage3DMultisample",
];
const SINCE_3_1: &[&str] = &[
    "glBindImageTexture",
    "glBindVertexBuffer",
    "glDispatchCompute",
    "glDispatchComputeIndirect",
    "glDrawArraysIndirect",
    "glDrawElementsIndirect",
    "glGetBooleani_v",
    "glGetProgramInterfaceiv",
    "glGetProgramResourceIndex",
    "glGetProgramResourceiv",
    "glGetTexLevelParameteriv",
    "glMemoryBarrier",
    "glProgramUniform1i",
    "glSampleMaski",
    "glTexStorage2DMultisample",
    "glVertexAttribBinding",
    "glVertexAttribFormat",
    "glVertexAttribIFormat",
    "glVertexBindingDivisor",
];

thread_local! {
    static MINOR: Cell<u32> = const { Cell::new(1) };
    /// Whether a function that the version lacks is NULL; if not, it raises an error, as ANGLE's do.
    static IS_NULL: Cell<bool> = const { Cell::new(false) };
    static WRONG: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
}

/// Stands for any function that this version lacks.
unsafe extern "system" fn not_here() {
    WRONG.with_borrow_mut(|wrong| wrong.push("a function of a later version was called".to_owned()));
    // SAFETY: an enumerant that nobody knows raises an error and does nothing else.
    unsafe { function::<unsafe extern "system" fn(u32)>("glEnable")(0xFFFF) };
}

unsafe extern "system" fn get_string(name: u32) -> *const u8 {
    match (name, MINOR.get()) {
        (0x1F02, 0) => c"OpenGL ES 3.0 strict".as_ptr().cast(),
        (0x1F02, _) => c"OpenGL ES 3.1 strict".as_ptr().cast(),
        (0x8B8C, 0) => c"OpenGL ES GLSL ES 3.00".as_ptr().cast(),
        (0x8B8C, _) => c"OpenGL ES GLSL ES 3.10".as_ptr().cast(),
        // SAFETY: as the caller vouches.
        _ => unsafe { function::<unsafe extern "system" fn(u32) -> *const u8>("glGetString")(name) },
    }
}

unsafe extern "C" fn strict_proc(_: *mut c_void, name: *const c_char) -> *const c_void {
    // SAFETY: Welkin passes NUL-terminated names.
    let name = unsafe { CStr::from_ptr(name) };
    let text = name.to_str().unwrap();
    let is_later = SINCE_3_2.contains(&text) || MINOR.get() == 0 && SINCE_3_1.contains(&text);
    match text {
        "glGetString" => get_string as *const c_void,
        _ if is_later && IS_NULL.get() => std::ptr::null(),
        _ if is_later => not_here as *const c_void,
        _ => proc_address(name),
    }
}

#[test]
fn strict_contexts_before_es_3_2_draw_the_same_picture() {
    let wanted = own_picture(SIZE, 0.001, 1);
    for (minor, is_null, mode) in [
        (1, false, GlMode::Shared),
        (1, true, GlMode::HostContext),
        (0, false, GlMode::HostContext),
        (0, true, GlMode::Shared),
    ] {
        MINOR.set(minor);
        IS_NULL.set(is_null);
        WRONG.take();
        let host = Host::new(Api::Es(3, minor as i32), Window::None, mode);
        let color = image_of(texture(&host.gl, glow::RGBA8));
        let depth = image_of(texture(&host.gl, glow::DEPTH_COMPONENT32F));
        let fbo = framebuffer(&host.gl, color, Some(depth));
        let shared = mode == GlMode::Shared;
        let desc = wk_opengl_host_desc {
            get_proc: Some(strict_proc),
            make_current: shared.then_some(make_current as _),
            user: (&raw const *host.contexts).cast_mut().cast(),
            mode: if shared { WK_OPENGL_SHARED } else { WK_OPENGL_HOST_CONTEXT },
            ..init("wk_opengl_host_desc")
        };
        let mut device = null_mut();
        // SAFETY: the callbacks are those of the host, whose contexts outlive the device.
        let status = unsafe { wk_device_create_opengl(&desc, &mut device) };
        assert_eq!(status, WK_OK, "ES 3.{minor}, NULL {is_null}: {}", message());
        let mut caps: wk_caps = init("wk_caps");
        // SAFETY: a live handle.
        ok(unsafe { wk_device_get_caps(device, &mut caps) });
        assert_eq!(caps.tier, minor, "compute came with ES 3.1");
        let scene = Scene::new(device);
        let _ = picture(&host, &scene, fbo, &target(color, depth), 0);
        let got = picture(&host, &scene, fbo, &target(color, depth), 1);
        assert_same(&got, &wanted, 3);
        scene.destroy();
        // SAFETY: a live handle.
        ok(unsafe { wk_device_destroy(device) });
        assert_eq!(WRONG.take(), [""; 0], "ES 3.{minor}, NULL {is_null}");
    }
}
