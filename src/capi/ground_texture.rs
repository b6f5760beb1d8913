//! Water on the host's terrain as a texture
//!
//! For the host's own materials: the water of the terrain's cells as one native texture, of a grid
//! (wk_context_set_ground_grid) uploaded once for the host and for the stage SURFACE, of tiles (wk_context_set_terrain)
//! those about a place. One texel for each cell, the first one south-west, rows to the north, in every graphics
//! interface. Published functions, GLSL and WGSL, compute how it looks.

use std::{
    ffi::{CString, c_char, c_void},
    ptr::null,
    sync::OnceLock,
};

use glam::DVec3;

use super::{
    boundary::{
        guard,
        input::{out, position},
        layout::{self, init_struct, struct_size},
        numbers::*,
        objects::{ContextObject, wk_context},
    },
    host,
    veil::wk_shading_language,
};
use crate::{
    error::{Result, Status},
    ground::{GroundTexture, SNIPPET_GLSL, SNIPPET_WGSL},
};

include!(concat!(env!("OUT_DIR"), "/init_ground_texture.rs"));

/// The water of the terrain's cells on the GPU, of a grid or about a place on tiles.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_ground_texture {
    /// sizeof(wk_ground_texture) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_GROUND_TEXTURE.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// RGBA half floats, an OpenGL texture name (GL_TEXTURE_2D) or a VkImage (VK_FORMAT_R16G16B16A16_SFLOAT): film_mm,
    /// soaked, standing_mm and ice of wk_ground_cell, each within 1/2048 of its value, standing water up to 65 504 mm.
    /// Where none stands, standing_mm is negative: the depth of its hollow's level below the ground, mm, or -50 where
    /// the hollow is dry. So a shore between texels lies where it crosses 0.
    pub texture: u64,
    /// Changes whenever `texture` becomes another object, whatever its name: after another grid was set or loaded.
    pub generation: u64,
    /// Revision of the texture's contents, as in wk_context_get_ground_cells.
    pub revision: u64,
    /// Texels: the grid's nodes east and north.
    pub width: u32,
    /// Texels: the grid's nodes east and north.
    pub height: u32,
    /// Two rows of a matrix: multiplied by (x, y, z, 1) of a place in the host's world, m, they give its u and v.
    /// (0, 0) is the south-western corner of the first texel. Single precision is enough once the fourth column
    /// includes the camera's position.
    pub uv_from_world: [[f64; 4]; 2],
    /// The snow on the same grid, an object like `texture`: depth_m, density_kg_m3, wetness and albedo of
    /// wk_lying_snow. 0 without WK_LYING_SNOW_SIMULATED. It changes at most once every 60 s of simulation time.
    pub snow_texture: u64,
}

impl wk_ground_texture {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_GROUND_TEXTURE,
        next: null(),
        texture: 0,
        generation: 0,
        revision: 0,
        width: 0,
        height: 0,
        uv_from_world: [[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]],
        snow_texture: 0,
    };
}

/// Gets the native texture of the terrain's water, up to date: call it after each wk_context_update. It costs nothing
/// if nothing has changed. Changes come at most once every 10 s of simulation time; this call, or a wk_view_record with
/// SURFACE, uploads them in order with the host's work on the device's queue or context. The texture belongs to the
/// context and stays the same until another grid, or none, is set or loaded: wait for the GPU's work that samples it
/// before that. In Vulkan it is in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL between calls, and you may copy from it. It
/// has no mipmaps; choose filter and wrap yourself. Thread: exclusive. Errors: WK_ERROR_WRONG_ORDER without a terrain;
/// WK_ERROR_UNSUPPORTED on an own device, which has no shaders of the host's.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_ground_texture(
    context: *mut wk_context,
    out_texture: *mut wk_ground_texture,
) -> wk_status {
    guard("wk_context_get_ground_texture", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `out_texture`.
        let place = unsafe { layout::out_struct(&"out_texture", out_texture)? };
        object.cell.host().check_own_shaders("context", "ground textures")?;
        object.cell.check_not_lost()?;
        object.cell.drain();
        let ground = object.write().ground_texture()?;
        place.set(&native(&object, &ground)?);
        Ok(Status::Ok)
    })
}

/// Gets the native textures of the tiles about a place, up to date, as wk_context_get_ground_texture does those of a
/// grid: a window of 512 x 512 cells, which has `center_m` in its middle quarter and moves by 64 cells at a time.
/// `uv_from_world` is where it is now; where no tile has ground there is neither water nor snow. Call it after each
/// wk_context_update, and for several cameras before you draw each. It costs nothing if nothing has changed; all of it
/// is uploaded where the window has moved. Both textures stay the same as long as the context lives. Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT for a place that is none; WK_ERROR_WRONG_ORDER where no tile reaches into the
/// window; WK_ERROR_UNSUPPORTED on an own device, which has no shaders of the host's.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_terrain_texture(
    context: *mut wk_context,
    center_m: *const [f64; 3],
    out_texture: *mut wk_ground_texture,
) -> wk_status {
    guard("wk_context_get_terrain_texture", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `out_texture`.
        let place = unsafe { layout::out_struct(&"out_texture", out_texture)? };
        // SAFETY: the caller's promise about `center_m`.
        let center = unsafe { position("center_m", center_m)? };
        object.cell.host().check_own_shaders("context", "terrain textures")?;
        object.cell.check_not_lost()?;
        object.cell.drain();
        let found = object.write().terrain_texture(DVec3::from_array(center));
        place.set(&native(&object, &found.map_err(|e| e.renamed("center", "center_m"))?)?);
        Ok(Status::Ok)
    })
}

/// Converts a ground texture to its C struct.
fn native(object: &ContextObject, ground: &GroundTexture) -> Result<wk_ground_texture> {
    let snow = ground.snow.as_ref().map(|texture| host::native_texture(&object.cell, texture)).transpose()?;
    Ok(wk_ground_texture {
        texture: host::native_texture(&object.cell, &ground.texture)?,
        generation: ground.generation,
        revision: ground.revision,
        width: ground.texture.width(),
        height: ground.texture.height(),
        uv_from_world: ground.uv_from_world.map(|row| row.to_array()),
        snow_texture: snow.unwrap_or(0),
        ..wk_ground_texture::INIT
    })
}

/// Gets the text of the functions that compute how a place of the texture looks: how dark, how much of it mirrors, how
/// rough. NUL-terminated UTF-8 that lives as long as the process.
/// Thread: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_get_ground_snippet(
    language: wk_shading_language,
    out_text: *mut *const c_char,
) -> wk_status {
    static TEXTS: OnceLock<[CString; 2]> = OnceLock::new();
    guard("wk_get_ground_snippet", |_| {
        layout::WK_SHADING_LANGUAGE.check(&"language", language.into())?;
        let place = out("out_text", out_text)?;
        let texts = TEXTS.get_or_init(|| [SNIPPET_GLSL, SNIPPET_WGSL].map(|t| CString::new(t).unwrap_or_default()));
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(texts[language as usize].as_ptr()) };
        Ok(Status::Ok)
    })
}
