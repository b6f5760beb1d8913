//! Terrain that Welkin draws: the tiles of a context in the host's colour and depth.
//!
//! **Ground**. Each square of four neighbouring cells is split along the diagonal from its south-western to its
//! north-eastern cell into two triangles. A triangle belongs to the ground if none of its three cells is a hole.
//! Pictures and queries of heights use the same triangles.
//!
//! **Levels of detail**. A quadtree of nodes with 16 x 16 squares, whose sides double from level to level, covers the
//! lattice. Level n has every 2^n-th cell, with the cell's own height. It is used up to the distance d / (e a), or up
//! to the distance at which its squares are 10 pixels wide if this is farther. Here e is the error that the host
//! accepts, pixels, and a the angle of a pixel. d is the vertical error of level n + 1: at 99.7 % of random cells of
//! the terrain, the error of that level is no larger. The distance is at least 40 and at most 160 sides of the squares.
//! Over the last stretch of this distance each odd vertex moves onto its even neighbour (Strugar 2010, Continuous
//! Distance-Dependent Level of Detail), so the mesh of a level becomes that of the next coarser one before the two
//! meet. There are no cracks, no skirts and no jumps.
//!
//! **Pages**. A page holds a node's data on the GPU: the heights of its 17 x 17 vertices, and slopes and classes in up
//! to 66 x 66 texels. The most recently used pages are kept. A change of the terrain writes the texels of all pages
//! that depend on it, in the frame that follows; the cost grows with the changed rectangle.
//!
//! **Materials** (`materials.rs`) follow from class, slope and altitude, varied by filtered noise. Dug soil covers the
//! materials with the colour stored in the tiles, and with clods.
//!
//! **Light** is that of sun, moon and sky at the ground below the camera, for the ground's own slope. Hills and pits
//! have shadows (`shadow/`). The composition adds to the terrain what it adds to the host's own surfaces: water, lying
//! snow, shadows of clouds, air and fog.
//!
//! **Precision**. Places are f64 until they are relative to the eye. Lattice positions reach the GPU as whole numbers
//! of cells from the cell below the eye.
//!
//! **Files**. There is no `candidates.rs`: the plan never leaves terrain out.

mod cells;
mod eye;
mod held;
mod light;
mod materials;
mod page;
mod pages;
mod passes;
mod patch;
#[cfg(test)]
pub(crate) mod reference;
mod relief;
mod selection;
mod settings;
mod shadow;
#[cfg(test)]
mod tests;
mod uniforms;
mod view;

pub(crate) use held::HeldLand;
pub use settings::TerrainDrawing;
pub(crate) use view::LandView;
