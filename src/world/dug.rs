//! Dug ground of a world, in the form that effects exchange: which heights have changed, and how wet that ground is.

use std::collections::BTreeMap;

use crate::terrain::CellRect;

/// Time between two exchanges of the ground's wetness, s. The exchanges take place at whole multiples of this time.
pub(crate) const DUG_WATER_S: f64 = 60.0;

/// Number of cells along a side of a patch of dug ground; a tile's side is a multiple of it.
pub(crate) const DUG_SIDE: i32 = 16;

/// Dug ground of a world.
#[derive(Clone, Debug, Default)]
pub(crate) struct DugGround {
    /// Rectangles of the terrain in which heights have changed since the water was last updated.
    pub changes: Vec<CellRect>,
    /// Patches that were dug: position east and north, in units of a patch's side.
    pub patches: Vec<[i32; 2]>,
    /// Simulated water, once there is any.
    pub water: Option<DugWater>,
}

/// Water in the pores of the ground, as shares of the water that full pores hold.
#[derive(Clone, Debug, Default)]
pub(crate) struct DugWater {
    /// Simulation time, s: a whole multiple of [`DUG_WATER_S`].
    pub time_s: f64,
    /// Share on level, open ground.
    pub level: f64,
    /// Mean share of each patch that was dug.
    pub patches: BTreeMap<[i32; 2], f64>,
}
