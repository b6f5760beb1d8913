//! The sky from below the ground's level to space.

pub mod moon;
pub mod planet;
mod planet_file;
pub mod spectral;
pub mod sun;

pub use planet::Planet;
