//! State of the night sky that a context holds: its settings. The host's own stars are no part of a saved state; a
//! context that loads one keeps those that it has.

use std::sync::Arc;

use glam::DMat3;
use serde::{Deserialize, Serialize};

use super::{NightSky, Star, StarSettings, places::to_world_and_sun};
use crate::{
    almanac::Utc,
    error::{Error, Result, Status},
    scene::Place,
    world::{HeldEffect, NightSettings, parse_error},
};

/// The night sky of a context.
#[derive(Clone, Default)]
pub(crate) struct HeldStars {
    pub settings: StarSettings,
}

/// The settings as a saved state has them.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedStars {
    planets: bool,
    airglow: f64,
    /// Columns.
    celestial_to_world: Option<[[f64; 3]; 3]>,
}

/// Where they are in a saved state.
const TABLE: &str = "settings";
const KEY: &str = "stars";

impl HeldStars {
    /// Takes its part out of a saved state; the stars are those given.
    ///
    /// # Errors
    /// [`Status::Parse`] for what are no such settings.
    pub fn read(state: &mut toml::Table, stars: Option<Arc<[Star]>>) -> Result<Self> {
        let settings = state.get_mut(TABLE).and_then(toml::Value::as_table_mut);
        let Some(value) = settings.and_then(|s| s.remove(KEY)) else {
            return Ok(Self { settings: StarSettings { stars, ..StarSettings::default() } });
        };
        let saved: SavedStars = value.try_into().map_err(|e| parse_error(format_args!("{KEY}: {e}")))?;
        let celestial_to_world = saved.celestial_to_world.map(|m| DMat3::from_cols_array_2d(&m));
        let settings = StarSettings { stars, planets: saved.planets, celestial_to_world, airglow: saved.airglow };
        settings.validate().map_err(|e| e.found_in("saved state"))?;
        Ok(Self { settings })
    }

    /// Returns the settings of the night's light on the ground.
    pub fn night(&self) -> NightSettings {
        NightSettings { airglow: self.settings.airglow, celestial_to_world: self.settings.celestial_to_world }
    }
}

impl HeldEffect for HeldStars {
    fn save(&self, state: &mut toml::Table) -> Result<()> {
        let StarSettings { planets, celestial_to_world, airglow, .. } = self.settings;
        if self.night() == NightSettings::default() && planets {
            return Ok(());
        }
        let saved =
            SavedStars { planets, airglow, celestial_to_world: celestial_to_world.map(|m| m.to_cols_array_2d()) };
        let written = |e| Error::new(Status::Internal, format!("the state cannot be written: {e}"));
        let value = toml::Value::try_from(saved).map_err(written)?;
        let settings = state.entry(TABLE).or_insert_with(|| toml::Table::new().into());
        if let Some(settings) = settings.as_table_mut() {
            settings.insert(KEY.into(), value);
        }
        Ok(())
    }
}

/// Light of the moonless sky on level ground, lux a channel, where the air's optical depths straight up are
/// `zenith_depth`.
///
/// # Errors
/// [`Status::InvalidArgument`] for a time or place out of range.
pub(crate) fn night_lux(utc: Utc, place: &Place, zenith_depth: [f64; 3], set: &NightSettings) -> Result<[f64; 3]> {
    let (to_world, sun) = to_world_and_sun(utc, place, set.celestial_to_world)?;
    Ok(NightSky::under(&to_world, sun, place.altitude_m, zenith_depth, set.airglow).level_lux())
}
