//! What a context holds of the clouds: how they are drawn, and where they grow, for questions.

use std::sync::{Arc, OnceLock};

use glam::DVec2;

use super::{
    CloudModel,
    field::{Map, Shape, Solid},
    shadow::sun_share,
};
use crate::{
    error::Result,
    moment::Scene,
    world::{HeldEffect, parse_error},
};

/// The clouds of a context.
#[derive(Clone, Default)]
pub(crate) struct HeldClouds {
    pub model: CloudModel,
    /// What clouds are cut out of: made when it is first asked for.
    grown: Arc<OnceLock<(Map, Solid)>>,
}

/// Where they are in a saved state.
const TABLE: &str = "settings";
const KEY: &str = "clouds";

impl HeldClouds {
    /// Takes its part out of a saved state.
    ///
    /// # Errors
    /// [`crate::Status::Parse`] for what is no model.
    pub fn read(state: &mut toml::Table) -> Result<Self> {
        let settings = state.get_mut(TABLE).and_then(toml::Value::as_table_mut);
        let Some(value) = settings.and_then(|s| s.remove(KEY)) else { return Ok(Self::default()) };
        let model = value.try_into().map_err(|e| parse_error(format_args!("{KEY}: {e}")))?;
        Ok(Self { model, ..Self::default() })
    }

    /// The share of the direct light of the brighter of sun and moon that clouds let through to a scene's place: by the clouds that a
    /// volume draws there, or with a deck on the mean over places. The wind at 10 m has carried the air `drift_m` by `time_s`.
    ///
    /// # Errors
    /// As [`Solid::new`].
    pub fn sun_share(&self, seed: u64, scene: &Scene, (drift_m, time_s): (DVec2, f64)) -> Result<f64> {
        let c = &scene.conditions;
        if self.model == CloudModel::Deck {
            return Ok(scene.brighter().direct_share);
        }
        let (map, solid) = match self.grown.get() {
            Some(grown) => grown,
            None => {
                let grown = (Map::new(seed), Solid::new(seed)?);
                self.grown.get_or_init(|| grown)
            }
        };
        let slabs = c.cloud_slabs().filter(|s| s.cover > 0.0);
        Ok(sun_share(slabs.map(|slab| Shape::new(c, slab, drift_m, time_s)), map, solid, scene))
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
