//! Columns of snow on patches of ground, and their mass balance.
//!
//! A **patch** is a rectangle of cells. All patches of a field have the same size and lie on one lattice, side by side
//! or apart. A host's grid is one patch; its tiles are many. Results do not depend on where patches end: sums are of
//! whole numbers, drifting snow passes from patch to patch ([`super::drift`]), and sliding snow is processed in the
//! order of the lattice's rows ([`super::slides`]). A patch without snow has no columns and is skipped until snow
//! falls, drifts or slides onto it.
//!
//! The ground is abstract here: heights, obstacles, holes, and the cells that are sheltered from snowfall. `site.rs`
//! finds these from the host's data.

use super::{
    drift_state::DriftSweep,
    patch::{NONE, Patch},
};

/// Mass balance of a field since it began: sums over cells, in units of mass ([`super::column::UNITS`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Books {
    /// Mass of the snow with which patches were added: when the host sets a grid or a tile, its patch begins with the
    /// snow of level, open ground.
    pub began: i64,
    /// Snow and ice that fell, and rain that fell on snow.
    pub fallen: i64,
    /// Snow that the wind blew in over the field's border.
    pub blown_in: i64,
    /// Snow that the wind blew out over the field's border.
    pub blown_out: i64,
    /// Melt water and rain that ran off to the ground.
    pub ran_off: i64,
    /// Snow that sublimated into the air.
    pub sublimated: i64,
    /// Snow that the host took away, including that on removed ground and on cells on which boxes were set.
    pub taken: i64,
}

impl Books {
    /// Returns all sums in the order of the fields.
    pub fn to_array(self) -> [i64; 7] {
        [self.began, self.fallen, self.blown_in, self.blown_out, self.ran_off, self.sublimated, self.taken]
    }

    /// Creates the mass balance from its sums, in the order of the fields.
    pub fn from_array([began, fallen, blown_in, blown_out, ran_off, sublimated, taken]: [i64; 7]) -> Self {
        Self { began, fallen, blown_in, blown_out, ran_off, sublimated, taken }
    }

    /// Returns the lying mass that follows from the balance; it equals [`SnowField::lying`].
    pub fn balance(&self) -> i64 {
        self.began + self.fallen + self.blown_in - self.blown_out - self.ran_off - self.sublimated - self.taken
    }
}

/// Lying snow on patches of ground.
#[derive(Clone, Debug)]
pub(super) struct SnowField {
    /// Number of cells of a patch, east and north.
    pub size: [usize; 2],
    /// Side of a cell, m.
    pub cell_m: f64,
    /// Lattice of tiles: x, y and z of its origin in the host's world, and its cell size, m. `None` for a grid.
    pub lattice: Option<[f64; 4]>,
    /// Patches, sorted by key: rows from the south, each from the west.
    #[expect(clippy::vec_box, reason = "a new one is put among the others, which are many and large")]
    pub patches: Vec<Box<Patch>>,
    /// Sums of all mass that came and went.
    pub books: Books,
    /// Mean run-off in the last step, mm/h.
    pub runoff_mm_h: f64,
    /// Share of the ground under snow after the last step.
    pub cover: f64,
    /// Whether `near` of all patches is up to date.
    joined: bool,
    pub drift: DriftSweep,
    /// Scratch space for sliding snow: patch and cell whose snow may slide.
    pub moving: Vec<(u32, u32)>,
}

impl SnowField {
    /// Creates a field without patches.
    pub fn new(size: [usize; 2], cell_m: f64) -> Self {
        Self {
            size,
            cell_m,
            lattice: None,
            patches: Vec::new(),
            books: Books::default(),
            runoff_mm_h: 0.0,
            cover: 0.0,
            joined: true,
            drift: DriftSweep::default(),
            moving: Vec::new(),
        }
    }

    /// Returns the number of cells.
    pub fn len(&self) -> usize {
        self.patches.len() * self.size[0] * self.size[1]
    }

    /// Returns the lying mass, summed over cells, in units of mass.
    pub fn lying(&self) -> i64 {
        self.patches.iter().map(|p| p.lying()).sum()
    }

    /// Returns the index of a patch, or the index at which to insert it.
    pub fn find(&self, key: [i32; 2]) -> Result<usize, usize> {
        self.patches.binary_search_by_key(&[key[1], key[0]], |p| [p.key[1], p.key[0]])
    }

    /// Adds a patch unless one with its key exists. The snow on the patch is added to [`Books::began`].
    pub fn add(&mut self, patch: Patch) {
        if let Err(at) = self.find(patch.key) {
            self.books.began += patch.lying();
            self.patches.insert(at, Box::new(patch));
            self.joined = false;
        }
    }

    /// Removes a patch and its snow.
    pub fn remove(&mut self, number: usize) {
        self.books.taken += self.patches.remove(number).lying();
        self.joined = false;
    }

    /// Returns the index of the patch and of the cell at a place of the lattice, in cells east and north; `None`
    /// without ground.
    pub fn cell_at(&self, place: [i32; 2]) -> Option<(usize, usize)> {
        let size = self.size.map(|n| n as i32);
        let at = self.find([0, 1].map(|i| place[i].div_euclid(size[i]))).ok()?;
        let [x, y] = [0, 1].map(|i| place[i].rem_euclid(size[i]) as usize);
        let cell = y * self.size[0] + x;
        (!self.patches[at].is_hole(cell)).then_some((at, cell))
    }

    /// Removes the snow from cells that are newly blocked by an object or are no longer ground.
    pub fn clear_blocked(&mut self, revision: u64) {
        for patch in &mut self.patches {
            let taken = patch.clear_blocked();
            if taken > 0 {
                self.books.taken += taken;
                patch.changed(revision);
            }
        }
    }

    /// Updates the neighbours of all patches.
    pub fn join(&mut self) {
        if std::mem::replace(&mut self.joined, true) {
            return;
        }
        for at in 0..self.patches.len() {
            let [x, y] = self.patches[at].key;
            let keys = [[x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]];
            self.patches[at].near = keys.map(|key| self.find(key).map_or(NONE, |at| at as u32));
        }
    }
}
