//! Ground: how wet it is, and how the water on it looks.
//!
//! **Drawing**. The surface pass ([`Stages::SURFACE`](crate::frame::Stages::SURFACE)) draws the water onto the host's
//! picture, pixel by pixel from the host's depth. Wet ground is darker (Angstrom 1925; Lekner & Dorf 1988), and its
//! rough film mirrors sky, sun, moon and the host's lamps (Fresnel, n = 1.333). Standing water fills the hollows of the
//! host's terrain. Where heights are unknown, it fills those of a pattern that is fixed to the host's world. The
//! surface of standing water is level; wind and the rings of drops roughen it a little.
//!
//! **Surface normals** come from the host's image of normals, else from its terrain, else from the depths around a
//! pixel. The error of a normal from depths limits how strongly a surface mirrors. Level ground catches all rain, walls
//! less, undersides none.
//!
//! **Surface classes** ([`SurfaceClass`]: what the ground is made of) come from an image, else from the terrain's
//! cells, else from the context. Only paved ground has a closed film everywhere, and puddles where heights are unknown.
//! The cost is one sky lookup a pixel, and nothing where the ground is dry.
//!
//! **Accuracy**. The result is right for a host that hands over scene-linear luminance: the albedo of the ground then
//! follows from its luminance and the light on it. A surface in shadow is taken for a dark surface in the light, and
//! darkens too much. In display spaces the shown colour is taken for the albedo and darkened, and the mirrored light is
//! added through the tone curve. Reflections show the sky and level ground, but no objects.
//!
//! **Files**. There is no `passes.rs`: the composition draws the water, and `texture.rs` holds the terrain data that it
//! reads. There is no `candidates.rs`: only one way to draw the water exists, and no plan leaves the water out.

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
