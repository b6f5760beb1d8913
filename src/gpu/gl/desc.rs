//! Description of an OpenGL host: its callbacks, and how Welkin lives beside it.

use std::ffi::{c_char, c_void};

use super::switch::MakeCurrent;

/// Answers the address of OpenGL function `name` (NUL-terminated), or NULL: `eglGetProcAddress`, `glXGetProcAddress`,
/// `glfwGetProcAddress` in the host's words. Called with Welkin's or the host's context current.
pub type GetProc = unsafe extern "C" fn(user: *mut c_void, name: *const c_char) -> *const c_void;

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
    /// [`WhichContext::Host`](super::WhichContext::Host) before each batch, if given.
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
