//! A host's settings of a world: lights, clock, planet, shelters, terrain, rain areas, clouds and wind.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::{
    almanac::{Utc, celestial::direction},
    error::{Result, check_range},
    moment::Region,
    planet::Planet,
    regions::HeldRegion,
    surroundings::{Shelter, TerrainHeights},
    terrain::Terrain,
    weather::CloudMap,
    wind::{WindGrid, WindVolume},
};

/// Direction to a light, given by the host in place of the almanac.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenDirection {
    /// Azimuth, degrees clockwise from true north, [-360, 360].
    pub azimuth_deg: f64,
    /// Elevation above the horizon, degrees, without refraction, [-90, 90].
    pub elevation_deg: f64,
}

impl GivenDirection {
    pub(crate) fn validate(&self, name: &str) -> Result<()> {
        check_range(&format!("{name}.azimuth_deg"), self.azimuth_deg, -360.0, 360.0, "deg")?;
        check_range(&format!("{name}.elevation_deg"), self.elevation_deg, -90.0, 90.0, "deg")
    }

    /// Returns the unit vector (east, north, up) of the direction.
    pub(crate) fn unit(&self) -> DVec3 {
        direction(self.azimuth_deg, self.elevation_deg)
    }
}

/// The host's settings of the night sky that affect its light on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NightSettings {
    /// Strength of the airglow; 1 near the minimum of the sun's activity.
    pub airglow: f64,
    /// Matrix of the rotation from the equator and equinox of J2000.0 to (east, north, up). `None` computes the matrix
    /// for the Earth.
    pub celestial_to_world: Option<DMat3>,
}

impl Default for NightSettings {
    fn default() -> Self {
        Self { airglow: 1.0, celestial_to_world: None }
    }
}

/// The host's settings that affect simulated steps. If an update leaves steps for a later call, these steps use the
/// settings that the host had set when that update was called.
#[derive(Clone)]
pub(crate) struct Settings {
    pub shelters: Vec<Shelter>,
    /// The host's terrain as one grid. It is saved with the effect that keeps the grid, not with these settings.
    pub terrain: Option<Arc<TerrainHeights>>,
    /// The host's terrain in tiles, whose heights the host keeps; never together with `terrain`.
    pub tiles: Option<Arc<Terrain>>,
    pub regions: Vec<Region>,
    /// Regions with a weather of their own.
    pub weather_regions: Vec<HeldRegion>,
    /// The host's map of local cloud cover.
    pub cloud_map: Option<Arc<CloudMap>>,
    /// The host's wind that varies in space.
    pub host_wind: Option<Arc<HostWind>>,
    /// Directions of sun and moon that the host gives in place of the almanac's.
    pub given_sun: Option<GivenDirection>,
    pub given_moon: Option<GivenDirection>,
    /// Universal time at simulation time 0.
    pub utc_at_zero: Utc,
    /// Whether the host's fog law replaces the weather's low layer. The weather's low layer then dims no light.
    pub undimmed: bool,
    pub planet: Planet,
    /// Colours of light at the planet's wavelengths. They are fitted whenever a planet is set, in some milliseconds.
    pub(super) color: [[f64; 3]; 3],
}

/// Wind that varies in space: the host's grid, and the form in which it is read.
pub(crate) struct HostWind {
    pub grid: Arc<WindGrid>,
    pub volume: WindVolume,
}
