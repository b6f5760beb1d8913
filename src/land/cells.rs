//! Cells of a terrain as the drawing reads them: across tiles, with a height at every lattice position.

use crate::terrain::{CellRect, DugColor, HOLE, Terrain, Tile};

/// Binary logarithm of the largest distance, cells, from which a position without ground takes its height.
pub(super) const FARTHEST_RING: u32 = 10;

/// Least steepness of a wall, drop over distance. On such a slope loose soil does not rest and grass does not grow.
pub(super) const WALL: f64 = 0.8;

/// Directions of the eight positions around a position.
const RING: [[i32; 2]; 8] = [[-1, -1], [0, -1], [1, -1], [-1, 0], [1, 0], [-1, 1], [0, 1], [1, 1]];

/// Reader of cells, which remembers the tile that it read last.
pub(super) struct CellReader<'a> {
    pub terrain: &'a Terrain,
    /// Rectangle of the last tile, and the tile, if there is one.
    last: (CellRect, Option<&'a Tile>),
}

fn tile_with(terrain: &Terrain, place: [i32; 2]) -> (CellRect, Option<&Tile>) {
    let key = terrain.key_of(place);
    (terrain.rect(key), terrain.slot(key).map(|slot| terrain.tile(slot)))
}

impl<'a> CellReader<'a> {
    pub fn new(terrain: &'a Terrain) -> Self {
        Self { terrain, last: tile_with(terrain, [0, 0]) }
    }

    /// Tile of a position, and the cell's index in it.
    fn tile_of(&mut self, [x, y]: [i32; 2]) -> Option<(&'a Tile, usize)> {
        let rect = &self.last.0;
        if x < rect.low[0] || y < rect.low[1] || x >= rect.high[0] || y >= rect.high[1] {
            self.last = tile_with(self.terrain, [x, y]);
        }
        Some((self.last.1?, self.terrain.in_tile([x, y])))
    }

    /// Height of a cell with ground, m.
    pub fn height(&mut self, place: [i32; 2]) -> Option<f32> {
        let (tile, cell) = self.tile_of(place)?;
        tile.has_ground(cell).then(|| tile.heights_m[cell])
    }

    /// Class number of a cell with ground.
    pub fn class(&mut self, place: [i32; 2]) -> Option<u8> {
        let (tile, cell) = self.tile_of(place)?;
        Some(tile.class_number(cell)).filter(|number| *number != HOLE)
    }

    /// Soil that shows in a cell.
    pub fn dug_color(&mut self, place: [i32; 2]) -> DugColor {
        self.tile_of(place).map_or_else(DugColor::default, |(tile, cell)| tile.dug_color(cell))
    }

    /// Returns whether a cell is the upper edge of a wall of soil: soil shows in a neighbour, and the drop to that
    /// neighbour is steeper than [`WALL`].
    pub fn tops_wall(&mut self, [x, y]: [i32; 2]) -> bool {
        let Some(own) = self.height([x, y]) else { return false };
        let drop = (WALL * self.terrain.desc.cell_m) as f32;
        [[x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]]
            .into_iter()
            .any(|at| self.dug_color(at).share > 0 && self.height(at).is_some_and(|height| own - height > drop))
    }

    /// Height at a lattice position, m. Without ground there it is the mean height of the nearest cells with ground
    /// among those in eight directions, at distances of 1, 2, 4 and so on. The largest of these distances depends on
    /// the position alone, so all levels of detail have the same height there. `None` if none of these cells has
    /// ground.
    pub fn height_or_near(&mut self, [x, y]: [i32; 2]) -> Option<f32> {
        if let Some(height) = self.height([x, y]) {
            return Some(height);
        }
        let coarsest = (x | y).trailing_zeros().min(FARTHEST_RING);
        (0..=coarsest).find_map(|ring| {
            let (mut sum, mut count) = (0.0, 0.0);
            for [dx, dy] in RING {
                let at = [x.saturating_add(dx << ring), y.saturating_add(dy << ring)];
                if let Some(height) = self.height(at) {
                    (sum, count) = (sum + height, count + 1.0);
                }
            }
            (count > 0.0).then(|| sum / count)
        })
    }
}
