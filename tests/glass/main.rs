//! Water on the windscreen: the cells against their twin and the flux, and what the lens makes of a picture. One
//! binary.

pub mod cells;
#[path = "../support/coarse_sky.rs"]
mod coarse_sky;
#[path = "../support/depth_texture.rs"]
mod depth_texture;
mod host;
mod lens;
mod pictures;
mod shelter;
mod snow;
#[path = "../support/textures.rs"]
mod textures;
