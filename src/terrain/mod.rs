//! The host's terrain as data: heights and surface classes on square cells, kept in tiles.
//!
//! A **lattice** of equal square cells is level and aligned to true north at its origin. It is cut into equal square
//! **tiles**. The key of a tile says how many tiles east and north of the origin it lies. All tiles share one lattice,
//! so neighbouring tiles share no row of cells and need no stitching. East of a tile's easternmost cells lie the
//! westernmost cells of the next tile. Water and interpolated heights continue across the border. Cells are counted
//! from the origin in whole numbers, so rounding is the same near the origin and far from it.
//!
//! A cell has a height and a class, or it is a **hole**, where there is no ground. The host adds and removes tiles and
//! changes rectangles of cells. The cost of such a change depends only on the number of cells in the rectangle, not on
//! the size of tile and terrain: a hash is a sum over cells. A change subtracts the hashes of the old cells from the
//! sum and adds those of the new cells. Only with [`TerrainCells::no_data_m`] does a change read all cells of the tile.
//! The terrain and each tile have a **revision**, which grows with each change.
//!
//! Copies of a terrain share its tiles. A tile that changes while another copy of the terrain still uses it is copied
//! once. This room depends on no effect: water, wind and queries all read the terrain. It has no settings, and no error
//! but rounding.

mod changes;
mod class;
mod desc;
mod dug;
#[cfg(test)]
mod tests;
mod tile;
mod tiles;

pub(crate) use changes::RecentChanges;
pub use class::SurfaceClass;
pub(crate) use class::{CLASSES, HOLE};
pub(crate) use desc::CellRect;
pub use desc::{MAX_TERRAIN_CELLS, Rows, TerrainCells, TerrainDesc, TileKey};
pub(crate) use dug::{DugCell, DugColor};
pub(crate) use tile::Tile;
pub use tiles::TerrainPoint;
pub(crate) use tiles::{AROUND, CellId, Terrain};
