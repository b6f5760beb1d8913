//! Every function of the C interface with everything that can be wrong about its parameters: the call returns a status
//! and a sentence that names the parameter, writes nothing and never crashes. The tests run on the backend that needs
//! no GPU.
//!
//! `world` makes one live object of each kind; `handles` and `structs` have one line for each function and parameter,
//! and fail if a function of the header has no line.

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
mod regions;
mod sea;
mod shelters;
mod sky;
mod soil;
mod state;
mod structs;
mod terrain;
mod weather;
mod wind;
mod world;
