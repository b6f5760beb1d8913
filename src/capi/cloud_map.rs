//! Cloud map
//!
//! A map of where cloud layers stand over the ground: a storm ahead of the runway, a clearing over the harbour. The map
//! applies to pictures, shadows, and queries of light, radiance and visibility, but not to wk_context_get_conditions
//! and wk_context_get_cloud_slabs. docs/clouds.md has an example.

use std::{ffi::c_void, ptr::null};

use super::boundary::{
    guard,
    input::{self, Named},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::{Error, Status},
    weather::{CloudMap, MAX_CLOUD_MAP_CELLS},
};

include!(concat!(env!("OUT_DIR"), "/init_cloud_map.rs"));

/// Cover of cloud layers over each place of the ground, as a share of the cover that the weather gives the layers. For
/// a layer of cover 1 the map is the cover itself. The map is level, aligned to true north and fixed to the ground.
/// Clouds drift across the map with their wind, and grow and dissolve on the way so that the cover stays that of the
/// map. Values are interpolated linearly between the centres of cells, and constant beyond the outermost centres.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_cloud_map {
    /// sizeof(wk_cloud_map) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_CLOUD_MAP.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Centre of the south-western cell: metres east and north of the world's origin. Range [-1e7, 1e7], default 0, 0.
    pub first_m: [f64; 2],
    /// Side of a cell, m. Range [100, 50 000], default 1000.
    pub cell_m: f64,
    /// Number of cells east and north. Range [1, 128], default 1, 1.
    pub cells: [u32; 2],
    /// Lowest and highest base of the layers that follow the map, above the station, m. Range [-1000, 20 000], the
    /// lower one first, default -1000, 20 000: all layers.
    pub base_m: [f64; 2],
    /// Share of the layer's cover in each cell, in [0, 1]: 0 for no cloud, 1 for the layer's cover. Cells run from west
    /// to east, rows from south to north. Copied by the call.
    pub cover: *const f32,
    /// Number of cells in `cover`: the product of `cells`.
    pub cover_count: u32,
    /// Must be 0.
    pub reserved0: u32,
}

impl wk_cloud_map {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_CLOUD_MAP,
        next: null(),
        first_m: [0.0, 0.0],
        cell_m: 1000.0,
        cells: [1, 1],
        base_m: [-1000.0, 20000.0],
        cover: null(),
        cover_count: 0,
        reserved0: 0,
    };
}

/// Sets the map of cloud cover, in place of any earlier map; NULL removes the map. Clouds change at once. The map is
/// part of the saved state. With WK_CLOUD_MODEL_DECK the map affects only the light. A failed call changes nothing.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_cloud_map(
    context: *mut wk_context,
    cloud_map: *const wk_cloud_map,
) -> wk_status {
    guard("wk_context_set_cloud_map", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        if cloud_map.is_null() {
            object.write().set_cloud_map(None)?;
            return Ok(Status::Ok);
        }
        let most = (MAX_CLOUD_MAP_CELLS * MAX_CLOUD_MAP_CELLS) as usize;
        // SAFETY: the caller's promise about `cloud_map`.
        let c = unsafe { layout::read(&"cloud_map", cloud_map)? };
        // SAFETY: the caller's promise about its pointers.
        let cover: &[f32] = unsafe {
            layout::check_chain(&"cloud_map", c.next, &[])?;
            let count = Named("cloud_map.cover_count", c.cover_count as usize);
            input::slice("cloud_map.cover", c.cover, count, most)?
        };
        let map =
            CloudMap { first_m: c.first_m, cell_m: c.cell_m, cells: c.cells, base_m: c.base_m, cover: cover.to_vec() };
        let named = |e: Error| e.renamed("cloud_map.cover.len", "cloud_map.cover_count");
        object.write().set_cloud_map(Some(map)).map_err(named)?;
        Ok(Status::Ok)
    })
}
