//! A small X11 host: its own server without a screen, a window, and the window's pixels as X sees them.

use std::ffi::{CString, c_char, c_int, c_uint, c_ulong, c_void};
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

use welkin::gpu::surface::NativeWindow;

#[link(name = "X11")]
unsafe extern "C" {
    fn XInitThreads() -> c_int;
    fn XOpenDisplay(name: *const c_char) -> *mut c_void;
    fn XCloseDisplay(d: *mut c_void) -> c_int;
    fn XDefaultScreen(d: *mut c_void) -> c_int;
    fn XRootWindow(d: *mut c_void, screen: c_int) -> c_ulong;
    fn XCreateSimpleWindow(
        d: *mut c_void,
        parent: c_ulong,
        x: c_int,
        y: c_int,
        width: c_uint,
        height: c_uint,
        border_width: c_uint,
        border: c_ulong,
        background: c_ulong,
    ) -> c_ulong;
    fn XMapWindow(d: *mut c_void, w: c_ulong) -> c_int;
    fn XUnmapWindow(d: *mut c_void, w: c_ulong) -> c_int;
    fn XResizeWindow(d: *mut c_void, w: c_ulong, width: c_uint, height: c_uint) -> c_int;
    fn XDestroyWindow(d: *mut c_void, w: c_ulong) -> c_int;
    fn XSync(d: *mut c_void, discard: c_int) -> c_int;
    fn XGetImage(
        d: *mut c_void,
        w: c_ulong,
        x: c_int,
        y: c_int,
        width: c_uint,
        height: c_uint,
        planes: c_ulong,
        format: c_int,
    ) -> *mut c_void;
    fn XGetPixel(image: *mut c_void, x: c_int, y: c_int) -> c_ulong;
    fn XDestroyImage(image: *mut c_void) -> c_int;
    fn XSetErrorHandler(handler: extern "C" fn(*mut c_void, *mut c_void) -> c_int) -> *mut c_void;
}

#[link(name = "xcb")]
unsafe extern "C" {
    fn xcb_connect(name: *const c_char, screen: *mut c_int) -> *mut c_void;
    fn xcb_disconnect(connection: *mut c_void);
}

/// X errors that reached the process: the default handler would have ended it.
pub static X_ERRORS: AtomicU32 = AtomicU32::new(0);

extern "C" fn count_error(_: *mut c_void, _: *mut c_void) -> c_int {
    X_ERRORS.fetch_add(1, Ordering::SeqCst);
    0
}

/// An X server without a screen, which ends when the value is dropped.
pub struct Server {
    child: Child,
    pub name: String,
}

impl Server {
    pub fn start() -> Self {
        let mut child = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "640x480x24", "-nolisten", "tcp", "-noreset"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb is installed");
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        Self { child, name: format!(":{}", line.trim()) }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A window of the host on its own connection.
pub struct Window {
    display: *mut c_void,
    xcb: *mut c_void,
    id: c_ulong,
    destroyed: bool,
    owns_connection: bool,
}

impl Window {
    pub fn open(server: &Server, width: u32, height: u32) -> Self {
        let name = CString::new(server.name.as_str()).unwrap();
        // SAFETY: plain Xlib and XCB by their rules.
        unsafe {
            XInitThreads();
            let display = XOpenDisplay(name.as_ptr());
            assert!(!display.is_null(), "the X server answers");
            XSetErrorHandler(count_error);
            let xcb = xcb_connect(name.as_ptr(), std::ptr::null_mut());
            let id = Self::make(display, width, height);
            Self { display, xcb, id, destroyed: false, owns_connection: true }
        }
    }

    /// Another window on the same connection.
    pub fn another(&self, width: u32, height: u32) -> Self {
        // SAFETY: the connection is live.
        let id = unsafe { Self::make(self.display, width, height) };
        Self { display: self.display, xcb: self.xcb, id, destroyed: false, owns_connection: false }
    }

    /// # Safety
    /// The connection is live.
    unsafe fn make(display: *mut c_void, width: u32, height: u32) -> c_ulong {
        // SAFETY: plain Xlib by its rules.
        unsafe {
            let root = XRootWindow(display, XDefaultScreen(display));
            let id = XCreateSimpleWindow(display, root, 0, 0, width, height, 0, 0, 0x0040_4040);
            XMapWindow(display, id);
            XSync(display, 0);
            id
        }
    }

    pub fn xlib(&self) -> NativeWindow {
        NativeWindow::Xlib { display: self.display, screen: 0, window: self.id }
    }

    pub fn xcb(&self) -> NativeWindow {
        NativeWindow::Xcb { connection: self.xcb, screen: 0, window: u32::try_from(self.id).unwrap() }
    }

    pub fn resize(&self, width: u32, height: u32) {
        // SAFETY: plain Xlib by its rules.
        unsafe {
            XResizeWindow(self.display, self.id, width, height);
            XSync(self.display, 0);
        }
    }

    pub fn unmap(&self) {
        // SAFETY: plain Xlib by its rules.
        unsafe {
            XUnmapWindow(self.display, self.id);
            XSync(self.display, 0);
        }
    }

    pub fn map(&self) {
        // SAFETY: plain Xlib by its rules.
        unsafe {
            XMapWindow(self.display, self.id);
            XSync(self.display, 0);
        }
    }

    pub fn destroy(&mut self) {
        // SAFETY: plain Xlib by its rules.
        unsafe {
            XDestroyWindow(self.display, self.id);
            XSync(self.display, 0);
        }
        self.destroyed = true;
    }

    /// One pixel (red, green, blue) as the X server has it.
    pub fn pixel(&self, x: i32, y: i32) -> [u8; 3] {
        const Z_PIXMAP: c_int = 2;
        // SAFETY: plain Xlib by its rules; the pixel is inside of the window.
        unsafe {
            XSync(self.display, 0);
            let image = XGetImage(self.display, self.id, x, y, 1, 1, c_ulong::MAX, Z_PIXMAP);
            assert!(!image.is_null(), "the window has pixels");
            let [blue, green, red, ..] = XGetPixel(image, 0, 0).to_le_bytes();
            XDestroyImage(image);
            [red, green, blue]
        }
    }
}

impl Drop for Window {
    fn drop(&mut self) {
        if !self.destroyed {
            self.destroy();
        }
        if !self.owns_connection {
            return;
        }
        // SAFETY: plain Xlib and XCB by their rules.
        unsafe {
            xcb_disconnect(self.xcb);
            XCloseDisplay(self.display);
        }
    }
}
