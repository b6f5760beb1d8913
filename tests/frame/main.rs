//! Frames as a host sees them: stages, targets, colour spaces, errors. One binary, so that it links once.

mod above;
mod banks;
mod diagnostic;
mod environment;
mod froxels;
mod measure;
mod moon;
mod night;
mod queries;
mod radiance;
mod refined;
mod refused;
mod spaces;
mod stability;
mod stages;
mod threads;
mod tiers;
mod unit;
mod variants;
