//! A window through the C functions: each event of the window gives a status, and the same device, context and view can
//! draw afterwards.

use std::ptr::{null, null_mut};
use std::sync::atomic::Ordering;

use welkin::capi::{abi, context::*, device::*, frame::*, status::*, surface::*, view::*};
use welkin::gpu::surface::NativeWindow;
use welkin_support::refusals;

use crate::x11::{Server, Window, X_ERRORS};

/// The thread's last message; also checks that its field is in the header.
fn message() -> String {
    assert_eq!(refusals::field_fault(), None);
    refusals::message()
}

#[track_caller]
fn ok(status: wk_status) {
    assert_eq!(status, WK_OK, "{}", message());
}

fn init<T>(name: &str) -> T {
    let mut bytes = vec![0_u64; size_of::<T>().div_ceil(8)];
    ok(abi::init(name, &mut bytes, size_of::<T>() as u32));
    // SAFETY: `bytes` holds a `T`, for which every bit pattern is valid.
    unsafe { bytes.as_ptr().cast::<T>().read() }
}

fn named(window: &Window) -> wk_window {
    let NativeWindow::Xlib { display, screen, window } = window.xlib() else { unreachable!() };
    wk_window { kind: WK_WINDOW_XLIB, display, screen, id: window, ..init("wk_window") }
}

fn record(view: *mut wk_view, surface: *mut wk_surface, frame_id: u64) -> wk_status {
    let target = wk_own_target { surface, ..init("wk_own_target") };
    let frame = wk_frame {
        frame_id,
        color_space: WK_COLOR_DISPLAY_LINEAR,
        target: (&raw const target).cast(),
        ..init("wk_frame")
    };
    // SAFETY: live handles.
    unsafe { wk_view_record(view, &frame, WK_STAGE_ALL) }
}

/// Draws one frame as a host does; returns the first status that is not WK_OK.
fn draw(view: *mut wk_view, surface: *mut wk_surface, frame_id: u64) -> wk_status {
    // SAFETY: live handles.
    unsafe {
        let calls: [&dyn Fn() -> wk_status; 3] =
            [&|| wk_surface_acquire(surface), &|| record(view, surface, frame_id), &|| wk_surface_present(surface)];
        calls.into_iter().map(|call| call()).find(|status| *status != WK_OK).unwrap_or(WK_OK)
    }
}

fn configure(surface: *mut wk_surface, width: u32, height: u32) -> wk_status {
    let config = wk_surface_config { width, height, pacing: WK_PACING_IMMEDIATE, ..init("wk_surface_config") };
    // SAFETY: a live handle.
    unsafe { wk_surface_configure(surface, &config) }
}

/// Draws until a frame is shown, which must be within a few: right after a change of the window the first ones may be
/// refused.
#[track_caller]
fn shows_again(view: *mut wk_view, surface: *mut wk_surface, size: (u32, u32), id: &mut u64) {
    for _ in 0..5 {
        *id += 1;
        match draw(view, surface, *id) {
            WK_OK => return,
            WK_ERROR_SURFACE_OUTDATED => ok(configure(surface, size.0, size.1)),
            other => panic!("{other}: {}", message()),
        }
    }
    panic!("the window shows nothing any more: {}", message());
}

#[test]
fn a_c_host_lives_through_its_windows_changes() {
    let server = Server::start();
    for backends in [WK_BACKEND_VULKAN, WK_BACKEND_GL] {
        let mut window = Window::open(&server, 120, 80);
        let other = window.another(60, 50);
        let desc = wk_device_desc { backends, ..init("wk_device_desc") };
        let (mut device, mut context, mut view, mut surface) = (null_mut(), null_mut(), null_mut(), null_mut());
        // SAFETY: live pointers; the windows outlive their surfaces except where the test says otherwise.
        unsafe {
            ok(wk_device_create_for_window(&desc, &named(&window), &mut device));
            ok(wk_surface_create(device, &named(&window), &mut surface));
            ok(wk_context_create(device, null(), &mut context));
            ok(wk_view_create(context, null(), &mut view));
            assert_eq!(wk_surface_acquire(surface), WK_ERROR_WRONG_ORDER, "{}", message());
        }
        let mut id = 0;
        ok(configure(surface, 120, 80));
        shows_again(view, surface, (120, 80), &mut id);

        // The window is resized.
        window.resize(200, 150);
        let mut outdated = false;
        for _ in 0..4 {
            id += 1;
            let status = draw(view, surface, id);
            assert!(matches!(status, WK_OK | WK_ERROR_SURFACE_OUTDATED), "{status}: {}", message());
            outdated |= status == WK_ERROR_SURFACE_OUTDATED;
        }
        // OpenGL stretches or crops without reporting it.
        assert!(outdated || backends == WK_BACKEND_GL, "nobody said that the window changed");
        ok(configure(surface, 200, 150));
        shows_again(view, surface, (200, 150), &mut id);

        // Minimised: a size of 0 is accepted.
        ok(configure(surface, 0, 0));
        id += 1;
        assert_eq!(draw(view, surface, id), WK_ERROR_SURFACE_OUTDATED, "{}", message());
        assert!(message().contains("0 x 0"), "{}", message());
        // SAFETY: a live handle.
        assert_eq!(unsafe { wk_surface_present(surface) }, WK_ERROR_WRONG_ORDER, "{}", message());
        ok(configure(surface, 200, 150));
        shows_again(view, surface, (200, 150), &mut id);

        // A size beyond the device's limit is refused by name, and the surface keeps its configuration.
        assert_eq!(configure(surface, 1 << 20, 150), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("config.width must be in [0, "), "{}", message());
        shows_again(view, surface, (200, 150), &mut id);

        // The window is destroyed while an image is acquired. SAFETY: a live handle.
        ok(unsafe { wk_surface_acquire(surface) });
        window.destroy();
        let mut outdated = 0;
        for _ in 0..4 {
            id += 1;
            for status in [draw(view, surface, id), configure(surface, 200, 150)] {
                assert!(matches!(status, WK_OK | WK_ERROR_SURFACE_OUTDATED), "{status}: {}", message());
                outdated += u32::from(status == WK_ERROR_SURFACE_OUTDATED);
            }
        }
        assert!(outdated >= 6, "{outdated} of 8 answers");
        // SAFETY: live handles; the other window is live.
        unsafe {
            ok(wk_surface_destroy(surface));
            ok(wk_device_get_status(device));
            let gone = wk_surface_create(device, &named(&window), &mut surface);
            assert_eq!(gone, WK_ERROR_SURFACE_OUTDATED, "{}", message());
            ok(wk_surface_create(device, &named(&other), &mut surface));
        }
        // The same view draws into another window.
        ok(configure(surface, 60, 50));
        shows_again(view, surface, (60, 50), &mut id);
        // The device is lost while an image is acquired: every call reports it, and all objects can be destroyed.
        // SAFETY: live handles.
        unsafe {
            id += 1;
            ok(wk_surface_acquire(surface));
            ok(record(view, surface, id));
            abi::lose_in_next_call();
            assert_eq!(wk_device_get_status(device), WK_ERROR_DEVICE_LOST);
            id += 1;
            assert_eq!(draw(view, surface, id), WK_ERROR_DEVICE_LOST, "{}", message());
            assert_eq!(wk_surface_present(surface), WK_ERROR_DEVICE_LOST, "{}", message());
            assert_eq!(configure(surface, 60, 50), WK_ERROR_DEVICE_LOST, "{}", message());
            let mut another = null_mut();
            assert_eq!(wk_surface_create(device, &named(&other), &mut another), WK_ERROR_DEVICE_LOST, "{}", message());
            assert!(another.is_null());
        }
        // SAFETY: live handles.
        unsafe {
            ok(wk_surface_destroy(surface));
            ok(wk_view_destroy(view));
            ok(wk_context_destroy(context));
            ok(wk_device_destroy(device));
            // A new device presents to the same window.
            ok(wk_device_create_for_window(&desc, &named(&other), &mut device));
            ok(wk_surface_create(device, &named(&other), &mut surface));
            ok(wk_context_create(device, null(), &mut context));
            ok(wk_view_create(context, null(), &mut view));
            ok(configure(surface, 60, 50));
        }
        shows_again(view, surface, (60, 50), &mut id);
        // SAFETY: live handles.
        unsafe {
            ok(wk_surface_destroy(surface));
            ok(wk_view_destroy(view));
            ok(wk_context_destroy(context));
            ok(wk_device_destroy(device));
        }
    }
    assert_eq!(X_ERRORS.load(Ordering::SeqCst), 0);
}
