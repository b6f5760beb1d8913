//! Settings of the drawn terrain.

use crate::error::{Error, Result, check_range};

/// Settings with which a context's views draw the tiles of its terrain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TerrainDrawing {
    /// Accepted vertical error of the drawn triangles, pixels, \[0.25, 16\], default 1. It sets how far each level of
    /// detail reaches, between 40 and 160 sides of the level's squares, so that 99.7 % of the ground is within this
    /// error. Ground so rough that a level would have to reach farther than 160 sides is drawn with a larger error.
    pub error_px: f64,
    /// Distance from the camera up to which the ground has shadows of the sun and the moon, m: 0 for none, or \[100,
    /// 1e5\], default 1e4. The shorter the distance, the sharper the near shadows. The shadow maps take up to 34 MB of
    /// GPU memory in each view.
    pub shadows_to_m: f64,
}

impl Default for TerrainDrawing {
    fn default() -> Self {
        Self { error_px: 1.0, shadows_to_m: 1e4 }
    }
}

impl TerrainDrawing {
    /// Checks that every field is within its range.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        check_range("terrain_drawing.error_px", self.error_px, 0.25, 16.0, "px")?;
        if self.shadows_to_m == 0.0 || (100.0..=1e5).contains(&self.shadows_to_m) {
            return Ok(());
        }
        Err(Error::range("terrain_drawing.shadows_to_m", "0 or in [100, 100000] m", self.shadows_to_m))
    }
}
