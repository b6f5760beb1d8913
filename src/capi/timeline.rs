//! Weather over time
//!
//! The host owns simulation time: seconds in double precision, advanced by wk_context_update. Weather is a timeline of
//! changes, each with an absolute start and a duration; between changes it is constant. A change that begins during
//! another one is superimposed on it, so neither the weather nor its rate of change jumps. The same calls in the same
//! order give the same weather on every machine.
//!
//! The positions of sun and moon follow from place and universal time, which is tied to simulation time, unless the
//! host sets them.

use std::{ffi::c_void, ptr::null};

use super::{
    boundary::{
        guard,
        input::{self, Named, out},
        layout::{self, init_struct, struct_size},
        numbers::*,
        objects::{ContextObject, wk_context},
    },
    context::{self, wk_exposure_mode},
    weather::wk_weather,
    weather_convert::{from_c, overrides},
};
use crate::{
    context::{GivenDirection, UPDATE_TIME},
    error::{Error, Result, Status},
    sky::sun::Utc,
};

include!(concat!(env!("OUT_DIR"), "/init_timeline.rs"));

/// Direction to the sun or moon that the host sets in place of the almanac's.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_given_direction {
    /// sizeof(wk_given_direction) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_GIVEN_DIRECTION.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Azimuth, degrees clockwise from true north. Range [-360, 360], default 180.
    pub azimuth_deg: f64,
    /// Elevation above the horizon, degrees, without refraction. Range [-90, 90], default 45.
    pub elevation_deg: f64,
}

impl wk_given_direction {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_GIVEN_DIRECTION,
        next: null(),
        azimuth_deg: 180.0,
        elevation_deg: 45.0,
    };
}

/// Changes the weather, beginning at `start_time_s` ([-1e10, 1e10] s) and lasting `transition_s` ([0, 3.2e7] s; 0
/// changes at once). `weather` may have a wk_weather_overrides in its chain. Copied during the call.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field; WK_ERROR_WRONG_ORDER if the change begins before the last update
/// or before the start of a change that was given earlier. After an error the weather stays as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_weather(
    context: *mut wk_context,
    weather: *const wk_weather,
    start_time_s: f64,
    transition_s: f64,
) -> wk_status {
    guard("wk_context_set_weather", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `weather`.
        let (given, overrides) = unsafe { (from_c("weather", weather)?, overrides("weather", weather)?) };
        object.write().set_weather_with(&given, &overrides, start_time_s, transition_s)?;
        Ok(Status::Ok)
    })
}

/// Advances simulation time to `time_s`, [-1e10, 1e10]; the same time again changes nothing. Call it once a frame
/// before the views record. Weather and light are functions of time and change at once. Simulated states take steps:
/// water (WK_GROUND_SIMULATED) every 10 s, snow (WK_LYING_SNOW_SIMULATED) every 60 s, soil every 1/64 s; a wind field
/// has steps of its own. One call computes steps for at most 50 ms, and at least one step. If steps remain, as after a
/// leap of hours, the call returns WK_PENDING: call it again with the same time, in a loop or once a frame, until it
/// returns WK_OK. Until then, simulated states are drawn and queried as of wk_context_get_state_time, and settings and
/// later times take effect only after the remaining steps. The state therefore does not depend on the number of calls.
/// After a leap of more than a day, the water is simulated for the last day only. The ground starts that day as wet as
/// the weather of that time reports. Snow then takes steps of ten minutes, for the last 30 days at most.
/// Thread: exclusive.
/// Returns WK_PENDING, which is no error, while steps remain.
/// Errors: WK_ERROR_INVALID_ARGUMENT for a time out of range; WK_ERROR_WRONG_ORDER if `time_s` is before the present.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_update(context: *mut wk_context, time_s: f64) -> wk_status {
    guard("wk_context_update", |call| {
        call.get::<ContextObject>("context", context)?.write().update_within(time_s, UPDATE_TIME)
    })
}

/// Gets the simulation time of the state, s: the time of the last wk_context_update, or an earlier one while
/// wk_context_update returns WK_PENDING. The difference from the time of the last wk_context_update is the lag of the
/// state. The state's time never decreases, except by wk_context_load.
/// Thread: concurrent.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_state_time(
    context: *const wk_context,
    out_state_time_s: *mut f64,
) -> wk_status {
    guard("wk_context_get_state_time", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let place = out("out_state_time_s", out_state_time_s)?;
        let state_time_s = object.read().state_time_s();
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(state_time_s) };
        Ok(Status::Ok)
    })
}

/// Ties universal time to simulation time: universal time is `utc_s` (Unix time, seconds without leap seconds) at
/// simulation time `time_s`. Before the first call, universal time is wk_context_desc.utc_at_zero_s at simulation
/// time 0.
/// Thread: exclusive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_clock(context: *mut wk_context, utc_s: f64, time_s: f64) -> wk_status {
    guard("wk_context_set_clock", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let utc = Utc(utc_s);
        object.write().set_clock(utc, time_s).map_err(|e| e.renamed("utc", "utc_s"))?;
        Ok(Status::Ok)
    })
}

/// Gets the Unix time of a calendar date (proleptic Gregorian) and a time of day in UTC. `year` lies in [-2000, 6000].
/// `second` lies in [0, 60), or in [0, 61) in the last minute of a day: the leap second 23:59:60 is the first second of
/// the next day, as in Unix time.
/// Thread: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_utc_from_calendar(
    year: i32,
    month: u32,
    day: u32,
    hour: u32,
    minute: u32,
    second: f64,
    out_utc_s: *mut f64,
) -> wk_status {
    guard("wk_utc_from_calendar", |_| {
        let place = out("out_utc_s", out_utc_s)?;
        let utc = Utc::from_calendar(year, month, day, hour, minute, second)?;
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(utc.0) };
        Ok(Status::Ok)
    })
}

/// Sets the direction of the sun; NULL returns to the almanac.
/// Thread: exclusive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_sun(
    context: *mut wk_context,
    direction: *const wk_given_direction,
) -> wk_status {
    guard("wk_context_set_sun", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `direction`.
        let given = unsafe { given_direction(direction)? };
        object.write().set_sun(given).map_err(|e| e.renamed("sun", "direction"))?;
        Ok(Status::Ok)
    })
}

/// Sets the direction of the moon (its phase follows from the sun's direction); NULL returns to the almanac.
/// Thread: exclusive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_moon(
    context: *mut wk_context,
    direction: *const wk_given_direction,
) -> wk_status {
    guard("wk_context_set_moon", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `direction`.
        let given = unsafe { given_direction(direction)? };
        object.write().set_moon(given).map_err(|e| e.renamed("moon", "direction"))?;
        Ok(Status::Ok)
    })
}

/// # Safety
/// `p` is NULL or a `wk_given_direction`.
unsafe fn given_direction(p: *const wk_given_direction) -> Result<Option<GivenDirection>> {
    if p.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's promise.
    let c = unsafe { layout::read(&"direction", p)? };
    // SAFETY: as above.
    unsafe { layout::check_chain(&"direction", c.next, &[])? };
    Ok(Some(GivenDirection { azimuth_deg: c.azimuth_deg, elevation_deg: c.elevation_deg }))
}

/// Sets the exposure of frames that do not set their own. `value` has the meaning and range that wk_exposure_mode
/// states for `mode`; WK_EXPOSURE_OF_CONTEXT is refused here.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the parameter and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_exposure(
    context: *mut wk_context,
    mode: wk_exposure_mode,
    value: f64,
) -> wk_status {
    guard("wk_context_set_exposure", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        input::check_enum("mode", &layout::WK_EXPOSURE_MODE, mode)?;
        let exposure = context::exposure(mode, value)
            .ok_or_else(|| Error::range("mode", "AUTO, EV100 or FACTOR in a context", "WK_EXPOSURE_OF_CONTEXT"))?;
        exposure.validate().map_err(|e| e.map_field(|_| "value".into()))?;
        object.write().set_exposure(exposure)?;
        Ok(Status::Ok)
    })
}

/// Writes everything that decides what the context shows from now on, as UTF-8 text, the same on every machine:
/// weather, weather regions, time, clock, directions of sun and moon that the host set, planet, exposure, tone curve,
/// fog law, cloud map and model, lightning, night sky, shelters, lamps, rain areas, wind grid and wind field, the
/// terrain with its water, snow and soil, the default surface class, the sea with its regions and hulls, and the world,
/// place, seed and models of ground and snow that the state belongs to. For the tiles of a wk_terrain the text has the
/// water, snow and soil, not the host's heights. Not included: how the state is drawn (sky settings, views, plans,
/// wk_terrain_drawing), the host's own list of stars, and the images of wk_context_set_occluder_maps, because each
/// channel may have its own.
/// `*out_size` always gets the number of bytes needed. If `capacity` is too small, nothing else is written and the call
/// fails; with `buffer` NULL and `capacity` 0 it succeeds.
/// Thread: concurrent.
/// Errors: WK_ERROR_WRONG_ORDER while wk_context_update returns WK_PENDING.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_save(
    context: *const wk_context,
    buffer: *mut c_void,
    capacity: usize,
    out_size: *mut usize,
) -> wk_status {
    guard("wk_context_save", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let saved = object.read().save()?;
        // SAFETY: the caller's promises.
        unsafe { input::answer_bytes(&saved, buffer, capacity, out_size)? };
        Ok(Status::Ok)
    })
}

/// Loads a state that wk_context_save wrote and replaces the context's own. The context must have been created with the
/// same world_kind, latitude_deg, longitude_deg, altitude_m, axes and grid_bearing_deg (for WK_WORLD_ECEF
/// geoid_height_m in place of the last two), seed, ground_model and lying_snow_model. If a state of an earlier version
/// lacks the planet and the tone curve, the context must also have the planet and the tone curve with which that state
/// was saved. Occluder maps stay as they are. Tiles of a wk_terrain stay too: before the call, set them as they were
/// when the state was saved.
/// Thread: exclusive.
/// Errors: WK_ERROR_PARSE for bytes that are no saved state, for a truncated or changed state, and for a state of
/// another format, which the message names (this version reads format 2; save states of format 1 again, because they
/// did not record their place); WK_ERROR_INVALID_ARGUMENT naming all settings that differ. After an error the context
/// stays as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_load(context: *mut wk_context, state: *const c_void, size: usize) -> wk_status {
    guard("wk_context_load", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        layout::check_pointer(&"state", state.cast::<u8>())?;
        // SAFETY: the caller promises `size` readable bytes.
        let bytes = unsafe { input::slice("state", state.cast::<u8>(), Named("size", size), usize::MAX)? };
        object.write().load(bytes).map_err(|e| e.in_text("state"))?;
        Ok(Status::Ok)
    })
}

/// Gets a hash of the state that wk_context_save writes. It is equal on two channels whose contexts show the same world
/// from now on.
/// Thread: concurrent.
/// Errors: WK_ERROR_WRONG_ORDER while wk_context_update returns WK_PENDING.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_state_hash(context: *const wk_context, out_hash: *mut u64) -> wk_status {
    guard("wk_context_state_hash", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let place = out("out_hash", out_hash)?;
        let hash = object.read().state_hash()?;
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(hash) };
        Ok(Status::Ok)
    })
}
