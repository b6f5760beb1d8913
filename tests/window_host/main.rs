//! Windows of Welkin's own devices by native handle: the X server shows what Welkin presents, and any event of the
//! window gives a status and never a crash.
#![cfg(target_os = "linux")]

mod capi;
mod held;
mod x11;

use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use welkin::Status;
use welkin::gpu::surface::{NativeWindow, Pacing, Surface, SurfaceEncoding, SurfaceOptions, device_for_window};
use welkin::gpu::{Device, DeviceOptions};
use x11::{Server, Window, X_ERRORS};

fn open(window: &NativeWindow, backends: wgpu::Backends) -> (std::sync::Arc<Device>, Surface) {
    let options = DeviceOptions { backends, ..DeviceOptions::default() };
    // SAFETY: the tests keep the window longer than device and surface.
    unsafe {
        let device = device_for_window(window, &options).unwrap_or_else(|e| panic!("{backends:?}: {e}"));
        let surface = Surface::new(&device, window).unwrap_or_else(|e| panic!("{backends:?}: {e}"));
        (device, surface)
    }
}

fn size(width: u32, height: u32) -> SurfaceOptions {
    SurfaceOptions { width, height, ..SurfaceOptions::default() }
}

/// Clears the next image to a colour and presents it.
fn show(device: &Device, surface: &mut Surface, colour: [f64; 3]) -> welkin::Result<()> {
    let texture = surface.acquire()?;
    assert!(texture.usage().contains(wgpu::TextureUsages::COPY_SRC), "effects read what is drawn so far");
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let mut encoder = device.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let [r, g, b] = colour;
    drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..Default::default()
    }));
    device.queue.submit([encoder.finish()]);
    surface.present()?;
    device.wait()
}

/// Checks that the pixel becomes the colour within a second: presenting is not synchronous.
fn assert_pixel(window: &Window, x: i32, y: i32, expected: [u8; 3]) {
    let start = Instant::now();
    loop {
        let got = window.pixel(x, y);
        if got.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 1) {
            return;
        }
        assert!(start.elapsed() < Duration::from_secs(1), "pixel ({x}, {y}) is {got:?}, expected {expected:?}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

const BACKENDS: [wgpu::Backends; 2] = [wgpu::Backends::VULKAN, wgpu::Backends::GL];

#[test]
fn what_is_presented_is_what_x_shows() {
    let server = Server::start();
    for backends in BACKENDS {
        for by_xcb in [false, true] {
            let window = Window::open(&server, 120, 80);
            let native = if by_xcb { window.xcb() } else { window.xlib() };
            let (device, mut surface) = open(&native, backends);
            assert_eq!(surface.acquire().unwrap_err().status, Status::WrongOrder);
            surface.configure(&size(120, 80)).unwrap();
            // Linear 0.5 is 188 when sRGB-encoded (IEC 61966-2-1).
            show(&device, &mut surface, [1.0, 0.5, 0.0]).unwrap();
            assert_pixel(&window, 60, 40, [255, 188, 0]);
            surface.configure(&SurfaceOptions { encoding: SurfaceEncoding::DisplaySrgb, ..size(120, 80) }).unwrap();
            show(&device, &mut surface, [0.0, 0.5, 1.0]).unwrap();
            assert_pixel(&window, 60, 40, [0, 128, 255]);
        }
    }
    assert_eq!(X_ERRORS.load(Ordering::SeqCst), 0);
}

#[test]
fn a_resized_window_is_filled_again() {
    let server = Server::start();
    for backends in BACKENDS {
        let window = Window::open(&server, 100, 60);
        let (device, mut surface) = open(&window.xlib(), backends);
        surface.configure(&SurfaceOptions { pacing: Pacing::Immediate, ..size(100, 60) }).unwrap();
        show(&device, &mut surface, [1.0, 0.0, 0.0]).unwrap();
        assert_pixel(&window, 99, 59, [255, 0, 0]);
        window.resize(300, 200);
        // The host may learn of the new size before or after the surface does; both orders must work.
        let mut outdated = false;
        for _ in 0..4 {
            match show(&device, &mut surface, [0.0, 1.0, 0.0]) {
                Ok(()) => {}
                Err(e) => {
                    assert_eq!(e.status, Status::SurfaceOutdated, "{backends:?}: {e}");
                    outdated = true;
                }
            }
        }
        // OpenGL stretches or crops without reporting it; Vulkan reports it.
        assert!(outdated || backends == wgpu::Backends::GL, "{backends:?} never said that the window changed");
        surface.configure(&size(300, 200)).unwrap();
        assert_eq!(surface.size(), (300, 200));
        for _ in 0..3 {
            show(&device, &mut surface, [0.0, 0.0, 1.0]).unwrap();
        }
        assert_pixel(&window, 299, 199, [0, 0, 255]);
        assert_pixel(&window, 0, 0, [0, 0, 255]);
    }
    assert_eq!(X_ERRORS.load(Ordering::SeqCst), 0);
}

#[test]
fn a_window_without_area_or_hidden_gives_a_status() {
    let server = Server::start();
    for backends in BACKENDS {
        let window = Window::open(&server, 100, 60);
        let (device, mut surface) = open(&window.xlib(), backends);
        surface.configure(&size(0, 0)).unwrap();
        let e = surface.acquire().unwrap_err();
        assert_eq!(e.status, Status::SurfaceOutdated);
        assert!(e.to_string().contains("0 x 0"), "{e}");
        assert_eq!(surface.present().unwrap_err().status, Status::WrongOrder);
        surface.configure(&size(100, 60)).unwrap();
        show(&device, &mut surface, [1.0, 0.0, 0.0]).unwrap();
        window.unmap();
        for _ in 0..3 {
            if let Err(e) = show(&device, &mut surface, [0.0, 1.0, 0.0]) {
                assert!(matches!(e.status, Status::Pending | Status::SurfaceOutdated), "{backends:?}: {e}");
            }
        }
        window.map();
        surface.configure(&size(100, 60)).unwrap();
        show(&device, &mut surface, [0.0, 0.0, 1.0]).unwrap();
        assert_pixel(&window, 50, 30, [0, 0, 255]);
        // An acquired image does not prevent a new configuration.
        surface.acquire().unwrap();
        surface.configure(&size(100, 60)).unwrap();
        show(&device, &mut surface, [0.0, 1.0, 0.0]).unwrap();
        assert_pixel(&window, 50, 30, [0, 255, 0]);
        let e = surface.configure(&size(1 << 20, 60)).unwrap_err();
        assert_eq!(e.status, Status::InvalidArgument);
        assert!(e.to_string().starts_with("width"), "{e}");
    }
    assert_eq!(X_ERRORS.load(Ordering::SeqCst), 0);
}

#[test]
fn a_destroyed_window_gives_a_status() {
    let server = Server::start();
    for backends in BACKENDS {
        let mut window = Window::open(&server, 100, 60);
        let other = window.another(50, 50);
        let (device, mut surface) = open(&window.xlib(), backends);
        surface.configure(&size(100, 60)).unwrap();
        show(&device, &mut surface, [1.0, 0.0, 0.0]).unwrap();
        window.destroy();
        let mut outdated = 0;
        for _ in 0..4 {
            let drawn = show(&device, &mut surface, [0.0, 1.0, 0.0]);
            let configured = surface.configure(&size(100, 60));
            for answer in [drawn, configured] {
                let Err(e) = answer else { continue };
                assert_eq!(e.status, Status::SurfaceOutdated, "{backends:?}: {e}");
                outdated += 1;
            }
        }
        // The software OpenGL driver draws on as if nothing had happened until the surface is configured again.
        assert!(outdated >= 7, "{backends:?}: {outdated} of 8 answers");
        drop(surface);
        // The device still works: it can draw to another window. SAFETY: the window outlives the surface.
        let mut surface = unsafe { Surface::new(&device, &other.xlib()).unwrap() };
        surface.configure(&size(50, 50)).unwrap();
        show(&device, &mut surface, [0.0, 0.0, 1.0]).unwrap();
        assert_pixel(&other, 25, 25, [0, 0, 255]);
        drop(surface);

        let NativeWindow::Xlib { display, screen, .. } = other.xlib() else { unreachable!() };
        let never = NativeWindow::Xlib { display, screen, window: 0x00ab_cdef };
        // SAFETY: the window does not exist, and Welkin finds that before a driver uses it.
        let e = unsafe { Surface::new(&device, &never) }.expect_err("there is no such window");
        assert_eq!(e.status, Status::SurfaceOutdated, "{backends:?}: {e}");
        let options = DeviceOptions { backends, ..DeviceOptions::default() };
        // SAFETY: as above.
        let e = unsafe { device_for_window(&never, &options) }.err().expect("there is no such window");
        assert_eq!(e.status, Status::SurfaceOutdated, "{backends:?}: {e}");
    }
    assert_eq!(X_ERRORS.load(Ordering::SeqCst), 0);
}
