//! Places in a cell of air that repeats through all space: fractions of its side in 32 bits. Adding them wraps as the
//! cell does, so they are exact at any time and place.

use glam::DVec3;

/// `x` metres as a fraction of `side`, in 2^-32 of it; wraps.
pub fn fraction(x: f64, side: f64) -> u32 {
    let cells = x / side;
    // 2^32 itself would saturate.
    ((cells - cells.floor()) * 4_294_967_296.0) as u64 as u32
}

/// From `camera` to the copy of `place` nearest to it, m.
pub fn nearest(place: [u32; 3], camera: [u32; 3], side: f64) -> DVec3 {
    DVec3::from([0, 1, 2].map(|i| f64::from(place[i].wrapping_sub(camera[i]) as i32) / 4_294_967_296.0 * side))
}

/// The seed's 32 bits that places are made of.
pub fn short_seed(seed: u64) -> u32 {
    (seed ^ (seed >> 32)) as u32
}
