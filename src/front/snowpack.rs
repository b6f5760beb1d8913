//! Lying snow by its name.

use glam::DVec3;

use crate::{
    context::Context,
    error::{Error, Result, Status, check_range},
    snowpack::{SnowAt, SnowBooks, SnowStrip},
};

/// Longest time that one call lays, hours.
const MOST_HOURS: f64 = 720.0;

impl Context {
    /// Snow at `position` as of [`Context::state_time_s`]: on the host's terrain, up to 3 m above it, that between its
    /// cells; elsewhere that of level, open ground.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] if the position is no place.
    pub fn snow_at(&self, position: DVec3) -> Result<SnowAt> {
        self.held.snowpack.at(&self.world, position)
    }

    /// Where the mass of the snow on the host's terrain came from and went, kg; `None` without a terrain or a simulated
    /// snow.
    pub fn snow_books(&self) -> Option<SnowBooks> {
        self.held.snowpack.books()
    }

    /// Time of the state that fast-forward has laid, s: 0 where every step was an ordinary one.
    pub fn snow_laid_fast_s(&self) -> f64 {
        self.held.snowpack.coarse_s()
    }

    /// Takes the snow of a strip of the host's terrain away but for the lowest `left_m`, \[0, 100\]: a plough, a
    /// shovel. Answers its mass, kg.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the field; [`Status::WrongOrder`] without a terrain or a simulated snow
    /// ([`LyingSnowModel::Simulated`](crate::snowpack::LyingSnowModel::Simulated)), and while steps of an update
    /// remain.
    pub fn take_snow(&mut self, strip: &SnowStrip, left_m: f64) -> Result<f64> {
        self.check_led()?;
        self.change_snow(|held, world| held.take(world, strip, left_m))
    }

    /// Presses the snow of a strip of the host's terrain to 500 kg/m^3, where it is less dense: a wheel's track.
    ///
    /// # Errors
    /// As [`Context::take_snow`].
    pub fn press_snow(&mut self, strip: &SnowStrip) -> Result<()> {
        self.check_led()?;
        self.change_snow(|held, world| held.press(world, strip))
    }

    fn change_snow<T>(
        &mut self,
        act: impl FnOnce(&mut crate::snowpack::HeldSnow, &crate::world::World) -> Result<T>,
    ) -> Result<T> {
        let done = act(&mut self.held.snowpack, &self.world)?;
        crate::world::HeldEffect::publish(&mut self.held.snowpack, &mut self.world);
        Ok(done)
    }

    /// Moves time on by `hours`, (0, 720], and lays the snow of that time by steps of ten minutes, so that a lesson may
    /// begin after a night's snowfall. Its laws are those of ordinary steps; the state differs from theirs by up to
    /// some percent, and remembers how much was laid so ([`Context::snow_laid_fast_s`]). All else is led as by
    /// [`Context::update`].
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] for another number of hours or a time beyond the range; [`Status::WrongOrder`] while
    /// steps of an update remain.
    pub fn accumulate(&mut self, hours: f64) -> Result<()> {
        if hours.is_nan() || hours <= 0.0 {
            return Err(Error::range("hours", "in (0, 720]", hours));
        }
        check_range("hours", hours, 0.0, MOST_HOURS, "")?;
        self.check_led()?;
        self.held.snowpack.is_fast = true;
        let led = self.update(self.world.time_s + 3600.0 * hours);
        self.held.snowpack.is_fast = false;
        led
    }

    fn check_led(&self) -> Result<()> {
        let wanted = "this comes after an update has done all of its steps";
        if self.is_behind() { Err(Error::new(Status::WrongOrder, wanted)) } else { Ok(()) }
    }
}
