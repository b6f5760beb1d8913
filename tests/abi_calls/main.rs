//! Every function of the C interface with everything that can be wrong about its parameters: a status and a sentence
//! that names the parameter, nothing written, never a crash. On the backend that needs no GPU.
//!
//! `world` makes one live object of each kind; `handles` and `structs` hold one line a function and parameter, and fail
//! if a function of the header has none.

mod areas;
mod clock;
mod clouds;
mod flashes;
mod ground;
mod handles;
mod limits;
mod plan;
mod planets;
mod prepare;
mod queries;
mod shelters;
mod sky;
mod state;
mod structs;
mod terrain;
mod weather;
mod wind;
mod world;
