//! Shape of a layer's clouds: its parameters, and how domes, anvils and bases bound the cloud over a place. The model
//! is in the folder's `mod.rs`. Excess is the map's number at a place less the threshold.

use glam::{DMat2, DVec2};

/// Parameters of the clouds of one layer.
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
    /// Threshold: there is cloud where the map's number exceeds it.
    pub threshold: f64,
    /// Excess at which a cloud reaches the layer's top, before `held` raises it: large for cumulus, small for stratus.
    pub dome: f64,
    /// Amplitude of the solid noise, which frays the edges, as an excess.
    pub rough: f64,
    /// Width of the edge: the excess over which extinction rises from 0 to all of it.
    pub soft: f64,
    /// Share of the map's cellular pattern, 0 to 1.
    pub cellular: f64,
    /// Side of the cube of solid noise, which repeats, m.
    pub solid_m: f64,
    /// Growth of the dome with the excess e of its place, by sqrt(1 + held e^2), so that no cloud would reach far above
    /// the layer's top, where it is cut off.
    pub held: f64,
    /// Least excess of a place that has an anvil over it; [`NO_ANVIL`] for a layer without anvils.
    pub anvil: f64,
    /// Matrix from a place (east, north) to the place in the pattern, which is not stretched along the wind.
    pub stretch: DMat2,
    /// How far the layer's top lies downwind of its base (east, north), m.
    pub lean_m: DVec2,
    /// How far the wind has carried the layer (east, north), m.
    pub drift_m: DVec2,
    /// How far the map's second sheet of noise has glided against the first (east, north), in distances from cloud to
    /// cloud.
    pub evolution: DVec2,
}

/// Value of [`Shape::anvil`] for a layer without anvils.
pub const NO_ANVIL: f64 = 1e3;
/// Heights between which an anvil is whole, 0 at the layer's base to 1 at its top.
const ANVIL: [f64; 2] = [0.84, 0.95];
/// Heights over which an anvil fades out, below the range of [`ANVIL`] and above it.
const ANVIL_FACES: [f64; 2] = [0.2, 0.05];
/// Share by which an anvil's edges fray less than those of its towers.
const ANVIL_SMOOTHER: f64 = 0.65;

/// Returns the excess needed for the cloud of an anvil at a height.
fn anvil_needs(shape: &Shape, height: f64) -> f64 {
    let below = (ANVIL[0] - height).max(0.0) / ANVIL_FACES[0];
    let above = (height - ANVIL[1]).max(0.0) / ANVIL_FACES[1];
    shape.anvil + 3.0 * (below * below + above * above)
}

/// Returns the share of the fraying that is left at a height: 1, or less in an anvil.
pub(super) fn smooth(shape: &Shape, height: f64) -> f64 {
    let within = ((height - ANVIL[0]) / 0.14 + 1.0).clamp(0.0, 1.0);
    1.0 - ANVIL_SMOOTHER * within * (-shape.anvil / 0.2).clamp(0.0, 1.0)
}

impl Shape {
    /// Returns the excess needed for cloud at the layer's top over a place of this excess.
    pub(crate) fn dome_over(&self, excess: f64) -> f64 {
        let e = excess.max(0.0);
        self.dome * (1.0 + self.held * e * e).sqrt()
    }
}

/// Height over which the edges of a base are round, as a share of the layer's thickness.
const EDGE_SHARE: f64 = 0.08;
/// Limit of the height of [`EDGE_SHARE`], m: bases of deep layers are flatter.
const EDGE_M: f64 = 40.0;

/// Returns the excess needed for cloud at a height (0 at the base to 1 at the top) over a place of this excess. This
/// gives clouds a flat base with round edges, and a dome or an anvil above it.
pub fn dome(shape: &Shape, excess: f64, height: f64) -> f64 {
    let share = (EDGE_M / shape.thickness_m).min(EDGE_SHARE);
    let edge = (1.0 - height / share).max(0.0);
    let edge = edge * edge * share / EDGE_SHARE;
    (shape.dome_over(excess) * height * height + 0.25 * edge).min(anvil_needs(shape, height))
}

/// Slope of the map: change of its number over one distance from cloud to cloud. A place's distance from its cloud's
/// edge, in this unit, is taken as its excess divided by the slope.
const MAP_SLOPE: f64 = 4.0;

/// Amount of cloud above, below and beside a place, as metres of cloud at full extinction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloudAround {
    /// Cloud straight up, m.
    pub above_m: f64,
    /// Cloud straight down, m.
    pub below_m: f64,
    /// Cloud horizontally, to the nearer edge, m.
    pub edge_m: f64,
}

/// Returns how much cloud lies below a height over a place of this excess, in layer thicknesses: the integral over
/// height of the ratio of the extinction to full extinction.
pub(crate) fn filled_below(shape: &Shape, excess: f64, height: f64) -> f64 {
    let d = shape.dome_over(excess).max(1e-3);
    let reach = |e: f64| (e.max(0.0) / d).sqrt().min(1.0);
    let (full, end) = (reach(excess - shape.soft), reach(excess));
    let ramp = |x: f64| (excess - d * x * x / 3.0) * x / shape.soft;
    // The part of an anvil above the dome.
    let from = end.clamp(ANVIL[0], ANVIL[1]);
    let anvil = ((excess - shape.anvil) / shape.soft).clamp(0.0, 1.0) * (height.clamp(from, ANVIL[1]) - from);
    height.min(full) + (ramp(height.clamp(full, end)) - ramp(full)).max(0.0) + anvil
}

/// Returns the amount of cloud around a place at a height, for edges that are not frayed. `excess` is the map's number
/// less the threshold, before the dome is subtracted.
pub fn about(shape: &Shape, excess: f64, height: f64) -> CloudAround {
    let below = filled_below(shape, excess, height);
    // An anvil reaches further than its tower.
    let beyond = if height > ANVIL[0] - 0.5 * ANVIL_FACES[0] { shape.anvil.min(0.0) } else { 0.0 };
    CloudAround {
        above_m: (filled_below(shape, excess, 1.0) - below) * shape.thickness_m,
        below_m: below * shape.thickness_m,
        edge_m: (excess - beyond).max(0.0) / MAP_SLOPE * shape.scale_m,
    }
}

/// Width of a cloud from side to side, in distances from cloud to cloud.
pub(crate) const WIDTH_CELLS: f64 = 0.6;
