//! Hosts that draw with OpenGL: a wgpu device round the host's context, and the host's images as wgpu textures.
//!
//! # Two modes
//! [`GlMode::Shared`]: the host makes a second context that shares objects with its own, and a callback that makes one
//! or the other current. Welkin draws in the second one, so none of the host's state can change. Fences order the two:
//! the host's commands end before Welkin's begin, and the other way round. Framebuffers are not shared, so targets are
//! textures and renderbuffers.
//!
//! [`GlMode::HostContext`]: Welkin draws in the host's own context. Its state is saved, set to what wgpu takes for
//! granted, and put back (see the `state` room). Any framebuffer can be a target, the window's too, by copies in and
//! out.
//!
//! # What is upside down
//! OpenGL counts rows from the bottom, wgpu from the top. wgpu's backend turns every vertex shader's y round
//! (`gl_Position.y` is negated), so wgpu's top row lies in memory where OpenGL has its bottom row. A host's image is
//! the other way round, and rows are never copied to mend that. Instead:
//! - Geometry: multiply wgpu's clip-space y by -1 ([`CLIP_Y_SIGN`]). The two turns cancel, and wgpu's
//!   front faces are clockwise then (`wgpu::FrontFace::Cw`), because it does not know of this turn.
//! - Full-screen passes: `@builtin(position).xy` is the host's texel, counted from its first row, in colour and depth
//!   alike: `textureLoad` needs no turn. Only the way from texel to ray does: y in clip space is `2 (y + 0.5) / h - 1`
//!   for a host's image, and not `1 - 2 (y + 0.5) / h`.
//!
//! Both are the sign [`CLIP_Y_SIGN`] on clip-space y. A host whose clip control has its origin at the upper left while
//! it draws stores its rows from the top as wgpu does; it says so with its projection, whose y is then negated.
//!
//! # Depth
//! What comes to wgpu is the depth as stored, the window's from 0 to 1. Bind it as a `texture_2d<f32>` with an
//! unfilterable sample type and use `textureLoad`: a `texture_depth_2d` becomes a shadow sampler in GLSL and fails.

mod api;
mod blit;
mod build;
mod cache;
mod check;
mod counting;
mod face;
mod formats;
mod gate;
mod host;
mod image;
mod later;
mod mark;
pub(crate) mod names;
mod open;
mod state;
mod target;
mod window;
mod windows;

use std::ffi::{c_char, c_void};

pub use check::{GlInfo, GlProfile};
pub(super) use host::raised_in_welkin;
pub use host::{Current, GlHost};
pub use image::GlImage;
pub use open::{GlDevice, adopt};
pub use target::{GlTarget, GlTargetDesc, Multisample};

use crate::error::{Error, Status};

/// Answers the address of OpenGL function `name` (NUL-terminated), or NULL: `eglGetProcAddress`, `glXGetProcAddress`,
/// `glfwGetProcAddress` in the host's words. Called with Welkin's or the host's context current.
pub type GetProc = unsafe extern "C" fn(user: *mut c_void, name: *const c_char) -> *const c_void;

/// Makes a context current on the calling thread: 0 ([`WhichContext::Host`]) or 1 ([`WhichContext::Welkin`]). Returns 0
/// when it is current, anything else when it could not be made so. Must not call back into Welkin.
pub type MakeCurrent = unsafe extern "C" fn(user: *mut c_void, which: u32) -> i32;

/// Context that [`MakeCurrent`] is asked for.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhichContext {
    /// The one the host draws in.
    Host = 0,
    /// The one the host made for Welkin, sharing objects with its own.
    Welkin = 1,
}

impl WhichContext {
    /// Refuses what the host's callback made current when it was asked for this context; `accepted` ends
    /// `make_current must, asked for WK_OPENGL_CONTEXT_HOST, `.
    fn refuse(self, accepted: impl std::fmt::Display) -> Error {
        let name = match self {
            Self::Host => "WK_OPENGL_CONTEXT_HOST",
            Self::Welkin => "WK_OPENGL_CONTEXT_WELKIN",
        };
        Error::about(Status::WrongOrder, "make_current", format_args!("must, asked for {name}, {accepted}"))
    }
}

/// How Welkin lives beside the host's OpenGL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GlMode {
    /// In a context of its own that shares objects with the host's.
    #[default]
    Shared,
    /// In the host's context, whose state is put back.
    HostContext,
}

/// How one context's commands are ordered after the other's in shared mode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Handover {
    /// `glFenceSync` and `glWaitSync`, as the standard asks.
    #[default]
    Fence,
    /// `glFlush` alone: enough where one queue serves both contexts, and cheaper there; measure before you rely on it.
    Flush,
}

/// Description of the OpenGL host that is drawn into.
#[derive(Clone, Copy, Debug)]
pub struct GlHostDesc {
    /// Finds OpenGL functions. Required.
    pub get_proc: Option<GetProc>,
    /// Makes contexts current. Required in shared mode; in the host's context it is called with
    /// [`WhichContext::Host`] before each batch, if given.
    pub make_current: Option<MakeCurrent>,
    /// Passed to both. They may be called on any thread that calls Welkin, one at a time.
    pub user: *mut c_void,
    /// Mode in which Welkin lives beside the host's OpenGL.
    pub mode: GlMode,
    /// How contexts wait for each other in shared mode.
    pub handover: Handover,
    /// Draw as a context of OpenGL 3.3 or OpenGL ES 3.0 would, without compute, whatever the driver can do.
    pub force_tier0: bool,
}

/// Sign of clip-space y with which wgpu's picture comes out the right way up in a host's image.
pub const CLIP_Y_SIGN: f32 = -1.0;
