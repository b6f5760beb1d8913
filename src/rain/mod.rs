//! Rain, hail and ice pellets near the camera, and rain areas seen from outside. The rain rate sets the drops' sizes
//! and fall speeds; the place of each drop is a function of (seed, id, time).
//!
//! *Drops*. [`drops`] has the physics of one drop in f64, [`sizes`] the size distribution, [`ice`] hail and pellets.
//! [`lattice`] has the places of drops: a cell of air full of drops that repeats in all directions. Each drop is drawn
//! at the copy nearest to the camera; no state is kept or updated. One quad draws a drop's streak. Its opacity is the
//! ratio of the area of the drop's disc to the area that the disc sweeps during the exposure. On devices with compute
//! shaders only the drops in the picture are drawn, by a list. The streaks go into a layer of their own, which the
//! composition puts in front of the picture.
//!
//! *Near and far*. [`cones`] show rain beyond the single drops. Drops that are too small or too far away for both are
//! extinction, drawn with the fog. A rain area ([`RainArea`]) is a column of rain. Near the camera the number of its
//! drops decreases over the area's rim. Farther away the column is drawn as one integral along the ray of each pixel.
//! [`contrast`] estimates how much all of this changes a picture.
//!
//! There is no `reference.rs`: each file has the f64 side of its own shader. There is no `held.rs`: drops follow from
//! seed and time. Stepped drops ([`RainModel::Integrated`]) belong to a view and are not saved.

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
