//! Resampling that keeps the mean: averages of piecewise parabolas over new cells.

use super::map::{HeightMap, check_size, room_for};
use crate::error::Result;

/// Least share of a new cell whose heights must be known. The slack is for rounding.
const LEAST_KNOWN: f64 = 0.5 - 1e-9;
/// Number of columns of the new map that are computed together: so few that their values in all old rows stay in the
/// cache.
const STRIP: usize = 32;

/// Height of a cell and the share of it that is known.
#[derive(Clone, Copy, Default)]
struct PartlyKnown {
    value: f64,
    share: f64,
}

impl HeightMap {
    /// Returns the map with another number of samples over the same ground. Each sample stands for a cell around it. A
    /// new sample is the mean over its cell of parabolas through the old cells (Colella and Woodward 1984, equations
    /// 1.5 to 1.9, without their limiter). So the mean of all heights stays, whether the map becomes finer or coarser.
    /// A plane stays a plane, and resampling to the map's own size gives the same heights. A finer map overshoots at a
    /// cliff by at most 0.18 of the cliff's height.
    ///
    /// A new sample is known if at least half of its cell is. The mean of a map with unknown heights then stays if each
    /// new sample is weighted by the known part of its cell.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a size that [`HeightMap::new`] refuses;
    /// [`crate::Status::OutOfMemory`].
    pub fn resampled(&self, columns: u32, rows: u32) -> Result<Self> {
        check_size(columns, rows)?;
        let mut heights_m = room_for(u64::from(columns) * u64::from(rows))?;
        heights_m.resize(columns as usize * rows as usize, 0.0);
        let (old_columns, old_rows) = (self.columns() as usize, self.rows() as usize);
        let strip_cells = STRIP.min(columns as usize) * old_rows;
        let mut strip = room_for(strip_cells as u64)?;
        strip.resize(strip_cells, PartlyKnown::default());
        for first in (0..columns as usize).step_by(STRIP) {
            let width = STRIP.min(columns as usize - first);
            for row in 0..old_rows {
                let old = &self.heights_m()[row * old_columns..][..old_columns];
                let cell = |i: usize| match old[i] {
                    height if height.is_nan() => PartlyKnown::default(),
                    height => PartlyKnown { value: f64::from(height), share: 1.0 },
                };
                for column in 0..width {
                    strip[column * old_rows + row] = Line::new(old_columns, columns).mean(first + column, cell);
                }
            }
            for column in 0..width {
                let cell = |i: usize| strip[column * old_rows + i];
                for row in 0..rows as usize {
                    let new = Line::new(old_rows, rows).mean(row, cell);
                    let height = if new.share >= LEAST_KNOWN { new.value as f32 } else { f32::NAN };
                    heights_m[row * columns as usize + first + column] = height;
                }
            }
        }
        let sides = [[self.columns(), columns], [self.rows(), rows]].map(|side| side.map(f64::from));
        let stretched = |distance: f64, [old, new]: [f64; 2]| distance * old / new;
        let cell = self.cell().map(|[x, y]| [stretched(x, sides[0]), stretched(y, sides[1])]);
        let moved = |place: f64, distance: f64, side| place + 0.5 * (stretched(distance, side) - distance);
        let south_west = match (self.south_west(), self.cell()) {
            (Some([x, y]), Some(old)) => Some([moved(x, old[0], sides[0]), moved(y, old[1], sides[1])]),
            (place, _) => place,
        };
        Ok(Self::of_checked(columns, rows, heights_m).placed(cell, south_west))
    }
}

/// Row or column of old cells, divided into new cells.
#[derive(Clone, Copy)]
struct Line {
    old: usize,
    new: usize,
}

impl Line {
    fn new(old: usize, new: u32) -> Self {
        Self { old, new: new as usize }
    }

    /// Returns the end of the first `index` new cells: the old cell in which this end lies, and the part of that cell
    /// before it. Whole numbers leave no gap and no overlap between new cells.
    fn end(self, index: usize) -> (usize, f64) {
        let end = index as u64 * self.old as u64;
        ((end / self.new as u64) as usize, (end % self.new as u64) as f64 / self.new as f64)
    }

    /// Returns the mean over a new cell.
    fn mean(self, index: usize, cell: impl Fn(usize) -> PartlyKnown) -> PartlyKnown {
        let ((first, begin), (last, end)) = (self.end(index), self.end(index + 1));
        let (mut sum, mut known) = (0.0, 0.0);
        for i in first..=last {
            let (begin, end) = (if i == first { begin } else { 0.0 }, if i == last { end } else { 1.0 });
            if end <= begin {
                continue;
            }
            let share = cell(i).share;
            if share > 0.0 {
                sum += share * self.integral(i, begin, end, &cell);
                known += share * (end - begin);
            }
        }
        if known == 0.0 {
            return PartlyKnown::default();
        }
        PartlyKnown { value: sum / known, share: known * self.new as f64 / self.old as f64 }
    }

    /// Returns the integral of the parabola of cell `i` over a part of that cell. The parabola's value at each edge is
    /// that of the cubic whose means over the four cells around the edge are the heights of these cells (equation 1.6
    /// for equal cells). Beyond the last known cell, heights continue linearly.
    fn integral(self, i: usize, begin: f64, end: f64, cell: impl Fn(usize) -> PartlyKnown) -> f64 {
        let mean = cell(i).value;
        if begin == 0.0 && end == 1.0 {
            return mean;
        }
        let known =
            |i: Option<usize>| i.filter(|i| *i < self.old).map(&cell).filter(|c| c.share > 0.0).map(|c| c.value);
        let (left, right) = (known(i.checked_sub(1)), known(Some(i + 1)));
        let left_1 = left.unwrap_or(2.0 * mean - right.unwrap_or(mean));
        let right_1 = right.unwrap_or(2.0 * mean - left.unwrap_or(mean));
        let left_2 = left.and(known(i.checked_sub(2))).unwrap_or(2.0 * left_1 - mean);
        let right_2 = right.and(known(Some(i + 2))).unwrap_or(2.0 * right_1 - mean);
        let edge = |near: f64, far: f64| (7.0 * near - far) / 12.0;
        let (low, high) = (edge(mean + left_1, right_1 + left_2), edge(mean + right_1, left_1 + right_2));
        // Equations 1.5 and 1.7: low + x (high - low + bend (1 - x)), from 0 to x.
        let bend = 6.0 * (mean - 0.5 * (low + high));
        let up_to = |x: f64| x * (low + x * (0.5 * (high - low + bend) - x * bend / 3.0));
        up_to(end) - up_to(begin)
    }
}
