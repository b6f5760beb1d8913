//! Random weathers over all documented ranges, often at the ends.

use welkin::weather::*;

use crate::host::Dice;

/// A number of a weather or of its overrides: name, range and setter.
pub struct Field {
    pub name: &'static str,
    pub range: [f64; 2],
    pub set: fn(&mut Given, f64),
}

/// Weather and overrides that a host gives.
#[derive(Clone, Debug, Default)]
pub struct Given {
    pub weather: Weather,
    pub overrides: Overrides,
}

macro_rules! fields {
    ($($name:literal, $lo:expr, $hi:expr, |$g:ident, $v:ident| $set:expr;)+) => {
        &[$(Field { name: $name, range: [$lo, $hi], set: |$g, $v| $set },)+]
    };
}

fn swell(g: &mut Given) -> &mut Swell {
    g.weather.sea.swell.get_or_insert(Swell { height_m: 2.0, period_s: 9.0, from_deg: 300.0 })
}

/// Every number with a range, at the ranges that the documentation of [`Weather`] and [`Overrides`] states.
#[rustfmt::skip]
pub const FIELDS: &[Field] = fields![
    "visibility_m", 1.0, 1e6, |g, v| g.weather.visibility_m = v;
    "vertical_visibility_m", 0.0, 10_000.0, |g, v| g.weather.vertical_visibility_m = Some(v);
    "runway_visual_range_m", 1.0, 10_000.0, |g, v| g.weather.runway_visual_range_m = Some(v);
    "temperature_c", -90.0, 60.0, |g, v| g.weather.temperature_c = v;
    "relative_humidity", 0.0, 1.0, |g, v| g.weather.relative_humidity = v;
    "pressure_hpa", 800.0, 1100.0, |g, v| g.weather.pressure_hpa = v;
    "station_altitude_m", -500.0, 9000.0, |g, v| g.weather.station_altitude_m = v;
    "ozone_du", 0.0, 700.0, |g, v| g.weather.ozone_du = v;
    "aerosol.angstrom_exponent", -1.0, 4.0, |g, v| g.weather.aerosol.angstrom_exponent = Some(v);
    "aerosol.single_scattering_albedo", 0.0, 1.0, |g, v| g.weather.aerosol.single_scattering_albedo = Some(v);
    "aerosol.asymmetry", -0.99, 0.99, |g, v| g.weather.aerosol.asymmetry = Some(v);
    "aerosol.scale_height_m", 10.0, 20_000.0, |g, v| g.weather.aerosol.scale_height_m = Some(v);
    "fog.top_m", 0.1, 2000.0, |g, v| g.weather.fog.top_m = Some(v);
    "fog.coverage", 0.0, 1.0, |g, v| g.weather.fog.coverage = Some(v);
    "fog.visibility_inside_m", 1.0, 10_000.0, |g, v| g.weather.fog.visibility_inside_m = Some(v);
    "clouds[0].cover", 0.0, 1.0, |g, v| g.weather.clouds[0].cover = v;
    "clouds[0].base_m", 0.0, 20_000.0, |g, v| g.weather.clouds[0].base_m = v;
    "clouds[0].thickness_m", 1.0, 20_000.0, |g, v| g.weather.clouds[0].thickness_m = Some(v);
    "clouds[0].water_g_m3", 0.0, 10.0, |g, v| g.weather.clouds[0].water_g_m3 = Some(v);
    "clouds[0].droplet_radius_um", 1.0, 500.0, |g, v| g.weather.clouds[0].droplet_radius_um = Some(v);
    "clouds[0].spacing_m", 50.0, 200e3, |g, v| g.weather.clouds[0].spacing_m = Some(v);
    "clouds[0].life_s", 60.0, 1e6, |g, v| g.weather.clouds[0].life_s = Some(v);
    "precipitation.rate_mm_h", 0.0, 500.0, |g, v| g.weather.precipitation.rate_mm_h = v;
    "precipitation.liquid_fraction", 0.0, 1.0, |g, v| g.weather.precipitation.liquid_fraction = Some(v);
    "wind.speed_m_s", 0.0, 120.0, |g, v| g.weather.wind.speed_m_s = v;
    "wind.from_deg", 0.0, 360.0, |g, v| g.weather.wind.from_deg = v;
    "wind.gust_m_s", 0.0, 150.0, |g, v| g.weather.wind.gust_m_s = Some(v);
    "wind.variable_deg.0", 0.0, 360.0, |g, v| g.weather.wind.variable_deg.get_or_insert((0.0, 90.0)).0 = v;
    "wind.variable_deg.1", 0.0, 360.0, |g, v| g.weather.wind.variable_deg.get_or_insert((0.0, 90.0)).1 = v;
    "wind.turbulence_intensity", 0.0, 1.0, |g, v| g.weather.wind.turbulence_intensity = Some(v);
    "sea.significant_wave_height_m", 0.0, 30.0, |g, v| g.weather.sea.significant_wave_height_m = Some(v);
    "sea.state", 0.0, 9.0, |g, v| g.weather.sea.state = Some(v as u8);
    "sea.temperature_c", -3.0, 45.0, |g, v| g.weather.sea.temperature_c = Some(v);
    "sea.swell.height_m", 0.0, 20.0, |g, v| swell(g).height_m = v;
    "sea.swell.period_s", 1.0, 30.0, |g, v| swell(g).period_s = v;
    "sea.swell.from_deg", 0.0, 360.0, |g, v| swell(g).from_deg = v;
    "surface.snow_depth_m", 0.0, 20.0, |g, v| g.weather.surface.snow_depth_m = v;
    "surface.roughness_length_m", 1e-5, 5.0, |g, v| g.weather.surface.roughness_length_m = Some(v);
    "lofted.top_m", 0.1, 5000.0, |g, v| g.weather.lofted.top_m = Some(v);
    "overrides.aerosol_extinction_per_m", 0.0, 10.0, |g, v| g.overrides.aerosol_extinction_per_m = Some(v);
    "overrides.fog_extinction_per_m", 0.0, 10.0, |g, v| g.overrides.fog_extinction_per_m = Some(v);
    "overrides.precipitation_extinction_per_m", 0.0, 10.0, |g, v| g.overrides.precipitation_extinction_per_m = Some(v);
    "overrides.visibility_above_fog_m", 100.0, 1e6, |g, v| g.overrides.visibility_above_fog_m = Some(v);
    "overrides.humidity_growth", 0.1, 20.0, |g, v| g.overrides.humidity_growth = Some(v);
    "overrides.rayleigh_density_ratio", 0.0, 10.0, |g, v| g.overrides.rayleigh_density_ratio = Some(v);
    "overrides.rayleigh_scale_height_m", 100.0, 50_000.0, |g, v| g.overrides.rayleigh_scale_height_m = Some(v);
    "overrides.cloud_light.0", 0.0, 1.0, |g, v| g.overrides.cloud_light.get_or_insert((0.5, 0.5)).0 = v;
    "overrides.cloud_light.1", 0.0, 1.0, |g, v| g.overrides.cloud_light.get_or_insert((0.5, 0.5)).1 = v;
    "overrides.wave_height_m", 0.0, 30.0, |g, v| g.overrides.wave_height_m = Some(v);
    "overrides.wetness", 0.0, 1.0, |g, v| g.overrides.wetness = Some(v);
];

/// Number of the [`FIELDS`] of a weather, which come first; the others are overrides.
pub fn weather_fields() -> usize {
    FIELDS.iter().position(|f| f.name.starts_with("overrides.")).unwrap()
}

fn pick<T: Copy>(dice: &mut Dice, all: &[T]) -> T {
    all[dice.below(all.len())]
}

/// A random number of a range: one of its ends, or a number between them, evenly distributed or by its order of
/// magnitude.
fn number(dice: &mut Dice, [lo, hi]: [f64; 2]) -> f64 {
    let u = dice.below(1 << 30) as f64 / f64::from(1 << 30);
    match dice.below(5) {
        0 => lo,
        1 => hi,
        2 if hi > 0.0 => lo + (hi - lo) * 1e-6f64.powf(1.0 - u),
        _ => lo + (hi - lo) * u,
    }
}

impl Given {
    /// A weather with random kinds, flags and layers, and usual numbers.
    pub fn of_kinds(dice: &mut Dice) -> Self {
        let mut given = Self::default();
        let w = &mut given.weather;
        w.aerosol.kind = pick(dice, AerosolKind::ALL);
        w.fog.kind = pick(dice, FogKind::ALL);
        w.precipitation = Precipitation::of(pick(dice, PrecipitationKind::ALL), 4.0);
        w.lofted.kind = pick(dice, LoftedKind::ALL);
        let state = pick(dice, SurfaceState::ALL);
        w.surface.state = (dice.below(2) == 0).then_some(state);
        [w.precipitation.showers, w.precipitation.thunderstorm, w.precipitation.hail] =
            [0; 3].map(|_| dice.below(3) == 0);
        w.clouds = vec![CloudLayer::of(pick(dice, CloudKind::ALL), 1.0, 900.0)];
        given
    }

    /// Sets `field` to a random number of its range.
    pub fn set(&mut self, dice: &mut Dice, field: &Field) {
        if field.name.starts_with("clouds[0]") {
            // A random layer becomes the first.
            let count = self.weather.clouds.len();
            self.weather.clouds.swap(0, dice.below(count));
        }
        (field.set)(self, number(dice, field.range));
    }

    /// The weather with each number that depends on another brought into its range, so that it is accepted.
    pub fn accepted(mut self) -> Self {
        let w = &mut self.weather;
        if w.precipitation.kind == PrecipitationKind::None {
            w.precipitation.rate_mm_h = 0.0;
        }
        w.wind.gust_m_s = w.wind.gust_m_s.map(|gust| gust.max(w.wind.speed_m_s));
        w.validate().unwrap();
        self.overrides.validate().unwrap();
        self
    }

    /// A random weather; one in three has overrides.
    pub fn random(dice: &mut Dice) -> Self {
        let mut given = Self::of_kinds(dice);
        for _ in 1..=dice.below(MAX_CLOUD_LAYERS) / (1 + dice.below(8)) {
            given.weather.clouds.push(CloudLayer::of(pick(dice, CloudKind::ALL), 0.5, 900.0));
        }
        let often = 1 + dice.below(8);
        let fields = if dice.below(3) == 0 { FIELDS.len() } else { weather_fields() };
        for field in &FIELDS[..fields] {
            let repeat = if field.name.starts_with("clouds[0]") { given.weather.clouds.len() } else { 1 };
            for _ in 0..repeat {
                if dice.below(often) == 0 {
                    given.set(dice, field);
                }
            }
        }
        given.accepted()
    }
}
