//! Named weathers, to start from or to test with.

use super::kinds::{AerosolKind, CloudKind, FogKind, LoftedKind, PrecipitationKind, SurfaceState};
use super::model::{Aerosol, CloudLayer, Fog, Lofted, Precipitation, Sea, Surface, Swell, Weather, Wind};
use crate::error::{Error, Result, beginning, listed};

/// A preset: its name, one line for a menu, and the function that creates it.
struct Preset {
    name: &'static str,
    what: &'static str,
    make: fn() -> Weather,
}

const PRESETS: &[Preset] = &[
    Preset { name: "clear", what: "cloudless standard day, 40 km", make: Weather::default },
    Preset { name: "crystal", what: "polar air after a front, 150 km", make: crystal },
    Preset { name: "hazy", what: "polluted summer air, 6 km", make: hazy },
    Preset { name: "smoke", what: "smoke of burning forest, 3 km", make: smoke },
    Preset { name: "scattered", what: "fair-weather cumulus, 25 km", make: scattered },
    Preset { name: "broken", what: "stratocumulus with gaps, 20 km", make: broken },
    Preset { name: "overcast", what: "closed stratocumulus, 15 km", make: overcast },
    Preset { name: "high_cloud", what: "veil of cirrostratus, 30 km", make: high_cloud },
    Preset { name: "mist", what: "damp morning under stratus, 2 km", make: mist },
    Preset { name: "fog", what: "dense fog, 150 m", make: fog },
    Preset { name: "shallow_fog", what: "fog to the knees under a clear sky", make: shallow_fog },
    Preset { name: "fog_patches", what: "banks of fog between clear stretches", make: fog_patches },
    Preset { name: "freezing_fog", what: "fog of supercooled droplets, 300 m", make: freezing_fog },
    Preset { name: "drizzle", what: "drizzle from low stratus, 4 km", make: drizzle },
    Preset { name: "rain", what: "steady rain of 5 mm/h, 3 km", make: rain },
    Preset { name: "heavy_rain", what: "rain of 20 mm/h, 1200 m", make: heavy_rain },
    Preset { name: "showers", what: "rain showers of 3 mm/h from towering cumulus, 4500 m", make: showers },
    Preset { name: "thunderstorm", what: "thunderstorm, 40 mm/h with hail, gusts, 900 m", make: thunderstorm },
    Preset { name: "freezing_rain", what: "rain that freezes on the ground, 3 km", make: freezing_rain },
    Preset { name: "sleet", what: "rain and snow together, 850 m", make: sleet },
    Preset { name: "light_snow", what: "light snow, 3 km", make: light_snow },
    Preset { name: "snow", what: "snow of 1.5 mm/h, 600 m", make: snow },
    Preset { name: "blizzard", what: "heavy snow in a gale, 150 m", make: blizzard },
    Preset { name: "hail", what: "hail shower", make: hail },
    Preset { name: "dust_storm", what: "wall of dust, 400 m", make: dust_storm },
    Preset { name: "sand_storm", what: "blowing sand, 800 m", make: sand_storm },
    Preset { name: "gale", what: "gale over open land under torn cloud", make: gale },
    Preset { name: "storm_at_sea", what: "storm of force 10, waves of 9 m, spray, 3 km", make: storm_at_sea },
];

impl Weather {
    /// Returns the names of all presets, in the order of a menu, from clear to severe.
    pub fn preset_names() -> impl ExactSizeIterator<Item = &'static str> {
        PRESETS.iter().map(|p| p.name)
    }

    /// Returns the description of a preset, one line for a menu.
    ///
    /// # Errors
    /// As [`Weather::preset`].
    pub fn preset_description(name: &str) -> Result<&'static str> {
        find(name).map(|p| p.what)
    }

    /// Returns the weather of a preset. Names are lower case, as [`Weather::preset_names`] lists them.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a name that [`Weather::preset_names`] does not list.
    pub fn preset(name: &str) -> Result<Self> {
        find(name).map(|p| (p.make)())
    }
}

fn find(name: &str) -> Result<&'static Preset> {
    PRESETS.iter().find(|p| p.name == name).ok_or_else(|| {
        let names: Vec<&str> = Weather::preset_names().collect();
        Error::range("name", &format!("one of {}", listed(&names)), format!("{:?}", beginning(name, 40)))
    })
}

/// Returns the default weather with this visibility, temperature and humidity.
fn day(visibility_m: f64, temperature_c: f64, relative_humidity: f64) -> Weather {
    Weather { visibility_m, temperature_c, relative_humidity, ..Weather::default() }
}

fn crystal() -> Weather {
    Weather { aerosol: Aerosol::of(AerosolKind::Clean), wind: Wind::of(4.0, 320.0), ..day(150_000.0, 8.0, 0.4) }
}

fn hazy() -> Weather {
    Weather { aerosol: Aerosol::of(AerosolKind::Haze), wind: Wind::of(2.0, 160.0), ..day(6000.0, 28.0, 0.6) }
}

fn smoke() -> Weather {
    Weather { aerosol: Aerosol::of(AerosolKind::Smoke), wind: Wind::of(3.0, 240.0), ..day(3000.0, 27.0, 0.35) }
}

fn scattered() -> Weather {
    let clouds = vec![CloudLayer::of(CloudKind::Cumulus, 0.4, 1300.0)];
    Weather { clouds, wind: Wind::of(5.0, 250.0), ..day(25_000.0, 20.0, 0.5) }
}

fn broken() -> Weather {
    let clouds = vec![CloudLayer::of(CloudKind::Stratocumulus, 0.75, 1000.0)];
    Weather { clouds, wind: Wind::of(6.0, 260.0), ..day(20_000.0, 15.0, 0.65) }
}

fn overcast() -> Weather {
    let clouds = vec![CloudLayer::of(CloudKind::Stratocumulus, 1.0, 900.0)];
    Weather { clouds, wind: Wind::of(5.0, 230.0), ..day(15_000.0, 12.0, 0.75) }
}

fn high_cloud() -> Weather {
    let clouds = vec![CloudLayer::of(CloudKind::Cirrostratus, 0.9, 8000.0)];
    Weather { clouds, wind: Wind::of(3.0, 200.0), ..day(30_000.0, 16.0, 0.5) }
}

fn mist() -> Weather {
    let clouds = vec![CloudLayer::of(CloudKind::Stratus, 1.0, 250.0)];
    Weather { fog: Fog::of(FogKind::Mist), clouds, wind: Wind::of(1.5, 90.0), ..day(2000.0, 7.0, 0.97) }
}

fn fog() -> Weather {
    Weather { fog: Fog::of(FogKind::Fog), vertical_visibility_m: Some(30.0), ..day(150.0, 4.0, 1.0) }
}

fn shallow_fog() -> Weather {
    Weather { fog: Fog::of(FogKind::Shallow), wind: Wind::of(0.5, 0.0), ..day(12_000.0, 3.0, 1.0) }
}

fn fog_patches() -> Weather {
    Weather { fog: Fog::of(FogKind::Patches), wind: Wind::of(1.0, 30.0), ..day(9000.0, 5.0, 0.98) }
}

fn freezing_fog() -> Weather {
    let surface = Surface { state: Some(SurfaceState::Frost), ..Surface::default() };
    let fog = Fog::of(FogKind::Freezing);
    Weather { fog, surface, vertical_visibility_m: Some(60.0), ..day(300.0, -4.0, 1.0) }
}

/// Returns `w` under a closed nimbostratus with its base at `base_m`, from which `rate_mm_h` of `kind` falls.
fn under_nimbostratus(w: Weather, kind: PrecipitationKind, rate_mm_h: f64, base_m: f64) -> Weather {
    let clouds = vec![CloudLayer::of(CloudKind::Nimbostratus, 1.0, base_m)];
    Weather { clouds, precipitation: Precipitation::of(kind, rate_mm_h), ..w }
}

fn drizzle() -> Weather {
    let clouds = vec![CloudLayer::of(CloudKind::Stratus, 1.0, 200.0)];
    let precipitation = Precipitation::of(PrecipitationKind::Drizzle, 0.3);
    Weather {
        fog: Fog::of(FogKind::Mist),
        clouds,
        precipitation,
        wind: Wind::of(3.0, 210.0),
        ..day(4000.0, 10.0, 0.96)
    }
}

fn rain() -> Weather {
    let w = Weather { wind: Wind::of(7.0, 200.0), pressure_hpa: 1000.0, ..day(3000.0, 9.0, 0.93) };
    under_nimbostratus(w, PrecipitationKind::Rain, 5.0, 600.0)
}

fn heavy_rain() -> Weather {
    let wind = Wind { gust_m_s: Some(17.0), ..Wind::of(10.0, 190.0) };
    let w = Weather { wind, pressure_hpa: 992.0, ..day(1200.0, 13.0, 0.96) };
    under_nimbostratus(w, PrecipitationKind::Rain, 20.0, 400.0)
}

fn showers() -> Weather {
    let clouds = vec![CloudLayer::of(CloudKind::ToweringCumulus, 0.6, 800.0)];
    let precipitation = Precipitation { showers: true, ..Precipitation::of(PrecipitationKind::Rain, 3.0) };
    let wind = Wind { gust_m_s: Some(14.0), ..Wind::of(8.0, 280.0) };
    Weather { clouds, precipitation, wind, ..day(4500.0, 11.0, 0.8) }
}

/// Returns a cumulonimbus overhead with its anvil.
fn thundercloud() -> Vec<CloudLayer> {
    vec![CloudLayer::of(CloudKind::Cumulonimbus, 0.9, 700.0), CloudLayer::of(CloudKind::Cirrostratus, 1.0, 9000.0)]
}

fn thunderstorm() -> Weather {
    let precipitation = Precipitation {
        showers: true,
        thunderstorm: true,
        hail: true,
        ..Precipitation::of(PrecipitationKind::Rain, 40.0)
    };
    let wind = Wind { gust_m_s: Some(24.0), variable_deg: Some((180.0, 280.0)), ..Wind::of(11.0, 230.0) };
    Weather { clouds: thundercloud(), precipitation, wind, pressure_hpa: 1004.0, ..day(900.0, 19.0, 0.95) }
}

fn hail() -> Weather {
    let precipitation =
        Precipitation { showers: true, thunderstorm: true, ..Precipitation::of(PrecipitationKind::Hail, 25.0) };
    let wind = Wind { gust_m_s: Some(20.0), ..Wind::of(9.0, 270.0) };
    Weather { clouds: thundercloud(), precipitation, wind, ..day(4000.0, 14.0, 0.9) }
}

fn freezing_rain() -> Weather {
    let w = Weather { wind: Wind::of(4.0, 70.0), pressure_hpa: 1006.0, ..day(3000.0, -1.0, 0.95) };
    under_nimbostratus(w, PrecipitationKind::FreezingRain, 1.5, 300.0)
}

fn sleet() -> Weather {
    let w = Weather { wind: Wind::of(6.0, 40.0), pressure_hpa: 1002.0, ..day(850.0, 1.0, 0.95) };
    under_nimbostratus(w, PrecipitationKind::Sleet, 2.0, 400.0)
}

/// Returns `w` with snow that falls at `rate_mm_h` on `depth_m` of lying snow, from a nimbostratus at 500 m.
fn snowing(w: Weather, rate_mm_h: f64, depth_m: f64) -> Weather {
    let surface = Surface { snow_depth_m: depth_m, ..Surface::default() };
    under_nimbostratus(Weather { surface, ..w }, PrecipitationKind::Snow, rate_mm_h, 500.0)
}

fn light_snow() -> Weather {
    snowing(Weather { wind: Wind::of(3.0, 20.0), ..day(3000.0, -3.0, 0.88) }, 0.3, 0.02)
}

fn snow() -> Weather {
    snowing(Weather { wind: Wind::of(4.0, 30.0), ..day(600.0, -2.0, 0.92) }, 1.5, 0.10)
}

fn blizzard() -> Weather {
    let wind = Wind { gust_m_s: Some(28.0), ..Wind::of(19.0, 0.0) };
    let lofted = Lofted::of(LoftedKind::BlowingSnow);
    let w = Weather { wind, lofted, pressure_hpa: 975.0, vertical_visibility_m: Some(60.0), ..day(150.0, -8.0, 0.9) };
    snowing(w, 4.0, 0.30)
}

/// Returns a storm that lifts dry soil.
fn storm_of(aerosol: AerosolKind, lofted: LoftedKind, visibility_m: f64, speed_m_s: f64) -> Weather {
    let wind = Wind { gust_m_s: Some(speed_m_s * 1.45), ..Wind::of(speed_m_s, 320.0) };
    let (aerosol, lofted) = (Aerosol::of(aerosol), Lofted::of(lofted));
    Weather { aerosol, lofted, wind, pressure_hpa: 999.0, ..day(visibility_m, 37.0, 0.12) }
}

fn dust_storm() -> Weather {
    storm_of(AerosolKind::Dust, LoftedKind::BlowingDust, 400.0, 15.0)
}

fn sand_storm() -> Weather {
    storm_of(AerosolKind::Sand, LoftedKind::BlowingSand, 800.0, 17.0)
}

fn gale() -> Weather {
    let clouds = vec![CloudLayer::of(CloudKind::Stratocumulus, 0.6, 700.0)];
    let wind = Wind { gust_m_s: Some(28.0), ..Wind::of(19.0, 260.0) };
    Weather { clouds, wind, pressure_hpa: 985.0, ..day(20_000.0, 9.0, 0.7) }
}

/// Returns a storm of Beaufort 10: 24.5 to 28.4 m/s, with waves of about 9 m (WMO-No. 306, section E). Such waves are
/// sea state 8 (code table 3700). Spray lowers the visibility. The gust is 1.23 times the ten-minute mean, the factor
/// at sea (Harper, Kepert and Ginger 2010, table 1.1).
fn storm_at_sea() -> Weather {
    let clouds = vec![CloudLayer::of(CloudKind::Stratocumulus, 1.0, 500.0)];
    let wind = Wind { gust_m_s: Some(32.0), ..Wind::of(26.0, 250.0) };
    let swell = Some(Swell { height_m: 4.0, period_s: 13.0, from_deg: 270.0 });
    let sea = Sea { state: Some(8), significant_wave_height_m: Some(9.0), temperature_c: Some(9.0), swell };
    let (aerosol, lofted) = (Aerosol::of(AerosolKind::Maritime), Lofted::of(LoftedKind::BlowingSpray));
    let precipitation = Precipitation { showers: true, ..Precipitation::of(PrecipitationKind::Rain, 2.0) };
    Weather { clouds, wind, sea, aerosol, lofted, precipitation, pressure_hpa: 968.0, ..day(3000.0, 8.0, 0.88) }
}

#[cfg(test)]
mod tests {
    use super::super::derive;
    use super::*;

    #[test]
    fn every_name_gives_a_valid_weather_of_its_own() {
        let all: Vec<Weather> = Weather::preset_names().map(|n| Weather::preset(n).unwrap()).collect();
        assert_eq!(all.len(), PRESETS.len());
        for (name, w) in Weather::preset_names().zip(&all) {
            let c = derive(w).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert!((c.visibility_m() / w.visibility_m - 1.0).abs() < 1e-9, "{name}");
            assert!(!Weather::preset_description(name).unwrap().is_empty());
            assert_eq!(all.iter().filter(|other| *other == w).count(), 1, "{name} has a twin");
        }
        assert_eq!(Weather::preset("clear").unwrap(), Weather::default());
    }

    #[test]
    fn an_unknown_name_is_answered_with_those_there_are() {
        let e = Weather::preset("Sunny").unwrap_err().to_string();
        let shown = Weather::preset_names().filter(|name| e.contains(&format!(" {name},"))).count();
        let more = format!(", {} more to storm_at_sea, got \"Sunny\"", Weather::preset_names().len() - shown);
        assert!(shown >= 5 && e.starts_with("name must be one of clear, ") && e.contains(&more), "{e}");
        assert!(Weather::preset("").is_err());
    }

    #[test]
    fn precipitation_does_not_hide_what_the_preset_is_about() {
        for name in Weather::preset_names() {
            let w = Weather::preset(name).unwrap();
            let c = derive(&w).unwrap();
            let alone = super::super::precipitation::falling(&w.precipitation).extinction_per_m();
            assert!(
                (c.precipitation.extinction_per_m() - alone).abs() < 1e-12,
                "{name}: the rate fits into the visibility"
            );
        }
    }
}
