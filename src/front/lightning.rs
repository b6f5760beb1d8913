//! The lightning by its name.

use glam::DVec3;

use crate::{
    context::Context,
    error::Result,
    lightning::{self, FlashEvent, FlashTrigger, LightningLight, LightningSettings},
};

impl Context {
    /// Sets how often it flashes, where, and how flashes are drawn; part of the saved state. Flashes are a function of
    /// seed, time, rate and cells: another rate adds and takes flashes, and moves none.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_lightning(&mut self, settings: LightningSettings) -> Result<()> {
        settings.validate()?;
        self.held.lightning.settings = settings;
        self.held.lightning.revision += 1;
        Ok(())
    }

    /// How often it flashes, where, and how flashes are drawn.
    pub fn lightning(&self) -> &LightningSettings {
        &self.held.lightning.settings
    }

    /// Triggers a flash, whatever the weather; part of the saved state. It is kept until 120 s after it.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field, or for more than [`lightning::MAX_TRIGGERED`] at a time;
    /// [`crate::Status::WrongOrder`] for a time before the present. Nothing changes then.
    pub fn trigger_flash(&mut self, flash: &FlashTrigger) -> Result<()> {
        self.held.lightning.trigger(flash, self.world.time_s)
    }

    /// The flashes that begin from `from_s` on until `until_s` (an hour at most) and lie within `most_distance_m` (50
    /// km at most, on the map) of a place, in order of time: past or to come. Where the timeline has forgotten the
    /// weather of then, that of the first moment that it knows counts.
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

    /// Light of flashes at a place, on the mean of `exposure_s` (1 s at most) before `time_s`; with 0 that of the very
    /// moment. A host that lights its own ground by it asks for the time of its frame.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the parameter.
    pub fn lightning_at(&self, position: DVec3, time_s: f64, exposure_s: f64) -> Result<LightningLight> {
        lightning::light_at(&self.world, &self.held.lightning, position, time_s, exposure_s)
    }
}
