//! The wind of a context: its velocity at any place and time, and the displacement of the air by it.

use std::sync::Arc;

use glam::DVec3;

use super::shared_world::Context;
use crate::{
    error::Result,
    wind::{Blowing, WindAt, WindGrid},
};

impl Context {
    /// Returns the weather's wind at a time that the timeline knows.
    fn blowing(&self, time_s: f64) -> Result<Blowing> {
        self.check_time(time_s)?;
        Ok(self.world.over().wind.at(time_s))
    }

    /// Returns the wind at `position` and simulation time `time_s`, in (east, north, up) of the place. Height is
    /// measured from the station's altitude. A host with terrain should therefore query a point as far above the
    /// station as the real point is above the terrain.
    ///
    /// Inside a host's grid ([`Context::set_wind_grid`]) the grid's wind replaces the weather's or is added to it
    /// ([`WindGridKind`](crate::wind::WindGridKind)), at any time. Inside a solved field ([`Context::set_wind_field`])
    /// the wind is the field's, at times within a minute of the field's own time.
    ///
    /// Any thread. Closed form: any time costs the same. [`crate::wind`] has the laws.
    ///
    /// # Errors
    /// As [`Context::conditions_at`].
    pub fn wind_at(&self, position: DVec3, time_s: f64) -> Result<WindAt> {
        self.world.wind_at(position, time_s)
    }

    /// Sets a wind that varies in space. It replaces a solved field ([`Context::set_wind_field`]), and it replaces the
    /// weather's wind or is added to it, by its kind. `None` removes the grid. The grid affects [`Context::wind_at`],
    /// the rain that lands on a surface or a windscreen, and drops and flakes near a camera. It affects neither
    /// [`Context::wind_displacement`] nor anything that moves by that displacement.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_wind_grid(&mut self, grid: Option<WindGrid>) -> Result<()> {
        grid.as_ref().map_or(Ok(()), WindGrid::validate)?;
        self.world.set_wind_grid(grid.map(Arc::new));
        Ok(())
    }

    /// Returns the wind that varies in space, if the host has set one.
    pub fn wind_grid(&self) -> Option<&Arc<WindGrid>> {
        self.world.set.host_wind.as_ref().map(|host| &host.grid)
    }

    /// Returns the displacement of the air by the wind at 10 m, gusts included, since simulation time 0, m (east,
    /// north, up). It is the integral of the wind's velocity over the timeline, the same at every place, and continuous
    /// through all changes of weather. Things that drift with the air are moved by differences of this displacement,
    /// never by velocity times time.
    ///
    /// Any thread. Closed form; the same bits for any sequence of updates, and after saving and loading.
    ///
    /// # Errors
    /// For times as [`Context::conditions_at`].
    pub fn wind_displacement(&self, time_s: f64) -> Result<DVec3> {
        Ok(self.blowing(time_s)?.drift.displacement_m.extend(0.0))
    }

    /// Returns the velocity whose integral is [`Context::wind_displacement`], m/s (east, north, up): the wind at 10 m
    /// with its gusts, which carries drops.
    ///
    /// # Errors
    /// For times as [`Context::conditions_at`].
    pub fn carrying_wind(&self, time_s: f64) -> Result<DVec3> {
        Ok(self.blowing(time_s)?.velocity_m_s().extend(0.0))
    }
}
