//! Field: where there is cloud. A map and solid noise, cut by the threshold that follows from a layer's cover, or from
//! the cover that a host's map or a rain area gives a part of it; and the layers over a place.

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
pub use shape::{About, NO_ANVIL, Shape, about, dome};
pub use solid::Solid;
