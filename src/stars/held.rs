//! State of the night sky in a context: its settings. The host's own stars are not saved; a context that loads a state
//! keeps the stars that it has.

use std::sync::Arc;

use glam::DMat3;
use serde::{Deserialize, Serialize};

use super::{NightSky, Star, StarSettings, catalogue, places::to_world_and_sun};
use crate::{
    almanac::Utc,
    error::{Error, Result, Status},
    scene::Place,
    world::{HeldEffect, NightSettings, parse_error},
};

/// State of the night sky of a context.
#[derive(Clone, Default)]
pub(crate) struct HeldStars {
    pub settings: StarSettings,
    /// Magnitude of the brightest of the host's own stars, infinite for an empty list; `None` with the catalogue.
    own_magnitude: Option<f64>,
}

/// Settings in the form of a saved state.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedStars {
    planets: bool,
    airglow: f64,
    /// Columns of the matrix.
    celestial_to_world: Option<[[f64; 3]; 3]>,
}

/// Table and key of the settings in a saved state.
const TABLE: &str = "settings";
const KEY: &str = "stars";

impl HeldStars {
    /// Creates the state with these settings.
    pub fn new(settings: StarSettings) -> Self {
        // A host's list has any order, and up to a million stars: too many to search in every frame.
        let brightest = |stars: &Arc<[Star]>| stars.iter().map(|s| s.magnitude).fold(f64::INFINITY, f64::min);
        let own_magnitude = settings.stars.as_ref().map(brightest);
        Self { settings, own_magnitude }
    }

    /// Returns the magnitude of the brightest star, infinite without stars.
    pub fn brightest_magnitude(&self) -> f64 {
        self.own_magnitude.unwrap_or_else(|| catalogue()[0].magnitude)
    }

    /// Removes the settings from a saved state and reads them. A state without them gives the defaults. `stars` are the
    /// host's own stars.
    ///
    /// # Errors
    /// [`Status::Parse`] for a value that is not a table of these settings; [`Status::InvalidArgument`] for a setting
    /// out of range.
    pub fn read(state: &mut toml::Table, stars: Option<Arc<[Star]>>) -> Result<Self> {
        let settings = state.get_mut(TABLE).and_then(toml::Value::as_table_mut);
        let Some(value) = settings.and_then(|s| s.remove(KEY)) else {
            return Ok(Self::new(StarSettings { stars, ..StarSettings::default() }));
        };
        let saved: SavedStars = value.try_into().map_err(|e| parse_error(format_args!("{KEY}: {e}")))?;
        let celestial_to_world = saved.celestial_to_world.map(|m| DMat3::from_cols_array_2d(&m));
        let settings = StarSettings { stars, planets: saved.planets, celestial_to_world, airglow: saved.airglow };
        settings.validate().map_err(|e| e.found_in("saved state"))?;
        Ok(Self::new(settings))
    }

    /// Returns the settings that affect the night's light on the ground.
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

/// Illuminance of level ground by the moonless sky, lux a channel; `zenith_depth` are the air's optical depths straight
/// up.
///
/// # Errors
/// [`Status::InvalidArgument`] for a time or place out of range.
pub(crate) fn night_lux(utc: Utc, place: &Place, zenith_depth: [f64; 3], set: &NightSettings) -> Result<[f64; 3]> {
    let (to_world, sun) = to_world_and_sun(utc, place, set.celestial_to_world)?;
    Ok(NightSky::under(&to_world, sun, place.altitude_m, zenith_depth, set.airglow).level_lux())
}
