//! The host's terrain as data: heights and classes of surface on square cells, kept in tiles.
//!
//! A **lattice** of equal cells, level and aligned to true north at its origin, is cut into equal square **tiles**. A
//! tile has a key: how many tiles it lies east and north of the origin. One lattice for all tiles means that neighbours
//! share no row and need no stitching: the cell east of a tile's last column is the first column of the next tile, and
//! whatever goes over the ground (water, heights between cells) goes on there. Cells are counted from the origin in
//! whole numbers, so that a place far from it has the same rounding as one near it.
//!
//! A cell has a height and a class, or is a **hole**, where there is no ground. Tiles come, go, and change by
//! rectangles of cells. Each change costs what its own cells cost, whatever the size of tile and terrain: hashes are
//! sums over cells, so that a change takes the old cells off and adds the new ones. Terrain and tiles have a
//! **revision**, which grows with each change.
//!
//! Copies share their tiles; a tile that changes while somebody still has a copy of it is copied once. This room names
//! no effect: water, wind and queries read it alike. It has no settings and no error but rounding.

mod class;
mod desc;
#[cfg(test)]
mod tests;
mod tile;
mod tiles;

pub use class::SurfaceClass;
pub(crate) use class::{CLASSES, HOLE};
pub(crate) use desc::CellRect;
pub use desc::{MAX_TERRAIN_CELLS, Rows, TerrainCells, TerrainDesc, TileKey};
pub(crate) use tile::Tile;
pub use tiles::TerrainPoint;
pub(crate) use tiles::{AROUND, CellId, Terrain};
