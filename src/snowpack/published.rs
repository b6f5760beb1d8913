//! Lying snow in the form in which other rooms read it.

use half::f16;

use super::{column::Column, field::SnowField};
use crate::surroundings::{LyingSnow, SnowHere};

/// Returns a column in the form that other rooms read.
pub(super) fn seen(column: &Column) -> SnowHere {
    SnowHere {
        depth_m: column.depth_m(),
        density_kg_m3: column.density_kg_m3(),
        wetness: column.wetness(),
        albedo: column.albedo(),
    }
}

/// Returns the depth (m), density (kg/m^3), wetness and albedo of a column.
fn texel(column: &Column) -> [f32; 4] {
    let s = seen(column);
    [s.depth_m, s.density_kg_m3, s.wetness, s.albedo].map(|v| v as f32)
}

/// Copies the snow on a field's cells to the world's `snow`, which other rooms read. Copies of tiles whose snow has not
/// changed stay as they are.
pub(super) fn publish(field: &SnowField, snow: &mut LyingSnow) {
    if field.lattice.is_none() {
        let cells = field.patches.first().map_or(0, |patch| patch.heights_m.len());
        snow.tiles.clear();
        snow.cells.clear();
        snow.cells.extend((0..cells).map(|cell| texel(&field.patches[0].column(cell))));
        snow.has_cells = snow.cells.iter().any(|c| c[0] > 0.0);
        return;
    }
    snow.cells.clear();
    let lies = |key: &[i32; 2]| field.find(*key).is_ok_and(|at| !field.patches[at].is_bare());
    snow.tiles.retain(|key, _| lies(key));
    for patch in field.patches.iter().filter(|patch| !patch.is_bare()) {
        let tile = snow.tiles.entry(patch.key).or_default();
        if tile.revision != patch.revision {
            tile.cells.clear();
            tile.cells.extend(patch.columns.iter().map(|c| texel(c).map(|v| f16::from_f32(v).to_bits())));
            tile.revision = patch.revision;
        }
    }
    snow.has_cells = !snow.tiles.is_empty();
}
