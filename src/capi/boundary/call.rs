//! Guard around every C call. No panic leaves it, and every failure stores a status, a message and a field for the
//! calling thread. After a panic in a call on a device, all later calls on that device are refused, except those that
//! destroy.

use std::{
    any::Any,
    cell::{Cell, RefCell},
    ffi::{CString, c_char},
    panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind},
    sync::{Arc, Once},
};

use super::{device_cell::DeviceCell, handles, numbers::wk_status};
use crate::error::{Error, Result, Status};

thread_local! {
    /// Last failure of this thread.
    static LAST: RefCell<Last> = RefCell::default();
    /// Number of boundary calls that this thread is in. A panic inside one becomes a message of Welkin's; the standard
    /// hook does not print it.
    static DEPTH: Cell<u32> = const { Cell::new(0) };
    /// Fault to inject, see [`inject`].
    static INJECTED: Cell<Injected> = const { Cell::new(Injected::Nothing) };
    /// File and line of the last panic inside a boundary call of this thread.
    static PANIC_PLACE: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// A call from C in progress. It finds the objects of handles, and knows the device that a panic would poison.
pub(in crate::capi) struct Call {
    /// Device that a panic poisons.
    device: Option<Arc<DeviceCell>>,
}

impl Call {
    /// Returns the live object behind a handle. From here on a panic in this call poisons the object's device.
    ///
    /// # Errors
    /// [`Status::BadHandle`] with the parameter's name; [`Status::Poisoned`] if an earlier call on the device has
    /// panicked.
    pub(in crate::capi) fn get<T: handles::HandleObject>(
        &mut self,
        param: &str,
        handle: *const T::C,
    ) -> Result<Arc<T>> {
        let object = handles::get::<T>(param, handle)?;
        if let Some(device) = object.device() {
            device.check_alive()?;
            self.blame(device);
        }
        Ok(object)
    }

    /// Sets the device that a panic in this call poisons, and injects the fault that a test has set ([`inject`]).
    pub(in crate::capi) fn blame(&mut self, device: &Arc<DeviceCell>) {
        self.device = Some(device.clone());
        match INJECTED.replace(Injected::Nothing) {
            Injected::Nothing => {}
            Injected::Panic => panic!("injected"),
            Injected::Message => log::info!(target: "welkin", "injected"),
            Injected::Loss => device.gpu().simulate_loss(),
        }
    }
}

/// Runs the body of a C function; turns its error or panic into a status and the thread's message. Inside a callback of
/// Welkin's the body does not run: the call is refused.
pub(in crate::capi) fn guard(function: &'static str, body: impl FnOnce(&mut Call) -> Result<Status>) -> wk_status {
    hush_panics();
    if DEPTH.get() > 0 {
        let text = "called inside a callback of Welkin's: no Welkin function may be";
        return remember(function, &Error::new(Status::WrongOrder, text));
    }
    let mut call = Call { device: None };
    DEPTH.set(DEPTH.get() + 1);
    // A panic may leave state half-done. That state belongs to the device, which is poisoned below.
    let outcome = catch_unwind(AssertUnwindSafe(|| body(&mut call)));
    DEPTH.set(DEPTH.get() - 1);
    let error = match outcome {
        Ok(Ok(status)) => return status as wk_status,
        // A window that shows nothing now is an error for Rust hosts; for C hosts it is a success, and successes keep
        // the last failure's message.
        Ok(Err(error)) if error.status == Status::Pending => return error.status as wk_status,
        Ok(Err(error)) => error,
        Err(payload) => {
            if let Some(device) = &call.device {
                device.poison();
            }
            panic_error(payload)
        }
    };
    remember(function, &error)
}

/// Last failure of a thread.
#[derive(Default)]
struct Last {
    status: wk_status,
    message: CString,
    field: CString,
}

/// Returns the status of the calling thread's last failed call; 0 before the first.
pub(in crate::capi) fn last_status() -> wk_status {
    LAST.with_borrow(|last| last.status)
}

/// Returns the calling thread's last message; valid until its next failing call.
pub(in crate::capi) fn last_error() -> *const c_char {
    LAST.with_borrow(|last| last.message.as_ptr())
}

/// Returns the field that the last message is about, as the header names it; empty if it is about none.
pub(in crate::capi) fn last_error_field() -> *const c_char {
    LAST.with_borrow(|last| last.field.as_ptr())
}

/// Fault that a test injects into a call.
#[derive(Clone, Copy)]
pub(in crate::capi) enum Injected {
    Nothing,
    Panic,
    Message,
    Loss,
}

/// Injects a fault into the next call of this thread that reaches a device.
pub(in crate::capi) fn inject(what: Injected) {
    INJECTED.set(what);
}

/// Stores an error for the thread's later query, and returns its status.
fn remember(function: &str, error: &Error) -> wk_status {
    let c_text = |text: String| CString::new(text.replace('\0', "\\0")).unwrap_or_default();
    let status = error.status as wk_status;
    let (message, field) = (c_text(format!("{function}: {error}")), c_text(error.field().unwrap_or_default().into()));
    LAST.set(Last { status, message, field });
    status
}

/// Returns the error for a panic.
fn panic_error(payload: Box<dyn Any + Send>) -> Error {
    let text = payload.downcast_ref::<&str>().map(|s| (*s).to_owned());
    let text = text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".into());
    let place = PANIC_PLACE.take().map_or_else(String::new, |p| format!(" at {p}"));
    // The payload's own drop might panic as well, so it is leaked.
    std::mem::forget(payload);
    Error::new(Status::Internal, format!("a fault inside Welkin{place}: {text}; its device answers no further calls"))
}

/// Keeps the standard hook from printing to stderr the panics that happen inside Welkin's calls. These panics become
/// messages. Panics elsewhere in the process (a Rust host's own code) still go to the previous hook.
fn hush_panics() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let outer = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info: &PanicHookInfo<'_>| {
            if DEPTH.get() == 0 {
                outer(info);
            } else {
                PANIC_PLACE.set(info.location().map(ToString::to_string));
            }
        }));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pending_call_keeps_the_last_failures_message() {
        let last = || LAST.with_borrow(|last| (last.status, last.message.clone(), last.field.clone()));
        let failed = guard("wk_first", |_| Err(Error::range("time_s", "in [0, 1] s", 2.0)));
        let kept = (failed, c"wk_first: time_s must be in [0, 1] s, got 2".to_owned(), c"time_s".to_owned());
        assert_eq!((failed, last()), (Status::InvalidArgument as wk_status, kept.clone()));
        let pending = guard("wk_second", |_| Err(Error::new(Status::Pending, "the window is hidden")));
        assert_eq!((pending, last()), (Status::Pending as wk_status, kept));
    }
}
