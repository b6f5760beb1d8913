//! Two uses of the Windows API: a check whether a window exists, made before calls to drivers, which mishandle a
//! destroyed window in various ways; and a pin that keeps Welkin's module loaded.
#![cfg(windows)]

use std::ffi::c_void;

#[link(name = "user32")]
unsafe extern "system" {
    fn IsWindow(hwnd: *mut c_void) -> i32;
}

#[link(name = "kernel32")]
unsafe extern "system" {
    fn GetModuleHandleExW(flags: u32, address: *const c_void, module: *mut *mut c_void) -> i32;
}

/// Whether a window exists.
pub(super) fn exists(hwnd: *mut c_void) -> bool {
    // SAFETY: Windows looks the handle up in a table, and follows no pointer.
    unsafe { IsWindow(hwnd) != 0 }
}

/// Keeps the module with this code loaded until the process ends. wgpu's OpenGL on Windows leaves behind a thread and a
/// window class whose code is in the module. A host that unloaded Welkin's DLL would crash in code that is no longer
/// there.
pub(super) fn stay_loaded() {
    const PIN: u32 = 1;
    const FROM_ADDRESS: u32 = 4;
    let mut module = std::ptr::null_mut();
    let here: fn() = stay_loaded;
    // SAFETY: the arguments are an address inside this module and a place for its handle. If the call fails, the module
    // is merely not pinned.
    unsafe { GetModuleHandleExW(PIN | FROM_ADDRESS, here as *const c_void, &mut module) };
}
