//! Water on the host's terrain
//!
//! Give the heights of your terrain on a grid, and Welkin computes wetness and puddles cell by cell. Rain areas, and
//! boxes that stand still (wk_context_set_shelters), determine the rain that each cell receives. Water runs off and
//! fills the terrain's hollows until they spill. wk_context_get_ground answers by place, the stage SURFACE draws the
//! water, and wk_context_get_ground_cells returns it for your own materials. With WK_GROUND_SIMULATED the water is a
//! state, which wk_context_save keeps together with the heights. Otherwise the water follows from the weather's
//! wetness, spread over the hollows.

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::boundary::{
    guard,
    input::{self, Named},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::{Error, Result, Status},
    ground::GroundCell,
    ground::{GroundGrid, MAX_GRID_NODES, SurfaceClass},
};

include!(concat!(env!("OUT_DIR"), "/init_ground_grid.rs"));

/// Heights of the host's terrain on a grid that is level and aligned to true north. Each node is the middle of a square
/// cell. Water is interpolated linearly between nodes. Outside the grid lies the world's ground, into which the picture
/// blends over two cells.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_ground_grid {
    /// sizeof(wk_ground_grid) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_GROUND_GRID.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Position of the south-western node in the host's world, m, within 1e12 m of the world's origin. heights_m are
    /// measured upwards from this position. Default 0, 0, 0.
    pub origin_m: [f64; 3],
    /// Distance between nodes, m. Range [0.01, 10 000], default 1. A puddle must be several cells wide to appear.
    pub cell_m: f64,
    /// Number of nodes east and north. Range [2, 512] each, default 2, 2.
    pub nodes: [u32; 2],
    /// Heights of the nodes above origin_m, m, within 1e5. Nodes run from west to east, rows from south to north.
    /// Copied by the call.
    pub heights_m: *const f32,
    /// Number of values in heights_m: the product of `nodes`.
    pub height_count: u32,
    /// Must be 0.
    pub reserved0: u32,
    /// Class of each cell, in the order of the heights: a wk_surface_class, or 0 to use the context's default. Copied
    /// by the call. Default NULL: 0 for all cells.
    pub surface_classes: *const u8,
    /// Number of values in surface_classes: 0 (the default), or height_count.
    pub surface_class_count: u32,
    /// Must be 0.
    pub reserved1: u32,
}

impl wk_ground_grid {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_GROUND_GRID,
        next: null(),
        origin_m: [0.0, 0.0, 0.0],
        cell_m: 1.0,
        nodes: [2, 2],
        heights_m: null(),
        height_count: 0,
        reserved0: 0,
        surface_classes: null(),
        surface_class_count: 0,
        reserved1: 0,
    };
}

/// Water of a cell of the host's terrain. Element of an array, without struct_size; calls take its sizeof instead. A
/// packed array can be uploaded as a texture of four floats per texel.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_ground_cell {
    /// Film: water on and between the grains of the surface, mm; 0 under standing water.
    pub film_mm: f32,
    /// Water in the pores, as a share of their capacity, 0 to 1.
    pub soaked: f32,
    /// Standing water, mm.
    pub standing_mm: f32,
    /// Share of the cell under ice, 0 to 1, by the present weather. Freezing rain leaves no ice where boxes that stand
    /// still keep it off.
    pub ice: f32,
}

impl wk_ground_cell {
    pub(super) fn of(c: &GroundCell) -> Self {
        Self { film_mm: c.film_mm, soaked: c.soaked, standing_mm: c.standing_mm, ice: c.ice }
    }
}

/// Sets the heights of the host's terrain, in place of a grid or tiles (wk_context_set_terrain) set before. NULL
/// removes the grid, but not tiles; without either the ground is level everywhere. Setting the same grid again keeps
/// its water, even with other classes; a different grid starts as wet as level ground is. For the largest grids the
/// call may take some tenths of a second. A failed call changes nothing.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_ground_grid(
    context: *mut wk_context,
    ground_grid: *const wk_ground_grid,
) -> wk_status {
    guard("wk_context_set_ground_grid", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        if ground_grid.is_null() {
            object.write().set_ground_grid(None)?;
            return Ok(Status::Ok);
        }
        // SAFETY: the caller's promise about `ground_grid`.
        let c = unsafe { layout::read(&"ground_grid", ground_grid)? };
        // SAFETY: the caller's promise about its pointers.
        let (heights, classes) = unsafe {
            layout::check_chain(&"ground_grid", c.next, &[])?;
            let most = (MAX_GRID_NODES * MAX_GRID_NODES) as usize;
            let height_count = Named("ground_grid.height_count", c.height_count as usize);
            let class_count = Named("ground_grid.surface_class_count", c.surface_class_count as usize);
            (
                input::slice("ground_grid.heights_m", c.heights_m, height_count, most)?,
                input::slice("ground_grid.surface_classes", c.surface_classes, class_count, most)?,
            )
        };
        let class = |(i, number): (usize, &u8)| {
            SurfaceClass::from_number(&format!("ground_grid.surface_classes[{i}]"), *number)
        };
        let grid = GroundGrid {
            origin: DVec3::from_array(c.origin_m),
            cell_m: c.cell_m,
            nodes: c.nodes,
            heights_m: heights.to_vec(),
            classes: classes.iter().enumerate().map(class).collect::<Result<_>>()?,
        };
        let named = |e: Error| {
            e.renamed("ground_grid.heights_m.len", "ground_grid.height_count")
                .renamed("ground_grid.classes.len", "ground_grid.surface_class_count")
        };
        object.write().set_ground_grid(Some(grid)).map_err(named)?;
        Ok(Status::Ok)
    })
}

/// Copies the water of the cells of a wk_ground_grid as of wk_context_get_state_time, in the order of the heights. For
/// tiles use wk_context_get_terrain_water. `cell_size` is sizeof(wk_ground_cell) of your header. `out_revision` gets a
/// number that changes whenever the cells change, at most once every 10 s of simulation time. With capacity 0 the call
/// returns only this number, so you can skip uploads when nothing has changed.
/// Thread: concurrent.
/// Errors: WK_ERROR_WRONG_ORDER without a wk_ground_grid; WK_ERROR_INVALID_ARGUMENT for a capacity other than 0 that is
/// too small.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_ground_cells(
    context: *const wk_context,
    cells: *mut wk_ground_cell,
    capacity: u32,
    cell_size: u32,
    out_revision: *mut u64,
) -> wk_status {
    guard("wk_context_get_ground_cells", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let room = input::Room::new("cells", "cell_size", cells, capacity, cell_size)?;
        let revision = input::out("out_revision", out_revision)?;
        let context = object.read();
        let water = context.ground_cells().ok_or_else(|| {
            Error::new(Status::WrongOrder, "there are no cells before wk_context_set_ground_grid").within("context")
        })?;
        if capacity > 0 {
            room.check_capacity("capacity", water.len())?;
            for (i, cell) in water.enumerate() {
                // SAFETY: the capacity was checked, and is what the caller promises.
                unsafe { room.write(i, &wk_ground_cell::of(&cell)) };
            }
        }
        // SAFETY: `revision` was checked and is the caller's.
        unsafe { revision.write(context.ground_revision()) };
        Ok(Status::Ok)
    })
}
