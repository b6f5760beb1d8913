//! Handles, panics and threads, through the C functions as a C host would call them, on the backend that needs no GPU.

use std::ffi::{CStr, c_void};
use std::ptr::{null, null_mut};

use welkin::capi::{abi, device::*, status::*, texture::*};

fn message() -> String {
    // SAFETY: the function promises a string.
    unsafe { CStr::from_ptr(wk_last_error_message()) }.to_string_lossy().into_owned()
}

fn noop_device() -> *mut wk_device {
    let mut desc = unsafe { std::mem::zeroed::<wk_device_desc>() };
    let mut device = null_mut();
    // SAFETY: pointers to live locals.
    unsafe {
        assert_eq!(wk_device_desc_init(&mut desc, size_of_val(&desc) as u32), WK_OK);
        desc.backends = WK_BACKEND_NOOP;
        assert_eq!(wk_device_create(&desc, &mut device), WK_OK, "{}", message());
    }
    device
}

fn texture(device: *mut wk_device) -> *mut wk_texture {
    let mut desc = unsafe { std::mem::zeroed::<wk_texture_desc>() };
    let mut texture = null_mut();
    // SAFETY: pointers to live locals.
    unsafe {
        wk_texture_desc_init(&mut desc, size_of_val(&desc) as u32);
        assert_eq!(wk_texture_create(device, &desc, &mut texture), WK_OK, "{}", message());
    }
    texture
}

#[test]
fn a_device_is_destroyed_once_and_only_without_live_children() {
    let device = noop_device();
    let child = texture(device);
    unsafe {
        assert_eq!(wk_device_destroy(device), WK_ERROR_IN_USE);
        assert!(message().contains("wk_device_destroy: device has 1 live child"), "{}", message());
        assert_eq!(wk_texture_destroy(child), WK_OK);
        assert_eq!(wk_texture_destroy(child), WK_ERROR_BAD_HANDLE);
        assert_eq!(wk_device_destroy(device), WK_OK);
        assert_eq!(wk_device_destroy(device), WK_ERROR_BAD_HANDLE);
        assert_eq!(wk_device_destroy(null_mut()), WK_OK);
    }
}

#[test]
fn a_panic_inside_poisons_the_device_and_nothing_else() {
    let (sick, healthy) = (noop_device(), noop_device());
    let child = texture(sick);
    unsafe {
        abi::panic_in_next_call();
        assert_eq!(wk_device_get_status(sick), WK_ERROR_INTERNAL);
        let text = message();
        assert!(text.contains("injected") && text.contains("call.rs"), "{text}");
        assert_eq!(wk_device_get_status(sick), WK_ERROR_POISONED);
        assert_eq!(wk_texture_write(child, null(), 0, 4), WK_ERROR_POISONED);
        assert_eq!(wk_device_get_status(healthy), WK_OK);
        assert_eq!(wk_texture_destroy(child), WK_OK);
        assert_eq!(wk_device_destroy(sick), WK_OK);
        assert_eq!(wk_device_destroy(healthy), WK_OK);
    }
}

unsafe extern "C" fn meddle(user: *mut c_void, _: wk_log_level, _: *const std::ffi::c_char) {
    let answer = unsafe { wk_version(null_mut(), null_mut(), null_mut()) };
    unsafe { user.cast::<wk_status>().write(answer) };
}

#[test]
fn a_callback_that_calls_welkin_is_refused_and_does_no_harm() {
    let mut answer: wk_status = 7;
    unsafe {
        let user = (&raw mut answer).cast();
        assert_eq!(wk_set_log_callback(Some(meddle), user, WK_LOG_LEVEL_DEBUG), WK_OK);
        assert_eq!(wk_set_log_callback(Some(meddle), user, 9), WK_ERROR_INVALID_ARGUMENT);
        let device = noop_device();
        abi::log_in_next_call();
        assert_eq!(wk_device_get_status(device), WK_OK);
        assert_eq!(answer, WK_ERROR_WRONG_ORDER);
        answer = 7;
        assert_eq!(wk_set_log_callback(None, null_mut(), WK_LOG_LEVEL_ERROR), WK_OK);
        abi::log_in_next_call();
        assert_eq!(wk_device_get_status(device), WK_OK);
        assert_eq!(answer, 7, "a removed callback is not called");
        assert_eq!(wk_device_destroy(device), WK_OK);
    }
}

#[test]
fn messages_belong_to_their_thread() {
    assert_eq!(message(), "");
    unsafe { wk_device_destroy(7 as *mut wk_device) };
    assert!(message().contains("device must be a live wk_device"), "{}", message());
    let other = std::thread::spawn(message).join().unwrap();
    assert_eq!(other, "");
}

#[test]
fn texture_memory_is_checked_before_it_is_touched() {
    let device = noop_device();
    let t = texture(device);
    let mut bytes = [0xAA_u8; 16];
    let p = bytes.as_mut_ptr().cast::<c_void>();
    unsafe {
        assert_eq!(wk_texture_read(t, null_mut(), 16, 4), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("data must not be NULL"), "{}", message());
        assert_eq!(wk_texture_read(t, p, 3, 4), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("data_size must be at least 4"), "{}", message());
        assert_eq!(wk_texture_read(t, p, 16, 3), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("bytes_per_row must be at least 4"), "{}", message());
        assert_eq!(bytes, [0xAA; 16]);
        assert_eq!(wk_texture_write(t, bytes.as_ptr().cast(), 16, 4), WK_OK, "{}", message());
        assert_eq!(wk_texture_destroy(t), WK_OK);
        assert_eq!(wk_device_destroy(device), WK_OK);
    }
}

#[test]
fn status_names_and_versions() {
    let name = |s| unsafe { CStr::from_ptr(wk_status_name(s)) }.to_str().unwrap();
    assert_eq!(name(WK_ERROR_POISONED), "WK_ERROR_POISONED");
    assert_eq!(name(WK_ERROR_INTERNAL), "WK_ERROR_INTERNAL");
    assert_eq!(name(WK_PENDING), "WK_PENDING");
    assert_eq!(name(-999), "unknown status");
    let mut major = u32::MAX;
    unsafe { assert_eq!(wk_version(&mut major, null_mut(), null_mut()), WK_OK) };
    assert_eq!(major.to_string(), env!("CARGO_PKG_VERSION_MAJOR"));
}
