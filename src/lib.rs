//! Welkin: weather for simulators, drawn into the host's own picture.
//!
//! This is the crate's front door. A Rust host creates a [`gpu::Device`], says what the weather is
//! ([`weather::Weather`]), and records into its own targets through [`frame`]. C and C++ hosts use the same
//! nouns and verbs through `include/welkin.h`, which [`capi`] implements as a thin shell.
#![deny(missing_docs, unsafe_op_in_unsafe_fn)]

// Tests of single rooms take helpers of `tests/support`, which name the crate as its users do.
#[cfg(test)]
extern crate self as welkin;

pub mod almanac;
pub mod bow;
pub mod candidates;
pub mod capi;
pub mod chance;
pub mod clouds;
pub mod context;
mod effects;
pub mod error;
mod falling;
pub mod flow;
pub mod fog;
pub mod frame;
mod front;
pub mod glass;
pub mod gpu;
pub mod ground;
pub mod light;
pub mod lightning;
mod moment;
pub mod noise;
pub mod plan;
pub mod planet;
pub mod rain;
pub mod scene;
pub mod sky;
pub mod snow;
mod stage;
pub mod stars;
mod surroundings;
pub mod terrain;
#[cfg(test)]
mod tests;
#[cfg(test)]
#[path = "../tests/support/textures.rs"]
mod textures;
pub mod weather;
pub mod wind;
mod world;

pub use error::{Error, Result, Status};
