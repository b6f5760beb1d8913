//! Windows
//!
//! For hosts without graphics of their own: Welkin presents to a window that the host identifies by its native handle.
//! The host makes the window, runs its event loop, and tells Welkin when its size changes. Resized, hidden, minimised
//! and lost windows give a status and never a fault.
//!
//!   wk_device_create_for_window, wk_surface_create, wk_surface_configure
//!   each frame: wk_surface_acquire, wk_view_record (wk_own_target.surface), wk_surface_present
//!   on WK_ERROR_SURFACE_OUTDATED: wk_surface_configure with the window's current size, then the next frame
//!   on WK_PENDING: the window shows nothing now; skip the frame

use std::{
    ffi::c_void,
    ptr::{null, null_mut},
    sync::Arc,
};

pub use super::boundary::objects::surface::*;
use super::{
    boundary::{
        Host, guard, handles,
        input::out,
        layout::{self, init_struct, struct_size},
        numbers::*,
        objects::{DeviceObject, wk_device},
    },
    device::{self, wk_device_desc},
};
use crate::{
    error::{Error, Result, Status},
    gpu::surface::{NativeWindow, Pacing, Surface, SurfaceEncoding, SurfaceOptions, device_for_window},
};

include!(concat!(env!("OUT_DIR"), "/init_surface.rs"));

/// Window systems.
pub type wk_window_kind = u32;
/// X11 by Xlib: `display` is the Display*, `id` the Window, `screen` the screen's number.
pub const WK_WINDOW_XLIB: wk_window_kind = 1;
/// X11 by XCB: `display` is the xcb_connection_t*, `id` the xcb_window_t, `screen` the screen's number.
pub const WK_WINDOW_XCB: wk_window_kind = 2;
/// Wayland: `display` is the wl_display*, `handle` the wl_surface*.
pub const WK_WINDOW_WAYLAND: wk_window_kind = 3;
/// Windows: `handle` is the HWND, `display` the HINSTANCE of the module that made the window.
pub const WK_WINDOW_WIN32: wk_window_kind = 4;
/// macOS: `handle` is the NSView*. Make all calls on the main thread.
pub const WK_WINDOW_APPKIT: wk_window_kind = 5;

/// A native window. Welkin ignores fields that its kind does not use. The window must outlive the surface, and its
/// display connection must outlive the device.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_window {
    /// sizeof(wk_window) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_WINDOW.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Window system. Default WK_WINDOW_XLIB.
    pub kind: wk_window_kind,
    /// Number of the screen, for X11. Default 0.
    pub screen: i32,
    /// Display, connection or module; see wk_window_kind. Default NULL.
    pub display: *mut c_void,
    /// Handle of the window; see wk_window_kind. Default NULL.
    pub handle: *mut c_void,
    /// Number of the window, for X11; see wk_window_kind. Default 0.
    pub id: u64,
}

impl wk_window {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_WINDOW,
        next: null(),
        kind: WK_WINDOW_XLIB,
        screen: 0,
        display: null_mut(),
        handle: null_mut(),
        id: 0,
    };
}

/// Encoding of the values drawn to a surface; give the frame a color_space that fits it.
pub type wk_surface_encoding = u32;
/// Display-linear values, which the hardware encodes to sRGB. WK_COLOR_DISPLAY_LINEAR fits, and WK_COLOR_SCENE_LINEAR
/// with WK_STAGE_TONE.
pub const WK_SURFACE_DISPLAY_LINEAR: wk_surface_encoding = 0;
/// Values encoded to sRGB already. WK_COLOR_DISPLAY_SRGB fits, and WK_COLOR_SCENE_LINEAR with WK_STAGE_TONE.
pub const WK_SURFACE_DISPLAY_SRGB: wk_surface_encoding = 1;

/// Time at which images reach the screen.
pub type wk_pacing = u32;
/// With the screen's refresh; wk_surface_acquire waits for the refresh.
pub const WK_PACING_REFRESH: wk_pacing = 0;
/// As soon as possible; may tear.
pub const WK_PACING_IMMEDIATE: wk_pacing = 1;

/// Settings of a surface.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_surface_config {
    /// sizeof(wk_surface_config) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SURFACE_CONFIG.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Width of the window's drawable area, pixels, at most wk_caps.max_texture_size; 0 (the default) while the window
    /// is minimised.
    pub width: u32,
    /// Height of the window's drawable area, pixels, at most wk_caps.max_texture_size; 0 (the default) while the window
    /// is minimised.
    pub height: u32,
    /// Encoding of the values drawn. Default WK_SURFACE_DISPLAY_LINEAR.
    pub encoding: wk_surface_encoding,
    /// Time at which images reach the screen. Default WK_PACING_REFRESH.
    pub pacing: wk_pacing,
}

impl wk_surface_config {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SURFACE_CONFIG,
        next: null(),
        width: 0,
        height: 0,
        encoding: WK_SURFACE_DISPLAY_LINEAR,
        pacing: WK_PACING_REFRESH,
    };
}

/// # Safety
/// `p` is NULL or a `wk_window`.
unsafe fn native(p: *const wk_window) -> Result<NativeWindow> {
    // SAFETY: the caller's promise.
    let c = unsafe { layout::read(&"window", p)? };
    // SAFETY: as above.
    unsafe { layout::check_chain(&"window", c.next, &[])? };
    Ok(match c.kind {
        WK_WINDOW_XCB => {
            let window = u32::try_from(c.id).map_err(|_| Error::range("window.id", "an xcb_window_t", c.id))?;
            NativeWindow::Xcb { connection: c.display, screen: c.screen, window }
        }
        WK_WINDOW_WAYLAND => NativeWindow::Wayland { display: c.display, surface: c.handle },
        WK_WINDOW_WIN32 => NativeWindow::Win32 { hwnd: c.handle, hinstance: c.display },
        WK_WINDOW_APPKIT => NativeWindow::AppKit { ns_view: c.handle },
        _ => NativeWindow::Xlib { display: c.display, screen: c.screen, window: c.id },
    })
}

/// Renames a window's handles in an error to the names of the header's fields.
fn in_window(e: Error) -> Error {
    e.map_field(|name| match name {
        "display" | "connection" | "hinstance" => "window.display".into(),
        "window" => "window.id".into(),
        "surface" | "hwnd" | "ns_view" => "window.handle".into(),
        other => other.into(),
    })
}

/// Creates an own device that can present to `window` and to other windows of the same connection. `desc` NULL means
/// WK_DEVICE_DESC_INIT. On success `*out_device` is a new handle for `wk_device_destroy`.
/// Thread: any; on macOS the main one. With X11, call XInitThreads first if you use Xlib from several threads.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming a missing handle; WK_ERROR_SURFACE_OUTDATED if the window does not exist;
/// WK_ERROR_NO_ADAPTER or WK_ERROR_UNSUPPORTED if no driver can present to the window; else as wk_device_create.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_device_create_for_window(
    desc: *const wk_device_desc,
    window: *const wk_window,
    out_device: *mut *mut wk_device,
) -> wk_status {
    guard("wk_device_create_for_window", |_| {
        let place = out("out_device", out_device)?;
        // SAFETY: the caller's promise about `desc`.
        let desc = unsafe { layout::read_or_default(&"desc", desc)? };
        // SAFETY: as above.
        unsafe { layout::check_chain(&"desc", desc.next, &[])? };
        // SAFETY: the caller's promise about `window`.
        let window = unsafe { native(window)? };
        // SAFETY: as above; the header demands that the window's connection outlives the device.
        let gpu = unsafe { device_for_window(&window, &device::options(&desc)) }.map_err(in_window)?;
        let handle = device::issue(gpu, Host::Own)?;
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(handle) };
        Ok(Status::Ok)
    })
}

/// Creates a surface on a window. Configure it before use. On success `*out_surface` is a new handle for
/// `wk_surface_destroy`.
/// Thread: exclusive on the device; on macOS the main one.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming a missing handle; WK_ERROR_SURFACE_OUTDATED if the window does not exist;
/// WK_ERROR_UNSUPPORTED if the device cannot present to this window.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_surface_create(
    device: *mut wk_device,
    window: *const wk_window,
    out_surface: *mut *mut wk_surface,
) -> wk_status {
    guard("wk_surface_create", |call| {
        let object = call.get::<DeviceObject>("device", device)?;
        let place = out("out_surface", out_surface)?;
        // SAFETY: the caller's promise about `window`.
        let window = unsafe { native(window)? };
        object.cell.drain();
        // SAFETY: the header demands that the window outlives the surface.
        let surface = unsafe { Surface::new(object.cell.gpu(), &window) }.map_err(in_window)?;
        let surface = SurfaceObject::new(object.cell.clone(), surface);
        let handle = handles::insert::<_, DeviceObject>(Arc::new(surface), Some(device))?;
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(handle) };
        Ok(Status::Ok)
    })
}

/// Destroys a surface; the window stays the host's. NULL does nothing.
/// Thread: any; on macOS the main one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_surface_destroy(surface: *mut wk_surface) -> wk_status {
    guard("wk_surface_destroy", |_| {
        if !surface.is_null() {
            let object = handles::remove::<SurfaceObject>("surface", surface)?;
            object.cell.clone().retire(object);
        }
        Ok(Status::Ok)
    })
}

/// Configures a surface, the first time or after its window changed. An image that was acquired and not yet presented
/// is discarded. With a width or height of 0 the call succeeds, and wk_surface_acquire returns
/// WK_ERROR_SURFACE_OUTDATED until the surface is configured with an area.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range; WK_ERROR_UNSUPPORTED if the window has no format
/// for the encoding; WK_ERROR_SURFACE_OUTDATED if the window is gone or refuses the configuration.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_surface_configure(surface: *mut wk_surface, config: *const wk_surface_config) -> wk_status {
    guard("wk_surface_configure", |call| {
        let object = call.get::<SurfaceObject>("surface", surface)?;
        // SAFETY: the caller's promise about `config`.
        let c = unsafe { layout::read(&"config", config)? };
        // SAFETY: as above.
        unsafe { layout::check_chain(&"config", c.next, &[])? };
        let options = SurfaceOptions {
            width: c.width,
            height: c.height,
            encoding: match c.encoding {
                WK_SURFACE_DISPLAY_SRGB => SurfaceEncoding::DisplaySrgb,
                _ => SurfaceEncoding::DisplayLinear,
            },
            pacing: if c.pacing == WK_PACING_IMMEDIATE { Pacing::Immediate } else { Pacing::Refresh },
        };
        object.lock().configure(&options).map_err(|e| e.map_field(|field| format!("config.{field}")))?;
        Ok(Status::Ok)
    })
}

/// Acquires the next image to draw into. Called again before `wk_surface_present`, it returns the same image.
/// Thread: exclusive.
/// Returns WK_PENDING if the window shows nothing now, because it is hidden or the screen is busy: skip this frame.
/// Errors: WK_ERROR_SURFACE_OUTDATED if the surface must be configured again, and while the window is minimised;
/// WK_ERROR_WRONG_ORDER before the first wk_surface_configure.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_surface_acquire(surface: *mut wk_surface) -> wk_status {
    guard("wk_surface_acquire", |call| {
        call.get::<SurfaceObject>("surface", surface)?.lock().acquire()?;
        Ok(Status::Ok)
    })
}

/// Presents the acquired image, after the work that was recorded for it.
/// Thread: exclusive.
/// Errors: WK_ERROR_WRONG_ORDER if no image was acquired; WK_ERROR_SURFACE_OUTDATED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_surface_present(surface: *mut wk_surface) -> wk_status {
    guard("wk_surface_present", |call| {
        call.get::<SurfaceObject>("surface", surface)?.lock().present()?;
        Ok(Status::Ok)
    })
}
