//! A cube map of what stands around the camera
//!
//! For reflections in the host's own objects: paint, water, windows. Six faces of 64 x 64 texels show the sky with its
//! clouds, fog and rain as far as the horizon, and the planet's ground below. They leave out the discs of the sun and
//! the moon (the host itself lights its objects by the sun and the moon), the stars and the host's objects. The glow of
//! the night sky is uniform. The axes are those of the host's world: a shader samples with the reflected direction as
//! it is. Level m of the 7 levels is prefiltered for a mirror of roughness m/6 (the distribution of Trowbridge and
//! Reitz, alpha = roughness^2; Karis 2013, Real Shading in Unreal Engine 4), so textureLod(cube, reflected, 6 *
//! roughness) is the specular light before the surface's reflectance. OpenGL hosts enable GL_TEXTURE_CUBE_MAP_SEAMLESS
//! and set their filters by a sampler object. Welkin draws one face a frame, in turn. It draws all six in the first
//! frame, in frames with WK_FRAME_CUT or WK_FRAME_NO_HISTORY, and when light, weather or place jump. A view draws the
//! cube map only after the first wk_view_get_environment.

use std::{ffi::c_void, ptr::null};

use super::{
    boundary::{
        guard,
        layout::{self, init_struct, struct_size},
        numbers::*,
        objects::{ViewObject, wk_view},
    },
    host,
};
use crate::error::Status;

include!(concat!(env!("OUT_DIR"), "/init_environment.rs"));

/// The cube map of a view.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_environment {
    /// sizeof(wk_environment) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_ENVIRONMENT.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// RGBA half floats: an OpenGL texture name (GL_TEXTURE_CUBE_MAP), or a VkImage of six layers with
    /// VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT (VK_FORMAT_R16G16B16A16_SFLOAT).
    pub texture: u64,
    /// Edge of a face, texels.
    pub size: u32,
    /// Number of mip levels, down to one texel.
    pub level_count: u32,
    /// Factor from texels to cd/m^2; 0 before the first frame. It changes only in frames that draw all faces.
    pub cd_m2_per_unit: f64,
    /// Factor from texels to the values of the last frame's colour. With WK_COLOR_SCENE_LINEAR these values are in the
    /// host's units. In the display spaces they are exposed luminances, to which the tone curve still has to be
    /// applied.
    pub light_scale: f64,
}

impl wk_environment {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_ENVIRONMENT,
        next: null(),
        texture: 0,
        size: 0,
        level_count: 0,
        cd_m2_per_unit: 0.0,
        light_scale: 0.0,
    };
}

/// Gets the native texture of the cube map. Once you have called this function, the faces that are due are drawn in
/// each frame by its first wk_view_record with WK_STAGE_BACKGROUND or WK_STAGE_MEDIUM. The texture belongs to the view
/// and stays the same until the view is destroyed. In Vulkan it is in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL after
/// each such wk_view_record. Call this function after each frame to get the frame's scales.
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_UNSUPPORTED on an own device, where the host has no shaders.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_get_environment(
    view: *mut wk_view,
    out_environment: *mut wk_environment,
) -> wk_status {
    guard("wk_view_get_environment", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        // SAFETY: the caller's promise about `out_environment`.
        let place = unsafe { layout::out_struct(&"out_environment", out_environment)? };
        object.cell.host().check_own_shaders("view", "environment maps")?;
        object.cell.drain();
        let environment = object.lock().environment()?;
        object.uses_environment();
        place.set(&wk_environment {
            texture: host::native_texture(&object.cell, &environment.texture)?,
            size: environment.texture.width(),
            level_count: environment.texture.mip_level_count(),
            cd_m2_per_unit: environment.cd_m2_per_unit,
            light_scale: environment.light_scale,
            ..wk_environment::INIT
        });
        Ok(Status::Ok)
    })
}
