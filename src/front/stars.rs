//! Stars: settings of the night sky, and the faintest visible star.

use std::f64::consts::PI;

use glam::DVec3;

use crate::{
    context::Context,
    error::Result,
    light::luminance,
    stars::{HeldStars, StarSettings, limits::limiting_magnitude},
    world::zenith_depth,
};

impl Context {
    /// Sets how the night sky is drawn: the host's own stars and their rotation, planets, airglow. Everything except
    /// the list of stars is part of the saved state; a context that loads a state keeps its own list.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_stars(&mut self, settings: StarSettings) -> Result<()> {
        settings.validate()?;
        self.held.stars = HeldStars::new(settings);
        self.world.night = self.held.stars.night();
        Ok(())
    }

    /// Returns the catalogue magnitude of the faintest star that the naked eye sees straight up from `position` at
    /// simulation time `time_s`. It is [`limiting_magnitude`] for the sky's mean luminance, less the extinction by air,
    /// fog and clouds at 550 nm, in magnitudes. Pictures leave out stars by the same function. Negative infinity if no
    /// light comes through.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is invalid; for times as [`Context::conditions_at`].
    pub fn limiting_magnitude(&self, position: DVec3, time_s: f64) -> Result<f64> {
        let scene = self.scene_at(position, time_s)?;
        let altitude_m = scene.place.altitude_m;
        let fog = scene.fog_model(self.fog_law(), self.world.seed, self.world.set.planet.bottom_radius_m)?;
        let depth = zenith_depth(&scene.planet, altitude_m.max(0.0))[1] + fog.depth_above(altitude_m);
        let clouds = scene.conditions.zenith_light_over_land(altitude_m.max(0.0));
        let through = clouds.direct.clamp(0.0, 1.0) * (-depth).exp();
        let at_eye = limiting_magnitude(luminance(&scene.above_fog.sky_lux) / PI);
        Ok(at_eye + 2.5 * through.log10())
    }

    /// Returns the settings of the night sky.
    pub fn stars(&self) -> &StarSettings {
        &self.held.stars.settings
    }
}
