//! Wet ground
//!
//! The stage SURFACE draws water onto the host's picture from its depth: what is wet is darker and mirrors the sky, level
//! ground has puddles, rain makes rings in them. It is right for WK_COLOR_SCENE_LINEAR; in the display's spaces the shown
//! colour is taken for the ground's own. Plants, told by their green, do not shine. Mirrors show the sky, and of objects only that what keeps rain off is dark.
//!
//! How wet the ground is follows the weather of the moment (wk_conditions.wetness, .puddles), or, with a wk_simulation_desc
//! in wk_context_desc.next, a state that fills, drains and dries over time, which wk_context_save keeps.

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::{
    boundary::guard,
    conditions::position,
    context::{ContextObject, wk_context},
    layout::{self, init_struct, struct_size},
    status::*,
};
use crate::{
    context::{GroundAt, GroundModel},
    error::Status,
};

include!(concat!(env!("OUT_DIR"), "/init_ground.rs"));

/// Where the wetness of the ground comes from.
pub type wk_ground_model = u32;
/// The weather of the moment: as reported, or as the rain of the moment keeps it. Rain that ends leaves dry ground.
pub const WK_GROUND_REPORTED: wk_ground_model = 0;
/// A state from simulation time 0 on, when it is as the weather has the ground (wet, if it rains then): rain fills pores, film and hollows; they drain and dry by wind, sun and humidity
/// (Penman 1948) in steps of 10 s. A leap of more than a day is simulated over its last day, which begins as the weather has the
/// ground then. See wk_context_update for leaps that take more than one call.
pub const WK_GROUND_SIMULATED: wk_ground_model = 1;

/// What has state, and how. An extension: put it into wk_context_desc.next.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_simulation_desc {
    /// sizeof(wk_simulation_desc) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SIMULATION_DESC.
    pub struct_type: wk_struct_type,
    /// The next extension. Default NULL.
    pub next: *const c_void,
    /// Default WK_GROUND_REPORTED.
    pub ground_model: wk_ground_model,
    /// Must be 0.
    pub reserved0: u32,
}

impl wk_simulation_desc {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SIMULATION_DESC,
        next: null(),
        ground_model: WK_GROUND_REPORTED,
        reserved0: 0,
    };

    /// As the Rust side takes it.
    pub(super) fn ground(&self) -> GroundModel {
        if self.ground_model == WK_GROUND_SIMULATED { GroundModel::Simulated } else { GroundModel::Reported }
    }
}

/// Water at a place of the ground.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_ground {
    /// sizeof(wk_ground) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_GROUND.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Depth of water there, mm: the film, and what stands in the hollow if there is one. For tyres.
    pub water_mm: f64,
    /// Film on level ground outside of hollows, mm; on the host's terrain that of the place.
    pub film_mm: f64,
    /// Of all the ground, on the host's terrain of the place: 0 dry, 0.3 damp, 1 under a closed film.
    pub wetness: f64,
    /// Share of all the ground, or of the host's terrain, under standing water.
    pub puddles: f64,
    /// 1 where standing water covers the place, else 0.
    pub in_puddle: u32,
    /// 0.
    pub reserved0: u32,
}

impl wk_ground {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_GROUND,
        next: null(),
        water_mm: 0.0,
        film_mm: 0.0,
        wetness: 0.0,
        puddles: 0.0,
        in_puddle: 0,
        reserved0: 0,
    };

    fn of(g: &GroundAt) -> Self {
        Self {
            water_mm: g.water_mm,
            film_mm: g.film_mm,
            wetness: g.wetness,
            puddles: g.puddles,
            in_puddle: u32::from(g.in_puddle),
            ..Self::INIT
        }
    }
}

/// Water on the ground at a place of the host's world, as of wk_context_get_state_time: on the host's terrain (wk_context_set_ground_grid), up to 3 m above
/// it, that of its cells; elsewhere that of level, open ground, with the hollows that are drawn, a pattern fixed to the world by
/// the context's seed.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT for a position that is no place.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_ground(
    context: *const wk_context,
    position_m: *const [f64; 3],
    out_ground: *mut wk_ground,
) -> wk_status {
    guard("wk_context_get_ground", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promises.
        let (at, place) =
            unsafe { (position("position_m", position_m)?, layout::out_struct(&"out_ground", out_ground)?) };
        place.set(&wk_ground::of(&object.read().ground_at(DVec3::from_array(at))?));
        Ok(Status::Ok)
    })
}
