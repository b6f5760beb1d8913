//! The sea without a context: its waves one by one, and its surface, under a weather that lasts for ever.

use std::f64::consts::TAU;

use glam::DVec2;

use super::{
    mode::SeaMode,
    model::{PreparedSea, SeaStatistics, SeaWorkshop, WeatherPast},
    regions::WaterBody,
    settings::SeaSettings,
    surface::SeaPoint,
};
use crate::{
    error::{Result, check_range},
    weather::{Timeline, Weather, derive},
};

/// The sea of settings and a lasting weather.
pub struct SeaProbe {
    sea: PreparedSea,
    timeline: Timeline,
    workshop: SeaWorkshop,
}

impl SeaProbe {
    /// Creates the sea.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field of the settings or of the weather.
    pub fn new(settings: SeaSettings, weather: &Weather, seed: u64) -> Result<Self> {
        settings.validate()?;
        let sea = PreparedSea::new(settings, seed);
        let workshop = SeaWorkshop::new(&sea);
        Ok(Self { sea, timeline: Timeline::new(derive(weather)?), workshop })
    }

    /// Returns all waves, single ones and those of tiles, as they are drawn. Their variance is strengthened to make up
    /// for what narrow crests take from the heights at fixed places: mostly by 1 % or less, and never by more than 6 %.
    pub fn modes(&mut self) -> Vec<SeaMode> {
        let past = WeatherPast { timeline: &self.timeline, revision: 0, kept: &[] };
        let (waves, tiles) = self.workshop.waves(&self.sea, &past, 0.0);
        let mut modes = Vec::with_capacity(waves.len());
        modes.extend(waves.iter().map(|wave| SeaMode {
            k_per_m: TAU * wave.turns_per_m,
            direction: libm::atan2(wave.toward.y, wave.toward.x),
            variance_m2: 0.5 * wave.amplitude_m * wave.amplitude_m,
        }));
        tiles.tiles.iter().for_each(|tile| modes.extend(tile.modes().filter(|mode| mode.variance_m2 > 0.0)));
        modes
    }

    /// Returns the statistics at time 0.
    pub fn statistics(&mut self) -> SeaStatistics {
        let past = WeatherPast { timeline: &self.timeline, revision: 0, kept: &[] };
        self.workshop.statistics(&self.sea, &past, 0.0)
    }

    /// Returns the surface at a place, m east and north, and a time; the point's `surface` is not filled in.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming `x`, `y` or `t`, which must lie within 1e12 m and 1e10 s.
    pub fn at(&mut self, place_m: DVec2, time_s: f64) -> Result<SeaPoint> {
        check_range("x", place_m.x, -1e12, 1e12, "m")?;
        check_range("y", place_m.y, -1e12, 1e12, "m")?;
        check_range("t", time_s, -1e10, 1e10, "s")?;
        let past = WeatherPast { timeline: &self.timeline, revision: 0, kept: &[] };
        Ok(self.workshop.surface(&self.sea, &past, time_s).within(&WaterBody::OPEN, place_m, 0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sea::WindSea;

    #[test]
    fn modes_hold_the_height_and_the_mean_direction() {
        let wind_sea = WindSea::Height { significant_m: 2.0, peak_period_s: Some(7.0), gamma: None };
        let settings = SeaSettings { wind_sea, depth_m: 30.0, from_deg: Some(240.0), ..SeaSettings::default() };
        let mut probe = SeaProbe::new(settings, &Weather::default(), 5).expect("a sea");
        let modes = probe.modes();
        let whole: f64 = modes.iter().map(|mode| mode.variance_m2).sum();
        assert!((4.0 * whole.sqrt() / 2.0 - 1.0).abs() < 0.006 && modes.len() > 3000, "{whole}, {}", modes.len());
        let along = |m: &SeaMode| DVec2::new(libm::cos(m.direction), libm::sin(m.direction)) * m.variance_m2;
        let mean: DVec2 = modes.iter().map(along).sum();
        // From 240 degrees waves travel towards 60 degrees clockwise from north: 30 degrees from east to north.
        assert!((libm::atan2(mean.y, mean.x).to_degrees() - 30.0).abs() < 1.5, "{mean}");
        assert!((probe.statistics().significant_height_m - 2.0).abs() < 1e-9);
        let before = probe.at(DVec2::new(3.0, 4.0), 1e5).expect("a place").height_m;
        assert_ne!(probe.at(DVec2::new(3.0, 4.0), 7.0).expect("a place").height_m, before);
        assert_eq!(probe.at(DVec2::new(3.0, 4.0), 1e5).expect("a place").height_m, before);
        assert_eq!(probe.at(DVec2::ZERO, f64::NAN).expect_err("no time").field(), Some("t"));
    }
}
