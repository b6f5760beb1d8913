//! The context as wgpu sees it while it opens: `glGetString` and `glGetStringi` answer through this room.
//!
//! Two reasons. A forced tier 0 must draw as a context of OpenGL 3.3 or OpenGL ES 3.0 would, whatever the driver can
//! do, so version, shading language and later extensions are hidden. And wgpu believes that floats can be rendered
//! to and filtered only if an extension of OpenGL 2 says so, which core profiles no longer list although OpenGL 3.0
//! made both part of itself (OpenGL 3.0 specification, table 3.16): that name is put back.

use std::{
    cell::RefCell,
    ffi::{CStr, CString, c_void},
};

use super::{api::Api, check::GlInfo, names::*};

type GetString = unsafe extern "system" fn(u32) -> *const u8;

/// Names newer than OpenGL 3.3 and OpenGL ES 3.0, of those that wgpu asks for.
const NEWER: &[&str] = &[
    "GL_ARB_compute_shader",
    "GL_ARB_shader_storage_buffer_object",
    "GL_ARB_shader_image_load_store",
    "GL_ARB_draw_indirect",
    "GL_ARB_vertex_attrib_binding",
    "GL_ARB_buffer_storage",
    "GL_EXT_buffer_storage",
    "GL_ARB_query_buffer_object",
    "GL_AMD_query_buffer_object",
    "GL_ARB_shader_draw_parameters",
    "GL_ARB_texture_compression_bptc",
    "GL_EXT_texture_cube_map_array",
    "GL_EXT_draw_buffers_indexed",
    "GL_KHR_debug",
    "GL_NV_image_formats",
];

/// Extensions that OpenGL 3.3 contains and wgpu never asks for: one gives its place to [`FLOATS`].
const UNASKED: &[&str] = &[
    "GL_ARB_sync",
    "GL_ARB_map_buffer_range",
    "GL_ARB_copy_buffer",
    "GL_ARB_vertex_array_object",
    "GL_ARB_uniform_buffer_object",
    "GL_ARB_draw_elements_base_vertex",
    "GL_ARB_fragment_coord_conventions",
    "GL_ARB_provoking_vertex",
    "GL_ARB_seamless_cube_map",
    "GL_ARB_vertex_array_bgra",
    "GL_ARB_sampler_objects",
];

/// With one of these wgpu writes buffers through memory that stays mapped and a copy on the GPU, else by
/// `glBufferSubData`.
pub(super) const STORAGE: [&str; 2] = ["GL_ARB_buffer_storage", "GL_EXT_buffer_storage"];

const FLOATS: &str = "GL_ARB_color_buffer_float";

/// Answers of the two functions on this thread.
struct Face {
    real: GetString,
    version: Option<CString>,
    shading_language: Option<CString>,
    extensions: Vec<CString>,
}

thread_local! {
    static FACE: RefCell<Option<Face>> = const { RefCell::new(None) };
}

extern "system" fn get_string(name: u32) -> *const u8 {
    FACE.with_borrow(|face| {
        let Some(face) = face else { return c"".as_ptr().cast() };
        let instead = match name {
            VERSION => &face.version,
            SHADING_LANGUAGE_VERSION => &face.shading_language,
            _ => &None,
        };
        match instead {
            Some(text) => text.as_ptr().cast(),
            // SAFETY: the host's own glGetString, its context current: the caller of `FaceGuard::show` saw to it.
            None => unsafe { (face.real)(name) },
        }
    })
}

extern "system" fn get_string_i(name: u32, index: u32) -> *const u8 {
    FACE.with_borrow(|face| match face {
        Some(face) if name == EXTENSIONS => {
            face.extensions.get(index as usize).map_or(std::ptr::null(), |t| t.as_ptr().cast())
        }
        // wgpu asks for nothing else, and never again once the adapter is made.
        _ => c"".as_ptr().cast(),
    })
}

/// The face is shown on this thread as long as this lives.
pub(super) struct FaceGuard(());

impl FaceGuard {
    /// Shows the current context; `force_tier0` hides what OpenGL 3.3 or OpenGL ES 3.0 lacks, `no_storage` what
    /// [`STORAGE`] names.
    pub(super) fn show(api: &Api, info: &GlInfo, force_tier0: bool, no_storage: bool) -> Option<Self> {
        let real = api.GetString?;
        let text = |t: String| CString::new(t).ok();
        let (version, shading_language) = match (force_tier0, info.is_es()) {
            (false, _) => (None, None),
            (true, false) => (text(format!("3.3.0 of {}", info.version_text)), text("3.30".into())),
            (true, true) => (text("OpenGL ES 3.0".into()), text("OpenGL ES GLSL ES 3.00".into())),
        };
        let mut names = api.extensions();
        let is_hidden = |n: &str| force_tier0 && NEWER.contains(&n) || no_storage && STORAGE.contains(&n);
        for name in names.iter_mut().filter(|n| is_hidden(n)) {
            *name = "GL_WELKIN_hidden".into();
        }
        if !info.is_es()
            && !names.iter().any(|n| n == FLOATS)
            && let Some(place) = names.iter_mut().find(|n| UNASKED.contains(&n.as_str()))
        {
            *place = FLOATS.into();
        }
        let extensions = names.into_iter().filter_map(text).collect();
        FACE.set(Some(Face { real, version, shading_language, extensions }));
        Some(Self(()))
    }

    /// Returns the function that wgpu's loader gets for `name`: one of the two of this room, or the host's for all
    /// others.
    pub(super) fn resolve(name: &CStr, hosts: *const c_void) -> *const c_void {
        match name.to_bytes() {
            b"glGetString" => get_string as extern "system" fn(u32) -> *const u8 as *const c_void,
            b"glGetStringi" => get_string_i as extern "system" fn(u32, u32) -> *const u8 as *const c_void,
            _ => hosts,
        }
    }
}

impl Drop for FaceGuard {
    fn drop(&mut self) {
        FACE.set(None);
    }
}
