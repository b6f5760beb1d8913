//! Conversion between `wk_weather`, a flat struct with `has` bits, and [`Weather`], a nested struct with options.

use std::ptr::null;

use super::{
    boundary::{
        input::{self, List, Named},
        layout,
        numbers::WK_STRUCT_TYPE_WEATHER_OVERRIDES,
    },
    weather::*,
};
use crate::{
    error::{Error, Result},
    weather::{
        Aerosol, AerosolKind, CloudKind, CloudLayer, Fog, FogKind, LayerWind, Lofted, LoftedKind, MAX_CLOUD_LAYERS,
        Overrides, Precipitation, PrecipitationKind, Sea, Surface, SurfaceState, Swell, Weather, Wind,
    },
};

/// Reads, checks and converts a weather.
///
/// # Safety
/// `p` is NULL or points to a `wk_weather` with readable cloud layers.
///
/// # Errors
/// Names the first wrong field as in the header.
pub(super) unsafe fn from_c(param: &str, p: *const wk_weather) -> Result<Weather> {
    // SAFETY: the caller's promise.
    let c = unsafe { layout::read(&param, p)? };
    // SAFETY: as above.
    unsafe { layout::check_chain(&param, c.next, &[WK_STRUCT_TYPE_WEATHER_OVERRIDES])? };
    let mut weather = fields(&c).map_err(|e| flat_name(param, e))?;
    let mut take = |i: usize, layer: wk_cloud_layer| {
        let layer = cloud(&layer).map_err(|e| e.renamed("clouds[].kind", &format!("{param}.clouds[{i}].kind")))?;
        weather.clouds.push(layer);
        Ok(())
    };
    let of = |field: &str| format!("{param}.{field}");
    let (name, count, stride) = (of("clouds"), of("cloud_count"), of("cloud_stride"));
    let list = List {
        name: &name,
        count: Named(&count, c.cloud_count as usize),
        stride: Named(&stride, c.cloud_stride as usize),
        limit: MAX_CLOUD_LAYERS,
    };
    // SAFETY: as above.
    unsafe { input::each(&list, c.clouds, &mut take)? };
    weather.validate().map_err(|e| flat_name(param, e))?;
    Ok(weather)
}

/// Returns the overrides in a weather's chain, which [`from_c`] has checked; without overrides in the chain, none is
/// set.
///
/// # Safety
/// As [`from_c`].
///
/// # Errors
/// Names the first wrong field as in the header.
pub(super) unsafe fn overrides(param: &str, p: *const wk_weather) -> Result<Overrides> {
    // SAFETY: the caller's promise.
    let c = unsafe { layout::read(&param, p)? };
    // SAFETY: as above; the chain was checked.
    let Some(c) = (unsafe { layout::extension::<wk_weather_overrides>(c.next)? }) else {
        return Ok(Overrides::default());
    };
    let some = |bit: wk_override_flags, value: f64| (c.set & bit != 0).then_some(value);
    let overrides = Overrides {
        aerosol_extinction_per_m: some(WK_OVERRIDE_AEROSOL_EXTINCTION, c.aerosol_extinction_per_m),
        fog_extinction_per_m: some(WK_OVERRIDE_FOG_EXTINCTION, c.fog_extinction_per_m),
        precipitation_extinction_per_m: some(WK_OVERRIDE_PRECIPITATION_EXTINCTION, c.precipitation_extinction_per_m),
        visibility_above_fog_m: some(WK_OVERRIDE_VISIBILITY_ABOVE_FOG, c.visibility_above_fog_m),
        humidity_growth: some(WK_OVERRIDE_HUMIDITY_GROWTH, c.humidity_growth),
        rayleigh_density_ratio: some(WK_OVERRIDE_RAYLEIGH_DENSITY, c.rayleigh_density_ratio),
        rayleigh_scale_height_m: some(WK_OVERRIDE_RAYLEIGH_SCALE_HEIGHT, c.rayleigh_scale_height_m),
        rain_needs_cloud: (c.set & WK_OVERRIDE_RAIN_WITHOUT_CLOUD != 0).then_some(false),
        cloud_light: (c.set & WK_OVERRIDE_CLOUD_LIGHT != 0).then_some((c.cloud_direct, c.cloud_diffuse)),
        wave_height_m: some(WK_OVERRIDE_WAVE_HEIGHT, c.wave_height_m),
        wetness: some(WK_OVERRIDE_WETNESS, c.wetness),
    };
    let named = |e: Error| {
        e.renamed("overrides", "wk_weather_overrides")
            .renamed("wk_weather_overrides.cloud_light.0", "wk_weather_overrides.cloud_direct")
            .renamed("wk_weather_overrides.cloud_light.1", "wk_weather_overrides.cloud_diffuse")
    };
    overrides.validate().map_err(named)?;
    Ok(overrides)
}

/// Renames a field in an error: `wind.speed_m_s` of the Rust API is `weather.wind_speed_m_s` in the header.
fn flat_name(param: &str, e: Error) -> Error {
    let flat = |field: &str| match field {
        "wind.variable_deg.0" => "wind_variable_from_deg".into(),
        "wind.variable_deg.1" => "wind_variable_to_deg".into(),
        layer if layer.starts_with("clouds") => {
            layer.replace(".wind.speed_m_s", ".wind_m_s").replace(".wind.from_deg", ".wind_from_deg")
        }
        other => match other.strip_prefix("sea.swell.") {
            Some(swell) => format!("swell_{swell}"),
            None => other.replace('.', "_"),
        },
    };
    e.map_field(flat).within(param)
}

/// Converts all fields except the cloud layers.
fn fields(c: &wk_weather) -> Result<Weather> {
    let some = |bit: wk_weather_has_flags, value: f64| (c.has & bit != 0).then_some(value);
    let has = |bit: wk_weather_has_flags| c.has & bit != 0;
    let sea_state = has(WK_WEATHER_HAS_SEA_STATE)
        .then(|| u8::try_from(c.sea_state).map_err(|_| Error::range("sea.state", "in [0, 9]", c.sea_state)));
    let surface_state = has(WK_WEATHER_HAS_SURFACE_STATE).then(|| SurfaceState::from_u32(c.surface_state));
    Ok(Weather {
        visibility_m: c.visibility_m,
        vertical_visibility_m: some(WK_WEATHER_HAS_VERTICAL_VISIBILITY, c.vertical_visibility_m),
        runway_visual_range_m: some(WK_WEATHER_HAS_RUNWAY_VISUAL_RANGE, c.runway_visual_range_m),
        temperature_c: c.temperature_c,
        relative_humidity: c.relative_humidity,
        pressure_hpa: c.pressure_hpa,
        station_altitude_m: c.station_altitude_m,
        ozone_du: c.ozone_du,
        clouds: Vec::new(),
        aerosol: Aerosol {
            kind: AerosolKind::from_u32(c.aerosol_kind)?,
            angstrom_exponent: some(WK_WEATHER_HAS_AEROSOL_ANGSTROM_EXPONENT, c.aerosol_angstrom_exponent),
            single_scattering_albedo: some(
                WK_WEATHER_HAS_AEROSOL_SINGLE_SCATTERING_ALBEDO,
                c.aerosol_single_scattering_albedo,
            ),
            asymmetry: some(WK_WEATHER_HAS_AEROSOL_ASYMMETRY, c.aerosol_asymmetry),
            scale_height_m: some(WK_WEATHER_HAS_AEROSOL_SCALE_HEIGHT, c.aerosol_scale_height_m),
        },
        fog: Fog {
            kind: FogKind::from_u32(c.fog_kind)?,
            top_m: some(WK_WEATHER_HAS_FOG_TOP, c.fog_top_m),
            coverage: some(WK_WEATHER_HAS_FOG_COVERAGE, c.fog_coverage),
            visibility_inside_m: some(WK_WEATHER_HAS_FOG_VISIBILITY_INSIDE, c.fog_visibility_inside_m),
        },
        precipitation: Precipitation {
            kind: PrecipitationKind::from_u32(c.precipitation_kind)?,
            rate_mm_h: c.precipitation_rate_mm_h,
            liquid_fraction: some(WK_WEATHER_HAS_PRECIPITATION_LIQUID_FRACTION, c.precipitation_liquid_fraction),
            showers: c.precipitation_flags & WK_PRECIPITATION_SHOWERS != 0,
            thunderstorm: c.precipitation_flags & WK_PRECIPITATION_THUNDERSTORM != 0,
            hail: c.precipitation_flags & WK_PRECIPITATION_WITH_HAIL != 0,
        },
        wind: Wind {
            speed_m_s: c.wind_speed_m_s,
            from_deg: c.wind_from_deg,
            gust_m_s: some(WK_WEATHER_HAS_WIND_GUST, c.wind_gust_m_s),
            variable_deg: has(WK_WEATHER_HAS_WIND_VARIABLE)
                .then_some((c.wind_variable_from_deg, c.wind_variable_to_deg)),
            turbulence_intensity: some(WK_WEATHER_HAS_WIND_TURBULENCE_INTENSITY, c.wind_turbulence_intensity),
        },
        sea: Sea {
            significant_wave_height_m: some(WK_WEATHER_HAS_SEA_WAVE_HEIGHT, c.sea_significant_wave_height_m),
            state: sea_state.transpose()?,
            temperature_c: some(WK_WEATHER_HAS_SEA_TEMPERATURE, c.sea_temperature_c),
            swell: has(WK_WEATHER_HAS_SWELL).then_some(Swell {
                height_m: c.swell_height_m,
                period_s: c.swell_period_s,
                from_deg: c.swell_from_deg,
            }),
        },
        surface: Surface {
            state: surface_state.transpose()?,
            snow_depth_m: c.surface_snow_depth_m,
            roughness_length_m: some(WK_WEATHER_HAS_SURFACE_ROUGHNESS_LENGTH, c.surface_roughness_length_m),
        },
        lofted: Lofted {
            kind: LoftedKind::from_u32(c.lofted_kind)?,
            top_m: some(WK_WEATHER_HAS_LOFTED_TOP, c.lofted_top_m),
        },
    })
}

/// Converts a cloud layer.
fn cloud(c: &wk_cloud_layer) -> Result<CloudLayer> {
    let some = |bit: wk_cloud_layer_has_flags, value: f64| (c.has & bit != 0).then_some(value);
    Ok(CloudLayer {
        cover: c.cover,
        base_m: c.base_m,
        thickness_m: some(WK_CLOUD_LAYER_HAS_THICKNESS, c.thickness_m),
        kind: CloudKind::from_u32(c.kind)?,
        water_g_m3: some(WK_CLOUD_LAYER_HAS_WATER, c.water_g_m3),
        droplet_radius_um: some(WK_CLOUD_LAYER_HAS_DROPLET_RADIUS, c.droplet_radius_um),
        wind: some(WK_CLOUD_LAYER_HAS_WIND, c.wind_m_s)
            .map(|speed_m_s| LayerWind { speed_m_s, from_deg: c.wind_from_deg }),
        spacing_m: (c.spacing_m != 0.0).then_some(c.spacing_m),
        life_s: (c.life_s != 0.0).then_some(c.life_s),
    })
}

/// Collects `has` bits while it unwraps options.
struct HasBits<T>(T);

impl HasBits<u64> {
    fn put(&mut self, bit: u64, value: Option<f64>) -> f64 {
        self.0 |= if value.is_some() { bit } else { 0 };
        value.unwrap_or(0.0)
    }
}

impl HasBits<u32> {
    fn put(&mut self, bit: u32, value: Option<f64>) -> f64 {
        self.0 |= if value.is_some() { bit } else { 0 };
        value.unwrap_or(0.0)
    }
}

/// Returns the flat struct of a weather, without its clouds.
pub(super) fn to_c(w: &Weather) -> wk_weather {
    let mut has = HasBits(0_u64);
    let variable = w.wind.variable_deg;
    let swell = w.sea.swell;
    let flags = [
        (w.precipitation.showers, WK_PRECIPITATION_SHOWERS),
        (w.precipitation.thunderstorm, WK_PRECIPITATION_THUNDERSTORM),
        (w.precipitation.hail, WK_PRECIPITATION_WITH_HAIL),
    ];
    let mut c = wk_weather {
        visibility_m: w.visibility_m,
        vertical_visibility_m: has.put(WK_WEATHER_HAS_VERTICAL_VISIBILITY, w.vertical_visibility_m),
        runway_visual_range_m: has.put(WK_WEATHER_HAS_RUNWAY_VISUAL_RANGE, w.runway_visual_range_m),
        temperature_c: w.temperature_c,
        relative_humidity: w.relative_humidity,
        pressure_hpa: w.pressure_hpa,
        station_altitude_m: w.station_altitude_m,
        ozone_du: w.ozone_du,
        aerosol_kind: w.aerosol.kind as u32,
        fog_kind: w.fog.kind as u32,
        aerosol_angstrom_exponent: has.put(WK_WEATHER_HAS_AEROSOL_ANGSTROM_EXPONENT, w.aerosol.angstrom_exponent),
        aerosol_single_scattering_albedo: has
            .put(WK_WEATHER_HAS_AEROSOL_SINGLE_SCATTERING_ALBEDO, w.aerosol.single_scattering_albedo),
        aerosol_asymmetry: has.put(WK_WEATHER_HAS_AEROSOL_ASYMMETRY, w.aerosol.asymmetry),
        aerosol_scale_height_m: has.put(WK_WEATHER_HAS_AEROSOL_SCALE_HEIGHT, w.aerosol.scale_height_m),
        fog_top_m: has.put(WK_WEATHER_HAS_FOG_TOP, w.fog.top_m),
        fog_coverage: has.put(WK_WEATHER_HAS_FOG_COVERAGE, w.fog.coverage),
        fog_visibility_inside_m: has.put(WK_WEATHER_HAS_FOG_VISIBILITY_INSIDE, w.fog.visibility_inside_m),
        precipitation_kind: w.precipitation.kind as u32,
        precipitation_flags: flags.iter().filter(|f| f.0).fold(0, |all, f| all | f.1),
        precipitation_rate_mm_h: w.precipitation.rate_mm_h,
        precipitation_liquid_fraction: has
            .put(WK_WEATHER_HAS_PRECIPITATION_LIQUID_FRACTION, w.precipitation.liquid_fraction),
        wind_speed_m_s: w.wind.speed_m_s,
        wind_from_deg: w.wind.from_deg,
        wind_gust_m_s: has.put(WK_WEATHER_HAS_WIND_GUST, w.wind.gust_m_s),
        wind_variable_from_deg: has.put(WK_WEATHER_HAS_WIND_VARIABLE, variable.map(|v| v.0)),
        wind_variable_to_deg: has.put(WK_WEATHER_HAS_WIND_VARIABLE, variable.map(|v| v.1)),
        wind_turbulence_intensity: has.put(WK_WEATHER_HAS_WIND_TURBULENCE_INTENSITY, w.wind.turbulence_intensity),
        sea_significant_wave_height_m: has.put(WK_WEATHER_HAS_SEA_WAVE_HEIGHT, w.sea.significant_wave_height_m),
        sea_temperature_c: has.put(WK_WEATHER_HAS_SEA_TEMPERATURE, w.sea.temperature_c),
        swell_height_m: has.put(WK_WEATHER_HAS_SWELL, swell.map(|s| s.height_m)),
        swell_period_s: has.put(WK_WEATHER_HAS_SWELL, swell.map(|s| s.period_s)),
        swell_from_deg: has.put(WK_WEATHER_HAS_SWELL, swell.map(|s| s.from_deg)),
        sea_state: has.put(WK_WEATHER_HAS_SEA_STATE, w.sea.state.map(f64::from)) as u32,
        surface_state: has.put(WK_WEATHER_HAS_SURFACE_STATE, w.surface.state.map(|s| f64::from(s as u32))) as u32,
        surface_snow_depth_m: w.surface.snow_depth_m,
        surface_roughness_length_m: has.put(WK_WEATHER_HAS_SURFACE_ROUGHNESS_LENGTH, w.surface.roughness_length_m),
        lofted_top_m: has.put(WK_WEATHER_HAS_LOFTED_TOP, w.lofted.top_m),
        lofted_kind: w.lofted.kind as u32,
        ..wk_weather::INIT
    };
    c.has = has.0;
    c
}

/// Output structs of a caller for a weather and its layers, checked before anything is written.
pub(super) struct WeatherOut {
    weather: layout::OutStruct<wk_weather>,
    layers: *mut wk_cloud_layer,
    capacity: usize,
    stride: usize,
}

/// Checks a caller's output structs.
///
/// # Safety
/// `answer` is NULL or a `wk_weather`; `layers` is NULL or has `capacity` elements of `stride` bytes.
///
/// # Errors
/// Names the wrong parameter.
pub(super) unsafe fn weather_out(
    layers: *mut wk_cloud_layer,
    capacity: u32,
    stride: u32,
    answer: *mut wk_weather,
) -> Result<WeatherOut> {
    // SAFETY: the caller's promise.
    let weather = unsafe { layout::out_struct(&"out_weather", answer)? };
    let (capacity, stride) = (capacity as usize, stride as usize);
    if capacity > 0 {
        layout::check_pointer(&"layers", layers)?;
        layout::check_version_size::<wk_cloud_layer>("layer_size", stride)?;
    }
    Ok(WeatherOut { weather, layers, capacity, stride })
}

impl WeatherOut {
    /// Writes a weather; its clouds are written to the caller's layers.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] if there are more layers than `capacity`; then nothing is written.
    pub(super) fn set(self, w: &Weather) -> Result<()> {
        if w.clouds.len() > self.capacity {
            let accepted = format!("at least {} here (16 always suffice)", w.clouds.len());
            return Err(Error::range("layer_capacity", &accepted, self.capacity));
        }
        for (i, layer) in w.clouds.iter().enumerate() {
            // SAFETY: `capacity` elements of `stride` bytes are the caller's, and the stride holds a known version.
            unsafe {
                layout::write_version(&cloud_to_c(layer), self.layers.cast::<u8>().add(i * self.stride), self.stride)
            };
        }
        let mut c = to_c(w);
        c.cloud_count = w.clouds.len() as u32;
        c.clouds = if w.clouds.is_empty() { null() } else { self.layers };
        c.cloud_stride = if w.clouds.is_empty() { c.cloud_stride } else { self.stride as u32 };
        self.weather.set(&c);
        Ok(())
    }
}

/// Returns the C struct of a cloud layer.
fn cloud_to_c(layer: &CloudLayer) -> wk_cloud_layer {
    let mut has = HasBits(0_u32);
    let mut c = wk_cloud_layer {
        kind: layer.kind as u32,
        cover: layer.cover,
        base_m: layer.base_m,
        thickness_m: has.put(WK_CLOUD_LAYER_HAS_THICKNESS, layer.thickness_m),
        water_g_m3: has.put(WK_CLOUD_LAYER_HAS_WATER, layer.water_g_m3),
        droplet_radius_um: has.put(WK_CLOUD_LAYER_HAS_DROPLET_RADIUS, layer.droplet_radius_um),
        wind_m_s: has.put(WK_CLOUD_LAYER_HAS_WIND, layer.wind.map(|w| w.speed_m_s)),
        wind_from_deg: has.put(WK_CLOUD_LAYER_HAS_WIND, layer.wind.map(|w| w.from_deg)),
        spacing_m: layer.spacing_m.unwrap_or(0.0),
        life_s: layer.life_s.unwrap_or(0.0),
        ..wk_cloud_layer::INIT
    };
    c.has = has.0;
    c
}
