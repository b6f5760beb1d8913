//! Selection of the patches that a picture shows: a quadtree whose levels follow the distance from the eye.
//!
//! A level is used up to a distance, its reach, at which the error of the next coarser level is as small as the host
//! asks. Distances combine the horizontal distance with the height of the eye above one reference height, so that they
//! depend on the place alone and not on the ground's height there. The vertices of a level move onto those of the next
//! coarser one before its reach ends (Strugar 2010). Where two levels meet, the vertices of the finer one have all
//! moved onto the coarser one's, and those of the coarser one have not begun to move. Both levels then have the same
//! vertices there, without a crack.

use glam::{DMat4, DVec2, DVec3, DVec4};

use super::relief::{LEVELS, NODE, NodeKey, Relief};
use crate::scene::Camera;

/// Squares along a side of a patch, the unit that is drawn: a quarter of a node.
pub(super) const PATCH: i32 = NODE / 2;
/// Shortest and longest reach of a level, in sides of its squares.
pub(super) const SHORTEST_REACH: f64 = 40.0;
const LONGEST_REACH: f64 = 160.0;
/// Diagonal of a node, in sides of its squares, rounded up. A node that begins within the reach of its level ends
/// within this distance beyond it.
const DIAGONAL: f64 = 23.0;
/// Side of a square in the picture, pixels: in perspective a level is used at least down to this size, with parallel
/// rays at most up to it.
const LONGEST_SIDE_PX: f64 = 10.0;
/// Largest ratio of the distances used here, which put all ground at the reference height ([`Relief::reference_m`]), to
/// the true ones.
const FARTHER: f64 = 1.07;
/// Least ratio of a level's reach to the distance at which its vertices begin to move.
const LEAST_BAND: f64 = 1.25;
/// Share of a level's reach at which its vertices begin to move, unless the next finer level ends farther away.
const LATEST_START: f64 = 0.7;
/// Largest error of a distance in single precision, as a share of the distance.
const ROUNDING: f64 = 1e-4;
/// Largest number of patches of a picture. A picture that would have more is drawn with coarser levels.
const MOST_PATCHES: usize = 4096;

/// Part of the lattice that is drawn at one level, from the page of a node of that level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LandPatch {
    pub page: NodeKey,
    /// Quarter of the node: 0 or 1 to the east and to the north.
    pub quarter: [i32; 2],
}

impl LandPatch {
    /// Lattice position of the south-western corner.
    pub fn low(self) -> [i32; 2] {
        let low = self.page.low();
        [0, 1].map(|i| low[i] + self.quarter[i] * (PATCH << self.page.level))
    }
}

impl LandPatch {
    /// Corners of the box around the patch's ground, m along the lattice's axes from its origin.
    pub fn corners_m(self, relief: &Relief, cell_m: f64) -> [DVec3; 2] {
        let (low, side) = (self.low(), PATCH << self.page.level);
        let heights = relief.bounds(self.page).unwrap_or_default();
        [0, 1].map(|i| {
            let plan = low.map(|v| f64::from(v + side * i as i32) * cell_m);
            DVec3::new(plan[0], plan[1], f64::from(heights[i]))
        })
    }
}

/// Distances by which levels are chosen and vertices moved, for one picture. Lengths are in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LevelDistances {
    /// Place of the eye on the lattice.
    pub eye: DVec2,
    /// Height of the eye above the reference height, at least 0. For parallel rays, and for a picture of too many
    /// patches, it is instead the distance that selects the level wanted.
    pub above: f64,
    /// Weight of the horizontal distance: 1, or 0 for parallel rays, whose pixels are equally large at any distance.
    pub spread: f64,
    /// Distances up to which the levels are used.
    pub reach: [f64; LEVELS],
}

impl LevelDistances {
    /// Returns the distances for a camera. `eye` is in cells, `eye_m` its height above the terrain's origin,
    /// `height_px` the height of the picture, `error_px` the vertical error that the host accepts.
    pub fn new(
        relief: &mut Relief,
        camera: &Camera,
        (eye, eye_m): (DVec2, f64),
        cell_m: f64,
        (height_px, error_px): (f64, f64),
    ) -> Self {
        // Size of a pixel in the picture's middle: its angle, or its side in metres for parallel rays.
        let pixel = 2.0 / (camera.projection.y_axis.y.abs().max(1e-12) * height_px.max(1.0));
        let errors_m = relief.errors_m();
        if camera.is_orthographic() {
            let is_fine = |level: &usize| {
                let side_m = cell_m * f64::from(1u32 << *level);
                side_m <= LONGEST_SIDE_PX * pixel && errors_m[*level] <= error_px * pixel
            };
            let level = (1..LEVELS).take_while(is_fine).last().unwrap_or(0);
            let reach = Self::reach_for(|_| SHORTEST_REACH);
            // This distance is beyond the reach of the next finer level, and less than that at which the vertices of
            // this level begin to move.
            let above = if level == 0 { 0.0 } else { 1.05 * reach[level - 1] };
            return Self { eye, above, spread: 0.0, reach };
        }
        let reach = Self::reach_for(|level| {
            let error = errors_m.get(level + 1).copied().unwrap_or(0.0) / (cell_m * f64::from(1u32 << level));
            FARTHER * (error / (error_px * pixel)).max(1.0 / (LONGEST_SIDE_PX * pixel))
        });
        let above = ((eye_m - relief.reference_m(eye, cell_m)) / cell_m).max(0.0);
        Self { eye, above, spread: 1.0, reach }
    }

    /// Returns the reach of each level, cells. `wanted` returns the reach that a level should have, in sides of its
    /// squares. A level reaches so far beyond the next finer one that its vertices have enough distance in which to
    /// move.
    pub fn reach_for(wanted: impl Fn(usize) -> f64) -> [f64; LEVELS] {
        let (mut reach, mut begins): ([f64; LEVELS], f64) = ([0.0; LEVELS], 0.0);
        for (level, reach) in reach.iter_mut().enumerate() {
            let side = f64::from(1u32 << level);
            *reach = (wanted(level).clamp(SHORTEST_REACH, LONGEST_REACH) * side).max(LEAST_BAND * begins);
            begins = *reach + DIAGONAL * side;
        }
        reach
    }

    /// Distance at which the vertices of a level begin to move, and at which they have arrived, cells.
    pub fn morph(&self, level: usize) -> [f64; 2] {
        let below = if level == 0 { 0.0 } else { self.reach[level - 1] + 0.5 * DIAGONAL * f64::from(1u32 << level) };
        let start = below.max(LATEST_START * self.reach[level]);
        [start * (1.0 + ROUNDING), self.reach[level] * (1.0 - ROUNDING)]
    }

    /// Distance of a node from the eye, cells.
    pub fn distance(&self, node: NodeKey) -> f64 {
        (self.spread * node.distance(self.eye)).hypot(self.above)
    }
}

/// Planes of the camera's frustum, in metres from the eye along the lattice's axes.
#[derive(Clone, Copy)]
pub(super) struct LandFrustum {
    planes: [DVec4; 5],
    /// Side of a cell, m, and the place of the eye: cells east and north, and the height in metres.
    cell_m: f64,
    eye: DVec3,
}

impl LandFrustum {
    /// Returns the frustum of a matrix from the lattice's axes about the eye, m, to clip space. `eye` is in cells, with
    /// its height in metres.
    pub fn new(clip: DMat4, eye: DVec3, cell_m: f64) -> Self {
        let rows = clip.transpose();
        let (x, y, w) = (rows.x_axis, rows.y_axis, rows.w_axis);
        Self { planes: [w + x, w - x, w + y, w - y, w], cell_m, eye }
    }

    /// Returns the box of a shadow map, open towards the light. The arguments are as those of [`Self::new`].
    pub fn of_light(clip: DMat4, eye: DVec3, cell_m: f64) -> Self {
        let mut planes = Self::new(clip, eye, cell_m);
        planes.planes[4] = clip.transpose().z_axis;
        planes
    }

    /// Whether a box of the lattice may be in the picture.
    fn sees(&self, low: [i32; 2], side: i32, heights: [f32; 2]) -> bool {
        let x = [low[0], low[0] + side].map(|v| (f64::from(v) - self.eye.x) * self.cell_m);
        let y = [low[1], low[1] + side].map(|v| (f64::from(v) - self.eye.y) * self.cell_m);
        let z = heights.map(|v| f64::from(v) - self.eye.z);
        self.planes.iter().all(|plane| {
            let most = |v: [f64; 2], n: f64| (v[0] * n).max(v[1] * n);
            most(x, plane.x) + most(y, plane.y) + most(z, plane.z) + plane.w > 0.0
        })
    }
}

/// Selects the patches of a picture, roughly from near to far. If they are too many, `detail` is made coarser.
pub(super) fn select(
    relief: &Relief,
    detail: &mut LevelDistances,
    frustum: &LandFrustum,
    patches: &mut Vec<LandPatch>,
) {
    loop {
        patches.clear();
        let selection = Selection { relief, detail, frustum };
        let mut roots = [NodeKey { level: 0, x: 0, y: 0 }; 4];
        let count = relief.roots().len().min(4);
        roots[..count].copy_from_slice(&relief.roots()[..count]);
        selection.sort(&mut roots[..count]);
        roots[..count].iter().for_each(|root| selection.add(*root, patches));
        if patches.len() <= MOST_PATCHES {
            return;
        }
        detail.above = 2.0 * detail.above.max(detail.reach[0]);
    }
}

struct Selection<'a> {
    relief: &'a Relief,
    detail: &'a LevelDistances,
    frustum: &'a LandFrustum,
}

impl Selection<'_> {
    fn sort(&self, nodes: &mut [NodeKey]) {
        nodes.sort_by(|a, b| a.distance(self.detail.eye).total_cmp(&b.distance(self.detail.eye)));
    }

    fn sees(&self, node: NodeKey, bounds: [f32; 2]) -> bool {
        self.frustum.sees(node.low(), node.side(), bounds)
    }

    /// Adds the patches in the picture of a node that lies within the reach of its level, or is a root. Children beyond
    /// the reach of their level are drawn as quarters of this node.
    fn add(&self, node: NodeKey, patches: &mut Vec<LandPatch>) {
        if patches.len() > MOST_PATCHES {
            return;
        }
        let Some(bounds) = self.relief.bounds(node) else { return };
        if !self.sees(node, bounds) {
            return;
        }
        if node.level == 0 {
            patches.extend(QUARTERS.map(|quarter| LandPatch { page: node, quarter }));
            return;
        }
        let mut children = node.children();
        self.sort(&mut children);
        for child in children {
            if self.detail.distance(child) < self.detail.reach[usize::from(child.level)] {
                self.add(child, patches);
            } else if self.relief.bounds(child).is_some_and(|bounds| self.sees(child, bounds)) {
                patches.push(LandPatch { page: node, quarter: [child.x - 2 * node.x, child.y - 2 * node.y] });
            }
        }
    }
}

const QUARTERS: [[i32; 2]; 4] = [[0, 0], [1, 0], [0, 1], [1, 1]];
