//! The stars by their name.

use crate::{
    context::Context,
    error::Result,
    stars::{HeldStars, StarSettings},
};

impl Context {
    /// Sets how the night sky is drawn: the host's own stars, how they are turned, planets, airglow. All but the list of stars is part of
    /// the saved state; one that loads a state keeps its own.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_stars(&mut self, settings: StarSettings) -> Result<()> {
        settings.validate()?;
        self.held.stars = HeldStars { settings };
        self.world.night = self.held.stars.night();
        Ok(())
    }

    /// How the night sky is drawn.
    pub fn stars(&self) -> &StarSettings {
        &self.held.stars.settings
    }
}
