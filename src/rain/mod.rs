//! Rain: sized by its rate, falling at the speeds that drops have, each drop where (seed, id, time) puts it.
//!
//! The model: [`drops`] has the physics of one drop in f64, [`sizes`] that of many. [`lattice`] has the places: a repeated cell of air full of drops that a camera
//! sees the nearest copy of, with no state and no update. One quad draws a drop's streak, as faint as the drop's disc is
//! small against the way it falls during the exposure; streaks make a layer of their own, which the composition puts before
//! the picture. What is too small or too far for a drop is the fog's extinction.

pub mod candidates;
mod cone_pass;
pub mod cones;
pub mod drops;
pub mod lattice;
mod passes;
pub mod probe;
mod settings;
pub mod shelter;
pub mod sizes;
pub mod source;
mod splash;
mod uniforms;

pub use settings::{RainModel, RainSettings};
pub use shelter::{MAX_SHELTERS, Shelter};

pub(crate) use cones::ConeUniform;
pub(crate) use passes::{Drawn, RainLayer};
pub(crate) use splash::Splashes;
pub use uniforms::Classes;
pub(crate) use uniforms::{Air, DropLight, RainUniform, Shot};
