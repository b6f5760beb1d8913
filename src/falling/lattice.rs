//! Positions in a cubic cell of air that repeats through all space, as 32-bit fractions of its side. Their addition
//! wraps around like the cell and does not round, so positions lose no accuracy at late times and far from the origin.

use glam::DVec3;

/// Returns the position `x`, m, as a fraction of `side`, m, in units of 2^-32; wraps around.
pub fn fraction(x: f64, side: f64) -> u32 {
    let cells = x / side;
    // Rounding may give 2^32 itself; a direct cast to `u32` would saturate it instead of wrapping.
    ((cells - cells.floor()) * 4_294_967_296.0) as u64 as u32
}

/// Returns the vector from `camera` to the nearest copy of `place`, m. Both are in 2^-32 of the side.
pub fn nearest(place: [u32; 3], camera: [u32; 3], side: f64) -> DVec3 {
    DVec3::from([0, 1, 2].map(|i| f64::from(place[i].wrapping_sub(camera[i]) as i32) / 4_294_967_296.0 * side))
}

/// Folds a seed to the 32 bits from which positions are made.
pub fn short_seed(seed: u64) -> u32 {
    (seed ^ (seed >> 32)) as u32
}
