//! State of the ground around a camera, from which a view draws.

use super::{class::SurfaceClass, hollows::Hollows, window::DrawnTerrain};
use crate::{surroundings::SnowHere, weather::SurfaceCover};

/// State of a context's ground around a camera.
pub(crate) struct GroundSeen<'a> {
    /// Wetness, puddles, ice and snow of the ground at the camera.
    pub cover: SurfaceCover,
    /// Pattern of hollows in which water stands where heights are unknown.
    pub hollows: &'a Hollows,
    /// Terrain of the host around the camera.
    pub terrain: Option<DrawnTerrain>,
    /// Whether there is water on the terrain.
    pub has_wet_terrain: bool,
    /// Snow on level, open ground.
    pub snow: SnowHere,
    /// Whether any snow lies on the terrain.
    pub has_snowy_terrain: bool,
    /// Whether the terrain's cells have snow of their own, which is simulated; otherwise the snow of level, open ground
    /// lies on them.
    pub terrain_has_snow: bool,
    /// Surface class of ground for which the host gives none.
    pub surface_class: SurfaceClass,
}
