//! Terrain of the host in the form that effects read: heights on a regular grid.

use glam::{DMat3, DVec2, DVec3};

/// Heights on a grid that is level and aligned to north at its origin; bilinear between nodes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TerrainHeights {
    /// Position of the south-western node in the host's world. `heights_m` are relative to its height.
    pub origin: DVec3,
    /// Rotation from the host's axes to east, north, up at the origin.
    pub to_enu: DMat3,
    /// Distance between nodes, m.
    pub cell_m: f64,
    /// Numbers of nodes east and north, at least two each.
    pub nodes: [u32; 2],
    /// Heights above the origin, m, row by row from south to north, each row from west to east.
    pub heights_m: Vec<f32>,
    /// Hash, equal for equal terrain.
    pub hash: u64,
}

impl TerrainHeights {
    /// Creates the terrain from heights, one for each node.
    pub fn new((origin, to_enu): (DVec3, DMat3), cell_m: f64, nodes: [u32; 2], heights_m: Vec<f32>) -> Self {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        let mut add = |bits: u64| hash = (hash ^ bits).wrapping_mul(0x0000_0100_0000_01b3);
        origin.to_array().into_iter().chain([cell_m]).for_each(|v| add(v.to_bits()));
        nodes.iter().for_each(|n| add(u64::from(*n)));
        heights_m.iter().for_each(|h| add(u64::from(h.to_bits())));
        Self { origin, to_enu, cell_m, nodes, heights_m, hash }
    }

    /// Returns whether the nodes lie at the same places as those of `other`.
    pub fn has_nodes_of(&self, other: &Self) -> bool {
        (self.origin, self.cell_m, self.nodes) == (other.origin, other.cell_m, other.nodes)
    }

    /// Returns the height above the origin, m, at a place east and north of the origin, m. Outside the grid it is the
    /// height of the nearest place on the grid.
    pub fn height_m(&self, place_m: DVec2) -> f64 {
        let at = place_m / self.cell_m;
        let along = |v: f64, nodes: u32| {
            let v = v.clamp(0.0, f64::from(nodes - 1));
            let low = (v as u32).min(nodes - 2);
            (low as usize, v - f64::from(low))
        };
        let ((i, x), (j, y)) = (along(at.x, self.nodes[0]), along(at.y, self.nodes[1]));
        let columns = self.nodes[0] as usize;
        let height = |i: usize, j: usize| f64::from(self.heights_m[j * columns + i]);
        let row = |j: usize| height(i, j) * (1.0 - x) + height(i + 1, j) * x;
        row(j) * (1.0 - y) + row(j + 1) * y
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_go_linearly_and_stay_beyond_the_edge() {
        let heights_m = (0..12).map(|i| (i % 4) as f32 * 0.5 + (i / 4) as f32).collect();
        let t = TerrainHeights::new((DVec3::ZERO, DMat3::IDENTITY), 2.0, [4, 3], heights_m);
        for (x, y) in [(0.0, 0.0), (3.0, 1.5), (6.0, 4.0), (1.1, 3.3)] {
            assert!((t.height_m(DVec2::new(x, y)) - (0.25 * x + 0.5 * y)).abs() < 1e-12, "{x} {y}");
        }
        assert_eq!(t.height_m(DVec2::new(-5.0, 40.0)), 2.0);
        assert_eq!(t.height_m(DVec2::new(1e9, -1e9)), 1.5);
    }
}
