//! Frames as a host sees them: stages, targets, colour spaces, errors. One binary, so that it links once.

mod above;
#[path = "../support/coarse_sky.rs"]
mod coarse_sky;
#[path = "../support/depth_texture.rs"]
mod depth_texture;
mod diagnostic;
mod environment;
mod froxels;
mod host;
mod lookup;
mod measure;
mod moon;
mod night;
#[path = "../support/opaque.rs"]
mod opaque;
mod queries;
mod radiance;
mod refined;
mod refused;
#[path = "../support/seen_lux.rs"]
mod seen_lux;
mod spaces;
mod stability;
mod stages;
#[path = "../support/textures.rs"]
mod textures;
mod threads;
mod tiers;
mod unit;
mod variants;
