//! Parts of the weather, each of which can differ from place to place independently, and their blending.

use std::ops::BitOr;

use serde::{Deserialize, Serialize};

use super::blend::clear_between_ends;
use super::conditions::{Conditions, clear_between};
use super::mix::mix;

/// Set of parts of the weather. Default none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct WeatherParts(pub u32);

impl WeatherParts {
    /// No part.
    pub const NONE: Self = Self(0);
    /// Haze: the particles of the mixed layer.
    pub const HAZE: Self = Self(0x1);
    /// Low layer of fog, mist, dust, sand or lifted snow, with its base and top.
    pub const FOG: Self = Self(0x2);
    /// Haze and low layer together: all that limits the visibility except precipitation.
    pub const VISIBILITY: Self = Self(0x3);
    /// Precipitation of all kinds, with its extinction.
    pub const PRECIPITATION: Self = Self(0x4);
    /// Thunder.
    pub const LIGHTNING: Self = Self(0x8);
    /// Temperature.
    pub const TEMPERATURE: Self = Self(0x10);
    /// Humidity.
    pub const HUMIDITY: Self = Self(0x20);
    /// Pressure.
    pub const PRESSURE: Self = Self(0x40);
    /// Wind and its gusts.
    pub const WIND: Self = Self(0x80);
    /// Cloud layers, and the host's own cloud light.
    pub const CLOUDS: Self = Self(0x100);
    /// Water, ice and snow on the ground.
    pub const SURFACE: Self = Self(0x200);
    /// Sea.
    pub const SEA: Self = Self(0x400);
    /// All parts.
    pub const ALL: Self = Self(0x7ff);

    /// Whether the set contains all of `parts`.
    pub fn has(self, parts: Self) -> bool {
        self.0 & parts.0 == parts.0
    }

    /// Iterates over the single parts of the set.
    pub(crate) fn singles(self) -> impl Iterator<Item = Self> {
        (0..32).map(|bit| Self(1 << bit)).filter(move |part| self.has(*part))
    }
}

impl BitOr for WeatherParts {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl Conditions {
    /// Returns the extinction that the low layer adds to the total, 1/m. A layer that the reported visibility leaves
    /// out, such as shallow fog, adds none.
    fn counted_fog_per_m(&self) -> f64 {
        let others =
            self.air.rayleigh_extinction_per_m + self.aerosol.extinction_per_m + self.precipitation.extinction_per_m();
        (self.extinction_per_m - others).max(0.0)
    }

    /// Blends single parts of the weather towards those of `other`: a share of 0 leaves a part as it is, a share of 1
    /// replaces it. The extinctions of particles, low layer and precipitation blend linearly, and the total follows.
    /// The extinction of clear air stays.
    pub(crate) fn blend_parts(&mut self, other: &Self, shares: impl IntoIterator<Item = (WeatherParts, f64)>) {
        let mut fog_per_m = self.counted_fog_per_m();
        for (part, t) in shares {
            if part == WeatherParts::FOG {
                fog_per_m = mix(fog_per_m, other.counted_fog_per_m(), t);
            }
            self.blend_part(part, other, t);
        }
        let clear = self.air.rayleigh_extinction_per_m + self.aerosol.extinction_per_m;
        self.extinction_per_m = clear + fog_per_m + self.precipitation.extinction_per_m();
    }

    /// Blends one part, but does not update the total extinction.
    fn blend_part(&mut self, part: WeatherParts, other: &Self, t: f64) {
        match part {
            WeatherParts::HAZE => self.aerosol = whole_or(t, other.aerosol, || self.aerosol.blend(&other.aerosol, t)),
            WeatherParts::FOG => self.fog = whole_or(t, other.fog, || self.fog.blend(&other.fog, t)),
            WeatherParts::PRECIPITATION => {
                let (from, to) = (&self.precipitation, &other.precipitation);
                let thunder = from.thunder;
                self.precipitation = whole_or(t, *to, || from.blend(to, t, t));
                self.precipitation.thunder = thunder;
            }
            WeatherParts::LIGHTNING => {
                let thunder = &mut self.precipitation.thunder;
                *thunder = mix(*thunder, other.precipitation.thunder, t);
            }
            WeatherParts::TEMPERATURE => {
                self.air.temperature_c = mix(self.air.temperature_c, other.air.temperature_c, t);
            }
            WeatherParts::HUMIDITY => {
                self.air.relative_humidity = mix(self.air.relative_humidity, other.air.relative_humidity, t);
            }
            WeatherParts::PRESSURE => {
                let (from, to) = (&mut self.air, &other.air);
                from.pressure_hpa = mix(from.pressure_hpa, to.pressure_hpa, t);
                from.station_pressure_hpa = mix(from.station_pressure_hpa, to.station_pressure_hpa, t);
            }
            WeatherParts::WIND => self.wind = whole_or(t, other.wind, || self.wind.blend(&other.wind, t)),
            WeatherParts::CLOUDS => self.blend_clouds(other, t),
            WeatherParts::SURFACE => {
                self.surface = whole_or(t, other.surface, || self.surface.blend(&other.surface, t))
            }
            WeatherParts::SEA => self.sea = whole_or(t, other.sea, || self.sea.blend(&other.sea, t)),
            _ => {}
        }
    }

    /// Blends the cloud layers, slot by slot.
    fn blend_clouds(&mut self, other: &Self, t: f64) {
        if t >= 1.0 {
            (self.clouds, self.clear_sky, self.cloud_light) = (other.clouds, other.clear_sky, other.cloud_light);
            return;
        }
        let clouds = std::array::from_fn(|i| self.clouds[i].blend(&other.clouds[i], t));
        self.clear_sky = clear_between_ends([self, other], clear_between(&clouds), t);
        self.cloud_light = self.cloud_light.blend(&other.cloud_light, t);
        self.clouds = clouds;
    }
}

/// Returns `other` for a share of 1, where a blend would be off by rounding, else the blend.
fn whole_or<T>(t: f64, other: T, blend: impl FnOnce() -> T) -> T {
    if t >= 1.0 { other } else { blend() }
}

#[cfg(test)]
mod tests {
    use super::super::{
        CloudKind, CloudLayer, Fog, FogKind, Precipitation, PrecipitationKind, Surface, Weather, Wind, derive,
    };
    use super::*;

    fn two() -> [Conditions; 2] {
        let day = Weather { wind: Wind::of(4.0, 270.0), ..Weather::default() };
        let storm = Weather {
            visibility_m: 400.0,
            temperature_c: -3.0,
            relative_humidity: 0.97,
            pressure_hpa: 985.0,
            fog: Fog::of(FogKind::Fog),
            clouds: vec![CloudLayer::of(CloudKind::Stratus, 1.0, 300.0)],
            precipitation: Precipitation { thunderstorm: true, ..Precipitation::of(PrecipitationKind::Snow, 2.0) },
            wind: Wind::of(15.0, 180.0),
            surface: Surface { snow_depth_m: 0.1, ..Surface::default() },
            ..Weather::default()
        };
        [day, storm].map(|w| derive(&w).unwrap())
    }

    #[test]
    fn all_parts_taken_in_full_are_the_other_weather_except_its_clear_air() {
        let [day, storm] = two();
        let mut c = day;
        c.blend_parts(&storm, WeatherParts::ALL.singles().map(|part| (part, 1.0)));
        let air = super::super::Air {
            rayleigh_density_ratio: day.air.rayleigh_density_ratio,
            rayleigh_scale_height_m: day.air.rayleigh_scale_height_m,
            rayleigh_extinction_per_m: day.air.rayleigh_extinction_per_m,
            ..storm.air
        };
        let less_air = day.air.rayleigh_extinction_per_m - storm.air.rayleigh_extinction_per_m;
        assert!((c.extinction_per_m - storm.extinction_per_m - less_air).abs() < 1e-15);
        assert_eq!(c, Conditions { air, extinction_per_m: c.extinction_per_m, ..storm });
    }

    #[test]
    fn each_part_changes_its_own_fields_alone_and_extinctions_add_up() {
        let [day, storm] = two();
        let mut changed = 0;
        for part in WeatherParts::ALL.singles() {
            let mut c = day;
            c.blend_parts(&storm, [(part, 0.25)]);
            assert_ne!(c, day, "{part:?} has a field");
            let parts =
                c.air.rayleigh_extinction_per_m + c.aerosol.extinction_per_m + c.precipitation.extinction_per_m();
            let fog_per_m = c.extinction_per_m - parts;
            let expected = if part == WeatherParts::FOG { 0.25 * storm.fog.extinction_per_m } else { 0.0 };
            assert!((fog_per_m - expected).abs() < 1e-15, "{part:?}: {fog_per_m} against {expected}");
            changed += 1;
        }
        assert_eq!(changed, 11);
        let mut c = day;
        c.blend_parts(&storm, [(WeatherParts::WIND, 0.5), (WeatherParts::TEMPERATURE, 0.5)]);
        assert!((c.wind.north_m_s - 7.5).abs() < 1e-12 && (c.wind.east_m_s - 2.0).abs() < 1e-12, "{:?}", c.wind);
        assert!((c.air.temperature_c - 6.0).abs() < 1e-12 && c.precipitation == day.precipitation);
    }
}
