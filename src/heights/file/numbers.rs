//! Conversion of heights to the whole numbers of a file.

use super::super::{
    map::HeightMap,
    settings::{HeightSettings, RowOrder},
};
use crate::error::{Error, Result};

/// Returns the indices of a map's samples in the order of a file.
pub fn in_order(map: &HeightMap, row_order: RowOrder) -> impl Iterator<Item = usize> {
    let (columns, rows) = (map.columns() as usize, map.rows() as usize);
    (0..rows).flat_map(move |row| {
        let row = if row_order == RowOrder::NorthFirst { rows - 1 - row } else { row };
        row * columns..(row + 1) * columns
    })
}

/// Returns the whole number that is nearest to a height by the settings' scale, or the settings' number for no data if
/// the height is not known.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] if the number lies outside `range`, if an unknown height has no whole number for
/// no data within `range`, or if a known height would get the number for no data.
pub fn whole_number(map: &HeightMap, index: usize, settings: &HeightSettings, range: [i32; 2]) -> Result<i32> {
    let [low, high] = range.map(f64::from);
    let (height, scale) = (f64::from(map.heights_m()[index]), settings.scale);
    if height.is_nan() {
        let none = settings.no_data.filter(|none| (low..=high).contains(none) && none.fract() == 0.0);
        return none.map(|none| none as i32).ok_or_else(|| {
            let accepted = format!("a whole number in [{low}, {high}], since heights_m[{index}] is not known");
            let got = settings.no_data.map_or("none".into(), |none| none.to_string());
            Error::range("settings.no_data", &accepted, got)
        });
    }
    let number = ((height - scale.base_m) / scale.step_m).round();
    if !(low..=high).contains(&number) {
        let ends = [low, high].map(|n| scale.base_m + scale.step_m * n);
        let accepted = format!("in [{}, {}] m by settings.scale", ends[0].min(ends[1]), ends[0].max(ends[1]));
        return Err(Error::range(&format!("heights_m[{index}]"), &accepted, height));
    }
    check_free(index, number, settings)?;
    Ok(number as i32)
}

/// Checks that a known height is not written as the number for no data.
pub fn check_free(index: usize, number: f64, settings: &HeightSettings) -> Result<()> {
    if settings.no_data.is_some() && settings.is_no_data(number) {
        let accepted = format!("a number of no height; heights_m[{index}] has it");
        return Err(Error::range("settings.no_data", &accepted, number));
    }
    Ok(())
}
