//! The wind that a context answers for: velocity at any place and time, and how far it has carried the air.

use std::sync::Arc;

use glam::DVec3;

use super::Context;
use crate::{
    error::Result,
    wind::{Blowing, WindAt, WindGrid, WindGridKind},
};

impl Context {
    fn blowing(&self, time_s: f64) -> Result<Blowing> {
        self.check_time(time_s)?;
        Ok(self.world.over().wind.at(time_s))
    }

    /// Wind at `position` and simulation time `time_s`, (east, north, up) of the place. Height counts from the station's altitude: who
    /// has terrain asks as far above the station as the point is above his ground.
    ///
    /// Any thread. Closed form: any time costs the same. Laws: [`crate::wind`].
    ///
    /// # Errors
    /// As [`Context::conditions_at`].
    pub fn wind_at(&self, position: DVec3, time_s: f64) -> Result<WindAt> {
        let place = self.world.frame.place_at("position", position)?.place;
        let conditions = self.world.weather_at(time_s)?;
        let height_m = place.altitude_m - conditions.air.station_altitude_m;
        let wind = self.blowing(time_s)?.at_height(&conditions.wind, height_m);
        let found = self.world.wind_grid.as_ref().and_then(|g| {
            let cells = g.cells_at(position, self.world.frame.frame_at(g.origin).world_to_enu);
            Some((g.kind, g.at(cells)?))
        });
        Ok(match found {
            None => wind,
            Some((WindGridKind::Whole, v)) => WindAt { velocity_m_s: v, mean_m_s: v, gust_deviation_m_s: 0.0 },
            Some((WindGridKind::Added, v)) => {
                WindAt { velocity_m_s: wind.velocity_m_s + v, mean_m_s: wind.mean_m_s + v, ..wind }
            }
        })
    }

    /// Sets a wind that varies in space; `None` leaves the weather's. It blows in [`Context::wind_at`] and on drops of
    /// [`RainModel::Integrated`](crate::rain::RainModel::Integrated); [`Context::wind_displacement`], and what goes with
    /// it, know nothing of it.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_wind_grid(&mut self, grid: Option<WindGrid>) -> Result<()> {
        grid.as_ref().map_or(Ok(()), WindGrid::validate)?;
        self.world.wind_grid = grid.map(Arc::new);
        Ok(())
    }

    /// The wind that varies in space.
    pub fn wind_grid(&self) -> Option<&Arc<WindGrid>> {
        self.world.wind_grid.as_ref()
    }

    /// How far the wind at 10 m, gusts included, has carried the air since simulation time 0, m (east, north, up): the integral of
    /// its velocity over the timeline, the same at every place. Continuous whatever the weather does: what goes with the air is
    /// moved by its differences, never by velocity times time.
    ///
    /// Any thread. Closed form; the same bits for any sequence of updates, and after saving and loading.
    ///
    /// # Errors
    /// For times as [`Context::conditions_at`].
    pub fn wind_displacement(&self, time_s: f64) -> Result<DVec3> {
        Ok(self.blowing(time_s)?.drift.displacement_m.extend(0.0))
    }

    /// Velocity that [`Context::wind_displacement`] is the integral of, m/s: the wind at 10 m with its gusts, which carries drops.
    ///
    /// # Errors
    /// For times as [`Context::conditions_at`].
    pub fn carrying_wind(&self, time_s: f64) -> Result<DVec3> {
        Ok(self.blowing(time_s)?.velocity_m_s().extend(0.0))
    }
}
