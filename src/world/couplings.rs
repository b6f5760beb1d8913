//! Couplings: the functions by which the effects act on every world.

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

/// The cloud over rain areas as it stands over a place, `eye` in the host's world.
pub(crate) type CloudOverAreas =
    fn(&WeatherOver<'_>, &Conditions, (&LocalFrame, DVec3), f64) -> Result<Option<CloudSlab>>;

/// Light of the moonless sky on level ground at a time and place, lux, under air of given optical depths straight up.
pub(crate) type NightLux = fn(Utc, &Place, [f64; 3], &NightSettings) -> Result<[f64; 3]>;

/// Functions by which the effects act on every world.
#[derive(Clone, Copy)]
pub(crate) struct Couplings {
    /// Takes the light that the weather's low layer takes.
    pub dim: Dim,
    /// The cloud over rain areas that takes light from a place, with the part of the sky that it covers there.
    pub cloud_over_areas: CloudOverAreas,
    /// Light of the moonless sky on level ground, lux a channel, at a time and place where the air's optical depths
    /// straight up are given.
    pub night_lux: NightLux,
}
