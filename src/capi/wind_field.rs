//! Wind round terrain and buildings
//!
//! A context can solve for the wind in a box of air about a place. The weather's wind enters the box, flows round the
//! terrain of wk_context_set_ground_grid or wk_context_set_terrain and round the boxes of wk_context_set_shelters,
//! including moving ones, and leaves on the downwind side. As a wind grid of your own does (wk_context_set_wind_grid),
//! the field acts in wk_context_get_wind_at, in the rain on surfaces and windscreens, on drifting snow, on patches of
//! fog and dust, and on drops and flakes near a camera. Without wk_context_set_wind_field nothing is solved.

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::boundary::{
    guard,
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::{Error, Result, Status, check_range},
    flow::{PressureMethod, Scheme, WindFieldDesc, WindFieldMode, WindFieldReport, WindWalls},
};

include!(concat!(env!("OUT_DIR"), "/init_wind_field.rs"));

/// Time dependence of a wind field.
pub type wk_wind_field_mode = u32;
/// The mean wind. The field is solved for in the first seconds of simulation time after the wind or an obstacle has
/// changed. Afterwards it rests at no cost. The weather's gusts are scaled in proportion to the local mean wind.
pub const WK_WIND_FIELD_STEADY: wk_wind_field_mode = 0;
/// The wind with its gusts and eddies, and with the eddies that obstacles shed, stepped all the time.
/// docs/wind-field.md says how much time a step takes on one CPU core.
pub const WK_WIND_FIELD_RUNNING: wk_wind_field_mode = 1;

/// Friction of terrain and boxes on air that flows along them.
pub type wk_wind_walls = u32;
/// Terrain and boxes slow the air, by the weather's roughness length.
pub const WK_WIND_WALLS_ROUGH: wk_wind_walls = 0;
/// Air slides along terrain and boxes without friction.
pub const WK_WIND_WALLS_SMOOTH: wk_wind_walls = 1;

/// Scheme by which the air of a wind field carries its own velocity. src/flow/mod.rs has the errors of each.
pub type wk_wind_scheme = u32;
/// Half a step of advection, a projection, a reflection about the projected field, another half step and a projection
/// (Zehnder et al. 2018). The interpolation is cubic and limited. Eddies keep their energy.
pub const WK_WIND_SCHEME_REFLECTION: wk_wind_scheme = 0;
/// Linear interpolation along curved paths, corrected by the error that appears when the result is carried back (Selle
/// et al. 2008).
pub const WK_WIND_SCHEME_MACCORMACK: wk_wind_scheme = 1;
/// Linear interpolation along straight paths (Stam 1999): the cheapest; it smears eddies within seconds.
pub const WK_WIND_SCHEME_SEMI_LAGRANGIAN: wk_wind_scheme = 2;

/// Method that solves for the pressure of a wind field.
pub type wk_wind_pressure = u32;
/// Conjugate gradients preconditioned by multigrid V-cycles, until the remaining divergence is small.
pub const WK_WIND_PRESSURE_MULTIGRID: wk_wind_pressure = 0;
/// Red-black successive over-relaxation, until the remaining divergence is small or most_iterations is reached. With
/// few iterations air is made and lost behind obstacles.
pub const WK_WIND_PRESSURE_RELAXATION: wk_wind_pressure = 1;

/// A box of air in which the wind is solved for: level and aligned to true north. Within four cells of the box's sides
/// and top, the solved wind blends into the weather's wind.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_wind_field {
    /// sizeof(wk_wind_field) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_WIND_FIELD.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Middle of the field's floor, in the host's world, m, within 1e12 m of the origin; no higher than the lowest
    /// ground that matters. If you set the field again with another point, the field moves by whole cells. Default 0,
    /// 0, 0.
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
    /// Largest memory for the field, bytes. A field that needs more is refused, and the message says how much it needs.
    /// Range [1048576, 17179869184], default 1073741824.
    pub most_bytes: u64,
    /// A WK_WIND_SCHEME_ constant, default WK_WIND_SCHEME_REFLECTION. Part of the saved state.
    pub scheme: wk_wind_scheme,
    /// A WK_WIND_PRESSURE_ constant, default WK_WIND_PRESSURE_MULTIGRID. Part of the saved state.
    pub pressure: wk_wind_pressure,
    /// Largest number of V-cycles in one projection, [0, 1000]; with WK_WIND_PRESSURE_RELAXATION, largest number of
    /// iterations, [0, 1000000]. 0, the default, means 50 V-cycles or 5 iterations.
    pub most_iterations: u32,
    /// Must be 0.
    pub reserved1: u32,
    /// Relaxation factors of the first and of the last possible iteration, both in (0, 2); between them the factor
    /// changes linearly. V-cycles ignore them. Default 0, 0, which means 1.7, 1.1.
    pub relaxation: [f32; 2],
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
        scheme: WK_WIND_SCHEME_REFLECTION,
        pressure: WK_WIND_PRESSURE_MULTIGRID,
        most_iterations: 0,
        reserved1: 0,
        relaxation: [0.0, 0.0],
    };

    fn pressure_method(&self) -> Result<PressureMethod> {
        let is_relaxed = self.pressure == WK_WIND_PRESSURE_RELAXATION;
        let most = if is_relaxed { 1_000_000 } else { 1000 };
        check_range("wind_field.most_iterations", self.most_iterations.into(), 0.0, f64::from(most), "")?;
        let chosen = |default: u32| if self.most_iterations == 0 { default } else { self.most_iterations };
        if !is_relaxed {
            return Ok(PressureMethod::Multigrid { max_cycles: chosen(50) });
        }
        if self.relaxation == [0.0; 2] {
            return Ok(PressureMethod::Sor { relaxation: [1.7, 1.1], max_iterations: chosen(5) });
        }
        for (i, factor) in self.relaxation.into_iter().enumerate() {
            if !(factor > 0.0 && factor < 2.0) {
                return Err(Error::range(&format!("wind_field.relaxation[{i}]"), "in (0, 2), or both 0", factor));
            }
        }
        Ok(PressureMethod::Sor { relaxation: self.relaxation, max_iterations: chosen(5) })
    }

    fn desc(&self) -> Result<WindFieldDesc> {
        Ok(WindFieldDesc {
            floor_center: DVec3::from_array(self.floor_center_m),
            cell_m: DVec3::from_array(self.cell_m),
            cells: self.cells,
            mode: if self.mode == WK_WIND_FIELD_RUNNING { WindFieldMode::Running } else { WindFieldMode::Steady },
            walls: if self.walls == WK_WIND_WALLS_SMOOTH { WindWalls::Smooth } else { WindWalls::Rough },
            scheme: match self.scheme {
                WK_WIND_SCHEME_SEMI_LAGRANGIAN => Scheme::SemiLagrangian,
                WK_WIND_SCHEME_MACCORMACK => Scheme::MacCormack,
                _ => Scheme::Reflection,
            },
            pressure: self.pressure_method()?,
            most_bytes: self.most_bytes,
        })
    }
}

/// State of a wind field.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_wind_field_report {
    /// sizeof(wk_wind_field_report) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_WIND_FIELD_REPORT.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// 1: there is a field. 0: none is set, its start time has not come, or its first steady state is still being
    /// solved for. While this field is 0, all others are 0 too.
    pub present: u32,
    /// 1: the field is steady and rests; nothing is stepped.
    pub rests: u32,
    /// Simulation time of the field, s: the present, or up to one step before it.
    pub time_s: f64,
    /// Simulation time at which the field last began from a steady state, s: when it was first set, after a leap of
    /// more than 60 s, or after a move too far for its cells to follow.
    pub begun_s: f64,
    /// Length of the field's steps, s.
    pub step_s: f64,
    /// Lowest, south-western corner of the field, in the host's world, m.
    pub corner_m: [f64; 3],
    /// Largest component of the wind anywhere in the field, m/s.
    pub fastest_m_s: f64,
    /// Memory that the field may use, bytes.
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

/// Sets a wind field from simulation time `start_time_s` on, [-1e10, 1e10] s, not before the last update or change;
/// NULL ends the field at that time. If only the place differs from that of the present field, by less than half of the
/// cells along each axis, the field moves there by whole cells. If it moves farther, or if the size, mode, walls,
/// scheme or pressure method differs, the field begins anew. A new field begins with the steady wind at the time of its
/// first step. wk_context_update advances the field in steps that end at multiples of wk_wind_field_report.step_s,
/// whatever is drawn, so it is the same on all channels of a simulator. Part of the saved state. Unchanged after an
/// error.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range; WK_ERROR_WRONG_ORDER for a time that has passed.
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
        object.write().set_wind_field(Some(&c.desc()?), start_time_s)?;
        Ok(Status::Ok)
    })
}

/// Gets the state of the wind field now.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an invalid output struct.
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
