//! One tile of the terrain: heights, classes, and a hash that each change updates.

use super::{DugCell, DugColor, HOLE, SurfaceClass, TerrainCells, TileKey, desc::is_height};

use crate::chance::mixed;

/// Heights and classes of a tile's cells.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tile {
    pub key: TileKey,
    /// Heights above the terrain's origin, m, by rows from the south-west; holes have a height too. These are the
    /// host's heights with the change by the soil.
    pub heights_m: Vec<f32>,
    /// Heights that the host gave. Empty if soil has changed no height: `heights_m` are then the host's.
    undug_m: Vec<f32>,
    /// Soil that shows in each cell. Empty if soil shows in no cell.
    dug_colors: Vec<DugColor>,
    /// Class numbers of the cells, or [`HOLE`]. Empty if the host has given no class for any cell.
    classes: Vec<u8>,
    /// Revision of the terrain at this tile's last change.
    pub revision: u64,
    /// Revision of the soil up to which the heights include the soil's changes; 0 for a new tile.
    pub soil_revision: u64,
    /// Sum of the hashes of the tile's cells; equal for tiles with the same heights and classes.
    pub hash: u64,
}

impl Tile {
    /// Creates a level tile at height 0 with `tile_cells` cells along a side and no classes.
    pub fn level(key: TileKey, tile_cells: u32) -> Self {
        let count = tile_cells as usize * tile_cells as usize;
        let mut tile = Self { key, heights_m: vec![0.0; count], ..Self::none() };
        tile.hash = (0..count).fold(0, |sum, i| sum.wrapping_add(tile.cell_hash(i)));
        tile
    }

    /// Creates a tile without cells, which takes the place of a removed tile.
    pub fn none() -> Self {
        Self {
            key: TileKey::default(),
            heights_m: Vec::new(),
            undug_m: Vec::new(),
            dug_colors: Vec::new(),
            classes: Vec::new(),
            revision: 0,
            soil_revision: 0,
            hash: 0,
        }
    }

    fn cell_hash(&self, cell: usize) -> u64 {
        let class = u64::from(self.class_number(cell));
        // -0 and 0 are the same height.
        let height = u64::from((self.heights_m[cell] + 0.0).to_bits());
        mixed(mixed(cell as u64) ^ (class << 32 | height))
    }

    /// Whether the tile has classes; without them no cell is a hole.
    pub fn says_classes(&self) -> bool {
        !self.classes.is_empty()
    }

    /// Class number of a cell, or [`HOLE`].
    pub fn class_number(&self, cell: usize) -> u8 {
        self.classes.get(cell).copied().unwrap_or(0)
    }

    /// Whether a cell has ground.
    pub fn has_ground(&self, cell: usize) -> bool {
        self.class_number(cell) != HOLE
    }

    /// Returns the material of a cell; unspecified for a hole.
    pub fn class(&self, cell: usize) -> SurfaceClass {
        let number = usize::from(self.class_number(cell));
        SurfaceClass::ALL.get(number).copied().unwrap_or_default()
    }

    /// Copies the values of a rectangle of cells that [`TerrainCells::check`] has accepted. A cell whose value is no
    /// height is a hole and keeps its earlier height. Returns whether any cell has changed.
    pub fn take(&mut self, cells: &TerrainCells<'_>, tile_cells: u32) -> bool {
        let before = self.hash;
        let size = cells.size_in(tile_cells);
        let lacks_data = cells.no_data_m.is_some() && cells.heights_m.values.iter().any(|h| cells.is_no_data(*h));
        if (!cells.classes.values.is_empty() || lacks_data) && self.classes.is_empty() {
            self.classes = vec![0; self.heights_m.len()];
        }
        for row in 0..size[1] {
            let first = (cells.first[1] + row) as usize * tile_cells as usize + cells.first[0] as usize;
            for cell in first..first + size[0] as usize {
                self.hash = self.hash.wrapping_sub(self.cell_hash(cell));
            }
            if !cells.classes.values.is_empty() {
                let classes = cells.classes.row(row, size[0]).1;
                let number = |c: &Option<SurfaceClass>| c.map_or(HOLE, |c| c as u8);
                self.classes[first..].iter_mut().zip(classes).for_each(|(to, c)| *to = number(c));
            }
            if !cells.heights_m.values.is_empty() {
                for (cell, height) in (first..).zip(cells.heights_m.row(row, size[0]).1) {
                    if cells.is_no_data(*height) {
                        self.classes[cell] = HOLE;
                    } else if is_height(*height) {
                        self.set_undug(cell, *height);
                    }
                }
            }
            for cell in first..first + size[0] as usize {
                self.hash = self.hash.wrapping_add(self.cell_hash(cell));
            }
        }
        self.hash != before
    }

    /// Height of a cell before anything was dug, m.
    pub fn undug_m(&self, cell: usize) -> f32 {
        self.undug_m.get(cell).copied().unwrap_or(self.heights_m[cell])
    }

    /// Sets the undug height of a cell. The height keeps the change by the soil, up to rounding: the soil then sets it
    /// exactly.
    fn set_undug(&mut self, cell: usize, height_m: f32) {
        let change_m = self.heights_m[cell] - self.undug_m(cell);
        self.heights_m[cell] = if change_m == 0.0 { height_m } else { height_m + change_m };
        if let Some(undug) = self.undug_m.get_mut(cell) {
            *undug = height_m;
        }
    }

    /// Soil that shows in a cell.
    pub fn dug_color(&self, cell: usize) -> DugColor {
        self.dug_colors.get(cell).copied().unwrap_or_default()
    }

    /// Sets the height of a cell, with the soil's change in it, and the colour of the soil that shows. Returns whether
    /// height or colour has changed.
    pub fn set_dug(&mut self, dug: &DugCell) -> bool {
        let &DugCell { cell, height_m, color } = dug;
        let (moves, is_tinted) = (self.heights_m[cell] != height_m, self.dug_color(cell) != color);
        if moves {
            if self.undug_m.is_empty() {
                self.undug_m = self.heights_m.clone();
            }
            self.hash = self.hash.wrapping_sub(self.cell_hash(cell));
            self.heights_m[cell] = height_m;
            self.hash = self.hash.wrapping_add(self.cell_hash(cell));
        }
        if is_tinted {
            if self.dug_colors.is_empty() {
                self.dug_colors = vec![DugColor::default(); self.heights_m.len()];
            }
            self.dug_colors[cell] = color;
        }
        moves || is_tinted
    }

    /// Whether soil has changed any cell.
    pub fn is_dug(&self) -> bool {
        !self.undug_m.is_empty() || !self.dug_colors.is_empty()
    }

    /// Undoes all changes by the soil.
    pub fn undo_dug(&mut self) {
        for cell in 0..self.undug_m.len() {
            self.set_dug(&DugCell { cell, height_m: self.undug_m[cell], color: DugColor::default() });
        }
        (self.undug_m, self.dug_colors, self.soil_revision) = (Vec::new(), Vec::new(), 0);
    }
}
