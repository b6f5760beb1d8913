//! Clouds: layers drawn as volumes that one can fly through, or the grey deck in their place.
//!
//! # Model
//! * [`field`] says where there is cloud. A map fixed to the moving air says how strongly cloud grows at each place,
//!   and solid noise frays the edges. [`cover`] finds the threshold at which the clouds of the map have the cover that
//!   is asked for.
//! * [`light`] computes the light in clouds, with the tables of [`transport`]. Light scattered once keeps the true
//!   phase function. Light scattered more than once is computed as if the place stood in a box of uniform cloud with
//!   the same optical depths up, down and to the sides. Ice cloud makes a [`halo`]. Two references check this light:
//!   [`mod@reference`] traces photons through boxes, [`traced`] through the field itself.
//! * A frame marches the ray of one pixel in sixteen by default ([`CloudSettings::square_side`]) and reprojects the
//!   other pixels from the previous frame.
//! * Mirrors and cube maps show clouds from `maps::panorama`, a small map of all directions.
//! * A host's map of cover and the cloud over rain areas are in `field::placed`, `field::layer_map` and `field::cells`.
//! * The light of lamps and lightning flashes in clouds follows [`lamp_light`]. It is drawn in a small picture of its
//!   own (`light::lamps`).
//! * [`shadow`] computes the light that clouds let through to a place. Pictures and a host's own materials read this
//!   light from a map (`maps::handed`).
//!
//! The deck is drawn with the sky (`shaders/between/sky.wgsl`).
//!
//! # Folders
//! Each folder uses only those named before it. [`field`] says where cloud is: shape, threshold, cells, cover maps and
//! `field::overhead`, the one query for the layers over a place. [`light`] says how bright cloud is. `drawn` marches
//! rays and holds the GPU resources of a picture. `maps` has the shadow map and the panorama. `view` and `passes`
//! combine them for a frame, `held` for a host's queries.
//!
//! # Error
//! Drawn light of uniform slabs: within 5 % or 0.01 of discrete ordinates, whichever is more. Drawn light that leaves
//! each face of a cube: within 15 % of that of photons, or within 0.03 of the light that falls on the cube, whichever
//! is more (`cargo test --lib clouds::drawn::probe -- --nocapture`). `lab photons` compares rays through the field with
//! photons; the error is largest under a low sun. Cover as seen from the ground: within 3 percentage points
//! ([`cover`]).

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
