//! The almanac: universal time, the positions, distances and brightness of sun and moon over a place, and the
//! orientation of the celestial sphere.

pub mod celestial;
pub(crate) mod ephemeris;
mod lunar_series;
pub mod moon;
pub mod sun;
pub(crate) mod time;

pub use time::Utc;
