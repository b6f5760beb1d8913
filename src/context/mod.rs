//! A context: the weather, the time and the place that all views of a simulator share, and what effects hold for all of
//! them.
//!
//! It leads the world (`src/world`) and the list of effects (`src/effects.rs`) through time, saves and loads them, and
//! names no effect itself: what a host asks by their names is in the front room.

mod shared_world;
mod state;
mod update;
mod wind;

pub use crate::effects::ContextDesc;
pub use crate::moment::{GroundLight, Light, Scene};
pub use crate::world::GivenDirection;
pub use shared_world::{Context, LightAt};
pub(crate) use update::UPDATE_TIME;
