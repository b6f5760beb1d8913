//! Material of the ground.

use crate::error::{Error, Result};

/// Material of the ground. The C header, terrains and images use the same numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[repr(u8)]
pub enum SurfaceClass {
    /// No class given. In a terrain or an image it means the context's default. As the context's default it means
    /// natural ground: vegetation where the host's colour is green, otherwise soil.
    #[default]
    Unspecified = 0,
    /// Earth, sand, gravel: darkens when wet, and hardly reflects.
    Soil = 1,
    /// Bare rock: darkens when wet, and shines in places.
    Rock = 2,
    /// Asphalt, concrete, paving: darkens when wet, gets a reflecting water film, and puddles.
    Paved = 3,
    /// Grass, crops, shrubs, trees: hardly changes when wet.
    Vegetation = 4,
    /// Water that the host draws: rain does not change it.
    Water = 5,
    /// Roofs and walls: darken and shine when wet, without puddles.
    Building = 6,
}

/// Number of classes.
pub(crate) const CLASSES: usize = 7;
/// Value that stands instead of a class number for a cell without ground.
pub(crate) const HOLE: u8 = 255;

impl SurfaceClass {
    /// All classes, in the order of their numbers.
    pub const ALL: [Self; CLASSES] =
        [Self::Unspecified, Self::Soil, Self::Rock, Self::Paved, Self::Vegetation, Self::Water, Self::Building];

    /// Returns the class with this number.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming `param` for a number above 6.
    pub fn from_number(param: &str, number: u8) -> Result<Self> {
        let known = Self::ALL.get(usize::from(number)).copied();
        known.ok_or_else(|| Error::range(param, "a WK_SURFACE_CLASS_ value, 0 to 6", number))
    }

    /// Returns this class, or `other` if this one is unspecified.
    pub fn or(self, other: Self) -> Self {
        if self == Self::Unspecified { other } else { self }
    }
}
