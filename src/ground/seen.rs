//! State of the ground as a camera sees it, which a view draws from.

use super::{class::SurfaceClass, hollows::Hollows, window::DrawnTerrain};
use crate::{surroundings::SnowHere, weather::SurfaceCover};

/// State of the ground that a context holds, as a camera sees it.
pub(crate) struct GroundSeen<'a> {
    /// Cover that weather has left on the ground at the camera.
    pub cover: SurfaceCover,
    pub hollows: &'a Hollows,
    /// The host's terrain about the camera.
    pub terrain: Option<DrawnTerrain>,
    /// Whether there is water on it.
    pub has_wet_terrain: bool,
    /// Snow on level, open ground, and whether any lies on the terrain.
    pub snow: SnowHere,
    pub has_snowy_terrain: bool,
    /// Whether the terrain's cells have snow of their own.
    pub terrain_has_snow: bool,
    /// Class of ground for which the host gives none.
    pub surface_class: SurfaceClass,
}
