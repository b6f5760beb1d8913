//! Kinds of pixels for the draws of the composition, and the depth that represents each kind.

use crate::gpu::pass::depth_test;

/// Format of the depth attachment; it holds the kinds' values exactly.
pub(in crate::frame) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Pixels that a draw of the composition changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::frame) enum Pixels {
    /// All pixels.
    All,
    /// Pixels that are not interpolated from the coarse grid.
    Uneven,
    /// Pixels at the far depth, above the level of the eye: sky.
    Above,
    /// Pixels at the far depth, below the level of the eye: the planet's own ground and, for a high camera, the sky
    /// just above it.
    Below,
    /// Pixels on which the host drew.
    Drawn,
    /// Pixels interpolated from the coarse grid ([`super::even`]).
    Even,
    /// Pixels of [`Pixels::Even`] on which the host drew, if they have a draw of their own
    /// ([`draws_apart`](super::kinds::draws_apart)).
    EvenDrawn,
    /// No pixels of the picture, but the texels of the coarse grid.
    Grid,
}

impl Pixels {
    /// Returns the depth that represents the kind (`shaders/frame/kinds.wgsl`) and the test that passes only for this
    /// kind; `None` for [`Pixels::All`] and [`Pixels::Grid`].
    pub fn test(self) -> Option<(f64, wgpu::DepthStencilState)> {
        let depth = match self {
            Self::All | Self::Grid => return None,
            Self::Above => 0.0,
            Self::Even => 0.25,
            Self::Below => 0.5,
            Self::EvenDrawn => 0.75,
            Self::Drawn | Self::Uneven => 1.0,
        };
        Some((depth, depth_test(FORMAT, wgpu::CompareFunction::Equal, false)))
    }

    /// Whether the pixels are interpolated from the coarse grid.
    pub fn are_even(self) -> bool {
        matches!(self, Self::Even | Self::EvenDrawn)
    }

    /// Whether the draw writes the grid or reads it.
    pub fn uses_grid(self) -> bool {
        self == Self::Grid || self.are_even()
    }

    /// Returns the depth and test of the draw that writes the kinds.
    pub fn writes() -> (f64, wgpu::DepthStencilState) {
        (0.0, depth_test(FORMAT, wgpu::CompareFunction::Always, true))
    }
}
