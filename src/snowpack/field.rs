//! Columns of snow side by side on a grid of heights, and the books of their mass.
//!
//! The grid is abstract: heights, what stands on cells, and which cells what falls gets to. Where these come from is `site.rs`'s part.

use glam::DVec2;

use super::{
    column::{Column, Forcing, UNITS},
    drift::Drift,
    slides,
};
use crate::weather::snow_cover;

/// The ground below a field of snow.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Land {
    /// Cells east and north.
    pub nodes: [usize; 2],
    pub cell_m: f64,
    /// Of each cell, m; eastern neighbours beside each other, then northern.
    pub heights_m: Vec<f64>,
    /// Height of what stands on each cell and stops the wind, m; 0 without, empty where nothing stands anywhere.
    pub obstacles_m: Vec<f64>,
    /// Whether something keeps off each cell what falls; empty where nothing does.
    pub sheltered: Vec<bool>,
}

impl Land {
    pub fn len(&self) -> usize {
        self.nodes[0] * self.nodes[1]
    }

    pub fn obstacle_m(&self, cell: usize) -> f64 {
        self.obstacles_m.get(cell).copied().unwrap_or(0.0)
    }

    /// Whether something stands on a cell, so that no snow lies there.
    pub fn is_blocked(&self, cell: usize) -> bool {
        self.obstacle_m(cell) > 0.0
    }

    fn open(&self, cell: usize) -> f64 {
        if self.sheltered.get(cell).copied().unwrap_or(false) { 0.0 } else { 1.0 }
    }
}

/// Where the mass of a field came from and went, in units of mass times cells since it began.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Books {
    /// What lay when it began.
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

    /// What must lie.
    pub fn balance(&self) -> i64 {
        self.began + self.fallen + self.blown_in - self.blown_out - self.ran_off - self.sublimated - self.taken
    }
}

/// The wind over a field at 10 m, m/s east and north.
#[derive(Clone, Copy, Debug)]
pub(super) struct WindOver<'a> {
    pub mean: DVec2,
    /// Of each cell, where it varies in space; else the surface's shape decides.
    pub local: Option<&'a [DVec2]>,
}

/// What a step is done with.
pub(super) struct Step<'a> {
    pub seconds: f64,
    /// Side of the square blocks of cells that have a forcing each, and these forcings; one forcing is for all cells.
    pub block: usize,
    pub forcings: &'a [Forcing],
    pub wind: WindOver<'a>,
    /// The level, open country about the field, which drifting snow comes from.
    pub country: &'a Column,
    /// Steep snow slides in this step.
    pub slides: bool,
}

/// Lying snow on a grid.
#[derive(Clone, Debug)]
pub(super) struct Field {
    pub columns: Vec<Column>,
    pub books: Books,
    /// Mean run-off of the last step, mm/h, and the share of the ground that snow covered.
    pub runoff_mm_h: f64,
    pub cover: f64,
    drift: Drift,
}

impl Field {
    /// With the same snow everywhere but where something stands.
    pub fn new(land: &Land, column: Column) -> Self {
        let at = |cell| if land.is_blocked(cell) { Column::default() } else { column };
        Self::of((0..land.len()).map(at).collect())
    }

    /// With these columns.
    pub fn of(columns: Vec<Column>) -> Self {
        let books = Books { began: columns.iter().map(Column::mass).sum(), ..Books::default() };
        Self { columns, books, runoff_mm_h: 0.0, cover: 0.0, drift: Drift::default() }
    }

    /// What lies, in units of mass times cells.
    pub fn lying(&self) -> i64 {
        self.columns.iter().map(Column::mass).sum()
    }

    /// Whether snow lies anywhere.
    #[cfg(test)]
    pub fn is_any(&self) -> bool {
        self.columns.iter().any(|c| c.ice > 0)
    }

    /// Snow of cells on which something new stands is carried off with it.
    pub fn clear_blocked(&mut self, land: &Land) {
        for (cell, column) in self.columns.iter_mut().enumerate() {
            if land.is_blocked(cell) {
                self.books.taken += column.mass();
                *column = Column::default();
            }
        }
    }

    /// Leads the snow through a step.
    pub fn step(&mut self, land: &Land, step: &Step<'_>) {
        let columns = land.nodes[0];
        let blocks = columns.div_ceil(step.block);
        let (mut ran_off, mut covered) = (0, 0.0);
        for (cell, column) in self.columns.iter_mut().enumerate().filter(|(cell, _)| !land.is_blocked(*cell)) {
            let block = if step.forcings.len() == 1 {
                0
            } else {
                cell / columns / step.block * blocks + cell % columns / step.block
            };
            let gone = column.step(&step.forcings[block], land.open(cell));
            self.books.fallen += gone.fallen;
            self.books.sublimated += gone.sublimated;
            ran_off += gone.ran_off;
            covered += if column.depth > 0 { snow_cover(column.depth_m()) } else { 0.0 };
        }
        self.books.ran_off += ran_off;
        self.runoff_mm_h = ran_off as f64 / UNITS / land.len() as f64 * 3600.0 / step.seconds;
        self.cover = covered / land.len() as f64;
        self.drift.blow(&mut self.columns, &mut self.books, land, step);
        if step.slides {
            slides::relax(&mut self.columns, land);
        }
    }
}
