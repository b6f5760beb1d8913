//! A context: the weather, the time and the place that all views of a simulator share, and the state of effects that is
//! common to them.
//!
//! A context advances the world (`src/world`) and the list of effects (`src/effects.rs`) through time, and saves and
//! loads them. This room names no single effect: the queries and settings of single effects are in `src/front`.

mod rehearsal;
mod shared_world;
mod state;
mod update;
mod wind;

pub use crate::effects::ContextDesc;
pub use crate::moment::{GroundLight, Light, Scene};
pub use crate::world::GivenDirection;
pub(crate) use rehearsal::Rehearsal;
pub use shared_world::{Context, LightAt};
pub(crate) use update::UPDATE_TIME;
