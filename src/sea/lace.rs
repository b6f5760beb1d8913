//! Pattern of foam: a tile of ranks by which shaders lay a share of foam out as holes, threads and flakes.
//!
//! The value of a texel is its rank among all texels of its mip level, from 0 to 1. Where foam covers a share of the
//! water, the texels of lower rank are white: their area is that share. Holes are around the points of three scattered
//! lattices (Worley 1996), as bubbles leave them. The lattices are bent, and a rough noise is added, so that the holes
//! do not look like cells.

use crate::chance::RandomStream;

/// Texels along a side.
pub(super) const LACE_SIDE: usize = 256;
/// Number of mip levels. Shaders fade the patterns out towards the coarsest ones.
pub(super) const LACE_MIPS: usize = 6;
/// Stream of the pattern's random numbers, the same for all seas.
const LACE_SEED: u64 = 0x6c61_6365;
/// Cells along a side of each lattice of points, and the weight of the distance to its nearest point.
const LATTICES: [(usize, f32); 3] = [(9, 1.0), (21, 0.6), (47, 0.35)];
/// Cells along a side of the noises that bend the lattices, with the size of the bends as a share of the tile.
const BENDS: [(usize, f32); 3] = [(6, 0.03), (20, 0.012), (50, 0.004)];
/// Cells along a side of the noises that gather foam in patches, with their weight.
const PATCHES: [(usize, f32); 3] = [(4, 0.2), (9, 0.14), (19, 0.08)];

/// A noise that repeats after the tile: values at the nodes of a lattice, and smooth between them.
struct TiledNoise {
    cells: usize,
    nodes: Vec<f32>,
}

impl TiledNoise {
    fn new(cells: usize, chance: &mut RandomStream) -> Self {
        Self { cells, nodes: (0..cells * cells).map(|_| 2.0 * chance.even() as f32 - 1.0).collect() }
    }

    /// Returns the value at a place within the tile, in \[-1, 1\].
    fn at(&self, [x, y]: [f32; 2]) -> f32 {
        let split = |v: f32| {
            let cells = v * self.cells as f32;
            let (first, t) = (cells.floor(), cells - cells.floor());
            (first as usize % self.cells, t * t * (3.0 - 2.0 * t))
        };
        let ((column, u), (row, v)) = (split(x), split(y));
        let node =
            |right: usize, up: usize| self.nodes[(row + up) % self.cells * self.cells + (column + right) % self.cells];
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        mix(mix(node(0, 0), node(1, 0), u), mix(node(0, 1), node(1, 1), u), v)
    }
}

/// A point scattered in each cell of a lattice that repeats after the tile.
struct TiledPoints {
    cells: usize,
    points: Vec<[f32; 2]>,
}

impl TiledPoints {
    fn new(cells: usize, chance: &mut RandomStream) -> Self {
        Self { cells, points: (0..cells * cells).map(|_| [chance.even() as f32, chance.even() as f32]).collect() }
    }

    /// Returns the distance from a place within the tile to the nearest point, in cells.
    fn distance(&self, place: [f32; 2]) -> f32 {
        let [x, y] = place.map(|v| v * self.cells as f32);
        let (column, row) = (x.floor(), y.floor());
        let mut nearest = f32::INFINITY;
        for up in -2..=2 {
            for right in -2..=2 {
                let of = |first: f32, step: i32| (first as i32 + step).rem_euclid(self.cells as i32) as usize;
                let [px, py] = self.points[of(row, up) * self.cells + of(column, right)];
                let (dx, dy) = (column + right as f32 + px - x, row + up as f32 + py - y);
                nearest = nearest.min(dx * dx + dy * dy);
            }
        }
        nearest.sqrt()
    }
}

/// Returns the pattern before it is ranked: foam gathers where values are low.
fn raw_pattern() -> Vec<f32> {
    let mut chance = RandomStream::new(LACE_SEED, 0);
    let mut noise = |(cells, size): (usize, f32)| (TiledNoise::new(cells, &mut chance), size);
    let [bends_x, bends_y, patches] = [BENDS, BENDS, PATCHES].map(|list| list.map(&mut noise));
    let lattices = LATTICES.map(|(cells, weight)| (TiledPoints::new(cells, &mut chance), weight));
    let sum = |list: &[(TiledNoise, f32)], at: [f32; 2]| list.iter().map(|(n, size)| size * n.at(at)).sum::<f32>();
    let along = |i: usize| (i as f32 + 0.5) / LACE_SIDE as f32;
    let mut pattern = Vec::with_capacity(LACE_SIDE * LACE_SIDE);
    for row in 0..LACE_SIDE {
        for column in 0..LACE_SIDE {
            let at = [along(column), along(row)];
            let bent = [at[0] + sum(&bends_x, at), at[1] + sum(&bends_y, at)].map(|v| v - v.floor());
            let holes: f32 = lattices.iter().map(|(points, weight)| weight * points.distance(bent)).sum();
            pattern.push(sum(&patches, at) - holes);
        }
    }
    pattern
}

/// Returns the ranks of values among all of them, in 255ths.
fn ranks(values: &[f32]) -> Vec<u8> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_unstable_by(|a, b| values[*a].total_cmp(&values[*b]).then(a.cmp(b)));
    let mut ranks = vec![0; values.len()];
    for (rank, at) in order.into_iter().enumerate() {
        ranks[at] = ((rank as f32 + 0.5) * 255.0 / values.len() as f32).round() as u8;
    }
    ranks
}

/// Returns the mip levels of the pattern, from fine to coarse.
pub(super) fn lace_levels() -> Vec<Vec<u8>> {
    let mut pattern = raw_pattern();
    let mut levels = Vec::with_capacity(LACE_MIPS);
    for mip in 0..LACE_MIPS {
        levels.push(ranks(&pattern));
        let side = LACE_SIDE >> mip;
        let mean = |i: usize| {
            let first = 2 * (i / (side / 2)) * side + 2 * (i % (side / 2));
            0.25 * (pattern[first] + pattern[first + 1] + pattern[first + side] + pattern[first + side + 1])
        };
        pattern = (0..side * side / 4).map(mean).collect();
    }
    levels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_share_is_covered_at_every_mip_level() {
        for (mip, level) in lace_levels().iter().enumerate() {
            assert_eq!(level.len(), (LACE_SIDE >> mip) * (LACE_SIDE >> mip));
            for share in [0.02, 0.1, 0.5, 0.9] {
                let white = level.iter().filter(|rank| f32::from(**rank) < 255.0 * share).count();
                let found = white as f32 / level.len() as f32;
                let texel = 1.0 / level.len() as f32;
                assert!((found - share).abs() < 0.004 + 0.5 * texel, "{mip}: {found} of {share}");
            }
        }
    }

    #[test]
    fn the_pattern_repeats_without_a_seam() {
        let level = &lace_levels()[0];
        let step = |a: usize, b: usize| (f32::from(level[a]) - f32::from(level[b])).abs();
        let mean = |columns: [usize; 2]| {
            (0..LACE_SIDE).map(|i| step(i * LACE_SIDE + columns[0], i * LACE_SIDE + columns[1])).sum::<f32>()
                / LACE_SIDE as f32
        };
        let inner: f32 = (0..16).map(|n| mean([16 * n, 16 * n + 1])).sum::<f32>() / 16.0;
        let edge = mean([LACE_SIDE - 1, 0]);
        assert!(edge < 1.5 * inner && inner > 1.0, "{edge} {inner}");
    }
}
