//! What falls, as physics: how large drops, pellets and stones are at a rate, how fast they fall, and what lands on a surface.
//!
//! Rain, wet ground and the windscreen all count by these; none of it is drawn here.

pub mod drops;
pub mod ice;
pub mod sizes;

/// Most rain areas at a time, and so most rains that fall at one place.
pub const MAX_AREAS: usize = 16;
