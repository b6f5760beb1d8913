//! Place of the eye over a terrain's lattice, in whole cells and a rest that single precision holds.

use glam::DVec3;

/// Place of the eye over a terrain's lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LandEye {
    /// Cells east and north of the origin, and metres above it.
    pub place: DVec3,
    /// Cell of the lattice below the eye.
    pub cell: [i32; 2],
}

impl LandEye {
    pub fn new(place: DVec3) -> Self {
        Self { place, cell: [place.x.floor() as i32, place.y.floor() as i32] }
    }

    /// Place of the eye in the cell, and its height as a sum of two floats.
    pub fn uniform(&self) -> [f32; 4] {
        let part = [0, 1].map(|i| (self.place[i] - f64::from(self.cell[i])) as f32);
        let height = self.place.z as f32;
        [part[0], part[1], height, (self.place.z - f64::from(height)) as f32]
    }
}
