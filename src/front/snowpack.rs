//! Lying snow: queries, clearing, and fast-forward.

use glam::DVec3;

use crate::{
    context::Context,
    error::{Error, Result, Status, check_range},
    snowpack::{SnowAt, SnowBalance, SnowStrip},
};

/// Longest time of one fast-forward, hours.
const MOST_HOURS: f64 = 720.0;

impl Context {
    /// Returns the snow at `position` as of [`Context::state_time_s`]. On the host's terrain and up to 3 m above the
    /// terrain, the snow is interpolated between cells. Elsewhere it is that of level, open ground.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] if the position is invalid.
    pub fn snow_at(&self, position: DVec3) -> Result<SnowAt> {
        self.held.snowpack.at(&self.world, position)
    }

    /// Returns the mass balance of the snow on the host's terrain, kg; `None` without a terrain or without simulated
    /// snow.
    pub fn snow_balance(&self) -> Option<SnowBalance> {
        self.held.snowpack.books()
    }

    /// Returns how much of the state's time was simulated in steps of ten minutes, s: by [`Context::accumulate`], or by
    /// an update over more than a day. 0 if every step was an ordinary one.
    pub fn snow_fast_forwarded_s(&self) -> f64 {
        self.held.snowpack.coarse_s()
    }

    /// Removes the snow of a strip of the host's terrain, except the lowest `left_m` metres, \[0, 100\]: a plough, a
    /// shovel. Returns the removed mass, kg.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the field; [`Status::WrongOrder`] without a terrain or without simulated snow
    /// ([`LyingSnowModel::Simulated`](crate::snowpack::LyingSnowModel::Simulated)), and while steps of an update
    /// remain.
    pub fn take_snow(&mut self, strip: &SnowStrip, left_m: f64) -> Result<f64> {
        self.check_advanced()?;
        self.change_snow(|held, world| held.take(world, strip, left_m))
    }

    /// Compacts the snow of a strip of the host's terrain to 500 kg/m^3 where it is less dense: a wheel's track.
    ///
    /// # Errors
    /// As [`Context::take_snow`].
    pub fn press_snow(&mut self, strip: &SnowStrip) -> Result<()> {
        self.check_advanced()?;
        self.change_snow(|held, world| held.press(world, strip))
    }

    /// Changes the lying snow, and publishes it to the world.
    fn change_snow<T>(
        &mut self,
        act: impl FnOnce(&mut crate::snowpack::HeldSnow, &crate::world::World) -> Result<T>,
    ) -> Result<T> {
        let done = act(&mut self.held.snowpack, &self.world)?;
        crate::world::HeldEffect::publish(&mut self.held.snowpack, &mut self.world);
        Ok(done)
    }

    /// Advances time by `hours`, (0, 720], with the snow in steps of ten minutes, for a scene that begins after a
    /// night's snowfall. The laws are those of ordinary steps. The state differs from that of ordinary steps by up to
    /// some percent, and records the time simulated this way ([`Context::snow_fast_forwarded_s`]). Everything else
    /// advances as by [`Context::update`].
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] if `hours` or the new time is out of range; [`Status::WrongOrder`] while steps of an
    /// update remain.
    pub fn accumulate(&mut self, hours: f64) -> Result<()> {
        if hours.is_nan() || hours <= 0.0 {
            return Err(Error::range("hours", "in (0, 720]", hours));
        }
        check_range("hours", hours, 0.0, MOST_HOURS, "")?;
        self.check_advanced()?;
        self.held.snowpack.is_fast = true;
        let advanced = self.update(self.world.time_s + 3600.0 * hours);
        self.held.snowpack.is_fast = false;
        advanced
    }

    /// Checks that no steps of an update remain.
    pub(super) fn check_advanced(&self) -> Result<()> {
        let wanted = "this comes after an update has done all of its steps";
        if self.is_behind() { Err(Error::new(Status::WrongOrder, wanted)) } else { Ok(()) }
    }
}
