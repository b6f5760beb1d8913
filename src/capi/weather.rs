//! Weather
//!
//! A wk_weather describes the weather: plain data in SI units, which every call copies. Start from WK_WEATHER_INIT (a
//! clear standard day), a METAR report or a preset, and change the fields that you know better. In a wk_weather zero is
//! a value (0 degrees, north, calm, 0 %) and never means unknown. A field that may be unknown has a bit in `has`: where
//! the bit is clear, Welkin ignores the field and derives the value by a named physical law. All reals are doubles.

use std::{ffi::c_void, ptr::null};

use super::{
    boundary::{
        layout::{init_struct, struct_size},
        numbers::*,
    },
    weather_kinds::*,
};

include!(concat!(env!("OUT_DIR"), "/init_weather.rs"));

/// Flags that say which optional fields of a wk_weather are set.
pub type wk_weather_has_flags = u64;
/// vertical_visibility_m
pub const WK_WEATHER_HAS_VERTICAL_VISIBILITY: wk_weather_has_flags = 0x1;
/// runway_visual_range_m
pub const WK_WEATHER_HAS_RUNWAY_VISUAL_RANGE: wk_weather_has_flags = 0x2;
/// aerosol_angstrom_exponent
pub const WK_WEATHER_HAS_AEROSOL_ANGSTROM_EXPONENT: wk_weather_has_flags = 0x4;
/// aerosol_single_scattering_albedo
pub const WK_WEATHER_HAS_AEROSOL_SINGLE_SCATTERING_ALBEDO: wk_weather_has_flags = 0x8;
/// aerosol_asymmetry
pub const WK_WEATHER_HAS_AEROSOL_ASYMMETRY: wk_weather_has_flags = 0x10;
/// aerosol_scale_height_m
pub const WK_WEATHER_HAS_AEROSOL_SCALE_HEIGHT: wk_weather_has_flags = 0x20;
/// fog_top_m
pub const WK_WEATHER_HAS_FOG_TOP: wk_weather_has_flags = 0x40;
/// fog_coverage
pub const WK_WEATHER_HAS_FOG_COVERAGE: wk_weather_has_flags = 0x80;
/// fog_visibility_inside_m
pub const WK_WEATHER_HAS_FOG_VISIBILITY_INSIDE: wk_weather_has_flags = 0x100;
/// precipitation_liquid_fraction
pub const WK_WEATHER_HAS_PRECIPITATION_LIQUID_FRACTION: wk_weather_has_flags = 0x200;
/// wind_gust_m_s
pub const WK_WEATHER_HAS_WIND_GUST: wk_weather_has_flags = 0x400;
/// wind_variable_from_deg and wind_variable_to_deg
pub const WK_WEATHER_HAS_WIND_VARIABLE: wk_weather_has_flags = 0x800;
/// wind_turbulence_intensity
pub const WK_WEATHER_HAS_WIND_TURBULENCE_INTENSITY: wk_weather_has_flags = 0x1000;
/// sea_significant_wave_height_m
pub const WK_WEATHER_HAS_SEA_WAVE_HEIGHT: wk_weather_has_flags = 0x2000;
/// sea_state
pub const WK_WEATHER_HAS_SEA_STATE: wk_weather_has_flags = 0x4000;
/// sea_temperature_c
pub const WK_WEATHER_HAS_SEA_TEMPERATURE: wk_weather_has_flags = 0x8000;
/// swell_height_m, swell_period_s and swell_from_deg
pub const WK_WEATHER_HAS_SWELL: wk_weather_has_flags = 0x1_0000;
/// surface_state
pub const WK_WEATHER_HAS_SURFACE_STATE: wk_weather_has_flags = 0x2_0000;
/// surface_roughness_length_m
pub const WK_WEATHER_HAS_SURFACE_ROUGHNESS_LENGTH: wk_weather_has_flags = 0x4_0000;
/// lofted_top_m
pub const WK_WEATHER_HAS_LOFTED_TOP: wk_weather_has_flags = 0x8_0000;

/// Flags that say which optional fields of a wk_cloud_layer are set.
pub type wk_cloud_layer_has_flags = u32;
/// thickness_m
pub const WK_CLOUD_LAYER_HAS_THICKNESS: wk_cloud_layer_has_flags = 1;
/// water_g_m3
pub const WK_CLOUD_LAYER_HAS_WATER: wk_cloud_layer_has_flags = 2;
/// droplet_radius_um
pub const WK_CLOUD_LAYER_HAS_DROPLET_RADIUS: wk_cloud_layer_has_flags = 4;
/// wind_m_s and wind_from_deg
pub const WK_CLOUD_LAYER_HAS_WIND: wk_cloud_layer_has_flags = 8;

/// Properties of precipitation.
pub type wk_precipitation_flags = u32;
/// Precipitation from convective cloud (SH): fewer and larger drops, sharp onset and end.
pub const WK_PRECIPITATION_SHOWERS: wk_precipitation_flags = 1;
/// Precipitation with thunder (TS).
pub const WK_PRECIPITATION_THUNDERSTORM: wk_precipitation_flags = 2;
/// Precipitation with hail in addition to its kind (GR, GS).
pub const WK_PRECIPITATION_WITH_HAIL: wk_precipitation_flags = 4;

/// One layer of cloud.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_cloud_layer {
    /// sizeof(wk_cloud_layer) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_CLOUD_LAYER.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Flags of the optional fields that are set. Default 0.
    pub has: wk_cloud_layer_has_flags,
    /// Kind of cloud. Default WK_CLOUD_UNKNOWN.
    pub kind: wk_cloud_kind,
    /// Fraction of the sky that the layer covers (eighths / 8). Range [0, 1], default 0.
    pub cover: f64,
    /// Base above the station, m. Range [0, 20000], default 0.
    pub base_m: f64,
    /// Optional: thickness, m. Range [1, 20000]; else by kind.
    pub thickness_m: f64,
    /// Optional: water, liquid or ice, g/m^3. Range [0, 10]; else by kind.
    pub water_g_m3: f64,
    /// Optional: effective radius of droplets or crystals, um. Range [1, 500]; else by kind.
    pub droplet_radius_um: f64,
    /// Optional: speed of the wind that carries the layer, m/s. Range [0, 150]; else that of the weather's wind at the
    /// middle of the layer, which grows and veers with height (docs/clouds.md). Changing this speed does not displace
    /// any cloud.
    pub wind_m_s: f64,
    /// Optional, with wind_m_s: direction that the wind of wind_m_s comes from, degrees clockwise from true north.
    /// Range [0, 360].
    pub wind_from_deg: f64,
    /// Typical distance between clouds, m. Range [50, 200000]; 0, the default, lets kind and thickness decide.
    pub spacing_m: f64,
    /// Lifetime of the layer's clouds, s. Range [60, 1e6]; 0, the default, means 1200.
    pub life_s: f64,
}

impl wk_cloud_layer {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_CLOUD_LAYER,
        next: null(),
        has: 0,
        kind: WK_CLOUD_UNKNOWN,
        cover: 0.0,
        base_m: 0.0,
        thickness_m: 0.0,
        water_g_m3: 0.0,
        droplet_radius_um: 0.0,
        wind_m_s: 0.0,
        wind_from_deg: 0.0,
        spacing_m: 0.0,
        life_s: 0.0,
    };
}

/// The weather at a station and a time. Heights are above the station unless stated otherwise.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_weather {
    /// sizeof(wk_weather) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_WEATHER.
    pub struct_type: wk_struct_type,
    /// NULL (the default), or a wk_weather_overrides.
    pub next: *const c_void,
    /// Flags of the optional fields that are set. Default 0.
    pub has: wk_weather_has_flags,

    /// Meteorological optical range at the station, m: the distance at which 550 nm light falls to 5 % (the reported
    /// visibility). It includes air, haze, fog, rain and snow. Range [1, 1e6], default 40000.
    pub visibility_m: f64,
    /// Optional: vertical visibility into an obscured sky, m. Range [0, 10000]; else the sky is not obscured. With fog
    /// it sets the fog's depth.
    pub vertical_visibility_m: f64,
    /// Optional: runway visual range, m. Range [1, 10000]. Information only; extinction follows visibility_m.
    pub runway_visual_range_m: f64,
    /// Air temperature at 2 m, degrees Celsius. Range [-90, 60], default 15.
    pub temperature_c: f64,
    /// Relative humidity over water, fraction. Range [0, 1], default 0.5.
    pub relative_humidity: f64,
    /// Pressure reduced to mean sea level (QNH), hPa. Range [800, 1100], default 1013.25.
    pub pressure_hpa: f64,
    /// Height of the station above mean sea level, m. Range [-500, 9000], default 0.
    pub station_altitude_m: f64,
    /// Ozone column, Dobson units. Range [0, 700], default 300.
    pub ozone_du: f64,

    /// Kind of dry particles. Default WK_AEROSOL_CONTINENTAL.
    pub aerosol_kind: wk_aerosol_kind,
    /// Fog or mist. Default WK_FOG_NONE.
    pub fog_kind: wk_fog_kind,
    /// Optional: Angstrom exponent: extinction falls as wavelength^-exponent. Range [-1, 4]; else by kind.
    pub aerosol_angstrom_exponent: f64,
    /// Optional: single scattering albedo at 550 nm. Range [0, 1]; else by kind and humidity.
    pub aerosol_single_scattering_albedo: f64,
    /// Optional: mean cosine of the phase function. Range [-0.99, 0.99]; else by kind and humidity.
    pub aerosol_asymmetry: f64,
    /// Optional: scale height of the particles, over which their density falls to 1/e, m. Range [10, 20000]; else by
    /// kind. The value used is at least the station's altitude divided by 4.6 (435 m for a station at 2000 m), because
    /// the sky is computed from the density at sea level, which is limited to 100 times that at the station.
    pub aerosol_scale_height_m: f64,
    /// Optional: top of the fog, m. Range [0.1, 2000]; else by kind or vertical visibility.
    pub fog_top_m: f64,
    /// Optional: fraction of the ground under fog. Range [0, 1]; else by kind.
    pub fog_coverage: f64,
    /// Optional: visibility inside the fog, m. Range [1, 10000]; else 200 m in shallow fog, and in patches of fog and
    /// partial fog if visibility_m is 1000 or more, because an observer reports the visibility over or past such fog;
    /// 500 m in drifting snow or dust without fog. Other layers ignore the field: visibility_m holds inside them.
    pub fog_visibility_inside_m: f64,

    /// Kind of precipitation. Default WK_PRECIPITATION_NONE.
    pub precipitation_kind: wk_precipitation_kind,
    /// Properties of the precipitation. Default 0.
    pub precipitation_flags: wk_precipitation_flags,
    /// Precipitation rate, mm/h of liquid water. Range [0, 500], default 0; must be 0 if nothing falls.
    pub precipitation_rate_mm_h: f64,
    /// Optional: liquid fraction of the precipitation. Range [0, 1]; else by kind.
    pub precipitation_liquid_fraction: f64,

    /// Mean wind at 10 m above ground, m/s. Range [0, 120], default 0.
    pub wind_speed_m_s: f64,
    /// Direction that the wind comes from, degrees clockwise from true north. Range [0, 360], default 0.
    pub wind_from_deg: f64,
    /// Optional: highest 3-second gust, m/s. Range [wind_speed_m_s, 150]; else from the turbulence.
    pub wind_gust_m_s: f64,
    /// Optional, together with wind_variable_to_deg: start of the range within which the direction varies, degrees; the
    /// range runs clockwise. Range [0, 360].
    pub wind_variable_from_deg: f64,
    /// End of the range within which the direction varies, degrees. Range [0, 360]. 0 to 360 means all directions
    /// (VRB).
    pub wind_variable_to_deg: f64,
    /// Optional: turbulence intensity, the ratio of the speed's standard deviation to its mean. Range [0, 1]; else from
    /// the roughness.
    pub wind_turbulence_intensity: f64,

    /// Optional: significant height of the wind sea, m. Range [0, 30]; else from sea_state or the wind.
    pub sea_significant_wave_height_m: f64,
    /// Optional: water temperature, degrees Celsius. Range [-3, 45]; else the air's, not below -1.8.
    pub sea_temperature_c: f64,
    /// Optional, together with swell_period_s and swell_from_deg: significant height of the swell, m. Range [0, 20].
    pub swell_height_m: f64,
    /// Peak period of the swell, s. Range [1, 30] if the swell is set.
    pub swell_period_s: f64,
    /// Direction that the swell comes from, degrees clockwise from true north. Range [0, 360].
    pub swell_from_deg: f64,
    /// Optional: WMO sea state, code table 3700. Range 0 to 9.
    pub sea_state: u32,
    /// Optional: observed state of the ground; else from precipitation, temperature and snow depth.
    pub surface_state: wk_surface_state,
    /// Depth of lying snow, m. Range [0, 20], default 0.
    pub surface_snow_depth_m: f64,
    /// Optional: roughness length of the land, m. Range [1e-5, 5]; else 0.03.
    pub surface_roughness_length_m: f64,

    /// Optional: depth of the layer of matter that the wind lifts, m. Range [0.1, 5000]; else by kind.
    pub lofted_top_m: f64,
    /// Kind of matter that the wind lifts. Default WK_LOFTED_NONE.
    pub lofted_kind: wk_lofted_kind,
    /// Number of cloud layers, at most wk_caps.max_cloud_layers (16). Default 0.
    pub cloud_count: u32,
    /// The cloud layers in any order; may be NULL if there are none. Read during the call only.
    pub clouds: *const wk_cloud_layer,
    /// Bytes from one layer to the next: sizeof(wk_cloud_layer) of your header, which is the default.
    pub cloud_stride: u32,
    /// Must be 0.
    pub reserved0: u32,
}

impl wk_weather {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_WEATHER,
        next: null(),
        has: 0,
        visibility_m: 40000.0,
        vertical_visibility_m: 0.0,
        runway_visual_range_m: 0.0,
        temperature_c: 15.0,
        relative_humidity: 0.5,
        pressure_hpa: 1013.25,
        station_altitude_m: 0.0,
        ozone_du: 300.0,
        aerosol_kind: WK_AEROSOL_CONTINENTAL,
        fog_kind: WK_FOG_NONE,
        aerosol_angstrom_exponent: 0.0,
        aerosol_single_scattering_albedo: 0.0,
        aerosol_asymmetry: 0.0,
        aerosol_scale_height_m: 0.0,
        fog_top_m: 0.0,
        fog_coverage: 0.0,
        fog_visibility_inside_m: 0.0,
        precipitation_kind: WK_PRECIPITATION_NONE,
        precipitation_flags: 0,
        precipitation_rate_mm_h: 0.0,
        precipitation_liquid_fraction: 0.0,
        wind_speed_m_s: 0.0,
        wind_from_deg: 0.0,
        wind_gust_m_s: 0.0,
        wind_variable_from_deg: 0.0,
        wind_variable_to_deg: 0.0,
        wind_turbulence_intensity: 0.0,
        sea_significant_wave_height_m: 0.0,
        sea_temperature_c: 0.0,
        swell_height_m: 0.0,
        swell_period_s: 0.0,
        swell_from_deg: 0.0,
        sea_state: 0,
        surface_state: WK_SURFACE_DRY,
        surface_snow_depth_m: 0.0,
        surface_roughness_length_m: 0.0,
        lofted_top_m: 0.0,
        lofted_kind: WK_LOFTED_NONE,
        cloud_count: 0,
        clouds: null(),
        cloud_stride: struct_size::<wk_cloud_layer>(),
        reserved0: 0,
    };
}

/// Flags that say which fields of a wk_weather_overrides are set.
pub type wk_override_flags = u32;
/// aerosol_extinction_per_m
pub const WK_OVERRIDE_AEROSOL_EXTINCTION: wk_override_flags = 0x1;
/// fog_extinction_per_m
pub const WK_OVERRIDE_FOG_EXTINCTION: wk_override_flags = 0x2;
/// precipitation_extinction_per_m
pub const WK_OVERRIDE_PRECIPITATION_EXTINCTION: wk_override_flags = 0x4;
/// visibility_above_fog_m
pub const WK_OVERRIDE_VISIBILITY_ABOVE_FOG: wk_override_flags = 0x8;
/// humidity_growth
pub const WK_OVERRIDE_HUMIDITY_GROWTH: wk_override_flags = 0x10;
/// rayleigh_density_ratio
pub const WK_OVERRIDE_RAYLEIGH_DENSITY: wk_override_flags = 0x20;
/// rayleigh_scale_height_m
pub const WK_OVERRIDE_RAYLEIGH_SCALE_HEIGHT: wk_override_flags = 0x40;
/// A flag without a field: rain adds no cloud to a weather without clouds, and no water to the clouds that it falls
/// from.
pub const WK_OVERRIDE_RAIN_WITHOUT_CLOUD: wk_override_flags = 0x80;
/// cloud_direct and cloud_diffuse
pub const WK_OVERRIDE_CLOUD_LIGHT: wk_override_flags = 0x100;
/// wave_height_m
pub const WK_OVERRIDE_WAVE_HEIGHT: wk_override_flags = 0x200;
/// wetness
pub const WK_OVERRIDE_WETNESS: wk_override_flags = 0x400;

/// Your own values in place of the laws that derive one part of the weather from another. An extension: put it into
/// wk_weather.next.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_weather_overrides {
    /// sizeof(wk_weather_overrides) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_WEATHER_OVERRIDES.
    pub struct_type: wk_struct_type,
    /// The next extension. Default NULL.
    pub next: *const c_void,
    /// Flags of the fields that are set; the laws give the others. Default 0.
    pub set: wk_override_flags,
    /// Must be 0.
    pub reserved0: u32,
    /// Aerosol extinction at 550 nm and station height, 1/m, in place of the value that follows from the visibility.
    /// Range [0, 10].
    pub aerosol_extinction_per_m: f64,
    /// Extinction inside the layer of fog, mist or lifted matter at the ground, 1/m, in place of the value that follows
    /// from the visibility. Range [0, 10].
    pub fog_extinction_per_m: f64,
    /// Extinction of precipitation, 1/m, in place of that from the spectra of drops and flakes. Range [0, 10].
    pub precipitation_extinction_per_m: f64,
    /// Visibility in the air above a mist or fog, m. Range [100, 1e6]; law: 5 km over mist, 10 km over fog.
    pub visibility_above_fog_m: f64,
    /// Growth of the particles' extinction with humidity, relative to that at 80 %. Range [0.1, 20]; law: Haenel
    /// (1976); 1 switches growth off.
    pub humidity_growth: f64,
    /// Ratio of the air density at sea level to that of the standard atmosphere. Range [0, 10].
    pub rayleigh_density_ratio: f64,
    /// Scale height of the air, m. Range [100, 50000].
    pub rayleigh_scale_height_m: f64,
    /// Fraction of the sun's direct beam that passes the clouds. Range [0, 1].
    pub cloud_direct: f64,
    /// Diffuse light below the clouds as a fraction of the light above them. Range [0, 1].
    pub cloud_diffuse: f64,
    /// Significant wave height, m, in place of that from the wind or the sea state. Range [0, 30].
    pub wave_height_m: f64,
    /// Wetness of the ground, in place of that from the precipitation. Range [0, 1].
    pub wetness: f64,
}

impl wk_weather_overrides {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_WEATHER_OVERRIDES,
        next: null(),
        set: 0,
        reserved0: 0,
        aerosol_extinction_per_m: 0.0,
        fog_extinction_per_m: 0.0,
        precipitation_extinction_per_m: 0.0,
        visibility_above_fog_m: 0.0,
        humidity_growth: 0.0,
        rayleigh_density_ratio: 0.0,
        rayleigh_scale_height_m: 0.0,
        cloud_direct: 0.0,
        cloud_diffuse: 0.0,
        wave_height_m: 0.0,
        wetness: 0.0,
    };
}
