//! Share of the waves that pixels show: the slopes' covariances by distance and direction, as a table for the shaders,
//! and the single waves that the pixels of a level of the mesh have to sum.

use std::f32::consts::TAU;

use half::f16;

use super::{
    drawn::{FOAM_MIPS, MIPS, TileSlopes, WaveUniform},
    mesh::{CELLS_TO_DISTANCE, MeshBlock},
    tiles::TILES,
    uniform::SeaUniform,
};

/// Sides of the table: distances, and directions over half a circle (covariances are the same in opposite directions).
pub(super) const SEEN_SIDES: [usize; 2] = [32, 16];

/// Copies of constants of `shaders/sea/surface.wgsl`, where they have the prefix `SEA_` and are described.
pub(super) const LEAST_CELLS: f32 = 1.5;
pub(super) const SMOOTH_CELLS: f32 = 3.0;
pub(super) const PIXEL_DEVIATION: f32 = 0.4;
pub(super) const MOST_LENGTHENED: f32 = 2.0;
pub(super) const FLAT_MIP: f32 = 5.0;
/// Margin for rounding where the waves of a level are chosen.
const MARGIN: f32 = 1.001;

/// Blocks of a level that are drawn together (`SeaBand` of `shaders/sea/uniform.wgsl`): the single waves that their
/// pixels sum, given by the first and the one after the last, and the numbers of regions and wakes that may reach the
/// blocks.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct SeaBand {
    pub first: u32,
    pub last: u32,
    pub regions: u32,
    pub is_open: u32,
    pub wakes: u32,
    pub pad: [u32; 3],
}

impl SeaBand {
    /// All waves and wakes, and no regions.
    pub const WHOLE: Self = Self { first: 0, last: u32::MAX, regions: 0, is_open: 1, wakes: u32::MAX, pad: [0; 3] };
}

/// Filter of a pixel on the level surface, as `footprint_at` of `shaders/sea/surface.wgsl` has it.
struct PixelFilter {
    /// Standard deviations along the view and across, m.
    along: f32,
    across: f32,
    /// Wave number from which on no single wave is told apart, turns per metre.
    last: f32,
}

impl PixelFilter {
    /// Returns the filter at a distance from the eye.
    fn at(sea: &SeaUniform, range: f32) -> Self {
        let across = PIXEL_DEVIATION * sea.pixel * range;
        let tilted = (sea.height * sea.height / (range * range) + 0.25 * sea.slopes[3]).sqrt();
        let along = across / tilted.min(1.0);
        Self { along, across, last: 0.39 / across.max(along / MOST_LENGTHENED) }
    }

    /// Returns the share of a wave's amplitude that passes, seen in a direction.
    fn share(&self, wave: &WaveUniform, [x, y]: [f32; 2]) -> f32 {
        let along = (wave.turns[0] * x + wave.turns[1] * y) * self.along;
        let across = (wave.turns[0] * y - wave.turns[1] * x) * self.across;
        let end = wave.turns_per_m / self.last;
        let left = 1.0 - (6.579_736 * (along * along + across * across)).max(end * end);
        left.max(0.0) * left.max(0.0)
    }
}

/// Returns the covariances of the slopes of all single waves that a pixel shows in a direction at a distance from the
/// eye, and half the variance of the slopes that are not in the mesh.
fn seen_slopes(sea: &SeaUniform, waves: &[WaveUniform], range: f32, direction: [f32; 2]) -> [f32; 4] {
    let level = (range * range - sea.height * sea.height).max(0.0).sqrt();
    let distance = (level * direction[0].abs().max(direction[1].abs())).max(sea.height);
    let (filter, cells) = (PixelFilter::at(sea, range), CELLS_TO_DISTANCE as f32 / (LEAST_CELLS * distance));
    let mut sums = [0.0; 4];
    for wave in waves.iter().take_while(|wave| wave.turns_per_m < filter.last) {
        let rise = TAU * wave.height * filter.share(wave, direction);
        let (x, y) = (rise * wave.turns[0], rise * wave.turns[1]);
        let out = 1.0 - (cells * wave.length - 1.0).clamp(0.0, 1.0);
        let half = [0.5 * x * x, 0.5 * x * y, 0.5 * y * y, 0.25 * (x * x + y * y) * out];
        sums.iter_mut().zip(half).for_each(|(sum, v)| *sum += v);
    }
    sums
}

/// Returns the unit vector of a row of the table; the shaders find rows by `seen_row`.
fn direction(row: usize) -> [f32; 2] {
    let v = row as f32 / SEEN_SIDES[1] as f32;
    // Cosine and sine of twice the angle, up to a common factor.
    let sine = if v < 0.25 {
        4.0 * v
    } else if v < 0.75 {
        2.0 - 4.0 * v
    } else {
        4.0 * v - 4.0
    };
    let cosine = if (0.25..0.75).contains(&v) { sine.abs() - 1.0 } else { 1.0 - sine.abs() };
    let angle = 0.5 * libm::atan2f(sine, cosine);
    [libm::cosf(angle), libm::sinf(angle)]
}

/// Returns the covariances of a tile's slopes that are shown at a mip level: two levels are mixed. The slopes of the
/// coarser one are in both, so that only the rest of the finer one becomes smaller.
fn shown_slopes(tile: &TileSlopes, mip: f32) -> [f32; 3] {
    let (low, part) = (mip as usize, 1.0 - mip.fract());
    let [fine, coarse] = [low, low + 1].map(|level| tile[level.min(MIPS - 1)]);
    std::array::from_fn(|n| coarse[n] + (fine[n] - coarse[n]) * (part * part))
}

/// Returns the covariances of those slopes of the tiles that a pixel at a distance shows, and the variance of the
/// smoother slopes that make foam.
fn seen_tiles(sea: &SeaUniform, tiles: &[TileSlopes; TILES], range: f32) -> ([f32; 3], f32) {
    let filter = PixelFilter::at(sea, range);
    let width = filter.across.max(filter.along / MOST_LENGTHENED) / PIXEL_DEVIATION;
    let (mut seen, mut smooth) = ([0.0; 3], 0.0);
    for (tile, slopes) in sea.tiles.iter().zip(tiles) {
        let mip = (libm::log2f(width) + tile.octaves).max(0.0);
        if tile.is_there > 0.0 && mip < FLAT_MIP + 1.0 {
            seen.iter_mut().zip(shown_slopes(slopes, mip)).for_each(|(sum, v)| *sum += v);
            let shown = shown_slopes(slopes, mip + FOAM_MIPS);
            smooth += shown[0] + shown[2];
        }
    }
    (seen, smooth)
}

/// Writes the two layers of the table. Columns are distances in equal ratios from the camera's height to the farthest
/// place, rows are directions.
pub(super) fn fill_seen(
    sea: &SeaUniform,
    waves: &[WaveUniform],
    tiles: &[TileSlopes; TILES],
    table: &mut Vec<[u16; 4]>,
) {
    let [columns, rows] = SEEN_SIDES;
    let half = |texel: [f32; 4]| texel.map(|v| f16::from_f32(v).to_bits());
    table.clear();
    table.resize(2 * columns * rows, [0; 4]);
    let (first, second) = table.split_at_mut(columns * rows);
    for column in 0..columns {
        let range = sea.height * libm::exp2f(column as f32 / ((columns - 1) as f32 * sea.seen_per_octave));
        let (tiled, smooth) = seen_tiles(sea, tiles, range);
        for row in 0..rows {
            let [xx, xy, yy, mapped] = seen_slopes(sea, waves, range, direction(row));
            let all = [xx + tiled[0], xy + tiled[1], yy + tiled[2], mapped + 0.5 * (tiled[0] + tiled[2])];
            first[row * columns + column] = half(all);
            second[row * columns + column] = half([xx + yy + smooth, 0.0, 0.0, 0.0]);
        }
    }
}

/// Returns the waves that the pixels of some blocks have to sum, without regions and wakes.
pub(super) fn band_of(sea: &SeaUniform, waves: &[WaveUniform], blocks: &[MeshBlock]) -> SeaBand {
    let (mut nearest, mut farthest) = (f32::INFINITY, sea.height);
    for block in blocks {
        let [lows, highs] = block.bounds_m().map(|corner| [corner[0] - sea.eye[0], corner[1] - sea.eye[1]]);
        let off = |axis: usize| lows[axis].max(-highs[axis]).max(0.0);
        let far = |axis: usize| highs[axis].max(-lows[axis]);
        nearest = nearest.min((off(0) * off(0) + off(1) * off(1) + sea.height * sea.height).sqrt());
        farthest = farthest.max(far(0)).max(far(1));
    }
    // The longer waves before the first are wholly in the slopes of the vertices.
    let smooth = CELLS_TO_DISTANCE as f32 / (2.0 * SMOOTH_CELLS * farthest * MARGIN);
    let last = PixelFilter::at(sea, nearest).last * MARGIN;
    let first = waves.partition_point(|wave| wave.turns_per_m < smooth);
    let last = waves.partition_point(|wave| wave.turns_per_m < last);
    SeaBand { first: first as u32, last: last as u32, wakes: 0, ..SeaBand::WHOLE }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Row of a direction, as `seen_row` of `shaders/sea/surface.wgsl` has it.
    fn row_of([x, y]: [f32; 2]) -> f32 {
        let (cosine, sine) = (x * x - y * y, 2.0 * x * y);
        let quarter = 0.25 * sine / (cosine.abs() + sine.abs());
        (if cosine >= 0.0 { quarter } else { 0.5 - quarter }).rem_euclid(1.0)
    }

    #[test]
    fn rows_are_those_of_their_directions() {
        for row in 0..SEEN_SIDES[1] {
            let off = row_of(direction(row)) - row as f32 / SEEN_SIDES[1] as f32;
            assert!((off - off.round()).abs() < 1e-6, "{row}: {off}");
        }
    }
}
