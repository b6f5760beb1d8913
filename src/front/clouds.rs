//! The clouds by their name.

use glam::DVec3;

use crate::{
    clouds::{CloudModel, CloudRays},
    context::{Context, Scene},
    error::Result,
    weather::CloudMap,
};

impl Context {
    /// Sets how clouds are drawn; part of the saved state. Default [`CloudModel::Volume`]. Light on the mean,
    /// conditions and what falls do not change with it; [`Context::sun_share`] does.
    pub fn set_cloud_model(&mut self, model: CloudModel) {
        self.held.clouds.model = model;
    }

    /// How clouds are drawn.
    pub fn cloud_model(&self) -> CloudModel {
        self.held.clouds.model
    }

    /// Lays a map on layers of cloud, in place of the one before: where over the ground they stand ([`CloudMap`]);
    /// `None` takes it off. It holds in pictures, shadows and questions, and in the light of a place
    /// ([`Context::light_at`]); what falls does not change with it. With [`CloudModel::Deck`] it holds for light alone.
    /// Clouds change at once. Part of the saved state.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_cloud_map(&mut self, map: Option<CloudMap>) -> Result<()> {
        self.world.set_cloud_map(map)?;
        self.refresh()
    }

    /// The map that is laid on layers of cloud.
    pub fn cloud_map(&self) -> Option<&CloudMap> {
        self.world.set.cloud_map.as_deref()
    }

    /// The share of the direct light of sun or moon, whichever is brighter, that clouds let through to `position` at
    /// simulation time `time_s`, 0 to 1: in the shadow of a cloud that [`CloudModel::Volume`] draws, or between two.
    /// The light of [`Context::light_at`] is that on the mean over places: times this over
    /// [`Light::direct_share`](crate::moment::Light::direct_share), its sun is that of the very place. With
    /// [`CloudModel::Deck`] the mean itself.
    ///
    /// The first question makes the field that clouds are cut out of, in some tenths of a second.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is no place; for times as [`Context::conditions_at`].
    pub fn sun_share(&self, position: DVec3, time_s: f64) -> Result<f64> {
        let scene = self.scene_at(position, time_s)?;
        self.held.clouds.sun_share(self.world.seed, (&scene, position), (&self.world.over(), time_s))
    }

    /// The clouds about the place of a scene, where they are drawn as a volume.
    pub(super) fn cloud_rays(&self, (scene, position): (&Scene, DVec3), time_s: f64) -> Result<Option<CloudRays<'_>>> {
        if self.held.clouds.model == CloudModel::Deck {
            return Ok(None);
        }
        let radius_m = self.world.set.planet.bottom_radius_m;
        self.held.clouds.rays(self.world.seed, (scene, position), (&self.world.over(), time_s), radius_m)
    }
}
