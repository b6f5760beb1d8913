//! Several windows whose contexts share objects, served by one device: after a call the context of the calling window
//! is current again, with one thread or one for each window; a host whose callback selects another window gets an
//! error.

use std::{
    cell::Cell,
    ffi::c_void,
    ptr::null_mut,
    sync::atomic::{AtomicU32, Ordering},
};

use glow::HasContext;
use welkin::capi::{device::*, frame::*, opengl::*, status::*, view::*};
use welkin_support::{
    c_scene::{Scene, init, message, ok},
    egl::{Api, Context, Window, function, make_none_current},
    refusals::field,
};

use crate::{
    SIZE,
    capi::target,
    frame,
    host::get_proc,
    images::{framebuffer, image_of, texture},
};

thread_local! {
    /// The window that this thread draws in.
    static HERE: Cell<usize> = const { Cell::new(0) };
}

struct Windows {
    contexts: [Context; 2],
    welkin: Context,
    /// Window that the callback makes current whatever the thread draws in, if not u32::MAX.
    stubborn: AtomicU32,
    switches: AtomicU32,
}

unsafe extern "C" fn make_current(user: *mut c_void, which: u32) -> i32 {
    // SAFETY: `user` is what `device` passed.
    let windows = unsafe { &*user.cast::<Windows>() };
    windows.switches.fetch_add(1, Ordering::Relaxed);
    let stubborn = windows.stubborn.load(Ordering::Relaxed);
    let context = match (which, stubborn) {
        (0, u32::MAX) => &windows.contexts[HERE.get()],
        (0, stubborn) => &windows.contexts[stubborn as usize],
        _ => &windows.welkin,
    };
    if context.make_current() { 0 } else { -1 }
}

impl Windows {
    fn new() -> Box<Self> {
        let first = Context::new(Api::Core(3, 3), Window::Pbuffer(64, 48, 0));
        let (second, welkin) = (first.sharing(), first.sharing());
        let (stubborn, switches) = (AtomicU32::new(u32::MAX), AtomicU32::new(0));
        Box::new(Self { contexts: [first, second], welkin, stubborn, switches })
    }

    fn enter(&self, window: usize) {
        HERE.set(window);
        assert!(self.contexts[window].make_current());
    }

    fn device(&self) -> *mut wk_device {
        let desc = wk_opengl_host_desc {
            get_proc: Some(get_proc),
            make_current: Some(make_current),
            user: std::ptr::from_ref(self).cast_mut().cast(),
            ..init("wk_opengl_host_desc")
        };
        let mut device = null_mut();
        // SAFETY: the callbacks are those of this file, the contexts outlive the device.
        ok(unsafe { wk_device_create_opengl(&desc, &mut device) });
        device
    }
}

/// Framebuffer of one window, with the window's own functions.
struct Canvas {
    gl: glow::Context,
    fbo: glow::Framebuffer,
    target: wk_opengl_target,
}

impl Canvas {
    /// Creates the textures and the framebuffer that frames are drawn into. The window's context must be current.
    fn new(context: &Context) -> Self {
        let gl = context.functions();
        let (color, depth) = (image_of(texture(&gl, glow::RGBA8)), image_of(texture(&gl, glow::DEPTH_COMPONENT32F)));
        let fbo = framebuffer(&gl, color, Some(depth));
        Self { gl, fbo, target: target(color, depth) }
    }

    /// Clears with `blue`, records, and returns the status and the picture.
    fn draw(&self, scene: &Scene, id: u64, blue: f32) -> (wk_status, Vec<[u8; 4]>) {
        let frame = wk_frame { target: (&raw const self.target).cast(), ..frame(id) };
        let mut pixels = vec![[0_u8; 4]; (SIZE.0 * SIZE.1) as usize];
        // SAFETY: the window's context is current, the handles live.
        unsafe {
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.fbo));
            self.gl.clear_color(0.0, 0.0, blue, 1.0);
            self.gl.clear_depth_f32(0.001);
            self.gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
            let status = wk_view_record(scene.view, &frame, WK_STAGE_ALL);
            let room = glow::PixelPackData::Slice(Some(pixels.as_flattened_mut()));
            self.gl.read_pixels(0, 0, SIZE.0 as i32, SIZE.1 as i32, glow::RGBA, glow::UNSIGNED_BYTE, room);
            (status, pixels)
        }
    }
}

#[test]
fn calls_come_back_to_the_window_that_they_came_from() {
    let windows = Windows::new();
    windows.enter(0);
    let device = windows.device();
    let scenes = [Scene::new(device), Scene::new(device)];
    let canvases = [0, 1].map(|i| {
        windows.enter(i);
        Canvas::new(&windows.contexts[i])
    });
    let mut first = None;
    for round in 0..3 {
        for i in [0, 1] {
            windows.enter(i);
            let (status, picture) = canvases[i].draw(&scenes[i], round, 0.5);
            assert_eq!(status, WK_OK, "{}", message());
            assert!(windows.contexts[i].is_current(), "window {i}");
            assert!(picture.iter().any(|p| p[0] > 20), "drawn");
            if round == 2 {
                assert_eq!(first.get_or_insert(picture.clone()), &picture, "both windows show one weather");
            }
        }
    }
    // Calls from one window need two switches each, no more.
    let before = windows.switches.load(Ordering::Relaxed);
    assert_eq!(canvases[1].draw(&scenes[1], 9, 0.5).0, WK_OK);
    assert_eq!(windows.switches.load(Ordering::Relaxed) - before, 2);
    // A host whose callback always selects the first window: the first call from the second window gives the error and
    // draws nothing.
    windows.stubborn.store(0, Ordering::Relaxed);
    windows.enter(0);
    assert_eq!(canvases[0].draw(&scenes[0], 10, 0.5).0, WK_OK, "{}", message());
    windows.enter(1);
    let (status, _) = canvases[1].draw(&scenes[1], 11, 0.5);
    assert_eq!(status, WK_ERROR_WRONG_ORDER);
    let wanted = "make_current must, asked for WK_OPENGL_CONTEXT_HOST, make the context current that was current";
    assert!(message().contains(wanted), "{}", message());
    assert_eq!(field(), "make_current");
    // If the callback selects another window during a call, that call gives the error as well.
    windows.stubborn.store(u32::MAX, Ordering::Relaxed);
    windows.enter(0);
    assert_eq!(canvases[0].draw(&scenes[0], 12, 0.5).0, WK_OK, "{}", message());
    windows.stubborn.store(1, Ordering::Relaxed);
    assert_eq!(canvases[0].draw(&scenes[0], 13, 0.5).0, WK_ERROR_WRONG_ORDER);
    assert!(windows.contexts[1].is_current() && message().contains("another window's"), "{}", message());
    // Later calls succeed again once the callback is right.
    windows.stubborn.store(u32::MAX, Ordering::Relaxed);
    windows.enter(0);
    assert_eq!(canvases[0].draw(&scenes[0], 14, 0.5).0, WK_OK, "{}", message());
    scenes.into_iter().for_each(Scene::destroy);
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
    // No object of Welkin's stays in the window in which the device was created and destroyed. SAFETY: the type is that
    // of every `glIs..`; any name may be queried.
    let arrays = unsafe {
        let is: unsafe extern "system" fn(u32) -> u8 = function("glIsVertexArray");
        (1..100).filter(|n| is(*n) != 0).count()
    };
    assert_eq!(arrays, 0);
}

#[test]
fn each_window_may_have_a_thread_of_its_own() {
    let windows = Windows::new();
    windows.enter(0);
    let device = windows.device();
    let scenes = [Scene::new(device), Scene::new(device)];
    make_none_current();
    let wanted = std::sync::Mutex::new(None);
    std::thread::scope(|scope| {
        for (i, scene) in scenes.iter().enumerate() {
            let (windows, wanted, scene) = (&windows, &wanted, SendScene(scene));
            scope.spawn(move || {
                let scene = scene.get();
                windows.enter(i);
                let canvas = Canvas::new(&windows.contexts[i]);
                for id in 0..20 {
                    let (status, picture) = canvas.draw(scene, id, 0.5);
                    assert_eq!(status, WK_OK, "{}", message());
                    assert!(windows.contexts[i].is_current(), "window {i} at frame {id}");
                    if id == 19 {
                        assert_eq!(wanted.lock().unwrap().get_or_insert(picture.clone()), &picture);
                    }
                }
                make_none_current();
            });
        }
    });
    windows.enter(0);
    scenes.into_iter().for_each(Scene::destroy);
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
}

/// Handles may be used from any thread, one at a time.
struct SendScene<'a>(&'a Scene);
// SAFETY: the handles are numbers in the form of pointers.
unsafe impl Send for SendScene<'_> {}

impl<'a> SendScene<'a> {
    fn get(self) -> &'a Scene {
        self.0
    }
}
