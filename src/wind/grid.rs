//! Wind that varies in space: velocities on a grid from the host or a flow solver.

use glam::DVec3;

use crate::error::{Error, Result, check_range};

/// Maximum numbers of nodes of a grid east, north and up.
pub const MAX_NODES: [u32; 3] = [64, 64, 32];
/// Largest speed of a node, m/s.
const MAX_SPEED_M_S: f64 = 300.0;

/// Meaning of a grid's velocities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WindGridKind {
    /// The whole wind, which replaces the weather's wind inside the grid.
    #[default]
    Whole,
    /// Wind that is added to the weather's wind.
    Added,
}

/// Velocities of the air at the nodes of a grid that is level and aligned to north. Between nodes the velocity is
/// linear along each axis. Outside the grid the weather's wind blows.
#[derive(Clone, Debug, PartialEq)]
pub struct WindGrid {
    /// Position of the lowest, south-western node in the host's world, within 1e12 m of the origin.
    pub origin: DVec3,
    /// Distance between nodes east, north and up, m, \[0.01, 10 000\].
    pub cell_m: DVec3,
    /// Numbers of nodes east, north and up, 2 to [`MAX_NODES`].
    pub nodes: [u32; 3],
    /// Meaning of `velocities_m_s`.
    pub kind: WindGridKind,
    /// Velocities (east, north, up), m/s, each of a magnitude of at most 300. East varies fastest, then north, then up.
    pub velocities_m_s: Vec<[f32; 3]>,
}

impl WindGrid {
    /// Checks that every field is in range.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a field out of range, or a number of velocities that is not that of the
    /// nodes. The message names the field.
    pub fn validate(&self) -> Result<()> {
        if !(self.origin.is_finite() && self.origin.length() <= 1e12) {
            return Err(Error::range("wind_grid.origin_m", "finite and within 1e12 m", self.origin));
        }
        for (i, (cell, nodes)) in self.cell_m.to_array().into_iter().zip(self.nodes).enumerate() {
            check_range(&format!("wind_grid.cell_m[{i}]"), cell, 0.01, 1e4, "m")?;
            check_range(&format!("wind_grid.nodes[{i}]"), f64::from(nodes), 2.0, f64::from(MAX_NODES[i]), "")?;
        }
        let count = self.nodes.iter().map(|n| *n as usize).product::<usize>();
        if self.velocities_m_s.len() != count {
            let wanted = format!("{count}, one a node");
            return Err(Error::range("wind_grid.velocities_m_s.len", &wanted, self.velocities_m_s.len()));
        }
        let slow = |v: &[f32; 3]| DVec3::from(v.map(f64::from)).length() <= MAX_SPEED_M_S;
        match self.velocities_m_s.iter().position(|v| !slow(v)) {
            None => Ok(()),
            Some(i) => Err(Error::range(
                &format!("wind_grid.velocities_m_s[{i}]"),
                &format!("finite and at most {MAX_SPEED_M_S} m/s"),
                format!("{:?}", self.velocities_m_s[i]),
            )),
        }
    }

    /// Returns the velocity at a position in cells from the origin, m/s (east, north, up); `None` outside.
    pub fn at(&self, cells: DVec3) -> Option<DVec3> {
        let velocity = |i: usize| DVec3::from(self.velocities_m_s[i].map(f64::from));
        Some(about(self.nodes, cells)?.into_iter().map(|(i, weight)| velocity(i) * weight).sum())
    }
}

/// Returns the eight nodes around a position in cells from the first node, with their weights for linear interpolation;
/// `None` outside.
pub(super) fn about(nodes: [u32; 3], cells: DVec3) -> Option<[(usize, f64); 8]> {
    let c = cells.to_array();
    let inside = c.iter().zip(nodes).all(|(x, n)| n > 1 && (0.0..=f64::from(n - 1)).contains(x));
    if !inside {
        return None;
    }
    let low = [0, 1, 2].map(|i| (c[i] as u32).min(nodes[i] - 2));
    let part = [0, 1, 2].map(|i| c[i] - f64::from(low[i]));
    Some(std::array::from_fn(|corner| {
        let bit = [corner & 1, corner >> 1 & 1, corner >> 2];
        let at = [0, 1, 2].map(|i| low[i] as usize + bit[i]);
        let weight = (0..3).map(|i| if bit[i] == 1 { part[i] } else { 1.0 - part[i] }).product();
        ((at[2] * nodes[1] as usize + at[1]) * nodes[0] as usize + at[0], weight)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a wind that is linear in every coordinate, which interpolation reproduces exactly.
    fn linear(p: DVec3) -> DVec3 {
        DVec3::new(3.0 + 0.5 * p.x - 0.25 * p.z, -1.0 + 0.125 * p.y, 0.5 * p.z - 0.0625 * p.x)
    }

    fn grid() -> WindGrid {
        let nodes = [5u32, 4, 3];
        let mut velocities_m_s = Vec::new();
        for z in 0..nodes[2] {
            for y in 0..nodes[1] {
                for x in 0..nodes[0] {
                    let v = linear(DVec3::new(f64::from(x), f64::from(y), f64::from(z)));
                    velocities_m_s.push(v.as_vec3().to_array());
                }
            }
        }
        let (origin, cell_m) = (DVec3::new(10.0, 20.0, 30.0), DVec3::new(2.0, 3.0, 4.0));
        WindGrid { origin, cell_m, nodes, kind: WindGridKind::Whole, velocities_m_s }
    }

    #[test]
    fn between_nodes_velocities_go_linearly_and_outside_there_are_none() {
        let grid = grid();
        for p in [DVec3::ZERO, DVec3::new(4.0, 3.0, 2.0), DVec3::new(1.3, 2.9, 0.4), DVec3::new(3.99, 0.01, 1.5)] {
            assert!((grid.at(p).unwrap() - linear(p)).length() < 1e-6, "{p}");
        }
        for p in [DVec3::new(-0.01, 1.0, 1.0), DVec3::new(1.0, 3.01, 1.0), DVec3::new(1.0, 1.0, 2.01), DVec3::NAN] {
            assert_eq!(grid.at(p), None, "{p}");
        }
    }

    #[test]
    fn bad_grids_are_refused_by_name() {
        grid().validate().unwrap();
        let mut torn = grid();
        torn.velocities_m_s[7][1] = f32::NAN;
        let mut short = grid();
        short.velocities_m_s.pop();
        for (bad, name) in [
            (WindGrid { origin: DVec3::splat(f64::INFINITY), ..grid() }, "origin_m"),
            (WindGrid { cell_m: DVec3::new(1.0, 0.0, 1.0), ..grid() }, "cell_m[1]"),
            (WindGrid { nodes: [5, 4, 33], ..grid() }, "nodes[2]"),
            (WindGrid { nodes: [1, 4, 3], ..grid() }, "nodes[0]"),
            (torn, "velocities_m_s[7]"),
            (short, "velocities_m_s.len must be 60"),
        ] {
            let e = bad.validate().unwrap_err();
            assert!(e.to_string().contains(&format!("wind_grid.{name}")), "{}", e);
        }
    }
}
