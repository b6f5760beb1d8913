//! Material of the ground.

use crate::error::{Error, Result};

/// Material of the ground; the numbers are those of the C header, of terrains and of images.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[repr(u8)]
pub enum SurfaceClass {
    /// Not said. In a terrain or an image: as the context's default. As that default: natural ground, soil where the
    /// host's colour is not green and vegetation where it is.
    #[default]
    Unspecified = 0,
    /// Earth, sand, gravel: darkens, and mirrors hardly.
    Soil = 1,
    /// Bare rock: darkens, and shines in parts.
    Rock = 2,
    /// Asphalt, concrete, paving: darkens, gets a film that mirrors, and puddles.
    Paved = 3,
    /// Grass, crops, shrubs, trees: hardly changes.
    Vegetation = 4,
    /// Water that the host draws: rain leaves it as it is.
    Water = 5,
    /// Roofs and walls: darken and shine, without puddles.
    Building = 6,
}

/// How many there are.
pub(crate) const CLASSES: usize = 7;
/// In the place of a class's number: a cell without ground.
pub(crate) const HOLE: u8 = 255;

impl SurfaceClass {
    /// All of them, by their numbers.
    pub const ALL: [Self; CLASSES] =
        [Self::Unspecified, Self::Soil, Self::Rock, Self::Paved, Self::Vegetation, Self::Water, Self::Building];

    /// The class of this number.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming `param` for a number above 6.
    pub fn from_number(param: &str, number: u8) -> Result<Self> {
        let known = Self::ALL.get(usize::from(number)).copied();
        known.ok_or_else(|| Error::range(param, "a WK_SURFACE_CLASS_ value, 0 to 6", number))
    }

    /// This, or `other` where nothing is said.
    pub fn or(self, other: Self) -> Self {
        if self == Self::Unspecified { other } else { self }
    }
}
