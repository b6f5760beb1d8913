//! Wind that varies in space
//!
//! If you know how air flows around your buildings, over your deck or under your rotor, give the velocities on a grid.
//! The grid acts in wk_context_get_wind_at, in the rain on surfaces and windscreens, on drifting snow, on patches of
//! fog and dust, and on drops and flakes near a camera. It takes the place of a wind field (wk_context_set_wind_field).
//! Everything else follows the weather's wind.

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
    error::{Error, Status},
    wind::{MAX_NODES, WindGrid, WindGridKind},
};

include!(concat!(env!("OUT_DIR"), "/init_wind_grid.rs"));

/// Meaning of a grid's velocities.
pub type wk_wind_grid_kind = u32;
/// The whole wind: replaces the weather's wind inside the grid.
pub const WK_WIND_GRID_WHOLE: wk_wind_grid_kind = 0;
/// A difference: added to the weather's wind.
pub const WK_WIND_GRID_ADDED: wk_wind_grid_kind = 1;

/// Velocities of the air at the nodes of a grid that is level and aligned to true north, interpolated linearly between
/// nodes along each axis. Outside the grid the weather's wind blows: make the grid so large that the flow equals that
/// wind at its border.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_wind_grid {
    /// sizeof(wk_wind_grid) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_WIND_GRID.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Position of the lowest, south-western node, in the host's world, m, within 1e12 m of the origin. Default 0,
    /// 0, 0.
    pub origin_m: [f64; 3],
    /// Distance between nodes east, north and up, m. Range [0.01, 10 000], default 1, 1, 1.
    pub cell_m: [f64; 3],
    /// Number of nodes east, north and up. Range 2 to 64 east and north, 2 to 32 up; default 2, 2, 2.
    pub nodes: [u32; 3],
    /// A WK_WIND_GRID_ constant, default WK_WIND_GRID_WHOLE.
    pub kind: wk_wind_grid_kind,
    /// Three numbers for each node (east, north, up), m/s, each vector of at most 300 m/s. Nodes run from west to east,
    /// rows from south to north, levels upwards. Copied by the call.
    pub velocities_m_s: *const f32,
    /// Number of nodes in velocities_m_s: the product of `nodes`.
    pub velocity_count: u32,
    /// Must be 0.
    pub reserved0: u32,
}

impl wk_wind_grid {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_WIND_GRID,
        next: null(),
        origin_m: [0.0, 0.0, 0.0],
        cell_m: [1.0, 1.0, 1.0],
        nodes: [2, 2, 2],
        kind: WK_WIND_GRID_WHOLE,
        velocities_m_s: null(),
        velocity_count: 0,
        reserved0: 0,
    };
}

/// Sets the grid of a wind that varies in space, in place of the grid set before; NULL removes the grid. Unchanged
/// after an error.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_wind_grid(
    context: *mut wk_context,
    wind_grid: *const wk_wind_grid,
) -> wk_status {
    guard("wk_context_set_wind_grid", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        if wind_grid.is_null() {
            object.write().set_wind_grid(None)?;
            return Ok(Status::Ok);
        }
        let most = MAX_NODES.iter().map(|n| *n as usize).product();
        // SAFETY: the caller's promise about `wind_grid`.
        let c = unsafe { layout::read(&"wind_grid", wind_grid)? };
        // SAFETY: the caller's promise about its pointers.
        let velocities: &[[f32; 3]] = unsafe {
            layout::check_chain(&"wind_grid", c.next, &[])?;
            let count = Named("wind_grid.velocity_count", c.velocity_count as usize);
            input::slice("wind_grid.velocities_m_s", c.velocities_m_s.cast(), count, most)?
        };
        let grid = WindGrid {
            origin: DVec3::from_array(c.origin_m),
            cell_m: DVec3::from_array(c.cell_m),
            nodes: c.nodes,
            kind: if c.kind == WK_WIND_GRID_ADDED { WindGridKind::Added } else { WindGridKind::Whole },
            velocities_m_s: velocities.to_vec(),
        };
        let named = |e: Error| e.renamed("wind_grid.velocities_m_s.len", "wind_grid.velocity_count");
        object.write().set_wind_grid(Some(grid)).map_err(named)?;
        Ok(Status::Ok)
    })
}
