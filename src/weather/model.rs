//! `Weather`: the weather as the host states it, in SI units, before any physics.

use super::kinds::{AerosolKind, CloudKind, FogKind, LoftedKind, PrecipitationKind, SurfaceState};

/// Maximum number of cloud layers of a [`Weather`].
pub const MAX_CLOUD_LAYERS: usize = 16;

/// The weather at one place and time, as a host or a METAR report states it.
///
/// Zero never means unknown: it is 0 C, north or calm. Values that may be unknown are an `Option`; for `None`,
/// [`super::derive`] chooses by a published law. [`Weather::default`] is a clear standard day. Plain data: any thread.
#[derive(Clone, Debug, PartialEq)]
pub struct Weather {
    /// Meteorological optical range, m: the distance at which 550 nm light falls to 5 % (WMO-No. 8, aviation use), at
    /// station height. The value is **total**: air, haze, fog, rain and snow together. Range [1, 1e6], default 40 000.
    /// A visibility above about 260 km would need less extinction than pure air has; the aerosol has then none.
    pub visibility_m: f64,
    /// Vertical visibility into an obscured sky, m. Range [0, 10 000], default none (the sky is not obscured).
    /// It sets the depth of fog, and of mist with a `visibility_m` below 1 km.
    pub vertical_visibility_m: Option<f64>,
    /// Runway visual range, m: how far lights and markings are seen. Range [1, 10 000], default none.
    /// For information only: extinction follows `visibility_m`.
    pub runway_visual_range_m: Option<f64>,
    /// Air temperature at 2 m, degrees Celsius. Range [-90, 60], default 15.
    pub temperature_c: f64,
    /// Relative humidity over water, fraction. Range [0, 1], default 0.5. See [`Weather::set_dew_point_c`].
    pub relative_humidity: f64,
    /// Pressure reduced to mean sea level (QNH), hPa. Range [800, 1100], default 1013.25.
    pub pressure_hpa: f64,
    /// Height of the station above mean sea level, m. Range [-500, 9000], default 0. Visibility, temperature and cloud
    /// bases refer to this height.
    pub station_altitude_m: f64,
    /// Particles in the air. Default continental, every optional field none.
    pub aerosol: Aerosol,
    /// Fog or mist. Default none.
    pub fog: Fog,
    /// Cloud layers, at most [`MAX_CLOUD_LAYERS`], in any order. Default none.
    pub clouds: Vec<CloudLayer>,
    /// Precipitation. Default none.
    pub precipitation: Precipitation,
    /// Wind. Default calm.
    pub wind: Wind,
    /// The sea. Default: every field none.
    pub sea: Sea,
    /// The ground. Default: every field none, no snow.
    pub surface: Surface,
    /// Matter that the wind lifts. Default none.
    pub lofted: Lofted,
    /// Ozone column, Dobson units. Range [0, 700], default 300.
    pub ozone_du: f64,
}

/// Particles suspended in the mixed layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aerosol {
    /// Kind of the particles. Sets the values of the fields below where those are `None`. Blowing dust or sand replaces
    /// every kind but haze, dust, sand, smoke and volcanic ash.
    pub kind: AerosolKind,
    /// Angstrom exponent: extinction is proportional to wavelength^-exponent. Range [-1, 4]; default by kind and
    /// humidity.
    pub angstrom_exponent: Option<f64>,
    /// Single scattering albedo at 550 nm and ambient humidity. Range [0, 1]; default by kind and humidity.
    pub single_scattering_albedo: Option<f64>,
    /// Asymmetry of the phase function (mean cosine). Range [-0.99, 0.99]; default by kind and humidity.
    pub asymmetry: Option<f64>,
    /// Height over which the density of the particles falls by a factor e, m. Range [10, 20 000]; default by kind.
    /// Raised to at least the station's altitude divided by 4.6 (435 m at 2000 m): the sky's tables start from the
    /// density at sea level, which can be at most a hundred times that at the station.
    pub scale_height_m: Option<f64>,
}

/// Droplets at the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// Kind of fog.
    pub kind: FogKind,
    /// Top of the fog above the station, m. Range [0.1, 2000]; default the top of lifted matter, else by kind,
    /// visibility, vertical visibility and lowest cloud.
    pub top_m: Option<f64>,
    /// Share of the ground under fog. Range [0, 1]; default by kind: 1, or 0.4 for patches, 0.6 for partial fog.
    pub coverage: Option<f64>,
    /// Visibility, m, inside a layer that `visibility_m` does not describe. Such layers are shallow fog, patches or
    /// partial fog with a `visibility_m` of at least 1 km, and drifting snow or dust without fog. Range [1, 10 000];
    /// default 200 in fog, 500 in drifting snow or dust. Without effect on other layers, inside which `visibility_m`
    /// holds.
    pub visibility_inside_m: Option<f64>,
}

/// One layer of cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloudLayer {
    /// Share of the sky that the layer covers. Range [0, 1]. [`cover_from_oktas`] converts eighths.
    pub cover: f64,
    /// Base above the station, m. Range [0, 20 000].
    pub base_m: f64,
    /// Thickness, m. Range [1, 20 000]; default by kind.
    pub thickness_m: Option<f64>,
    /// Kind of cloud.
    pub kind: CloudKind,
    /// Liquid water or ice content, g/m^3. Range [0, 10]; default by kind. Raised in the layer from which precipitation
    /// falls, if the rate needs more.
    pub water_g_m3: Option<f64>,
    /// Effective radius of droplets or crystals, um. Range [1, 500]; default by kind.
    pub droplet_radius_um: Option<f64>,
    /// Wind that carries the layer; default the weather's wind at the middle of the layer
    /// ([`super::WindProfile::mean_at_height_m_s`]).
    pub wind: Option<LayerWind>,
    /// Distance from cloud to cloud, m. Range [50, 200 000]; default by kind and thickness.
    pub spacing_m: Option<f64>,
    /// Time in which the layer's clouds form and dissolve, s. Range [60, 1e6]; default 1200: a fair-weather cumulus
    /// lives some 20 minutes (Stull 1988, chapter 13).
    pub life_s: Option<f64>,
}

/// Wind of a layer of cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerWind {
    /// Speed, m/s. Range [0, 150].
    pub speed_m_s: f64,
    /// Direction from which the wind blows, degrees clockwise from true north. Range [0, 360].
    pub from_deg: f64,
}

/// Precipitation from the clouds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Precipitation {
    /// Kind of precipitation; the heaviest one if several fall.
    pub kind: PrecipitationKind,
    /// Rate, mm/h of liquid water. Range [0, 500]; must be 0 if `kind` is none.
    pub rate_mm_h: f64,
    /// Share of the precipitation that is liquid. Range [0, 1]; default by kind.
    pub liquid_fraction: Option<f64>,
    /// Whether the precipitation falls from convective cloud (SH): fewer and larger drops, with a sharp onset and end.
    pub showers: bool,
    /// Whether there is thunder (TS).
    pub thunderstorm: bool,
    /// Whether hail falls with the precipitation (GR, GS beside rain).
    pub hail: bool,
}

/// Wind at 10 m above ground, 10-minute mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wind {
    /// Mean speed, m/s. Range [0, 120], default 0.
    pub speed_m_s: f64,
    /// Direction from which the wind blows, degrees clockwise from true north. Range [0, 360], default 0.
    pub from_deg: f64,
    /// Highest 3-second gust, m/s. Range [speed, 150]; default from the turbulence.
    pub gust_m_s: Option<f64>,
    /// Range over which the direction varies, clockwise from the first to the second angle, degrees. Range [0, 360]
    /// each; default none. (0, 360) means all directions (VRB).
    pub variable_deg: Option<(f64, f64)>,
    /// Ratio of the standard deviation of the speed to its mean. Range [0, 1]; default the larger of that from the
    /// roughness (neutral log law) and that from `gust_m_s`.
    pub turbulence_intensity: Option<f64>,
}

/// The sea's surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sea {
    /// Significant height of the wind sea, m. Range [0, 30]; default from `state`, else from the wind.
    pub significant_wave_height_m: Option<f64>,
    /// WMO sea state code 3700. Range 0..=9; default none.
    pub state: Option<u8>,
    /// Water temperature, degrees Celsius. Range [-3, 45]; default the air temperature, at least -1.8.
    pub temperature_c: Option<f64>,
    /// Swell in addition to the wind sea. Default none.
    pub swell: Option<Swell>,
}

/// Waves raised by a distant wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swell {
    /// Significant height, m. Range [0, 20].
    pub height_m: f64,
    /// Peak period, s. Range [1, 30].
    pub period_s: f64,
    /// Direction from which the swell comes, degrees clockwise from true north. Range [0, 360].
    pub from_deg: f64,
}

/// The ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// State as observed; default from precipitation, temperature, humidity and snow depth.
    pub state: Option<SurfaceState>,
    /// Depth of lying snow, m. Range [0, 20], default 0.
    pub snow_depth_m: f64,
    /// Roughness length of the land, m. Range [1e-5, 5]; default 0.03 (open grassland, WMO station siting).
    pub roughness_length_m: Option<f64>,
}

/// Matter that the wind lifts from the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lofted {
    /// Kind of matter.
    pub kind: LoftedKind,
    /// Depth of the lifted layer, m. Range [0.1, 5000]; default by kind.
    pub top_m: Option<f64>,
}

impl Default for Weather {
    /// Creates a clear standard day: 15 C, 1013.25 hPa, 50 %, 40 km, calm.
    fn default() -> Self {
        Self {
            visibility_m: 40_000.0,
            vertical_visibility_m: None,
            runway_visual_range_m: None,
            temperature_c: 15.0,
            relative_humidity: 0.5,
            pressure_hpa: 1013.25,
            station_altitude_m: 0.0,
            aerosol: Aerosol::default(),
            fog: Fog::default(),
            clouds: Vec::new(),
            precipitation: Precipitation::default(),
            wind: Wind::default(),
            sea: Sea::default(),
            surface: Surface::default(),
            lofted: Lofted::default(),
            ozone_du: 300.0,
        }
    }
}

impl Aerosol {
    /// Creates particles of `kind` with that kind's properties.
    pub const fn of(kind: AerosolKind) -> Self {
        Self { kind, angstrom_exponent: None, single_scattering_albedo: None, asymmetry: None, scale_height_m: None }
    }
}

impl Default for Aerosol {
    fn default() -> Self {
        Self::of(AerosolKind::Continental)
    }
}

impl Fog {
    /// Creates fog of `kind` with that kind's depth and coverage.
    pub const fn of(kind: FogKind) -> Self {
        Self { kind, top_m: None, coverage: None, visibility_inside_m: None }
    }
}

impl Default for Fog {
    fn default() -> Self {
        Self::of(FogKind::None)
    }
}

impl CloudLayer {
    /// Creates a layer of unknown kind, thickness and water; `cover` is a share of the sky, `base_m` is above the
    /// station.
    pub const fn new(cover: f64, base_m: f64) -> Self {
        Self::of(CloudKind::Unknown, cover, base_m)
    }

    /// Creates a layer of `kind` with that kind's thickness and water; `cover` is a share of the sky, `base_m` above
    /// the station.
    pub const fn of(kind: CloudKind, cover: f64, base_m: f64) -> Self {
        Self {
            cover,
            base_m,
            thickness_m: None,
            kind,
            water_g_m3: None,
            droplet_radius_um: None,
            wind: None,
            spacing_m: None,
            life_s: None,
        }
    }
}

impl Precipitation {
    /// Creates steady precipitation of `kind` at `rate_mm_h`, without thunder.
    pub const fn of(kind: PrecipitationKind, rate_mm_h: f64) -> Self {
        Self { kind, rate_mm_h, liquid_fraction: None, showers: false, thunderstorm: false, hail: false }
    }
}

impl Default for Precipitation {
    fn default() -> Self {
        Self::of(PrecipitationKind::None, 0.0)
    }
}

impl Wind {
    /// Creates a steady wind of `speed_m_s` from `from_deg`.
    pub const fn of(speed_m_s: f64, from_deg: f64) -> Self {
        Self { speed_m_s, from_deg, gust_m_s: None, variable_deg: None, turbulence_intensity: None }
    }
}

impl Default for Wind {
    fn default() -> Self {
        Self::of(0.0, 0.0)
    }
}

impl Default for Surface {
    fn default() -> Self {
        Self { state: None, snow_depth_m: 0.0, roughness_length_m: None }
    }
}

impl Lofted {
    /// Creates matter of `kind` with its usual depth.
    pub const fn of(kind: LoftedKind) -> Self {
        Self { kind, top_m: None }
    }
}

impl Default for Lofted {
    fn default() -> Self {
        Self::of(LoftedKind::None)
    }
}

/// Converts cloud cover from eighths of the sky, clamped to 0..=8, to a share.
pub fn cover_from_oktas(oktas: u32) -> f64 {
    f64::from(oktas.min(8)) / 8.0
}

/// Returns the saturation pressure of water vapour over water, hPa: 6.112 exp(17.62 t / (243.12 + t)) (WMO-No. 8, Annex
/// 4.B), t in degrees Celsius.
pub fn saturation_pressure_hpa(temperature_c: f64) -> f64 {
    6.112 * libm::exp(17.62 * temperature_c / (243.12 + temperature_c))
}

impl Weather {
    /// Sets the humidity from a dew point (degrees Celsius): [`saturation_pressure_hpa`] at the dew point divided by
    /// its value at the air temperature. A dew point above the temperature gives saturation, a humidity of 1.
    pub fn set_dew_point_c(&mut self, dew_point_c: f64) {
        let ratio = saturation_pressure_hpa(dew_point_c) / saturation_pressure_hpa(self.temperature_c);
        self.relative_humidity = ratio.clamp(0.0, 1.0);
    }

    /// Returns the dew point, degrees Celsius (the inverse of [`saturation_pressure_hpa`]); -90 for a vapour pressure
    /// below 1e-6 hPa, as at humidity 0.
    pub fn dew_point_c(&self) -> f64 {
        let e = saturation_pressure_hpa(self.temperature_c) * self.relative_humidity;
        if e < 1e-6 {
            return -90.0;
        }
        let l = libm::log(e / 6.112);
        243.12 * l / (17.62 - l)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dew_point_round_trips_and_matches_the_tables() {
        // 20 C: 23.37 hPa in the WMO formula; published steam-table value 23.39.
        assert!((saturation_pressure_hpa(20.0) - 23.37).abs() < 0.05);
        let mut w = Weather { temperature_c: 25.0, ..Weather::default() };
        w.set_dew_point_c(12.0);
        assert!((w.relative_humidity - 0.443).abs() < 0.002, "{}", w.relative_humidity);
        assert!((w.dew_point_c() - 12.0).abs() < 1e-9);
        w.set_dew_point_c(30.0);
        assert_eq!(w.relative_humidity, 1.0);
        w.relative_humidity = 0.0;
        assert_eq!(w.dew_point_c(), -90.0);
    }

    #[test]
    fn oktas_clamp() {
        assert_eq!([0, 4, 8, 99].map(cover_from_oktas), [0.0, 0.5, 1.0, 1.0]);
    }
}
