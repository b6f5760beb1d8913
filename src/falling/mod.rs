//! Physics of precipitation: the sizes of drops, flakes, pellets and hailstones at a given rate, their fall speeds,
//! their flux onto surfaces, and the areas that have rain of their own.
//!
//! Rain, wet ground and the windscreen all use this physics. Nothing is drawn here.

pub mod area;
pub(crate) mod curtain;
pub mod drag;
pub mod drops;
pub mod flakes;
pub mod ice;
pub mod lattice;
pub mod sizes;

use crate::weather::{Conditions, ONSET_M};

/// Largest number of rain areas at a time.
pub const MAX_AREAS: usize = 16;

/// Returns three random words for a key: the hash pcg3d (Jarzynski and Olano 2020). `random3` of
/// `shaders/common/hash.wgsl` returns the same words.
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

/// Extinction of the precipitation outside all rain areas, by species. It is the same everywhere below the cloud that
/// the precipitation falls from. Inside the cloud the extinction is left out, because the cloud's own water hides it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallingLayer {
    /// Extinction of rain and drizzle, at 550 nm, 1/m.
    pub liquid_per_m: f64,
    /// Extinction of snow, ice pellets and hail, at 550 nm, 1/m.
    pub solid_per_m: f64,
    /// Altitude above which no falling precipitation is visible, m.
    pub top_m: f64,
    /// Depth below `top_m` over which the extinction rises linearly from 0 to its full value, m.
    pub soft_m: f64,
}

impl FallingLayer {
    /// Layer without precipitation.
    pub const NONE: Self = Self { liquid_per_m: 0.0, solid_per_m: 0.0, top_m: 0.0, soft_m: ONSET_M };

    /// Creates the layer for the precipitation of a weather.
    pub(crate) fn new(c: &Conditions) -> Self {
        Self {
            liquid_per_m: c.precipitation.liquid_extinction_per_m,
            solid_per_m: c.precipitation.solid_extinction_per_m,
            top_m: c.falling_base_m() + 0.5 * ONSET_M,
            soft_m: ONSET_M,
        }
    }

    /// Returns the extinction of liquid and solid precipitation together, 1/m.
    pub fn extinction_per_m(&self) -> f64 {
        self.liquid_per_m + self.solid_per_m
    }
}
