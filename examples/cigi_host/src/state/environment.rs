//! The environment: date and time, air, layers, regions, sea and ground.

use std::collections::BTreeMap;

use super::{MAX_ITEMS, MAX_REGIONS, State, entry};
use crate::geodesy::Place;
use crate::notes::{Checked, Notes};
use crate::wire::{
    AtmosphereControl, CelestialSphereControl, EnvironmentalRegionControl, MaritimeSurfaceConditionsControl,
    TerrestrialSurfaceConditionsControl, WaveControl, WeatherControl,
};

const PERCENT: [f64; 2] = [0.0, 100.0];
const TEMPERATURE_C: [f64; 2] = [-273.15, 100.0];
const VISIBILITY_M: [f64; 2] = [0.0, 1e6];
const SPEED_MPS: [f64; 2] = [0.0, 200.0];
const VERTICAL_MPS: [f64; 2] = [-200.0, 200.0];
const PRESSURE_HPA: [f64; 2] = [0.0, 2000.0];
const ELEVATION_M: [f64; 2] = [-1e4, 1e5];
const HEIGHT_M: [f64; 2] = [0.0, 1e5];
const LENGTH_M: [f64; 2] = [0.0, 1e7];

/// Date and time as the host last set them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// Year.
    pub year: i32,
    /// Month, 1 to 12.
    pub month: u8,
    /// Day, 1 to 31.
    pub day: u8,
    /// Hour, 0 to 23.
    pub hour: u8,
    /// Minute, 0 to 59.
    pub minute: u8,
    /// Second, below 60.
    pub second: f64,
}

/// The celestial sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// Date and time; `None` until the host sets them.
    pub clock: Option<Clock>,
    /// How often the host has set date and time.
    pub clock_revision: u64,
    /// Whether the time of day runs on by itself.
    pub is_running: bool,
    /// Whether the sun shines.
    pub has_sun: bool,
    /// Whether the moon shines.
    pub has_moon: bool,
    /// Whether there are stars.
    pub has_stars: bool,
    /// Intensity of the stars, percent.
    pub star_intensity_percent: f64,
}

impl Default for Sky {
    fn default() -> Self {
        Self {
            clock: None,
            clock_revision: 0,
            is_running: false,
            has_sun: true,
            has_moon: true,
            has_stars: true,
            star_intensity_percent: 100.0,
        }
    }
}

/// Splits a date. Month, day, year is the order of CIGI; a number from 13 000 000 on is read as year, month, day, as
/// Wireshark labels it in 4.0: there is no thirteenth month, so this is certain for years from 1300 on.
fn date(number: u32) -> Option<(i32, u8, u8)> {
    let [high, middle, low] = [number / 1_000_000, number / 10_000 % 100, number % 10_000];
    let (year, month, day) =
        if number < 13_000_000 { (low, high, middle) } else { (number / 10_000, low / 100, low % 100) };
    let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let days = match month {
        2 if is_leap => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    };
    ((1..=12).contains(&month) && (1..=days).contains(&day)).then_some((year as i32, month as u8, day as u8))
}

impl Sky {
    pub(super) fn apply(&mut self, packet: &CelestialSphereControl, notes: &mut Notes) {
        const NAME: &str = CelestialSphereControl::LAYOUT.name;
        self.is_running = packet.ephemeris_enable;
        self.has_sun = packet.sun_enable;
        self.has_moon = packet.moon_enable;
        self.has_stars = packet.star_enable;
        let mut checked = Checked { notes, packet: NAME };
        let (former, given) = (self.star_intensity_percent, packet.star_intensity_percent);
        self.star_intensity_percent = checked.number("star_intensity_percent", given, former, PERCENT);
        if !packet.date_time_valid {
            return;
        }
        let former = self.clock.map_or(0.0, |clock| clock.second);
        let second = checked.number("second", packet.second, former, [0.0, 59.999]);
        match date(packet.date_mmddyyyy) {
            Some((year, month, day)) if packet.hour < 24 && packet.minute < 60 => {
                let (hour, minute) = (packet.hour, packet.minute);
                self.clock = Some(Clock { year, month, day, hour, minute, second });
                self.clock_revision += 1;
            }
            _ => notes.add(NAME, "date_mmddyyyy", "no date or time, the former one stays"),
        }
    }
}

/// Properties of air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    /// Relative humidity, percent.
    pub humidity_percent: f64,
    /// Temperature, degrees Celsius.
    pub temperature_c: f64,
    /// Visibility, m.
    pub visibility_m: f64,
    /// Horizontal speed of the wind, m/s.
    pub wind_mps: f64,
    /// Vertical speed of the wind, upward, m/s.
    pub vertical_wind_mps: f64,
    /// Direction from which the wind blows, degrees from true north in [0, 360).
    pub wind_from_deg: f64,
    /// Pressure, hPa.
    pub pressure_hpa: f64,
}

impl Default for Air {
    /// Creates the air of the class library before the first packet: 0 degrees, 30 %, 40 statute miles.
    fn default() -> Self {
        Self {
            humidity_percent: 30.0,
            temperature_c: 0.0,
            visibility_m: 64_373.8,
            wind_mps: 0.0,
            vertical_wind_mps: 0.0,
            wind_from_deg: 0.0,
            pressure_hpa: 1013.25,
        }
    }
}

impl Air {
    pub(super) fn apply(&mut self, packet: &AtmosphereControl, notes: &mut Notes) {
        let mut checked = Checked { notes, packet: AtmosphereControl::LAYOUT.name };
        let former = *self;
        let number = &mut |field, value: f32, former, range| checked.number(field, value, former, range);
        *self = Self {
            humidity_percent: number("humidity_percent", packet.humidity_percent.into(), 0.0, PERCENT),
            temperature_c: number("air_temperature_c", packet.air_temperature_c, former.temperature_c, TEMPERATURE_C),
            visibility_m: number("visibility_m", packet.visibility_m, former.visibility_m, VISIBILITY_M),
            wind_mps: number("horizontal_wind_mps", packet.horizontal_wind_mps, former.wind_mps, SPEED_MPS),
            vertical_wind_mps: number(
                "vertical_wind_mps",
                packet.vertical_wind_mps,
                former.vertical_wind_mps,
                VERTICAL_MPS,
            ),
            pressure_hpa: number("pressure_hpa", packet.pressure_hpa, former.pressure_hpa, PRESSURE_HPA),
            wind_from_deg: checked.azimuth("wind_from_deg", packet.wind_from_deg, former.wind_from_deg),
        };
    }
}

/// A layer of weather.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Layer {
    /// Whether it is on.
    pub is_enabled: bool,
    /// Its air.
    pub air: Air,
    /// Cloud type by CIGI's number.
    pub cloud_type: u8,
    /// Severity, 0 to 5.
    pub severity: u8,
    /// Share of area, percent.
    pub coverage_percent: f64,
    /// Base above mean sea level, m.
    pub base_m: f64,
    /// Thickness, m.
    pub thickness_m: f64,
    /// Widths of the transition below and above, m.
    pub transition_m: [f64; 2],
    /// Amounts of scud below and above, percent; 0 where it is off.
    pub scud_percent: [f64; 2],
    /// Whether there are gusts.
    pub has_gusts: bool,
    /// Whether there is lightning.
    pub has_lightning: bool,
    /// Concentration of particles, g/m^3.
    pub aerosol_g_m3: f64,
    /// When the last packet for it came.
    pub arrival: u64,
}

impl Layer {
    fn apply(&mut self, packet: &WeatherControl, arrival: u64, notes: &mut Notes) {
        let mut checked = Checked { notes, packet: WeatherControl::LAYOUT.name };
        let former = *self;
        let number = &mut |field, value: f32, former, range| checked.number(field, value, former, range);
        let air = Air {
            humidity_percent: number("humidity_percent", packet.humidity_percent.into(), 0.0, PERCENT),
            temperature_c: number(
                "air_temperature_c",
                packet.air_temperature_c,
                former.air.temperature_c,
                TEMPERATURE_C,
            ),
            visibility_m: number("visibility_m", packet.visibility_m, former.air.visibility_m, VISIBILITY_M),
            wind_mps: number("horizontal_wind_mps", packet.horizontal_wind_mps, former.air.wind_mps, SPEED_MPS),
            vertical_wind_mps: number(
                "vertical_wind_mps",
                packet.vertical_wind_mps,
                former.air.vertical_wind_mps,
                VERTICAL_MPS,
            ),
            wind_from_deg: former.air.wind_from_deg,
            pressure_hpa: number("pressure_hpa", packet.pressure_hpa, former.air.pressure_hpa, PRESSURE_HPA),
        };
        // 3.x has one band and one amount of scud for both sides, 4.0 one each: the other version's fields are 0.
        let [[below_m, above_m], [below, above]] = [former.transition_m, former.scud_percent];
        let band = number("transition_band_m", packet.transition_band_m, below_m, HEIGHT_M);
        let below_m = number("bottom_transition_m", packet.bottom_transition_m, below_m, HEIGHT_M).max(band);
        let above_m = number("top_transition_m", packet.top_transition_m, above_m, HEIGHT_M).max(band);
        let both = number("scud_frequency_percent", packet.scud_frequency_percent, below, PERCENT);
        let (bottom, top) = (packet.bottom_scud_frequency_percent, packet.top_scud_frequency_percent);
        let below = number("bottom_scud_frequency_percent", bottom, below, PERCENT);
        let above = number("top_scud_frequency_percent", top, above, PERCENT);
        let amount = |is_on: bool, own: f64| if packet.scud_enable { both } else { own * f64::from(u8::from(is_on)) };
        *self = Self {
            is_enabled: packet.weather_enable,
            cloud_type: packet.cloud_type,
            severity: number("severity", packet.severity.into(), 0.0, [0.0, 5.0]) as u8,
            coverage_percent: number("coverage_percent", packet.coverage_percent, former.coverage_percent, PERCENT),
            base_m: number("base_elevation_m", packet.base_elevation_m, former.base_m, ELEVATION_M),
            thickness_m: number("thickness_m", packet.thickness_m, former.thickness_m, HEIGHT_M),
            transition_m: [below_m, above_m],
            scud_percent: [amount(packet.bottom_scud_enable, below), amount(packet.top_scud_enable, above)],
            has_gusts: packet.random_winds_enable,
            has_lightning: packet.random_lightning_enable,
            aerosol_g_m3: number("aerosol_g_m3", packet.aerosol_g_m3, former.aerosol_g_m3, [0.0, 1e6]),
            arrival,
            air: Air {
                wind_from_deg: checked.azimuth("wind_from_deg", packet.wind_from_deg, former.air.wind_from_deg),
                ..air
            },
        };
    }
}

/// State of the sea.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sea {
    /// Whether the region or entity has a sea of its own.
    pub is_enabled: bool,
    /// Whether there are whitecaps.
    pub has_whitecaps: bool,
    /// Height at rest above mean sea level, m.
    pub surface_height_m: f64,
    /// Temperature, degrees Celsius.
    pub temperature_c: f64,
    /// Clarity, percent.
    pub clarity_percent: f64,
    /// When the last packet for it came.
    pub arrival: u64,
}

/// A train of waves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wave {
    /// Whether it is on.
    pub is_enabled: bool,
    /// 0 plunging, 1 spilling, 2 surging.
    pub breaker_type: u8,
    /// Height from trough to crest, m.
    pub height_m: f64,
    /// Length, m.
    pub length_m: f64,
    /// Period, s.
    pub period_s: f64,
    /// Direction in which it travels, degrees from true north in [0, 360).
    pub direction_to_deg: f64,
    /// Phase, degrees.
    pub phase_deg: f64,
    /// Lean of the crest, degrees.
    pub leading_deg: f64,
}

/// A condition of the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Condition {
    /// Severity, 0 to 31.
    pub severity: u8,
    /// Share of area, percent.
    pub coverage_percent: u8,
}

/// Conditions of the ground.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ground {
    /// Conditions by their number, without dry.
    pub conditions: BTreeMap<u16, Condition>,
    /// Whether the host has said that the ground is dry.
    pub is_dry: bool,
    /// When the last packet for it came.
    pub arrival: u64,
}

impl Ground {
    /// Whether the host has said anything that holds.
    pub fn is_stated(&self) -> bool {
        self.is_dry || !self.conditions.is_empty()
    }
}

/// The environment of the world, of a region or of an entity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scope {
    /// Layers by their number.
    pub layers: BTreeMap<u8, Layer>,
    /// Sea; `None` until the host sets it.
    pub sea: Option<Sea>,
    /// Waves by their number.
    pub waves: BTreeMap<u8, Wave>,
    /// Ground.
    pub ground: Ground,
}

/// Shape of a region: a rectangle with round corners, and a perimeter outside of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shape {
    /// Centre. The altitude is 0.
    pub centre: Place,
    /// Whole lengths along the rotation and across it, m.
    pub size_m: [f64; 2],
    /// Radius of the corners, m, at most half of the smaller size.
    pub corner_radius_m: f64,
    /// Rotation clockwise from true north, degrees.
    pub rotation_deg: f64,
    /// Width of the perimeter, m.
    pub perimeter_m: f64,
}

/// Quantities of overlapping regions that are merged; else the last one wins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MergeFlags {
    /// Weather.
    pub weather: bool,
    /// Aerosol.
    pub aerosol: bool,
    /// Sea.
    pub maritime: bool,
    /// Ground.
    pub terrestrial: bool,
}

/// A region.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Region {
    /// Shape; `None` until the host sets it.
    pub shape: Option<Shape>,
    /// Whether its environment shows.
    pub is_active: bool,
    /// Quantities that are merged.
    pub merge: MergeFlags,
    /// Its environment.
    pub scope: Scope,
}

impl State {
    pub(super) fn control_region(&mut self, packet: &EnvironmentalRegionControl, notes: &mut Notes) {
        const NAME: &str = EnvironmentalRegionControl::LAYOUT.name;
        if packet.region_state == 2 {
            self.regions.remove(&packet.region_id);
            return;
        }
        let Some(region) = entry(&mut self.regions, packet.region_id, MAX_REGIONS, NAME, notes) else { return };
        let former = region.shape.unwrap_or_default();
        let mut checked = Checked { notes, packet: NAME };
        let mut number = |field, value: f64, former, range| checked.number(field, value, former, range);
        let latitude = number("latitude_deg", packet.latitude_deg, former.centre.latitude_deg, [-90.0, 90.0]);
        let longitude = number("longitude_deg", packet.longitude_deg, former.centre.longitude_deg, [-360.0, 360.0]);
        let size_m = [
            number("size_x_m", packet.size_x_m.into(), former.size_m[0], LENGTH_M),
            number("size_y_m", packet.size_y_m.into(), former.size_m[1], LENGTH_M),
        ];
        let widest = size_m[0].min(size_m[1]) / 2.0;
        let (radius, perimeter) = (packet.corner_radius_m.into(), packet.transition_perimeter_m.into());
        region.shape = Some(Shape {
            centre: Place { latitude_deg: latitude, longitude_deg: longitude, altitude_m: 0.0 },
            size_m,
            corner_radius_m: number("corner_radius_m", radius, former.corner_radius_m.min(widest), [0.0, widest]),
            perimeter_m: number("transition_perimeter_m", perimeter, former.perimeter_m, LENGTH_M),
            rotation_deg: checked.azimuth("rotation_deg", packet.rotation_deg, former.rotation_deg),
        });
        region.is_active = packet.region_state == 1;
        region.merge = MergeFlags {
            weather: packet.merge_weather != 0,
            aerosol: packet.merge_aerosol != 0,
            maritime: packet.merge_maritime != 0,
            terrestrial: packet.merge_terrestrial != 0,
        };
    }

    /// Returns the environment that a packet is for: 0 global, 1 of a region, 2 of an entity.
    fn scope(&mut self, scope: u8, id: u16, packet: &'static str, notes: &mut Notes) -> Option<&mut Scope> {
        match scope {
            0 => Some(&mut self.global),
            1 => entry(&mut self.regions, id, MAX_REGIONS, packet, notes).map(|region| &mut region.scope),
            2 => match self.entities.get_mut(&id) {
                Some(entity) => Some(&mut entity.scope),
                None => {
                    notes.add(packet, "entity_or_region_id", "ignored, there is no such entity");
                    None
                }
            },
            _ => {
                notes.add(packet, "scope", "ignored, there is no scope 3");
                None
            }
        }
    }

    pub(super) fn control_layer(&mut self, packet: &WeatherControl, notes: &mut Notes) {
        const NAME: &str = WeatherControl::LAYOUT.name;
        let arrival = self.arrivals;
        // The weather of an entity has no layers.
        let layer_id = if packet.scope == 2 { 0 } else { packet.layer_id };
        let Some(scope) = self.scope(packet.scope, packet.entity_or_region_id, NAME, notes) else { return };
        if let Some(layer) = entry(&mut scope.layers, layer_id, MAX_ITEMS, NAME, notes) {
            layer.apply(packet, arrival, notes);
        }
    }

    pub(super) fn control_sea(&mut self, packet: &MaritimeSurfaceConditionsControl, notes: &mut Notes) {
        const NAME: &str = MaritimeSurfaceConditionsControl::LAYOUT.name;
        let arrival = self.arrivals;
        let Some(scope) = self.scope(packet.scope, packet.entity_or_region_id, NAME, notes) else { return };
        let former = scope.sea.unwrap_or_default();
        let mut checked = Checked { notes, packet: NAME };
        let mut number = |field, value: f32, former, range| checked.number(field, value, former, range);
        let (height, temperature) = (packet.sea_surface_height_m, packet.water_temperature_c);
        scope.sea = Some(Sea {
            is_enabled: packet.surface_conditions_enable,
            has_whitecaps: packet.whitecap_enable,
            surface_height_m: number("sea_surface_height_m", height, former.surface_height_m, ELEVATION_M),
            temperature_c: number("water_temperature_c", temperature, former.temperature_c, TEMPERATURE_C),
            clarity_percent: number("clarity_percent", packet.clarity_percent, former.clarity_percent, PERCENT),
            arrival,
        });
    }

    pub(super) fn control_wave(&mut self, packet: &WaveControl, notes: &mut Notes) {
        const NAME: &str = WaveControl::LAYOUT.name;
        let Some(scope) = self.scope(packet.scope, packet.entity_or_region_id, NAME, notes) else { return };
        let Some(wave) = entry(&mut scope.waves, packet.wave_id, MAX_ITEMS, NAME, notes) else { return };
        let mut checked = Checked { notes, packet: NAME };
        let mut number = |field, value: f32, former, range| checked.number(field, value, former, range);
        *wave = Wave {
            is_enabled: packet.wave_enable,
            breaker_type: number("breaker_type", packet.breaker_type.into(), 0.0, [0.0, 2.0]) as u8,
            height_m: number("wave_height_m", packet.wave_height_m, wave.height_m, [0.0, 100.0]),
            length_m: number("wavelength_m", packet.wavelength_m, wave.length_m, HEIGHT_M),
            period_s: number("period_s", packet.period_s, wave.period_s, [0.0, 1e4]),
            phase_deg: number("phase_offset_deg", packet.phase_offset_deg, wave.phase_deg, [-360.0, 360.0]),
            leading_deg: number("leading_deg", packet.leading_deg, wave.leading_deg, [-180.0, 180.0]),
            direction_to_deg: checked.azimuth("direction_to_deg", packet.direction_to_deg, wave.direction_to_deg),
        };
    }

    pub(super) fn control_ground(&mut self, packet: &TerrestrialSurfaceConditionsControl, notes: &mut Notes) {
        const NAME: &str = TerrestrialSurfaceConditionsControl::LAYOUT.name;
        let arrival = self.arrivals;
        let Some(scope) = self.scope(packet.scope, packet.entity_or_region_id, NAME, notes) else { return };
        let ground = &mut scope.ground;
        ground.arrival = arrival;
        match (packet.surface_condition_id, packet.surface_condition_enable) {
            (0, is_dry) => {
                ground.is_dry = is_dry;
                ground.conditions.clear();
            }
            (id, false) => {
                ground.conditions.remove(&id);
            }
            (id, true) => {
                if let Some(condition) = entry(&mut ground.conditions, id, MAX_ITEMS, NAME, notes) {
                    let mut checked = Checked { notes, packet: NAME };
                    let coverage = checked.number("coverage_percent", packet.coverage_percent, 0.0, PERCENT);
                    *condition = Condition { severity: packet.severity, coverage_percent: coverage as u8 };
                    ground.is_dry = false;
                }
            }
        }
    }
}
