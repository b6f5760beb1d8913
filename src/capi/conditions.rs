//! Queries: conditions
//!
//! The weather as physical quantities, at any place, at any future time, and at any past time whose weather the
//! timeline (see Weather over time) still knows. The answers are in closed form and need no device. Heights are above
//! the station unless stated otherwise. Every number is continuous in time while the weather changes, even the heights
//! of a layer that appears or dissolves.
//!
//! Here and in every other function a position must lie within 1e12 m of the world's origin and at an altitude in
//! [-1e4, 1e9] m above mean sea level (in WK_WORLD_ECEF: above the ellipsoid, less geoid_height_m of wk_context_desc).
//! Other positions are refused.

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::boundary::{
    guard,
    input::{self, out, position},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::Status,
    weather::{CloudSlab, Conditions, MAX_CLOUD_LAYERS},
};

include!(concat!(env!("OUT_DIR"), "/init_conditions.rs"));

/// The weather as physical quantities, each continuous in time.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_conditions {
    /// sizeof(wk_conditions) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_CONDITIONS.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Total extinction at 550 nm, 1/m: air, particles and fog at station height, and precipitation at the position.
    /// Shallow or patchy fog, which a reported visibility leaves out, is not included.
    pub extinction_per_m: f64,
    /// Meteorological optical range for extinction_per_m, m; at most 1e9, the value without any air.
    pub visibility_m: f64,
    /// Air temperature at 2 m, degrees Celsius.
    pub temperature_c: f64,
    /// Relative humidity, a fraction.
    pub relative_humidity: f64,
    /// Pressure reduced to sea level, hPa.
    pub pressure_hpa: f64,
    /// Pressure at the station, hPa.
    pub station_pressure_hpa: f64,
    /// Station above mean sea level, m.
    pub station_altitude_m: f64,
    /// Air density at sea level, divided by that at 15 C and 1013.25 hPa.
    pub rayleigh_density_ratio: f64,
    /// Scale height of the air, m: the rise in height over which the air's density falls to 1/e.
    pub rayleigh_scale_height_m: f64,
    /// Extinction by air, at 550 nm and station height, 1/m.
    pub rayleigh_extinction_per_m: f64,
    /// Extinction by particles, at 550 nm and station height, 1/m.
    pub aerosol_extinction_per_m: f64,
    /// Exponent of the particles' extinction, which is proportional to (wavelength / 550 nm)^-exponent.
    pub aerosol_angstrom_exponent: f64,
    /// Single-scattering albedo of the particles at 550 nm.
    pub aerosol_single_scattering_albedo: f64,
    /// Mean cosine of the particles' phase function.
    pub aerosol_asymmetry: f64,
    /// Scale height of the particles, m: the rise in height over which their density falls to 1/e.
    pub aerosol_scale_height_m: f64,
    /// Extinction inside the layer at the ground (fog, mist, lifted matter), at 550 nm, 1/m; 0 if there is none.
    pub fog_extinction_per_m: f64,
    /// Base of the layer at the ground, m above the station.
    pub fog_base_m: f64,
    /// Top of the layer at the ground, m above the station.
    pub fog_top_m: f64,
    /// Depth of the layer's soft upper edge, m.
    pub fog_softness_m: f64,
    /// Fraction of the ground that the layer covers.
    pub fog_coverage: f64,
    /// Fraction of the sky that all layers together hide. While the weather changes, it stays between the values before
    /// and after.
    pub cloud_cover: f64,
    /// Rain, mm/h.
    pub rain_mm_h: f64,
    /// Drizzle, mm/h.
    pub drizzle_mm_h: f64,
    /// Snow, snow grains and ice crystals together, mm/h of melted water.
    pub snow_mm_h: f64,
    /// Ice pellets and small hail, mm/h of melted water.
    pub ice_pellets_mm_h: f64,
    /// Hail, mm/h of melted water.
    pub hail_mm_h: f64,
    /// Fraction of rain and drizzle that freezes where it lands.
    pub freezing: f64,
    /// Degree to which the precipitation is convective: 0 steady, 1 showers.
    pub showers: f64,
    /// Presence of thunder, 0 to 1.
    pub thunder: f64,
    /// Extinction by all precipitation, at 550 nm, 1/m.
    pub precipitation_extinction_per_m: f64,
    /// Velocity at 10 m towards the east, m/s.
    pub wind_east_m_s: f64,
    /// Velocity at 10 m towards the north, m/s.
    pub wind_north_m_s: f64,
    /// Highest 3-second gust at 10 m, m/s.
    pub wind_gust_m_s: f64,
    /// Standard deviation of the wind's speed divided by the mean speed, at 10 m.
    pub wind_turbulence_intensity: f64,
    /// Half the range over which the wind's direction wanders, degrees: 0 steady, 180 all round.
    pub wind_wander_deg: f64,
    /// Roughness length of the land, m.
    pub roughness_length_m: f64,
    /// Roughness length of the sea, m.
    pub sea_roughness_length_m: f64,
    /// Significant wave height of the wind sea, m.
    pub significant_wave_height_m: f64,
    /// Height of the swell, m; 0 without swell.
    pub swell_height_m: f64,
    /// Peak period of the swell, s.
    pub swell_period_s: f64,
    /// Direction in which the swell travels: east component of the unit vector.
    pub swell_east: f64,
    /// Direction in which the swell travels: north component of the unit vector.
    pub swell_north: f64,
    /// Sea temperature, degrees Celsius.
    pub sea_temperature_c: f64,
    /// Wetness of the ground: 0 dry, 0.3 damp, 1 under a closed film.
    pub wetness: f64,
    /// Fraction of the ground under standing water.
    pub puddles: f64,
    /// Fraction of the ground under ice or frost.
    pub ice: f64,
    /// Depth of lying snow, m.
    pub snow_depth_m: f64,
    /// Ozone column, Dobson units.
    pub ozone_du: f64,
    /// Flakes alone, which snow_mm_h includes, mm/h of melted water; 0 where none fall.
    pub snow_flakes_mm_h: f64,
    /// Snow grains alone, which snow_mm_h includes, mm/h of melted water; 0 where none fall.
    pub snow_grains_mm_h: f64,
    /// Ice crystals alone, which snow_mm_h includes, mm/h of melted water; 0 where none fall.
    pub ice_crystals_mm_h: f64,
}

impl wk_conditions {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_CONDITIONS,
        next: null(),
        extinction_per_m: 0.0,
        visibility_m: 0.0,
        temperature_c: 0.0,
        relative_humidity: 0.0,
        pressure_hpa: 0.0,
        station_pressure_hpa: 0.0,
        station_altitude_m: 0.0,
        rayleigh_density_ratio: 0.0,
        rayleigh_scale_height_m: 0.0,
        rayleigh_extinction_per_m: 0.0,
        aerosol_extinction_per_m: 0.0,
        aerosol_angstrom_exponent: 0.0,
        aerosol_single_scattering_albedo: 0.0,
        aerosol_asymmetry: 0.0,
        aerosol_scale_height_m: 0.0,
        fog_extinction_per_m: 0.0,
        fog_base_m: 0.0,
        fog_top_m: 0.0,
        fog_softness_m: 0.0,
        fog_coverage: 0.0,
        cloud_cover: 0.0,
        rain_mm_h: 0.0,
        drizzle_mm_h: 0.0,
        snow_mm_h: 0.0,
        ice_pellets_mm_h: 0.0,
        hail_mm_h: 0.0,
        freezing: 0.0,
        showers: 0.0,
        thunder: 0.0,
        precipitation_extinction_per_m: 0.0,
        wind_east_m_s: 0.0,
        wind_north_m_s: 0.0,
        wind_gust_m_s: 0.0,
        wind_turbulence_intensity: 0.0,
        wind_wander_deg: 0.0,
        roughness_length_m: 0.0,
        sea_roughness_length_m: 0.0,
        significant_wave_height_m: 0.0,
        swell_height_m: 0.0,
        swell_period_s: 0.0,
        swell_east: 0.0,
        swell_north: 0.0,
        sea_temperature_c: 0.0,
        wetness: 0.0,
        puddles: 0.0,
        ice: 0.0,
        snow_depth_m: 0.0,
        ozone_du: 0.0,
        snow_flakes_mm_h: 0.0,
        snow_grains_mm_h: 0.0,
        ice_crystals_mm_h: 0.0,
    };

    fn of(c: &Conditions) -> Self {
        let [snow_flakes_mm_h, snow_grains_mm_h, ice_crystals_mm_h] = c.precipitation.snow_kinds_mm_h();
        Self {
            snow_flakes_mm_h,
            snow_grains_mm_h,
            ice_crystals_mm_h,
            extinction_per_m: c.extinction_per_m,
            visibility_m: c.visibility_m(),
            temperature_c: c.air.temperature_c,
            relative_humidity: c.air.relative_humidity,
            pressure_hpa: c.air.pressure_hpa,
            station_pressure_hpa: c.air.station_pressure_hpa,
            station_altitude_m: c.air.station_altitude_m,
            rayleigh_density_ratio: c.air.rayleigh_density_ratio,
            rayleigh_scale_height_m: c.air.rayleigh_scale_height_m,
            rayleigh_extinction_per_m: c.air.rayleigh_extinction_per_m,
            aerosol_extinction_per_m: c.aerosol.extinction_per_m,
            aerosol_angstrom_exponent: c.aerosol.angstrom_exponent,
            aerosol_single_scattering_albedo: c.aerosol.single_scattering_albedo,
            aerosol_asymmetry: c.aerosol.asymmetry,
            aerosol_scale_height_m: c.aerosol.scale_height_m,
            fog_extinction_per_m: c.fog.extinction_per_m,
            fog_base_m: c.fog.base_m,
            fog_top_m: c.fog.top_m,
            fog_softness_m: c.fog.softness_m,
            fog_coverage: c.fog.coverage,
            cloud_cover: c.cloud_cover(),
            rain_mm_h: c.precipitation.rain_mm_h,
            drizzle_mm_h: c.precipitation.drizzle_mm_h,
            snow_mm_h: c.precipitation.snow_mm_h,
            ice_pellets_mm_h: c.precipitation.ice_pellets_mm_h,
            hail_mm_h: c.precipitation.hail_mm_h,
            freezing: c.precipitation.freezing,
            showers: c.precipitation.showers,
            thunder: c.precipitation.thunder,
            precipitation_extinction_per_m: c.precipitation.extinction_per_m(),
            wind_east_m_s: c.wind.east_m_s,
            wind_north_m_s: c.wind.north_m_s,
            wind_gust_m_s: c.wind.gust_m_s,
            wind_turbulence_intensity: c.wind.turbulence_intensity,
            wind_wander_deg: c.wind.wander_deg,
            roughness_length_m: c.wind.roughness_length_m,
            sea_roughness_length_m: c.wind.sea_roughness_length_m,
            significant_wave_height_m: c.sea.significant_wave_height_m,
            swell_height_m: c.sea.swell_height_m,
            swell_period_s: c.sea.swell_period_s,
            swell_east: c.sea.swell_east,
            swell_north: c.sea.swell_north,
            sea_temperature_c: c.sea.temperature_c,
            wetness: c.surface.wetness,
            puddles: c.surface.puddles,
            ice: c.surface.ice,
            snow_depth_m: c.surface.snow_depth_m,
            ozone_du: c.ozone_du,
            ..Self::INIT
        }
    }
}

/// Horizontally uniform layer of cloud. Element of an array, without struct_size; calls take its sizeof instead.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_cloud_slab {
    /// Fraction of the sky covered.
    pub cover: f64,
    /// Base above the station, m.
    pub base_m: f64,
    /// Thickness, m.
    pub thickness_m: f64,
    /// Optical depth straight up, where there is cloud.
    pub optical_depth: f64,
    /// Effective radius of droplets or crystals, um.
    pub droplet_radius_um: f64,
    /// Mean cosine of the phase function.
    pub asymmetry: f64,
    /// Shape: 0 a sheet, 0.5 fair-weather heaps, 1 cumulonimbus.
    pub convection: f64,
    /// Fraction of the water that is ice.
    pub ice_fraction: f64,
}

impl wk_cloud_slab {
    fn of(s: &CloudSlab) -> Self {
        Self {
            cover: s.cover,
            base_m: s.base_m,
            thickness_m: s.thickness_m,
            optical_depth: s.optical_depth,
            droplet_radius_um: s.droplet_radius_um,
            asymmetry: s.asymmetry,
            convection: s.convection,
            ice_fraction: s.ice_fraction,
        }
    }
}

/// Gets the conditions at a position and a past or future simulation time, with the weather regions there
/// (wk_context_set_weather_regions). Precipitation is that at the position itself: it includes the rain areas there
/// (wk_context_set_rain_areas), weighted by their rims, and is zero above the cloud that it falls from. rain_mm_h and
/// drizzle_mm_h add up to rate_mm_h of wk_context_get_rainfall_at. precipitation_extinction_per_m, extinction_per_m and
/// visibility_m include that precipitation. All other fields are for the station's height unless their descriptions say
/// otherwise.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an invalid position, and for a time that the timeline has forgotten. The last
/// wk_context_update forgot all times before the end of the latest change of weather that was over by then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_conditions(
    context: *const wk_context,
    position_m: *const [f64; 3],
    time_s: f64,
    out_conditions: *mut wk_conditions,
) -> wk_status {
    guard("wk_context_get_conditions", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promises.
        let (at, place) =
            unsafe { (position("position_m", position_m)?, layout::out_struct(&"out_conditions", out_conditions)?) };
        let conditions = object.read().conditions_at(DVec3::from_array(at), time_s);
        place.set(&wk_conditions::of(&conditions.map_err(|e| e.renamed("position", "position_m"))?));
        Ok(Status::Ok)
    })
}

/// Gets the cloud layers at a position and time, low ones first; position and time are as in wk_context_get_conditions.
/// The map of wk_context_set_cloud_map has no effect on the answer. `*out_count` gets the number of layers, at most 16.
/// With capacity 0 nothing else is written, and the call succeeds. If `capacity` is too small, the call writes only the
/// number and fails. `slab_size` is sizeof(wk_cloud_slab) of your header.
/// Thread: concurrent.
/// Errors: as wk_context_get_conditions; WK_ERROR_INVALID_ARGUMENT for a capacity other than 0 that is too small.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_cloud_slabs(
    context: *const wk_context,
    position_m: *const [f64; 3],
    time_s: f64,
    slabs: *mut wk_cloud_slab,
    capacity: u32,
    slab_size: u32,
    out_count: *mut u32,
) -> wk_status {
    guard("wk_context_get_cloud_slabs", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `position_m`.
        let at = unsafe { position("position_m", position_m)? };
        let count = out("out_count", out_count)?;
        let room = input::Room::new("slabs", "slab_size", slabs, capacity, slab_size)?;
        let conditions = object.read().conditions_at(DVec3::from_array(at), time_s);
        let conditions = conditions.map_err(|e| e.renamed("position", "position_m"))?;
        let found: [Option<&CloudSlab>; MAX_CLOUD_LAYERS] = {
            let mut slabs = conditions.cloud_slabs();
            std::array::from_fn(|_| slabs.next())
        };
        let present = found.iter().flatten().count();
        // SAFETY: `count` was checked and is the caller's.
        unsafe { count.write(present as u32) };
        if capacity > 0 {
            room.check_capacity("capacity", present)?;
            for (i, slab) in found.iter().flatten().enumerate() {
                // SAFETY: `i` is below the capacity that the caller promises.
                unsafe { room.write(i, &wk_cloud_slab::of(slab)) };
            }
        }
        Ok(Status::Ok)
    })
}
