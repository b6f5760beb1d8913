//! Solid noise that frays the edges of clouds.

use glam::DVec3;

use super::map::wrapped;
use crate::{
    error::Result,
    noise::{NoiseImage, NoiseKind, NoiseSettings},
};

/// Texels along a side of the solid noise.
pub(crate) const SOLID_SIZE: u32 = 64;

/// Returns the settings of the solid noise.
pub(crate) fn solid_settings(seed: u64) -> NoiseSettings {
    NoiseSettings { kind: NoiseKind::Cellular, frequency: [4; 3], octaves: 3, amplitude: 0.5, persistence: 0.6, seed }
}

/// Solid noise, one byte a texel.
pub struct Solid {
    /// Texels along a side.
    pub size: usize,
    /// Texels, east fastest.
    pub texels: Vec<u8>,
}

impl Solid {
    /// Creates the noise of a seed.
    ///
    /// # Errors
    /// [`crate::Status::OutOfMemory`] if there is no memory for the noise.
    pub fn new(seed: u64) -> Result<Self> {
        let image = NoiseImage::generate([SOLID_SIZE; 3], &solid_settings(seed))?;
        Ok(Self { size: SOLID_SIZE as usize, texels: image.levels()[0].clone() })
    }

    /// Interpolates the texels at `place`, which is in periods. Returns 0 to 1.
    pub fn at(&self, place: DVec3) -> f64 {
        let [x, y, z] = [place.x, place.y, place.z].map(|v| wrapped(v, self.size));
        let texel = |i: usize, j: usize, k: usize| f64::from(self.texels[(k * self.size + j) * self.size + i]) / 255.0;
        let row = |j: usize, k: usize| texel(x.0, j, k) * (1.0 - x.2) + texel(x.1, j, k) * x.2;
        let sheet = |k: usize| row(y.0, k) * (1.0 - y.2) + row(y.1, k) * y.2;
        sheet(z.0) * (1.0 - z.2) + sheet(z.1) * z.2
    }
}
