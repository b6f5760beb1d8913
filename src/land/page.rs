//! Content of a page: the vertices of a node, and texels with the slopes and classes of the node's ground.
//!
//! A page has the heights of the node's 17 x 17 vertices. At level 2 and all coarser levels, four texels lie along each
//! side of a square, so that shading stays sharp where the squares are many pixels wide. At levels 0 to 2 a texel is a
//! cell. Values depend on the lattice position and the level alone, so pages that meet have the same values on their
//! common edge. Each texel also has the slope of the next coarser level. As the vertices move onto that level, the
//! shading changes to its slope. Where the terrain has dug soil, a further texture has the soil's colour.

use half::f16;

use super::{
    cells::{CellReader, WALL},
    relief::{NODE, NodeKey},
};
use crate::{
    light::tone::{srgb_decode, srgb_encode},
    terrain::{CLASSES, CellRect, DugColor, Terrain},
};

/// Vertices along a side of a page.
pub(super) const VERTICES: i32 = NODE + 1;
/// Texels along a side of a page: four for each square, and two more for interpolation at the eastern and northern
/// edges.
pub(super) const TEXELS: i32 = 4 * NODE + 2;
/// Number of texels beyond each side of a page at which heights are also read, because the page's slopes need them.
const MARGIN: i32 = 3;
/// Number of heights along a side of the square that is read for the texels of a page.
const READ: i32 = TEXELS + 2 * MARGIN;
/// Largest number of cells along a side of a texel at which classes and dug soil are read.
const CLASS_SAMPLES: i32 = 4;

/// Distance between texels of a level, cells.
pub(super) fn texel_cells(level: u8) -> i32 {
    1 << level.saturating_sub(2)
}

/// Texels along a side of a node of a level, without the two for interpolation.
pub(super) fn texels_in_node(level: u8) -> i32 {
    (NODE << level) / texel_cells(level)
}

/// Slopes of a texel: to the east and the north on the page's level, then both on the next coarser one.
type SlopeTexel = [u16; 4];
/// Shares of the classes in 255ths, in the order of the class numbers. The last byte is 255 where there is ground.
type ClassTexel = [u8; 8];
/// Colour of dug soil times the soil's share, in codes of sRGB, and that share.
type DugTexel = [u8; 4];

/// Scratch space in which a page, or a part of it, is computed.
pub(super) struct PageWriter {
    /// Heights around the texels, m; NaN where there is no ground.
    heights: Vec<f32>,
    /// Slopes of the next coarser level at the same positions.
    coarse: Vec<[f32; 2]>,
    /// Slopes of the texels written last.
    pub slopes: Vec<SlopeTexel>,
    /// Classes of the texels written last.
    pub classes: Vec<ClassTexel>,
    /// Heights of the vertices written last, m.
    pub vertices: Vec<f32>,
    /// Dug soil of the texels written last; empty where the terrain has no soil.
    pub dug: Vec<DugTexel>,
    /// Linear value of each code of sRGB.
    linear: [f32; 256],
}

impl Default for PageWriter {
    fn default() -> Self {
        let side = READ as usize * READ as usize;
        Self {
            heights: vec![0.0; side],
            coarse: vec![[0.0; 2]; side],
            slopes: Vec::new(),
            classes: Vec::new(),
            vertices: Vec::new(),
            dug: Vec::new(),
            linear: std::array::from_fn(|code| srgb_decode(code as f64 / 255.0) as f32),
        }
    }
}

/// Rectangle of texels or vertices of a page: from `low` up to, but not including, `high`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PageRect {
    pub low: [i32; 2],
    pub high: [i32; 2],
}

impl PageRect {
    /// All texels that a page of a level uses.
    pub fn texels(level: u8) -> Self {
        Self { low: [0; 2], high: [texels_in_node(level) + 2; 2] }
    }

    /// All vertices of a page.
    pub fn vertices() -> Self {
        Self { low: [0; 2], high: [VERTICES; 2] }
    }

    /// Texels of a page that depend on changed cells; `None` if none does.
    pub fn changed_texels(page: NodeKey, cells: CellRect) -> Option<Self> {
        // Slopes of the coarser level reach two texels, and are interpolated over one more.
        Self::within(
            page,
            texel_cells(page.level),
            cells.grown(MARGIN * texel_cells(page.level)),
            Self::texels(page.level),
        )
    }

    /// Vertices of a page that depend on changed cells; `None` if none does.
    pub fn changed_vertices(page: NodeKey, cells: CellRect) -> Option<Self> {
        Self::within(page, 1 << page.level, cells, Self::vertices())
    }

    fn within(page: NodeKey, step: i32, cells: CellRect, all: Self) -> Option<Self> {
        let origin = page.low();
        let low = [0, 1].map(|i| (cells.low[i] - origin[i] + step - 1).div_euclid(step).max(all.low[i]));
        let high = [0, 1].map(|i| ((cells.high[i] - 1 - origin[i]).div_euclid(step) + 1).min(all.high[i]));
        (low[0] < high[0] && low[1] < high[1]).then_some(Self { low, high })
    }

    pub fn size(&self) -> [u32; 2] {
        [0, 1].map(|i| (self.high[i] - self.low[i]) as u32)
    }

    fn places(self) -> impl Iterator<Item = [i32; 2]> {
        (self.low[1]..self.high[1]).flat_map(move |j| (self.low[0]..self.high[0]).map(move |i| [i, j]))
    }
}

/// Slope at a place with the height `own`, from the heights of its two neighbours, each `distance` away: one-sided if
/// one neighbour has no ground, 0 if neither has.
fn slope(low: f32, own: f32, high: f32, distance: f32) -> f32 {
    match (low.is_nan(), high.is_nan()) {
        (false, false) => (high - low) / (2.0 * distance),
        (true, false) => (high - own) / distance,
        (false, true) => (own - low) / distance,
        (true, true) => 0.0,
    }
}

impl PageWriter {
    /// Computes the heights of the vertices of a page in `rect`. Returns whether any of these vertices has no ground.
    pub fn write_vertices(&mut self, cells: &mut CellReader<'_>, page: NodeKey, rect: PageRect) -> bool {
        let [x, y] = page.low();
        let mut is_torn = false;
        self.vertices.clear();
        for [i, j] in rect.places() {
            let place = [x + (i << page.level), y + (j << page.level)];
            is_torn |= cells.height(place).is_none();
            self.vertices.push(cells.height_or_near(place).unwrap_or(0.0));
        }
        is_torn
    }

    /// Computes the slopes, the classes and the dug soil of the texels of a page in `rect`. `default` is the class of
    /// cells for which the host gives none.
    pub fn write_texels(&mut self, cells: &mut CellReader<'_>, page: NodeKey, rect: PageRect, default: u8) {
        self.read_heights(cells, page, rect);
        let step_m = (f64::from(texel_cells(page.level)) * cells.terrain.desc.cell_m) as f32;
        let has_coarse = page.level >= 2;
        if has_coarse {
            self.find_coarse(rect, 2.0 * step_m);
        }
        self.slopes.clear();
        self.classes.clear();
        self.dug.clear();
        let has_dug = shows_soil(cells.terrain);
        for [i, j] in rect.places() {
            let (place, side) = (position(page, [i, j]), texel_cells(page.level));
            let mut own = self.slope_at([i, j], 1, step_m);
            if has_dug {
                let dug = self.dug_texel(cells, place, side);
                if dug[3] > 0 && side == 1 && own[0].hypot(own[1]) > WALL as f32 {
                    own = self.wall_slope([i, j], own, step_m);
                }
                self.dug.push(dug);
            }
            let coarse = if has_coarse { self.coarse_at([i, j]) } else { own };
            let half = |v: f32| f16::from_f32(v.clamp(-6e4, 6e4)).to_bits();
            self.slopes.push([half(own[0]), half(own[1]), half(coarse[0]), half(coarse[1])]);
            let classes = classes(cells, place, side, default);
            self.classes.push(classes);
        }
    }

    /// Mean colour of the dug soil in a square as large as a texel, around a lattice position. A cell at the upper edge
    /// of a wall of soil shows the terrain's `surface_soil`.
    fn dug_texel(&self, cells: &mut CellReader<'_>, place: [i32; 2], side: i32) -> DugTexel {
        let (mut sum, mut share, mut last) = ([0.0; 3], 0, DugColor::default());
        let samples = samples(side);
        for at in samples.places(place) {
            last = cells.dug_color(at);
            if last.share < u8::MAX && cells.tops_wall(at) {
                last = cells.terrain.surface_soil;
            }
            sum.iter_mut().zip(last.albedo).for_each(|(sum, code)| *sum += self.linear[usize::from(code)]);
            share += u32::from(last.share);
        }
        let count = samples.count.pow(2) as u32;
        let code = |sum: f32| (255.0 * srgb_encode(f64::from(sum) / f64::from(count))).round() as u8;
        let [r, g, b] = if count == 1 || share == 0 { last.albedo } else { sum.map(code) };
        [r, g, b, (share / count) as u8]
    }

    /// Index of a texel in the scratch arrays.
    fn index([i, j]: [i32; 2]) -> usize {
        (j + MARGIN) as usize * READ as usize + (i + MARGIN) as usize
    }

    fn read_heights(&mut self, cells: &mut CellReader<'_>, page: NodeKey, rect: PageRect) {
        let around = PageRect { low: rect.low.map(|v| v - MARGIN), high: rect.high.map(|v| v + MARGIN) };
        for at in around.places() {
            self.heights[Self::index(at)] = cells.height(position(page, at)).unwrap_or(f32::NAN);
        }
    }

    /// Slope at a texel from the heights `distance` texels away on each side; 0 without ground.
    fn slope_at(&self, [i, j]: [i32; 2], distance: i32, distance_m: f32) -> [f32; 2] {
        let height = |at: [i32; 2]| self.heights[Self::index(at)];
        let own = height([i, j]);
        if own.is_nan() {
            return [0.0; 2];
        }
        [
            slope(height([i - distance, j]), own, height([i + distance, j]), distance_m),
            slope(height([i, j - distance]), own, height([i, j + distance]), distance_m),
        ]
    }

    /// Slope of a wall of dug soil, in place of the texel's `own`. A wall that runs obliquely to the lattice is a stair
    /// of cells whose sides face east and north by turns. The result keeps the steepness of `own`, in the mean
    /// direction of the slopes within two cells.
    fn wall_slope(&self, [x, y]: [i32; 2], own: [f32; 2], distance_m: f32) -> [f32; 2] {
        let mut sum = [0.0f32; 2];
        for at in (PageRect { low: [x - 2, y - 2], high: [x + 3, y + 3] }).places() {
            let slope = self.slope_at(at, 1, distance_m);
            sum = [sum[0] + slope[0], sum[1] + slope[1]];
        }
        let (steepness, length) = (own[0].hypot(own[1]), sum[0].hypot(sum[1]));
        // The slopes of two walls that face each other cancel out: the texel keeps its own.
        if length < 2.5 * steepness { own } else { sum.map(|s| s * steepness / length) }
    }

    /// Computes the slopes of the next coarser level, at every second texel of this one.
    fn find_coarse(&mut self, rect: PageRect, distance_m: f32) {
        let (low, high) = (rect.low.map(|v| v - 1), rect.high.map(|v| v + 1));
        for at in (PageRect { low, high }).places().filter(|at| at[0] & 1 == 0 && at[1] & 1 == 0) {
            self.coarse[Self::index(at)] = self.slope_at(at, 2, distance_m);
        }
    }

    /// Slope of the next coarser level at a texel, interpolated between that level's texels.
    fn coarse_at(&self, [i, j]: [i32; 2]) -> [f32; 2] {
        let (x, y) = ([i - (i & 1), i + (i & 1)], [j - (j & 1), j + (j & 1)]);
        let at = |i: i32, j: i32| self.coarse[Self::index([i, j])];
        let corners = [at(x[0], y[0]), at(x[1], y[0]), at(x[0], y[1]), at(x[1], y[1])];
        [0, 1].map(|axis| 0.25 * corners.iter().map(|c| c[axis]).sum::<f32>())
    }
}

/// Lattice position of a texel.
fn position(page: NodeKey, [i, j]: [i32; 2]) -> [i32; 2] {
    let ([x, y], step) = (page.low(), texel_cells(page.level));
    [x + i * step, y + j * step]
}

/// Whether pages of a terrain have colours of dug soil.
pub(super) fn shows_soil(terrain: &Terrain) -> bool {
    terrain.soil_revision > 0
}

/// Whether any texel of a page has no ground.
pub(super) fn has_holes(cells: &mut CellReader<'_>, page: NodeKey) -> bool {
    PageRect::texels(page.level).places().any(|at| cells.class(position(page, at)).is_none())
}

/// Places in the square of a texel at which its cells are read.
#[derive(Clone, Copy)]
struct TexelSamples {
    /// Side of the texel, cells.
    side: i32,
    /// Number of places along a side.
    count: i32,
}

fn samples(side: i32) -> TexelSamples {
    TexelSamples { side, count: side.min(CLASS_SAMPLES) }
}

impl TexelSamples {
    /// Lattice positions of the places, by rows from the south-west. `[x, y]` is the texel's own position.
    fn places(self, [x, y]: [i32; 2]) -> impl Iterator<Item = [i32; 2]> {
        let off = move |k: i32| (2 * k + 1) * self.side / (2 * self.count) - self.side / 2;
        (0..self.count).flat_map(move |j| (0..self.count).map(move |i| [x + off(i), y + off(j)]))
    }
}

/// Shares of the classes in the square of a texel around a lattice position; all 0 if the position itself has no
/// ground.
fn classes(cells: &mut CellReader<'_>, place: [i32; 2], side: i32, default: u8) -> ClassTexel {
    let mut texel = [0; 8];
    let Some(own) = cells.class(place) else { return texel };
    texel[7] = 255;
    let class = |number: u8| usize::from(if number == 0 { default } else { number });
    let samples = samples(side);
    if samples.count == 1 {
        texel[class(own)] = 255;
        return texel;
    }
    let (mut shares, mut all) = ([0u32; CLASSES], 0);
    for at in samples.places(place) {
        if let Some(number) = cells.class(at) {
            shares[class(number)] += 1;
            all += 1;
        }
    }
    if all == 0 {
        (shares[class(own)], all) = (1, 1);
    }
    for (to, share) in texel.iter_mut().zip(shares) {
        *to = (255 * share / all) as u8;
    }
    texel
}
