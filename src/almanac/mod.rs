//! The almanac: universal time, where sun and moon stand over a place, how far, how bright, and how the sphere of the
//! stars is turned.

pub mod celestial;
pub(crate) mod ephemeris;
mod lunar_series;
pub mod moon;
pub mod sun;
pub(crate) mod time;

pub use time::Utc;
