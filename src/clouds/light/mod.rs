//! Light in clouds and on its way through them, from sun, sky and ground, lamps and flashes.
//!
//! # Model
//! A place has the depth of cloud above and below it, towards the sun and, horizontally, to either side. Its light is
//! that of a place in a box with these depths. Light scattered once keeps the true phase function. Light scattered more
//! often comes from the tables of [`transport`]: one for the beam on the box's top, one for the beam on the side that
//! faces the sun, and one each for sky and ground. Near the face that the beam falls on, this light is the same from
//! side to side. Deeper in the box it varies from side to side as a cosine, the one from which [`transport`] computes
//! the leak.
//!
//! Top and side share the beam, because the sun's rays reach a place through the nearer of the two. With d the path to
//! the top less the path to the side, the top has the share 1 / (1 + exp((1 - g') d)), and the side has the rest. A
//! real cloud is no box. If its path to the sun, s, is longer than the box's, m, the light is multiplied by the
//! square of (1 + (1 - g') m) / (1 + (1 - g') s). The beam and the light of its first scatterings keep the momentum
//! exp(-(1 - g') s) - exp(-s) (van de Hulst 1980). The component of this momentum along the axis of a table is in the
//! table already. The component across the axis is added to the first moment.
//!
//! A cloud that absorbs nothing, between sky and ground of equal radiance, has that radiance too. The tables give less,
//! because some of the light leaks through the sides. The same amount comes in through the sides. The difference is
//! added, half to the sky's light and half to the ground's.
//!
//! # Error
//! Fluxes through the faces of a cube of optical depth 16 (Henyey-Greenstein 0.85) stay within 0.03 of the incident
//! flux from a path tracer's: `cargo test --lib clouds::light::sources`.

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
