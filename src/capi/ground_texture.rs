//! Water on the host's terrain as a texture
//!
//! A native texture for the host's own materials, with the water of the terrain's cells. The cells of a grid
//! (wk_context_set_ground_grid) are uploaded once for both the host and the stage SURFACE. For tiles
//! (wk_context_set_terrain) the texture covers a window around a place. Each cell is one texel; the first one is the
//! south-western cell, and rows go north, in every graphics interface. The functions from wk_get_ground_snippet, in
//! GLSL and WGSL, compute how the wet surface looks.

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

/// Texture of the water of the terrain's cells: of a whole grid, or of the tiles around a place.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_ground_texture {
    /// sizeof(wk_ground_texture) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_GROUND_TEXTURE.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// RGBA half floats: an OpenGL texture name (GL_TEXTURE_2D) or a VkImage (VK_FORMAT_R16G16B16A16_SFLOAT). The
    /// channels are film_mm, soaked, standing_mm and ice of wk_ground_cell, each within 1/2048 of its value, standing
    /// water up to 65 504 mm. Where no water stands, standing_mm is negative: it is the depth of the hollow's water
    /// level below the ground, mm, or -50 where the hollow is dry. A shore between texels therefore lies where
    /// standing_mm crosses 0.
    pub texture: u64,
    /// Number that changes whenever `texture` becomes another object, even one of the same name: after another grid was
    /// set or loaded. For tiles it never changes.
    pub generation: u64,
    /// Revision of the texture's contents: for a grid, that of wk_context_get_ground_cells; for tiles, the number of
    /// writes to the texture so far.
    pub revision: u64,
    /// Width, texels: the number of nodes of a grid to the east, or 512 for tiles.
    pub width: u32,
    /// Height, texels: the number of nodes of a grid to the north, or 512 for tiles.
    pub height: u32,
    /// Two rows of a matrix: multiplied by (x, y, z, 1) of a place in the host's world, m, they give the texture
    /// coordinates u and v of the place. (0, 0) is the south-western corner of the first texel. For single precision,
    /// see uv_from_world of wk_cloud_shadows.
    pub uv_from_world: [[f64; 4]; 2],
    /// Texture of the snow on the same grid, an object like `texture`; its channels are depth_m, density_kg_m3, wetness
    /// and albedo of wk_lying_snow. The field is 0 without WK_LYING_SNOW_SIMULATED. The snow in the texture changes at
    /// most once every 60 s of simulation time.
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

/// Gets the native texture of the water on a wk_ground_grid, up to date. Call this function after each
/// wk_context_update; the call costs nothing if nothing has changed. The water changes at most once every 10 s of
/// simulation time. This call, or a wk_view_record with SURFACE, uploads the changes in order with the host's work on
/// the device's queue or context. The texture belongs to the context and stays the same until you set or load another
/// grid, or remove the grid. Before you do so, wait for GPU work that samples the texture. In Vulkan it is in
/// VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL between calls, and you may copy from it. It has no mipmaps; choose filter
/// and wrap yourself.
/// Thread: exclusive.
/// Errors: WK_ERROR_WRONG_ORDER without a wk_ground_grid; WK_ERROR_UNSUPPORTED on an own device, where the host has no
/// shaders.
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

/// Gets the native textures of the tiles around a place, up to date, as wk_context_get_ground_texture does for a grid.
/// The textures cover a window of 512 x 512 cells, which moves in steps of 64 cells so that `center_m` stays within the
/// middle 64 x 64 cells of the window. `uv_from_world` is the present placement of the window. Where no tile has
/// ground, the textures have neither water nor snow. Call this function after each wk_context_update; with several
/// cameras, call it before you draw the picture of each one. The call costs nothing if nothing has changed; after a
/// move it uploads the whole window. Both textures stay the same as long as the context lives.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an invalid position; WK_ERROR_WRONG_ORDER where no tile reaches into the
/// window; WK_ERROR_UNSUPPORTED on an own device, where the host has no shaders.
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

/// Gets the text of the functions that compute how a texel's surface looks: how dark it is, how much of it mirrors, and
/// how rough it is. NUL-terminated UTF-8 that lives as long as the process.
/// Thread: any.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an unknown language.
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
