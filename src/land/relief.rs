//! Bounds of a terrain's heights in a quadtree, and the errors that decide how far each level of detail reaches.

use std::collections::HashMap;

use glam::DVec2;

use super::cells::CellReader;
use crate::{
    chance::RandomStream,
    terrain::{CellRect, Terrain},
};

/// Squares along a side of a node, at every level.
pub(super) const NODE: i32 = 16;
/// Level of the largest node: its side is 2^30 cells.
pub(super) const MOST_LEVELS: u8 = 26;
/// Number of levels.
pub(super) const LEVELS: usize = MOST_LEVELS as usize + 1;
/// Number of places at which the error of each level is measured.
const SAMPLES: u32 = 1024;
/// Quantile of the measured errors that is taken as a level's error: of a normal distribution, this share lies within
/// three standard deviations.
const HELD_SHARE: f64 = 0.9973;
/// Slope, rise over run, at which the reference height falls with the distance from high ground
/// ([`Relief::reference_m`]).
const CONE: f64 = 0.125;

/// Node of the quadtree over the lattice: `NODE` x `NODE` squares whose sides are 2^level cells. `x` and `y` count the
/// nodes of the level east and north of the terrain's origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct NodeKey {
    pub level: u8,
    pub x: i32,
    pub y: i32,
}

impl NodeKey {
    /// Lattice position of the south-western corner.
    pub fn low(self) -> [i32; 2] {
        [self.x, self.y].map(|v| v * (NODE << self.level))
    }

    /// Side, cells.
    pub fn side(self) -> i32 {
        NODE << self.level
    }

    /// Cells of the node, without its northern and eastern edges, which it shares with the nodes there.
    pub fn rect(self) -> CellRect {
        let low = self.low();
        CellRect { low, high: low.map(|v| v + self.side()) }
    }

    /// The four nodes of the next finer level, by rows from the south-west.
    pub fn children(self) -> [Self; 4] {
        [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[i, j]| Self {
            level: self.level - 1,
            x: 2 * self.x + i,
            y: 2 * self.y + j,
        })
    }

    /// Distance from a place to the node's rectangle, both in cells.
    pub fn distance(self, place: DVec2) -> f64 {
        let low = DVec2::from(self.low().map(f64::from));
        let high = low + f64::from(self.side());
        (low - place).max(place - high).max(DVec2::ZERO).length()
    }
}

/// Bounds of the heights in all nodes of a terrain. Ground means cells that are no holes.
#[derive(Default)]
pub(super) struct Relief {
    /// Identity and revision of the terrain that was read.
    read: Option<(u64, u64)>,
    /// Lowest and highest height of the vertices of each node with ground, m, including the vertices on all its edges.
    /// A vertex in a hole has the height of ground near it.
    bounds: HashMap<NodeKey, [f32; 2]>,
    /// Level of the roots.
    top: u8,
    /// Nodes that cover the whole terrain.
    roots: Vec<NodeKey>,
    /// Vertical error of each level, m.
    errors_m: [f64; LEVELS],
    /// Number of cells that changed since the errors were measured.
    unmeasured: i64,
    /// Scratch space: nodes that a search has yet to visit.
    open: Vec<NodeKey>,
}

impl Relief {
    /// Lowest and highest height in a node, m; `None` without ground.
    pub fn bounds(&self, node: NodeKey) -> Option<[f32; 2]> {
        self.bounds.get(&node).copied()
    }

    /// Nodes that cover the whole terrain.
    pub fn roots(&self) -> &[NodeKey] {
        &self.roots
    }

    /// Level of the roots.
    pub fn top(&self) -> u8 {
        self.top
    }

    /// Vertical error of each level, m, which [`HELD_SHARE`] of the measured cells do not exceed.
    pub fn errors_m(&self) -> &[f64; LEVELS] {
        &self.errors_m
    }

    /// Updates the bounds after the changes of the terrain since the last call. Measures the errors anew once more than
    /// an eighth of the cells have changed. Calls `changed` with each changed rectangle, or with `None` if everything
    /// may have changed.
    pub fn update(&mut self, terrain: &Terrain, mut changed: impl FnMut(Option<CellRect>)) {
        let now = (terrain.id, terrain.revision);
        if self.read == Some(now) {
            return;
        }
        let before = self.read.filter(|read| read.0 == terrain.id).map(|read| read.1);
        match before.and_then(|revision| terrain.recent.since(revision, terrain.revision)) {
            Some(rects) => rects.for_each(|rect| {
                self.read_rect(terrain, rect);
                changed(Some(rect));
            }),
            None => {
                self.bounds.clear();
                self.unmeasured = i64::MAX / 2;
                for (_, tile) in terrain.all() {
                    self.read_rect(terrain, terrain.rect(tile.key));
                }
                changed(None);
            }
        }
        self.read = Some(now);
        self.find_roots(terrain);
        let cells = terrain.all().len() as i64 * (terrain.side() * terrain.side()) as i64;
        if self.unmeasured > cells / 8 {
            self.errors_m = level_errors_m(terrain, self.top);
            self.unmeasured = 0;
        }
    }

    /// Computes the bounds of the nodes that a rectangle of cells touches, on all levels.
    fn read_rect(&mut self, terrain: &Terrain, rect: CellRect) {
        self.unmeasured = self
            .unmeasured
            .saturating_add(i64::from(rect.high[0] - rect.low[0]) * i64::from(rect.high[1] - rect.low[1]));
        let mut cells = CellReader::new(terrain);
        // A node includes the first cells of its eastern and northern neighbours: a change of these cells also touches
        // the node. `rect.high` is exclusive.
        let mut low = rect.low.map(|v| (v - 1).div_euclid(NODE));
        let mut high = rect.high.map(|v| (v - 1).div_euclid(NODE));
        for (x, y) in nodes(low, high) {
            let key = NodeKey { level: 0, x, y };
            self.set(key, leaf_bounds(&mut cells, key));
        }
        for level in 1..=MOST_LEVELS {
            (low, high) = (low.map(|v| v >> 1), high.map(|v| v >> 1));
            for (x, y) in nodes(low, high) {
                let key = NodeKey { level, x, y };
                let parts = key.children().map(|child| self.bounds(child));
                let both = |a: [f32; 2], b: [f32; 2]| [a[0].min(b[0]), a[1].max(b[1])];
                self.set(key, parts.into_iter().flatten().reduce(both));
            }
        }
    }

    fn set(&mut self, key: NodeKey, bounds: Option<[f32; 2]>) {
        match bounds {
            Some(bounds) => self.bounds.insert(key, bounds),
            None => self.bounds.remove(&key),
        };
    }

    /// Finds the roots: the nodes with ground at the lowest level whose nodes are at least as wide as the terrain. They
    /// are at most two by two.
    fn find_roots(&mut self, terrain: &Terrain) {
        self.roots.clear();
        let Some(all) = terrain.bounds else { return };
        let side = |level: u8| i64::from(NODE) << level;
        let extent = (0..2).map(|i| i64::from(all.high[i]) - i64::from(all.low[i])).max().unwrap_or(0);
        self.top = (0..MOST_LEVELS).find(|level| side(*level) >= extent).unwrap_or(MOST_LEVELS);
        let at = |v: i32| (i64::from(v)).div_euclid(side(self.top)) as i32;
        let found = nodes(all.low.map(at), all.high.map(|v| at(v - 1)));
        let keys = found.map(|(x, y)| NodeKey { level: self.top, x, y });
        self.roots.extend(keys.filter(|key| self.bounds.contains_key(key)));
    }

    /// Returns the reference height, m, above which the eye's height is measured: the maximum, over all nodes of level
    /// 0, of the node's highest ground less an eighth of its horizontal distance from the eye. It changes continuously
    /// as the eye moves, and is 0 without ground. `eye` is in cells.
    pub fn reference_m(&mut self, eye: DVec2, cell_m: f64) -> f64 {
        let mut best = f64::NEG_INFINITY;
        self.open.clear();
        self.open.extend_from_slice(&self.roots);
        while let Some(node) = self.open.pop() {
            let Some([_, high]) = self.bounds(node) else { continue };
            let most = f64::from(high) - CONE * cell_m * node.distance(eye);
            if most <= best {
                continue;
            }
            if node.level == 0 {
                best = most;
            } else {
                let mut children = node.children();
                children.sort_by(|a, b| b.distance(eye).total_cmp(&a.distance(eye)));
                self.open.extend(children);
            }
        }
        if best.is_finite() { best } else { 0.0 }
    }
}

fn nodes(low: [i32; 2], high: [i32; 2]) -> impl Iterator<Item = (i32, i32)> {
    (low[1]..=high[1]).flat_map(move |y| (low[0]..=high[0]).map(move |x| (x, y)))
}

fn leaf_bounds(cells: &mut CellReader<'_>, key: NodeKey) -> Option<[f32; 2]> {
    let [x, y] = key.low();
    let places = || (0..=NODE).flat_map(move |j| (0..=NODE).map(move |i| [x + i, y + j]));
    // No triangle of the node has its south-western corner on the eastern or northern edge.
    if !places().any(|[i, j]| i < x + NODE && j < y + NODE && cells.height([i, j]).is_some()) {
        return None;
    }
    // Corners without ground are drawn at the height of ground near them, so the bounds include this height.
    let heights = places().filter_map(|place| cells.height_or_near(place));
    Some(heights.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], h| [low.min(h), high.max(h)]))
}

/// Returns the vertical error of each level up to `top`, m: the quantile [`HELD_SHARE`] of the distances by which the
/// level's triangles lie above or below random cells. The error is at least that of the next finer level.
fn level_errors_m(terrain: &Terrain, top: u8) -> [f64; LEVELS] {
    let tiles: Vec<_> = terrain.all().map(|(_, tile)| tile.key).collect();
    let (mut cells, mut chance) = (CellReader::new(terrain), RandomStream::new(0, 44));
    let mut held = [0.0; LEVELS];
    let mut errors = Vec::with_capacity(SAMPLES as usize);
    for level in 1..=top {
        errors.clear();
        for _ in 0..SAMPLES {
            let tile = tiles[((chance.unit() * tiles.len() as f64) as usize).min(tiles.len() - 1)];
            let cell = (chance.unit() * (terrain.side() * terrain.side()) as f64) as usize;
            errors.extend(level_error_m(&mut cells, terrain.place_in(tile, cell), level));
        }
        errors.sort_by(f64::total_cmp);
        // If no triangle of a level has ground at all corners, the error of the next finer level is the best estimate.
        let own = errors.len().checked_sub(1).map(|last| errors[(last as f64 * HELD_SHARE).round() as usize]);
        held[usize::from(level)] = own.unwrap_or(0.0).max(held[usize::from(level) - 1]);
    }
    held
}

/// Vertical distance, m, between a cell and the triangle of a level at its place; `None` if the cell or a corner has no
/// ground.
fn level_error_m(cells: &mut CellReader<'_>, place: [i32; 2], level: u8) -> Option<f64> {
    let own = f64::from(cells.height(place)?);
    let step = 1 << level;
    let low = place.map(|v| v & !(step - 1));
    let part = [0, 1].map(|i| f64::from(place[i] - low[i]) / f64::from(step));
    let is_south = part[0] >= part[1];
    let (large, small) = if is_south { (part[0], part[1]) } else { (part[1], part[0]) };
    let third = if is_south { [low[0] + step, low[1]] } else { [low[0], low[1] + step] };
    let mut height = |place: [i32; 2]| cells.height(place).map(f64::from);
    let (a, b, c) = (height(low)?, height(third)?, height(low.map(|v| v + step))?);
    Some((a * (1.0 - large) + b * (large - small) + c * small - own).abs())
}
