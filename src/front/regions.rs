//! Weather regions: setting them, and the optical depth of ways through them.

use glam::DVec3;

use crate::{
    context::{Context, Scene},
    error::Result,
    fog::{LowAir, LowMedia, Viewpoint},
    regions::{RegionWay, WeatherRegion},
    sky::reference::{medium::Medium, ray::Ray},
    weather::{Conditions, WeatherParts},
};

/// Parts of the weather whose media attenuate light along a way, in the order of [`WayMedia::depths`].
const ATTENUATING: [WeatherParts; 3] = [WeatherParts::HAZE, WeatherParts::FOG, WeatherParts::PRECIPITATION];

/// Media of one weather along a ray.
struct WayMedia {
    /// Air. Its haze is used; its gas and ozone are used only in the weather outside all regions.
    air: Medium,
    ray: Ray,
    low: LowMedia,
}

impl WayMedia {
    /// Returns the optical depths per channel of one medium of [`ATTENUATING`] over the first `range_m` metres of the
    /// ray along `unit` (east, north, up).
    fn depths(&self, medium: usize, unit: DVec3, range_m: f64) -> [f64; 3] {
        match medium {
            0 => {
                let [_, haze_m, _] = self.ray.columns(&self.air, 0.0, range_m);
                self.air.extinction[1].map(|per_m| per_m * haze_m)
            }
            1 => self.low.layer_depths(unit, range_m),
            _ => self.low.falling_depths(unit, range_m),
        }
    }
}

impl Context {
    /// Sets the weather regions, which have a weather of their own, in place of those before. They move by themselves;
    /// a host may also set them again each frame, at their new places. [`crate::regions`] has the rules.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for more than
    /// [`MAX_WEATHER_REGIONS`](crate::regions::MAX_WEATHER_REGIONS), or naming the field; nothing changes then.
    pub fn set_weather_regions(&mut self, regions: &[WeatherRegion]) -> Result<()> {
        self.world.set_weather_regions(regions)?;
        self.refresh()
    }

    /// Returns the number of weather regions.
    pub fn weather_region_count(&self) -> usize {
        self.world.set.weather_regions.len()
    }

    /// Returns the optical depths per channel of air, haze, low layer and precipitation over `offset` metres (east,
    /// north, up) from a scene's place, if weather regions lie on the way.
    ///
    /// # Errors
    /// As [`Context::conditions_at`].
    pub(super) fn depths_through_regions(
        &self,
        scene: &Scene,
        start: DVec3,
        offset: DVec3,
        time_s: f64,
    ) -> Result<Option<[f64; 3]>> {
        let world = &self.world;
        if world.set.weather_regions.is_empty() {
            return Ok(None);
        }
        let range_m = offset.length();
        let unit = offset / range_m;
        let direction = scene.world_to_enu.transpose() * unit;
        let way = RegionWay::new(&world.set.weather_regions, &world.frame, start, direction, range_m, time_s);
        if way.is_empty() {
            return Ok(None);
        }
        let drift_m = world.over().wind_at(time_s)?.drift.displacement_m.to_array();
        let outside = world.weather_outside(time_s)?;
        let view = Viewpoint {
            altitude_m: scene.place.altitude_m,
            map_m: scene.map_m,
            planet_radius_m: scene.planet.bottom_radius_m,
            ..Viewpoint::flat(0.0)
        };
        let media_of = |c: &Conditions| -> Result<WayMedia> {
            let air = Medium::of(&world.planet_under(c));
            let ray = Ray::new(&air, scene.place.altitude_m, unit.z);
            let detour = world.detour(start, c, time_s);
            let low = LowAir::new(c, world.seed, drift_m).with_detour(detour).media(&view)?;
            Ok(WayMedia { air, ray, low })
        };
        let weathers = std::iter::once(&outside).chain(way.regions().map(|region| &region.conditions));
        let media = weathers.map(media_of).collect::<Result<Vec<_>>>()?;
        let air = &media[0];
        let [gas_m, _, ozone_m] = air.ray.columns(&air.air, 0.0, range_m);
        let mut depths = air.air.optical_depth(&[gas_m, 0.0, ozone_m]);
        // For each medium of each weather: the end, m, of the last piece of the way on which the medium was present,
        // and the depths up to there.
        let mut before = vec![[(0.0, [0.0; 3]); ATTENUATING.len()]; media.len()];
        way.pieces(|[from_m, to_m], here| {
            for (medium, part) in ATTENUATING.into_iter().enumerate() {
                let shares = here.shares(part);
                let regions = here.with_shares(shares).map(|(index, _, share)| (index + 1, share));
                for (weather, share) in std::iter::once((0, shares.base)).chain(regions) {
                    if share == 0.0 {
                        continue;
                    }
                    let (known_m, known) = before[weather][medium];
                    let at = |range_m| media[weather].depths(medium, unit, range_m);
                    let first = if known_m == from_m { known } else { at(from_m) };
                    let last = at(to_m);
                    before[weather][medium] = (to_m, last);
                    for (depth, (a, b)) in depths.iter_mut().zip(first.iter().zip(last)) {
                        *depth += share * (b - a);
                    }
                }
            }
            Ok(())
        })?;
        Ok(Some(depths))
    }
}
