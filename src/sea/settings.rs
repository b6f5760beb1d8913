//! Settings with which a host describes the sea: level, tide, fetch, depth, waves, ice, water.

use super::{
    clarity::WaterClarity,
    dispersion::wave_length_m,
    ice::SeaIce,
    shore::LUNAR_TIDE_S,
    single::{self, SingleWave},
    spectrum::{GROWING_GAMMA, developed_peak_rad_s},
};
use crate::{
    error::{Error, Result, check_range},
    weather::wave_height_of_state_m,
};

/// Maximum number of swells.
pub const MAX_SWELLS: usize = 4;
/// Largest ratio of the significant height to the length of the waves at the peak: steeper seas break (DNV-RP-C205,
/// 3.5.5).
pub const MOST_STEEPNESS: f64 = 1.0 / 15.0;

/// Source of the wind sea's height.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum WindSea {
    /// The weather: its sea state or height if it has one, else what its wind has raised by fetch and duration.
    #[default]
    Weather,
    /// A significant height, and a peak.
    Height {
        /// Significant height, m. Range [0, 30], at most a fifteenth of the wave length at the peak.
        significant_m: f64,
        /// Peak period, s. Range [0.5, 30]; `None` is that of a fully developed sea of this height.
        peak_period_s: Option<f64>,
        /// Peak enhancement of JONSWAP. Range [1, 10]; `None` is 3.3 with a peak period, else 1.
        gamma: Option<f64>,
    },
    /// WMO sea state (code 3700), 0 to 9: the middle of its range of heights, 16 m for 9, fully developed.
    SeaState(u8),
    /// Beaufort number B. Range [0, 12]: the sea that a wind of 0.836 B^1.5 m/s keeps up over the fetch.
    Beaufort(f64),
}

/// A swell: waves from far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeaSwell {
    /// Significant height, m. Range [0, 20], at most a fifteenth of the wave length.
    pub height_m: f64,
    /// Peak period, s. Range [1, 30].
    pub period_s: f64,
    /// Direction that it comes from, degrees clockwise from true north. Range [0, 360].
    pub from_deg: f64,
    /// Directional width, degrees. Range [1, 60]; `None` is 15.07: the width of Donelan and Banner's spreading at the
    /// peak, narrowed by Horvath's swell parameter 1.
    pub spread_deg: Option<f64>,
}

/// Tide about the mean level, with a period of half a lunar day, 12.4206 h.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tide {
    /// Height of high water above the mean level, m. Range [0, 10].
    pub amplitude_m: f64,
    /// Simulation time of a high water, s. Range [-1e10, 1e10].
    pub high_water_s: f64,
}

/// Settings of the sea. What is set here replaces the weather's sea and swell.
#[derive(Clone, Debug, PartialEq)]
pub struct SeaSettings {
    /// Mean level, m above mean sea level. Range [-500, 9000], default 0.
    pub level_m: f64,
    /// Tide. Default none.
    pub tide: Option<Tide>,
    /// Distance over which the wind raises waves, m. Range [10, 2e7]; `None`, the default, is the open sea.
    pub fetch_m: Option<f64>,
    /// Depth of the water below the mean level, m. Range [0.5, 12000], default 4000. Waves are computed for this depth
    /// everywhere in this version.
    pub depth_m: f64,
    /// Salinity, g/kg. Range [0, 45], default 35.
    pub salinity_g_kg: f64,
    /// Water temperature, degrees Celsius. Range [-3, 45]; `None`, the default, is the weather's.
    pub temperature_c: Option<f64>,
    /// Source of the wind sea. Default the weather.
    pub wind_sea: WindSea,
    /// Direction that the wind sea comes from, degrees clockwise from true north. Range [0, 360]; `None`, the default,
    /// is that of the wind that raised it.
    pub from_deg: Option<f64>,
    /// Swells, at most [`MAX_SWELLS`]; `None`, the default, is the weather's swell.
    pub swells: Option<Vec<SeaSwell>>,
    /// Single waves, added to all others, at most [`MAX_SINGLE_WAVES`](super::MAX_SINGLE_WAVES). Default none.
    pub waves: Vec<SingleWave>,
    /// Ice, which dampens all waves. Default none.
    pub ice: Option<SeaIce>,
    /// Clarity of the water. Default the clear open sea.
    pub clarity: WaterClarity,
    /// Whether waves break without foam. Default `false`.
    pub without_whitecaps: bool,
    /// Whether there is water only inside regions ([`Context::set_sea_regions`](crate::context::Context)). Default
    /// `false`: the sea is everywhere.
    pub only_in_regions: bool,
}

impl Default for SeaSettings {
    fn default() -> Self {
        Self {
            level_m: 0.0,
            tide: None,
            fetch_m: None,
            depth_m: 4000.0,
            salinity_g_kg: 35.0,
            temperature_c: None,
            wind_sea: WindSea::Weather,
            from_deg: None,
            swells: None,
            waves: Vec::new(),
            ice: None,
            clarity: WaterClarity::default(),
            without_whitecaps: false,
            only_in_regions: false,
        }
    }
}

/// Checks a height against the length of its waves.
fn check_steepness(name: &str, height_m: f64, period: &str, period_s: f64, depth_m: f64) -> Result<()> {
    let most_m = MOST_STEEPNESS * wave_length_m(period_s, depth_m);
    if height_m <= most_m {
        return Ok(());
    }
    let accepted = format!("at most {most_m:.4} m for {period} = {period_s} s (steeper waves break)");
    Err(Error::range(name, &accepted, height_m))
}

impl WindSea {
    fn validate(&self, depth_m: f64) -> Result<()> {
        match *self {
            Self::Weather => Ok(()),
            Self::Height { significant_m, peak_period_s, gamma } => {
                check_range("wind_sea.significant_m", significant_m, 0.0, 30.0, "m")?;
                let peak_s = peak_period_s.unwrap_or_else(|| developed_period_s(significant_m));
                check_range("wind_sea.peak_period_s", peak_s, 0.5, 30.0, "s")?;
                check_range("wind_sea.gamma", gamma.unwrap_or(GROWING_GAMMA), 1.0, 10.0, "")?;
                check_steepness("wind_sea.significant_m", significant_m, "peak_period_s", peak_s, depth_m)
            }
            Self::SeaState(state) => {
                check_range("wind_sea.sea_state", f64::from(state), 0.0, 9.0, "")?;
                let height_m = wave_height_of_state_m(state);
                let most_m = MOST_STEEPNESS * wave_length_m(developed_period_s(height_m), depth_m);
                if height_m <= most_m {
                    return Ok(());
                }
                let accepted = format!("a state of at most {most_m:.3} m in a depth of {depth_m} m");
                Err(Error::range("wind_sea.sea_state", &accepted, state))
            }
            Self::Beaufort(number) => check_range("wind_sea.beaufort", number, 0.0, 12.0, ""),
        }
    }
}

/// Returns the peak period, s, of a fully developed sea of a height, at least 0.5.
pub(super) fn developed_period_s(significant_m: f64) -> f64 {
    let quarter = 0.25 * significant_m;
    (std::f64::consts::TAU / developed_peak_rad_s(quarter * quarter)).max(0.5)
}

impl SeaSettings {
    /// Checks all fields.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        check_range("level_m", self.level_m, -500.0, 9000.0, "m")?;
        if let Some(tide) = &self.tide {
            check_range("tide.amplitude_m", tide.amplitude_m, 0.0, 10.0, "m")?;
            check_range("tide.high_water_s", tide.high_water_s, -1e10, 1e10, "s")?;
        }
        check_range("fetch_m", self.fetch_m.unwrap_or(1e5), 10.0, 2e7, "m")?;
        check_range("depth_m", self.depth_m, 0.5, 12_000.0, "m")?;
        check_range("salinity_g_kg", self.salinity_g_kg, 0.0, 45.0, "g/kg")?;
        check_range("temperature_c", self.temperature_c.unwrap_or(10.0), -3.0, 45.0, "degrees")?;
        check_range("from_deg", self.from_deg.unwrap_or(0.0), 0.0, 360.0, "degrees")?;
        self.clarity.validate()?;
        self.ice.as_ref().map_or(Ok(()), SeaIce::validate)?;
        self.wind_sea.validate(self.depth_m)?;
        single::validate(&self.waves, self.depth_m)?;
        let Some(swells) = &self.swells else { return Ok(()) };
        if swells.len() > MAX_SWELLS {
            return Err(Error::range("swells", &format!("at most {MAX_SWELLS} swells"), swells.len()));
        }
        swells
            .iter()
            .enumerate()
            .try_for_each(|(i, swell)| swell.validate(self.depth_m).map_err(|e| e.within(&format!("swells[{i}]"))))
    }

    /// Returns the level of the sea without waves at a time, m: the mean level and the tide.
    pub fn level_at_m(&self, time_s: f64) -> f64 {
        let Some(tide) = &self.tide else { return self.level_m };
        let turns = (time_s - tide.high_water_s) / LUNAR_TIDE_S;
        self.level_m + tide.amplitude_m * libm::cos(std::f64::consts::TAU * (turns - turns.floor()))
    }
}

impl SeaSwell {
    fn validate(&self, depth_m: f64) -> Result<()> {
        check_range("height_m", self.height_m, 0.0, 20.0, "m")?;
        check_range("period_s", self.period_s, 1.0, 30.0, "s")?;
        check_range("from_deg", self.from_deg, 0.0, 360.0, "degrees")?;
        check_range("spread_deg", self.spread_deg.unwrap_or(15.0), 1.0, 60.0, "degrees")?;
        check_steepness("height_m", self.height_m, "period_s", self.period_s, depth_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{error::Status, sea::WaveScale};

    const SINGLE: SingleWave =
        SingleWave { height_m: 0.8, scale: WaveScale::Length(40.0), from_deg: 10.0, phase_deg: 0.0 };

    #[test]
    fn faults_are_named_with_their_range() {
        let height = |significant_m, peak_period_s| WindSea::Height { significant_m, peak_period_s, gamma: None };
        let swell = SeaSwell { height_m: 2.0, period_s: 12.0, from_deg: 90.0, spread_deg: None };
        let base = SeaSettings::default;
        let faults: Vec<(&str, SeaSettings)> = vec![
            ("level_m", SeaSettings { level_m: f64::NAN, ..base() }),
            ("tide.amplitude_m", SeaSettings { tide: Some(Tide { amplitude_m: -1.0, high_water_s: 0.0 }), ..base() }),
            ("tide.high_water_s", SeaSettings { tide: Some(Tide { amplitude_m: 1.0, high_water_s: 1e11 }), ..base() }),
            ("fetch_m", SeaSettings { fetch_m: Some(0.0), ..base() }),
            ("depth_m", SeaSettings { depth_m: f64::NAN, ..base() }),
            ("salinity_g_kg", SeaSettings { salinity_g_kg: -1.0, ..base() }),
            ("temperature_c", SeaSettings { temperature_c: Some(80.0), ..base() }),
            ("from_deg", SeaSettings { from_deg: Some(-1.0), ..base() }),
            ("wind_sea.significant_m", SeaSettings { wind_sea: height(10.0, Some(4.0)), ..base() }),
            ("wind_sea.significant_m", SeaSettings { wind_sea: height(f64::INFINITY, None), ..base() }),
            ("wind_sea.peak_period_s", SeaSettings { wind_sea: height(1.0, Some(0.0)), ..base() }),
            ("wind_sea.sea_state", SeaSettings { wind_sea: WindSea::SeaState(10), ..base() }),
            ("wind_sea.sea_state", SeaSettings { wind_sea: WindSea::SeaState(9), depth_m: 2.0, ..base() }),
            ("wind_sea.beaufort", SeaSettings { wind_sea: WindSea::Beaufort(12.5), ..base() }),
            ("clarity.percent", SeaSettings { clarity: WaterClarity::Percent(20.0), ..base() }),
            ("ice.cover", SeaSettings { ice: Some(SeaIce { cover: -0.1, ..SeaIce::default() }), ..base() }),
            ("waves", SeaSettings { waves: vec![SINGLE; 17], ..base() }),
            ("waves[0].height_m", SeaSettings { waves: vec![SINGLE], depth_m: 0.5, ..base() }),
            ("swells", SeaSettings { swells: Some(vec![swell; 5]), ..base() }),
            (
                "swells[1].period_s",
                SeaSettings { swells: Some(vec![swell, SeaSwell { period_s: 0.0, ..swell }]), ..base() },
            ),
            ("swells[0].height_m", SeaSettings { swells: Some(vec![SeaSwell { period_s: 4.0, ..swell }]), ..base() }),
            (
                "swells[0].spread_deg",
                SeaSettings { swells: Some(vec![SeaSwell { spread_deg: Some(0.0), ..swell }]), ..base() },
            ),
        ];
        for (field, settings) in faults {
            let e = settings.validate().expect_err(field);
            assert_eq!((e.status, e.field()), (Status::InvalidArgument, Some(field)), "{e}");
        }
        base().validate().expect("the default stands");
        let storm = SeaSettings { wind_sea: height(9.0, Some(11.0)), swells: Some(vec![swell]), ..base() };
        storm.validate().expect("a storm stands");
        for state in 0..=9 {
            SeaSettings { wind_sea: WindSea::SeaState(state), ..base() }.validate().expect("all states");
        }
    }

    #[test]
    fn tides_rise_and_fall_twice_a_lunar_day() {
        let tide = Some(Tide { amplitude_m: 2.0, high_water_s: 1000.0 });
        let sea = SeaSettings { level_m: 0.5, tide, ..SeaSettings::default() };
        assert_eq!(sea.level_at_m(1000.0), 2.5);
        assert!((sea.level_at_m(1000.0 + 0.5 * 12.4206 * 3600.0) + 1.5).abs() < 1e-9);
        assert!((sea.level_at_m(1000.0 + 1000.0 * 12.4206 * 3600.0) - 2.5).abs() < 1e-9);
    }
}
