//! Mesh of the drawn sea: square rings of blocks around the camera, on a lattice that is fixed in the world.
//!
//! A level has blocks of 8 by 8 cells. Its cells are twice as long as those of the level inside it. Around the camera a
//! level is a square of 8 by 8 blocks with a hole where the finer level lies (geometry clipmaps, Losasso and Hoppe
//! 2004). Towards its outer edge every second vertex moves onto its even neighbour, until the level has the vertices of
//! the next coarser one (continuous distance-dependent level of detail, Strugar 2010). How far vertices have moved
//! depends on their distance from the camera. This distance is the largest of the differences east and north and of the
//! camera's height, so that a camera that rises leaves the finest level without a jump.
//!
//! Coordinates of vertices are whole multiples of the finest cell. Two levels that meet therefore have the same bits at
//! their common vertices, and the same function of the place displaces both: there are no cracks. Vertices stay at
//! their places in the world while the camera moves: nothing swims.

use glam::DVec2;

/// Length of the finest cells, m. A power of two.
pub(super) const FINEST_M: f64 = 1.0 / 32.0;
/// Cells along a block's side.
pub(super) const CELLS: u32 = 8;
/// Blocks from the middle of a level to its edge.
const HALF: i64 = 4;
/// Distances from the camera, in sides of a level's blocks, between which its vertices move onto those of the next
/// coarser one. The hole of a level ends before the first of these distances, at 2.5 sides at most. The level itself
/// ends beyond the second, at 3 sides at least.
pub(super) const MORPH: [f64; 2] = [2.52, 2.98];
/// Levels, at most: the coarsest has cells of 32 km.
pub(super) const LEVELS: u32 = 21;
/// Blocks of all levels, at most.
pub(super) const MOST_BLOCKS: usize = 64 + 48 * (LEVELS as usize - 1);
/// Step of the anchor, m. Places on the lattice are relative to an anchor near the camera, whose coordinates are
/// multiples of this step.
const ANCHOR_M: f64 = 16.0;
/// Least ratio of a cell's distance to its length, for all cells but the finest. `SEA_CELLS_TO_DISTANCE` of the shaders
/// has the same value (tested).
pub(super) const CELLS_TO_DISTANCE: f64 = 11.9;

/// Marks of blocks.
pub(super) const REGION_MARK: i32 = 1;
pub(super) const WAKE_MARK: i32 = 2;
/// Number of different marks.
pub(super) const MARKS: usize = 4;

/// A block of the mesh as the vertex stage reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct MeshBlock {
    /// Corner of the block from the anchor, in finest cells.
    pub corner: [i32; 2],
    /// Level: the block's cells are 2^level finest cells long.
    pub level: i32,
    /// [`REGION_MARK`] if regions may reach the block, plus [`WAKE_MARK`] if wakes may. Blocks with different marks are
    /// drawn separately.
    pub marks: i32,
}

impl MeshBlock {
    /// Returns the corners with the least and the greatest coordinates, m from the anchor.
    pub fn bounds_m(&self) -> [[f32; 2]; 2] {
        let low = self.corner.map(|cells| cells as f32 * FINEST_M as f32);
        let side = side_m(self.level as u32) as f32;
        [low, low.map(|v| v + side)]
    }

    /// Returns the middle, m from the anchor, and the radius, m, of the circle through the corners.
    pub fn circle(&self) -> (DVec2, f64) {
        let [low, high] = self.bounds_m();
        let middle = DVec2::new(f64::from(low[0] + high[0]), f64::from(low[1] + high[1])) * 0.5;
        (middle, std::f64::consts::FRAC_1_SQRT_2 * side_m(self.level as u32))
    }
}

/// Camera over the lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MeshEye {
    /// Place of the camera on the map, m.
    pub place_m: DVec2,
    /// Height of the camera above the sea's level, m.
    pub height_m: f64,
    /// Distance up to which the sea is drawn, m.
    pub reach_m: f64,
}

impl MeshEye {
    /// Returns the anchor, m on the map.
    pub fn anchor_m(&self) -> DVec2 {
        (self.place_m / ANCHOR_M).round() * ANCHOR_M
    }

    /// Returns the finest level that is drawn: the first whose vertices under the camera have not all moved onto those
    /// of the next coarser one.
    pub fn first_level(&self) -> u32 {
        (0..LEVELS - 1).find(|level| MORPH[1] * side_m(*level) > self.height_m).unwrap_or(LEVELS - 1)
    }

    /// Writes the blocks that are near enough and visible into `blocks`, from fine to coarse. `is_visible` takes the
    /// middle of a block, m on the map relative to the camera, and half the block's side.
    pub fn blocks(&self, is_visible: impl Fn(DVec2, f64) -> bool, blocks: &mut Vec<MeshBlock>) {
        blocks.clear();
        let anchor = self.anchor_m();
        let first = self.first_level();
        for level in first..LEVELS {
            let side = side_m(level);
            let middle = middle_m(self.place_m, level);
            let hole = (level > first).then(|| middle_m(self.place_m, level - 1));
            for j in -HALF..HALF {
                for i in -HALF..HALF {
                    let corner = middle + DVec2::new(i as f64, j as f64) * side;
                    let center = corner + 0.5 * side;
                    if hole.is_some_and(|hole| (center - hole).abs().max_element() < 0.5 * HALF as f64 * side) {
                        continue;
                    }
                    let from_eye = center - self.place_m;
                    let nearest = (from_eye.abs() - 0.5 * side).max(DVec2::ZERO).length();
                    if nearest > self.reach_m || !is_visible(from_eye, 0.5 * side) {
                        continue;
                    }
                    let cells = (corner - anchor) / FINEST_M;
                    blocks.push(MeshBlock { corner: [cells.x as i32, cells.y as i32], level: level as i32, marks: 0 });
                }
            }
            if (HALF - 1) as f64 * side >= self.reach_m {
                break;
            }
        }
    }
}

/// Returns the side of a level's blocks, m.
pub(super) fn side_m(level: u32) -> f64 {
    f64::from(CELLS) * FINEST_M * f64::from(1u32 << level)
}

/// Returns the middle of a level around a place: the nearest place at which four blocks of the next coarser level meet.
fn middle_m(place_m: DVec2, level: u32) -> DVec2 {
    let step = 2.0 * side_m(level);
    (place_m / step).round() * step
}

/// Returns the vertex indices of a block's triangles.
pub(super) fn indices() -> Vec<u16> {
    let row = CELLS as u16 + 1;
    let cell = |i: u16, j: u16| {
        let at = j * row + i;
        [at, at + 1, at + row, at + row, at + 1, at + row + 1]
    };
    (0..CELLS as u16).flat_map(|j| (0..CELLS as u16).flat_map(move |i| cell(i, j))).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;
    use crate::chance::RandomStream;

    /// Place of a vertex from the anchor, m, in f32 as the shader computes it (`shaders/sea/mesh.wgsl`).
    fn rest_of(eye: &MeshEye, block: &MeshBlock, index: [u32; 2]) -> [f32; 2] {
        let cell = 1i32 << block.level;
        let own = (eye.place_m - eye.anchor_m()).as_vec2();
        let length = cell as f32 * FINEST_M as f32;
        let at = |axis: usize| (block.corner[axis] + index[axis] as i32 * cell) as f32 * FINEST_M as f32;
        let (x, y) = (at(0), at(1));
        let distance = (x - own.x).abs().max((y - own.y).abs()).max(eye.height_m as f32);
        let [from, until] = MORPH.map(|m| m as f32);
        let moved = ((distance / (length * CELLS as f32) - from) * (1.0 / (until - from))).clamp(0.0, 1.0);
        let odd = |axis: usize| (index[axis] & 1) as f32 * length;
        [x - odd(0) * moved, y - odd(1) * moved]
    }

    /// Counts the edges, away from the mesh's outer rim, that belong to only one of the triangles that have an area.
    fn open_edges(eye: &MeshEye) -> usize {
        let mut blocks = Vec::new();
        eye.blocks(|_, _| true, &mut blocks);
        let own = (eye.place_m - eye.anchor_m()).as_vec2();
        let key = |p: [f32; 2]| p.map(f32::to_bits);
        let mut edges: HashMap<_, i32> = HashMap::new();
        let triangles = indices();
        for block in &blocks {
            for corners in triangles.chunks_exact(3) {
                let row = CELLS + 1;
                let p: Vec<[f32; 2]> =
                    corners.iter().map(|v| rest_of(eye, block, [u32::from(*v) % row, u32::from(*v) / row])).collect();
                if key(p[0]) == key(p[1]) || key(p[1]) == key(p[2]) || key(p[2]) == key(p[0]) {
                    continue;
                }
                for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                    *edges.entry((key(p[a]), key(p[b]))).or_default() += 1;
                    *edges.entry((key(p[b]), key(p[a]))).or_default() -= 1;
                }
            }
        }
        let last = blocks.iter().map(|b| b.level).max().expect("blocks") as u32;
        let inside = |p: [u32; 2]| {
            let p = p.map(f32::from_bits);
            // Blocks beyond a circle of three sides are left out.
            f64::from((p[0] - own.x).hypot(p[1] - own.y)) < 2.4 * side_m(last)
        };
        edges.iter().filter(|((a, b), n)| **n != 0 && inside(*a) && inside(*b)).count()
    }

    #[test]
    fn triangles_meet_bit_by_bit() {
        let views = if std::env::var_os("WELKIN_ACCEPT").is_some() { 10_000 } else { 6 };
        let mut chance = RandomStream::new(5, 5);
        for view in 0..views {
            let far = if view % 3 == 0 { 1e6 } else { 1e3 };
            let place_m = DVec2::new(chance.even() - 0.5, chance.even() - 0.5) * far;
            let height_m = 0.3 * (4e4f64).powf(chance.even());
            // Three levels are enough: all meet alike.
            let eye = MeshEye { place_m, height_m, reach_m: 0.0 };
            let eye = MeshEye { reach_m: 3.0 * side_m((eye.first_level() + 2).min(LEVELS - 1)), ..eye };
            assert_eq!(open_edges(&eye), 0, "{eye:?}");
        }
    }

    #[test]
    fn cells_are_short_for_their_distance_and_blocks_are_bounded() {
        let mut chance = RandomStream::new(6, 6);
        let mut blocks = Vec::new();
        for _ in 0..300 {
            let place_m = DVec2::new(chance.even(), chance.even()) * 1e5;
            let eye = MeshEye { place_m, height_m: 0.5 * (2e5f64).powf(chance.even()), reach_m: 4e5 };
            eye.blocks(|_, _| true, &mut blocks);
            assert!(blocks.len() <= MOST_BLOCKS && blocks.len() >= 64);
            for block in &blocks {
                let cell = FINEST_M * f64::from(1u32 << block.level);
                let corner = DVec2::from(block.corner.map(f64::from)) * FINEST_M + eye.anchor_m() - place_m;
                let nearest = corner.max(-(corner + side_m(block.level as u32))).max_element().max(eye.height_m);
                assert!(cell <= FINEST_M || cell * CELLS_TO_DISTANCE <= nearest * 1.0001, "{block:?}");
            }
        }
    }
}
