//! The surface at a time in the form that shaders read: the single waves, and the tiles with their mip levels.

use std::f64::consts::TAU;

use glam::{DVec2, Vec4};
use half::{
    f16,
    slice::{HalfBitsSliceExt, HalfFloatSliceExt},
};

use super::{
    fft::SIDE,
    foam::AGE_STEP_S,
    surface::{SeaSurface, TileFields, to_tile},
    tiles::TILES,
    turn::{fraction, sin_cos},
};

/// Mip levels of a tile: from [`SIDE`] texels down to one.
pub(super) const MIPS: usize = SIDE.trailing_zeros() as usize + 1;
/// Single waves that shaders sum, at most.
pub(super) const MOST_WAVES: usize = 512;

/// A single wave (`SeaWave` of `shaders/sea/uniform.wgsl`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct WaveUniform {
    pub turns: [f32; 2],
    pub phase: f32,
    pub height: f32,
    pub turns_per_m: f32,
    pub length: f32,
    pub shift: f32,
    pub age_step: u32,
}

/// A tile (`SeaTile` of `shaders/sea/uniform.wgsl`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct TileUniform {
    pub anchor: [f32; 2],
    pub turn: [f32; 2],
    pub length: f32,
    pub lowering: f32,
    pub is_there: f32,
    pub octaves: f32,
}

/// Covariances of a tile's slopes at each mip level: east east, east north, north north.
pub(super) type TileSlopes = [[f32; 3]; MIPS];

/// Texels of all tiles at one mip level, tile after tile, as the bits of half floats.
type HalfTexels = Vec<[u16; 4]>;

/// The tiles of a surface, with mip levels.
pub(super) struct DrawnTiles {
    /// B-spline coefficients of height and displacement along the tile's axes.
    pub shapes: [HalfTexels; MIPS],
    /// Slopes along the tile's axes, and the compression, which is smoother.
    pub slopes: [HalfTexels; MIPS],
    /// Covariances of the slopes that a filtering look-up finds at each mip level, along the tile's axes: xx, xy, yy.
    covariances: [[[f64; 3]; MIPS]; TILES],
    /// One mip level of a tile, and the next coarser one.
    work: [Vec<Vec4>; 2],
    /// Slopes of a tile at its samples.
    finest: Vec<Vec4>,
}

/// Sums over all waves that are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct DrawnSums {
    /// Covariances of the slopes: east east, east north, north north.
    pub slopes: [f64; 3],
    /// Variance of the compression.
    pub compression: f64,
}

impl DrawnTiles {
    pub fn new() -> Self {
        let empty = || std::array::from_fn(|mip| vec![[0u16; 4]; TILES * (SIDE >> mip) * (SIDE >> mip)]);
        let texels = || vec![Vec4::ZERO; SIDE * SIDE];
        let covariances = [[[0.0; 3]; MIPS]; TILES];
        Self { shapes: empty(), slopes: empty(), covariances, work: [texels(), texels()], finest: texels() }
    }

    /// Fills all mip levels from the tiles of a surface.
    pub fn fill(&mut self, surface: &SeaSurface) {
        for (t, tile) in surface.tiles().iter().enumerate() {
            if tile.variance_m2 <= 0.0 {
                self.covariances[t] = [[0.0; 3]; MIPS];
                continue;
            }
            for (to, from) in self.work[0].iter_mut().zip(&tile.fields) {
                *to = Vec4::new(from[0] as f32, from[1] as f32, from[2] as f32, 0.0);
            }
            fill_slopes(&self.work[0], tile.length_m, &mut self.finest);
            each_mip(&mut self.work, |mip, texels| store(&mut self.shapes[mip], t, texels));
            self.work[0].copy_from_slice(&self.finest);
            let covariances = &mut self.covariances[t];
            let (levels, before) = (&mut self.slopes, &mut self.finest);
            each_mip(&mut self.work, |mip, texels| {
                covariances[mip] = filtered_covariances(texels, SIDE >> mip);
                if mip > 0 {
                    smooth_compression(before, texels, SIDE >> mip);
                    store(&mut levels[mip - 1], t, before);
                    before.truncate(0);
                    before.extend_from_slice(texels);
                }
            });
            store(&mut levels[MIPS - 1], t, before);
            before.resize(SIDE * SIDE, Vec4::ZERO);
        }
    }

    /// Returns the uniforms of a tile around an anchor on the map.
    pub fn uniform(&self, tile: &TileFields, anchor_m: DVec2) -> TileUniform {
        // Texel i of a texture has its middle at i + 1/2; sample i of a tile lies at i.
        let place = to_tile(tile.turn, anchor_m) / tile.length_m + 0.5 / SIDE as f64;
        TileUniform {
            anchor: [place.x - place.x.floor(), place.y - place.y.floor()].map(|v| v as f32),
            turn: tile.turn.as_vec2().to_array(),
            length: tile.length_m as f32,
            lowering: tile.lowering_m as f32,
            is_there: if tile.variance_m2 > 0.0 { 1.0 } else { 0.0 },
            octaves: libm::log2(SIDE as f64 / tile.length_m) as f32,
        }
    }

    /// Returns the covariances of a tile's slopes at each mip level: east east, east north, north north.
    pub fn slopes(&self, t: usize, tile: &TileFields) -> TileSlopes {
        let (c, s) = (tile.turn.x, tile.turn.y);
        self.covariances[t].map(|[xx, xy, yy]| {
            let east = c * c * xx - 2.0 * c * s * xy + s * s * yy;
            let across = c * s * (xx - yy) + (c * c - s * s) * xy;
            let north = s * s * xx + 2.0 * c * s * xy + c * c * yy;
            [east as f32, across as f32, north as f32]
        })
    }
}

/// Calls `act` with each mip level of the texels in `work[0]`: each texel is the mean of four texels of the next finer
/// level.
fn each_mip(work: &mut [Vec<Vec4>; 2], mut act: impl FnMut(usize, &[Vec4])) {
    for mip in 0..MIPS {
        let side = SIDE >> mip;
        act(mip, &work[0][..side * side]);
        let [from, to] = work;
        let rows = from[..side * side].chunks_exact(2 * side);
        for (rows, to) in rows.zip(to.chunks_exact_mut((side / 2).max(1))) {
            let (upper, lower) = rows.split_at(side);
            for ((a, b), texel) in upper.chunks_exact(2).zip(lower.chunks_exact(2)).zip(to) {
                *texel = 0.25 * ((a[0] + a[1]) + (b[0] + b[1]));
            }
        }
        work.swap(0, 1);
    }
}

/// Stores the texels of a tile.
fn store(level: &mut HalfTexels, t: usize, texels: &[Vec4]) {
    let to = &mut level[t * texels.len()..(t + 1) * texels.len()];
    to.as_flattened_mut().reinterpret_cast_mut::<f16>().convert_from_f32_slice(bytemuck::cast_slice(texels));
}

/// Writes the slopes and the compression at a tile's samples: the derivatives of its B-splines there. A derivative
/// along an axis is half the difference of the two neighbours on that axis, averaged across the axis with the weights
/// 1/6, 2/3 and 1/6.
fn fill_slopes(shapes: &[Vec4], length_m: f64, slopes: &mut [Vec4]) {
    let factor = (SIDE as f64 / length_m / 12.0) as f32;
    let row = |y: usize| &shapes[(y % SIDE) * SIDE..][..SIDE];
    // Weighted sums and differences of three rows, with the last column before the first and the first after the last.
    let (mut sums, mut differences) = ([Vec4::ZERO; SIDE + 2], [Vec4::ZERO; SIDE + 2]);
    for (y, to) in slopes.chunks_exact_mut(SIDE).enumerate() {
        let (low, middle, high) = (row(y + SIDE - 1), row(y), row(y + 1));
        for x in 0..SIDE {
            sums[x + 1] = low[x] + 4.0 * middle[x] + high[x];
            differences[x + 1] = high[x] - low[x];
        }
        for list in [&mut sums, &mut differences] {
            (list[0], list[SIDE + 1]) = (list[SIDE], list[1]);
        }
        for (x, texel) in to.iter_mut().enumerate() {
            let along_x = factor * (sums[x + 2] - sums[x]);
            let along_y = factor * (differences[x] + 4.0 * differences[x + 1] + differences[x + 2]);
            *texel = Vec4::new(along_x.x, along_y.x, -(along_x.y + along_y.z), 0.0);
        }
    }
}

/// Number of mip levels by which the compression of tiles is smoother than their slopes: the waves that make foam are
/// longer than the shortest ripples.
pub(super) const FOAM_MIPS: f32 = 0.8;

/// Makes the compression of a level's texels smoother, by mixing in that of the next coarser level, which has `side`
/// texels along a side.
fn smooth_compression(texels: &mut [Vec4], coarser: &[Vec4], side: usize) {
    let beside =
        |at: usize| (at / 2, if at.is_multiple_of(2) { (at / 2 + side - 1) % side } else { (at / 2 + 1) % side });
    for (y, row) in texels.chunks_exact_mut(2 * side).enumerate() {
        let (near, far) = beside(y);
        let (near, far) = (&coarser[near * side..][..side], &coarser[far * side..][..side]);
        for (x, texel) in row.iter_mut().enumerate() {
            let (a, b) = beside(x);
            let between = 0.5625 * near[a].z + 0.1875 * (near[b].z + far[a].z) + 0.0625 * far[b].z;
            texel.z += FOAM_MIPS * (between - texel.z);
        }
    }
}

/// Returns the covariances of the first two values that a bilinear look-up finds, over all places. Its weights along an
/// axis are 1 - a and a with a between 0 and 1. Their mean products over a are 1/3 for a texel with itself and 1/6 for
/// two neighbours. Over a bilinear patch the product of two functions has the mean 1/9 of the products at the same
/// corners, 1/18 of those at neighbours and 1/36 of those at opposite corners. The sum over all patches has each pair
/// of texels several times.
fn filtered_covariances(texels: &[Vec4], side: usize) -> [f64; 3] {
    let mut sums = [0.0f64; 3];
    for y in 0..side {
        let (row, next_row) = (&texels[y * side..][..side], &texels[(y + 1) % side * side..][..side]);
        let (mut squares, mut mixed) = (Vec4::ZERO, 0.0);
        for x in 0..side {
            let next = if x + 1 == side { 0 } else { x + 1 };
            let [a, b, c, d] = [row[x], row[next], next_row[x], next_row[next]];
            // Factor of each texel: the weighted sum of the texel itself and its neighbours to one side.
            let near = 4.0 / 9.0 * a + 2.0 / 9.0 * (b + c) + 1.0 / 18.0 * d;
            squares += a * near + 1.0 / 18.0 * (b * c);
            let half = 1.0 / 9.0 * (b + c) + 1.0 / 36.0 * d;
            mixed += 4.0 / 9.0 * a.x * a.y + a.x * half.y + a.y * half.x + 1.0 / 36.0 * (b.x * c.y + b.y * c.x);
        }
        let row = [squares.x, mixed, squares.y];
        sums.iter_mut().zip(row).for_each(|(sum, v)| *sum += f64::from(v));
    }
    sums.map(|sum| sum / (side * side) as f64)
}

/// Returns sine and cosine of a phase in turns as `unpack2x16snorm` reads them.
fn packed_turn(turns: f64) -> u32 {
    let (sin, cos) = sin_cos(turns);
    let [sin, cos] = [sin, cos].map(|v| u32::from((32_767.0 * v).round() as i16 as u16));
    sin | (cos << 16)
}

/// Writes the single waves of a surface around an anchor on the map, and returns the sums over all that is drawn.
pub(super) fn fill_waves(
    surface: &SeaSurface,
    tiles: &[TileSlopes; TILES],
    anchor_m: DVec2,
    waves: &mut Vec<WaveUniform>,
) -> DrawnSums {
    let mut sums = DrawnSums::default();
    waves.clear();
    for wave in surface.waves().take(MOST_WAVES) {
        let turns = wave.turns_per_m;
        let rise = TAU * wave.height_m * turns;
        let half = [rise.x * rise.x, rise.x * rise.y, rise.y * rise.y].map(|v| 0.5 * v);
        sums.slopes.iter_mut().zip(half).for_each(|(sum, v)| *sum += v);
        let squeeze = TAU * wave.shift_m.dot(turns);
        sums.compression += 0.5 * squeeze * squeeze;
        waves.push(WaveUniform {
            turns: turns.as_vec2().to_array(),
            phase: fraction(wave.phase + fraction(turns.x * anchor_m.x) + fraction(turns.y * anchor_m.y)) as f32,
            height: wave.height_m as f32,
            turns_per_m: turns.length() as f32,
            length: (1.0 / turns.length()) as f32,
            // The displacement is along the wave vector, so that one factor gives it.
            shift: (wave.shift_m.dot(turns) / turns.length_squared()) as f32,
            age_step: packed_turn(wave.frequency_hz * AGE_STEP_S),
        });
    }
    for tile in tiles {
        let own = tile[0].map(f64::from);
        sums.slopes.iter_mut().zip(own).for_each(|(sum, v)| *sum += v);
        sums.compression += own[0] + own[2];
    }
    sums
}
