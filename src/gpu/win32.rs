//! Queries to Windows about windows and modules: each driver treats a window that is gone in its own way, and none
//! well.
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

/// Keeps the module that this code is in loaded until the process ends. wgpu's OpenGL on Windows leaves a thread and a
/// class of windows behind, whose code is in the module: a host that unloads Welkin's DLL would end in what is no
/// longer there.
pub(super) fn stay_loaded() {
    const PIN: u32 = 1;
    const FROM_ADDRESS: u32 = 4;
    let mut module = std::ptr::null_mut();
    let here: fn() = stay_loaded;
    // SAFETY: an address inside this module and a place for its handle. Where the call fails, nothing is kept and
    // nothing is broken.
    unsafe { GetModuleHandleExW(PIN | FROM_ADDRESS, here as *const c_void, &mut module) };
}
