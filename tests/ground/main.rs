//! Water on the ground: as it is drawn onto a host's picture. One binary, so that it links once.

mod classes;
#[path = "../support/coarse_sky.rs"]
mod coarse_sky;
mod drawn;
mod hills;
mod host;
mod leaps;
mod lying_snow;
mod mirrors;
mod rings;
mod snow_in_wind;
mod snow_on_tiles;
mod state;
mod terrain;
mod texture;
#[path = "../support/textures.rs"]
mod textures;
mod tiles;
