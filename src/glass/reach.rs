//! Share of the rain that reaches each part of the pane past shelters and maps.
//!
//! A grid of nodes lies over the pane's bounds. Boxes are tested on the CPU in f64, so that every view has the same
//! bits. The host's maps, which are on the GPU, are tested by their own pass (`shaders/glass/maps.wgsl`). The shaders
//! give each cell of the glass, which holds one bead, the share interpolated between the four nodes around it, in
//! integers.

use std::array::from_fn;

/// Number of nodes along the pane's lower edge, and up the glass.
pub const NODES: [usize; 2] = [16, 8];
/// Value of a node that all of the rain reaches.
pub const ALL: u8 = 128;
/// Number of vectors of four words that hold the nodes; each vector holds sixteen nodes.
const WORDS: usize = NODES[0] * NODES[1] / 16;
/// Number of drop sizes tested at each node. Each represents an equal share of the water.
pub const SIZES: usize = 6;

/// Shares of the rain that reach the nodes, each from 0 to [`ALL`], in rows from the lower edge up, packed for
/// `shaders/glass/cells.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reach([[u32; 4]; WORDS]);

impl Reach {
    /// Shares with which all of the rain reaches every node.
    pub const ALL: Self = Self([[ALL as u32 * 0x0101_0101; 4]; WORDS]);

    /// Creates the shares. `share` returns the share, 0 to 1, at a position in the pane's bounds, 0 to 1 to the right
    /// and up.
    pub fn of(share: impl Fn([f64; 2]) -> f64) -> Self {
        let mut nodes = [0u8; NODES[0] * NODES[1]];
        for (i, node) in nodes.iter_mut().enumerate() {
            let at = [i % NODES[0], i / NODES[0]];
            let share = share(from_fn(|k| at[k] as f64 / (NODES[k] - 1) as f64));
            *node = (share * f64::from(ALL)).round().clamp(0.0, f64::from(ALL)) as u8;
        }
        Self::from_nodes(&nodes)
    }

    /// Creates the shares from the nodes, row by row; a missing node has 0.
    pub fn from_nodes(nodes: &[u8]) -> Self {
        let byte = |i: usize| nodes.get(i).copied().unwrap_or(0);
        Self(from_fn(|w| from_fn(|k| u32::from_le_bytes(from_fn(|b| byte(16 * w + 4 * k + b))))))
    }

    /// Returns the shares in the layout of the shaders: four nodes in a word, the first in the lowest byte.
    pub(super) fn words(&self) -> [[u32; 4]; WORDS] {
        self.0
    }

    /// Returns the share of each node, 0 to 1.
    fn nodes(&self) -> impl Iterator<Item = f64> + '_ {
        self.0.iter().flatten().flat_map(|w| w.to_le_bytes()).map(|b| f64::from(b) / f64::from(ALL))
    }

    /// Returns whether any rain reaches the pane.
    pub fn any(&self) -> bool {
        self.0.iter().flatten().any(|w| *w != 0)
    }

    /// Returns the product of this share and `other` at each node: the rain that passes both.
    pub fn and(&self, other: &Self) -> Self {
        let mut nodes = [0u8; NODES[0] * NODES[1]];
        for ((node, a), b) in nodes.iter_mut().zip(self.nodes()).zip(other.nodes()) {
            *node = (a * b * f64::from(ALL)) as u8;
        }
        Self::from_nodes(&nodes)
    }

    /// Returns the mean share over the pane's bounds. Nodes on an edge have half the weight, and those at a corner a
    /// quarter.
    pub fn mean(&self) -> f64 {
        let edge = |i: usize, n: usize| if i == 0 || i == n - 1 { 0.5 } else { 1.0 };
        let weighed = self.nodes().enumerate().map(|(i, share)| {
            let weight = edge(i % NODES[0], NODES[0]) * edge(i / NODES[0], NODES[1]);
            share * weight
        });
        weighed.sum::<f64>() / ((NODES[0] - 1) * (NODES[1] - 1)) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_that_of_a_surface_through_the_nodes() {
        assert_eq!((Reach::ALL.mean(), Reach::of(|_| 1.0), Reach::of(|_| 0.0).any()), (1.0, Reach::ALL, false));
        let half = Reach::of(|[x, _]| x);
        assert!((half.mean() - 0.5).abs() < 1e-2 && half.any(), "{}", half.mean());
        let corner = Reach::of(|[x, y]| if x == 1.0 && y == 1.0 { 1.0 } else { 0.0 });
        assert_eq!(corner.words()[WORDS - 1], [0, 0, 0, u32::from(ALL) << 24]);
        assert!((half.and(&half).mean() - 1.0 / 3.0).abs() < 1e-2 && half.and(&Reach::ALL) == half);
    }
}
