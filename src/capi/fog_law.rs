//! Fog laws of older simulators
//!
//! Normally fog follows from the weather and is lit by sun and sky. For pictures that must look as in an older
//! simulator, Welkin can draw the older laws instead: linear, exponential or exponential squared, by range or by plane
//! distance.

use std::{ffi::c_void, ptr::null};

use super::boundary::{
    guard,
    input::out,
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::{Error, Result, Status, check_range},
    fog::{
        CompatibilityLaw, Law, MAX_EXTINCTION_PER_M, koschmieder_extinction_per_m,
        laws::{CULL_THRESHOLD, Curve, DistanceKind, cull_distance_m},
    },
};

include!(concat!(env!("OUT_DIR"), "/init_fog_law.rs"));

/// Curve of the fog: V is the share of an object's colour that is left at distance d. V = 1 is clear, V = 0 is all fog.
pub type wk_fog_curve = u32;
/// No fog at all, whatever the weather.
pub const WK_FOG_CURVE_CLEAR: wk_fog_curve = 0;
/// V = (end - d) / (end - start), clamped.
pub const WK_FOG_CURVE_LINEAR: wk_fog_curve = 1;
/// V = exp(-density d).
pub const WK_FOG_CURVE_EXPONENTIAL: wk_fog_curve = 2;
/// V = exp(-(density d)^2).
pub const WK_FOG_CURVE_EXPONENTIAL_SQUARED: wk_fog_curve = 3;

/// Measure of distance.
pub type wk_fog_distance = u32;
/// Distance from the camera's centre: turning the camera changes nothing.
pub const WK_FOG_DISTANCE_RANGE: wk_fog_distance = 0;
/// Distance from the plane through the camera at right angles to its viewing direction, as in the oldest systems.
pub const WK_FOG_DISTANCE_PLANE: wk_fog_distance = 1;

/// Flags that name the optional fields of a wk_fog_law that the host has set.
pub type wk_fog_law_has_flags = u32;
/// color
pub const WK_FOG_LAW_HAS_COLOR: wk_fog_law_has_flags = 1;

/// A fog law in place of the weather's fog.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_fog_law {
    /// sizeof(wk_fog_law) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_FOG_LAW.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Curve of the fog. Default WK_FOG_CURVE_CLEAR.
    pub curve: wk_fog_curve,
    /// Measure of distance. Default WK_FOG_DISTANCE_RANGE.
    pub distance: wk_fog_distance,
    /// WK_FOG_LAW_HAS_* flags: the optional fields that the host has set. Default 0.
    pub has: wk_fog_law_has_flags,
    /// Must be 0.
    pub reserved0: u32,
    /// Distance where linear fog begins, m. Range [0, 1e9], default 0.
    pub start_m: f64,
    /// Distance where linear fog is complete, m. Above start_m, at most 1e9; default 1000.
    pub end_m: f64,
    /// Density of exponential and exponential squared fog, 1/m. Range [0, 10], default 0.003.
    pub density_per_m: f64,
    /// Optional: radiance into which the picture fades, cd/m^2 per channel. Range [0, 1e12]. Without it Welkin uses the
    /// radiance of deep fog under the present light.
    pub color: [f64; 3],
    /// Elevation above the horizon up to which sky pixels fade, rad. The fade is full at the horizon and ends at this
    /// elevation. Range [0, pi], default 0.2. 0 leaves the sky as it is, pi covers all of it.
    pub sky_band: f64,
}

impl wk_fog_law {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_FOG_LAW,
        next: null(),
        curve: WK_FOG_CURVE_CLEAR,
        distance: WK_FOG_DISTANCE_RANGE,
        has: 0,
        reserved0: 0,
        start_m: 0.0,
        end_m: 1000.0,
        density_per_m: 0.003,
        color: [0.0, 0.0, 0.0],
        sky_band: 0.2,
    };
}

/// Reads and checks a fog law.
///
/// # Safety
/// `p` is NULL or a `wk_fog_law`.
unsafe fn law(p: *const wk_fog_law) -> Result<Law> {
    // SAFETY: the caller's promise.
    let c = unsafe { layout::read(&"fog_law", p)? };
    // SAFETY: as above.
    unsafe { layout::check_chain(&"fog_law", c.next, &[])? };
    let curve = match c.curve {
        WK_FOG_CURVE_LINEAR => Curve::Linear { start_m: c.start_m, end_m: c.end_m },
        WK_FOG_CURVE_EXPONENTIAL => Curve::Exponential { density_per_m: c.density_per_m },
        WK_FOG_CURVE_EXPONENTIAL_SQUARED => Curve::ExponentialSquared { density_per_m: c.density_per_m },
        // The clear law draws no curve. Its figures must still be in range.
        _ => Curve::Exponential { density_per_m: c.density_per_m },
    };
    let plane = c.distance == WK_FOG_DISTANCE_PLANE;
    let law = CompatibilityLaw {
        curve,
        distance: if plane { DistanceKind::Plane } else { DistanceKind::Range },
        colour: (c.has & WK_FOG_LAW_HAS_COLOR != 0).then_some(c.color),
        sky_band: c.sky_band,
    };
    law.validate().map_err(in_law)?;
    check_unused(&c).map_err(in_law)?;
    Ok(if c.curve == WK_FOG_CURVE_CLEAR { Law::Clear } else { Law::Compatibility(law) })
}

/// Checks the figures of the curves that `law` does not use. These figures are not drawn, but a host that sets one out
/// of range has made a mistake.
fn check_unused(law: &wk_fog_law) -> Result<()> {
    check_range("fog.start_m", law.start_m, 0.0, 1e9, "m")?;
    check_range("fog.end_m", law.end_m, 0.0, 1e9, "m")?;
    check_range("fog.density_per_m", law.density_per_m, 0.0, MAX_EXTINCTION_PER_M, "1/m")
}

/// Renames a law's errors to the header's field names.
fn in_law(e: Error) -> Error {
    e.renamed("fog.colour", "fog_law.color").renamed("fog", "fog_law")
}

/// Draws a fog law in place of the weather's fog; NULL returns to the weather's fog.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_fog_law(context: *mut wk_context, fog_law: *const wk_fog_law) -> wk_status {
    guard("wk_context_set_fog_law", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `fog_law`.
        let law = if fog_law.is_null() { None } else { Some(unsafe { law(fog_law)? }) };
        object.write().set_fog_law(law)?;
        Ok(Status::Ok)
    })
}

/// Gets the distance beyond which a fog law leaves less than 1/255 of an object's colour, m: you need not draw anything
/// farther away. The distance is measured as the law says (wk_fog_distance). It is infinite if the law always leaves
/// more.
/// Thread: any.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_fog_law_cull_distance(fog_law: *const wk_fog_law, out_distance_m: *mut f64) -> wk_status {
    guard("wk_fog_law_cull_distance", |_| {
        let place = out("out_distance_m", out_distance_m)?;
        // SAFETY: the caller's promise about `fog_law`.
        let distance = match unsafe { law(fog_law)? } {
            Law::Compatibility(law) => law.cull_distance_m(CULL_THRESHOLD),
            _ => f64::INFINITY,
        };
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(distance) };
        Ok(Status::Ok)
    })
}

/// Gets the distance beyond which air of a given visibility leaves less than 1/255 of an object's contrast, m: about
/// 1.85 times the visibility. visibility_m is the meteorological optical range, m, [1, 1e6].
/// Thread: any.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the parameter and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_visibility_cull_distance(visibility_m: f64, out_distance_m: *mut f64) -> wk_status {
    guard("wk_visibility_cull_distance", |_| {
        let place = out("out_distance_m", out_distance_m)?;
        check_range("visibility_m", visibility_m, 1.0, 1e6, "m")?;
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(cull_distance_m(koschmieder_extinction_per_m(visibility_m))) };
        Ok(Status::Ok)
    })
}
