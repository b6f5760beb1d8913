//! Settings of the drawn terrain.

use crate::error::{Result, check_range};

/// Settings with which a context's views draw the tiles of its terrain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TerrainDrawing {
    /// Vertical error of the drawn triangles within which 99.7 % of the ground stays, pixels, \[0.25, 16\], default 1.
    /// The error sets how far each level of detail reaches, between 40 and 160 sides of its squares; ground that is so
    /// rough that more would be needed is drawn with a larger error.
    pub error_px: f64,
}

impl Default for TerrainDrawing {
    fn default() -> Self {
        Self { error_px: 1.0 }
    }
}

impl TerrainDrawing {
    /// Checks that every field is within its range.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        check_range("terrain_drawing.error_px", self.error_px, 0.25, 16.0, "px")
    }
}
