//! State of the fog in a context: the fog law that replaces the weather's fog, if the host has set one.

use super::layer::Law;
use crate::{
    error::{Error, Result, Status},
    world::{HeldEffect, parse_error},
};

/// Fog of a context.
#[derive(Clone, Default)]
pub(crate) struct HeldFog {
    /// Law that replaces the weather's fog; `None` draws the weather's fog.
    pub law: Option<Law>,
}

/// Table and key of the law in a saved state.
const TABLE: &str = "settings";
const KEY: &str = "fog_law";

impl HeldFog {
    /// Removes the law from a saved state and returns it.
    ///
    /// # Errors
    /// [`Status::Parse`] for an entry that is not a law; [`Status::InvalidArgument`] for a law with a value outside its
    /// range.
    pub fn read(state: &mut toml::Table) -> Result<Self> {
        let settings = state.get_mut(TABLE).and_then(toml::Value::as_table_mut);
        let Some(value) = settings.and_then(|s| s.remove(KEY)) else { return Ok(Self::default()) };
        let law: Law = value.try_into().map_err(|e| parse_error(format_args!("{KEY}: {e}")))?;
        law.validate().map_err(|e| e.found_in("saved state"))?;
        Ok(Self { law: Some(law) })
    }
}

impl HeldEffect for HeldFog {
    fn save(&self, state: &mut toml::Table) -> Result<()> {
        let Some(law) = &self.law else { return Ok(()) };
        let written = |e| Error::new(Status::Internal, format!("the state cannot be written: {e}"));
        let value = toml::Value::try_from(law).map_err(written)?;
        let settings = state.entry(TABLE).or_insert_with(|| toml::Table::new().into());
        if let Some(settings) = settings.as_table_mut() {
            settings.insert(KEY.into(), value);
        }
        Ok(())
    }
}
