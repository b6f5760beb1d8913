//! The sea: its settings, and queries of its surface and statistics.

use glam::DVec3;

use crate::{
    context::Context,
    error::{Result, check_range},
    sea::{SeaPoint, SeaSettings, SeaStatistics},
};

/// Longest wave that a query may leave out, m.
const MOST_SHORTEST_M: f64 = 1e4;

impl Context {
    /// Sets the sea; `None` removes it. Part of the saved state. Set it before the first update, because its fetch
    /// applies to all weather that the timeline still knows.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_sea(&mut self, settings: Option<SeaSettings>) -> Result<()> {
        self.held.sea.set(settings, self.world.seed)
    }

    /// Returns the settings of the sea; `None` without a sea.
    pub fn sea(&self) -> Option<&SeaSettings> {
        self.held.sea.settings()
    }

    /// Writes the sea at each of `positions` and at simulation time `time_s`, past or future, into `points`. The height
    /// of a position has no influence. `shortest_wave_m`, [0, 1e4], leaves out shorter waves, and tiles that have only
    /// such waves; 0 leaves out none. [`SeaPoint::height_error_m`] says by how much the height may be off.
    ///
    /// The first query of a time sums the short waves (some milliseconds); the sums of the last two times are kept.
    /// Nothing is allocated after the first queries.
    ///
    /// # Errors
    /// [`crate::Status::WrongOrder`] without a sea; [`crate::Status::InvalidArgument`] if a position is not a place or
    /// `points` is of another length; for times as [`Context::conditions_at`]. `points` stays as it was then.
    pub fn sea_at(
        &self,
        positions: &[DVec3],
        time_s: f64,
        shortest_wave_m: f64,
        points: &mut [SeaPoint],
    ) -> Result<()> {
        check_range("shortest_wave_m", shortest_wave_m, 0.0, MOST_SHORTEST_M, "m")?;
        if points.len() != positions.len() {
            let accepted = format!("as long as positions, {}", positions.len());
            return Err(crate::Error::range("points", &accepted, points.len()));
        }
        for (i, position) in positions.iter().enumerate() {
            let named = |e: crate::Error| e.renamed("position", &format!("positions[{i}]"));
            self.world.frame.place_at("position", *position).map_err(named)?;
        }
        let surface = self.held.sea.surface(&self.world, time_s)?;
        for (position, point) in positions.iter().zip(points) {
            *point = surface.at(self.world.map_at(*position), shortest_wave_m);
        }
        Ok(())
    }

    /// Returns the statistics of the sea at simulation time `time_s`: heights, period, direction, slopes, whitecaps.
    ///
    /// # Errors
    /// [`crate::Status::WrongOrder`] without a sea; for times as [`Context::conditions_at`].
    pub fn sea_statistics(&self, time_s: f64) -> Result<SeaStatistics> {
        self.held.sea.statistics(&self.world, time_s)
    }
}
