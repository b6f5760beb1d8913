//! The sky from below the ground's level to space.

pub mod planet;
mod planet_file;
pub mod spectral;

pub use planet::Planet;
