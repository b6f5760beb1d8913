//! Collector of a file's numbers, which become heights one by one.

use std::fmt::Display;

use super::super::{
    map::{HeightMap, MOST_M, check_size, room_for},
    settings::{HeightSettings, RowOrder, is_same},
};
use crate::error::{Error, Result, Status};

/// Heights of a file so far, in the file's order.
pub struct Samples<'a> {
    settings: &'a HeightSettings,
    columns: u32,
    rows: u32,
    heights_m: Vec<f32>,
    /// Number that means no data according to the file's header.
    pub own_no_data: Option<f64>,
}

impl<'a> Samples<'a> {
    /// Creates a collector for a map of this size.
    pub fn new(columns: u32, rows: u32, settings: &'a HeightSettings) -> Result<Self> {
        check_size(columns, rows).map_err(|e| e.with_status(Status::Parse))?;
        let heights_m = room_for(u64::from(columns) * u64::from(rows))?;
        Ok(Self { settings, columns, rows, heights_m, own_no_data: None })
    }

    /// Adds the next number, which is at `place` in the file.
    pub fn take(&mut self, number: f64, place: impl Display) -> Result<()> {
        if self.settings.is_no_data(number) || self.own_no_data.is_some_and(|none| is_same(none, number)) {
            return self.take_none(place);
        }
        let height = self.settings.scale.base_m + self.settings.scale.step_m * number;
        if !(-MOST_M..=MOST_M).contains(&height) {
            let rest = format!(
                "must be a height within {MOST_M} m of 0 by settings.scale, or the number in settings.no_data, got {number}"
            );
            return Err(self.fault(place, rest));
        }
        self.push(height as f32, place)
    }

    /// Adds a sample without a height.
    pub fn take_none(&mut self, place: impl Display) -> Result<()> {
        self.push(f32::NAN, place)
    }

    fn push(&mut self, height: f32, place: impl Display) -> Result<()> {
        if self.heights_m.len() as u64 == u64::from(self.columns) * u64::from(self.rows) {
            let sentence = format!("{place}: the file must end after {} x {} heights", self.columns, self.rows);
            return Err(Error::new(Status::Parse, sentence));
        }
        self.heights_m.push(height);
        Ok(())
    }

    fn fault(&self, place: impl Display, rest: String) -> Error {
        let (row, column) =
            (self.heights_m.len() / self.columns as usize, self.heights_m.len() % self.columns as usize);
        Error::about(Status::Parse, format!("{place}, column {column} of row {row} (from 0),"), rest)
    }

    /// Returns the number of heights so far.
    pub fn len(&self) -> usize {
        self.heights_m.len()
    }

    /// Returns the map of all heights. `row_order` is the order of the rows in the file.
    pub fn finish(mut self, row_order: RowOrder) -> HeightMap {
        debug_assert_eq!(self.heights_m.len() as u64, u64::from(self.columns) * u64::from(self.rows));
        if row_order == RowOrder::NorthFirst {
            turn(&mut self.heights_m, self.columns);
        }
        HeightMap::of_checked(self.columns, self.rows, self.heights_m)
    }
}

/// Reverses the order of the rows.
fn turn(values: &mut [f32], columns: u32) {
    let columns = columns as usize;
    let rows = values.len() / columns;
    for row in 0..rows / 2 {
        let (south, north) = values.split_at_mut((rows - 1 - row) * columns);
        south[row * columns..][..columns].swap_with_slice(&mut north[..columns]);
    }
}

/// Returns the error for a file that ends before its heights do.
pub fn cut_short(place: impl Display, needed: impl Display, got: impl Display) -> Error {
    Error::new(Status::Parse, format!("{place}: needs {needed} bytes, the file has {got}"))
}
