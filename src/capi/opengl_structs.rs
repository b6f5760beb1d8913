//! Structs of OpenGL hosts: the description of a host, its images and the target of a frame.

use std::{
    ffi::{c_char, c_void},
    ptr::{null, null_mut},
};

use super::{
    boundary::{layout::struct_size, numbers::*},
    device::wk_device_flags,
};

/// Returns the address of an OpenGL function, or NULL, as glfwGetProcAddress, SDL_GL_GetProcAddress, eglGetProcAddress
/// or glXGetProcAddress do. With WGL, call wglGetProcAddress, then GetProcAddress of opengl32.dll, which exports the
/// functions of OpenGL 1.1. Welkin treats 1, 2, 3 and -1 as NULL: some drivers' wglGetProcAddress returns them. Welkin
/// calls this function while the host's or its own context is current.
pub type wk_opengl_get_proc_fn = Option<unsafe extern "C" fn(user: *mut c_void, name: *const c_char) -> *const c_void>;

/// Makes a context current on the calling thread: `which` is WK_OPENGL_CONTEXT_HOST or WK_OPENGL_CONTEXT_WELKIN.
/// Returns 0 on success, anything else on failure.
pub type wk_opengl_make_current_fn = Option<unsafe extern "C" fn(user: *mut c_void, which: u32) -> i32>;

/// A context that Welkin asks for.
pub type wk_opengl_context = u32;
/// The context that the host draws in. With several windows, this is the context that was current when the host called
/// Welkin: the host must remember it for each thread.
pub const WK_OPENGL_CONTEXT_HOST: wk_opengl_context = 0;
/// The context that the host made for Welkin, sharing objects with its own.
pub const WK_OPENGL_CONTEXT_WELKIN: wk_opengl_context = 1;

/// The context that Welkin draws in.
pub type wk_opengl_mode = u32;
/// Welkin's own context, which shares objects with the host's.
pub const WK_OPENGL_SHARED: wk_opengl_mode = 0;
/// The host's context, whose state Welkin restores.
pub const WK_OPENGL_HOST_CONTEXT: wk_opengl_mode = 1;

/// Order of the two contexts' commands in shared mode.
pub type wk_opengl_handover = u32;
/// By fences, as the standard requires.
pub const WK_OPENGL_FENCE: wk_opengl_handover = 0;
/// By a flush alone: enough, and cheaper, where one queue serves both contexts. Check the pictures and the gain on your
/// driver.
pub const WK_OPENGL_FLUSH: wk_opengl_handover = 1;

/// Access to a host's OpenGL: its functions, contexts and options.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_opengl_host_desc {
    /// sizeof(wk_opengl_host_desc) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_OPENGL_HOST_DESC.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Finds functions. Default NULL; must be given.
    pub get_proc: wk_opengl_get_proc_fn,
    /// Makes contexts current. Required in WK_OPENGL_SHARED. In WK_OPENGL_HOST_CONTEXT it may be NULL (the default);
    /// Welkin then uses the current context as it is.
    pub make_current: wk_opengl_make_current_fn,
    /// Pointer that is passed to both callbacks. Welkin calls them on the thread that calls Welkin, one at a time.
    /// Default NULL.
    pub user: *mut c_void,
    /// Context that Welkin draws in. Default WK_OPENGL_SHARED.
    pub mode: wk_opengl_mode,
    /// Order of the two contexts' commands. Default WK_OPENGL_FENCE.
    pub handover: wk_opengl_handover,
    /// WK_DEVICE_FORCE_TIER0 or 0, the default; WK_DEVICE_FORCE_SOFTWARE has no meaning here.
    pub flags: wk_device_flags,
    /// Must be 0.
    pub reserved0: u32,
}

impl wk_opengl_host_desc {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_OPENGL_HOST_DESC,
        next: null(),
        get_proc: None,
        make_current: None,
        user: null_mut(),
        mode: WK_OPENGL_SHARED,
        handover: WK_OPENGL_FENCE,
        flags: 0,
        reserved0: 0,
    };
}

/// Type of the object that an OpenGL name stands for.
pub type wk_opengl_image_kind = u32;
/// No image.
pub const WK_OPENGL_NONE: wk_opengl_image_kind = 0;
/// A texture; its level 0 is used.
pub const WK_OPENGL_TEXTURE: wk_opengl_image_kind = 1;
/// A renderbuffer.
pub const WK_OPENGL_RENDERBUFFER: wk_opengl_image_kind = 2;
/// The attachments of a framebuffer; 0 is the window's. Only in WK_OPENGL_HOST_CONTEXT.
pub const WK_OPENGL_FRAMEBUFFER: wk_opengl_image_kind = 3;

/// A host's image, embedded in wk_opengl_target and wk_occluder_map.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_opengl_image {
    /// Type of the object. Default WK_OPENGL_NONE.
    pub kind: wk_opengl_image_kind,
    /// OpenGL name of the object. Default 0.
    pub name: u32,
    /// Target of a texture: GL_TEXTURE_2D (0x0DE1, the default) or GL_TEXTURE_2D_MULTISAMPLE (0x9100).
    pub target: u32,
    /// Must be 0.
    pub reserved0: u32,
}

impl wk_opengl_image {
    pub(crate) const INIT: Self = Self { kind: WK_OPENGL_NONE, name: 0, target: 0x0DE1, reserved0: 0 };
}

/// Handling of multisampled images.
pub type wk_opengl_multisample = u32;
/// Reads depth and draws weather for each sample. From OpenGL 4.0 on; not on OpenGL ES nor on a forced tier 0.
pub const WK_OPENGL_MULTISAMPLE_EACH: wk_opengl_multisample = 0;
/// Averages colour, draws, and writes the result to every sample alike; uses the depth of one sample. Not on OpenGL ES.
pub const WK_OPENGL_MULTISAMPLE_RESOLVE: wk_opengl_multisample = 1;

/// The images of a frame of an OpenGL host.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_opengl_target {
    /// sizeof(wk_opengl_target) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_OPENGL_TARGET.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// The image to draw into. Default none.
    pub color: wk_opengl_image,
    /// The host's depth; none (the default) shows the sky in every pixel. If `color` is a framebuffer, use the same
    /// one, else another image. The depth has as many samples as `color`, with one exception: where `color` has one
    /// sample (a resolved picture), the depth may have more, except on OpenGL ES. One sample of each pixel is then
    /// used.
    pub depth: wk_opengl_image,
    /// A mask of one sample: where red is 1, the host's pixel stays; where it is 0, Welkin draws weather. Default none.
    pub mask: wk_opengl_image,
    /// Width, pixels; must equal the images' width, and a window's present width. Default 0; must be given.
    pub width: u32,
    /// Height, pixels; must equal the images' height, and a window's present height. Default 0; must be given.
    pub height: u32,
    /// Increase this number when you create an object again under an old name. It must never fall. Default 0.
    pub generation: u64,
    /// Handling of multisampled images. Default WK_OPENGL_MULTISAMPLE_EACH.
    pub multisample: wk_opengl_multisample,
    /// Must be 0.
    pub reserved0: u32,
    /// A texture of one sample with each pixel's surface class: the byte of red is a wk_surface_class, or 0 to use the
    /// class of the host's terrain or the context's default. GL_R8, GL_RGB8 or GL_RGBA8. Default none.
    pub surface_classes: wk_opengl_image,
    /// A texture of one sample with unit normals, in the host's world or in eye space (WK_FRAME_NORMALS_IN_EYE_SPACE):
    /// (n + 1) / 2 in GL_RGB8, GL_RGBA8 and GL_RGB10_A2, n in GL_RGB16F, GL_RGBA16F and GL_RGBA32F. Where a pixel holds
    /// no unit vector (a cleared pixel), Welkin uses the normal of the host's terrain or depth. Default none.
    pub normals: wk_opengl_image,
}

impl wk_opengl_target {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_OPENGL_TARGET,
        next: null(),
        color: wk_opengl_image::INIT,
        depth: wk_opengl_image::INIT,
        mask: wk_opengl_image::INIT,
        width: 0,
        height: 0,
        generation: 0,
        multisample: WK_OPENGL_MULTISAMPLE_EACH,
        reserved0: 0,
        surface_classes: wk_opengl_image::INIT,
        normals: wk_opengl_image::INIT,
    };
}
