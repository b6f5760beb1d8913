//! The wind at a place: the weather's, and what varies in space about it.

use std::sync::Arc;

use glam::DVec3;

use super::World;
use crate::{
    error::Result,
    wind::{WindAt, WindGrid, WindVolume},
};

impl World {
    /// The wind that varies in space at a time: the host's grid if there is one, else the solved field.
    pub fn wind_volume(&self, time_s: f64) -> Option<&WindVolume> {
        let volume = self.host_wind.as_ref().or(self.solved_wind.as_ref());
        volume.map(AsRef::as_ref).filter(|v| v.holds_at(time_s))
    }

    /// Puts a host's grid, which is valid, in place of the one before.
    pub fn set_wind_grid(&mut self, grid: Option<Arc<WindGrid>>) {
        self.wind_grid = grid;
        self.show_wind_grid();
    }

    /// Makes what queries and shaders read of the host's grid.
    pub(super) fn show_wind_grid(&mut self) {
        let volume = |g: &Arc<WindGrid>| Box::new(WindVolume::of_grid(g, self.frame.frame_at(g.origin).world_to_enu));
        self.host_wind = self.wind_grid.as_ref().map(volume);
    }

    /// The wind with gusts at a place and time; height counts from the station's altitude.
    ///
    /// # Errors
    /// As [`World::conditions_at`].
    pub fn wind_at(&self, position: DVec3, time_s: f64) -> Result<WindAt> {
        let place = self.frame.place_at("position", position)?.place;
        let conditions = self.weather_at(time_s)?;
        let height_m = place.altitude_m - conditions.air.station_altitude_m;
        let wind = self.over().wind.at(time_s).at_height(&conditions.wind, height_m);
        let Some(volume) = self.wind_volume(time_s) else { return Ok(wind) };
        let Some(found) = volume.at(volume.cells_at(position)) else { return Ok(wind) };
        let (own, rest) = (found.truncate(), 1.0 - found.w);
        Ok(WindAt {
            velocity_m_s: own + wind.velocity_m_s * rest,
            mean_m_s: own + wind.mean_m_s * rest,
            gust_deviation_m_s: wind.gust_deviation_m_s * rest,
        })
    }

    /// The wind that carries what falls past a place: that at 10 m with its gusts, m/s (east, north, up), and where the wind varies in
    /// space that.
    ///
    /// # Errors
    /// As [`World::weather_at`].
    pub fn carrying_at(&self, position: DVec3, time_s: f64) -> Result<DVec3> {
        let weathers = self.over().carrying_until(time_s)?.velocity_m_s();
        let about = self.wind_volume(time_s).and_then(|volume| volume.wind(position, weathers));
        Ok(about.unwrap_or(weathers))
    }
}
