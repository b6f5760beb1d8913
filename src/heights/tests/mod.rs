//! Height maps against GDAL's readings, the laws of resampling and noise, and what is refused.

mod files;
mod refusals;
mod relief;
mod resampling;

use super::{ByteOrder, HeightMap, HeightSettings, RawHeights, RawSample, RowOrder};
use crate::chance::RandomStream;

/// Map of random heights between two bounds, with one hole in so many samples; 0 for none.
fn random(columns: u32, rows: u32, range: [f64; 2], hole_in: u32, chance: &mut RandomStream) -> HeightMap {
    let height = |_| {
        let is_hole = hole_in > 0 && chance.even() < 1.0 / f64::from(hole_in);
        if is_hole { f32::NAN } else { (range[0] + (range[1] - range[0]) * chance.even()) as f32 }
    };
    HeightMap::new(columns, rows, (0..columns * rows).map(height).collect()).expect("good heights")
}

fn raw(map: &HeightMap, sample: RawSample, byte_order: ByteOrder, row_order: RowOrder) -> HeightSettings {
    let raw = RawHeights { columns: map.columns(), rows: map.rows(), sample, byte_order, row_order };
    HeightSettings { raw: Some(raw), ..Default::default() }
}

/// Largest difference of two maps' heights, which must be known in the same places.
fn difference(a: &HeightMap, b: &HeightMap) -> f64 {
    assert_eq!([a.columns(), a.rows()], [b.columns(), b.rows()]);
    let pairs = a.heights_m().iter().zip(b.heights_m());
    pairs.fold(0.0, |most, (a, b)| {
        assert_eq!(a.is_nan(), b.is_nan());
        if a.is_nan() { most } else { f64::max(most, f64::from((a - b).abs())) }
    })
}
