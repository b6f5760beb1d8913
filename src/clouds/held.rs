//! Clouds of a context: the model that draws them, and the noise that gives them their shapes. The host's queries about
//! clouds read both.

use std::sync::{Arc, OnceLock};

use glam::DVec3;

use super::{
    drawn::{march::CloudRays, noise::CloudNoise},
    field::{layers::CloudLayers, overhead::LayersQuery, shape::Shape},
    light::shadow::sun_share,
    model::CloudModel,
};
use crate::{
    error::Result,
    moment::{Scene, WeatherOver},
    world::{HeldEffect, parse_error},
};

/// The clouds of a context.
#[derive(Clone, Default)]
pub(crate) struct HeldClouds {
    /// Model that draws the clouds.
    pub model: CloudModel,
    /// Noise that gives clouds their shapes, created at first use.
    grown: Arc<OnceLock<CloudNoise>>,
}

/// Table and key of the model in a saved state.
const TABLE: &str = "settings";
const KEY: &str = "clouds";

impl HeldClouds {
    /// Takes the model of clouds out of a saved state; the default if the state has none.
    ///
    /// # Errors
    /// [`crate::Status::Parse`] for a value that names no model.
    pub fn read(state: &mut toml::Table) -> Result<Self> {
        let settings = state.get_mut(TABLE).and_then(toml::Value::as_table_mut);
        let Some(value) = settings.and_then(|s| s.remove(KEY)) else { return Ok(Self::default()) };
        let model = value.try_into().map_err(|e| parse_error(format_args!("{KEY}: {e}")))?;
        Ok(Self { model, ..Self::default() })
    }

    /// Returns the share of the direct light that clouds let through to a scene's place, 0 to 1. The light is that of
    /// the sun or the moon, whichever is brighter. With [`CloudModel::Volume`] it is the share along the ray from the
    /// place to the light, with [`CloudModel::Deck`] the mean over all places. `eye` is the place in the host's world,
    /// m; `time_s` is the simulation time, s.
    ///
    /// # Errors
    /// [`crate::Status::OutOfMemory`] if there is no memory for the noise; [`WeatherOver::check_time`] refuses times
    /// for which the weather is not known.
    pub fn sun_share(
        &self,
        seed: u64,
        (scene, eye): (&Scene, DVec3),
        (weather, time_s): (&WeatherOver<'_>, f64),
    ) -> Result<f64> {
        if self.model == CloudModel::Deck {
            return Ok(scene.brighter().direct_share);
        }
        let grown = self.grown(seed)?;
        let query = LayersQuery { scene, eye, weather, time_s };
        let Some(overhead) = self.overhead(grown, &query)? else { return Ok(1.0) };
        Ok(sun_share((0..overhead.all().len()).map(|i| grown.field(&overhead, i)), scene))
    }

    /// Finds the layers of cloud over a scene's place; `None` without clouds, or if the model draws no volume.
    fn overhead(&self, grown: &CloudNoise, query: &LayersQuery<'_>) -> Result<Option<CloudLayers>> {
        let mut maps = grown.maps.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        let overhead = query.layers(self.model, &mut maps, Shape::of)?;
        Ok(overhead.filter(|o| !o.all().is_empty()))
    }

    /// Returns the noise, created from `seed` at the first call.
    fn grown(&self, seed: u64) -> Result<&CloudNoise> {
        if let Some(grown) = self.grown.get() {
            return Ok(grown);
        }
        let grown = CloudNoise::new(seed)?;
        Ok(self.grown.get_or_init(|| grown))
    }

    /// Returns the clouds around a scene's place; `None` without clouds, or if the model draws no volume. `eye` is the
    /// place in the host's world, m, and `radius_m` the radius of the planet.
    ///
    /// # Errors
    /// Errors of [`HeldClouds::sun_share`].
    pub fn rays(
        &self,
        seed: u64,
        (scene, eye): (&Scene, DVec3),
        (weather, time_s): (&WeatherOver<'_>, f64),
        radius_m: f64,
    ) -> Result<Option<CloudRays<'_>>> {
        let query = LayersQuery { scene, eye, weather, time_s };
        // A clear sky needs no noise.
        if query.is_clear() {
            return Ok(None);
        }
        let grown = self.grown(seed)?;
        let overhead = self.overhead(grown, &query)?;
        Ok(overhead.map(|overhead| CloudRays::new(&overhead, grown, scene, radius_m.min(1e9))))
    }
}

impl HeldEffect for HeldClouds {
    fn save(&self, state: &mut toml::Table) -> Result<()> {
        if self.model == CloudModel::default() {
            return Ok(());
        }
        let settings = state.entry(TABLE).or_insert_with(|| toml::Table::new().into());
        if let Some(settings) = settings.as_table_mut() {
            settings.insert(KEY.into(), self.model.name().into());
        }
        Ok(())
    }
}
