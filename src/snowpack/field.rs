//! Columns of snow side by side on patches of ground, and the books of their mass.
//!
//! A **patch** is a rectangle of cells; all of a field have the same size and lie on one lattice, side by side or
//! apart. A grid of the host's is one patch, its tiles are many. Nothing depends on where one patch ends and the next
//! begins: sums are of whole numbers, what goes with the wind goes from patch to patch ([`super::drift`]), and what
//! slides does so in the order of the lattice's rows ([`super::slides`]). A patch without snow has no columns and is
//! passed over until something falls, drifts or slides onto it.
//!
//! The ground is abstract here: heights, what stands on cells, where there is none, and which cells what falls gets to.
//! Where these come from is `site.rs`'s part.

use super::{
    drift_state::DriftSweep,
    patch::{NONE, Patch},
};

/// Where the mass of a field came from and went, in units of mass times cells since it began.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Books {
    /// Mass that lay when its ground was set.
    pub began: i64,
    pub fallen: i64,
    pub blown_in: i64,
    pub blown_out: i64,
    pub ran_off: i64,
    pub sublimated: i64,
    pub taken: i64,
}

impl Books {
    pub fn to_array(self) -> [i64; 7] {
        [self.began, self.fallen, self.blown_in, self.blown_out, self.ran_off, self.sublimated, self.taken]
    }

    pub fn from_array([began, fallen, blown_in, blown_out, ran_off, sublimated, taken]: [i64; 7]) -> Self {
        Self { began, fallen, blown_in, blown_out, ran_off, sublimated, taken }
    }

    /// Returns the mass that must lie.
    pub fn balance(&self) -> i64 {
        self.began + self.fallen + self.blown_in - self.blown_out - self.ran_off - self.sublimated - self.taken
    }
}

/// Lying snow on patches of ground.
#[derive(Clone, Debug)]
pub(super) struct SnowField {
    /// Cells of a patch, east and north.
    pub size: [usize; 2],
    pub cell_m: f64,
    /// Lattice of tiles: the origin and the cells, m. None for a grid.
    pub lattice: Option<[f64; 4]>,
    /// By their keys: rows from the south, in each from the west.
    #[expect(clippy::vec_box, reason = "a new one is put among the others, which are many and large")]
    pub patches: Vec<Box<Patch>>,
    pub books: Books,
    /// Mean run-off of the last step, mm/h, and the share of the ground that snow covered.
    pub runoff_mm_h: f64,
    pub cover: f64,
    /// Whether all patches know their neighbours.
    joined: bool,
    pub drift: DriftSweep,
    /// Room for what slides.
    pub moving: Vec<(u32, u32)>,
}

impl SnowField {
    /// Without patches.
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

    /// All cells.
    pub fn len(&self) -> usize {
        self.patches.len() * self.size[0] * self.size[1]
    }

    /// Returns the mass that lies, in units of mass times cells.
    pub fn lying(&self) -> i64 {
        self.patches.iter().map(|p| p.lying()).sum()
    }

    /// The number of a patch, or where it would be.
    pub fn find(&self, key: [i32; 2]) -> Result<usize, usize> {
        self.patches.binary_search_by_key(&[key[1], key[0]], |p| [p.key[1], p.key[0]])
    }

    /// Adds a patch where there is none. What lies on it lay there when it began.
    pub fn add(&mut self, patch: Patch) {
        if let Err(at) = self.find(patch.key) {
            self.books.began += patch.lying();
            self.patches.insert(at, Box::new(patch));
            self.joined = false;
        }
    }

    /// Takes a patch away with its snow.
    pub fn remove(&mut self, number: usize) {
        self.books.taken += self.patches.remove(number).lying();
        self.joined = false;
    }

    /// The patch and the cell at a place of the lattice, if there is ground.
    pub fn cell_at(&self, place: [i32; 2]) -> Option<(usize, usize)> {
        let size = self.size.map(|n| n as i32);
        let at = self.find([0, 1].map(|i| place[i].div_euclid(size[i]))).ok()?;
        let [x, y] = [0, 1].map(|i| place[i].rem_euclid(size[i]) as usize);
        let cell = y * self.size[0] + x;
        (!self.patches[at].is_hole(cell)).then_some((at, cell))
    }

    /// Takes snow off cells on which something new stands, or that are no ground any more.
    pub fn clear_blocked(&mut self, revision: u64) {
        for patch in &mut self.patches {
            let taken = patch.clear_blocked();
            if taken > 0 {
                self.books.taken += taken;
                patch.changed(revision);
            }
        }
    }

    /// Lets all patches know their neighbours.
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
