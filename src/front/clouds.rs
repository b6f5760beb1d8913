//! The clouds by their name.

use crate::{
    clouds::{CloudModel, HeldClouds},
    context::Context,
};

impl Context {
    /// Sets how clouds are drawn; part of the saved state. Default [`CloudModel::Deck`]. Light, queries and what falls do not change with
    /// it.
    pub fn set_cloud_model(&mut self, model: CloudModel) {
        self.held.clouds = HeldClouds { model };
    }

    /// How clouds are drawn.
    pub fn cloud_model(&self) -> CloudModel {
        self.held.clouds.model
    }
}
