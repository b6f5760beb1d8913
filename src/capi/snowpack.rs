//! Lying snow
//!
//! The stage SURFACE draws snow onto the host's surfaces that face up, as deep as the weather reports it
//! (wk_weather.surface_snow_depth_m). Shallow snow lies in patches, deeper snow everywhere. With
//! WK_LYING_SNOW_SIMULATED in a wk_simulation_desc the snow is a simulated state: it falls, settles, drifts, slides,
//! melts into the ground's water and refreezes. The state covers level, open ground and each cell of the host's terrain
//! (wk_context_set_ground_grid, wk_context_set_terrain), and wk_context_save keeps it. Standing boxes
//! (wk_context_set_shelters) keep snow off the ground and cause drifts.

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::boundary::{
    guard,
    input::{self, MAX_BATCH, Named, position},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::{Result, Status},
    snowpack::{MAX_STRIP_POINTS, SnowAt, SnowStrip},
};

include!(concat!(env!("OUT_DIR"), "/init_snowpack.rs"));

/// Class of the grip that snow leaves to a wheel.
pub type wk_snow_friction = u32;
/// No snow, or so little that it covers less than 30 % of the ground.
pub const WK_SNOW_FRICTION_BARE: wk_snow_friction = 0;
/// Loose snow, dry or with at most half of the liquid water that it can hold.
pub const WK_SNOW_FRICTION_LOOSE: wk_snow_friction = 1;
/// Snow above 350 kg/m^3: pressed, or packed by wind.
pub const WK_SNOW_FRICTION_PACKED: wk_snow_friction = 2;
/// Slush: snow with more than half of the liquid water that it can hold.
pub const WK_SNOW_FRICTION_SLUSH: wk_snow_friction = 3;
/// Snow above 650 kg/m^3: frozen hard.
pub const WK_SNOW_FRICTION_ICE: wk_snow_friction = 4;

/// Snow at a place. Element of an array, without struct_size; calls take its sizeof instead.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_lying_snow {
    /// Depth, m.
    pub depth_m: f64,
    /// Mass of ice and liquid water, kg/m^2 (millimetres of water).
    pub mass_kg_m2: f64,
    /// Density, kg/m^3; 0 without snow.
    pub density_kg_m3: f64,
    /// Ratio of the liquid water in the snow to the most that the snow can hold, 0 to 1.
    pub wetness: f64,
    /// Albedo for visible light; 0 without snow.
    pub albedo: f64,
    /// Share of the ground that snow covers, 0 to 1.
    pub cover: f64,
    /// Point of the snow's surface above or below the queried position, in the host's world: at the terrain's height
    /// plus the snow's depth. Off the host's terrain, or more than 3 m above it, the queried position itself.
    pub surface_m: [f64; 3],
    /// Grip of a wheel.
    pub friction: wk_snow_friction,
    /// Always 0.
    pub reserved0: u32,
}

impl wk_lying_snow {
    fn of(s: &SnowAt) -> Self {
        Self {
            depth_m: s.depth_m,
            mass_kg_m2: s.mass_kg_m2,
            density_kg_m3: s.density_kg_m3,
            wetness: s.wetness,
            albedo: s.albedo,
            cover: s.cover,
            surface_m: s.surface.to_array(),
            friction: s.friction as u32,
            reserved0: 0,
        }
    }
}

/// A strip of ground: a path with a width. Two points and a width make a rectangle.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_snow_strip {
    /// sizeof(wk_snow_strip) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SNOW_STRIP.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Points of the path in the host's world, m, within 1e12 m of the origin; their heights do not matter. The path
    /// has square ends and round bends. Read during the call.
    pub points_m: *const [f64; 3],
    /// Number of points. Range 2 to 1024.
    pub point_count: u32,
    /// Must be 0.
    pub reserved0: u32,
    /// Width of the strip, m. Range [0.01, 1000], default 1.
    pub width_m: f64,
}

impl wk_snow_strip {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SNOW_STRIP,
        next: null(),
        points_m: null(),
        point_count: 0,
        reserved0: 0,
        width_m: 1.0,
    };
}

/// Reads a strip with its points.
///
/// # Safety
/// `strip` is NULL or points to a struct of the size in its `struct_size`. Its list is NULL or has `point_count`
/// elements.
unsafe fn strip_of(strip: *const wk_snow_strip) -> Result<SnowStrip> {
    // SAFETY: the caller's promise.
    let c = unsafe { layout::read(&"strip", strip)? };
    // SAFETY: the caller's promise about its pointers.
    let points = unsafe {
        layout::check_chain(&"strip", c.next, &[])?;
        let count = Named("strip.point_count", c.point_count as usize);
        input::slice("strip.points_m", c.points_m, count, MAX_STRIP_POINTS)?
    };
    let made = SnowStrip { points: points.iter().map(|p| DVec3::from_array(*p)).collect(), width_m: c.width_m };
    made.validate()
        .map_err(|e| e.renamed("strip.points.len", "strip.point_count").renamed("strip.points", "strip.points_m"))?;
    Ok(made)
}

/// Gets the snow at places of the host's world, at most wk_caps.max_batch of them, as of wk_context_get_state_time. On
/// the host's terrain and up to 3 m above it, the answer is interpolated between the terrain's cells; elsewhere it is
/// that of level, open ground. `position_size` and `snow_size` are the distances from one element to the next, bytes:
/// 24 or more for positions, sizeof(wk_lying_snow) of your header for snow.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an invalid position.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_lying_snow(
    context: *const wk_context,
    positions_m: *const [f64; 3],
    count: u32,
    position_size: u32,
    snow: *mut wk_lying_snow,
    snow_size: u32,
) -> wk_status {
    guard("wk_context_get_lying_snow", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let places = input::Places::new("positions_m", "position_size", positions_m, count, position_size, MAX_BATCH)?;
        let room = input::Room::new("snow", "snow_size", snow, count, snow_size)?;
        let context = object.read();
        let answer = |i: usize| {
            let name = format!("positions_m[{i}]");
            // SAFETY: `i` is below the count that the caller promises.
            let at = unsafe { position(&name, places.at(i))? };
            let found = context.snow_at(DVec3::from_array(at)).map_err(|e| e.renamed("position", &name))?;
            Ok(wk_lying_snow::of(&found))
        };
        let answers = (0..count as usize).map(answer).collect::<Result<Vec<_>>>()?;
        for (i, snow) in answers.iter().enumerate() {
            // SAFETY: the caller's promise about the room, which has as many elements.
            unsafe { room.write(i, snow) };
        }
        Ok(Status::Ok)
    })
}

/// Removes the snow of a strip of the host's terrain except the lowest `left_m` metres (range [0, 100]), as a plough or
/// a shovel does. `out_mass_kg` gets the removed mass and may be NULL.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field; WK_ERROR_WRONG_ORDER without a terrain or without
/// WK_LYING_SNOW_SIMULATED, and while steps of an update remain.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_take_snow(
    context: *mut wk_context,
    strip: *const wk_snow_strip,
    left_m: f64,
    out_mass_kg: *mut f64,
) -> wk_status {
    guard("wk_context_take_snow", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let out = layout::optional_out(&"out_mass_kg", out_mass_kg)?;
        // SAFETY: the caller's promise about `strip`.
        let strip = unsafe { strip_of(strip)? };
        let mass_kg = object.write().take_snow(&strip, left_m)?;
        if let Some(out) = out {
            // SAFETY: checked, and the caller's promise that it points to a double.
            unsafe { out.write(mass_kg) };
        }
        Ok(Status::Ok)
    })
}

/// Compacts the snow of a strip of the host's terrain to 500 kg/m^3 where it is less dense, as a wheel does.
/// Thread: exclusive.
/// Errors: as wk_context_take_snow.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_press_snow(context: *mut wk_context, strip: *const wk_snow_strip) -> wk_status {
    guard("wk_context_press_snow", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `strip`.
        let strip = unsafe { strip_of(strip)? };
        object.write().press_snow(&strip)?;
        Ok(Status::Ok)
    })
}

/// Advances time by `hours`, in (0, 720], with the snow in steps of ten minutes, so that a lesson can begin after a
/// night's snowfall. The laws are those of ordinary steps, but the resulting state differs by up to some percent from
/// the state after ordinary steps. The state records that it was made in this way (wk_context_state_hash). Everything
/// else advances as with wk_context_update, but in this one call: with the largest terrain it may take some seconds.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the range; WK_ERROR_WRONG_ORDER while steps of an update remain.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_accumulate(context: *mut wk_context, hours: f64) -> wk_status {
    guard("wk_context_accumulate", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        object.write().accumulate(hours)?;
        Ok(Status::Ok)
    })
}
