//! Heights of the host's terrain on a regular grid, for the water on the terrain.

use glam::{DMat3, DVec2, DVec3};

use super::class::SurfaceClass;
use crate::error::{Error, Result, check_range};

/// Largest number of nodes of a grid along each axis.
pub const MAX_GRID_NODES: u32 = 512;
/// Largest height above or below the origin, m.
const MOST_M: f32 = 1e5;
/// Height above the terrain, m. A place at this height or higher is taken to be on an object that stands on the
/// terrain, such as a bridge or a roof.
pub(super) const ABOVE_M: f64 = 3.0;

/// Heights of the host's terrain on a grid that is level and aligned to north at its origin. Each node is the middle of
/// a square cell with water of its own. Between nodes the water is interpolated bilinearly. Outside the nodes lies
/// level, open ground ([`GroundModel`](crate::ground::GroundModel)).
#[derive(Clone, Debug, PartialEq)]
pub struct GroundGrid {
    /// South-west corner node in the host's world; `heights_m` are measured from its height.
    pub origin: DVec3,
    /// Distance between nodes, m, \[0.01, 10 000\]. Puddles smaller than a few cells are not resolved.
    pub cell_m: f64,
    /// Numbers of nodes east and north, each \[2, 512\].
    pub nodes: [u32; 2],
    /// Heights above the origin, m, within +-1e5. They are stored row by row from south to north, each row from west to
    /// east.
    pub heights_m: Vec<f32>,
    /// Surface class of each cell, in the order of the heights; empty if not given.
    pub classes: Vec<SurfaceClass>,
}

impl GroundGrid {
    /// Checks the grid; the error names the field at fault.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        if !(self.origin.is_finite() && self.origin.length() <= 1e12) {
            return Err(Error::range("ground_grid.origin_m", "finite and within 1e12 m", self.origin));
        }
        check_range("ground_grid.cell_m", self.cell_m, 0.01, 1e4, "m")?;
        for (i, nodes) in self.nodes.into_iter().enumerate() {
            let name = format!("ground_grid.nodes[{i}]");
            check_range(&name, f64::from(nodes), 2.0, f64::from(MAX_GRID_NODES), "")?;
        }
        let count = self.len();
        if self.heights_m.len() != count {
            let wanted = format!("{count}, one a node");
            return Err(Error::range("ground_grid.heights_m.len", &wanted, self.heights_m.len()));
        }
        if !self.classes.is_empty() && self.classes.len() != count {
            let wanted = format!("0, or {count}, one a node");
            return Err(Error::range("ground_grid.classes.len", &wanted, self.classes.len()));
        }
        match self.heights_m.iter().position(|h| h.is_nan() || h.abs() > MOST_M) {
            None => Ok(()),
            Some(i) => {
                let name = format!("ground_grid.heights_m[{i}]");
                Err(Error::range(&name, &format!("finite and within {MOST_M} m"), self.heights_m[i]))
            }
        }
    }

    /// Returns the number of nodes.
    pub(crate) fn len(&self) -> usize {
        self.nodes[0] as usize * self.nodes[1] as usize
    }

    /// Returns the place of `position` (in the host's world): cells east and north of the origin, and height over the
    /// origin, m. `to_enu` turns the host's axes to east, north, up at the origin.
    pub(crate) fn cells_at(&self, position: DVec3, to_enu: DMat3) -> (DVec2, f64) {
        let p = to_enu * (position - self.origin);
        (p.truncate() / self.cell_m, p.z)
    }

    /// Returns the grid's cells without its classes.
    pub(super) fn cells(&self) -> CellGrid<'_> {
        CellGrid { origin: self.origin, cell_m: self.cell_m, nodes: self.nodes, heights_m: &self.heights_m }
    }

    /// Returns the position of a node in the host's world.
    #[cfg(test)]
    pub(super) fn node(&self, index: usize, to_enu: &DMat3) -> DVec3 {
        self.cells().node(index, to_enu)
    }

    /// Returns whether `other` has the same heights at the same places; classes are ignored.
    pub(crate) fn has_heights_of(&self, other: &Self) -> bool {
        let place = |g: &Self| (g.origin, g.cell_m, g.nodes);
        place(self) == place(other) && self.heights_m == other.heights_m
    }

    /// Returns the surface class of a cell; [`SurfaceClass::Unspecified`] if the host gave no classes.
    pub(crate) fn class(&self, cell: usize) -> SurfaceClass {
        self.classes.get(cell).copied().unwrap_or_default()
    }

    /// Returns the slope at a node, rise over run to the east and the north: a central difference, one-sided at the
    /// border.
    pub(crate) fn slope(&self, node: usize) -> [f64; 2] {
        let columns = self.nodes[0] as usize;
        let place = [node % columns, node / columns];
        [0, 1].map(|axis| {
            let stride = if axis == 0 { 1 } else { columns };
            let before = usize::from(place[axis] > 0);
            let after = usize::from(place[axis] + 1 < self.nodes[axis] as usize);
            let rise = f64::from(self.heights_m[node + after * stride] - self.heights_m[node - before * stride]);
            rise / ((before + after) as f64 * self.cell_m)
        })
    }

    /// Returns the four nodes around a place and their bilinear weights; `None` outside the grid.
    pub(crate) fn about(&self, cells: DVec2) -> Option<[(usize, f64); 4]> {
        let c = cells.to_array();
        let inside = c.iter().zip(self.nodes).all(|(x, n)| (0.0..=f64::from(n - 1)).contains(x));
        inside.then(|| {
            let low = [0, 1].map(|i| (c[i] as u32).min(self.nodes[i] - 2));
            let part = [0, 1].map(|i| c[i] - f64::from(low[i]));
            [[0, 0], [1, 0], [0, 1], [1, 1]].map(|bit: [u32; 2]| {
                let share = [0, 1].map(|i| if bit[i] == 1 { part[i] } else { 1.0 - part[i] });
                let index = (low[1] + bit[1]) as usize * self.nodes[0] as usize + (low[0] + bit[0]) as usize;
                (index, share[0] * share[1])
            })
        })
    }

    /// Returns the nodes around a place of the host's world, with their weights; `None` outside the grid, and at
    /// [`ABOVE_M`] or more above its ground.
    pub(crate) fn on_terrain(&self, position: DVec3, to_enu: DMat3) -> Option<[(usize, f64); 4]> {
        let (cells, height) = self.cells_at(position, to_enu);
        let about = self.about(cells)?;
        let ground: f64 = about.iter().map(|(i, share)| share * f64::from(self.heights_m[*i])).sum();
        (height < ground + ABOVE_M).then_some(about)
    }
}

/// Places and heights of the cells of a grid or of a tile.
#[derive(Clone, Copy)]
pub(super) struct CellGrid<'a> {
    /// First node in the host's world; heights are measured from its height.
    pub origin: DVec3,
    /// Distance between neighbouring cells, m.
    pub cell_m: f64,
    /// Numbers of nodes east and north.
    pub nodes: [u32; 2],
    /// Height of each cell over the origin, m, row by row from the south-west.
    pub heights_m: &'a [f32],
}

impl CellGrid<'_> {
    /// Returns the number of nodes.
    pub fn len(&self) -> usize {
        self.heights_m.len()
    }

    /// Returns the position of a node in the host's world.
    pub fn node(&self, index: usize, to_enu: &DMat3) -> DVec3 {
        let columns = self.nodes[0] as usize;
        let plan = DVec2::new((index % columns) as f64, (index / columns) as f64) * self.cell_m;
        self.origin + to_enu.transpose() * plan.extend(f64::from(self.heights_m[index]))
    }

    /// Returns the heights of the lowest and the highest node, m.
    pub fn range(&self) -> (f64, f64) {
        let ends = self.heights_m.iter().fold((f32::MAX, f32::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
        (f64::from(ends.0), f64::from(ends.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Creates a grid that rises by 0.5 m a cell to the east and by 1 m a cell to the north.
    fn grid() -> GroundGrid {
        let heights_m = (0..12).map(|i| (i % 4) as f32 * 0.5 + (i / 4) as f32).collect();
        GroundGrid { origin: DVec3::new(10.0, 20.0, 30.0), cell_m: 2.0, nodes: [4, 3], heights_m, classes: Vec::new() }
    }

    #[test]
    fn places_between_nodes_have_their_share_of_each() {
        let grid = grid();
        for p in [DVec3::new(10.0, 20.0, 30.0), DVec3::new(13.0, 21.5, 30.0), DVec3::new(16.0, 24.0, 33.5)] {
            let about = grid.on_terrain(p, DMat3::IDENTITY).unwrap();
            let height: f64 = about.iter().map(|(i, s)| s * f64::from(grid.heights_m[*i])).sum();
            assert!((height - ((p.x - 10.0) * 0.25 + (p.y - 20.0) * 0.5)).abs() < 1e-12, "{p}: {height}");
        }
        for p in [DVec3::new(9.9, 21.0, 30.0), DVec3::new(11.0, 24.1, 30.0), DVec3::new(11.0, 21.0, 34.0)] {
            assert_eq!(grid.on_terrain(p, DMat3::IDENTITY), None, "{p}");
        }
        assert_eq!(grid.node(6, &DMat3::IDENTITY), DVec3::new(14.0, 22.0, 32.0));
    }

    #[test]
    fn slopes_are_those_of_the_heights() {
        let grid = grid();
        for node in 0..12 {
            let slope = grid.slope(node);
            assert!((slope[0] - 0.25).abs() < 1e-12 && (slope[1] - 0.5).abs() < 1e-12, "{node}: {slope:?}");
        }
    }

    #[test]
    fn bad_grids_are_refused_by_name() {
        grid().validate().unwrap();
        let torn = |v: f32| {
            let mut torn = grid();
            torn.heights_m[7] = v;
            torn
        };
        let mut short = grid();
        short.heights_m.pop();
        for (bad, name) in [
            (GroundGrid { origin: DVec3::splat(f64::NAN), ..grid() }, "origin_m must be"),
            (GroundGrid { cell_m: -1.0, ..grid() }, "cell_m must be in [0.01, 10000]"),
            (GroundGrid { cell_m: f64::NAN, ..grid() }, "cell_m must be in [0.01, 10000] m, got NaN"),
            (GroundGrid { nodes: [1, 4], ..grid() }, "nodes[0] must be in [2, 512]"),
            (GroundGrid { nodes: [4, 513], ..grid() }, "nodes[1] must be in [2, 512]"),
            (torn(f32::NAN), "heights_m[7] must be finite"),
            (torn(f32::INFINITY), "heights_m[7] must be finite"),
            (torn(-2e5), "heights_m[7] must be finite"),
            (short, "heights_m.len must be 12"),
            (GroundGrid { classes: vec![SurfaceClass::Soil; 11], ..grid() }, "classes.len must be 0, or 12"),
        ] {
            let e = bad.validate().unwrap_err();
            assert!(e.to_string().contains(&format!("ground_grid.{name}")), "{name}: {}", e);
        }
    }
}
