//! Wind round terrain and buildings
//!
//! A context can solve for the wind in a box of air about a place: it goes round the terrain of
//! wk_context_set_ground_grid or wk_context_set_terrain and the boxes of wk_context_set_shelters, moving ones too,
//! comes in as the weather's wind and leaves behind. It acts where a wind grid of your own would
//! (wk_context_set_wind_grid): in wk_context_get_wind_at, in what lands on surfaces and windscreens, and on drops and
//! flakes near a camera. Nothing is solved unless you ask for it.

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::boundary::{
    guard,
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::Status,
    flow::{WindFieldDesc, WindFieldMode, WindFieldReport, WindWalls},
};

include!(concat!(env!("OUT_DIR"), "/init_wind_field.rs"));

/// How a wind field is led through time.
pub type wk_wind_field_mode = u32;
/// The mean wind: solved for over the first moments after the wind or an obstacle has changed, then it rests at no
/// cost. Gusts are as strong, against the weather's, as the mean is there.
pub const WK_WIND_FIELD_STEADY: wk_wind_field_mode = 0;
/// The wind with gusts, the whirls that come in with it and those that obstacles shed, stepped all the time.
/// docs/wind-field.md says what sizes a core keeps up with.
pub const WK_WIND_FIELD_RUNNING: wk_wind_field_mode = 1;

/// Effect of terrain and boxes on air that passes along them.
pub type wk_wind_walls = u32;
/// They slow it, by the weather's roughness length.
pub const WK_WIND_WALLS_ROUGH: wk_wind_walls = 0;
/// It slides.
pub const WK_WIND_WALLS_SMOOTH: wk_wind_walls = 1;

/// A box of air in which the wind is solved for: level and aligned to true north. Within four cells of its sides and
/// top it goes over into the weather's wind.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_wind_field {
    /// sizeof(wk_wind_field) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_WIND_FIELD.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Middle of the field's floor, in the host's world, m, within 1e12 m of the origin: no higher than the lowest
    /// ground that matters. Where it moves the field follows by whole cells. Default 0, 0, 0.
    pub floor_center_m: [f64; 3],
    /// Size of a cell east, north and up, m, the longest at most 8 times the shortest. Range [0.05, 1000], default 4,
    /// 4, 4.
    pub cell_m: [f64; 3],
    /// Number of cells east, north and up. Range [8, 4096] each, default 128, 128, 32.
    pub cells: [u32; 3],
    /// A WK_WIND_FIELD_ constant, default WK_WIND_FIELD_STEADY.
    pub mode: wk_wind_field_mode,
    /// A WK_WIND_WALLS_ constant, default WK_WIND_WALLS_ROUGH.
    pub walls: wk_wind_walls,
    /// Must be 0.
    pub reserved0: u32,
    /// Memory that the field may take, bytes; more is refused, and the message says how much is needed. Range [1048576,
    /// 17179869184], default 1073741824.
    pub most_bytes: u64,
}

impl wk_wind_field {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_WIND_FIELD,
        next: null(),
        floor_center_m: [0.0, 0.0, 0.0],
        cell_m: [4.0, 4.0, 4.0],
        cells: [128, 128, 32],
        mode: WK_WIND_FIELD_STEADY,
        walls: WK_WIND_WALLS_ROUGH,
        reserved0: 0,
        most_bytes: 1073741824,
    };

    fn desc(&self) -> WindFieldDesc {
        WindFieldDesc {
            floor_center: DVec3::from_array(self.floor_center_m),
            cell_m: DVec3::from_array(self.cell_m),
            cells: self.cells,
            mode: if self.mode == WK_WIND_FIELD_RUNNING { WindFieldMode::Running } else { WindFieldMode::Steady },
            walls: if self.walls == WK_WIND_WALLS_SMOOTH { WindWalls::Smooth } else { WindWalls::Rough },
            most_bytes: self.most_bytes,
        }
    }
}

/// How a wind field stands.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_wind_field_report {
    /// sizeof(wk_wind_field_report) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_WIND_FIELD_REPORT.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// 1: there is a field. 0: none is set, its time has not come, or its first steady state is still being solved for;
    /// all else is 0 then.
    pub present: u32,
    /// 1: it is steady and rests; nothing is stepped.
    pub rests: u32,
    /// Simulation time of the field, s: the present, or up to one step before it.
    pub time_s: f64,
    /// Simulation time at which it last began from a steady field, s: when it was first set, after a leap of more than
    /// 60 s, or far off.
    pub begun_s: f64,
    /// Length of its steps, s.
    pub step_s: f64,
    /// Its lowest corner, farthest to the south-west, in the host's world, m.
    pub corner_m: [f64; 3],
    /// The largest component of the wind anywhere in it, m/s.
    pub fastest_m_s: f64,
    /// Memory that it may take, bytes.
    pub bytes: u64,
}

impl wk_wind_field_report {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_WIND_FIELD_REPORT,
        next: null(),
        present: 0,
        rests: 0,
        time_s: 0.0,
        begun_s: 0.0,
        step_s: 0.0,
        corner_m: [0.0, 0.0, 0.0],
        fastest_m_s: 0.0,
        bytes: 0,
    };

    fn of(r: &WindFieldReport) -> Self {
        Self {
            present: 1,
            rests: u32::from(r.rests),
            time_s: r.time_s,
            begun_s: r.begun_s,
            step_s: r.step_s,
            corner_m: r.corner.to_array(),
            fastest_m_s: r.fastest_m_s,
            bytes: r.bytes,
            ..Self::INIT
        }
    }
}

/// Sets a wind field from simulation time start_time_s on, not before the last update or change; NULL ends it then. The
/// same size, mode and walls at another place move it by whole cells; anything else begins it anew. wk_context_update
/// leads it in steps on a grid anchored at time 0, whatever is drawn: the same on every channel. It begins with the
/// steady field of its first moment. Part of the saved state. Unchanged after an error. Thread: exclusive. Errors:
/// WK_ERROR_INVALID_ARGUMENT naming the field and its range; WK_ERROR_WRONG_ORDER for a time that has passed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_wind_field(
    context: *mut wk_context,
    wind_field: *const wk_wind_field,
    start_time_s: f64,
) -> wk_status {
    guard("wk_context_set_wind_field", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        if wind_field.is_null() {
            object.write().set_wind_field(None, start_time_s)?;
            return Ok(Status::Ok);
        }
        // SAFETY: the caller's promise about `wind_field`.
        let c = unsafe { layout::read(&"wind_field", wind_field)? };
        // SAFETY: the caller's promise about its pointers.
        unsafe { layout::check_chain(&"wind_field", c.next, &[])? };
        object.write().set_wind_field(Some(&c.desc()), start_time_s)?;
        Ok(Status::Ok)
    })
}

/// How the wind field stands now.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT for a structure that is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_wind_field_report(
    context: *const wk_context,
    out_report: *mut wk_wind_field_report,
) -> wk_status {
    guard("wk_context_get_wind_field_report", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise.
        let place = unsafe { layout::out_struct(&"out_report", out_report)? };
        let report = object.read().wind_field_report();
        place.set(&report.map_or(wk_wind_field_report::INIT, |r| wk_wind_field_report::of(&r)));
        Ok(Status::Ok)
    })
}
