//! Water on the windscreen: the cells against their twin and the flux, and the lens over a picture. One binary.

pub mod cells;
mod host;
mod lens;
mod pictures;
mod shelter;
mod snow;
