//! Where there is cloud: the extinction of a layer at a place. Twin of `shaders/clouds/field.wgsl`.
//!
//! # Model
//! A map over the plane says how strongly cloud grows at a place, as a number z that is spread normally about 0: two
//! sheets of noise, each made normal by ranks, whose periods have no common multiple, so that no tile shows. Cloud is
//! where z exceeds a threshold that follows from the cover ([`super::cover`]); how far it exceeds it says how high the
//! cloud grows there. Solid noise frays its edges. The two sheets glide against each other, which makes clouds form and
//! dissolve, without end and as a function of time alone.
//!
//! Of a place with the excess e = z - threshold and the height h, 0 at the base to 1 at the top, the extinction is that
//! of the layer times (e - dome(h) + rough (noise - 1/2)) / soft, held between 0 and 1. Over heaps the dome grows with
//! e, so that no top is cut flat.
//!
//! Ice is drawn out along the wind that carries it, and leans with height: heads stand downwind of what falls from
//! them. Cumulonimbus has an anvil, a sheet below the layer's top about its towers (`anvil_needs`).

use glam::{DMat2, DVec2, DVec3};

use super::placed::LocalCover;

/// Texels of the map along a side.
pub const MAP_SIZE: usize = 256;
/// Largest number that the map holds.
pub const MAP_REACH: f64 = 4.0;
/// Cells of cloud along the map's side.
pub const MAP_CELLS: f64 = 16.0;
/// Period of the second sheet over that of the first, and its turn: no whole numbers of one are a whole number of the
/// other.
pub(super) const SECOND_PERIOD: f64 = 1.618_033_988_749_895;
pub(super) const SECOND_TURN_RAD: f64 = 0.9;
pub(super) const SECOND_OFFSET: DVec2 = DVec2::new(0.37, 0.71);
/// Mean of the solid noise, and one over the range of nearly all of it.
const SOLID_MEAN: f64 = 0.47;
const SOLID_GAIN: f64 = 2.2;

/// Most that the solid noise adds to the excess, over how far it frays: nearly all of it.
pub(super) const MOST_FRAYED: f64 = 0.8;

/// How the clouds of one layer are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Base above the sea, m.
    pub base_m: f64,
    /// Thickness, m.
    pub thickness_m: f64,
    /// Distance from cloud to cloud, m.
    pub scale_m: f64,
    /// Extinction inside, 1/m.
    pub extinction_per_m: f64,
    /// Threshold of the map, above which there is cloud.
    pub threshold: f64,
    /// Excess at which a cloud reaches the layer's top: large for heaps, small for sheets.
    pub dome: f64,
    /// How far the solid noise frays the edges.
    pub rough: f64,
    /// Excess over which cloud becomes dense.
    pub soft: f64,
    /// Share of the map's cellular pattern, 0 to 1.
    pub cellular: f64,
    /// Side of the solid noise, m.
    pub solid_m: f64,
    /// How domes of heaps grow with the excess e of their place, by sqrt(1 + held e^2), so that none reaches far above
    /// the layer.
    pub held: f64,
    /// Least excess of a place that has an anvil over it; [`NO_ANVIL`] without.
    pub anvil: f64,
    /// From places (east, north) to those of a pattern that is not drawn out along the wind.
    pub stretch: DMat2,
    /// How far the layer's top lies downwind of its base (east, north), m.
    pub lean_m: DVec2,
    /// How far the wind has carried the layer (east, north), m.
    pub drift_m: DVec2,
    /// How far the second sheet has glided against the first, in cells.
    pub evolution: DVec2,
}

/// The map's texels: two sheets of even noise, and two of a cellular kind.
pub struct Map(pub Vec<[f32; 4]>);

/// Solid noise, a byte a texel.
pub struct Solid {
    /// Texels along a side.
    pub size: usize,
    /// Its texels, east fastest.
    pub texels: Vec<u8>,
}

fn wrapped(x: f64, size: usize) -> (usize, usize, f64) {
    let x = (x * size as f64 - 0.5).rem_euclid(size as f64);
    let i = (x as usize).min(size - 1);
    (i, (i + 1) % size, x - i as f64)
}

impl Map {
    /// Between its texels; `at` in periods.
    pub fn at(&self, at: DVec2) -> [f64; 4] {
        let (i0, i1, x) = wrapped(at.x, MAP_SIZE);
        let (j0, j1, y) = wrapped(at.y, MAP_SIZE);
        let texel = |i: usize, j: usize| self.0[j * MAP_SIZE + i];
        let (a, b, c, d) = (texel(i0, j0), texel(i1, j0), texel(i0, j1), texel(i1, j1));
        [0, 1, 2, 3].map(|k| {
            let low = f64::from(a[k]) * (1.0 - x) + f64::from(b[k]) * x;
            let high = f64::from(c[k]) * (1.0 - x) + f64::from(d[k]) * x;
            low * (1.0 - y) + high * y
        })
    }
}

impl Solid {
    /// Between its texels, 0 to 1; `at` in periods.
    pub fn at(&self, at: DVec3) -> f64 {
        let [x, y, z] = [at.x, at.y, at.z].map(|v| wrapped(v, self.size));
        let texel = |i: usize, j: usize, k: usize| f64::from(self.texels[(k * self.size + j) * self.size + i]) / 255.0;
        let row = |j: usize, k: usize| texel(x.0, j, k) * (1.0 - x.2) + texel(x.1, j, k) * x.2;
        let sheet = |k: usize| row(y.0, k) * (1.0 - y.2) + row(y.1, k) * y.2;
        sheet(z.0) * (1.0 - z.2) + sheet(z.1) * z.2
    }
}

/// A layer's clouds.
pub struct Field<'a> {
    /// How they are made.
    pub shape: Shape,
    /// Where they grow.
    pub map: &'a Map,
    /// Solid noise that frays their edges.
    pub solid: &'a Solid,
    /// Where they are other than the layer's cover says.
    pub(super) placed: LocalCover,
}

/// [`Shape::anvil`] of a layer without.
pub const NO_ANVIL: f64 = 1e3;
/// Heights between which an anvil is whole, and over which its faces fade.
pub(super) const ANVIL: [f64; 2] = [0.84, 0.95];
const ANVIL_FACES: [f64; 2] = [0.2, 0.05];
/// How much smoother an anvil is than its towers.
const ANVIL_SMOOTHER: f64 = 0.65;

/// Excess that a place needs at a height for the anvil there.
fn anvil_needs(shape: &Shape, height: f64) -> f64 {
    let below = (ANVIL[0] - height).max(0.0) / ANVIL_FACES[0];
    let above = (height - ANVIL[1]).max(0.0) / ANVIL_FACES[1];
    shape.anvil + 3.0 * (below * below + above * above)
}

/// How far edges fray at a height, of 1: less in an anvil.
fn smooth(shape: &Shape, height: f64) -> f64 {
    let within = ((height - ANVIL[0]) / 0.14 + 1.0).clamp(0.0, 1.0);
    1.0 - ANVIL_SMOOTHER * within * (-shape.anvil / 0.2).clamp(0.0, 1.0)
}

impl Shape {
    /// Excess at which a place of this excess reaches the layer's top.
    pub(super) fn dome_over(&self, excess: f64) -> f64 {
        let e = excess.max(0.0);
        self.dome * (1.0 + self.held * e * e).sqrt()
    }
}

/// Height over which a base is round at its edges: share of the thickness, and m at most. Bases of deep layers are the
/// flatter.
const EDGE_SHARE: f64 = 0.08;
const EDGE_M: f64 = 40.0;

/// Excess that a place of this excess needs at a height, 0 at the base to 1 at the top: a flat base with round edges,
/// and a dome or an anvil.
pub fn dome(shape: &Shape, excess: f64, height: f64) -> f64 {
    let share = (EDGE_M / shape.thickness_m).min(EDGE_SHARE);
    let edge = (1.0 - height / share).max(0.0);
    let edge = edge * edge * share / EDGE_SHARE;
    (shape.dome_over(excess) * height * height + 0.25 * edge).min(anvil_needs(shape, height))
}

impl Field<'_> {
    /// The map's number at a place, m east and north of the world's origin.
    pub fn strength(&self, place_m: DVec2) -> f64 {
        let s = &self.shape;
        let cell = s.stretch * (place_m - s.drift_m) / s.scale_m;
        let first = self.map.at(cell / MAP_CELLS);
        let turned = DMat2::from_angle(SECOND_TURN_RAD) * (cell - s.evolution);
        let second = self.map.at(turned / (MAP_CELLS * SECOND_PERIOD) + SECOND_OFFSET);
        let c = s.cellular;
        let scale = 1.0 / (2.0 * (c * c + (1.0 - c) * (1.0 - c))).sqrt();
        ((first[0] + second[1]) * (1.0 - c) + (first[2] + second[3]) * c) * scale
    }

    /// The clouds about a place as they are there, within which distance that holds, m, and how much the threshold
    /// changes a metre beyond.
    pub(super) fn here(&self, position_m: DVec3) -> (Self, [f64; 2]) {
        let mut shape = self.shape;
        let steady = self.placed.shape_at(self.upright(position_m), &mut shape);
        (Self { shape, placed: LocalCover::default(), ..*self }, steady)
    }

    /// A place of the layer as its pattern has it: what is above the base leans.
    pub(super) fn upright(&self, position_m: DVec3) -> DVec2 {
        let s = &self.shape;
        let height = (position_m.z - s.base_m) / s.thickness_m;
        position_m.truncate() - s.lean_m * (height * height)
    }

    /// Excess over the threshold at a place, neither frayed nor under a dome.
    pub(super) fn over(&self, position_m: DVec3) -> f64 {
        let s = &self.shape;
        self.strength(self.upright(position_m)) - s.threshold
    }

    /// Returns what the solid noise adds to the excess at a place.
    pub(super) fn frays(&self, position_m: DVec3) -> f64 {
        let s = &self.shape;
        let level = s.stretch * (self.upright(position_m) - s.drift_m);
        let at = level.extend(position_m.z - s.base_m) / s.solid_m;
        s.rough * smooth(s, (position_m.z - s.base_m) / s.thickness_m) * SOLID_GAIN * (self.solid.at(at) - SOLID_MEAN)
    }

    /// Extinction, 1/m, of a frayed excess over threshold and dome.
    pub(super) fn dense(&self, excess: f64) -> f64 {
        self.shape.extinction_per_m * (excess / self.shape.soft).clamp(0.0, 1.0)
    }

    /// Extinction, 1/m, at a place `position_m` (east and north of the world's origin, above the sea).
    pub fn extinction_per_m(&self, position_m: DVec3) -> f64 {
        let height = (position_m.z - self.shape.base_m) / self.shape.thickness_m;
        if !(0.0..=1.0).contains(&height) {
            return 0.0;
        }
        let (here, _) = self.here(position_m);
        let over = here.over(position_m);
        let excess = over - dome(&here.shape, over, height);
        if excess < -MOST_FRAYED * here.shape.rough {
            return 0.0;
        }
        here.dense(excess + here.frays(position_m))
    }
}

/// Slope of the map, a cell: so far is a place from its cloud's edge as its excess is over that.
const MAP_SLOPE: f64 = 4.0;

/// Extent of a cloud above and below a place, and to its sides, in metres of its full extinction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct About {
    /// Straight up.
    pub above_m: f64,
    /// Straight down.
    pub below_m: f64,
    /// Level, to the nearer edge.
    pub edge_m: f64,
}

/// Height, of 1, of full extinction below a height in a column of this excess.
pub(super) fn filled_below(shape: &Shape, excess: f64, height: f64) -> f64 {
    let d = shape.dome_over(excess).max(1e-3);
    let reach = |e: f64| (e.max(0.0) / d).sqrt().min(1.0);
    let (full, end) = (reach(excess - shape.soft), reach(excess));
    let ramp = |x: f64| (excess - d * x * x / 3.0) * x / shape.soft;
    // What of an anvil lies above the dome.
    let from = end.clamp(ANVIL[0], ANVIL[1]);
    let anvil = ((excess - shape.anvil) / shape.soft).clamp(0.0, 1.0) * (height.clamp(from, ANVIL[1]) - from);
    height.min(full) + (ramp(height.clamp(full, end)) - ramp(full)).max(0.0) + anvil
}

/// The cloud about a place of this excess (over the threshold alone) and height, frayed edges left out.
pub fn about(shape: &Shape, excess: f64, height: f64) -> About {
    let below = filled_below(shape, excess, height);
    // An anvil reaches further than its tower.
    let beyond = if height > ANVIL[0] - 0.5 * ANVIL_FACES[0] { shape.anvil.min(0.0) } else { 0.0 };
    About {
        above_m: (filled_below(shape, excess, 1.0) - below) * shape.thickness_m,
        below_m: below * shape.thickness_m,
        edge_m: (excess - beyond).max(0.0) / MAP_SLOPE * shape.scale_m,
    }
}
