//! Rain: sized by its rate, falling at the speeds that drops have, each drop where (seed, id, time) puts it.
//!
//! The model: [`drops`] has the physics of one drop in f64, [`sizes`] that of many, [`ice`] that of hail and pellets.
//! [`lattice`] has the places: a repeated cell of air full of drops that a camera sees the nearest copy of, with no
//! state and no update. One quad draws a drop's streak, as faint as the drop's disc is small against the way it falls
//! during the exposure, by a list of those that the picture shows where there are compute shaders; [`cones`] show what
//! falls farther off, [`contrast`] says what all of it is worth. Streaks make a layer of their own, which the
//! composition puts before the picture. What is too small or too far is the fog's extinction; under a rain area of its
//! own ([`RainArea`]) it is a column of rain, whose drops fall thinned by the area's rim near the camera and as a veil
//! beyond.
//!
//! No `reference.rs`: each file has the f64 side of its own shader. No `held.rs`: drops follow from seed
//! and time; those that are stepped ([`RainModel::Integrated`]) belong to a view and are not saved.

mod area_pass;
#[cfg(not(feature = "lab"))]
pub(crate) mod candidates;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod candidates;
mod classes;
mod cone_pass;
pub mod cones;
pub mod contrast;
mod crown_pass;
mod cull_pass;
mod ice_here;
pub mod integrated;
pub mod lattice;
pub mod light;
mod local;
mod open_pass;
mod passes;
mod presence;
mod query;
mod settings;
mod shaft;
mod shells;
pub mod splash;
mod stone_pass;
mod stones;
mod uniforms;
mod view;

pub use crate::falling::area::{AreaMotion, AreaRain, AreaShape, MAX_CORNERS, RainArea};
pub use crate::falling::{MAX_AREAS, drops, ice, sizes};
pub use crate::stage::RainReport;
pub use crate::surroundings::{
    MAX_OCCLUDER_MAPS, MAX_PLANES, MAX_SHELTERS, OccluderMap, Planes, Shelter, Taken, shelter,
};
pub use light::DropLight;
pub use query::{RainAt, RainOn, RainSurface};
pub(crate) use query::{rain_at, rain_on};
pub use settings::{RainModel, RainSettings};

pub use classes::Classes;
pub(crate) use contrast::Streaks;
pub(crate) use shaft::{AreaField, EyeInWorld};
pub use stones::Stones;
pub(crate) use view::RainView;
