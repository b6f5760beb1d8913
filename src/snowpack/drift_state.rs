//! State of drifting snow: what crosses the borders of cells and patches with the wind, and the room for a sweep.

/// Snow and lee that cross a cell's border with the wind.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DriftFlux {
    /// Snow that hops and that is suspended, in units of mass.
    pub snow: [i64; 2],
    /// Height of the lee's line there, and of what casts it, m; none at the end of the ground.
    pub lee: Option<[f64; 2]>,
}

/// State of a sweep for a patch.
#[derive(Clone, Debug, Default)]
pub(super) struct Edges {
    /// Air that has left it down the wind: along each row to the east or west, along each column to the north or south.
    pub left: [Vec<DriftFlux>; 2],
    /// Wind over each cell: its parts along the sweep, m/s, or its speed over the mean wind's and nothing.
    pub wind: Vec<[f64; 2]>,
    /// The line of the calm before what stands to its lee, along each row and each column where the wind comes in: its
    /// height and that of what casts it, m. Empty where nothing stands.
    pub fronts: [Vec<Option<[f64; 2]>>; 2],
    /// Number of the sweep that it was in last.
    pub swept: u64,
    /// Snow may lie on it or come to it in this sweep; and some may lie to its lee.
    pub has_snow: bool,
    pub has_lee: bool,
}

/// Room for a sweep.
#[derive(Clone, Debug, Default)]
pub(super) struct DriftSweep {
    /// Numbers of the patches down the wind.
    pub order: Vec<u32>,
    /// Air that comes to a patch: along each row, and along each column.
    pub coming: [Vec<DriftFlux>; 2],
    /// Fronts of the patches to the lee: see [`Edges`].
    pub fronts: [Vec<Option<[f64; 2]>>; 2],
    pub sweeps: u64,
}
