//! Surroundings that all effects share: the host's boxes and occluder maps, which keep rain off, its lamps and terrain,
//! the lying snow, and the wind that varies in space.

mod around;
mod occluder;
mod occluder_maps;
pub mod shelter;
mod snow;
mod terrain;
mod wind;

pub use occluder::{MAX_OCCLUDER_MAPS, OccluderMap, Taken};
pub use shelter::{MAX_PLANES, MAX_SHELTERS, Planes, Shelter};

pub(crate) use around::{HostSurroundings, ShelterReach, SurroundingsBlock, layout};
pub(crate) use occluder_maps::OccluderMaps;
pub(crate) use shelter::met_at;
pub(crate) use snow::{LyingSnow, Meltwater, SnowHere};
pub(crate) use terrain::TerrainHeights;
pub(crate) use wind::{WindMap, WindTexture, WindView};
