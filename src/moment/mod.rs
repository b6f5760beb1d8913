//! State at a camera's place at a time: lights, air, clouds overhead, and the light on the ground.
//!
//! A context computes it ([`crate::context::Context::scene_at`]); every effect reads it.

mod around;
mod camera;
mod regions;
mod scene;

pub use around::LightAround;
pub(crate) use camera::{FlashLight, SceneMoment};
pub(crate) use regions::{Region, WeatherOver};
pub use scene::{GroundLight, Light, MAX_EXTINCTION_PER_M, Scene};
