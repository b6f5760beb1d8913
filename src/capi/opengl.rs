//! OpenGL hosts
//!
//! Welkin draws into the host's own textures, renderbuffers or framebuffers, in one of two ways.
//!
//! SHARED (the default): the host makes a second context that shares objects with its own, and a callback that makes
//! either context current. Welkin draws in the second one, so none of the host's state can change. Fences order the
//! two. Contexts do not share framebuffers, so targets are textures and renderbuffers. Bind a texture again before you
//! sample what Welkin drew into it, as OpenGL requires between contexts.
//!
//! HOST_CONTEXT: Welkin draws in the host's own context. It saves every piece of state that it touches, sets it, and
//! restores it. Any framebuffer can be a target, even that of the window (0); Welkin copies its images in and out.
//!
//! In SHARED mode one device serves all windows whose contexts share objects, with one view for each. In HOST_CONTEXT
//! mode a device belongs to one context.
//!
//! When a call begins, the host's context must be current on the calling thread; it is current again when the call
//! returns. Needed: OpenGL 3.3 or OpenGL ES 3.0, core or compatibility. From 4.3 (ES 3.1) on Welkin uses compute
//! shaders.

pub use super::opengl_structs::*;
use super::{
    boundary::{
        guard,
        input::out,
        layout::{self, init_struct},
        numbers::*,
        objects::wk_device,
    },
    host,
};
use crate::error::Status;

include!(concat!(env!("OUT_DIR"), "/init_opengl.rs"));

/// Wraps the host's OpenGL context, which must be current on this thread. On success `*out_device` is a new handle for
/// `wk_device_destroy`; call that function while the contexts live. Welkin never deletes the host's objects.
/// Thread: the one on which the host's context is current.
/// Errors: WK_ERROR_INVALID_ARGUMENT for callbacks that are missing or return NULL; WK_ERROR_WRONG_ORDER if no context
/// or the wrong one is current, if make_current fails, if the context cannot draw now (a display list is being
/// compiled, the render mode is not GL_RENDER, or the current program is marked for deletion), or, in
/// WK_OPENGL_HOST_CONTEXT, if conditional rendering or a query that counts samples or primitives is active;
/// WK_ERROR_UNSUPPORTED if the context's version is too old; WK_ERROR_ALREADY_WRAPPED if the context already has a
/// wk_device; WK_ERROR_NO_ADAPTER, with the driver's name, if the context's driver draws a few known texels wrong or
/// does not finish them within 6 s.
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
