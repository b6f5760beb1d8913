//! Stars
//!
//! At night every view draws the 9096 stars of the Yale Bright Star Catalogue, Mercury to Uranus, the airglow, the
//! zodiacal light and the Milky Way behind its sky, at their positions for the context's place and time. By day, in fog
//! and under closed clouds none of them is drawn. A budget may leave all of these lights out (WK_PART_STARS).

use std::{ffi::c_void, ptr::null};

use glam::{DMat3, DVec3};

use super::boundary::{
    guard,
    input::{self, Named, position},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::{Error, Result, Status, check_range},
    stars::{Star, StarSettings, settings::MAX_STARS},
};

include!(concat!(env!("OUT_DIR"), "/init_stars.rs"));

/// Flags of a wk_stars.
pub type wk_stars_flags = u32;
/// stars and star_count: the host's own stars replace the catalogue's.
pub const WK_STARS_OWN: wk_stars_flags = 1;
/// celestial_to_world: the host orients the celestial sphere itself.
pub const WK_STARS_TURNED: wk_stars_flags = 2;
/// No planets.
pub const WK_STARS_NO_PLANETS: wk_stars_flags = 4;

/// Settings of the night sky.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_stars {
    /// sizeof(wk_stars) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_STARS.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// WK_STARS_ flags: the settings that replace the defaults. Default 0: the stars of the catalogue and the planets,
    /// at their positions over the Earth.
    pub flags: wk_stars_flags,
    /// Number of stars in `stars`, at most 1 000 000. Default 0.
    pub star_count: u32,
    /// With WK_STARS_OWN: four numbers for each star: right ascension, degrees in [-1e6, 1e6], and declination, degrees
    /// in [-90, 90], both in the equator and equinox of J2000.0; visual magnitude in [-30, 30]; colour temperature of a
    /// black body, K, in [1000, 100000]. Copied by the call. Default NULL.
    pub stars: *const f64,
    /// With WK_STARS_TURNED: rotation from the equator and equinox of J2000.0 (x to the equinox, z to the north pole)
    /// to (east, north, up), column-major. Default the identity.
    pub celestial_to_world: [f64; 9],
    /// Strength of the airglow. Range [0, 10], default 1, as near the minimum of solar activity; 1.7 at the maximum.
    pub airglow: f64,
}

impl wk_stars {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_STARS,
        next: null(),
        flags: 0,
        star_count: 0,
        stars: null(),
        celestial_to_world: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        airglow: 1.0,
    };
}

/// Reads and checks the settings of a night sky.
///
/// # Safety
/// `p` is NULL or points to a `wk_stars` whose list has `star_count` stars.
unsafe fn settings(p: *const wk_stars) -> Result<StarSettings> {
    // SAFETY: the caller's promise.
    let c = unsafe { layout::read(&"stars", p)? };
    // SAFETY: as above.
    let list: &[[f64; 4]] = unsafe {
        layout::check_chain(&"stars", c.next, &[])?;
        input::slice("stars.stars", c.stars.cast(), Named("stars.star_count", c.star_count as usize), MAX_STARS)?
    };
    let star = |(i, [right_ascension, declination, magnitude, temperature]): (usize, &[f64; 4])| {
        // Errors name a number by its index in the host's list.
        let number = |k: usize| format!("stars.stars[{}]", 4 * i + k);
        check_range(&number(0), *right_ascension, -1e6, 1e6, "deg")?;
        check_range(&number(1), *declination, -90.0, 90.0, "deg")?;
        let star = Star::new(*right_ascension, *declination, *magnitude, *temperature);
        let of_list = |e: Error| e.renamed("star.magnitude", &number(2)).renamed("star.temperature_k", &number(3));
        star.validate("star").map_err(of_list)?;
        Ok(star)
    };
    let stars = list.iter().enumerate().map(star).collect::<Result<_>>()?;
    let settings = StarSettings {
        stars: (c.flags & WK_STARS_OWN != 0).then_some(stars),
        planets: c.flags & WK_STARS_NO_PLANETS == 0,
        celestial_to_world: (c.flags & WK_STARS_TURNED != 0).then(|| DMat3::from_cols_array(&c.celestial_to_world)),
        airglow: c.airglow,
    };
    settings.validate().map_err(|e| e.within("stars"))?;
    Ok(settings)
}

/// Sets how the night sky is drawn; NULL returns to the default. Part of the saved state, except the list of stars: a
/// context that loads a state keeps its own list. Unchanged after an error.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_stars(context: *mut wk_context, stars: *const wk_stars) -> wk_status {
    guard("wk_context_set_stars", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `stars`.
        let settings = if stars.is_null() { StarSettings::default() } else { unsafe { settings(stars)? } };
        object.write().set_stars(settings)?;
        Ok(Status::Ok)
    })
}

/// Gets the magnitude, as catalogues give it, of the faintest star that the naked eye sees straight up from a place at
/// a simulation time. This magnitude decreases with the brightness of the sky, and with the extinction of the star's
/// light in air, fog and clouds. It is minus infinity where no starlight gets through.
/// Thread: concurrent.
/// Errors: as wk_context_get_conditions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_limiting_magnitude_at(
    context: *const wk_context,
    position_m: *const [f64; 3],
    time_s: f64,
    out_magnitude: *mut f64,
) -> wk_status {
    guard("wk_context_get_limiting_magnitude_at", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let place = input::out("out_magnitude", out_magnitude)?;
        // SAFETY: the caller's promise.
        let at = DVec3::from_array(unsafe { position("position_m", position_m)? });
        let named = |e: Error| e.renamed("position", "position_m");
        let magnitude = object.read().limiting_magnitude(at, time_s).map_err(named)?;
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(magnitude) };
        Ok(Status::Ok)
    })
}
