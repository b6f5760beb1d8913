//! Shadows of clouds as a texture
//!
//! For the host's own materials: the share of the direct light of sun or moon that broken clouds let through, as one
//! native texture for all places about the camera. The published sampling function, GLSL and WGSL, looks it up.

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
    veil::wk_shading_language,
};
use crate::{
    clouds::{SHADOW_SNIPPET_GLSL, SHADOW_SNIPPET_WGSL},
    error::Status,
};

include!(concat!(env!("OUT_DIR"), "/init_cloud_shadow.rs"));

/// The map of the clouds' shadows, and how it lay in the view's last frame: a plane at the station's height, fixed to
/// the air that carries the clouds, which repeats every 20 km.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_cloud_shadows {
    /// sizeof(wk_cloud_shadows) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_CLOUD_SHADOWS.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Share of the direct light of sun or moon, whichever is brighter, that clouds let through: one channel of 8 bits,
    /// an OpenGL texture name (GL_TEXTURE_2D, GL_R8) or a VkImage (VK_FORMAT_R8_UNORM). Sample it with a linear filter
    /// that repeats.
    pub texture: u64,
    /// Texels of both sides.
    pub width: u32,
    /// Texels of both sides.
    pub height: u32,
    /// Two rows of a matrix: multiplied by (x, y, z, 1) of a place in the host's world, m, they give its u and v.
    /// Single precision is enough once the fourth column includes the camera's position.
    pub uv_from_world: [[f64; 4]; 2],
    /// Row of a matrix, used as uv_from_world: it gives the height of a place over the plane, m.
    pub height_from_world: [f64; 4],
    /// u and v of the place in the plane that the camera of the last frame stood over.
    pub camera_uv: [f64; 2],
    /// Share of the direct light on the mean over places: wk_context_get_light has that light.
    pub mean_share: f64,
    /// How far shadows are told apart, 0 to 1: 0 without broken clouds, with WK_CLOUD_MODEL_DECK, and under a light
    /// near the horizon. The texture means nothing then.
    pub told: f64,
    /// Height over the plane, m, from which on shadows are not told apart: 100 m above the base of the lowest clouds.
    pub top_m: f64,
}

impl wk_cloud_shadows {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_CLOUD_SHADOWS,
        next: null(),
        texture: 0,
        width: 0,
        height: 0,
        uv_from_world: [[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]],
        height_from_world: [0.0, 0.0, 0.0, 0.0],
        camera_uv: [0.0, 0.0],
        mean_share: 0.0,
        told: 0.0,
        top_m: 0.0,
    };
}

/// Gets the native texture of the clouds' shadows. From the first call on, the first wk_view_record of each frame
/// brings it up to date, and WK_STAGE_SURFACE lays no shadows of clouds any more: your materials do. It belongs to the
/// view and stays the same until that is destroyed. In Vulkan it is in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL between
/// calls. Call this after each frame for how the map lies. If you draw before Welkin, use that of the last frame, or
/// record WK_STAGE_PREPARE first. Thread: exclusive on the view. Errors: WK_ERROR_UNSUPPORTED on an own device, which
/// has no shaders of the host's.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_get_cloud_shadows(
    view: *mut wk_view,
    out_shadows: *mut wk_cloud_shadows,
) -> wk_status {
    guard("wk_view_get_cloud_shadows", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        // SAFETY: the caller's promise about `out_shadows`.
        let place = unsafe { layout::out_struct(&"out_shadows", out_shadows)? };
        object.cell.host().check_own_shaders("view", "shadows of clouds")?;
        object.cell.drain();
        let shadows = object.lock().cloud_shadows()?;
        object.uses_cloud_shadows();
        place.set(&wk_cloud_shadows {
            texture: host::native_texture(&object.cell, &shadows.texture)?,
            width: shadows.texture.width(),
            height: shadows.texture.height(),
            uv_from_world: shadows.uv_from_world.map(|row| row.to_array()),
            height_from_world: shadows.height_from_world.to_array(),
            camera_uv: shadows.camera_uv,
            mean_share: shadows.mean_share,
            told: shadows.told,
            top_m: shadows.top_m,
            ..wk_cloud_shadows::INIT
        });
        Ok(Status::Ok)
    })
}

/// Gets the text of the sampling function: NUL-terminated UTF-8 that lives as long as the process.
/// Thread: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_get_cloud_shadow_snippet(
    language: wk_shading_language,
    out_text: *mut *const c_char,
) -> wk_status {
    static TEXTS: OnceLock<[CString; 2]> = OnceLock::new();
    guard("wk_get_cloud_shadow_snippet", |_| {
        layout::WK_SHADING_LANGUAGE.check(&"language", language.into())?;
        let place = out("out_text", out_text)?;
        let texts = TEXTS
            .get_or_init(|| [SHADOW_SNIPPET_GLSL, SHADOW_SNIPPET_WGSL].map(|t| CString::new(t).unwrap_or_default()));
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(texts[language as usize].as_ptr()) };
        Ok(Status::Ok)
    })
}
