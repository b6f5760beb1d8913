//! The sea: settings and queries
//!
//! Describe your sea. Queries then give the height and slope of its surface and the motion of the water at any time, so
//! that a hull can float by the answers. Without settings a context has no sea. A wave height, swell or water
//! temperature that you set here replaces that of the weather (wk_weather.sea_significant_wave_height_m,
//! swell_height_m, sea_temperature_c). If neither you nor the weather gives a wave height or a sea state, the weather's
//! wind raises the waves by fetch and duration. The waves have the requested height within 1 %, their pattern does not
//! repeat, and the same time gives the same bits on every machine. Regions (wk_context_set_sea_regions) describe dry
//! places, sheltered harbours, and lakes with a level of their own. Hulls (wk_context_set_sea_hulls) raise wakes.
//!
//! ```text
//! wk_sea sea = WK_SEA_INIT;
//! sea.has = WK_SEA_HAS_HEIGHT | WK_SEA_HAS_PEAK_PERIOD;
//! sea.significant_height_m = 2.1;
//! sea.peak_period_s = 6.2;
//! wk_context_set_sea(context, &sea);
//! wk_context_get_sea_at(context, corners_m, 4, sizeof corners_m[0], time_s, 0.0, points, sizeof points[0]);
//! ```

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::boundary::{
    guard,
    input::{self, List, MAX_BATCH, Named, position},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::{Error, Result, Status},
    sea::{
        MAX_OUTLINE_CORNERS, MAX_SEA_HULLS, MAX_SEA_REGIONS, MAX_SINGLE_WAVES, MAX_SWELLS, SeaSettings, SeaStatistics,
    },
};

pub use super::sea_structs::*;

include!(concat!(env!("OUT_DIR"), "/init_sea.rs"));

/// Renames the field in an error: a field of [`SeaSettings`] gets its name in the header.
fn header_name(e: Error) -> Error {
    let flat = |field: &str| match field {
        "wind_sea.significant_m" => "significant_height_m".into(),
        "wind_sea.gamma" => "peak_gamma".into(),
        "from_deg" => "wind_sea_from_deg".into(),
        "swells" => "swell_count".into(),
        "waves" => "wave_count".into(),
        other => match other.strip_prefix("wind_sea.") {
            Some(field) => field.into(),
            None => other.replace("tide.", "tide_").replace("ice.", "ice_").replace("clarity.", "clarity_"),
        },
    };
    e.map_field(flat).within("sea")
}

/// Reads a sea with its lists.
///
/// # Safety
/// `sea` is NULL or points to a struct of the size in its `struct_size`. Each of its lists is NULL or has as many
/// elements as its count says.
unsafe fn settings_of(sea: *const wk_sea) -> Result<SeaSettings> {
    // SAFETY: the caller's promise.
    let c = unsafe { layout::read(&"sea", sea)? };
    // SAFETY: as above.
    unsafe { layout::check_chain(&"sea", c.next, &[])? };
    let mut settings = c.settings()?;
    if let Some(swells) = &mut settings.swells {
        let list = List {
            name: "sea.swells",
            count: Named("sea.swell_count", c.swell_count as usize),
            stride: Named("sea.swell_stride", c.swell_stride as usize),
            limit: MAX_SWELLS,
        };
        let mut take = |_: usize, swell: wk_sea_swell| {
            swells.push(swell.swell());
            Ok(())
        };
        // SAFETY: the caller's promise about the lists.
        unsafe { input::each(&list, c.swells, &mut take)? };
    }
    let list = List {
        name: "sea.waves",
        count: Named("sea.wave_count", c.wave_count as usize),
        stride: Named("sea.wave_stride", c.wave_stride as usize),
        limit: MAX_SINGLE_WAVES,
    };
    let mut take = |i: usize, wave: wk_sea_wave| {
        settings.waves.push(wave.wave(&format!("sea.waves[{i}]"))?);
        Ok(())
    };
    // SAFETY: as above.
    unsafe { input::each(&list, c.waves, &mut take)? };
    Ok(settings)
}

/// Sets the sea; NULL removes it. Part of the saved state. Set it before the first update: waves grow from the past
/// weather that the timeline still knows, and updates forget past weather. A new fetch applies to all of this past.
/// Unchanged after an error.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range, also for two sources of the wave height.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_sea(context: *mut wk_context, sea: *const wk_sea) -> wk_status {
    guard("wk_context_set_sea", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `sea`.
        let settings = if sea.is_null() { None } else { Some(unsafe { settings_of(sea)? }) };
        object.write().set_sea(settings).map_err(header_name)?;
        Ok(Status::Ok)
    })
}

/// Replaces the list of regions, at most 64; count 0 removes all. Regions move at their velocity and rate of turn by
/// themselves: set them again when these change. Where regions overlap, the last one in the list applies, but a dry one
/// takes precedence over all others. Part of the saved state. Unchanged after an error.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the element, its field and range, or for an outline that crosses itself.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_sea_regions(
    context: *mut wk_context,
    regions: *const wk_sea_region,
    count: u32,
    stride: u32,
) -> wk_status {
    guard("wk_context_set_sea_regions", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let mut list = Vec::new();
        let mut take = |i: usize, c: wk_sea_region| {
            let (of, name) = (c.corner_count as usize, format!("regions[{i}].corner_count"));
            // SAFETY: the caller's promise about the corners.
            let corners = unsafe {
                input::slice(&format!("regions[{i}].corners_m"), c.corners_m, Named(&name, of), MAX_OUTLINE_CORNERS)?
            };
            list.push(c.region(corners.to_vec()));
            Ok(())
        };
        // SAFETY: the caller's promise about `regions`.
        unsafe { input::each(&List::parameters("regions", count, stride, MAX_SEA_REGIONS), regions, &mut take)? };
        object.write().set_sea_regions(list)?;
        Ok(Status::Ok)
    })
}

/// Replaces the list of hulls that raise wakes; count 0 removes all. At most 64. A hull goes on at its speed and rate
/// of turn: set the list again when these change, in every frame if you like. A hull whose id was in the previous list
/// continues its track, unless its new position is more than two of its lengths from where that track would have led.
/// The waves of a hull that is no longer in the list stay until they have faded, after 240 s at most. Wakes are in the
/// picture and in the answers of wk_context_get_sea_at. In the answers for a place inside a dry region, the wake of the
/// hull at this place is left out, so that a hull does not float by its own waves. Keep water out of the hull by a dry
/// region (wk_context_set_sea_regions). Part of the state that wk_context_save keeps. Unchanged after an error.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the element, its field and range, or for two hulls with the same id.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_sea_hulls(
    context: *mut wk_context,
    hulls: *const wk_sea_hull,
    count: u32,
    stride: u32,
) -> wk_status {
    guard("wk_context_set_sea_hulls", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let mut list = Vec::new();
        let mut take = |_: usize, hull: wk_sea_hull| {
            list.push(hull.hull());
            Ok(())
        };
        // SAFETY: the caller's promise about `hulls`.
        unsafe { input::each(&List::parameters("hulls", count, stride, MAX_SEA_HULLS), hulls, &mut take)? };
        object.write().set_sea_hulls(&list)?;
        Ok(Status::Ok)
    })
}

/// Gets the sea at places of the host's world, at most wk_caps.max_batch of them, at a past or future simulation time.
/// The height of a position has no effect. There is no water where the terrain's tiles lie above the surface of the
/// sea, except in cells of WK_SURFACE_CLASS_WATER. In a dry region `has_water` is 0, and the other fields are those of
/// the water around the region, so that a hull can float by them. `shortest_wave_m`, in [0, 10000] m, is the length of
/// the shortest waves to include: leave out those too short to move your hull. 0 includes all. `position_size` and
/// `point_size` are the distances from one element to the next, bytes: 24 or more for positions, sizeof(wk_sea_point)
/// of your header for points. The first call for a time costs some milliseconds; the results for the last two times are
/// kept, and each place then costs some microseconds. No work of the GPU is needed, and nothing is allocated after the
/// first calls.
/// Thread: concurrent.
/// Errors: WK_ERROR_WRONG_ORDER without a sea; WK_ERROR_INVALID_ARGUMENT for an invalid position or a `shortest_wave_m`
/// out of range; for times as wk_context_get_conditions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_sea_at(
    context: *const wk_context,
    positions_m: *const [f64; 3],
    count: u32,
    position_size: u32,
    time_s: f64,
    shortest_wave_m: f64,
    points: *mut wk_sea_point,
    point_size: u32,
) -> wk_status {
    guard("wk_context_get_sea_at", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let places = input::Places::new("positions_m", "position_size", positions_m, count, position_size, MAX_BATCH)?;
        let room = input::Room::new("points", "point_size", points, count, point_size)?;
        let context = object.read();
        let query = context.sea_query(time_s, shortest_wave_m)?;
        let place = |i: usize| {
            let named = |e: Error| e.renamed("position", &format!("positions_m[{i}]"));
            // SAFETY: `i` is below the count that the caller promises.
            let at = unsafe { position("position", places.at(i)) }.map_err(named)?;
            Ok(DVec3::from_array(at))
        };
        for i in 0..count as usize {
            let named = |e: Error| e.renamed("position", &format!("positions_m[{i}]"));
            context.check_sea_position(place(i)?).map_err(named)?;
        }
        for i in 0..count as usize {
            let point = query.at(place(i)?)?;
            // SAFETY: the caller's promise about the room, which has as many elements.
            unsafe { room.write(i, &wk_sea_point::of(&point)) };
        }
        Ok(Status::Ok)
    })
}

/// Statistics of the sea at a time.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_sea_state {
    /// sizeof(wk_sea_state) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SEA_STATE.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Level without waves, m above mean sea level: wk_sea.level_m plus the tide.
    pub level_m: f64,
    /// Significant height of all waves, m: four standard deviations of the surface's height, single waves included.
    pub significant_height_m: f64,
    /// Period of the strongest waves, s; that of the highest single wave if there are no others; 0 without waves.
    pub peak_period_s: f64,
    /// Mean direction that the waves come from, degrees clockwise from true north, weighted by variance; 0 without
    /// waves.
    pub mean_from_deg: f64,
    /// Mean square slope of the surface: Cox and Munk's (1954) for the wind, or that of the waves if theirs is larger.
    pub mean_square_slope: f64,
    /// Part of mean_square_slope that belongs to the waves in the computed surface. The rest belongs to waves too short
    /// for that surface.
    pub drawn_square_slope: f64,
    /// Height of the largest wave expected in an hour, m, crest to trough (Longuet-Higgins 1952), plus the heights of
    /// all single waves.
    pub highest_in_hour_m: f64,
    /// Share of the sea under whitecaps, 0 to 1 (Monahan and O'Muircheartaigh 1980), less under ice.
    pub whitecap_share: f64,
    /// Temperature of the water, degrees Celsius.
    pub water_temperature_c: f64,
    /// Refractive index of the water against air at 550 nm (Quan and Fry 1995).
    pub refractive_index: f64,
    /// Diffuse attenuation of downward light at 450, 550 and 650 nm, 1/m (Jerlov 1976).
    pub attenuation_per_m: [f64; 3],
}

impl wk_sea_state {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SEA_STATE,
        next: null(),
        level_m: 0.0,
        significant_height_m: 0.0,
        peak_period_s: 0.0,
        mean_from_deg: 0.0,
        mean_square_slope: 0.0,
        drawn_square_slope: 0.0,
        highest_in_hour_m: 0.0,
        whitecap_share: 0.0,
        water_temperature_c: 0.0,
        refractive_index: 0.0,
        attenuation_per_m: [0.0, 0.0, 0.0],
    };

    fn of(s: &SeaStatistics) -> Self {
        Self {
            level_m: s.level_m,
            significant_height_m: s.significant_height_m,
            peak_period_s: s.peak_period_s,
            mean_from_deg: s.mean_from_deg,
            mean_square_slope: s.mean_square_slope,
            drawn_square_slope: s.drawn_square_slope,
            highest_in_hour_m: s.highest_in_hour_m,
            whitecap_share: s.whitecap_share,
            water_temperature_c: s.water_temperature_c,
            refractive_index: s.refractive_index,
            attenuation_per_m: s.attenuation_per_m,
            ..Self::INIT
        }
    }
}

/// Gets the statistics of the open sea at a simulation time, past or future.
/// Thread: concurrent.
/// Errors: WK_ERROR_WRONG_ORDER without a sea; for times as wk_context_get_conditions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_sea_state(
    context: *const wk_context,
    time_s: f64,
    out_state: *mut wk_sea_state,
) -> wk_status {
    guard("wk_context_get_sea_state", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `out_state`.
        let out = unsafe { layout::out_struct(&"out_state", out_state)? };
        out.set(&wk_sea_state::of(&object.read().sea_statistics(time_s)?));
        Ok(Status::Ok)
    })
}
