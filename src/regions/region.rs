//! A weather region as a host sets it, and as a world holds it: its place, its motion and its weight at a point.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::shape::RegionShape;
use crate::{
    error::{Error, Result, check_range},
    numerics::smooth,
    scene::WorldFrame,
    weather::{Conditions, Overrides, Weather, WeatherParts, derive_with},
};

/// Largest number of weather regions at a time.
pub const MAX_WEATHER_REGIONS: usize = 64;
/// Largest width of a perimeter, m.
const MOST_PERIMETER_M: f64 = 1e6;
/// Largest velocity of a region along each axis, m/s.
const MOST_SPEED_M_S: f64 = 400.0;
/// Largest vertical wind, m/s.
const MOST_VERTICAL_M_S: f64 = 50.0;
/// Distance from a region's perimeter beyond which a point is taken as outside, m. Otherwise points on the far side of
/// the planet would lie inside the region again, because the plan is flat.
pub(super) const FARTHEST_M: f64 = 3e5;

/// Shape, place, motion and strength of a region.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RegionPlan {
    /// Shape around the centre. Default: a circle with a radius of 2000 m.
    pub shape: RegionShape,
    /// Position of the centre in the host's world at the time `at_s`, m, within 1e12 of the origin. The height of the
    /// position does not matter. Default: the origin.
    pub center_m: [f64; 3],
    /// Heading of the axis along which the shape's second extent is measured: degrees clockwise from true north,
    /// \[-360, 360\]. Default 0.
    pub heading_deg: f64,
    /// Width of the band outside the shape over which the region's weather fades, m, \[0, 1e6\]; 0 is a step at the
    /// border. Default 500.
    pub perimeter_m: f64,
    /// Velocity of the region towards east and north, m/s, each within \[-400, 400\]. Default 0: the wind does not move
    /// a region.
    pub velocity_m_s: [f64; 2],
    /// Simulation time at which the centre is at `center_m`, s, \[-1e10, 1e10\]. Default 0.
    pub at_s: f64,
    /// Factor on the region's weight, \[0, 1\], default 1. A host fades a region in and out with it.
    pub strength: f64,
}

/// Region with a weather of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct WeatherRegion {
    /// Place and motion.
    pub plan: RegionPlan,
    /// Parts of `weather` that the region has. Default none.
    pub has: WeatherParts,
    /// Parts that are averaged with the same parts of earlier regions that merge them too. The region's other parts
    /// cover those of earlier regions. Default none.
    pub merges: WeatherParts,
    /// Weather inside. Its `station_altitude_m` is ignored: heights are measured from the station of the world's
    /// weather.
    pub weather: Weather,
    /// Values of the host that replace derived ones inside the region.
    pub overrides: Overrides,
    /// Upward velocity of the wind above 100 m, m/s, \[-50, 50\]. Below 100 m it decreases linearly to 0 at the ground.
    /// A part of [`WeatherParts::WIND`]. Default 0.
    pub vertical_wind_m_s: f64,
}

impl Default for RegionPlan {
    fn default() -> Self {
        Self {
            shape: RegionShape::Ellipse { half_m: [2000.0; 2] },
            center_m: [0.0; 3],
            heading_deg: 0.0,
            perimeter_m: 500.0,
            velocity_m_s: [0.0; 2],
            at_s: 0.0,
            strength: 1.0,
        }
    }
}

impl Default for WeatherRegion {
    fn default() -> Self {
        Self {
            plan: RegionPlan::default(),
            has: WeatherParts::NONE,
            merges: WeatherParts::NONE,
            weather: Weather::default(),
            overrides: Overrides::default(),
            vertical_wind_m_s: 0.0,
        }
    }
}

impl RegionPlan {
    /// Checks that every field but `at_s` is within its range. The context checks `at_s`.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        let center = DVec3::from(self.center_m);
        if !(center.is_finite() && center.length() <= 1e12) {
            return Err(Error::range("weather_region.center_m", "finite and within 1e12 m", center));
        }
        self.shape.validate()?;
        check_range("weather_region.heading_deg", self.heading_deg, -360.0, 360.0, "deg")?;
        check_range("weather_region.perimeter_m", self.perimeter_m, 0.0, MOST_PERIMETER_M, "m")?;
        for v in self.velocity_m_s {
            check_range("weather_region.velocity_m_s", v, -MOST_SPEED_M_S, MOST_SPEED_M_S, "m/s")?;
        }
        check_range("weather_region.strength", self.strength, 0.0, 1.0, "")
    }

    /// Returns the distance from the centre beyond which the region cannot act, m.
    pub(super) fn reach_m(&self) -> f64 {
        1.1 * (self.shape.radius_m() + self.perimeter_m) + FARTHEST_M
    }

    /// Returns the plan's axes at a time.
    pub(super) fn at(&self, world: &WorldFrame, time_s: f64) -> PlanAxes {
        let start = DVec3::from(self.center_m);
        let moved = DVec2::from(self.velocity_m_s) * (time_s - self.at_s);
        let center = start + world.frame_at(start).world_to_enu.transpose() * moved.extend(0.0);
        let local = world.frame_at(center);
        let (sin, cos) = libm::sincos(self.heading_deg.to_radians());
        let to_world = local.world_to_enu.transpose();
        PlanAxes {
            center,
            altitude_m: local.place.altitude_m,
            right: to_world * DVec3::new(cos, -sin, 0.0),
            ahead: to_world * DVec3::new(sin, cos, 0.0),
        }
    }

    /// Returns the weight of the region at `distance_m` from its border. The distance is negative inside.
    pub(super) fn weight(&self, distance_m: f64) -> f64 {
        let outward = if distance_m <= 0.0 {
            0.0
        } else if distance_m < self.perimeter_m {
            smooth(distance_m / self.perimeter_m)
        } else {
            1.0
        };
        self.strength * (1.0 - outward)
    }

    /// Returns the distance of a point of the plan from the border, m, negative inside. Beyond the perimeter it may be
    /// less than the true distance, but not less than the perimeter.
    pub(super) fn distance_m(&self, p: DVec2) -> f64 {
        let beyond = p.length() - self.shape.radius_m();
        if beyond > self.perimeter_m { beyond } else { self.shape.distance(p) }
    }

    /// Returns the weight of the region at a point and time.
    pub(super) fn weight_at(&self, world: &WorldFrame, point: &PlanPoint, time_s: f64) -> f64 {
        // A region far away needs no axes.
        let moved_m = DVec2::from(self.velocity_m_s).length() * (time_s - self.at_s).abs();
        let away_m = (point.position - DVec3::from(self.center_m)).length();
        if self.strength == 0.0 || away_m > self.reach_m() + moved_m {
            return 0.0;
        }
        let axes = self.at(world, time_s);
        if (point.position - axes.center).length() > self.reach_m() {
            return 0.0;
        }
        self.weight(self.distance_m(axes.plan(point)))
    }
}

/// Axes of a region's plan at a time, in the host's world.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlanAxes {
    /// Centre of the region, m.
    center: DVec3,
    /// Altitude of the centre, m.
    altitude_m: f64,
    /// Unit vector to the right of the heading.
    right: DVec3,
    /// Unit vector along the heading.
    ahead: DVec3,
}

impl PlanAxes {
    /// Whether a position is within a distance of the centre, m.
    pub fn is_within(&self, position: DVec3, distance_m: f64) -> bool {
        (position - self.center).length() <= distance_m
    }

    /// Returns the unit vector along the heading.
    pub fn ahead(&self) -> DVec3 {
        self.ahead
    }

    /// Returns a point's position on the plan, (right, ahead) of the centre, m. The point is moved along its own
    /// vertical to the altitude of the centre, so that columns are vertical everywhere.
    pub fn plan(&self, point: &PlanPoint) -> DVec2 {
        let away = point.position - point.up * (point.altitude_m - self.altitude_m) - self.center;
        DVec2::new(away.dot(self.right), away.dot(self.ahead))
    }
}

/// Point at which weights of regions are computed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlanPoint {
    /// Position in the host's world, m.
    position: DVec3,
    /// Unit vector upwards there.
    up: DVec3,
    /// Altitude, m.
    altitude_m: f64,
}

impl PlanPoint {
    /// Creates the point at a position of the host's world.
    pub fn new(world: &WorldFrame, position: DVec3) -> Self {
        let local = world.frame_at(position);
        Self { position, up: local.world_to_enu.transpose().z_axis, altitude_m: local.place.altitude_m }
    }

    /// Returns the altitude, m.
    pub fn altitude_m(&self) -> f64 {
        self.altitude_m
    }
}

/// Weather region as a world holds and saves it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct HeldRegion {
    /// Place and motion.
    pub plan: RegionPlan,
    /// Parts of the weather that the region has.
    pub has: WeatherParts,
    /// Parts that are averaged with the same parts of earlier regions that merge them too.
    pub merges: WeatherParts,
    /// Weather inside.
    pub conditions: Conditions,
}

impl HeldRegion {
    /// Derives the conditions inside a region. `station_altitude_m` is that of the world's weather.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn new(region: &WeatherRegion, station_altitude_m: f64) -> Result<Self> {
        region.plan.validate()?;
        check_parts("weather_region.has", region.has)?;
        check_parts("weather_region.merges", region.merges)?;
        let up_m_s = region.vertical_wind_m_s;
        check_range("weather_region.vertical_wind_m_s", up_m_s, -MOST_VERTICAL_M_S, MOST_VERTICAL_M_S, "m/s")?;
        let weather = Weather { station_altitude_m, ..region.weather.clone() };
        let mut conditions =
            derive_with(&weather, &region.overrides).map_err(|e| e.within("weather_region.weather"))?;
        conditions.wind.up_m_s = up_m_s;
        Ok(Self { plan: region.plan, has: region.has, merges: region.merges, conditions })
    }

    /// Whether a region from a saved state is within all ranges and contains only finite numbers.
    pub fn is_valid(&self) -> bool {
        // Numbers of a forged state may be infinite.
        let is_finite = |text: String| !text.contains("nan") && !text.contains("inf");
        self.plan.validate().is_ok()
            && toml::to_string(&self.conditions).is_ok_and(is_finite)
            && [self.has, self.merges].iter().all(|parts| WeatherParts::ALL.has(*parts))
            && self.conditions.wind.up_m_s.abs() <= MOST_VERTICAL_M_S
    }
}

/// Checks that `parts` contains only known parts of the weather.
fn check_parts(name: &str, parts: WeatherParts) -> Result<()> {
    if WeatherParts::ALL.has(parts) {
        return Ok(());
    }
    Err(Error::range(name, &format!("a sum of parts within {:#x}", WeatherParts::ALL.0), format!("{:#x}", parts.0)))
}
