//! Tests of window handles and formats that need no window.

use super::*;

#[test]
fn null_handles_are_refused_by_name() {
    let null = std::ptr::null_mut();
    let some = std::ptr::dangling_mut::<u64>().cast::<c_void>();
    let cases = [
        (NativeWindow::Xlib { display: null, screen: 0, window: 1 }, "display"),
        (NativeWindow::Xlib { display: some, screen: 0, window: 0 }, "window"),
        (NativeWindow::Xcb { connection: null, screen: 0, window: 1 }, "connection"),
        (NativeWindow::Xcb { connection: some, screen: 0, window: 0 }, "window"),
        (NativeWindow::Wayland { display: null, surface: some }, "display"),
        (NativeWindow::Wayland { display: some, surface: null }, "surface"),
        (NativeWindow::Win32 { hwnd: null, hinstance: some }, "hwnd"),
        (NativeWindow::Win32 { hwnd: some, hinstance: null }, "hinstance"),
        (NativeWindow::AppKit { ns_view: null }, "ns_view"),
    ];
    for (window, name) in cases {
        // SAFETY: the null handle is found before anything is used.
        let e = unsafe { device_for_window(&window, &DeviceOptions::default()) }.err().expect("refused");
        assert_eq!(e.status, Status::InvalidArgument);
        assert!(e.to_string().starts_with(name), "{}", e);
    }
}

#[test]
fn the_format_follows_the_encoding_in_the_windows_order() {
    use wgpu::TextureFormat as F;
    let offered = [F::Rgba16Float, F::Bgra8Unorm, F::Rgba8UnormSrgb, F::Bgra8UnormSrgb];
    assert_eq!(choose_format(&offered, SurfaceEncoding::DisplayLinear).unwrap(), F::Rgba8UnormSrgb);
    assert_eq!(choose_format(&offered, SurfaceEncoding::DisplaySrgb).unwrap(), F::Bgra8Unorm);
    let e = choose_format(&[F::Rgba16Float], SurfaceEncoding::DisplayLinear).unwrap_err();
    assert_eq!(e.status, Status::Unsupported);
}
