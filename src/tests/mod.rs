//! Tests of several rooms together that check things hidden from hosts.

mod changing_air;
mod counted;
mod detour;
mod dug;
mod even;
mod land;
mod longest;
mod moment;
mod opaque;
mod planets;
mod prepared;
mod sea;
mod seascapes;
mod shadow;
pub mod textures;
