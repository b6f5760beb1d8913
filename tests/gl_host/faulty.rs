//! Drivers whose blocks contain other bytes than were written, or that never finish: the device is refused in time,
//! with the driver's name.

use std::{
    cell::Cell,
    ffi::{CStr, c_char, c_void},
    ptr::null_mut,
    time::{Duration, Instant},
};

use glow::HasContext;
use welkin::capi::{device::*, frame::*, opengl::*, status::*, view::*};
use welkin::gpu::gl::GlMode;
use welkin_support::{
    c_scene::{Scene, assert_same, init, message, ok, own_picture},
    egl::{Api, Window, function, proc_address},
};

use crate::{
    SIZE,
    capi::{picture, target},
    frame,
    host::{Host, get_proc, make_current},
    images::{framebuffer, image_of, texture},
};

/// Faults of the driver.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Broken {
    /// Bytes of this value in place of those written through mapped memory.
    mapped: Option<u32>,
    /// Bytes of this value in place of those written by `glBufferSubData`.
    sub_data: Option<u32>,
    /// The GPU does not finish.
    hangs: bool,
}

thread_local! {
    static BROKEN: Cell<Broken> = const { Cell::new(Broken { mapped: None, sub_data: None, hangs: false }) };
    /// Calls of a hung driver that would never return.
    static ENDLESS: Cell<u32> = const { Cell::new(0) };
}

const TIMEOUT_EXPIRED: u32 = 0x911B;

unsafe extern "system" fn flush_mapped(target: u32, offset: isize, length: isize) {
    type Pointer = unsafe extern "system" fn(u32, u32, *mut *mut u32);
    type Flush = unsafe extern "system" fn(u32, isize, isize);
    // SAFETY: the caller's buffer is bound to the target and mapped over these bytes.
    unsafe {
        if let Some(word) = BROKEN.get().mapped {
            let mut start = null_mut();
            function::<Pointer>("glGetBufferPointerv")(target, 0x88BD, &mut start);
            let words = std::slice::from_raw_parts_mut(start.byte_offset(offset), length as usize / 4);
            words.fill(word);
        }
        function::<Flush>("glFlushMappedBufferRange")(target, offset, length);
    }
}

unsafe extern "system" fn buffer_sub_data(target: u32, offset: isize, size: isize, data: *const c_void) {
    type SubData = unsafe extern "system" fn(u32, isize, isize, *const c_void);
    let other = BROKEN.get().sub_data.map(|word| vec![word; size as usize / 4 + 1]);
    // SAFETY: as the caller vouches; ours holds as many bytes.
    unsafe {
        function::<SubData>("glBufferSubData")(target, offset, size, other.map_or(data, |o| o.leak().as_ptr().cast()))
    };
}

unsafe extern "system" fn client_wait_sync(sync: *const c_void, flags: u32, timeout_ns: u64) -> u32 {
    if BROKEN.get().hangs {
        std::thread::sleep(Duration::from_nanos(timeout_ns));
        return TIMEOUT_EXPIRED;
    }
    type Wait = unsafe extern "system" fn(*const c_void, u32, u64) -> u32;
    // SAFETY: as the caller vouches.
    unsafe { function::<Wait>("glClientWaitSync")(sync, flags, timeout_ns) }
}

unsafe extern "system" fn get_sync(sync: *const c_void, name: u32, room: i32, length: *mut i32, value: *mut i32) {
    type Get = unsafe extern "system" fn(*const c_void, u32, i32, *mut i32, *mut i32);
    // SAFETY: as the caller vouches; one value is there at least.
    unsafe {
        function::<Get>("glGetSynciv")(sync, name, room, length, value);
        if BROKEN.get().hangs {
            *value = 0x9118; // GL_UNSIGNALED
        }
    }
}

unsafe extern "system" fn finish() {
    if BROKEN.get().hangs {
        ENDLESS.set(ENDLESS.get() + 1);
        return;
    }
    // SAFETY: no arguments.
    unsafe { function::<unsafe extern "system" fn()>("glFinish")() };
}

unsafe extern "system" fn read_pixels(x: i32, y: i32, w: i32, h: i32, format: u32, ty: u32, out: *mut c_void) {
    type Read = unsafe extern "system" fn(i32, i32, i32, i32, u32, u32, *mut c_void);
    if BROKEN.get().hangs {
        ENDLESS.set(ENDLESS.get() + 1);
    }
    // SAFETY: as the caller vouches.
    unsafe { function::<Read>("glReadPixels")(x, y, w, h, format, ty, out) };
}

unsafe extern "C" fn broken_proc(user: *mut c_void, name: *const c_char) -> *const c_void {
    // SAFETY: Welkin passes NUL-terminated names.
    let name = unsafe { CStr::from_ptr(name) };
    match name.to_bytes() {
        b"glFlushMappedBufferRange" => flush_mapped as *const c_void,
        b"glBufferSubData" => buffer_sub_data as *const c_void,
        b"glClientWaitSync" => client_wait_sync as *const c_void,
        b"glGetSynciv" => get_sync as *const c_void,
        b"glFinish" => finish as *const c_void,
        b"glReadPixels" => read_pixels as *const c_void,
        _ if user.is_null() => proc_address(name),
        // SAFETY: the name is alive.
        _ => unsafe { get_proc(user, name.as_ptr()) },
    }
}

/// Requests a device. Returns the status, the message, the device and the time taken.
fn create(host: &Host, broken: Broken) -> (wk_status, String, *mut wk_device, Duration) {
    let shared = host.mode == GlMode::Shared;
    let desc = wk_opengl_host_desc {
        get_proc: Some(broken_proc),
        make_current: shared.then_some(make_current as _),
        user: (&raw const *host.contexts).cast_mut().cast(),
        mode: if shared { WK_OPENGL_SHARED } else { WK_OPENGL_HOST_CONTEXT },
        ..init("wk_opengl_host_desc")
    };
    BROKEN.set(broken);
    ENDLESS.set(0);
    let (begun, mut device) = (Instant::now(), null_mut());
    // SAFETY: the callbacks are those of the host, whose contexts outlive the device.
    let status = unsafe { wk_device_create_opengl(&desc, &mut device) };
    let text = if status == WK_OK { String::new() } else { message() };
    let took = begun.elapsed();
    assert!(host.contexts.host.is_current());
    // SAFETY: the host's context is current.
    assert_eq!(unsafe { host.gl.get_error() }, glow::NO_ERROR);
    (status, text, device, took)
}

/// The bits of 5.8e-6, with which a loop would practically never end.
const FLOAT_BITS: u32 = 918_728_397;

const HOSTS: [(Api, GlMode); 4] = [
    (Api::Core(4, 5), GlMode::Shared),
    (Api::Core(3, 3), GlMode::HostContext),
    (Api::Es(3, 1), GlMode::Shared),
    (Api::Compatibility(4, 5), GlMode::HostContext),
];

#[test]
fn a_driver_with_other_bytes_in_blocks_is_refused_by_name() {
    for (api, mode) in HOSTS {
        let host = Host::new(api, Window::None, mode);
        for word in [0, FLOAT_BITS] {
            let broken = Broken { mapped: Some(word), sub_data: Some(word), hangs: false };
            let (status, text, _, took) = create(&host, broken);
            assert_eq!(status, WK_ERROR_NO_ADAPTER, "{api:?} {mode:?} {word:x}: {text}");
            // SAFETY: the host's context is current.
            let renderer = unsafe { host.gl.get_parameter_string(glow::RENDERER) };
            for part in [&renderer[..8], "bytes", "WK_BACKEND_VULKAN", &format!("0x{word:08x}")] {
                assert!(text.contains(part), "{part}: {text}");
            }
            assert!(text.len() < 300 && took < Duration::from_secs(10), "{took:?} {text}");
        }
        // The context still works: with a driver without the fault a device is created.
        let (status, text, device, _) = create(&host, Broken::default());
        assert_eq!(status, WK_OK, "{text}");
        // SAFETY: a live handle.
        ok(unsafe { wk_device_destroy(device) });
    }
}

#[test]
fn where_mapped_memory_brings_other_bytes_the_other_way_draws_the_right_picture() {
    let wanted = own_picture(SIZE, 0.001, 1);
    for (api, mode) in [(Api::Core(4, 5), GlMode::Shared), (Api::Compatibility(4, 5), GlMode::HostContext)] {
        let host = Host::new(api, Window::None, mode);
        let color = image_of(texture(&host.gl, glow::RGBA8));
        let depth = image_of(texture(&host.gl, glow::DEPTH_COMPONENT32F));
        let fbo = framebuffer(&host.gl, color, Some(depth));
        let broken = Broken { mapped: Some(FLOAT_BITS), ..Broken::default() };
        let (status, text, device, _) = create(&host, broken);
        assert_eq!(status, WK_OK, "{text}");
        let scene = Scene::new(device);
        let _ = picture(&host, &scene, fbo, &target(color, depth), 0);
        let got = picture(&host, &scene, fbo, &target(color, depth), 1);
        assert_same(&got, &wanted, 3);
        scene.destroy();
        // SAFETY: a live handle.
        ok(unsafe { wk_device_destroy(device) });
    }
}

#[test]
fn a_driver_that_never_finishes_is_given_up() {
    for (api, mode) in [(Api::Core(4, 5), GlMode::Shared), (Api::Core(4, 5), GlMode::HostContext)] {
        let host = Host::new(api, Window::None, mode);
        let (status, text, _, took) = create(&host, Broken { hangs: true, ..Broken::default() });
        assert_eq!(status, WK_ERROR_NO_ADAPTER, "{text}");
        assert!(text.contains("did not finish") && text.contains("WK_BACKEND_VULKAN"), "{text}");
        assert!(took < Duration::from_secs(10), "{took:?}");
        assert_eq!(ENDLESS.get(), 0, "calls that would not have returned");
    }
}

/// A driver that passes the test of known answers and then hangs in the first table: the frame that needed the table
/// returns, and all objects can be destroyed.
#[test]
fn a_driver_that_hangs_in_the_first_table_loses_the_device_by_name() {
    let host = Host::new(Api::Core(4, 5), Window::None, GlMode::Shared);
    let color = image_of(texture(&host.gl, glow::RGBA8));
    let depth = image_of(texture(&host.gl, glow::DEPTH_COMPONENT32F));
    let (status, text, device, _) = create(&host, Broken::default());
    assert_eq!(status, WK_OK, "{text}");
    let scene = Scene::new(device);
    BROKEN.set(Broken { hangs: true, ..Broken::default() });
    let target = target(color, depth);
    let frame = |id| wk_frame { target: (&raw const target).cast(), ..frame(id) };
    // SAFETY: live handles.
    unsafe {
        assert_eq!(wk_view_record(scene.view, &frame(0), WK_STAGE_ALL), WK_ERROR_DEVICE_LOST, "{}", message());
        assert!(message().contains("first texel") && message().contains("WK_BACKEND_VULKAN"), "{}", message());
        assert_eq!(wk_view_record(scene.view, &frame(1), WK_STAGE_ALL), WK_ERROR_DEVICE_LOST, "{}", message());
        scene.destroy();
        ok(wk_device_destroy(device));
        assert_eq!(host.gl.get_error(), glow::NO_ERROR);
    }
    assert!(host.contexts.host.is_current());
    assert_eq!(ENDLESS.get(), 0, "calls that would not have returned");
}
