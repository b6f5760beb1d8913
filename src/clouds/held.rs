//! What a context holds of the clouds: how they are drawn.

use super::CloudModel;
use crate::{
    error::Result,
    world::{HeldEffect, parse_error},
};

/// The clouds of a context.
#[derive(Clone, Copy, Default)]
pub(crate) struct HeldClouds {
    pub model: CloudModel,
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
        Ok(Self { model })
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
