//! Weather over time
//!
//! Simulation time is the host's: seconds in double precision, moved forward by wk_context_update. Weather is a timeline
//! of changes, each with its absolute start and duration; between them it stays. A change that begins while another is
//! under way is laid over it, so neither the weather nor its rate of change jumps. What the host says twice in the same
//! order gives the same weather on every machine.
//!
//! Sun and moon follow from place and universal time, which is tied to simulation time, or are put where the host says.

use std::{ffi::c_void, ptr::null};

use super::{
    boundary::guard,
    context::{self, ContextObject, renamed, wk_context, wk_exposure_mode},
    input::{self, check_finite, out},
    layout::{self, init_struct, struct_size},
    status::*,
    weather::wk_weather,
    weather_convert::{from_c, overrides},
};
use crate::{
    context::GivenDirection,
    error::{Error, Result, Status},
    sky::sun::Utc,
};

include!(concat!(env!("OUT_DIR"), "/init_timeline.rs"));

/// A direction to a light, given by the host in place of the almanac.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_given_direction {
    /// sizeof(wk_given_direction) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_GIVEN_DIRECTION.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Degrees clockwise from true north. Range [-360, 360], default 180.
    pub azimuth_deg: f64,
    /// Degrees above the horizon, without refraction. Range [-90, 90], default 45.
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

/// Changes the weather, beginning at `start_time_s` ([-1e10, 1e10] s) and lasting `transition_s` ([0, 3.2e7] s; 0 is a cut). `weather` may
/// have a wk_weather_overrides in its chain. Copied during the call.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT by the field's name; WK_ERROR_WRONG_ORDER if it begins before the last update or
/// before a change that was given earlier. The weather stays as it was then.
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

/// Moves simulation time to `time_s`, [-1e10, 1e10]; the same time again changes nothing. Call it once a frame before
/// the views record.
/// Thread: exclusive.
/// Answers WK_PENDING if simulation steps remain to be done: call again with the same time.
/// Errors: WK_ERROR_WRONG_ORDER if it lies before the present.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_update(context: *mut wk_context, time_s: f64) -> wk_status {
    guard("wk_context_update", |call| {
        call.get::<ContextObject>("context", context)?.write().update(time_s)?;
        Ok(Status::Ok)
    })
}

/// Ties universal time to simulation time: it is `utc_s` (Unix time, seconds without leap seconds) at simulation time
/// `time_s`. Before the first call it is wk_context_desc.utc_at_zero_s at 0.
/// Thread: exclusive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_clock(context: *mut wk_context, utc_s: f64, time_s: f64) -> wk_status {
    guard("wk_context_set_clock", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let utc = Utc(check_finite("utc_s", utc_s)?);
        object.write().set_clock(utc, time_s).map_err(|e| renamed("utc ", "utc_s ", e))?;
        Ok(Status::Ok)
    })
}

/// Unix time of a calendar date (proleptic Gregorian) and a time of day in UTC. `year` in [-2000, 6000]; `second` in [0, 60), in the
/// last minute of a day in [0, 61): the leap second 23:59:60 is the first second of the next day, as Unix time has it.
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
        check_finite("second", second)?;
        let utc = Utc::from_calendar(year, month, day, hour, minute, second)?;
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(utc.0) };
        Ok(Status::Ok)
    })
}

/// Puts the sun where the host says; NULL returns it to the almanac.
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
        object.write().set_sun(given).map_err(|e| renamed("sun.", "direction.", e))?;
        Ok(Status::Ok)
    })
}

/// Puts the moon where the host says (its phase follows from the sun's place); NULL returns it to the almanac.
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
        object.write().set_moon(given).map_err(|e| renamed("moon.", "direction.", e))?;
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

/// Sets the exposure of frames that bring none; see wk_exposure_mode. WK_EXPOSURE_OF_CONTEXT is refused here.
/// Thread: exclusive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_exposure(
    context: *mut wk_context,
    mode: wk_exposure_mode,
    value: f64,
) -> wk_status {
    guard("wk_context_set_exposure", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        input::check_enum("mode", &layout::WK_EXPOSURE_MODE, mode)?;
        let exposure = context::exposure(mode, check_finite("value", value)?)
            .ok_or_else(|| Error::range("mode", "AUTO, EV100 or FACTOR in a context", "WK_EXPOSURE_OF_CONTEXT"))?;
        exposure.validate().map_err(value_name)?;
        object.write().set_exposure(exposure)?;
        Ok(Status::Ok)
    })
}

/// `exposure.ev100 must ..` as `value must ..`.
fn value_name(e: Error) -> Error {
    let rest = e.message.split_once(' ').map_or("", |m| m.1);
    Error::new(e.status, format!("value {rest}"))
}

/// Writes everything that decides what the context shows from now on: UTF-8 text, the same on every machine.
/// `*out_size` gets the bytes needed, also if `capacity` is too small (then nothing else is written and the call fails)
/// or `buffer` is NULL with `capacity` 0 (then it succeeds).
/// Thread: concurrent.
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

/// Takes up a state that wk_context_save wrote, on a context of the same planet and seed.
/// Thread: exclusive.
/// Errors: WK_ERROR_PARSE for bytes that are no such state or of another version; WK_ERROR_INVALID_ARGUMENT if planet or
/// seed differ. The context stays as it was then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_load(context: *mut wk_context, state: *const c_void, size: usize) -> wk_status {
    guard("wk_context_load", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        layout::check_pointer(&"state", state.cast::<u8>())?;
        // SAFETY: the caller promises `size` readable bytes.
        let bytes = unsafe { input::slice("state", state.cast::<u8>(), size, usize::MAX)? };
        object.write().load(bytes)?;
        Ok(Status::Ok)
    })
}

/// A number that is equal on two channels whose contexts show the same world from now on.
/// Thread: concurrent.
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
