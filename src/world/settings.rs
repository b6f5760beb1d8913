//! Settings of a world that its host makes: lights, clock, planet, shelters, terrain, rain areas, clouds and wind.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::{
    almanac::{Utc, celestial::direction},
    error::{Result, check_range},
    moment::Region,
    planet::Planet,
    surroundings::{Shelter, TerrainHeights},
    terrain::Terrain,
    weather::CloudMap,
    wind::{WindGrid, WindVolume},
};

/// A direction to a light, given by the host in place of the almanac.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenDirection {
    /// Degrees clockwise from true north, [-360, 360].
    pub azimuth_deg: f64,
    /// Degrees above the horizon, without refraction, [-90, 90].
    pub elevation_deg: f64,
}

impl GivenDirection {
    pub(crate) fn validate(&self, name: &str) -> Result<()> {
        check_range(&format!("{name}.azimuth_deg"), self.azimuth_deg, -360.0, 360.0, "deg")?;
        check_range(&format!("{name}.elevation_deg"), self.elevation_deg, -90.0, 90.0, "deg")
    }

    pub(crate) fn unit(&self) -> DVec3 {
        direction(self.azimuth_deg, self.elevation_deg)
    }
}

/// The host's settings of the night sky that decide how much it lights the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NightSettings {
    /// Strength of the airglow, 1 near the sun's least activity.
    pub airglow: f64,
    /// From the equator and equinox of J2000.0 to (east, north, up), in place of the planet's own turning.
    pub celestial_to_world: Option<DMat3>,
}

impl Default for NightSettings {
    fn default() -> Self {
        Self { airglow: 1.0, celestial_to_world: None }
    }
}

/// Settings of the host that decide a step of what is simulated. Steps that an update leaves for another call are done
/// under the settings at the time of the update.
#[derive(Clone)]
pub(crate) struct Settings {
    pub shelters: Vec<Shelter>,
    /// The host's terrain; whatever holds it saves it.
    pub terrain: Option<Arc<TerrainHeights>>,
    /// The host's terrain in tiles, of which the host keeps the heights; never together with `terrain`.
    pub tiles: Option<Arc<Terrain>>,
    pub regions: Vec<Region>,
    /// Where over the ground layers of cloud stand.
    pub cloud_map: Option<Arc<CloudMap>>,
    /// The host's wind that varies in space.
    pub host_wind: Option<Arc<HostWind>>,
    pub given_sun: Option<GivenDirection>,
    pub given_moon: Option<GivenDirection>,
    /// Universal time at simulation time 0.
    pub utc_at_zero: Utc,
    /// A law of the host's stands in for the weather's low layer, which then takes no light.
    pub undimmed: bool,
    pub planet: Planet,
    /// Colours of light at the planet's wavelengths; fitted once, which takes some milliseconds.
    pub(super) color: [[f64; 3]; 3],
}

/// A wind that varies in space as the host gave it, and in the form that is read.
pub(crate) struct HostWind {
    pub grid: Arc<WindGrid>,
    pub volume: WindVolume,
}
