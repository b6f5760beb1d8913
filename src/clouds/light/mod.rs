//! Light: what it does in clouds and on its way through them, from sun, sky and ground, lamps and flashes.

pub mod halo;
pub mod lamp_light;
pub(crate) mod lamps;
pub(crate) mod layer_light;
#[cfg(test)]
mod mean_light;
pub(crate) mod media;
pub mod shadow;
pub(crate) mod sources;
pub mod transport;

pub use sources::{Depths, Scattered, Sources};
