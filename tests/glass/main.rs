//! Water on the windscreen: the cells against their twin and the flux, and what the lens makes of a picture. One binary.

mod cells;
#[path = "../depth_texture/mod.rs"]
mod depth_texture;
mod host;
mod lens;
mod pictures;
mod shelter;
