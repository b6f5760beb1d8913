//! From what the host has said to what Welkin's weather takes: a pure function to plain values, whose names, units and
//! ranges are those of `welkin::weather::Weather`.
//!
//! Compare one result with the next, and hand on what differs: a host that repeats its packets every frame changes
//! nothing.

use std::collections::BTreeSet;

use crate::notes::Note;
use crate::site::{CloudKind, ComponentMeaning, LayerMeaning, Site, SurfaceState};
use crate::state::{Clock, Layer, MergeFlags, Scope, Shape, State};

/// Contrast of 5 % at the visibility: extinction times visibility (WMO-No. 8).
const LN_20: f64 = 2.995_732_273_553_991;
/// Most regions that Welkin takes.
pub const MAX_WELKIN_REGIONS: usize = 64;
/// Most cloud layers that Welkin takes.
const MAX_CLOUDS: usize = 16;
/// Effective radii of droplets and of ice crystals, um, by which visibility gives the water in a cloud.
const RADIUS_UM: [f64; 2] = [10.0, 30.0];

/// Fog on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogValues {
    /// Top above the station, m.
    pub top_m: f64,
    /// Visibility inside, m.
    pub visibility_inside_m: f64,
    /// Share of the ground under it, [0, 1].
    pub coverage: f64,
}

/// A layer of cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloudValues {
    /// Kind.
    pub kind: CloudKind,
    /// Share of the sky, [0, 1].
    pub cover: f64,
    /// Base above the station, m.
    pub base_m: f64,
    /// Thickness, m.
    pub thickness_m: f64,
    /// Water or ice, g/m^3.
    pub water_g_m3: f64,
    /// Effective radius of droplets or crystals, um.
    pub droplet_radius_um: f64,
    /// Wind that carries it: speed, m/s, and the direction from which it blows, degrees.
    pub wind: WindValues,
}

/// Wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindValues {
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Direction from which it blows, degrees.
    pub from_deg: f64,
    /// Whether there are gusts.
    pub is_gusty: bool,
}

/// Kind of precipitation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PrecipitationKind {
    /// Rain.
    Rain,
    /// Snow.
    Snow,
    /// Rain and snow together.
    Sleet,
    /// Hail.
    Hail,
}

/// Precipitation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrecipitationValues {
    /// Kind.
    pub kind: PrecipitationKind,
    /// Rate, mm/h of water.
    pub rate_mm_h: f64,
    /// Share of it that is liquid, [0, 1].
    pub liquid_fraction: f64,
    /// Whether it falls from convective cloud.
    pub showers: bool,
    /// Whether hail falls with it.
    pub hail: bool,
    /// Extinction, 1/m; `None` if it follows from the rate.
    pub extinction_per_m: Option<f64>,
}

/// Sand or dust in the wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoftedValues {
    /// Whether it is sand, else dust.
    pub is_sand: bool,
    /// Top above the station, m.
    pub top_m: f64,
}

/// The sea.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeaValues {
    /// Temperature of the water, degrees Celsius.
    pub temperature_c: Option<f64>,
    /// Significant height of all waves but the longest, m.
    pub significant_wave_height_m: Option<f64>,
    /// The longest wave: significant height, m, period, s, and the direction from which it comes, degrees.
    pub swell: Option<[f64; 3]>,
}

/// The ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceValues {
    /// State.
    pub state: SurfaceState,
    /// Depth of snow, m.
    pub snow_depth_m: f64,
    /// Share of area, [0, 1].
    pub coverage: f64,
}

/// Weather of the world or of a region. `None`: a region leaves what holds without it, the world has Welkin's default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WeatherValues {
    /// Temperature, degrees Celsius.
    pub temperature_c: Option<f64>,
    /// Relative humidity, [0, 1].
    pub relative_humidity: Option<f64>,
    /// Pressure at mean sea level, hPa, [800, 1100].
    pub pressure_hpa: Option<f64>,
    /// Visibility at the station, m: all together.
    pub visibility_m: Option<f64>,
    /// Visibility above the fog, m.
    pub visibility_above_fog_m: Option<f64>,
    /// Wind at the station.
    pub wind: Option<WindValues>,
    /// Fog.
    pub fog: Option<FogValues>,
    /// Clouds.
    pub clouds: Vec<CloudValues>,
    /// Precipitation.
    pub precipitation: Option<PrecipitationValues>,
    /// Sand or dust.
    pub lofted: Option<LoftedValues>,
    /// Flashes a minute.
    pub flashes_per_minute: f64,
    /// Sea.
    pub sea: SeaValues,
    /// Ground.
    pub surface: Option<SurfaceValues>,
}

/// A region with its weather.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionValues {
    /// Number of the region.
    pub id: u16,
    /// Shape.
    pub shape: Shape,
    /// Quantities that are merged with regions before it.
    pub merge: MergeFlags,
    /// Weather.
    pub weather: WeatherValues,
}

/// A command to a wiper or a lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command {
    /// Meaning of the commanded component.
    pub means: ComponentMeaning,
    /// Class of the object that it belongs to.
    pub class: u8,
    /// Object, by class.
    pub instance: u16,
    /// Component.
    pub component: u16,
    /// State.
    pub state: u8,
    /// First word of its data, as a float.
    pub value: f32,
}

/// Values that Welkin takes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mapped {
    /// Time as the host last set it, s since 1970-01-01 UTC; and how often it has.
    pub utc_s: Option<(f64, u64)>,
    /// Whether the time runs on by itself.
    pub is_running: bool,
    /// Whether sun, moon and stars shine.
    pub has_sun_moon_stars: [bool; 3],
    /// Intensity of the stars, [0, 1].
    pub star_intensity: f64,
    /// Weather of the world.
    pub global: WeatherValues,
    /// Active regions, in the order of their last packets: the last wins unless it is merged.
    pub regions: Vec<RegionValues>,
    /// Wipers and lamps.
    pub commands: Vec<Command>,
    /// Words of the host that no value here carries, each with its reason.
    pub left_out: BTreeSet<Note>,
}

/// Returns seconds since 1970-01-01 UTC (Hinnant 2013, days from civil).
fn utc_s(clock: Clock, hours_ahead: f64) -> f64 {
    let (month, day) = (i64::from(clock.month), i64::from(clock.day));
    let year = i64::from(clock.year) - i64::from(month <= 2);
    let era = year.div_euclid(400);
    let year_of_era = year.rem_euclid(400);
    let day_of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    let days = era * 146_097 + year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year - 719_468;
    let minutes = f64::from(clock.hour) * 60.0 + f64::from(clock.minute);
    days as f64 * 86_400.0 + (minutes - hours_ahead * 60.0) * 60.0 + clock.second
}

/// Returns what Welkin takes.
pub fn map(state: &State, site: &Site) -> Mapped {
    let sky = state.sky;
    let mut out = Mapped {
        utc_s: sky.clock.map(|clock| (utc_s(clock, site.hours_ahead_of_utc), sky.clock_revision)),
        is_running: sky.is_running,
        has_sun_moon_stars: [sky.has_sun, sky.has_moon, sky.has_stars],
        star_intensity: sky.star_intensity_percent / 100.0,
        ..Mapped::default()
    };
    out.global = Mapping { state, site, left_out: &mut out.left_out }.weather(&state.global, true);
    out.fill_in_atmosphere(state);
    out.map_regions(state, site);
    for (key, component) in &state.components {
        let is_row = |row: &&crate::site::ComponentRow| row.class == key.class && row.component == key.component;
        match site.components.iter().find(is_row) {
            Some(row) => out.commands.push(Command {
                means: row.means,
                class: key.class,
                instance: key.instance,
                component: key.component,
                state: component.state,
                value: f32::from_bits(component.data[0]),
            }),
            None => out.leave_out("Component Control", "component_id", "the site's table has no row for it"),
        }
    }
    if state.entities.values().any(|entity| entity.scope != Scope::default()) {
        out.leave_out("Weather Control", "scope", "the environment of an entity has no extent");
    }
    out
}

impl Mapped {
    fn leave_out(&mut self, subject: &'static str, field: &'static str, reason: &'static str) {
        self.left_out.insert(Note { subject, field, reason });
    }

    /// Fills in what no layer of the world says.
    fn fill_in_atmosphere(&mut self, state: &State) {
        const NAME: &str = "Atmosphere Control";
        let air = state.atmosphere;
        let global = &mut self.global;
        global.temperature_c.get_or_insert(air.temperature_c.clamp(-90.0, 60.0));
        global.relative_humidity.get_or_insert(air.humidity_percent / 100.0);
        global.visibility_m.get_or_insert(air.visibility_m.max(1.0));
        let gusts = state.global.layers.values().any(|layer| layer.is_enabled && layer.has_gusts);
        let (speed_m_s, from_deg) = (air.wind_mps.min(120.0), air.wind_from_deg);
        global.wind.get_or_insert(WindValues { speed_m_s, from_deg, is_gusty: gusts });
        global.pressure_hpa = Some(air.pressure_hpa.clamp(800.0, 1100.0));
        if !(800.0..=1100.0).contains(&air.pressure_hpa) {
            self.leave_out(NAME, "pressure_hpa", "Welkin takes 800 to 1100 hPa: the nearest end");
        }
        if air.vertical_wind_mps != 0.0 {
            self.leave_out(NAME, "vertical_wind_mps", "Welkin has no vertical wind but in a grid");
        }
    }

    fn map_regions(&mut self, state: &State, site: &Site) {
        let mut shown: Vec<_> = state.regions.iter().filter(|(_, region)| region.is_active).collect();
        shown.sort_by_key(|(_, region)| region.scope.last_arrival());
        let surplus = shown.len().saturating_sub(MAX_WELKIN_REGIONS);
        if surplus > 0 {
            self.leave_out("Environmental Region Control", "region_id", "Welkin takes 64 regions: the last ones");
        }
        for (id, region) in shown.into_iter().skip(surplus) {
            let Some(shape) = region.shape else { continue };
            let weather = Mapping { state, site, left_out: &mut self.left_out }.weather(&region.scope, false);
            self.regions.push(RegionValues { id: *id, shape, merge: region.merge, weather });
        }
    }
}

impl Scope {
    /// Returns when the last packet for the scope came.
    fn last_arrival(&self) -> u64 {
        let layers = self.layers.values().map(|layer| layer.arrival);
        layers.chain(self.sea.map(|sea| sea.arrival)).chain([self.ground.arrival]).max().unwrap_or(0)
    }
}

/// The mapping of one scope.
struct Mapping<'a> {
    state: &'a State,
    site: &'a Site,
    left_out: &'a mut BTreeSet<Note>,
}

/// Precipitation of one scope by kind, mm/h: rain, snow, sleet, hail.
#[derive(Default)]
struct Rates([f64; 4]);

impl Mapping<'_> {
    fn leave_out(&mut self, subject: &'static str, field: &'static str, reason: &'static str) {
        self.left_out.insert(Note { subject, field, reason });
    }

    fn weather(&mut self, scope: &Scope, is_global: bool) -> WeatherValues {
        let station_m = self.site.station_altitude_m;
        let mut out =
            WeatherValues { sea: self.sea(scope, is_global), surface: self.surface(scope), ..WeatherValues::default() };
        let mut rates = Rates::default();
        let (mut extinction_per_m, mut is_convective) = (0.0, false);
        let enabled: Vec<(u8, Layer)> =
            scope.layers.iter().filter(|(_, layer)| layer.is_enabled).map(|(id, layer)| (*id, *layer)).collect();
        if let Some(air) = self.state.air_in(scope, station_m) {
            out.temperature_c = Some(air.temperature_c.clamp(-90.0, 60.0));
            out.relative_humidity = Some(air.humidity_percent / 100.0);
            out.visibility_m = Some(air.visibility_m.clamp(1.0, 1e6));
            let is_gusty = enabled.iter().any(|(_, layer)| layer.has_gusts);
            let (speed_m_s, from_deg) = (air.wind_mps.min(120.0), air.wind_from_deg);
            out.wind = Some(WindValues { speed_m_s, from_deg, is_gusty });
        }
        for (id, layer) in &enabled {
            let kind = match self.site.layer(*id) {
                LayerMeaning::GroundFog => {
                    self.fog(layer, &mut out);
                    None
                }
                LayerMeaning::Cloud => {
                    is_convective |= self.cloud(layer, &mut out);
                    None
                }
                LayerMeaning::Rain => Some(0),
                LayerMeaning::Snow => Some(1),
                LayerMeaning::Sleet => Some(2),
                LayerMeaning::Hail => Some(3),
                means @ (LayerMeaning::Sand | LayerMeaning::Dust) => {
                    let top_m = (layer.base_m + layer.thickness_m - station_m).clamp(0.1, 5000.0);
                    out.lofted = Some(LoftedValues { is_sand: means == LayerMeaning::Sand, top_m });
                    None
                }
                LayerMeaning::Haze => None,
                LayerMeaning::Nothing => {
                    self.leave_out("Weather Control", "layer_id", "the site's table has no row for the layer");
                    None
                }
            };
            if let Some(kind) = kind {
                rates.0[kind] += self.rate(kind, layer);
                let beyond = 1.0 / layer.air.visibility_m.max(1.0) - 1.0 / self.state.atmosphere.visibility_m.max(1.0);
                extinction_per_m += LN_20 * beyond.max(0.0);
            }
            if layer.has_lightning {
                out.flashes_per_minute += self.site.severities.flashes_per_minute[usize::from(layer.severity.min(5))];
            }
            self.leave_out_of_layer(layer);
        }
        out.flashes_per_minute = out.flashes_per_minute.min(60.0);
        out.precipitation = rates.precipitation(extinction_per_m, is_convective);
        out
    }

    fn leave_out_of_layer(&mut self, layer: &Layer) {
        const NAME: &str = "Weather Control";
        if layer.scud_percent != [0.0; 2] {
            self.leave_out(NAME, "scud_frequency_percent", "Welkin has no scud");
        }
        if layer.transition_m != [0.0; 2] {
            self.leave_out(
                NAME,
                "transition_band_m",
                "Welkin's layers have transitions by their kind; answers have the host's",
            );
        }
        if layer.air.vertical_wind_mps != 0.0 {
            self.leave_out(NAME, "vertical_wind_mps", "Welkin has no vertical wind but in a grid");
        }
        if layer.aerosol_g_m3 != 0.0 {
            self.leave_out(NAME, "aerosol_g_m3", "concentrations are answered; visibility decides the picture");
        }
    }

    fn fog(&mut self, layer: &Layer, out: &mut WeatherValues) {
        let base_m = layer.base_m - self.site.station_altitude_m;
        if base_m > 1.0 {
            let cloud = Layer { cloud_type: 10, ..*layer };
            self.cloud(&cloud, out);
            self.leave_out("Weather Control", "base_elevation_m", "fog above the ground becomes stratus");
            return;
        }
        out.fog = Some(FogValues {
            top_m: (base_m + layer.thickness_m).clamp(0.1, 2000.0),
            visibility_inside_m: layer.air.visibility_m.clamp(1.0, 10_000.0),
            coverage: layer.coverage_percent / 100.0,
        });
        out.visibility_above_fog_m = Some(self.state.atmosphere.visibility_m.clamp(100.0, 1e6));
    }

    /// Adds a layer of cloud, and returns whether it is convective.
    fn cloud(&mut self, layer: &Layer, out: &mut WeatherValues) -> bool {
        const NAME: &str = "Weather Control";
        let Some(kind) = self.site.cloud(layer.cloud_type) else {
            if layer.cloud_type != 0 {
                self.leave_out(NAME, "cloud_type", "the site's table has no row for the cloud type");
            }
            return false;
        };
        if out.clouds.len() == MAX_CLOUDS {
            self.leave_out(NAME, "layer_id", "Welkin takes 16 layers of cloud");
            return false;
        }
        let droplet_radius_um = RADIUS_UM[usize::from(kind.is_ice())];
        // Extinction is 3/2 of water over density and radius (Stephens 1978, equation 10), so water is 2/3 of
        // extinction times radius, in g/m^3 for 1/m and um.
        let water = LN_20 / layer.air.visibility_m.max(1.0) * droplet_radius_um * 2.0 / 3.0;
        out.clouds.push(CloudValues {
            kind,
            cover: layer.coverage_percent / 100.0,
            base_m: (layer.base_m - self.site.station_altitude_m).clamp(0.0, 20_000.0),
            thickness_m: layer.thickness_m.clamp(1.0, 20_000.0),
            water_g_m3: water.min(10.0),
            droplet_radius_um,
            wind: WindValues {
                speed_m_s: layer.air.wind_mps.min(150.0),
                from_deg: layer.air.wind_from_deg,
                is_gusty: layer.has_gusts,
            },
        });
        matches!(kind, CloudKind::Cumulus | CloudKind::ToweringCumulus | CloudKind::Cumulonimbus)
    }

    fn rate(&self, kind: usize, layer: &Layer) -> f64 {
        let severities = &self.site.severities;
        let table = [severities.rain_mm_h, severities.snow_mm_h, severities.snow_mm_h, severities.hail_mm_h][kind];
        table[usize::from(layer.severity.min(5))] * layer.coverage_percent / 100.0
    }

    fn sea(&mut self, scope: &Scope, is_global: bool) -> SeaValues {
        const NAME: &str = "Maritime Surface Conditions Control";
        let mut out = SeaValues::default();
        if let Some(sea) = scope.sea.filter(|sea| is_global || sea.is_enabled) {
            out.temperature_c = Some(sea.temperature_c.clamp(-3.0, 45.0));
            if sea.surface_height_m != 0.0 {
                self.leave_out(NAME, "sea_surface_height_m", "Welkin's sea lies at 0 m; answers have the host's");
            }
            if sea.has_whitecaps {
                self.leave_out(NAME, "whitecap_enable", "Welkin draws no sea yet");
            }
        }
        let mut waves: Vec<_> = scope.waves.values().filter(|wave| wave.is_enabled && wave.height_m > 0.0).collect();
        waves.sort_by(|a, b| b.length_m.total_cmp(&a.length_m));
        let Some((longest, others)) = waves.split_first() else { return out };
        // A sine of height H has the variance H^2 / 8, and a significant height is four standard deviations.
        let significant = |square: f64| (2.0 * square).sqrt();
        let from_deg = (longest.direction_to_deg + 180.0) % 360.0;
        let height_m = significant(longest.height_m * longest.height_m).min(20.0);
        out.swell = Some([height_m, longest.period_s.clamp(1.0, 30.0), from_deg]);
        let squares: f64 = others.iter().map(|wave| wave.height_m * wave.height_m).sum();
        out.significant_wave_height_m = Some(significant(squares).min(30.0));
        self.leave_out(
            "Wave Control",
            "breaker_type",
            "Welkin's sea has no single waves: heights and the longest wave count",
        );
        out
    }

    /// Returns the condition with the largest severity and share of those that the site's table names.
    fn surface(&mut self, scope: &Scope) -> Option<SurfaceValues> {
        const NAME: &str = "Terrestrial Surface Conditions Control";
        if scope.ground.is_dry {
            return Some(SurfaceValues { state: SurfaceState::Dry, snow_depth_m: 0.0, coverage: 1.0 });
        }
        let mut found: Option<(f64, SurfaceValues)> = None;
        for (id, condition) in &scope.ground.conditions {
            let Some(row) = self.site.surfaces.iter().find(|row| row.id == *id) else {
                self.leave_out(NAME, "surface_condition_id", "the site's table has no row for the condition");
                continue;
            };
            let (severity, coverage) =
                (f64::from(condition.severity) / 31.0, f64::from(condition.coverage_percent) / 100.0);
            let values = SurfaceValues { state: row.state, snow_depth_m: row.snow_depth_m * severity, coverage };
            if found.is_some() {
                self.leave_out(NAME, "surface_condition_id", "Welkin's ground has one state: the most severe counts");
            }
            let weight = severity * coverage;
            if found.is_none_or(|(most, _)| weight > most) {
                found = Some((weight, values));
            }
        }
        found.map(|(_, values)| values)
    }
}

impl Rates {
    /// Returns the precipitation of all kinds together: rain with snow is sleet, hail falls with rain.
    fn precipitation(&self, extinction_per_m: f64, showers: bool) -> Option<PrecipitationValues> {
        let Self([rain, snow, sleet, hail]) = *self;
        let rate_mm_h: f64 = self.0.iter().sum();
        if rate_mm_h <= 0.0 {
            return None;
        }
        let liquid = rain + sleet / 2.0;
        let kind = if hail > 0.0 && rain + snow + sleet <= 0.0 {
            PrecipitationKind::Hail
        } else if sleet > 0.0 || rain > 0.0 && snow > 0.0 {
            PrecipitationKind::Sleet
        } else if snow > 0.0 {
            PrecipitationKind::Snow
        } else {
            PrecipitationKind::Rain
        };
        // Hail beside rain is a flag in Welkin, and the rate is that of the rain.
        let is_beside = hail > 0.0 && kind != PrecipitationKind::Hail;
        let rate_mm_h = if is_beside { rate_mm_h - hail } else { rate_mm_h }.min(500.0);
        let liquid_fraction = if kind == PrecipitationKind::Hail { 0.0 } else { liquid / (rain + snow + sleet) };
        let extinction_per_m = (extinction_per_m > 0.0).then_some(extinction_per_m.min(10.0));
        Some(PrecipitationValues { kind, rate_mm_h, liquid_fraction, showers, hail: is_beside, extinction_per_m })
    }
}
