//! Field: where there is cloud. A map and solid noise, cut by the threshold that follows from a layer's cover, or from
//! the cover that a host's map or a rain area gives a part of it; and the layers over a place.
//!
//! # Model
//! A map over the plane says how strongly cloud grows at a place, as a number z that is spread normally about 0: two
//! sheets of noise, each made normal by ranks, whose periods have no common multiple, so that no tile shows. Cloud is
//! where z exceeds a threshold that follows from the cover ([`cover`]); how far it exceeds it says how high the
//! cloud grows there. Solid noise frays its edges. The two sheets glide against each other, which makes clouds form and
//! dissolve, without end and as a function of time alone.
//!
//! Of a place with the excess e = z - threshold and the height h, 0 at the base to 1 at the top, the extinction is that
//! of the layer times (e - dome(h) + rough (noise - 1/2)) / soft, held between 0 and 1. Over heaps the dome grows with
//! e, so that no top is cut flat.
//!
//! Ice is drawn out along the wind that carries it, and leans with height: heads stand downwind of what falls from
//! them. Cumulonimbus has an anvil, a sheet below the layer's top about its towers (`anvil_needs`).

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
