//! Lightning: its settings, triggered flashes, and queries.

use glam::DVec3;

use crate::{
    context::Context,
    error::Result,
    lightning::{self, FlashEvent, FlashTrigger, LightningLight, LightningSettings},
};

impl Context {
    /// Sets how often and where lightning flashes, and how flashes are drawn; part of the saved state. Flashes are a
    /// function of seed, time, rate and cells: another rate adds or removes flashes, but moves none.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_lightning(&mut self, settings: LightningSettings) -> Result<()> {
        settings.validate()?;
        self.held.lightning.settings = settings;
        self.held.lightning.revision += 1;
        Ok(())
    }

    /// Returns the settings of lightning.
    pub fn lightning(&self) -> &LightningSettings {
        &self.held.lightning.settings
    }

    /// Triggers a flash in any weather; part of the saved state. The flash is kept until 120 s after it.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field, or for more than [`lightning::MAX_TRIGGERED`] at a time;
    /// [`crate::Status::WrongOrder`] for a time before the present. Nothing changes then.
    pub fn trigger_flash(&mut self, flash: &FlashTrigger) -> Result<()> {
        self.held.lightning.trigger(flash, self.world.time_s)
    }

    /// Returns the past or future flashes that begin between `from_s` and `until_s` (an hour at most), within
    /// `most_distance_m` (50 km at most, on the map) of a place, in order of time. For times that the timeline has
    /// forgotten, the weather is that of the earliest time that the timeline still knows.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the parameter.
    pub fn flashes_near(
        &self,
        position: DVec3,
        (from_s, until_s): (f64, f64),
        most_distance_m: f64,
    ) -> Result<Vec<FlashEvent>> {
        lightning::events(&self.world, &self.held.lightning, position, (from_s, until_s), most_distance_m)
    }

    /// Returns the light of flashes at a place, as the mean over `exposure_s` (1 s at most) before `time_s`; with 0 the
    /// light at `time_s`. A host that lights its own ground with this light passes the time of its frame.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the parameter.
    pub fn lightning_at(&self, position: DVec3, time_s: f64, exposure_s: f64) -> Result<LightningLight> {
        lightning::light_at(&self.world, &self.held.lightning, position, time_s, exposure_s)
    }
}
