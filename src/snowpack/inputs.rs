//! Inputs of a step of a field of snow: what falls, the wind, and the country about it.

use glam::DVec2;

use super::column::{Column, ColumnForcing, Settling};

/// Function that returns the forcing at a place of the lattice whose ground is so high, m.
pub(super) type FallsAt<'a> = &'a dyn Fn([i32; 2], f64) -> ColumnForcing;

/// The wind at 10 m over a place of the lattice whose snow reaches so high, m; m/s east and north.
pub(super) type CellWind<'a> = &'a dyn Fn([i32; 2], f64) -> DVec2;

/// The wind over a field at 10 m, m/s east and north.
#[derive(Clone, Copy)]
pub(super) struct FieldWind<'a> {
    pub mean: DVec2,
    /// Where it varies in space; else the surface's shape decides.
    pub local: Option<CellWind<'a>>,
}

/// Inputs of a step.
pub(super) struct SnowStep<'a> {
    pub seconds: f64,
    /// Forcing of all cells, and the function that replaces it where it varies from place to place.
    pub even: &'a ColumnForcing,
    pub falls: Option<FallsAt<'a>>,
    pub settling: &'a Settling,
    pub wind: FieldWind<'a>,
    /// The level, open country about the field, which drifting snow comes from.
    pub country: &'a Column,
    /// Steep snow slides in this step.
    pub slides: bool,
    /// Revision given to the patches that it changes.
    pub revision: u64,
}
