//! OpenGL contexts for the tests, created as by a host without a window: EGL without a surface or on a pbuffer.

use std::{
    ffi::{CStr, CString, c_char, c_int, c_void},
    ptr::{null, null_mut},
    sync::OnceLock,
};

use glow::HasContext;

unsafe extern "C" {
    fn dlopen(name: *const c_char, flags: c_int) -> *mut c_void;
    fn dlsym(library: *mut c_void, name: *const c_char) -> *mut c_void;
}

type Ptr = *const c_void;

/// The OpenGL version of a context.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Api {
    Core(i32, i32),
    Compatibility(i32, i32),
    Es(i32, i32),
}

/// The drawable that comes with a context.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Window {
    /// No default framebuffer.
    None,
    /// A pbuffer of this size and sample count, with depth and stencil.
    Pbuffer(i32, i32, i32),
}

struct Egl {
    display: Ptr,
    get_proc: unsafe extern "C" fn(*const c_char) -> Ptr,
    bind_api: unsafe extern "C" fn(u32) -> u32,
    choose_config: unsafe extern "C" fn(Ptr, *const i32, *mut Ptr, i32, *mut i32) -> u32,
    create_context: unsafe extern "C" fn(Ptr, Ptr, Ptr, *const i32) -> Ptr,
    destroy_context: unsafe extern "C" fn(Ptr, Ptr) -> u32,
    create_pbuffer: unsafe extern "C" fn(Ptr, Ptr, *const i32) -> Ptr,
    destroy_surface: unsafe extern "C" fn(Ptr, Ptr) -> u32,
    make_current: unsafe extern "C" fn(Ptr, Ptr, Ptr, Ptr) -> u32,
    get_current: unsafe extern "C" fn() -> Ptr,
}

// SAFETY: EGL's own functions may be called from any thread.
unsafe impl Send for Egl {}
// SAFETY: as above.
unsafe impl Sync for Egl {}

const EGL_OPENGL_ES_API: u32 = 0x30A0;
const EGL_OPENGL_API: u32 = 0x30A2;
const EGL_PLATFORM_SURFACELESS_MESA: u32 = 0x31DD;
const EGL_PLATFORM_DEVICE_EXT: u32 = 0x313F;

/// The EGL device with this number.
///
/// # Safety
/// `get_proc` is `eglGetProcAddress`.
unsafe fn device(get_proc: unsafe extern "C" fn(*const c_char) -> Ptr, number: usize) -> *mut c_void {
    type Query = unsafe extern "C" fn(i32, *mut *mut c_void, *mut i32) -> u32;
    let (mut devices, mut count) = ([null_mut(); 16], 0);
    // SAFETY: the extension's own function, with room for as many devices as are asked for.
    unsafe {
        let query = get_proc(c"eglQueryDevicesEXT".as_ptr());
        assert!(!query.is_null(), "EGL_EXT_device_enumeration");
        std::mem::transmute::<Ptr, Query>(query)(16, devices.as_mut_ptr(), &mut count);
    }
    assert!(number < count.max(0) as usize, "there are {count} EGL devices");
    devices[number]
}

fn egl() -> &'static Egl {
    static EGL: OnceLock<Egl> = OnceLock::new();
    EGL.get_or_init(|| {
        // SAFETY: the functions are EGL's and have EGL's signatures; the library is never unloaded.
        unsafe {
            let library = dlopen(c"libEGL.so.1".as_ptr(), 2);
            assert!(!library.is_null(), "libEGL.so.1 must be installed for these tests");
            let get_platform_display: unsafe extern "C" fn(u32, *mut c_void, *const isize) -> Ptr =
                symbol(library, c"eglGetPlatformDisplay");
            let initialize: unsafe extern "C" fn(Ptr, *mut i32, *mut i32) -> u32 = symbol(library, c"eglInitialize");
            let get_proc: unsafe extern "C" fn(*const c_char) -> Ptr = symbol(library, c"eglGetProcAddress");
            // Without a display server, a GPU's driver is opened by its device number.
            let display = match std::env::var("WELKIN_EGL_DEVICE") {
                Ok(number) => {
                    let device = device(get_proc, number.parse().expect("WELKIN_EGL_DEVICE is a number"));
                    get_platform_display(EGL_PLATFORM_DEVICE_EXT, device, null())
                }
                Err(_) => get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, null_mut(), null()),
            };
            assert_eq!(initialize(display, null_mut(), null_mut()), 1, "EGL must open without a display server");
            Egl {
                display,
                get_proc,
                bind_api: symbol(library, c"eglBindAPI"),
                choose_config: symbol(library, c"eglChooseConfig"),
                create_context: symbol(library, c"eglCreateContext"),
                destroy_context: symbol(library, c"eglDestroyContext"),
                create_pbuffer: symbol(library, c"eglCreatePbufferSurface"),
                destroy_surface: symbol(library, c"eglDestroySurface"),
                make_current: symbol(library, c"eglMakeCurrent"),
                get_current: symbol(library, c"eglGetCurrentContext"),
            }
        }
    })
}

/// A context with its drawable.
pub struct Context {
    raw: Ptr,
    surface: Ptr,
    config: Ptr,
    api: Api,
}

// SAFETY: an EGL context may be current on any one thread.
unsafe impl Send for Context {}
// SAFETY: as above; the tests make sure that it is only one.
unsafe impl Sync for Context {}

impl Context {
    pub fn new(api: Api, window: Window) -> Self {
        let renderable = if matches!(api, Api::Es(..)) { 0x40 } else { 0x08 };
        let (surfaces, depth, samples) = match window {
            Window::None => (1, 0, 0),
            Window::Pbuffer(_, _, samples) => (1, 24, samples),
        };
        let attributes = [
            0x3033,
            surfaces, // EGL_SURFACE_TYPE: pbuffer
            0x3040,
            renderable, // EGL_RENDERABLE_TYPE
            0x3024,
            8,
            0x3023,
            8,
            0x3022,
            8,
            0x3021,
            8, // 8 bits per channel
            0x3025,
            depth,
            0x3026,
            if depth > 0 { 8 } else { 0 }, // depth and stencil
            0x3031,
            samples, // EGL_SAMPLES
            0x3038,
        ];
        let (mut config, mut count) = (null(), 0);
        // SAFETY: room for one configuration is given.
        unsafe { (egl().choose_config)(egl().display, attributes.as_ptr(), &mut config, 1, &mut count) };
        assert_eq!(count, 1, "no EGL configuration for {api:?} with {window:?}");
        Self::with_config(api, config, window, null())
    }

    fn with_config(api: Api, config: Ptr, window: Window, share: Ptr) -> Self {
        let (name, (major, minor), profile) = match api {
            Api::Core(a, b) => (EGL_OPENGL_API, (a, b), Some(1)),
            Api::Compatibility(a, b) => (EGL_OPENGL_API, (a, b), Some(2)),
            Api::Es(a, b) => (EGL_OPENGL_ES_API, (a, b), None),
        };
        let mut attributes = vec![0x3098, major, 0x30FB, minor];
        if let Some(profile) = profile {
            attributes.extend([0x30FD, profile]);
        }
        attributes.push(0x3038);
        // SAFETY: handles are EGL's own, lists end in EGL_NONE.
        unsafe {
            (egl().bind_api)(name);
            let raw = (egl().create_context)(egl().display, config, share, attributes.as_ptr());
            assert!(!raw.is_null(), "EGL makes no context for {api:?}");
            let surface = match window {
                Window::None => null(),
                Window::Pbuffer(width, height, _) => {
                    let size = [0x3057, width, 0x3056, height, 0x3038];
                    (egl().create_pbuffer)(egl().display, config, size.as_ptr())
                }
            };
            Self { raw, surface, config, api }
        }
    }

    /// Creates another context of the same kind that shares this one's objects.
    pub fn sharing(&self) -> Self {
        Self::with_config(self.api, self.config, Window::None, self.raw)
    }

    /// Creates another context of the same kind that shares nothing.
    pub fn separate(&self) -> Self {
        Self::with_config(self.api, self.config, Window::None, null())
    }

    pub fn make_current(&self) -> bool {
        // SAFETY: handles are EGL's own. The API is per thread.
        unsafe {
            (egl().bind_api)(if matches!(self.api, Api::Es(..)) { EGL_OPENGL_ES_API } else { EGL_OPENGL_API });
            (egl().make_current)(egl().display, self.surface, self.surface, self.raw) == 1
        }
    }

    pub fn is_current(&self) -> bool {
        // SAFETY: no arguments.
        unsafe { (egl().get_current)() == self.raw }
    }

    /// The host's own OpenGL functions; the context must be current.
    pub fn functions(&self) -> glow::Context {
        assert!(self.make_current());
        // SAFETY: the context is current.
        let gl = unsafe { glow::Context::from_loader_function_cstr(proc_address) };
        // If the driver falls back to an older version, the tests would pass for the wrong reason.
        let (major, minor) = match self.api {
            Api::Core(a, b) | Api::Compatibility(a, b) | Api::Es(a, b) => (a as u32, b as u32),
        };
        assert!((gl.version().major, gl.version().minor) >= (major, minor));
        gl
    }
}

/// Leaves no context current on this thread.
pub fn make_none_current() {
    // SAFETY: NULLs release.
    unsafe { (egl().make_current)(egl().display, null(), null(), null()) };
}

impl Drop for Context {
    fn drop(&mut self) {
        // SAFETY: the handles are EGL's own and are not used afterwards.
        unsafe {
            if self.is_current() {
                make_none_current();
            }
            (egl().destroy_context)(egl().display, self.raw);
            if !self.surface.is_null() {
                (egl().destroy_surface)(egl().display, self.surface);
            }
        }
    }
}

/// The address of an OpenGL function.
pub fn proc_address(name: &CStr) -> Ptr {
    // SAFETY: the name is NUL-terminated.
    unsafe { (egl().get_proc)(name.as_ptr()) }
}

/// A function of a library.
///
/// # Safety
/// `F` is the function's pointer type.
unsafe fn symbol<F: Copy>(library: *mut c_void, name: &CStr) -> F {
    // SAFETY: the library is open; the caller vouches for the type, which has the size of a pointer.
    unsafe {
        let address = dlsym(library, name.as_ptr());
        assert!(!address.is_null(), "{name:?}");
        std::mem::transmute_copy(&address)
    }
}

/// An OpenGL function that glow lacks.
///
/// # Safety
/// `F` is the function's pointer type.
pub unsafe fn function<F: Copy>(name: &str) -> F {
    let name = CString::new(name).unwrap();
    let address = proc_address(&name);
    assert!(!address.is_null(), "{name:?}");
    // SAFETY: the caller vouches for the type; a function pointer has the size of a pointer.
    unsafe { std::mem::transmute_copy(&address) }
}
