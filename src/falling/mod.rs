//! What falls, as physics: how large drops, pellets and stones are at a rate, how fast they fall, what lands on a surface, and the
//! regions that have rain of their own.
//!
//! Rain, wet ground and the windscreen all count by these; none of it is drawn here.

pub mod area;
pub(crate) mod curtain;
pub mod drops;
pub mod ice;
pub mod sizes;

use crate::weather::{Falling, hydrometeors};

/// Most rain areas at a time, and so most rains that fall at one place.
pub const MAX_AREAS: usize = 16;

/// pcg3d (Jarzynski and Olano 2020), as `shaders/rain/hash.wgsl` has it.
pub fn random3(key: [u32; 3]) -> [u32; 3] {
    let [mut x, mut y, mut z] = key.map(|k| k.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    x = x.wrapping_add(y.wrapping_mul(z));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    [x, y, z] = [x, y, z].map(|v| v ^ (v >> 16));
    x = x.wrapping_add(y.wrapping_mul(z));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    [x, y, z]
}

/// Share of the extinction of all that falls that is rain's and drizzle's.
pub(crate) fn liquid_share(f: &Falling) -> f64 {
    let [steady, showers] =
        [hydrometeors::rain_extinction_per_m, hydrometeors::shower_extinction_per_m].map(|law| law(f.rain_mm_h));
    let liquid = steady + (showers - steady) * f.showers + hydrometeors::drizzle_extinction_per_m(f.drizzle_mm_h);
    let solid = hydrometeors::snow_extinction_per_m(f.snow_mm_h)
        + hydrometeors::ice_pellet_extinction_per_m(f.ice_pellets_mm_h)
        + hydrometeors::hail_extinction_per_m(f.hail_mm_h);
    if liquid > 0.0 { liquid / (liquid + solid) } else { 0.0 }
}
