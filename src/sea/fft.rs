//! Fourier transform of the tiles of waves.

pub(super) use crate::fourier::Complex;

/// Samples of a tile's side.
pub(super) const SIDE: usize = 128;

/// Transform of a tile.
pub(super) type Transform = crate::fourier::Transform<SIDE>;
