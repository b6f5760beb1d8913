//! Queries of precipitation at a place, and on a surface there.

use glam::DVec3;

use super::{
    drops::factor_in,
    ice::StoneSizes,
    sizes::{DropSizes, SMALLEST_MM, Weight},
};
use crate::{
    error::{Error, Result, check_range},
    surroundings::shelter::sheltered,
    world::World,
};

/// Precipitation at a place: rain and drizzle, hail and ice pellets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RainAt {
    /// Rain and drizzle on level ground, mm/h.
    pub rate_mm_h: f64,
    /// Number of drops from 0.1 to 6 mm, 1/m^3.
    pub number_per_m3: f64,
    /// Liquid water in the air, g/m^3.
    pub liquid_g_m3: f64,
    /// Extinction by the drops, 1/m.
    pub extinction_per_m: f64,
    /// Mean diameter of the drops in the air, mm.
    pub mean_diameter_mm: f64,
    /// Median diameter by volume, mm: smaller drops hold half of the liquid water in the air.
    pub median_volume_diameter_mm: f64,
    /// Number of drops that land on level ground, 1/(m^2 s).
    pub drops_per_m2_s: f64,
    /// Velocity, m/s (east, north, up), of the drop that divides the falling water into halves: one half falls more
    /// steeply, the other less. Draw occluder maps along this direction. The velocity is 0 if no rain falls.
    pub fall_velocity_m_s: DVec3,
    /// Hail and ice pellets on level ground, mm/h of melted water.
    pub ice_mm_h: f64,
    /// Number of stones (hail and ice pellets) in the air, 1/m^3.
    pub stones_per_m3: f64,
    /// Extinction by the stones, 1/m.
    pub stone_extinction_per_m: f64,
    /// Mean diameter of the stones in the air, mm.
    pub stone_diameter_mm: f64,
    /// Number of stones that land on level ground, 1/(m^2 s).
    pub stones_per_m2_s: f64,
}

/// Distance from a surface to the point in front of it for which shelter by boxes is tested, m.
const BEFORE_M: f64 = 0.05;

/// Surface on which rain may land, or an opening through which it may fall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RainSurface {
    /// Position in the host's world.
    pub position: DVec3,
    /// Direction that the wet side faces, (east, north, up) at the position. Any finite length above 1e-9 is allowed.
    pub normal: DVec3,
    /// Velocity of the surface, m/s (east, north, up), each component within \[-1000, 1000\].
    pub velocity_m_s: DVec3,
    /// Area, m^2, \[0, 1e6\].
    pub area_m2: f64,
}

/// Precipitation that lands on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RainOn {
    /// Rain and drizzle, mm/h: litres per square metre of the surface and hour.
    pub rate_mm_h: f64,
    /// Number of drops on the whole surface, 1/s.
    pub drops_per_s: f64,
    /// Hail and ice pellets, mm/h of melted water.
    pub ice_mm_h: f64,
    /// Number of stones on the whole surface, 1/s.
    pub stones_per_s: f64,
}

impl RainSurface {
    /// Checks the ranges of normal, velocity and area.
    fn validate(&self) -> Result<()> {
        let length = self.normal.length();
        if !(length.is_finite() && length > 1e-9) {
            return Err(Error::range("normal", "finite and longer than 1e-9", self.normal));
        }
        for (axis, v) in ["[0]", "[1]", "[2]"].iter().zip(self.velocity_m_s.to_array()) {
            check_range(&format!("velocity_m_s{axis}"), v, -1000.0, 1000.0, "m/s")?;
        }
        check_range("area_m2", self.area_m2, 0.0, 1e6, "m^2")
    }
}

/// Returns the drops and stones in the air at a place, and the wind that carries them: the wind at 10 m with its gusts,
/// or the wind that varies in space there. Above the cloud that they fall from, there are no drops or stones. Within
/// rain areas ([`Context::set_rain_areas`](crate::context::Context::set_rain_areas)) the drops and stones are those of
/// the areas, mixed with the weather's own at the rims.
fn drops_at(world: &World, position: DVec3, time_s: f64) -> Result<(DropSizes, StoneSizes, DVec3)> {
    let place = world.frame.place_at("position", position)?.place;
    let c = world.weather_at(position, time_s)?;
    let here = world.over().falling_at(position, time_s, c).precipitation;
    let stones = StoneSizes::new(&here, factor_in(&c.air, place.altitude_m));
    Ok((world.over().sizes_at(position, time_s, &c)?, stones, world.carrying_at(position, time_s)?))
}

/// Implements [`Context::rain_at`](crate::context::Context::rain_at).
pub(crate) fn rain_at(world: &World, position: DVec3, time_s: f64) -> Result<RainAt> {
    let (sizes, stones, wind) = drops_at(world, position, time_s)?;
    let (level, landed) = (sizes.on_level_ground(), stones.on_surface(DVec3::Z, DVec3::ZERO));
    let [median] = sizes.diameters(Weight::Water, SMALLEST_MM, [0.5]);
    let falls = level.drops_per_m2_s > 0.0;
    Ok(RainAt {
        rate_mm_h: level.rate_mm_h,
        number_per_m3: sizes.number_per_m3(),
        liquid_g_m3: sizes.liquid_g_m3(),
        extinction_per_m: sizes.extinction_per_m(),
        mean_diameter_mm: sizes.mean_diameter_mm(),
        median_volume_diameter_mm: sizes.median_volume_diameter_mm(),
        drops_per_m2_s: level.drops_per_m2_s,
        fall_velocity_m_s: if falls { wind - DVec3::Z * sizes.speed_m_s(median) } else { DVec3::ZERO },
        ice_mm_h: landed.rate_mm_h,
        stones_per_m3: stones.number_per_m3(),
        stone_extinction_per_m: stones.extinction_per_m(),
        stone_diameter_mm: stones.mean_diameter_mm(),
        stones_per_m2_s: landed.drops_per_m2_s,
    })
}

/// Implements [`Context::rain_on`](crate::context::Context::rain_on).
pub(crate) fn rain_on(world: &World, surface: &RainSurface, time_s: f64) -> Result<RainOn> {
    surface.validate()?;
    let (sizes, stones, wind) = drops_at(world, surface.position, time_s)?;
    let (normal, air) = (surface.normal.normalize(), wind - surface.velocity_m_s);
    let to_world = world.frame.frame_at(surface.position).world_to_enu.transpose();
    let before = surface.position + to_world * (normal * BEFORE_M);
    let since_s = time_s - world.time_s;
    // Moves the point back by each box's motion since the world's time, for which the boxes' positions are stored.
    let comes = |falls_m_s: f64| {
        let velocity = to_world * (wind - DVec3::Z * falls_m_s);
        !world.set.shelters.iter().any(|b| sheltered(b, before - b.velocity_m_s * since_s, velocity))
    };
    let (flux, ice) = (sizes.on_surface_of(normal, air, comes), stones.on_surface_of(normal, air, comes));
    Ok(RainOn {
        rate_mm_h: flux.rate_mm_h,
        drops_per_s: flux.drops_per_m2_s * surface.area_m2,
        ice_mm_h: ice.rate_mm_h,
        stones_per_s: ice.drops_per_m2_s * surface.area_m2,
    })
}
