//! Description of a host's terrain and of its cells, and the checks of both.

use std::cmp::Ordering;

use glam::DVec3;

use super::SurfaceClass;
use crate::error::{Error, Result, check_range};

/// Largest number of cells in all tiles of a terrain together.
pub const MAX_TERRAIN_CELLS: usize = 4096 * 4096;
/// Smallest and largest tile, cells along a side.
const TILE_CELLS: [u32; 2] = [32, 1024];
/// Largest distance of a tile from the origin, tiles.
const FARTHEST: i32 = 1_000_000;
/// Largest height above or below the origin, m.
const MOST_M: f32 = 1e5;

/// Lattice of a terrain, level and aligned to true north at its origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TerrainDesc {
    /// Position of the south-western cell of tile (0, 0) in the host's world, m, within 1e12 of the world's origin.
    /// Default 0. All heights are relative to the height of this position.
    pub origin: DVec3,
    /// Distance between neighbouring cells, m, \[0.01, 10 000\]. Default 1.
    pub cell_m: f64,
    /// Number of cells along each side of a tile: a power of two from 32 to 1024. Default 256.
    pub tile_cells: u32,
}

impl Default for TerrainDesc {
    fn default() -> Self {
        Self { origin: DVec3::ZERO, cell_m: 1.0, tile_cells: 256 }
    }
}

impl TerrainDesc {
    /// Checks that every field is within its range.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        if !(self.origin.is_finite() && self.origin.length() <= 1e12) {
            return Err(Error::range("terrain.origin_m", "finite and within 1e12 m", self.origin));
        }
        check_range("terrain.cell_m", self.cell_m, 0.01, 1e4, "m")?;
        let [least, most] = TILE_CELLS;
        if !((least..=most).contains(&self.tile_cells) && self.tile_cells.is_power_of_two()) {
            let wanted = format!("a power of two from {least} to {most}");
            return Err(Error::range("terrain.tile_cells", &wanted, self.tile_cells));
        }
        Ok(())
    }

    /// Largest number of tiles of this size that a terrain may have.
    pub fn most_tiles(&self) -> usize {
        MAX_TERRAIN_CELLS / (self.tile_cells as usize * self.tile_cells as usize)
    }
}

/// Key of a tile in the lattice: the numbers of tiles by which it lies east and north of the origin, each within 1e6.
/// Keys are ordered by rows from the south.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct TileKey {
    /// Number of tiles to the east; negative to the west.
    pub east: i32,
    /// Number of tiles to the north; negative to the south.
    pub north: i32,
}

impl TileKey {
    /// Creates the key of the tile `east` tiles east and `north` tiles north of the origin.
    pub fn new(east: i32, north: i32) -> Self {
        Self { east, north }
    }

    /// Checks that the tile is not too far from the origin.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming `param`.
    pub(crate) fn validate(self, param: &str) -> Result<()> {
        for (i, v) in [self.east, self.north].into_iter().enumerate() {
            let far = f64::from(FARTHEST);
            check_range(&format!("{param}[{i}]"), f64::from(v), -far, far, "")?;
        }
        Ok(())
    }
}

impl Ord for TileKey {
    fn cmp(&self, other: &Self) -> Ordering {
        (self.north, self.east).cmp(&(other.north, other.east))
    }
}

impl PartialOrd for TileKey {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Values for a rectangle of cells, in rows from south to north. Each row runs from west to east.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rows<'a, T> {
    /// Values, row after row.
    pub values: &'a [T],
    /// Number of values from the start of a row to the start of the next. 0 means that rows follow each other without a
    /// gap.
    pub stride: u32,
}

impl<T> Default for Rows<'_, T> {
    fn default() -> Self {
        Self { values: &[], stride: 0 }
    }
}

impl<'a, T: Copy> Rows<'a, T> {
    /// Creates rows without a gap.
    pub fn of(values: &'a [T]) -> Self {
        Self { values, stride: 0 }
    }

    fn stride(&self, width: u32) -> usize {
        if self.stride == 0 { width as usize } else { self.stride as usize }
    }

    /// Returns one row of the rectangle, and the index of its first value in `values`.
    pub(crate) fn row(&self, row: u32, width: u32) -> (usize, &'a [T]) {
        let first = row as usize * self.stride(width);
        (first, &self.values[first..first + width as usize])
    }

    fn check(&self, name: &str, size: [u32; 2]) -> Result<()> {
        if self.stride != 0 && self.stride < size[0] {
            let wanted = format!("0, or at least {}, the width of the rectangle", size[0]);
            return Err(Error::range(&format!("terrain_cells.{name}_stride"), &wanted, self.stride));
        }
        let needed = (size[1] as usize - 1) * self.stride(size[0]) + size[0] as usize;
        if self.values.len() < needed {
            let wanted = format!("at least {needed} for a rectangle of {} x {}", size[0], size[1]);
            return Err(Error::range(&format!("terrain_cells.{name}.len"), &wanted, self.values.len()));
        }
        Ok(())
    }
}

/// Heights and classes of a rectangle of cells of one tile.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct TerrainCells<'a> {
    /// Key of the tile.
    pub key: TileKey,
    /// South-western cell of the rectangle, counted east and north within the tile.
    pub first: [u32; 2],
    /// Number of cells of the rectangle east and north; (0, 0) means the whole tile.
    pub size: [u32; 2],
    /// Heights above the terrain's origin, m, within 1e5. If empty in an update, the heights stay. A new tile needs
    /// heights. A hole may have any value.
    pub heights_m: Rows<'a, f32>,
    /// Materials of the cells, `None` for a hole. If empty in an update, the materials stay. If empty in a new tile,
    /// all are unspecified.
    pub classes: Rows<'a, Option<SurfaceClass>>,
    /// Value among the heights that marks cells without data, such as -9999, -32768, or the value in the host's source.
    /// These cells become holes, and so do cells whose height is NaN. The value must be finite, and it must not be a
    /// height in use: neither in a cell to which `classes` gives a class other than unspecified, nor in a cell with
    /// ground in the same tile outside the rectangle. Default `None`: every number is a height.
    pub no_data_m: Option<f32>,
}

impl TerrainCells<'_> {
    /// Size of the rectangle in cells; a tile has `tile_cells` along a side.
    pub(crate) fn size_in(&self, tile_cells: u32) -> [u32; 2] {
        if self.size == [0, 0] { [tile_cells; 2] } else { self.size }
    }

    /// Whether a height means no data.
    pub(crate) fn is_no_data(&self, height_m: f32) -> bool {
        self.no_data_m.is_some_and(|none| height_m == none || height_m.is_nan())
    }

    /// Checks that the values fit the tile. `is_hole` returns whether a cell of the tile is a hole before the change.
    pub(crate) fn check(&self, tile_cells: u32, is_hole: impl Fn(usize) -> bool) -> Result<()> {
        self.key.validate("terrain_cells.tile")?;
        let size = self.size_in(tile_cells);
        for i in [0, 1] {
            let fits = size[i] >= 1 && u64::from(self.first[i]) + u64::from(size[i]) <= u64::from(tile_cells);
            if !fits {
                let wanted = format!("at least one cell, and within the tile's {tile_cells} with first_cell[{i}]");
                let got = format!("{} from {}", size[i], self.first[i]);
                return Err(Error::range(&format!("terrain_cells.cells[{i}]"), &wanted, got));
            }
        }
        if !self.heights_m.values.is_empty() {
            self.heights_m.check("heights_m", size)?;
        }
        if !self.classes.values.is_empty() {
            self.classes.check("surface_classes", size)?;
        }
        match self.no_data_m.filter(|none| !none.is_finite()) {
            Some(none) => {
                Err(Error::range("terrain_cells.no_data_m", "finite; NaN among the heights is no data then too", none))
            }
            None => self.check_heights(tile_cells, is_hole),
        }
    }

    fn check_heights(&self, tile_cells: u32, is_hole: impl Fn(usize) -> bool) -> Result<()> {
        let size = self.size_in(tile_cells);
        if self.heights_m.values.is_empty() {
            return Ok(());
        }
        for row in 0..size[1] {
            let (first, heights) = self.heights_m.row(row, size[0]);
            let said = (!self.classes.values.is_empty()).then(|| self.classes.row(row, size[0]).1);
            let first_cell = (self.first[1] + row) as usize * tile_cells as usize + self.first[0] as usize;
            for (i, height) in heights.iter().enumerate() {
                let name = |list: &str| format!("terrain_cells.{list}[{}]", first + i);
                if self.is_no_data(*height) {
                    // A cell with a class has ground, so it must have a height.
                    if said.is_some_and(|said| said[i].is_some_and(|class| class != SurfaceClass::Unspecified)) {
                        let accepted =
                            format!("no height in use, such as {} with a class of ground", name("heights_m"));
                        return Err(Error::range("terrain_cells.no_data_m", &accepted, height));
                    }
                    continue;
                }
                let is_hole = said.map_or_else(|| is_hole(first_cell + i), |said| said[i].is_none());
                if !is_hole && !is_height(*height) {
                    return Err(Error::range(&name("heights_m"), &format!("finite and within {MOST_M} m"), height));
                }
            }
        }
        Ok(())
    }
}

/// Whether `v` can be a height, m.
pub(super) fn is_height(v: f32) -> bool {
    v.abs() <= MOST_M
}

/// Rectangle of cells, counted from the terrain's origin: from `low` up to, but not including, `high`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CellRect {
    pub low: [i32; 2],
    pub high: [i32; 2],
}

impl CellRect {
    /// Returns the rectangle with `cells` more cells on each side.
    pub fn grown(self, cells: i32) -> Self {
        Self { low: self.low.map(|v| v - cells), high: self.high.map(|v| v + cells) }
    }

    /// Returns the smallest rectangle that holds both rectangles.
    pub fn with(self, other: Self) -> Self {
        Self {
            low: [0, 1].map(|i| self.low[i].min(other.low[i])),
            high: [0, 1].map(|i| self.high[i].max(other.high[i])),
        }
    }

    /// Returns the cells that two rectangles have in common, if there are any.
    pub fn meets(self, other: Self) -> Option<Self> {
        let low = [0, 1].map(|i| self.low[i].max(other.low[i]));
        let high = [0, 1].map(|i| self.high[i].min(other.high[i]));
        (low[0] < high[0] && low[1] < high[1]).then_some(Self { low, high })
    }

    /// All cells of the rectangle, by rows.
    pub fn cells(self) -> impl Iterator<Item = [i32; 2]> {
        (self.low[1]..self.high[1]).flat_map(move |y| (self.low[0]..self.high[0]).map(move |x| [x, y]))
    }
}
