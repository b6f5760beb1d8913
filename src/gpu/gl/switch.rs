//! Switch between OpenGL contexts: the host's callback that makes one current, and the contexts that it is asked for.

use std::ffi::c_void;

use crate::error::{Error, Result, Status};

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
    pub(super) fn refuse(self, accepted: impl std::fmt::Display) -> Error {
        let name = match self {
            Self::Host => "WK_OPENGL_CONTEXT_HOST",
            Self::Welkin => "WK_OPENGL_CONTEXT_WELKIN",
        };
        Error::about(Status::WrongOrder, "make_current", format_args!("must, asked for {name}, {accepted}"))
    }
}

/// The host's callback with its argument.
#[derive(Clone, Copy)]
pub(super) struct Switch {
    pub(super) call: MakeCurrent,
    pub(super) user: *mut c_void,
}

// SAFETY: the contract of `GlHostDesc` says that the callback may be called on any thread that calls Welkin.
unsafe impl Send for Switch {}
// SAFETY: as above; calls never overlap, the gate sees to it.
unsafe impl Sync for Switch {}

impl Switch {
    /// Asks the host to make a context current.
    pub(super) fn to(self, which: WhichContext) -> Result<()> {
        // SAFETY: the host vouches for its callback and argument when it makes the device.
        let answer = unsafe { (self.call)(self.user, which as u32) };
        if answer == 0 {
            return Ok(());
        }
        Err(which.refuse(format_args!("make that context current and return 0, got {answer}")))
    }
}
