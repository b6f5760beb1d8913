//! Status, versions, messages
//!
//! Every call that can fail returns a wk_status: 0 and positive values mean success, negative ones failure.
//! wk_last_error_message() then says which parameter was wrong and what is accepted, and wk_last_error_field() gives
//! that parameter or field alone.

use std::ffi::{CStr, c_char, c_void};

pub use super::boundary::numbers::*;
use super::boundary::{call, guard, input, layout, log_sink};
use crate::error::Status;

/// Returns the name of a status, such as "WK_ERROR_BAD_HANDLE"; "unknown status" for other numbers. Never NULL; lives
/// as long as the library, and you must not free it.
/// Thread: any.
#[unsafe(no_mangle)]
pub extern "C" fn wk_status_name(status: wk_status) -> *const c_char {
    NAMES.iter().find(|n| n.0 == status).map_or(c"unknown status", |n| n.1).as_ptr()
}

/// Returns the message of the calling thread's last failed call: one sentence that begins with the function's name and
/// names the parameter and the accepted range. Empty before the first failure; successful calls do not change it. Never
/// NULL; valid until the next failing call of this thread.
/// Thread: any; each thread has its own message.
#[unsafe(no_mangle)]
pub extern "C" fn wk_last_error_message() -> *const c_char {
    call::last_error()
}

/// Returns the parameter or field that the calling thread's last failed call was about, as a path of names in this
/// header that begins at the function's parameter or at a struct's name: `frame.projection`, `shelters[2].half_size_m`,
/// `wk_sky_settings.suns`, `time_s`. A host's editor can use it to mark a control. A failure with
/// WK_ERROR_INVALID_ARGUMENT always has a field. Empty where a failure is about no field, and before the first failure.
/// Never NULL; valid until the next failing call of this thread.
/// Thread: any; each thread has its own field.
#[unsafe(no_mangle)]
pub extern "C" fn wk_last_error_field() -> *const c_char {
    call::last_error_field()
}

/// Gets the library's version. WK_VERSION_MAJOR, _MINOR and _PATCH are the header's. A library fits a header if the
/// major versions are equal and the library's minor version is at least the header's. Each of the three pointers may be
/// NULL.
/// Thread: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_version(major: *mut u32, minor: *mut u32, patch: *mut u32) -> wk_status {
    guard("wk_version", |_| {
        let out = layout::optional_out::<u32>;
        let parts = [
            (out(&"major", major)?, env!("CARGO_PKG_VERSION_MAJOR")),
            (out(&"minor", minor)?, env!("CARGO_PKG_VERSION_MINOR")),
            (out(&"patch", patch)?, env!("CARGO_PKG_VERSION_PATCH")),
        ];
        for (place, text) in parts {
            if let Some(out) = place {
                // SAFETY: checked, and the caller's promise that it points to a `uint32_t`.
                unsafe { out.write(text.parse().unwrap_or(0)) };
            }
        }
        Ok(Status::Ok)
    })
}

/// Sends Welkin's messages, and its graphics layer's warnings and errors, to `callback` from now on; NULL stops them.
/// They are off by default, and Welkin never prints. There is one callback in a process. `max_level` is the least
/// severe level that is sent. `callback` must return normally and must not unwind, even if it could not handle the
/// message.
/// Thread: any. When the call returns, the previous callback is no longer called.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an unknown level; WK_ERROR_IN_USE in a Rust program that has its own logger.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_set_log_callback(
    callback: wk_log_fn,
    user: *mut c_void,
    max_level: wk_log_level,
) -> wk_status {
    guard("wk_set_log_callback", |_| {
        input::check_enum("max_level", &layout::WK_LOG_LEVEL, max_level)?;
        log_sink::set(callback, user, max_level)?;
        Ok(Status::Ok)
    })
}

/// Names of the statuses by number.
static NAMES: &[(wk_status, &CStr)] = &[
    (WK_OK, c"WK_OK"),
    (WK_PENDING, c"WK_PENDING"),
    (WK_ERROR_INVALID_ARGUMENT, c"WK_ERROR_INVALID_ARGUMENT"),
    (WK_ERROR_BAD_HANDLE, c"WK_ERROR_BAD_HANDLE"),
    (WK_ERROR_IN_USE, c"WK_ERROR_IN_USE"),
    (WK_ERROR_UNSUPPORTED, c"WK_ERROR_UNSUPPORTED"),
    (WK_ERROR_NO_ADAPTER, c"WK_ERROR_NO_ADAPTER"),
    (WK_ERROR_DEVICE_LOST, c"WK_ERROR_DEVICE_LOST"),
    (WK_ERROR_OUT_OF_MEMORY, c"WK_ERROR_OUT_OF_MEMORY"),
    (WK_ERROR_POISONED, c"WK_ERROR_POISONED"),
    (WK_ERROR_ALREADY_WRAPPED, c"WK_ERROR_ALREADY_WRAPPED"),
    (WK_ERROR_PARSE, c"WK_ERROR_PARSE"),
    (WK_ERROR_IO, c"WK_ERROR_IO"),
    (WK_ERROR_SURFACE_OUTDATED, c"WK_ERROR_SURFACE_OUTDATED"),
    (WK_ERROR_WRONG_ORDER, c"WK_ERROR_WRONG_ORDER"),
    (WK_ERROR_ABORTED, c"WK_ERROR_ABORTED"),
    (WK_ERROR_INTERNAL, c"WK_ERROR_INTERNAL"),
];
