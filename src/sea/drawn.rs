//! The surface at a time in the form that shaders read: the single waves, and the tiles with their mip levels.

use std::f64::consts::TAU;

use glam::DVec2;
use half::f16;

use super::{
    fft::SIDE,
    surface::{SeaSurface, TileFields, to_tile},
    tiles::{TILES, VALUES},
    turn::fraction,
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
    pub shift: [f32; 2],
    pub turns_per_m: f32,
    pub lowering: f32,
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
    pub pad: f32,
    pub slopes: [[f32; 4]; MIPS],
}

/// Texels of all tiles at one mip level, tile after tile, as the bits of half floats.
type HalfTexels = Vec<[u16; 4]>;

/// The tiles of a surface, with mip levels.
pub(super) struct DrawnTiles {
    /// B-spline coefficients of height and displacement along the tile's axes.
    pub shapes: [HalfTexels; MIPS],
    /// Slopes along the tile's axes, and the compression.
    pub slopes: [HalfTexels; MIPS],
    /// Covariances of the slopes that a filtering look-up finds at each mip level, along the tile's axes: xx, xy, yy.
    covariances: [[[f64; 3]; MIPS]; TILES],
    /// One mip level of a tile, and the next.
    work: [Vec<[f32; 4]>; 2],
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
        let work = [vec![[0.0; 4]; SIDE * SIDE], vec![[0.0; 4]; SIDE * SIDE]];
        Self { shapes: empty(), slopes: empty(), covariances: [[[0.0; 3]; MIPS]; TILES], work }
    }

    /// Takes over the tiles of a surface.
    pub fn fill(&mut self, surface: &SeaSurface) {
        for (t, tile) in surface.tiles().iter().enumerate() {
            if tile.variance_m2 <= 0.0 {
                self.covariances[t] = [[0.0; 3]; MIPS];
                continue;
            }
            for (to, from) in self.work[0].iter_mut().zip(&tile.fields) {
                *to = [from[0] as f32, from[1] as f32, from[2] as f32, 0.0];
            }
            each_mip(&mut self.work, |mip, texels| store(&mut self.shapes[mip], t, texels));
            fill_slopes(tile, &mut self.work[0]);
            let covariances = &mut self.covariances[t];
            each_mip(&mut self.work, |mip, texels| {
                covariances[mip] = filtered_covariances(texels, SIDE >> mip);
                store(&mut self.slopes[mip], t, texels);
            });
        }
    }

    /// Returns the uniforms of a tile around an anchor on the map.
    pub fn uniform(&self, t: usize, tile: &TileFields, anchor_m: DVec2) -> TileUniform {
        // Texel i of a texture has its middle at i + 1/2; sample i of a tile lies at i.
        let place = to_tile(tile.turn, anchor_m) / tile.length_m + 0.5 / SIDE as f64;
        let (c, s) = (tile.turn.x, tile.turn.y);
        let turned = |[xx, xy, yy]: [f64; 3]| {
            let east = c * c * xx - 2.0 * c * s * xy + s * s * yy;
            let across = c * s * (xx - yy) + (c * c - s * s) * xy;
            let north = s * s * xx + 2.0 * c * s * xy + c * c * yy;
            [east as f32, across as f32, north as f32, 0.0]
        };
        TileUniform {
            anchor: [place.x - place.x.floor(), place.y - place.y.floor()].map(|v| v as f32),
            turn: tile.turn.as_vec2().to_array(),
            length: tile.length_m as f32,
            lowering: tile.lowering_m as f32,
            is_there: if tile.variance_m2 > 0.0 { 1.0 } else { 0.0 },
            pad: 0.0,
            slopes: self.covariances[t].map(turned),
        }
    }
}

/// Calls `act` with each mip level of the texels in `work[0]`: each texel is the mean of four of the level before.
fn each_mip(work: &mut [Vec<[f32; 4]>; 2], mut act: impl FnMut(usize, &[[f32; 4]])) {
    for mip in 0..MIPS {
        let side = SIDE >> mip;
        act(mip, &work[0][..side * side]);
        let half = side / 2;
        let [from, to] = work;
        for (i, texel) in to.iter_mut().enumerate().take(half * half) {
            let at = 2 * (i / half) * side + 2 * (i % half);
            let four = [from[at], from[at + 1], from[at + side], from[at + side + 1]];
            *texel = std::array::from_fn(|n| 0.25 * ((four[0][n] + four[1][n]) + (four[2][n] + four[3][n])));
        }
        work.swap(0, 1);
    }
}

/// Stores the texels of a tile.
fn store(level: &mut HalfTexels, t: usize, texels: &[[f32; 4]]) {
    let to = &mut level[t * texels.len()..(t + 1) * texels.len()];
    to.iter_mut().zip(texels).for_each(|(to, from)| *to = from.map(|v| f16::from_f32(v).to_bits()));
}

/// Writes the slopes and the compression at a tile's samples: the derivatives of its B-splines there.
fn fill_slopes(tile: &TileFields, texels: &mut [[f32; 4]]) {
    let per_m = SIDE as f64 / tile.length_m;
    let at = |x: usize, y: usize| -> &[f64; VALUES] { &tile.fields[(y % SIDE) * SIDE + x % SIDE] };
    for y in 0..SIDE {
        let (low, high) = (y + SIDE - 1, y + 1);
        for x in 0..SIDE {
            let (left, right) = (x + SIDE - 1, x + 1);
            // Weights 1/6, 2/3, 1/6 across, and half the difference along.
            let along_x = |n: usize| {
                let of = |row: usize| at(right, row)[n] - at(left, row)[n];
                per_m * (of(low) + 4.0 * of(y) + of(high)) / 12.0
            };
            let along_y = |n: usize| {
                let of = |column: usize| at(column, high)[n] - at(column, low)[n];
                per_m * (of(left) + 4.0 * of(x) + of(right)) / 12.0
            };
            let compression = -(along_x(1) + along_y(2));
            texels[y * SIDE + x] = [along_x(0) as f32, along_y(0) as f32, compression as f32, 0.0];
        }
    }
}

/// Returns the covariances of the first two values that a bilinear look-up finds, over all places. Its weights along an
/// axis are 1 - a and a with a between 0 and 1. Their mean products over a are 1/3 for a texel with itself and 1/6 for
/// two neighbours.
fn filtered_covariances(texels: &[[f32; 4]], side: usize) -> [f64; 3] {
    let mut sums = [0.0f64; 3];
    for y in 0..side {
        let next_row = ((y + 1) % side) * side;
        for x in 0..side {
            let next = (x + 1) % side;
            let [a, b, c, d] = [y * side + x, y * side + next, next_row + x, next_row + next].map(|i| texels[i]);
            // The mean over a bilinear patch of the product of two functions with these corners.
            let product = |m: usize, n: usize| {
                let [am, bm, cm, dm] = [a[m], b[m], c[m], d[m]];
                let [an, bn, cn, dn] = [a[n], b[n], c[n], d[n]];
                let own = am * an + bm * bn + cm * cn + dm * dn;
                let beside = am * bn + bm * an + cm * dn + dm * cn + am * cn + cm * an + bm * dn + dm * bn;
                let across = am * dn + dm * an + bm * cn + cm * bn;
                f64::from(own / 9.0 + beside / 18.0 + across / 36.0)
            };
            sums[0] += product(0, 0);
            sums[1] += product(0, 1);
            sums[2] += product(1, 1);
        }
    }
    sums.map(|sum| sum / (side * side) as f64)
}

/// Writes the single waves of a surface around an anchor on the map, and returns the sums over all that is drawn.
pub(super) fn fill_waves(
    surface: &SeaSurface,
    tiles: &[TileUniform; TILES],
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
            shift: wave.shift_m.as_vec2().to_array(),
            turns_per_m: turns.length() as f32,
            lowering: wave.lowering_m as f32,
        });
    }
    for tile in tiles {
        let own = tile.slopes[0].map(f64::from);
        sums.slopes.iter_mut().zip(own).for_each(|(sum, v)| *sum += v);
        sums.compression += own[0] + own[2];
    }
    sums
}
