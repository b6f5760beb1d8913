//! Set of the stages of a frame.

use crate::error::{Error, Result};

/// Set of stages of a frame. The bits are in the order in which a host interleaves the stages with its own drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Stages(pub u32);

impl Stages {
    /// Tables and simulation textures; needs no target.
    pub const PREPARE: Self = Self(1);
    /// Sky behind everything. Fills the pixels at the far depth, or all pixels if the frame has no depth texture.
    pub const BACKGROUND: Self = Self(2);
    /// Water and snow on surfaces, shadows of clouds, and the sea and terrain that Welkin draws; after the host's
    /// opaque objects.
    pub const SURFACE: Self = Self(4);
    /// Air, fog and distant precipitation in front of everything drawn so far, and clouds in front of what the host
    /// drew.
    pub const MEDIUM: Self = Self(8);
    /// Rain, hail and snow near the camera, and the channels of lightning flashes.
    pub const PARTICLES: Self = Self(16);
    /// Water and snow on the windscreen.
    pub const LENS: Self = Self(32);
    /// Exposure, tone curve, display encoding and dither of a scene-linear picture. Does nothing in the other colour
    /// spaces, where the host has tone-mapped the picture.
    pub const TONE: Self = Self(64);
    /// All stages.
    pub const ALL: Self = Self(127);

    /// Whether any stage of `other` is in this set.
    pub fn has(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether any stage of this set may draw into the target.
    pub(crate) fn draw(self) -> bool {
        self.without(Self::PREPARE) != Self(0)
    }

    /// This set without the stages of `other`.
    pub fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Set of all stages that are in this set or in `other`.
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Splits this set into one set for each of the five stages that draw over the whole picture, in order. The set of
    /// a stage that this set lacks is empty.
    pub(crate) fn each(self) -> [Self; 5] {
        [Self::BACKGROUND, Self::SURFACE, Self::MEDIUM, Self::PARTICLES, Self::TONE].map(|stage| Self(self.0 & stage.0))
    }

    /// Checks a bit mask from the host.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the mask is empty or has unknown bits.
    pub fn from_bits(bits: u32) -> Result<Self> {
        if bits == 0 || bits & !Self::ALL.0 != 0 {
            return Err(Error::range("stages", "a non-empty mask of WK_STAGE_ bits (0x7f)", format!("{bits:#x}")));
        }
        Ok(Self(bits))
    }
}
