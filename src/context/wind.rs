//! The wind that a context answers for: velocity at any place and time, and how far it has carried the air.

use std::sync::Arc;

use glam::DVec3;

use super::shared_world::Context;
use crate::{
    error::Result,
    wind::{Blowing, WindAt, WindGrid},
};

impl Context {
    fn blowing(&self, time_s: f64) -> Result<Blowing> {
        self.check_time(time_s)?;
        Ok(self.world.over().wind.at(time_s))
    }

    /// Wind at `position` and simulation time `time_s`, (east, north, up) of the place. Height counts from the
    /// station's altitude: who has terrain asks as far above the station as the point is above his ground.
    ///
    /// Within a host's grid ([`Context::set_wind_grid`]) the wind is that of the grid, at any time; within a solved
    /// field ([`Context::set_wind_field`]) that of the field, at times within a minute of its own.
    ///
    /// Any thread. Closed form: any time costs the same. Laws: [`crate::wind`].
    ///
    /// # Errors
    /// As [`Context::conditions_at`].
    pub fn wind_at(&self, position: DVec3, time_s: f64) -> Result<WindAt> {
        self.world.wind_at(position, time_s)
    }

    /// Sets a wind that varies in space; `None` leaves the weather's, or the solved field's
    /// ([`Context::set_wind_field`]), in place of which it blows. It is in [`Context::wind_at`], in what lands on a
    /// surface or a windscreen, and on what falls near a camera; [`Context::wind_displacement`], and what goes with it,
    /// know nothing of it.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_wind_grid(&mut self, grid: Option<WindGrid>) -> Result<()> {
        grid.as_ref().map_or(Ok(()), WindGrid::validate)?;
        self.world.set_wind_grid(grid.map(Arc::new));
        Ok(())
    }

    /// The wind that varies in space.
    pub fn wind_grid(&self) -> Option<&Arc<WindGrid>> {
        self.world.set.host_wind.as_ref().map(|host| &host.grid)
    }

    /// How far the wind at 10 m, gusts included, has carried the air since simulation time 0, m (east, north, up): the
    /// integral of its velocity over the timeline, the same at every place. Continuous whatever the weather does: what
    /// goes with the air is moved by its differences, never by velocity times time.
    ///
    /// Any thread. Closed form; the same bits for any sequence of updates, and after saving and loading.
    ///
    /// # Errors
    /// For times as [`Context::conditions_at`].
    pub fn wind_displacement(&self, time_s: f64) -> Result<DVec3> {
        Ok(self.blowing(time_s)?.drift.displacement_m.extend(0.0))
    }

    /// Velocity that [`Context::wind_displacement`] is the integral of, m/s: the wind at 10 m with its gusts, which
    /// carries drops.
    ///
    /// # Errors
    /// For times as [`Context::conditions_at`].
    pub fn carrying_wind(&self, time_s: f64) -> Result<DVec3> {
        Ok(self.blowing(time_s)?.velocity_m_s().extend(0.0))
    }
}
