//! Check whether an X11 window exists. Drivers do not check: Mesa's EGL dereferences NULL for a window that is gone,
//! and an X error that reaches Xlib's default handler ends the process. The same question through XCB does neither.
#![cfg(all(unix, not(any(target_os = "macos", target_os = "ios"))))]

use std::ffi::{c_uint, c_void};
use std::ptr::{NonNull, null_mut};
use std::sync::OnceLock;

type GetXcbConnection = unsafe extern "C" fn(display: *mut c_void) -> *mut c_void;
type GetGeometry = unsafe extern "C" fn(connection: *mut c_void, drawable: u32) -> Cookie;
type GetGeometryReply =
    unsafe extern "C" fn(connection: *mut c_void, cookie: Cookie, error: *mut *mut c_void) -> *mut c_void;

/// `xcb_get_geometry_cookie_t`.
#[repr(C)]
struct Cookie {
    _sequence: c_uint,
}

/// Functions of the X libraries, loaded at first use, because a machine without X has none.
struct Xcb {
    get_geometry: GetGeometry,
    get_geometry_reply: GetGeometryReply,
    /// `XGetXCBConnection`, needed only for Xlib displays; `None` without `libX11-xcb`.
    get_xcb_connection: Option<GetXcbConnection>,
}

unsafe extern "C" {
    /// `free` of the C library, for replies, which the caller must free.
    fn free(p: *mut c_void);
}

fn xcb() -> Option<&'static Xcb> {
    static XCB: OnceLock<Option<Xcb>> = OnceLock::new();
    XCB.get_or_init(|| {
        // SAFETY: the initialisers of these libraries only set up the libraries; the symbols have these signatures in
        // every version; the libraries stay loaded for good.
        unsafe {
            let xcb = libloading::Library::new("libxcb.so.1").ok()?;
            let get_geometry = *xcb.get::<GetGeometry>(b"xcb_get_geometry\0").ok()?;
            let get_geometry_reply = *xcb.get::<GetGeometryReply>(b"xcb_get_geometry_reply\0").ok()?;
            std::mem::forget(xcb);
            let bridge = libloading::Library::new("libX11-xcb.so.1").ok();
            let get_xcb_connection =
                bridge.as_ref().and_then(|b| b.get::<GetXcbConnection>(b"XGetXCBConnection\0").ok()).map(|f| *f);
            std::mem::forget(bridge);
            Some(Xcb { get_geometry, get_geometry_reply, get_xcb_connection })
        }
    })
    .as_ref()
}

/// Whether `window` exists on the server behind an XCB connection: the server must give its geometry. `None` without
/// `libxcb`.
///
/// # Safety
/// `connection` is a live `xcb_connection_t*`.
pub(super) unsafe fn exists_xcb(connection: NonNull<c_void>, window: u32) -> Option<bool> {
    let xcb = xcb()?;
    // SAFETY: the caller vouches for the connection; the reply, if any, is ours to free. Without a place for an error,
    // XCB drops it instead of queueing it for the host.
    unsafe {
        let cookie = (xcb.get_geometry)(connection.as_ptr(), window);
        let reply = (xcb.get_geometry_reply)(connection.as_ptr(), cookie, null_mut());
        let exists = !reply.is_null();
        free(reply);
        Some(exists)
    }
}

/// Answers as [`exists_xcb`] does, for an Xlib display; `None` also without `libX11-xcb`.
///
/// # Safety
/// `display` is a live `Display*`.
pub(super) unsafe fn exists_xlib(display: NonNull<c_void>, window: u64) -> Option<bool> {
    let bridge = xcb()?.get_xcb_connection?;
    // SAFETY: the caller vouches for the display.
    let connection = NonNull::new(unsafe { bridge(display.as_ptr()) })?;
    let Ok(window) = u32::try_from(window) else { return Some(false) };
    // SAFETY: the connection lives as long as the display.
    unsafe { exists_xcb(connection, window) }
}
