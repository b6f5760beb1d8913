//! Edge flux between the cells of a height field: how much of a granular material slides across each edge in a sweep.
//!
//! Material lies at rest up to a gradient, the tangent of its angle of repose. A simple rule compares a cell with each
//! of its eight neighbours, and material slides where the drop between the two is too steep. Such a rule judges the
//! slope along eight directions only, and heaps become polygons: their radius is off by 7 to 33 %, depending on the
//! azimuth. Here each edge is judged by the full gradient. Let `a` be the drop across the edge, and `b` the mean of
//! four drops along the edge: between each of its two cells and this cell's neighbours on both sides. Each drop is over
//! one cell. The slope is `s = sqrt(a^2 + b^2)`. Where it exceeds the gradient `t` up to which the higher cell's
//! material rests, `RATE (s - t) a / s` slides across the edge. Heaps are then round within 1 %. Every drop between two
//! cells enters the slope of their edge, so no pattern of heights is missed. Gradients at the corners of cells would be
//! 0 on a checkerboard of high and low cells.
//!
//! Heights and flows are whole numbers of units in f64. Flows are truncated to whole units, so that sums are exact, and
//! the material comes to rest. The caller moves the material, because only it knows what the material consists of.

/// Share of the excess drop that slides across an edge in one sweep. Above 0.25 a sweep can overshoot (von Neumann's
/// limit for diffusion on a square lattice).
const RATE: f64 = 0.24;

/// Heights of a rectangle of cells with a margin of one cell on each side, by rows from the south-west.
#[derive(Clone, Copy)]
pub(crate) struct SlopeInputs<'a> {
    /// Number of cells east and north, without the margin.
    pub size: [usize; 2],
    /// Heights in units, `(size[0] + 2) * (size[1] + 2)` of them; NaN where there is no ground.
    pub heights: &'a [f64],
    /// Largest drop over one cell, in units, at which the material on top of each cell rests; infinite where nothing
    /// can move. As many as the heights.
    pub grades: &'a [f64],
}

/// Drop over one cell along an edge, from the heights of a cell at the edge and of its two neighbours along the edge;
/// 0 where neither neighbour has ground.
fn side_drop(middle: f64, lower: f64, upper: f64) -> f64 {
    match (lower.is_nan(), upper.is_nan()) {
        (false, false) => 0.5 * (upper - lower),
        (true, false) => upper - middle,
        (false, true) => middle - lower,
        (true, true) => 0.0,
    }
}

/// Flow across the edge between a cell and `cell + step`; `aside` is the distance in memory from a cell to its
/// neighbours along the edge.
#[inline(always)]
fn edge_flow(inputs: &SlopeInputs<'_>, cell: usize, step: usize, aside: usize) -> f64 {
    let (heights, other) = (inputs.heights, cell + step);
    let a = heights[cell] - heights[other];
    let beside = (heights[cell + aside] - heights[cell - aside]) + (heights[other + aside] - heights[other - aside]);
    let grade = inputs.grades[if a > 0.0 { cell } else { other }];
    let b = 0.25 * beside;
    // Where ground is missing, the comparison with NaN is false.
    if a * a + b * b <= grade * grade {
        return 0.0;
    }
    steep_flow(inputs, cell, step, aside)
}

/// As [`edge_flow`], for an edge that is too steep or lies beside missing ground.
fn steep_flow(inputs: &SlopeInputs<'_>, cell: usize, step: usize, aside: usize) -> f64 {
    let (heights, other) = (inputs.heights, cell + step);
    let a = heights[cell] - heights[other];
    if a.is_nan() || a == 0.0 {
        return 0.0;
    }
    let side = |i: usize| side_drop(heights[i], heights[i - aside], heights[i + aside]);
    let b = 0.5 * (side(cell) + side(other));
    let slope = (a * a + b * b).sqrt();
    let over = slope - inputs.grades[if a > 0.0 { cell } else { other }];
    // An infinite grade gives a negative excess.
    if over > 0.0 { (RATE * over * (a / slope)).trunc() } else { 0.0 }
}

/// Writes the flows of one sweep, in units: those across the eastern edge of each cell into `east`, those across the
/// northern edge into `north`, positive where material leaves the cell. Returns whether anything flows.
pub(crate) fn edge_flows(inputs: &SlopeInputs<'_>, east: &mut [f64], north: &mut [f64]) -> bool {
    let [columns, rows] = inputs.size;
    let stride = columns + 2;
    let mut flows = false;
    for row in 0..rows {
        let first = (row + 1) * stride + 1;
        for column in 0..columns {
            let (cell, here) = (row * columns + column, first + column);
            east[cell] = edge_flow(inputs, here, 1, stride);
            north[cell] = edge_flow(inputs, here, stride, 1);
            flows |= east[cell] != 0.0 || north[cell] != 0.0;
        }
    }
    flows
}
