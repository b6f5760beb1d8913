//! Clouds: layers of a volume that one can fly through, or the grey deck in their place.
//!
//! # Model
//! * Where there is cloud, [`field`]: a map that says how strongly cloud grows, fixed to the air that carries it, and
//!   solid noise that frays its edges; [`cover`] finds how much of the map is cloud where a cover is asked for.
//! * What light does in it, [`light`] with the tables of [`transport`]: scattered once as it is, more often as in a box
//!   of the depths about a place. Ice makes a [`halo`]. [`mod@reference`] follows photons through boxes, [`traced`]
//!   through the field itself.
//! * What a picture shows of it: rays are marched at one pixel of sixteen a frame, the others are taken over from the
//!   frame before.
//! * What mirrors and cube maps show of it: `maps::panorama`, a small map of all directions.
//! * A host's map of where clouds stand, and cloud over rain areas: `field::placed`, `field::layer_map`,
//!   `field::cells`.
//! * What lamps and flashes make of it: [`lamp_light`], a small picture of its own (`light::lamps`).
//! * [`shadow`]: the light that it lets through to a place, and a map of that for pictures and for a host's own
//!   materials (`maps::handed`).
//!
//! The deck is drawn with the sky (`shaders/between/sky.wgsl`).
//!
//! # Folders
//! Each uses those before it. [`field`] says where cloud is: shape, threshold, cells and maps of cover, and
//! `field::overhead`, the one query of the layers over a place. [`light`] says how bright cloud is. `drawn` marches
//! rays and holds what a picture is drawn with. `maps` has the map of shadows and that of all directions. `view` and
//! `passes` put them together for a frame, `held` for a host's questions.
//!
//! # Error
//! Of the drawn light: even slabs within 5 % or 0.01 of discrete ordinates, each face of a cube within 15 % or 0.03 of
//! what falls on the cube (`cargo test --lib clouds::drawn::probe -- --nocapture`); along rays through the field,
//! against photons, what `lab photons` prints, most under a low sun. Of the cover that is seen: 3 points ([`cover`]).

#[cfg(not(feature = "lab"))]
pub(crate) mod candidates;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod candidates;
mod drawn;
pub mod field;
mod held;
pub mod light;
mod maps;
mod model;
mod passes;
pub mod reference;
pub mod settings;
mod view;

pub(crate) use drawn::march::CloudRays;
pub use drawn::{probe, traced};
pub(crate) use field::cells::over_place as cloud_over_areas;
pub use field::{cover, map};
pub(crate) use held::HeldClouds;
pub use light::{halo, lamp_light, shadow, transport};
pub use maps::handed::{CloudShadows, SHADOW_SNIPPET_GLSL, SHADOW_SNIPPET_WGSL};
pub use model::CloudModel;
pub use settings::CloudSettings;
pub(crate) use view::CloudsView;
