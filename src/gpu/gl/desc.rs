//! Description of an OpenGL host: its callbacks, and how Welkin shares OpenGL with it.

use std::ffi::{c_char, c_void};

use super::switch::MakeCurrent;

/// Returns the address of OpenGL function `name` (NUL-terminated), or NULL: the host's `eglGetProcAddress`,
/// `glXGetProcAddress` or `glfwGetProcAddress`. Called with Welkin's or the host's context current.
pub type GetProc = unsafe extern "C" fn(user: *mut c_void, name: *const c_char) -> *const c_void;

/// Context in which Welkin uses the host's OpenGL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GlMode {
    /// A second context, which shares objects with the host's.
    #[default]
    Shared,
    /// Host's context, whose state is restored after each batch of Welkin's OpenGL calls.
    HostContext,
}

/// Means by which the commands of the two contexts are kept in order, in shared mode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Handover {
    /// `glFenceSync` and `glWaitSync`, as the standard requires.
    #[default]
    Fence,
    /// `glFlush` alone: enough, and cheaper, where one queue serves both contexts. Measure before you rely on it.
    Flush,
}

/// Description of the OpenGL host that Welkin draws into.
#[derive(Clone, Copy, Debug)]
pub struct GlHostDesc {
    /// Callback that finds OpenGL functions. Required.
    pub get_proc: Option<GetProc>,
    /// Callback that makes contexts current. Required in shared mode. In the host's context it is optional: if given,
    /// it is called with [`WhichContext::Host`](super::WhichContext::Host) before each batch.
    pub make_current: Option<MakeCurrent>,
    /// Argument of both callbacks. The callbacks may be called on any thread that calls Welkin, one call at a time.
    pub user: *mut c_void,
    /// Context in which Welkin uses the host's OpenGL.
    pub mode: GlMode,
    /// Means by which the commands of the two contexts are kept in order, in shared mode.
    pub handover: Handover,
    /// Whether to draw as on OpenGL 3.3 or OpenGL ES 3.0, without compute, even if the driver can do more.
    pub force_tier0: bool,
}
