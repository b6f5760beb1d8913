//! Switch between OpenGL contexts: the host's callback that makes one current, and the two contexts.

use std::ffi::c_void;

use crate::error::{Error, Result, Status};

/// Makes a context current on the calling thread: 0 ([`WhichContext::Host`]) or 1 ([`WhichContext::Welkin`]). Returns 0
/// on success and any other value on failure. Must not call Welkin.
pub type MakeCurrent = unsafe extern "C" fn(user: *mut c_void, which: u32) -> i32;

/// Context that [`MakeCurrent`] makes current.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhichContext {
    /// Context that the host draws in.
    Host = 0,
    /// Context that the host created for Welkin; it shares objects with the host's own.
    Welkin = 1,
}

impl WhichContext {
    /// Returns the error for a callback that failed or made a wrong context current when asked for this one. `accepted`
    /// completes the sentence `make_current must, asked for WK_OPENGL_CONTEXT_HOST, `.
    pub(super) fn refuse(self, accepted: impl std::fmt::Display) -> Error {
        let name = match self {
            Self::Host => "WK_OPENGL_CONTEXT_HOST",
            Self::Welkin => "WK_OPENGL_CONTEXT_WELKIN",
        };
        Error::about(Status::WrongOrder, "make_current", format_args!("must, asked for {name}, {accepted}"))
    }
}

/// Host's callback with its argument.
#[derive(Clone, Copy)]
pub(super) struct Switch {
    pub(super) call: MakeCurrent,
    pub(super) user: *mut c_void,
}

// SAFETY: the contract of `GlHostDesc` says that the callback may be called on any thread that calls Welkin.
unsafe impl Send for Switch {}
// SAFETY: as above; the gate ensures that calls never overlap.
unsafe impl Sync for Switch {}

impl Switch {
    /// Calls the host to make a context current.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] if the callback does not return 0.
    pub(super) fn to(self, which: WhichContext) -> Result<()> {
        // SAFETY: the host vouches for its callback and argument when it creates the device.
        let answer = unsafe { (self.call)(self.user, which as u32) };
        if answer == 0 {
            return Ok(());
        }
        Err(which.refuse(format_args!("make that context current and return 0, got {answer}")))
    }
}
