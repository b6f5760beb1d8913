//! Patch of ground: a rectangle of cells, the objects on them, and the snow on them.

use std::sync::OnceLock;

use super::{column::Column, drift_state::Edges};

/// Index that means no patch.
pub(super) const NONE: u32 = u32::MAX;

/// Rectangle of ground and the snow on it. Cells are in rows from the south, each from the west.
#[derive(Clone, Debug, Default)]
pub(super) struct Patch {
    /// Position on the lattice, in patches east and north.
    pub key: [i32; 2],
    /// Revision of the host's tile from which the ground was taken.
    pub tile_revision: u64,
    /// Height of each cell above the origin of the host's terrain, m. Empty until the ground is known.
    pub heights_m: Vec<f32>,
    /// Lowest height of a cell, m.
    pub lowest_m: f64,
    /// Whether each cell is a hole in the ground; empty if there are no holes.
    pub holes: Vec<bool>,
    /// Number of cells with ground.
    pub ground_cells: usize,
    /// Height of the object that stops the wind on each cell, m; 0 without one. Empty if there are no objects.
    pub obstacles_m: Vec<f64>,
    /// Whether each cell is sheltered from precipitation; empty if none is.
    pub sheltered: Vec<bool>,
    /// Snow of each cell; empty while no snow lies on the patch.
    pub columns: Vec<Column>,
    /// Revision of the snow, changed whenever the snow may have changed.
    pub revision: u64,
    /// Indices of the neighbouring patches to the west, east, south and north; [`NONE`] without one.
    pub near: [u32; 4],
    /// State of the drift: snow that the wind carries over the patch's borders, and the wind over its cells.
    pub edges: Edges,
    /// Cached hash of the columns, until they change.
    hash: OnceLock<u64>,
}

impl Patch {
    /// Creates a patch with these heights, and the same snow everywhere except on holes.
    pub fn new(key: [i32; 2], heights_m: Vec<f32>, holes: Vec<bool>, column: Column) -> Self {
        let mut patch = Self { key, ..Self::default() };
        patch.set_ground(heights_m, holes);
        if column.mass() > 0 {
            let at = |cell| if patch.is_hole(cell) { Column::default() } else { column };
            patch.columns = (0..patch.heights_m.len()).map(at).collect();
        }
        patch
    }

    /// Creates a patch of saved snow; [`Self::set_ground`] sets its ground later.
    pub fn loaded(key: [i32; 2], columns: Vec<Column>) -> Self {
        Self { key, columns, ..Self::default() }
    }

    /// Replaces the ground by another of the same size. The snow stays.
    pub fn set_ground(&mut self, heights_m: Vec<f32>, holes: Vec<bool>) {
        self.lowest_m = f64::from(heights_m.iter().fold(f32::MAX, |low, h| h.min(low)));
        self.ground_cells = heights_m.len() - holes.iter().filter(|hole| **hole).count();
        (self.heights_m, self.holes) = (heights_m, holes);
    }

    /// Returns whether no snow lies on the patch.
    pub fn is_bare(&self) -> bool {
        self.columns.is_empty()
    }

    /// Returns the column of a cell; an empty one on a bare patch.
    pub fn column(&self, cell: usize) -> Column {
        self.columns.get(cell).copied().unwrap_or_default()
    }

    /// Replaces the column of a cell.
    pub fn put(&mut self, cell: usize, column: Column) {
        self.wake();
        self.columns[cell] = column;
    }

    /// Allocates columns if the patch has none.
    pub fn wake(&mut self) {
        if self.columns.is_empty() {
            self.columns.resize(self.heights_m.len(), Column::default());
        }
    }

    /// Returns whether a cell has no ground.
    pub fn is_hole(&self, cell: usize) -> bool {
        self.holes.get(cell).copied().unwrap_or(false)
    }

    /// Returns the height of the object that stops the wind on a cell, m; 0 without one.
    pub fn obstacle_m(&self, cell: usize) -> f64 {
        self.obstacles_m.get(cell).copied().unwrap_or(0.0)
    }

    /// Returns whether an object stops the wind on any cell.
    pub fn has_obstacles(&self) -> bool {
        self.obstacles_m.iter().any(|height| *height > 0.0)
    }

    /// Returns whether no snow can lie on a cell, because an object stands on it or there is no ground.
    pub fn is_blocked(&self, cell: usize) -> bool {
        self.obstacle_m(cell) > 0.0 || self.is_hole(cell)
    }

    /// Returns the share of the precipitation that reaches a cell: 0 if it is sheltered, else 1.
    pub fn open(&self, cell: usize) -> f64 {
        if self.sheltered.get(cell).copied().unwrap_or(false) { 0.0 } else { 1.0 }
    }

    /// Returns the height of ground and snow, m.
    pub fn surface_m(&self, cell: usize) -> f64 {
        f64::from(self.heights_m[cell]) + self.columns.get(cell).map_or(0.0, Column::depth_m)
    }

    /// Returns the lying mass, summed over cells, in units of mass.
    pub fn lying(&self) -> i64 {
        self.columns.iter().map(Column::mass).sum()
    }

    /// Returns a hash that is equal for equal snow.
    pub fn hash(&self) -> u64 {
        *self.hash.get_or_init(|| {
            let fold = |hash: u64, v: i64| (hash ^ v as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
            let numbers = self.columns.iter().flat_map(|c| [c.ice, c.water, c.depth, c.albedo]);
            numbers.fold(0xcbf2_9ce4_8422_2325, fold)
        })
    }

    /// Marks the snow as changed.
    pub fn changed(&mut self, revision: u64) {
        self.revision = revision;
        self.hash.take();
    }

    /// Removes the snow from blocked cells. Returns its mass.
    pub fn clear_blocked(&mut self) -> i64 {
        let mut taken = 0;
        for cell in 0..self.columns.len() {
            if self.is_blocked(cell) {
                taken += std::mem::take(&mut self.columns[cell]).mass();
            }
        }
        taken
    }
}
