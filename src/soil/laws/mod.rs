//! Laws of soil in f64, each with its source: cutting force, standing walls, sinkage, heaps and swell,
//! water and frost.
//!
//! Lengths are in m, forces in N, densities in kg/m^3; cohesion, adhesion and pressure are in kPa, as in the tables of
//! the field. Angles are in radians.

mod force;
mod frost;
mod gravity;
mod heap;
mod moisture;
mod sinkage;
mod wall;

pub use force::{CuttingForce, CuttingInputs, cutting_force};
pub use frost::frost_depth_m;
pub use gravity::GRAVITY_M_S2;
pub use heap::{cone_radius_m, heap_volume_m3, load_factor, voids_share};
pub use moisture::{cohesion_share, saturation_after};
pub use sinkage::{ReeceSet, SinkageSet, WheelLoad};
pub use wall::{WallLaw, WallTable};
