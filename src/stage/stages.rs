//! Stages of a frame, as a set.

use crate::error::{Error, Result};

/// The stages of a frame, in the order in which a host interleaves them with its own drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Stages(pub u32);

impl Stages {
    /// Tables and simulation textures; needs no target.
    pub const PREPARE: Self = Self(1);
    /// Sky behind everything: fills pixels at the far depth, or all pixels where there is no depth.
    pub const BACKGROUND: Self = Self(2);
    /// Wet surfaces, later white ones, sea and terrain; after the host's opaque objects.
    pub const SURFACE: Self = Self(4);
    /// Fog and aerial perspective on all that the host drew.
    pub const MEDIUM: Self = Self(8);
    /// Rain, snow and dust.
    pub const PARTICLES: Self = Self(16);
    /// Water on the windscreen.
    pub const LENS: Self = Self(32);
    /// Exposure, tone curve, display encoding and dither of a scene-linear picture. Nothing in the other colour spaces,
    /// where the host has done that.
    pub const TONE: Self = Self(64);
    /// Everything at once.
    pub const ALL: Self = Self(127);

    /// Whether any stage of `other` is in the set.
    pub fn has(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether any of them may draw into the target.
    pub(crate) fn draw(self) -> bool {
        self.without(Self::PREPARE) != Self(0)
    }

    /// This set without `other`.
    pub fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Both sets.
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The stages of this set that draw over the whole picture, one by one in their order; empty ones among them.
    pub(crate) fn each(self) -> [Self; 5] {
        [Self::BACKGROUND, Self::SURFACE, Self::MEDIUM, Self::PARTICLES, Self::TONE].map(|stage| Self(self.0 & stage.0))
    }

    /// Checks a mask from outside.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if it is empty or has unknown bits.
    pub fn from_bits(bits: u32) -> Result<Self> {
        if bits == 0 || bits & !Self::ALL.0 != 0 {
            return Err(Error::range("stages", "a non-empty mask of WK_STAGE_ bits (0x7f)", format!("{bits:#x}")));
        }
        Ok(Self(bits))
    }
}
