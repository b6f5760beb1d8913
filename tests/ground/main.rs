//! Water on the ground, as it is drawn onto a host's picture. One binary, so that it links once.

mod classes;
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
mod tiles;
