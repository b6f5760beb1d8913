//! Obstacles: terrain and solid objects in the air, as the open share of each face, which is the part of its area that
//! they leave free.
//!
//! The share is exact in the vertical. Along each horizontal side of a face, [`SAMPLES`] places are evaluated. So
//! terrain slopes through cells instead of forming stairs, and a box may end anywhere within a cell. A box thinner than
//! a cell is made one cell thick, so that no air passes through it between two faces.

use glam::{DMat3, DVec2, DVec3};

use super::{
    lattice::{Faces, Lattice},
    settings::MAX_SPEED_M_S,
};
use crate::error::{Error, Result, check_range};

/// Number of places along each horizontal side of a face at which obstacles are evaluated.
const SAMPLES: usize = 8;
/// Distance from a face, as a share of a cell, within which an object counts as lying on the face.
const NEAR: f64 = 1e-6;

/// Box in the air with any orientation, cut by planes. Places are measured from the lowest corner of the field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowBox<'a> {
    /// Centre, m.
    pub center_m: DVec3,
    /// Half of its size along its own axes, m, \[1e-3, 1e5\].
    pub half_size_m: DVec3,
    /// Axes of the box as columns (east, north, up): a rotation.
    pub axes: DMat3,
    /// Velocity, m/s. A moving box pushes the air ahead of it.
    pub velocity_m_s: DVec3,
    /// Planes that cut the box, in its own axes: outward unit normal, and distance from the centre along it, m.
    pub planes: &'a [[f64; 4]],
}

impl FlowBox<'static> {
    /// Creates a box that stands still on a level floor, turned by `turned_deg` counter-clockwise seen from above.
    pub fn level(center_m: DVec3, half_size_m: DVec3, turned_deg: f64) -> Self {
        let (sin, cos) = libm::sincos(turned_deg.to_radians());
        let axes = DMat3::from_cols(DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z);
        Self { center_m, half_size_m, axes, velocity_m_s: DVec3::ZERO, planes: &[] }
    }
}

impl FlowBox<'_> {
    /// Returns how far the box reaches from its centre along the field's axes, m, ignoring the planes.
    pub(super) fn reach_m(&self) -> DVec3 {
        let reach = |axis: DVec3, half: f64| axis.abs() * half;
        let h = self.half_size_m;
        reach(self.axes.x_axis, h.x) + reach(self.axes.y_axis, h.y) + reach(self.axes.z_axis, h.z)
    }
}

/// Function that returns the height of the ground above the field's lowest corner, m. Its argument is a place, m east
/// and north of this corner.
pub type Heights<'a> = &'a dyn Fn(DVec2) -> f64;

/// Obstacles that stand or move in the air.
#[derive(Clone, Copy, Default)]
pub struct FlowObstacles<'a> {
    /// Heights of the ground; `None` if only the low side of the field bounds the air from below.
    pub terrain: Option<Heights<'a>>,
    /// Boxes.
    pub boxes: &'a [FlowBox<'a>],
}

/// Open shares of faces, and the moving obstacles that close them.
#[derive(Clone, Debug)]
pub(super) struct Shares {
    /// Open share of each face, \[0, 1\].
    pub open: Faces,
    /// Velocity along the face's axis times the share of the face that a moving obstacle closes, m/s; empty if no
    /// obstacle moves.
    pub pushed: Faces,
}

/// First and last column of cells along east and north.
pub(super) type ColumnRange = [[usize; 2]; 2];

/// Box in the form that a grid needs: the space inside all of its planes.
struct SolidBox {
    /// Outward unit normals, and distances of the planes along them from the field's corner, m.
    planes: Vec<(DVec3, f64)>,
    /// Lowest corner of the box's extent, m east and north of the field's corner.
    low: DVec2,
    /// Highest corner of the box's extent, m east and north of the field's corner.
    high: DVec2,
    /// Velocity of the box, m/s.
    velocity: DVec3,
}

impl SolidBox {
    /// Creates the planes of a box, made at least one cell thick.
    fn new(lattice: &Lattice, b: &FlowBox) -> Self {
        let h = DVec3::from(lattice.h.map(f64::from));
        let near = NEAR * h.min_element();
        let axes = [b.axes.x_axis, b.axes.y_axis, b.axes.z_axis];
        let mut planes = Vec::with_capacity(6 + b.planes.len());
        let mut solid = FlowBox { ..*b };
        for (i, axis) in axes.into_iter().enumerate() {
            // The width of a cell along the axis is the least thickness.
            let half = b.half_size_m[i].max(0.5 * axis.abs().dot(h)) + near;
            solid.half_size_m[i] = half;
            planes.push((axis, half + axis.dot(b.center_m)));
            planes.push((-axis, half - axis.dot(b.center_m)));
        }
        for &[x, y, z, d] in b.planes {
            let out = b.axes * DVec3::new(x, y, z);
            planes.push((out, d + near + out.dot(b.center_m)));
        }
        let reach = solid.reach_m();
        let (low, high) = ((b.center_m - reach).truncate(), (b.center_m + reach).truncate());
        Self { planes, low, high, velocity: b.velocity_m_s }
    }

    /// Returns the heights between which the box lies over a place, lowest first; `None` if it does not lie over the
    /// place.
    fn span(&self, place: DVec2) -> Option<[f64; 2]> {
        if place.cmplt(self.low).any() || place.cmpgt(self.high).any() {
            return None;
        }
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for (n, d) in &self.planes {
            let rest = d - n.truncate().dot(place);
            if n.z > 1e-12 {
                high = high.min(rest / n.z);
            } else if n.z < -1e-12 {
                low = low.max(rest / n.z);
            } else if rest < 0.0 {
                return None;
            }
        }
        (low < high).then_some([low, high])
    }

    /// Returns the columns of cells whose faces the box may close; `None` if the box lies beside the field.
    fn columns(&self, lattice: &Lattice) -> Option<ColumnRange> {
        let along = |a: usize| {
            let h = f64::from(lattice.h[a]);
            let (low, high) = ((self.low[a] / h).floor() - 1.0, (self.high[a] / h).ceil());
            let last = lattice.n[a] - 1;
            (high >= 0.0 && low <= last as f64).then(|| [low.max(0.0) as usize, (high as usize).min(last)])
        };
        Some([along(0)?, along(1)?])
    }
}

/// Returns the columns whose faces the boxes may close; `None` if there are none.
pub(super) fn columns_of(lattice: &Lattice, boxes: &[FlowBox]) -> Option<ColumnRange> {
    let all = boxes.iter().filter_map(|b| SolidBox::new(lattice, b).columns(lattice));
    all.reduce(|a, b| [0, 1].map(|i| [a[i][0].min(b[i][0]), a[i][1].max(b[i][1])]))
}

impl FlowObstacles<'_> {
    /// Checks the boxes; the error names the box and its value at fault.
    fn check(&self, lattice: &Lattice) -> Result<()> {
        let size = DVec3::from([0, 1, 2].map(|a| lattice.n[a] as f64 * f64::from(lattice.h[a])));
        for (i, b) in self.boxes.iter().enumerate() {
            let name = |field: &str| format!("flow.boxes[{i}].{field}");
            for v in b.half_size_m.to_array() {
                check_range(&name("half_size_m"), v, 1e-3, 1e5, "m")?;
            }
            let speed = b.velocity_m_s.length();
            if !(0.0..=MAX_SPEED_M_S).contains(&speed) {
                let wanted = format!("a vector of at most {MAX_SPEED_M_S} m/s");
                return Err(Error::range(&name("velocity_m_s"), &wanted, b.velocity_m_s));
            }
            let off = (b.axes.transpose() * b.axes - DMat3::IDENTITY).to_cols_array();
            if !off.iter().all(|v| v.abs() < 1e-3) {
                return Err(Error::range(&name("axes"), "three unit vectors at right angles", b.axes));
            }
            let reach = b.reach_m();
            let is_in = (b.center_m + reach).cmpgt(DVec3::ZERO).all() && (b.center_m - reach).cmplt(size).all();
            if !(b.center_m.is_finite() && is_in) {
                return Err(Error::range(&name("center_m"), "such that the box reaches into the field", b.center_m));
            }
        }
        Ok(())
    }

    /// Returns the open shares of all faces of a grid.
    pub(super) fn shares(&self, lattice: &Lattice) -> Result<Shares> {
        let open = lattice.zeros().map(|v| vec![1.0; v.len()]);
        let mut shares = Shares { open, pushed: Faces::default() };
        if self.terrain.is_none() && self.boxes.is_empty() {
            return Ok(shares);
        }
        self.check(lattice)?;
        self.find(lattice, [0, 1].map(|a| [0, lattice.n[a] - 1]), &mut shares)?;
        Ok(shares)
    }

    /// Computes the shares of the faces of some columns.
    pub(super) fn find(&self, lattice: &Lattice, columns: ColumnRange, shares: &mut Shares) -> Result<()> {
        let solids: Vec<SolidBox> = self.boxes.iter().map(|b| SolidBox::new(lattice, b)).collect();
        let moves = solids.iter().any(|s| s.velocity != DVec3::ZERO);
        if moves && shares.pushed[0].is_empty() {
            shares.pushed = lattice.zeros();
        }
        let h = lattice.h.map(f64::from);
        let mut column = SpanColumn { h: h[2], spans: Vec::new(), moving: Vec::new() };
        let nz = lattice.n[2] + 1;
        let (mut closed, mut pushed) = (vec![0.0; nz], vec![0.0; nz]);
        for c in lattice.axes() {
            // Along the normal of a face one place is enough.
            let count = |a: usize| if a == c || lattice.is_flat(a) { 1 } else { SAMPLES };
            let along = |a: usize, i: usize, s: usize| match a == c && !lattice.is_flat(a) {
                true => i as f64 * h[a],
                false => (i as f64 + (s as f64 + 0.5) / count(a) as f64) * h[a],
            };
            let share = 1.0 / (count(0) * count(1)) as f64;
            let of_component = |a: usize| columns[a][0]..=columns[a][1] + lattice.count(c, a) - lattice.n[a];
            for (i, j) in of_component(1).flat_map(|j| of_component(0).map(move |i| (i, j))) {
                closed.fill(0.0);
                pushed.fill(0.0);
                for (t, s) in (0..count(1)).flat_map(|t| (0..count(0)).map(move |s| (t, s))) {
                    column.find(self.terrain, &solids, DVec2::new(along(0, i, s), along(1, j, t)))?;
                    for k in 0..lattice.count(c, 2) {
                        closed[k] += share * column.closed(c, k);
                        if moves {
                            pushed[k] += share * column.pushed(c, k);
                        }
                    }
                }
                for k in 0..lattice.count(c, 2) {
                    let at = lattice.at([i, j, k]);
                    shares.open[c][at] = (1.0 - closed[k]) as f32;
                    if let Some(v) = shares.pushed[c].get_mut(at) {
                        *v = pushed[k] as f32;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Solid spans above a place.
struct SpanColumn {
    /// Height of a cell, m.
    h: f64,
    /// Lower and upper height of each span, lowest first, without overlap.
    spans: Vec<[f64; 2]>,
    /// Spans of moving objects, with their velocity.
    moving: Vec<([f64; 2], DVec3)>,
}

impl SpanColumn {
    /// Finds the spans above a place.
    fn find(&mut self, terrain: Option<Heights>, solids: &[SolidBox], place: DVec2) -> Result<()> {
        self.spans.clear();
        self.moving.clear();
        if let Some(heights) = terrain {
            let ground = heights(place);
            if !ground.is_finite() {
                let got = format!("{ground} at {place}");
                return Err(Error::range("flow.terrain", "a finite height everywhere in the field", got));
            }
            self.spans.push([f64::NEG_INFINITY, ground + NEAR * self.h]);
        }
        for solid in solids {
            let Some(span) = solid.span(place) else { continue };
            self.spans.push(span);
            if solid.velocity != DVec3::ZERO {
                self.moving.push((span, solid.velocity));
            }
        }
        self.spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
        self.spans.dedup_by(|next, kept| {
            let joins = next[0] <= kept[1];
            if joins {
                kept[1] = kept[1].max(next[1]);
            }
            joins
        });
        Ok(())
    }

    /// Returns the solid share of the height of a cell. For the vertical component, returns 1 or 0: whether the face at
    /// the cell's bottom is closed.
    fn closed(&self, component: usize, cell: usize) -> f64 {
        let sum: f64 = self.spans.iter().map(|s| self.within(s, component, cell)).sum();
        sum.min(1.0)
    }

    /// Returns the share of a cell's height that a span takes up. For the vertical component, returns 1 or 0: whether
    /// the span contains the face at the cell's bottom.
    fn within(&self, span: &[f64; 2], component: usize, cell: usize) -> f64 {
        let (low, high) = (cell as f64 * self.h, (cell + 1) as f64 * self.h);
        if component == 2 {
            return f64::from(u8::from((span[0]..=span[1]).contains(&low)));
        }
        (span[1].min(high) - span[0].max(low)).max(0.0) / self.h
    }

    /// Returns the sum over moving objects of the share of a cell's height that the object takes up, times its velocity
    /// along the component's axis, m/s. For the vertical component the share is 1 or 0: whether the object contains the
    /// face at the cell's bottom.
    fn pushed(&self, component: usize, cell: usize) -> f64 {
        self.moving.iter().map(|(span, v)| self.within(span, component, cell) * v[component]).sum()
    }
}
