//! The host's log callback. Welkin and wgpu log through the crate `log`. In the shared and the static library, only
//! Welkin can set the logger of `log`, and it does so when a host first asks for messages. In a Rust program the logger
//! belongs to the program. If the program has set one, `wk_set_log_callback` fails with `WK_ERROR_IN_USE`.

use std::{
    ffi::{CString, c_void},
    sync::{OnceLock, PoisonError, RwLock},
};

use super::numbers::{
    WK_LOG_LEVEL_DEBUG, WK_LOG_LEVEL_ERROR, WK_LOG_LEVEL_INFO, WK_LOG_LEVEL_WARNING, wk_log_fn, wk_log_level,
};
use crate::error::{Error, Result, Status};

struct Receiver {
    callback: unsafe extern "C" fn(*mut c_void, wk_log_level, *const std::ffi::c_char),
    user: *mut c_void,
}

// SAFETY: the header says that the callback comes from any thread, so the host must make `user` safe for that.
unsafe impl Send for Receiver {}
// SAFETY: as above.
unsafe impl Sync for Receiver {}

static RECEIVER: RwLock<Option<Receiver>> = RwLock::new(None);

struct LogSink;

impl log::Log for LogSink {
    fn enabled(&self, metadata: &log::Metadata<'_>) -> bool {
        // The graphics layer logs its routine work as information; only its warnings and errors matter to a host.
        metadata.target().starts_with("welkin") || metadata.level() <= log::Level::Warn
    }

    fn log(&self, record: &log::Record<'_>) {
        if !self.enabled(record.metadata()) {
            return;
        }
        let level = match record.level() {
            log::Level::Error => WK_LOG_LEVEL_ERROR,
            log::Level::Warn => WK_LOG_LEVEL_WARNING,
            log::Level::Info => WK_LOG_LEVEL_INFO,
            _ => WK_LOG_LEVEL_DEBUG,
        };
        let Ok(text) = CString::new(format!("{}: {}", record.target(), record.args()).replace('\0', "\\0")) else {
            return;
        };
        if let Some(receiver) = &*RECEIVER.read().unwrap_or_else(PoisonError::into_inner) {
            // SAFETY: the host gave the pair, and can only replace it under the write lock.
            unsafe { (receiver.callback)(receiver.user, level, text.as_ptr()) };
        }
    }

    fn flush(&self) {}
}

/// Installs, replaces or (with `None`) removes the receiver. When the function returns, the old receiver is no longer
/// called.
///
/// # Errors
/// [`Status::InUse`] for a receiver if the program has set a logger of its own.
pub(in crate::capi) fn set(callback: wk_log_fn, user: *mut c_void, max_level: wk_log_level) -> Result<()> {
    static INSTALLED: OnceLock<bool> = OnceLock::new();
    let receiver = callback.map(|callback| Receiver { callback, user });
    if receiver.is_some() && !*INSTALLED.get_or_init(|| log::set_logger(&LogSink).is_ok()) {
        let text = "this Rust program has its own logger, which gets Welkin's messages already";
        return Err(Error::new(Status::InUse, text));
    }
    let filter = match (&receiver, max_level) {
        (None, _) => log::LevelFilter::Off,
        (_, WK_LOG_LEVEL_ERROR) => log::LevelFilter::Error,
        (_, WK_LOG_LEVEL_WARNING) => log::LevelFilter::Warn,
        (_, WK_LOG_LEVEL_INFO) => log::LevelFilter::Info,
        _ => log::LevelFilter::Debug,
    };
    if INSTALLED.get() == Some(&true) {
        log::set_max_level(filter);
    }
    *RECEIVER.write().unwrap_or_else(PoisonError::into_inner) = receiver;
    Ok(())
}
