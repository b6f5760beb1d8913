//! Shape of a layer's clouds: its numbers, and how domes, anvils and bases cut cloud out of a column.

use glam::{DMat2, DVec2};

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

/// [`Shape::anvil`] of a layer without.
pub const NO_ANVIL: f64 = 1e3;
/// Heights between which an anvil is whole, and over which its faces fade.
const ANVIL: [f64; 2] = [0.84, 0.95];
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
pub(super) fn smooth(shape: &Shape, height: f64) -> f64 {
    let within = ((height - ANVIL[0]) / 0.14 + 1.0).clamp(0.0, 1.0);
    1.0 - ANVIL_SMOOTHER * within * (-shape.anvil / 0.2).clamp(0.0, 1.0)
}

impl Shape {
    /// Excess at which a place of this excess reaches the layer's top.
    pub(crate) fn dome_over(&self, excess: f64) -> f64 {
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
pub(crate) fn filled_below(shape: &Shape, excess: f64, height: f64) -> f64 {
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

/// Width of a cloud from side to side, in cells.
pub(crate) const WIDTH_CELLS: f64 = 0.6;
