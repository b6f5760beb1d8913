//! Clouds: their model, their map, and the share of direct light at a place.

use glam::DVec3;

use crate::{
    clouds::{CloudModel, CloudRays},
    context::{Context, Scene},
    error::Result,
    weather::CloudMap,
};

impl Context {
    /// Sets how clouds are drawn; part of the saved state. Default [`CloudModel::Volume`]. The mean light, the
    /// conditions and the precipitation do not depend on it. [`Context::sun_share`], [`Context::sky_radiance`],
    /// [`Context::between`] and [`Context::visibility_toward`] do.
    pub fn set_cloud_model(&mut self, model: CloudModel) {
        self.held.clouds.model = model;
    }

    /// Returns how clouds are drawn.
    pub fn cloud_model(&self) -> CloudModel {
        self.held.clouds.model
    }

    /// Sets a map of where cloud layers stand over the ground ([`CloudMap`]), in place of the one before; `None`
    /// removes the map. The map affects pictures, shadows, and queries of light, radiance and visibility, but neither
    /// the precipitation nor the conditions ([`Context::conditions_at`]). With [`CloudModel::Deck`] it affects only the
    /// light. Clouds change at once. Part of the saved state.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_cloud_map(&mut self, map: Option<CloudMap>) -> Result<()> {
        self.world.set_cloud_map(map)?;
        self.refresh()
    }

    /// Returns the map of cloud cover; `None` without one.
    pub fn cloud_map(&self) -> Option<&CloudMap> {
        self.world.set.cloud_map.as_deref()
    }

    /// Returns the share of the direct light of the sun or the moon, whichever is brighter, that clouds let through to
    /// `position` at simulation time `time_s`, 0 to 1. The share is low in the shadow of a cloud that
    /// [`CloudModel::Volume`] draws, and high between two clouds. The light of [`Context::light_at`] contains the mean
    /// of this share over all places, [`Light::direct_share`](crate::moment::Light::direct_share). To get the direct
    /// sunlight at `position`, replace the mean: `sun_lux / direct_share * share`. With [`CloudModel::Deck`] the share
    /// is the mean itself.
    ///
    /// The first call builds the noise field from which clouds are cut, which takes some tenths of a second.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is invalid; for times as [`Context::conditions_at`];
    /// [`crate::Status::OutOfMemory`] if there is no memory for the noise field.
    pub fn sun_share(&self, position: DVec3, time_s: f64) -> Result<f64> {
        let scene = self.scene_at(position, time_s)?;
        self.held.clouds.sun_share(self.world.seed, (&scene, position), (&self.world.over(), time_s))
    }

    /// Returns the clouds around the place of a scene if they are drawn as a volume.
    pub(super) fn cloud_rays(&self, (scene, position): (&Scene, DVec3), time_s: f64) -> Result<Option<CloudRays<'_>>> {
        if self.held.clouds.model == CloudModel::Deck {
            return Ok(None);
        }
        let radius_m = self.world.set.planet.bottom_radius_m;
        self.held.clouds.rays(self.world.seed, (scene, position), (&self.world.over(), time_s), radius_m)
    }
}
