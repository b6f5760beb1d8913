//! Step of a snow field: its columns, drift, slides, and mass balance.

use super::{
    column::{Column, MassExchange, UNITS},
    field::SnowField,
    inputs::SnowStep,
    patch::Patch,
    slides,
};
use crate::weather::snow_cover;

/// Side length, in cells, of the squares that share one evaluation of precipitation that varies in space.
const BLOCK: usize = 16;
/// Units per share of 1: 2^32. Sums of whole numbers do not depend on their order.
const SHARE_UNITS: f64 = 4_294_967_296.0;

/// Sums over the columns of a field, in units of mass.
#[derive(Default)]
struct Sums {
    /// Snow and rain that fell.
    fallen: i64,
    /// Water that ran off to the ground.
    ran_off: i64,
    /// Snow that sublimated.
    sublimated: i64,
    /// Sum over all cells of the share of a cell that snow covers, in units of [`SHARE_UNITS`].
    covered: i64,
}

impl Sums {
    /// Adds a column after its step, and what it gained and lost.
    fn add(&mut self, gone: MassExchange, column: &Column) {
        self.fallen += gone.fallen;
        self.ran_off += gone.ran_off;
        self.sublimated += gone.sublimated;
        self.covered += if column.depth > 0 { (snow_cover(column.depth_m()) * SHARE_UNITS) as i64 } else { 0 };
    }
}

impl Patch {
    /// Steps the patch's columns, block by block. A patch on which no ice is left becomes bare.
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

impl SnowField {
    /// Steps the snow of the field.
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
