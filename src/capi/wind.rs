//! Queries: wind and rain
//!
//! These functions give the velocity and the displacement of the air, the precipitation, and the rain on surfaces. They
//! answer for any place and for any past or future simulation time that the timeline of the weather still knows (see
//! wk_context_get_conditions). The answers are in closed form and need no work of the GPU. Vectors are (east, north,
//! up) at the place. Only wk_context_get_rain_on_at takes shelters into account.

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::boundary::{
    guard,
    input::{self, MAX_BATCH, position},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::{Result, Status},
    rain::{RainAt, RainOn, RainSurface},
};

include!(concat!(env!("OUT_DIR"), "/init_wind.rs"));

/// Wind at a place and time.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_wind {
    /// sizeof(wk_wind) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_WIND.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Velocity of the air at the queried time, gusts included, m/s.
    pub velocity_m_s: [f64; 3],
    /// Mean velocity, without gusts, m/s.
    pub mean_m_s: [f64; 3],
    /// Displacement of the air at 10 m since simulation time 0, gusts included, m. It is the same at every place,
    /// continuous through all changes of the weather, and equal bit for bit on all channels of a simulator. Move
    /// objects that the air carries by differences of this displacement, never by velocity times time.
    pub displacement_m: [f64; 3],
    /// Standard deviation of the wind speed along the mean wind, due to gusts, m/s.
    pub gust_deviation_m_s: f64,
}

impl wk_wind {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_WIND,
        next: null(),
        velocity_m_s: [0.0, 0.0, 0.0],
        mean_m_s: [0.0, 0.0, 0.0],
        displacement_m: [0.0, 0.0, 0.0],
        gust_deviation_m_s: 0.0,
    };
}

/// Precipitation at a place and time: rain and drizzle, hail and ice pellets, but no snow. All fields are 0 if none
/// falls.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_rainfall {
    /// sizeof(wk_rainfall) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_RAINFALL.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Rate of rain and drizzle on level ground, mm/h.
    pub rate_mm_h: f64,
    /// Number of drops of 0.1 to 6 mm in the air, 1/m^3. The size distributions are those of Marshall and Palmer
    /// (1948), and for showers and drizzle those of Joss et al. (1968). Each is scaled so that its drops give the rate.
    pub number_per_m3: f64,
    /// Liquid water in the air, g/m^3.
    pub liquid_g_m3: f64,
    /// Extinction by the drops, 1/m.
    pub extinction_per_m: f64,
    /// Mean diameter of the drops in the air, mm.
    pub mean_diameter_mm: f64,
    /// Median volume diameter, mm: half of the water in the air is in smaller drops.
    pub median_volume_diameter_mm: f64,
    /// Number of drops that land on level ground, 1/(m^2 s).
    pub drops_per_m2_s: f64,
    /// Velocity of the median drop of the falling water, m/s: half of the water falls more steeply, the other half
    /// less. Render occluder maps along this velocity. The drop falls at the speed of Gunn and Kinzer (1949). It moves
    /// with the wind at 10 m, gusts included, or with the wind grid or wind field there (wk_context_set_wind_grid,
    /// wk_context_set_wind_field). 0 if neither rain nor drizzle falls.
    pub fall_velocity_m_s: [f64; 3],
    /// Hail, small hail and ice pellets on level ground, mm/h of melted water.
    pub ice_mm_h: f64,
    /// Number of stones in the air, 1/m^3: hail of 5 to 60 mm (Cheng and English 1983), or pellets of 0.5 to 5 mm,
    /// which are frozen raindrops.
    pub stones_per_m3: f64,
    /// Extinction by the stones, 1/m.
    pub stone_extinction_per_m: f64,
    /// Mean diameter of the stones in the air, mm.
    pub stone_diameter_mm: f64,
    /// Number of stones that land on level ground, 1/(m^2 s).
    pub stones_per_m2_s: f64,
}

impl wk_rainfall {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_RAINFALL,
        next: null(),
        rate_mm_h: 0.0,
        number_per_m3: 0.0,
        liquid_g_m3: 0.0,
        extinction_per_m: 0.0,
        mean_diameter_mm: 0.0,
        median_volume_diameter_mm: 0.0,
        drops_per_m2_s: 0.0,
        fall_velocity_m_s: [0.0, 0.0, 0.0],
        ice_mm_h: 0.0,
        stones_per_m3: 0.0,
        stone_extinction_per_m: 0.0,
        stone_diameter_mm: 0.0,
        stones_per_m2_s: 0.0,
    };

    fn of(rain: &RainAt) -> Self {
        Self {
            rate_mm_h: rain.rate_mm_h,
            number_per_m3: rain.number_per_m3,
            liquid_g_m3: rain.liquid_g_m3,
            extinction_per_m: rain.extinction_per_m,
            mean_diameter_mm: rain.mean_diameter_mm,
            median_volume_diameter_mm: rain.median_volume_diameter_mm,
            drops_per_m2_s: rain.drops_per_m2_s,
            fall_velocity_m_s: rain.fall_velocity_m_s.to_array(),
            ice_mm_h: rain.ice_mm_h,
            stones_per_m3: rain.stones_per_m3,
            stone_extinction_per_m: rain.stone_extinction_per_m,
            stone_diameter_mm: rain.stone_diameter_mm,
            stones_per_m2_s: rain.stones_per_m2_s,
            ..Self::INIT
        }
    }
}

/// A surface that rain lands on, or an opening that it falls through. Element of an array, without struct_size; calls
/// take its sizeof instead.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_rain_surface {
    /// Position in the host's world, m.
    pub position_m: [f64; 3],
    /// Normal of the surface's wet side, (east, north, up) at the place; of any length but 0.
    pub normal: [f64; 3],
    /// Velocity of the surface, m/s (east, north, up). Range [-1000, 1000] each.
    pub velocity_m_s: [f64; 3],
    /// Area of the surface, m^2. Range [0, 1e6].
    pub area_m2: f64,
}

/// Rain on a surface. Element of an array, without struct_size; calls take its sizeof instead.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_rain_on {
    /// Rate of rain and drizzle, mm/h: litres per square metre and hour.
    pub rate_mm_h: f64,
    /// Number of drops of 0.1 to 6 mm that land on the whole surface, 1/s.
    pub drops_per_s: f64,
}

impl wk_rain_on {
    fn of(rain: &RainOn) -> Self {
        Self { rate_mm_h: rain.rate_mm_h, drops_per_s: rain.drops_per_s }
    }
}

/// Gets the wind at a place of the host's world and a simulation time. The mean follows the logarithmic profile over
/// the ground's roughness up to 100 m; above that it grows and veers to the geostrophic wind (docs/clouds.md). Gusts
/// have Kaimal's spectrum (1972, as in IEC 61400-1) and are the same all over the world. Height above ground means the
/// position's altitude minus the altitude of the weather's station; the reported wind is the wind 10 m above the
/// station. A host with terrain should therefore query the place at the station's altitude plus the height above the
/// host's own ground. At and below the roughness length there is no wind.
/// Thread: concurrent.
/// Errors: as wk_context_get_conditions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_wind_at(
    context: *const wk_context,
    position_m: *const [f64; 3],
    time_s: f64,
    out_wind: *mut wk_wind,
) -> wk_status {
    guard("wk_context_get_wind_at", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promises.
        let (at, place) = unsafe { (position("position_m", position_m)?, layout::out_struct(&"out_wind", out_wind)?) };
        let context = object.read();
        let wind = context.wind_at(DVec3::from_array(at), time_s).map_err(|e| e.renamed("position", "position_m"))?;
        place.set(&wk_wind {
            velocity_m_s: wind.velocity_m_s.to_array(),
            mean_m_s: wind.mean_m_s.to_array(),
            displacement_m: context.wind_displacement(time_s)?.to_array(),
            gust_deviation_m_s: wind.gust_deviation_m_s,
            ..wk_wind::INIT
        });
        Ok(Status::Ok)
    })
}

/// Gets the precipitation at a place of the host's world and a simulation time. The precipitation of a cloud layer
/// begins halfway up the layer, but at most 500 m above its base. Where the sky has several layers, precipitation
/// begins at the mean of these heights, weighted by the share of the sky in which each layer is the lowest; without
/// clouds, at 2000 m above the station. Above this height the weather's precipitation is 0. Rain areas
/// (wk_context_set_rain_areas) have tops of their own.
/// Thread: concurrent.
/// Errors: as wk_context_get_conditions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_rainfall_at(
    context: *const wk_context,
    position_m: *const [f64; 3],
    time_s: f64,
    out_rainfall: *mut wk_rainfall,
) -> wk_status {
    guard("wk_context_get_rainfall_at", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promises.
        let (at, place) =
            unsafe { (position("position_m", position_m)?, layout::out_struct(&"out_rainfall", out_rainfall)?) };
        let rain = object.read().rain_at(DVec3::from_array(at), time_s);
        place.set(&wk_rainfall::of(&rain.map_err(|e| e.renamed("position", "position_m"))?));
        Ok(Status::Ok)
    })
}

/// Gets the rain on at most wk_caps.max_batch surfaces at a simulation time. Drops of each size arrive in their own
/// direction: it follows from their fall speed, the wind with its gusts, and the velocity of the surface. A windscreen
/// at 25 m/s meets far more drops than the ground does. Boxes (wk_context_set_shelters) keep rain off where they
/// shelter a point 5 cm in front of the surface, each box at the place to which its velocity has carried it by that
/// time. Occluder maps have no effect here. `surface_size` and `on_size` are sizeof(wk_rain_surface) and
/// sizeof(wk_rain_on) of your header. If one surface is wrong, nothing is written.
/// Thread: concurrent.
/// Errors: as wk_context_get_conditions; WK_ERROR_INVALID_ARGUMENT naming the wrong field of a surface and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_rain_on_at(
    context: *const wk_context,
    surfaces: *const wk_rain_surface,
    count: u32,
    surface_size: u32,
    time_s: f64,
    on: *mut wk_rain_on,
    on_size: u32,
) -> wk_status {
    guard("wk_context_get_rain_on_at", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let list = input::Places::new("surfaces", "surface_size", surfaces, count, surface_size, MAX_BATCH)?;
        let room = input::Room::new("on", "on_size", on, count, on_size)?;
        let context = object.read();
        context.check_time(time_s)?;
        let answer = |i: usize| {
            // SAFETY: `i` is below the count that the caller promises, and the size was checked.
            let c = unsafe { list.at(i).read() };
            let surface = RainSurface {
                position: DVec3::from_array(c.position_m),
                normal: DVec3::from_array(c.normal),
                velocity_m_s: DVec3::from_array(c.velocity_m_s),
                area_m2: c.area_m2,
            };
            let on = context.rain_on(&surface, time_s);
            Ok(wk_rain_on::of(&on.map_err(|e| e.renamed("position", "position_m").within(&format!("surfaces[{i}]")))?))
        };
        let answers = (0..count as usize).map(answer).collect::<Result<Vec<_>>>()?;
        for (i, on) in answers.iter().enumerate() {
            // SAFETY: as above.
            unsafe { room.write(i, on) };
        }
        Ok(Status::Ok)
    })
}
