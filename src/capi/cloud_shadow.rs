//! Shadows of clouds as a texture
//!
//! A native texture for the host's own materials: the share of the direct light of the sun or moon that broken clouds
//! let through, for all places around the camera. The function from wk_get_cloud_shadow_snippet, in GLSL or WGSL,
//! samples the texture.

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

/// Map of the clouds' shadows, and its placement in the view's last frame. The map is a level plane at the altitude of
/// the weather's station (station_altitude_m of wk_weather). It moves with the air that carries the clouds, and repeats
/// every 20.48 km.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_cloud_shadows {
    /// sizeof(wk_cloud_shadows) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_CLOUD_SHADOWS.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Share of the direct light of the sun or the moon, whichever is brighter, that clouds let through. One channel of
    /// 8 bits: an OpenGL texture name (GL_TEXTURE_2D, GL_R8) or a VkImage (VK_FORMAT_R8_UNORM). Sample it with a linear
    /// filter and a repeating wrap mode.
    pub texture: u64,
    /// Width, texels; equal to the height.
    pub width: u32,
    /// Height, texels; equal to the width.
    pub height: u32,
    /// Two rows of a matrix: multiplied by (x, y, z, 1) of a place in the host's world, m, they give the texture
    /// coordinates u and v of the place. For single precision, subtract the camera's position (x0, y0, z0) from the
    /// place. In each row (p, q, r, s), then replace s by p x0 + q y0 + r z0 + s, computed in double precision.
    pub uv_from_world: [[f64; 4]; 2],
    /// Row of a matrix, used like uv_from_world: it gives the height of a place above the plane, m.
    pub height_from_world: [f64; 4],
    /// Texture coordinates u and v of the point of the plane that was below the camera in the last frame.
    pub camera_uv: [f64; 2],
    /// Mean over all places of the share in `texture`. The direct light from wk_context_get_light includes it already:
    /// multiply that light by the place's own share / mean_share.
    pub mean_share: f64,
    /// Weight of the texture against mean_share, 0 to 1. It is 0 without broken clouds, with WK_CLOUD_MODEL_DECK, and
    /// with the light near the horizon: the texture is then meaningless.
    pub map_weight: f64,
    /// Height above the plane, m, from which on mean_share replaces the texture: 100 m above the base of the lowest
    /// clouds.
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
        map_weight: 0.0,
        top_m: 0.0,
    };
}

/// Gets the native texture of the clouds' shadows. From the first call on, the first wk_view_record of each frame
/// updates it, and WK_STAGE_SURFACE no longer draws cloud shadows: your materials do. The texture belongs to the view
/// and stays the same until the view is destroyed. In Vulkan the texture is in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
/// between calls. Call this function after each frame to get the placement of the map. If you draw before Welkin, use
/// the placement of the last frame, or record WK_STAGE_PREPARE first.
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_UNSUPPORTED on a device that Welkin made itself (wk_device_create), on which the host's shaders
/// cannot run.
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
            map_weight: shadows.map_weight,
            top_m: shadows.top_m,
            ..wk_cloud_shadows::INIT
        });
        Ok(Status::Ok)
    })
}

/// Gets the text of the sampling function: NUL-terminated UTF-8 that lives as long as the process.
/// Thread: any.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an unknown language.
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
