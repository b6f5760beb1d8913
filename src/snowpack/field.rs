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

use std::sync::OnceLock;

use glam::DVec2;

use super::{
    column::{Column, ColumnForcing, Settling, UNITS},
    drift::{DriftSweep, Edges},
    slides,
};
use crate::weather::snow_cover;

/// In the place of a patch's number: there is none.
pub(super) const NONE: u32 = u32::MAX;
/// Side of the square blocks of cells that ask once what falls on them.
const BLOCK: usize = 16;
/// Units of a share of 1, so that sums do not depend on their order.
const SHARE_UNITS: f64 = 4_294_967_296.0;

/// A rectangle of ground and the snow on it, by rows from the south-west.
#[derive(Clone, Debug, Default)]
pub(super) struct Patch {
    /// Where it lies on the lattice, in patches east and north.
    pub key: [i32; 2],
    /// Revision of the host's tile from which the ground was taken.
    pub tile_revision: u64,
    /// Height of each cell, m. Empty until the ground is known.
    pub heights_m: Vec<f32>,
    /// At most as high as any of them, m.
    pub lowest_m: f64,
    /// Where there is no ground; empty where there is ground everywhere. And how many cells have some.
    pub holes: Vec<bool>,
    ground_cells: usize,
    /// Height of what stands on each cell and stops the wind, m; 0 without, empty where nothing stands anywhere.
    pub obstacles_m: Vec<f64>,
    /// Whether something keeps off each cell what falls; empty where nothing does.
    pub sheltered: Vec<bool>,
    /// Empty while no snow lies on it.
    pub columns: Vec<Column>,
    /// Other whenever its snow may be.
    pub revision: u64,
    /// West, east, south, north of it.
    pub near: [u32; 4],
    /// Snow that the wind carries over its borders, and the wind's speed.
    pub edges: Edges,
    hash: OnceLock<u64>,
}

impl Patch {
    /// With these heights and the same snow everywhere but on holes.
    pub fn new(key: [i32; 2], heights_m: Vec<f32>, holes: Vec<bool>, column: Column) -> Self {
        let mut patch = Self { key, ..Self::default() };
        patch.set_ground(heights_m, holes);
        if column.mass() > 0 {
            let at = |cell| if patch.is_hole(cell) { Column::default() } else { column };
            patch.columns = (0..patch.heights_m.len()).map(at).collect();
        }
        patch
    }

    /// With this snow, on ground that is still to be known.
    pub fn loaded(key: [i32; 2], columns: Vec<Column>) -> Self {
        Self { key, columns, ..Self::default() }
    }

    /// Takes other ground of the same size. The snow stays.
    pub fn set_ground(&mut self, heights_m: Vec<f32>, holes: Vec<bool>) {
        self.lowest_m = f64::from(heights_m.iter().fold(f32::MAX, |low, h| h.min(low)));
        self.ground_cells = heights_m.len() - holes.iter().filter(|hole| **hole).count();
        (self.heights_m, self.holes) = (heights_m, holes);
    }

    pub fn is_bare(&self) -> bool {
        self.columns.is_empty()
    }

    pub fn column(&self, cell: usize) -> Column {
        self.columns.get(cell).copied().unwrap_or_default()
    }

    /// Puts another column into a cell.
    pub fn put(&mut self, cell: usize, column: Column) {
        self.wake();
        self.columns[cell] = column;
    }

    fn wake(&mut self) {
        if self.columns.is_empty() {
            self.columns.resize(self.heights_m.len(), Column::default());
        }
    }

    pub fn is_hole(&self, cell: usize) -> bool {
        self.holes.get(cell).copied().unwrap_or(false)
    }

    pub fn obstacle_m(&self, cell: usize) -> f64 {
        self.obstacles_m.get(cell).copied().unwrap_or(0.0)
    }

    pub fn has_obstacles(&self) -> bool {
        self.obstacles_m.iter().any(|height| *height > 0.0)
    }

    /// Whether no snow lies on a cell because something stands on it or there is no ground.
    pub fn is_blocked(&self, cell: usize) -> bool {
        self.obstacle_m(cell) > 0.0 || self.is_hole(cell)
    }

    fn open(&self, cell: usize) -> f64 {
        if self.sheltered.get(cell).copied().unwrap_or(false) { 0.0 } else { 1.0 }
    }

    /// Height of ground and snow, m.
    pub fn surface_m(&self, cell: usize) -> f64 {
        f64::from(self.heights_m[cell]) + self.columns.get(cell).map_or(0.0, Column::depth_m)
    }

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

    /// Says that its snow is other than before.
    pub fn changed(&mut self, revision: u64) {
        self.revision = revision;
        self.hash.take();
    }

    /// Takes the snow off cells on which none can lie. Answers its mass.
    pub fn clear_blocked(&mut self) -> i64 {
        let mut taken = 0;
        for cell in 0..self.columns.len() {
            if self.is_blocked(cell) {
                taken += std::mem::take(&mut self.columns[cell]).mass();
            }
        }
        taken
    }

    /// Leads its columns through a step, block by block.
    fn step(&mut self, size: [usize; 2], step: &SnowStep<'_>, sums: &mut Sums) {
        let side = if step.falls.is_some() { [BLOCK; 2] } else { size };
        let (mut lies, was_bare) = (false, self.is_bare());
        for row in (0..size[1]).step_by(side[1]) {
            for column in (0..size[0]).step_by(side[0]) {
                let middle = [column + side[0] / 2, row + side[1] / 2];
                let middle = [middle[0].min(size[0] - 1), middle[1].min(size[1] - 1)];
                let own = step.falls.map(|falls| {
                    let place = [0, 1].map(|i| self.key[i] * size[i] as i32 + middle[i] as i32);
                    falls(place, f64::from(self.heights_m[middle[1] * size[0] + middle[0]]))
                });
                let forcing = own.as_ref().unwrap_or(step.even);
                if was_bare && !forcing.snows() {
                    continue;
                }
                self.wake();
                let rows = row..(row + side[1]).min(size[1]);
                let across = column..(column + side[0]).min(size[0]);
                for cell in rows.flat_map(|row| across.clone().map(move |column| row * size[0] + column)) {
                    if !self.is_blocked(cell) {
                        let open = self.open(cell);
                        let column = &mut self.columns[cell];
                        sums.add(column.step(forcing, step.settling, open), column);
                        lies |= column.ice > 0;
                    }
                }
            }
        }
        if !lies {
            self.columns.clear();
        }
        if !(was_bare && self.is_bare()) {
            self.changed(step.revision);
        }
    }
}

/// Sums over the columns of a field: what they gave and what they have.
#[derive(Default)]
struct Sums {
    fallen: i64,
    ran_off: i64,
    sublimated: i64,
    /// In units of a share.
    covered: i64,
}

impl Sums {
    fn add(&mut self, gone: super::column::MassExchange, column: &Column) {
        self.fallen += gone.fallen;
        self.ran_off += gone.ran_off;
        self.sublimated += gone.sublimated;
        self.covered += if column.depth > 0 { (snow_cover(column.depth_m()) * SHARE_UNITS) as i64 } else { 0 };
    }
}

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

/// Function that returns the forcing at a place of the lattice whose ground is so high, m.
pub(super) type FallsAt<'a> = &'a dyn Fn([i32; 2], f64) -> ColumnForcing;
/// The wind at 10 m over a place of the lattice whose snow reaches so high, m; m/s east and north.
pub(super) type WindAt<'a> = &'a dyn Fn([i32; 2], f64) -> DVec2;

/// The wind over a field at 10 m, m/s east and north.
#[derive(Clone, Copy)]
pub(super) struct FieldWind<'a> {
    pub mean: DVec2,
    /// Where it varies in space; else the surface's shape decides.
    pub local: Option<WindAt<'a>>,
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
    drift: DriftSweep,
    /// Room for what slides.
    moving: Vec<(u32, u32)>,
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
    pub fn remove(&mut self, at: usize) {
        self.books.taken += self.patches.remove(at).lying();
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
    fn join(&mut self) {
        if std::mem::replace(&mut self.joined, true) {
            return;
        }
        for at in 0..self.patches.len() {
            let [x, y] = self.patches[at].key;
            let keys = [[x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]];
            self.patches[at].near = keys.map(|key| self.find(key).map_or(NONE, |at| at as u32));
        }
    }

    /// Leads the snow through a step.
    pub fn step(&mut self, step: &SnowStep<'_>) {
        self.join();
        let mut sums = Sums::default();
        self.patches.iter_mut().for_each(|patch| patch.step(self.size, step, &mut sums));
        self.books.fallen += sums.fallen;
        self.books.sublimated += sums.sublimated;
        self.books.ran_off += sums.ran_off;
        let cells = self.patches.iter().map(|p| p.ground_cells).sum::<usize>().max(1) as f64;
        self.runoff_mm_h = sums.ran_off as f64 / UNITS / cells * 3600.0 / step.seconds;
        self.cover = sums.covered as f64 / SHARE_UNITS / cells;
        let mut drift = std::mem::take(&mut self.drift);
        drift.blow(self, step);
        self.drift = drift;
        if step.slides {
            let mut moving = std::mem::take(&mut self.moving);
            slides::relax(self, &mut moving, step.revision);
            self.moving = moving;
        }
    }
}
