//! Water on the ground: how wet it is, and how that looks.
//!
//! **Drawn** onto the host's picture from its depth ([`Stages::SURFACE`](crate::frame::Stages::SURFACE)): what is wet
//! is darker (Angstrom 1925; Lekner & Dorf 1988) and mirrors sky, sun and moon (Fresnel, n = 1.333) off a rough film;
//! standing water fills the hollows of a pattern that is fixed to the host's world, level and smooth but for the rings
//! of drops. Which way a surface faces comes from the host's image of normals, else from its terrain, else from the
//! depths round a pixel, whose error bounds the mirror: level ground gets all of it, walls less, undersides nothing.
//! What the ground is made of ([`SurfaceClass`]) comes from an image, else from the terrain's cells, else from the
//! context: film and puddles belong to what is paved. Costs one sky lookup a pixel and nothing where it is dry.
//!
//! Right for a host that hands over scene-linear luminance: the ground's albedo then follows from its luminance and the
//! light on it (a surface in shadow is taken for a darker one and darkens too much). In the display's spaces the shown
//! colour is taken for the albedo, darkened, and the mirrored light added through the tone curve. Mirrors see the sky
//! and level ground, no objects.
//!
//! No `passes.rs`: the composition draws the water, and `texture.rs` holds what it reads of the terrain. No
//! `candidates.rs`: it is drawn in one way, and no plan leaves it out.

mod basins;
mod class;
mod grid;
mod held;
mod held_texture;
mod held_tiles;
mod hollows;
mod host;
mod host_rain;
mod pools;
mod rain_on;
pub mod reference;
mod saved;
mod seen;
mod state;
pub(crate) mod terrain;
pub(crate) mod texture;
mod tiled;
mod uniform;
mod view;
pub mod water;
mod window;

pub use class::SurfaceClass;
pub use grid::{GroundGrid, MAX_GRID_NODES};
pub use held::GroundAt;
pub(crate) use held::{HeldGround, LoadedGround};
pub use hollows::Hollows;
pub use host::GroundCell;
pub use state::GroundModel;
pub use texture::{GroundTexture, SNIPPET_GLSL, SNIPPET_WGSL};
pub(crate) use uniform::GroundUniform;
pub(crate) use view::GroundView;
pub use water::GroundWater;
