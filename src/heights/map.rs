//! Rectangle of heights, with the distance and the place of its samples if they are known.

use crate::error::{Error, Result, Status, check_range};

/// Largest number of samples of a height map: a square of 16 384.
pub const MAX_HEIGHT_SAMPLES: u64 = 1 << 28;
/// Largest height above or below 0, m, the same as for terrain.
pub(super) const MOST_M: f64 = 1e5;

/// Least and largest distance between samples, in the file's own unit.
pub(super) const CELL_RANGE: [f64; 2] = [1e-9, 1e6];

/// Rectangle of heights in metres, in rows from south to north; each row runs from west to east.
#[derive(Clone, Debug)]
pub struct HeightMap {
    columns: u32,
    rows: u32,
    heights_m: Vec<f32>,
    cell: Option<[f64; 2]>,
    south_west: Option<[f64; 2]>,
}

impl HeightMap {
    /// Creates a map of heights within 100 000 m of 0, in rows from the south; NaN where the height is not known.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] for a side of 0, for more than [`MAX_HEIGHT_SAMPLES`] samples, for a number of
    /// heights other than `columns` x `rows`, and for a height out of range.
    pub fn new(columns: u32, rows: u32, heights_m: Vec<f32>) -> Result<Self> {
        check_size(columns, rows)?;
        let wanted = u64::from(columns) * u64::from(rows);
        if heights_m.len() as u64 != wanted {
            let accepted = format!("{wanted}, one for each of {columns} x {rows} samples");
            return Err(Error::range("heights_m.len", &accepted, heights_m.len()));
        }
        if let Some(i) = heights_m.iter().position(|h| !h.is_nan() && f64::from(h.abs()) > MOST_M) {
            let accepted = format!("within {MOST_M} m of 0, or NaN where the height is not known");
            return Err(Error::range(&format!("heights_m[{i}]"), &accepted, heights_m[i]));
        }
        Ok(Self::of_checked(columns, rows, heights_m))
    }

    /// Creates a map of heights that were checked.
    pub(super) fn of_checked(columns: u32, rows: u32, heights_m: Vec<f32>) -> Self {
        Self { columns, rows, heights_m, cell: None, south_west: None }
    }

    /// Returns the map with the distance between neighbouring samples to the east and to the north, in the unit of
    /// [`HeightMap::cell`].
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] unless both are in \[1e-9, 1e6\].
    pub fn with_cell(mut self, cell: [f64; 2]) -> Result<Self> {
        check_cell(cell)?;
        self.cell = Some(cell);
        Ok(self)
    }

    /// Returns the map with this distance between its samples and this place of its south-western sample.
    pub(super) fn placed(mut self, cell: Option<[f64; 2]>, south_west: Option<[f64; 2]>) -> Self {
        (self.cell, self.south_west) = (cell, south_west);
        self
    }

    /// Returns the number of samples from west to east.
    pub fn columns(&self) -> u32 {
        self.columns
    }

    /// Returns the number of samples from south to north.
    pub fn rows(&self) -> u32 {
        self.rows
    }

    /// Returns all heights in metres, rows from the south; NaN where the height is not known.
    pub fn heights_m(&self) -> &[f32] {
        &self.heights_m
    }

    /// Returns the height of a sample, counted from the south-west; `None` outside the map and where it is not known.
    pub fn height_m(&self, column: u32, row: u32) -> Option<f32> {
        if column >= self.columns || row >= self.rows {
            return None;
        }
        Some(self.heights_m[row as usize * self.columns as usize + column as usize]).filter(|h| !h.is_nan())
    }

    /// Returns the distance between neighbouring samples to the east and to the north, in the file's own unit: metres,
    /// or degrees in a grid of longitudes and latitudes. `None` if the file does not say.
    pub fn cell(&self) -> Option<[f64; 2]> {
        self.cell
    }

    /// Returns the place of the south-western sample, east and north, in the file's own unit; `None` if the file does
    /// not say.
    pub fn south_west(&self) -> Option<[f64; 2]> {
        self.south_west
    }

    /// Returns the lowest and the highest height, m; `None` if no height is known.
    pub fn range_m(&self) -> Option<[f32; 2]> {
        let known = || self.heights_m.iter().copied().filter(|h| !h.is_nan());
        Some([known().reduce(f32::min)?, known().reduce(f32::max)?])
    }

    /// Returns the mean of the known heights, m; `None` if none is known.
    pub fn mean_m(&self) -> Option<f64> {
        let (mut sum, mut count) = (0.0, 0_u64);
        for height in self.heights_m.iter().filter(|h| !h.is_nan()) {
            sum += f64::from(*height);
            count += 1;
        }
        (count > 0).then(|| sum / count as f64)
    }

    /// Returns the number of samples whose height is not known.
    pub fn missing(&self) -> usize {
        self.heights_m.iter().filter(|h| h.is_nan()).count()
    }
}

/// Checks that a map has samples, and not too many.
pub(super) fn check_size(columns: u32, rows: u32) -> Result<()> {
    for (name, side) in [("columns", columns), ("rows", rows)] {
        if side == 0 {
            return Err(Error::range(name, "at least 1", side));
        }
    }
    let samples = u64::from(columns) * u64::from(rows);
    if samples > MAX_HEIGHT_SAMPLES {
        let accepted = format!("at most {MAX_HEIGHT_SAMPLES} together with rows");
        return Err(Error::range("columns", &accepted, format_args!("{columns} x {rows}")));
    }
    Ok(())
}

/// Checks the distance between samples.
pub(super) fn check_cell(cell: [f64; 2]) -> Result<()> {
    for (i, distance) in cell.into_iter().enumerate() {
        check_range(&format!("cell[{i}]"), distance, CELL_RANGE[0], CELL_RANGE[1], "")?;
    }
    Ok(())
}

/// Returns an empty list with room for `count` values.
pub(super) fn room_for<T>(count: u64) -> Result<Vec<T>> {
    let full = || {
        let bytes = count.saturating_mul(size_of::<T>() as u64);
        Error::new(Status::OutOfMemory, format!("there is no memory for {bytes} bytes of heights"))
    };
    let mut room = Vec::new();
    room.try_reserve_exact(usize::try_from(count).map_err(|_| full())?).map_err(|_| full())?;
    Ok(room)
}
