//! The almanac: where sun and moon stand over a place at a time, how far, how bright, and how the sphere of the stars is turned.

pub mod celestial;
pub(crate) mod ephemeris;
pub mod moon;
pub mod sun;
