//! State of drifting snow: fluxes across the borders of cells and patches, and scratch space for a sweep.

/// Snow that crosses a cell's border with the wind, and the line of the lee there.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DriftFlux {
    /// Saltating and suspended snow, in units of mass.
    pub snow: [i64; 2],
    /// Height of the line below which the lee calms the wind, and height of the object that casts the lee, m. `None`
    /// without a line: at the edge of the ground, behind a patch that the sweep leaves out, and in a wind that varies
    /// in space.
    pub lee: Option<[f64; 2]>,
}

/// State of a patch in a sweep.
#[derive(Clone, Debug, Default)]
pub(super) struct Edges {
    /// Fluxes that have left the patch down the wind: along each row to the east or west, along each column to the
    /// north or south.
    pub left: [Vec<DriftFlux>; 2],
    /// Wind over each cell, as two numbers. In a wind that varies in space they are its components along rows and along
    /// columns, m/s, positive in the direction of the sweep and never negative. Otherwise they are the ratio of the
    /// wind over the cell to the mean wind, and 0.
    pub wind: Vec<[f64; 2]>,
    /// Lines below which obstacles to leeward calm the wind, where the wind enters each row and each column of the
    /// patch: height of the line and of the obstacle that casts it, m. Empty without such lines.
    pub fronts: [Vec<Option<[f64; 2]>>; 2],
    /// Number of the last sweep in which the patch took part.
    pub swept: u64,
    /// Whether snow may lie on the patch or reach it in this sweep.
    pub has_snow: bool,
    /// Whether snow may lie on a patch to leeward of this one.
    pub has_lee: bool,
}

/// Scratch space of a sweep.
#[derive(Clone, Debug, Default)]
pub(super) struct DriftSweep {
    /// Indices of the patches, from windward to leeward.
    pub order: Vec<u32>,
    /// Fluxes that enter a patch: along each row, and along each column.
    pub coming: [Vec<DriftFlux>; 2],
    /// Lines below which obstacles to leeward calm the wind, at the leeward border of the patch in work: for each row
    /// and each column, as in [`Edges::fronts`].
    pub fronts: [Vec<Option<[f64; 2]>>; 2],
    /// Number of sweeps so far.
    pub sweeps: u64,
}
