//! Filter for wgpu's queries while it opens a context: this room answers `glGetString` and `glGetStringi`.
//!
//! There are two reasons. A forced tier 0 must draw as on OpenGL 3.3 or OpenGL ES 3.0, even if the driver can do more,
//! so the version, the shading language and later extensions are hidden. And wgpu treats float formats as renderable
//! and filterable only if an OpenGL 2 extension is listed. Core profiles no longer list that extension, because both
//! abilities are part of OpenGL 3.0 (OpenGL 3.0 specification, table 3.16); this room adds the extension to the list
//! again.

use std::{
    cell::RefCell,
    ffi::{CStr, CString, c_void},
};

use super::{api::Api, check::GlInfo, names::*};

type GetString = unsafe extern "system" fn(u32) -> *const u8;

/// Extensions newer than OpenGL 3.3 and OpenGL ES 3.0 that wgpu asks for.
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

/// Extensions that OpenGL 3.3 contains and wgpu never asks for. One of them is replaced by [`FLOATS`] in the list.
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

/// Extensions with which wgpu writes buffers through persistently mapped memory and a copy on the GPU; without them it
/// uses `glBufferSubData`.
pub(super) const STORAGE: [&str; 2] = ["GL_ARB_buffer_storage", "GL_EXT_buffer_storage"];

/// Extension that says that float formats are renderable and filterable.
const FLOATS: &str = "GL_ARB_color_buffer_float";

/// Answers of `glGetString` and `glGetStringi` on this thread.
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
            // SAFETY: this is the host's own glGetString, with its context current, as the caller of `FaceGuard::show`
            // ensures.
            None => unsafe { (face.real)(name) },
        }
    })
}

extern "system" fn get_string_i(name: u32, index: u32) -> *const u8 {
    FACE.with_borrow(|face| match face {
        Some(face) if name == EXTENSIONS => {
            face.extensions.get(index as usize).map_or(std::ptr::null(), |t| t.as_ptr().cast())
        }
        // wgpu asks for nothing else, and asks nothing after the adapter is created.
        _ => c"".as_ptr().cast(),
    })
}

/// Guard: as long as it lives, `glGetString` and `glGetStringi` answer from this thread's [`Face`].
pub(super) struct FaceGuard(());

impl FaceGuard {
    /// Sets this thread's [`Face`] for the current context. `force_tier0` hides what OpenGL 3.3 or OpenGL ES 3.0 lacks;
    /// `no_storage` hides the extensions of [`STORAGE`]. Returns `None` if the context has no `glGetString`.
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

    /// Returns the function that wgpu's loader gets for `name`: this room's own for `glGetString` and `glGetStringi`,
    /// the host's for all others.
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
