//! Water on the ground: as it is drawn onto a host's picture. One binary, so that it links once.

mod classes;
mod drawn;
mod hills;
mod host;
mod leaps;
mod mirrors;
mod rings;
mod state;
mod terrain;
mod texture;
