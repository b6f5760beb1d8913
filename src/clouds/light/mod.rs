//! Light: what it does in clouds and on its way through them, from sun, sky and ground, lamps and flashes.
//!
//! # Model
//! A place knows how much cloud lies about it: above and below, towards the sun and, level, to either side. As far as
//! light is concerned it stands in a box of these depths. Light that is scattered once keeps the true phase function.
//! Light scattered more often comes from the tables of [`transport`]: one for the beam that falls on the box's
//! top, one for what falls on the side that faces the sun, one each for sky and ground. Side to side, light goes as the
//! cosine whose leak the tables were made with, once it has turned: at the face that it falls on it is even. Top and
//! side share the beam. The rays of the sun come to a place through the nearer of the two, so with d the way to the top
//! less the way to the side the top has the share 1 / (1 + exp((1 - g') d)), the side the rest. A real cloud is no box:
//! where its way to the sun, s, is longer than the box's, m, the light falls as the square of (1 + (1 - g') m) / (1 +
//! (1 - g') s). What beam and first scatterings keep of their level momentum, exp(-(1 - g') s) - exp(-s), is added to
//! the first moment (van de Hulst 1980). Between sky and ground of the same light a cloud that absorbs nothing is as
//! bright as they are: what sky and ground light less than that, the sides let in.
//!
//! # Error
//! Fluxes through the faces of a cube of optical depth 16 (Henyey-Greenstein 0.85) stay within 0.03 of the incident
//! flux of a path tracer's: `cargo test --lib clouds::light::sources`.

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
