//! Textures for the host's transparent things
//!
//! Glass, lamps and smoke that the host draws after the stage MEDIUM need the same air in front of them as the objects
//! that the stage has covered. Their shaders sample the frame's veil: the light that air, fog and rain add on the way
//! to a point, and the transmittance up to it. The published sampling functions, GLSL and WGSL, map clip coordinates
//! and distance to texels.

use std::{
    ffi::{CString, c_char, c_void},
    ptr::null,
    sync::OnceLock,
};

use super::{
    boundary::{
        guard,
        input::out,
        layout::{self, init_struct, struct_size},
        numbers::*,
        objects::{ViewObject, wk_view},
    },
    host,
};
use crate::{
    error::Status,
    frame::{SNIPPET_GLSL, SNIPPET_WGSL},
};

include!(concat!(env!("OUT_DIR"), "/init_veil.rs"));

/// The veil of the view's last frame. It includes air, clouds drawn as a volume, fog, the rain of the weather, and rain
/// areas.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_frame_textures {
    /// sizeof(wk_frame_textures) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_FRAME_TEXTURES.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Light that air, fog and precipitation add, RGB half floats: an OpenGL texture name (GL_TEXTURE_2D) or a VkImage.
    pub light: u64,
    /// Transmittance: share of the light from behind that passes. A texture of the same kind as `light`.
    pub through: u64,
    /// Width of both textures, pixels.
    pub width: u32,
    /// Height of both textures, pixels.
    pub height: u32,
    /// Factor that converts `light` to units of the host's colour.
    pub light_scale: f64,
}

impl wk_frame_textures {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_FRAME_TEXTURES,
        next: null(),
        light: 0,
        through: 0,
        width: 0,
        height: 0,
        light_scale: 0.0,
    };
}

/// Shading languages of the sampling functions.
pub type wk_shading_language = u32;
/// GLSL 3.30.
pub const WK_SHADING_GLSL: wk_shading_language = 0;
/// WGSL.
pub const WK_SHADING_WGSL: wk_shading_language = 1;

/// Gets the native textures of the veil. From the first call on, each frame's MEDIUM stage fills them. They belong to
/// the view and stay the same until it is destroyed. In Vulkan they are in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
/// between wk_view_record calls with MEDIUM. Call this function after each frame to get that frame's light_scale.
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_UNSUPPORTED on an own device, where the host has no shaders.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_get_frame_textures(
    view: *mut wk_view,
    out_textures: *mut wk_frame_textures,
) -> wk_status {
    guard("wk_view_get_frame_textures", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        // SAFETY: the caller's promise about `out_textures`.
        let place = unsafe { layout::out_struct(&"out_textures", out_textures)? };
        object.cell.host().check_own_shaders("view", "frame textures")?;
        object.cell.drain();
        let textures = object.lock().frame_textures()?;
        object.uses_veil();
        place.set(&wk_frame_textures {
            light: host::native_texture(&object.cell, &textures.light)?,
            through: host::native_texture(&object.cell, &textures.through)?,
            width: textures.light.width(),
            height: textures.light.height(),
            light_scale: f64::from(textures.light_scale),
            ..wk_frame_textures::INIT
        });
        Ok(Status::Ok)
    })
}

/// Gets the text of the sampling functions: NUL-terminated UTF-8 that lives as long as the process.
/// Thread: any.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an unknown language.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_get_veil_snippet(language: wk_shading_language, out_text: *mut *const c_char) -> wk_status {
    static TEXTS: OnceLock<[CString; 2]> = OnceLock::new();
    guard("wk_get_veil_snippet", |_| {
        layout::WK_SHADING_LANGUAGE.check(&"language", language.into())?;
        let place = out("out_text", out_text)?;
        let texts = TEXTS.get_or_init(|| [SNIPPET_GLSL, SNIPPET_WGSL].map(|t| CString::new(t).unwrap_or_default()));
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(texts[language as usize].as_ptr()) };
        Ok(Status::Ok)
    })
}
