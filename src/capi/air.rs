//! Air at a height
//!
//! Welkin computes temperature, humidity and pressure at any place and altitude from the weather's values at the
//! station, by the laws of the standard atmosphere.

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::boundary::{
    guard,
    input::position,
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::error::Status;

include!(concat!(env!("OUT_DIR"), "/init_air.rs"));

/// Air at a place and altitude.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_air {
    /// sizeof(wk_air) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_AIR.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Temperature, degrees Celsius. It equals the station's temperature at the station's altitude, falls by 6.5 K/km
    /// from there up to 11 km above sea level, and is constant above 11 km.
    pub temperature_c: f64,
    /// Relative humidity over water, 0 to 1. The density of water vapour falls by a factor e every 2 km (ITU-R P.835).
    pub relative_humidity: f64,
    /// Pressure, hPa, in hydrostatic equilibrium (ICAO Doc 7488).
    pub pressure_hpa: f64,
    /// Density of the air, taken as dry, kg/m^3.
    pub density_kg_m3: f64,
}

impl wk_air {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_AIR,
        next: null(),
        temperature_c: 0.0,
        relative_humidity: 0.0,
        pressure_hpa: 0.0,
        density_kg_m3: 0.0,
    };
}

/// Gets temperature, humidity and pressure at a position and a past or future simulation time, with the weather regions
/// there. The answer is for the altitude of the position. The laws hold down to 1 km below the station; lower positions
/// have the air at 1 km below the station.
/// Thread: concurrent.
/// Errors: as wk_context_get_conditions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_air(
    context: *const wk_context,
    position_m: *const [f64; 3],
    time_s: f64,
    out_air: *mut wk_air,
) -> wk_status {
    guard("wk_context_get_air", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promises.
        let (at, place) = unsafe { (position("position_m", position_m)?, layout::out_struct(&"out_air", out_air)?) };
        let air = object.read().air_at(DVec3::from_array(at), time_s);
        let air = air.map_err(|e| e.renamed("position", "position_m"))?;
        place.set(&wk_air {
            temperature_c: air.temperature_c,
            relative_humidity: air.relative_humidity,
            pressure_hpa: air.pressure_hpa,
            density_kg_m3: air.density_kg_m3,
            ..wk_air::INIT
        });
        Ok(Status::Ok)
    })
}
