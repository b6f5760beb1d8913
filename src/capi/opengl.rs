//! OpenGL hosts
//!
//! Welkin draws into the host's own textures, renderbuffers or framebuffers, in one of two ways.
//!
//! SHARED (the default): the host makes a second context that shares objects with its own, and a callback that makes one
//! or the other current. Welkin draws in the second one, so none of the host's state can change. Fences order the two.
//! Framebuffers are not shared, so targets are textures and renderbuffers; bind a texture again before sampling what was
//! drawn into it, as OpenGL asks between contexts.
//!
//! HOST_CONTEXT: Welkin draws in the host's own context; every piece of state it touches is saved, set, and put back.
//! Any framebuffer can be a target, the window's (0) too, by copies in and out.
//!
//! One device serves all windows whose contexts share objects in SHARED mode, with a view each; in HOST_CONTEXT mode a device
//! belongs to one context.
//!
//! When a call begins the host's context is current on the calling thread, and so it is when it returns. Needed: OpenGL
//! 3.3 or OpenGL ES 3.0, core or compatibility; compute shaders are used from 4.3 (ES 3.1) on.

use std::{
    ffi::{c_char, c_void},
    ptr::{null, null_mut},
};

use super::{
    boundary::guard,
    device::{wk_device, wk_device_flags},
    host,
    input::out,
    layout::{self, init_struct, struct_size},
    status::*,
};
use crate::error::Status;

include!(concat!(env!("OUT_DIR"), "/init_opengl.rs"));

/// Answers the address of an OpenGL function, or NULL: what glfwGetProcAddress, SDL_GL_GetProcAddress, eglGetProcAddress
/// or glXGetProcAddress answer. Called with the host's or Welkin's context current.
pub type wk_opengl_get_proc_fn = Option<unsafe extern "C" fn(user: *mut c_void, name: *const c_char) -> *const c_void>;

/// Makes a context current on the calling thread: `which` is WK_OPENGL_CONTEXT_HOST or WK_OPENGL_CONTEXT_WELKIN. Answers
/// 0 when it is, anything else when it cannot be.
pub type wk_opengl_make_current_fn = Option<unsafe extern "C" fn(user: *mut c_void, which: u32) -> i32>;

/// Which context is asked for.
pub type wk_opengl_context = u32;
/// The one the host draws in: with several windows, the one that was current when the call came (keep it for each thread).
pub const WK_OPENGL_CONTEXT_HOST: wk_opengl_context = 0;
/// The one the host made for Welkin, sharing objects with its own.
pub const WK_OPENGL_CONTEXT_WELKIN: wk_opengl_context = 1;

/// How Welkin lives beside the host's OpenGL.
pub type wk_opengl_mode = u32;
/// In a context of its own that shares objects with the host's.
pub const WK_OPENGL_SHARED: wk_opengl_mode = 0;
/// In the host's context, whose state is put back.
pub const WK_OPENGL_HOST_CONTEXT: wk_opengl_mode = 1;

/// How one context's commands are ordered after the other's in shared mode.
pub type wk_opengl_handover = u32;
/// By fences, as the standard asks.
pub const WK_OPENGL_FENCE: wk_opengl_handover = 0;
/// By a flush alone: enough where one queue serves both contexts, and cheaper there. Measure before you rely on it.
pub const WK_OPENGL_FLUSH: wk_opengl_handover = 1;

/// The host's OpenGL.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_opengl_host_desc {
    /// sizeof(wk_opengl_host_desc) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_OPENGL_HOST_DESC.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Finds functions. Default NULL; must be given.
    pub get_proc: wk_opengl_get_proc_fn,
    /// Makes contexts current. Must be given in shared mode; in the host's context it may be NULL (the default), then
    /// the host's context is taken as it is.
    pub make_current: wk_opengl_make_current_fn,
    /// Handed to both. They are called on whatever thread calls Welkin, one at a time. Default NULL.
    pub user: *mut c_void,
    /// Default WK_OPENGL_SHARED.
    pub mode: wk_opengl_mode,
    /// Default WK_OPENGL_FENCE.
    pub handover: wk_opengl_handover,
    /// WK_DEVICE_FORCE_TIER0 or 0, the default; WK_DEVICE_FORCE_SOFTWARE has no meaning here.
    pub flags: wk_device_flags,
    /// Must be 0.
    pub reserved0: u32,
}

impl wk_opengl_host_desc {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_OPENGL_HOST_DESC,
        next: null(),
        get_proc: None,
        make_current: None,
        user: null_mut(),
        mode: WK_OPENGL_SHARED,
        handover: WK_OPENGL_FENCE,
        flags: 0,
        reserved0: 0,
    };
}

/// What an OpenGL name is a name of.
pub type wk_opengl_image_kind = u32;
/// No image.
pub const WK_OPENGL_NONE: wk_opengl_image_kind = 0;
/// A texture; its level 0 is used.
pub const WK_OPENGL_TEXTURE: wk_opengl_image_kind = 1;
/// A renderbuffer.
pub const WK_OPENGL_RENDERBUFFER: wk_opengl_image_kind = 2;
/// What a framebuffer draws to, 0 being the window's; only in the host's own context.
pub const WK_OPENGL_FRAMEBUFFER: wk_opengl_image_kind = 3;

/// A host's image, embedded in wk_opengl_target.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_opengl_image {
    /// Default WK_OPENGL_NONE.
    pub kind: wk_opengl_image_kind,
    /// Its OpenGL name. Default 0.
    pub name: u32,
    /// Of a texture: GL_TEXTURE_2D (0x0DE1, the default) or GL_TEXTURE_2D_MULTISAMPLE (0x9100).
    pub target: u32,
    /// Must be 0.
    pub reserved0: u32,
}

impl wk_opengl_image {
    pub(crate) const INIT: Self = Self { kind: WK_OPENGL_NONE, name: 0, target: 0x0DE1, reserved0: 0 };
}

/// What is done about multisampled images.
pub type wk_opengl_multisample = u32;
/// Depth is read and weather drawn per sample. From OpenGL 4.0 on; not on OpenGL ES nor on a forced tier 0.
pub const WK_OPENGL_MULTISAMPLE_EACH: wk_opengl_multisample = 0;
/// Colour comes in averaged and goes back to every sample alike; depth is that of one sample. Not on OpenGL ES.
pub const WK_OPENGL_MULTISAMPLE_RESOLVE: wk_opengl_multisample = 1;

/// The images of a frame of an OpenGL host.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_opengl_target {
    /// sizeof(wk_opengl_target) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_OPENGL_TARGET.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// What is drawn into. Default none.
    pub color: wk_opengl_image,
    /// The host's depth; none (the default) shows the sky in every pixel. Where `color` is a framebuffer, the same one; else another
    /// image. It has as many samples as `color`. Where that has one (a resolved picture) depth may have more, not on OpenGL ES: one
    /// sample of each pixel counts.
    pub depth: wk_opengl_image,
    /// A texture of one sample: where its red is 1, the host's pixel stays; where 0, weather is drawn. Default none.
    pub mask: wk_opengl_image,
    /// Pixels; must be the images' own, and a window's size now. Default 0; must be given.
    pub width: u32,
    /// Pixels; must be the images' own, and a window's size now. Default 0; must be given.
    pub height: u32,
    /// A number that the host raises when it makes an object anew under an old name; it never falls. Default 0.
    pub generation: u64,
    /// Default WK_OPENGL_MULTISAMPLE_EACH.
    pub multisample: wk_opengl_multisample,
    /// Must be 0.
    pub reserved0: u32,
    /// A texture of one sample that says what each pixel shows is made of: the byte of red is a wk_surface_class, 0 where
    /// wk_ground_grid or the context's default says it. GL_R8, GL_RGB8 or GL_RGBA8. Default none.
    pub surface_classes: wk_opengl_image,
    /// A texture of one sample with unit normals, in the host's world or in eye space (WK_FRAME_NORMALS_IN_EYE_SPACE): (n + 1) / 2 in
    /// GL_RGB8, GL_RGBA8 and GL_RGB10_A2, n in GL_RGB16F, GL_RGBA16F and GL_RGBA32F. What is no unit vector, as a cleared pixel,
    /// leaves it to the host's terrain and depth. Default none.
    pub normals: wk_opengl_image,
}

impl wk_opengl_target {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_OPENGL_TARGET,
        next: null(),
        color: wk_opengl_image::INIT,
        depth: wk_opengl_image::INIT,
        mask: wk_opengl_image::INIT,
        width: 0,
        height: 0,
        generation: 0,
        multisample: WK_OPENGL_MULTISAMPLE_EACH,
        reserved0: 0,
        surface_classes: wk_opengl_image::INIT,
        normals: wk_opengl_image::INIT,
    };
}

/// Wraps the host's OpenGL context, which is current on this thread. On success `*out_device` is a new handle for
/// `wk_device_destroy`, to be called while the contexts live; nothing of the host's is ever deleted.
/// Thread: the one on which the host's context is current.
/// Errors: WK_ERROR_INVALID_ARGUMENT for callbacks that are missing or answer NULL; WK_ERROR_WRONG_ORDER if no context is
/// current, or the wrong one; WK_ERROR_UNSUPPORTED if it is too old; WK_ERROR_ALREADY_WRAPPED if it has a wk_device.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_device_create_opengl(
    desc: *const wk_opengl_host_desc,
    out_device: *mut *mut wk_device,
) -> wk_status {
    guard("wk_device_create_opengl", |_| {
        let place = out("out_device", out_device)?;
        // SAFETY: the caller's promise about `desc`.
        let c = unsafe { layout::read(&"desc", desc)? };
        // SAFETY: as above.
        unsafe { layout::check_chain(&"desc", c.next, &[])? };
        // SAFETY: as above.
        let handle = unsafe { host::opengl::open(&c)? };
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(handle) };
        Ok(Status::Ok)
    })
}
