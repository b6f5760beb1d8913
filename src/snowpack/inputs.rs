//! Inputs of a step of a snow field: precipitation, wind, and the open country around the field.

use glam::DVec2;

use super::column::{Column, ColumnForcing, Settling};

/// Function that returns the forcing at a cell of the lattice. Its arguments are the cell's index east and north, and
/// the height of the cell's ground above the terrain's origin, m.
pub(super) type FallsAt<'a> = &'a dyn Fn([i32; 2], f64) -> ColumnForcing;

/// Function that returns the wind at 10 m, m/s east and north, over a cell of the lattice. Its arguments are the cell's
/// index east and north, and the height of the snow's surface there above the terrain's origin, m.
pub(super) type CellWind<'a> = &'a dyn Fn([i32; 2], f64) -> DVec2;

/// Wind at 10 m over a field, m/s east and north.
#[derive(Clone, Copy)]
pub(super) struct FieldWind<'a> {
    /// Mean wind over the field.
    pub mean: DVec2,
    /// Wind over each cell, if the wind varies in space. With `None`, the drift derives the wind over each cell from
    /// `mean` and the surface's shape.
    pub local: Option<CellWind<'a>>,
}

/// Inputs of a step of a field.
pub(super) struct SnowStep<'a> {
    /// Length of the step, s.
    pub seconds: f64,
    /// Forcing of all cells.
    pub even: &'a ColumnForcing,
    /// Forcing of single cells, which replaces `even` if precipitation varies from place to place.
    pub falls: Option<FallsAt<'a>>,
    /// Settling in the step, by density.
    pub settling: &'a Settling,
    /// Wind over the field.
    pub wind: FieldWind<'a>,
    /// Snow of the level, open country around the field, from which snow drifts in.
    pub country: &'a Column,
    /// Whether steep snow slides in this step.
    pub slides: bool,
    /// Revision for the patches that change in this step.
    pub revision: u64,
}
