//! Cloud field: where there is cloud in a layer, and which layers are over a place. A threshold cuts the clouds out of
//! a map and solid noise. The threshold follows from the layer's cover, or from the cover that a host's map or a rain
//! area gives to places of the layer.
//!
//! # Model
//! A horizontal map says how strongly cloud grows at each place, as a number z with a normal distribution about 0. The
//! map is the sum of two sheets of noise, each made normal by its ranks. The periods of the sheets have no common
//! multiple, so that no repetition shows. There is cloud where z exceeds a threshold that follows from the cover
//! ([`cover`]). The excess e = z - threshold says how high the cloud grows there. Solid noise frays the cloud's edges.
//! The two sheets glide against each other, so that clouds form and dissolve without end, as a function of time alone.
//!
//! At a place with excess e and height h, from 0 at the base to 1 at the top, the extinction is k c. k is the layer's
//! extinction inside clouds, 1/m, and c = (e - dome(h) + rough (noise - 1/2)) / soft, clamped to 0 and 1. Here dome(h)
//! is the excess that cloud needs at height h, rough and soft are fields of [`Shape`], and noise is the solid noise,
//! scaled to about 0 to 1. In cumulus and in cellular sheets the dome also grows with e, so that no top is cut flat.
//!
//! Ice cloud is stretched along the wind that carries it, and leans with height: the head of a fibre lies downwind of
//! the crystals that have fallen from it. Cumulonimbus has an anvil, a sheet below the layer's top around its towers
//! (`anvil_needs` in `shape.rs`).

pub(crate) mod cells;
pub mod cover;
pub(crate) mod cover_threshold;
pub(crate) mod droplets;
pub(crate) mod extinction;
pub(crate) mod layer;
pub(crate) mod layer_map;
mod layer_shape;
pub(crate) mod layers;
pub mod map;
pub(crate) mod overhead;
pub(crate) mod placed;
pub(crate) mod shape;
pub(crate) mod solid;
pub(crate) mod thresholds;

pub use extinction::Field;
pub use map::{MAP_CELLS, MAP_REACH, MAP_SIZE, Map};
pub use shape::{CloudAround, NO_ANVIL, Shape, about, dome};
pub use solid::Solid;
