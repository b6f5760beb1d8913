//! Light in clouds and on its way through them, from sun, sky and ground, lamps and flashes.
//!
//! # Model
//! A place has the depth of cloud above and below it, towards the sun and, level, to either side. Its light is that in
//! a box with these depths. Light that is scattered once keeps the true phase function. Light scattered more often
//! comes from the tables of [`transport`]: one for the beam on the box's top, one for the beam on the side that faces
//! the sun, and one each for sky and ground. Across the box, from side to side, the light is even at the face that the
//! beam falls on. Once it has turned, it varies as the cosine whose leak the tables were made with.
//!
//! Top and side share the beam, because the sun's rays reach a place through the nearer of the two. With d the path to
//! the top less the path to the side, the top has the share 1 / (1 + exp((1 - g') d)), and the side has the rest. A
//! real cloud is no box: where its path to the sun, s, is longer than the box's, m, the light falls as the square of
//! (1 + (1 - g') m) / (1 + (1 - g') s). The level momentum that beam and first scatterings keep, exp(-(1 - g') s) -
//! exp(-s), is added to the first moment (van de Hulst 1980).
//!
//! A cloud that absorbs nothing, between sky and ground of equal radiance, has that radiance too. The light from sky
//! and ground alone is less, and the difference comes in through the sides.
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
