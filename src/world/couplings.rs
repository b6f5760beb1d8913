//! Couplings: functions of effects that a world calls to compute light and clouds, without naming the effects.

use glam::DVec3;

use super::settings::NightSettings;
use crate::{
    almanac::Utc,
    error::Result,
    moment::{Scene, WeatherOver},
    scene::{LocalFrame, Place},
    weather::{CloudSlab, Conditions},
};

/// Function by which an effect changes the light of a scene.
pub(crate) type Dim = fn(&mut Scene) -> Result<()>;

/// Function that returns the cloud of rain areas above a place, at a time in seconds. The place is given in the
/// planet's and in the host's coordinates.
pub(crate) type CloudOverAreas =
    fn(&WeatherOver<'_>, &Conditions, (&LocalFrame, DVec3), f64) -> Result<Option<CloudSlab>>;

/// Function that returns the light of the moonless sky on level ground at a time and place, lux, under air of given
/// vertical optical depths.
pub(crate) type NightLux = fn(Utc, &Place, [f64; 3], &NightSettings) -> Result<[f64; 3]>;

/// Functions of effects that a world calls.
#[derive(Clone, Copy)]
pub(crate) struct Couplings {
    /// Dims a scene by the weather's low layer.
    pub dim: Dim,
    /// Returns the cloud of rain areas that dims a place, with the cloud's cover there.
    pub cloud_over_areas: CloudOverAreas,
    /// Returns the light of the moonless sky on level ground, lux per channel, at a time and place, under air of given
    /// vertical optical depths.
    pub night_lux: NightLux,
}
