//! Tests of several rooms together that look at what no host can see.

mod changing_air;
mod counted;
mod detour;
mod even;
mod longest;
mod moment;
mod opaque;
mod prepared;
pub mod textures;
