//! Rain areas and weather regions of a world.

use glam::DVec3;

use super::state::World;
use crate::{
    error::{Error, Result, check_range},
    falling::{
        MAX_AREAS,
        area::{AreaMotion, RainArea},
    },
    moment::Region,
    regions::{HeldRegion, MAX_WEATHER_REGIONS, RegionPlan, WeatherRegion},
    weather::{Timeline, timeline::MAX_TIME_S},
};

impl World {
    /// Replaces the rain areas.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for more than [`MAX_AREAS`] areas, and for a field out of range, which the
    /// message names. The areas then stay as they were.
    pub fn set_regions(&mut self, areas: &[RainArea]) -> Result<()> {
        if areas.len() > MAX_AREAS {
            return Err(Error::range("rain_areas", &format!("at most {MAX_AREAS}"), areas.len()));
        }
        for (i, area) in areas.iter().enumerate() {
            let named = |e: Error| e.renamed("rain_area", &format!("rain_areas[{i}]"));
            self.check_region(area).map_err(named)?;
        }
        self.set.regions.clear();
        self.set.regions.extend(areas.iter().map(|area| Region { area: *area, carried_m: None }));
        self.keep_carried(self.time_s)?;
        self.surroundings_revision += 1;
        Ok(())
    }

    /// Checks a rain area's fields, its place and its time `at_s`.
    fn check_region(&self, area: &RainArea) -> Result<()> {
        area.validate()?;
        self.frame.place_at("rain_area.center_m", DVec3::from(area.center_m))?;
        check_range("rain_area.at_s", area.at_s, -MAX_TIME_S, MAX_TIME_S, "s")?;
        let known_s = self.timeline.known_from_s();
        if area.motion == AreaMotion::WithWind && area.at_s != 0.0 && area.at_s < known_s {
            let accepted =
                format!("0, or at least {known_s} s where the wind moves it: how it blew before is forgotten");
            return Err(Error::range("rain_area.at_s", &accepted, area.at_s));
        }
        Ok(())
    }

    /// Whether saved rain areas could have been set in this world with `timeline`.
    pub(super) fn are_valid(&self, regions: &[Region], timeline: &Timeline) -> bool {
        let is_place = |center_m: [f64; 3]| self.frame.place_at("center_m", DVec3::from(center_m)).is_ok();
        let is_timed = |kept: &Region| match (kept.area.motion, kept.carried_m) {
            (AreaMotion::Own(_), carried) => carried.is_none(),
            (AreaMotion::WithWind, Some(carried)) => carried.iter().all(|v| v.is_finite()),
            (AreaMotion::WithWind, None) => kept.area.at_s >= timeline.known_from_s(),
        };
        regions.len() <= MAX_AREAS
            && regions.iter().all(|kept| {
                let area = &kept.area;
                area.validate().is_ok() && is_place(area.center_m) && area.at_s.abs() <= MAX_TIME_S && is_timed(kept)
            })
    }

    /// Stores, for each rain area that the wind moves, the displacement of the air at the area's time `at_s`, if that
    /// time is not after `now_s`. The timeline may then forget that time.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a time at which the weather is not known.
    pub fn keep_carried(&mut self, now_s: f64) -> Result<()> {
        for i in 0..self.set.regions.len() {
            let Region { area, carried_m } = self.set.regions[i];
            if carried_m.is_none() && area.at_s <= now_s && area.motion == AreaMotion::WithWind {
                self.set.regions[i].carried_m = Some(self.over().carried_until(area.at_s)?);
            }
        }
        Ok(())
    }

    /// Replaces the weather regions.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for more than [`MAX_WEATHER_REGIONS`] regions, and for a field out of range,
    /// which the message names. The regions then stay as they were.
    pub fn set_weather_regions(&mut self, regions: &[WeatherRegion]) -> Result<()> {
        if regions.len() > MAX_WEATHER_REGIONS {
            return Err(Error::range("weather_regions", &format!("at most {MAX_WEATHER_REGIONS}"), regions.len()));
        }
        let station_altitude_m = self.timeline.at(self.time_s).air.station_altitude_m;
        let held = regions.iter().enumerate().map(|(i, region)| {
            let held = HeldRegion::new(region, station_altitude_m).and_then(|held| {
                self.frame.place_at("weather_region.center_m", DVec3::from(region.plan.center_m))?;
                check_range("weather_region.at_s", region.plan.at_s, -MAX_TIME_S, MAX_TIME_S, "s")?;
                Ok(held)
            });
            held.map_err(|e: Error| e.renamed("weather_region", &format!("weather_regions[{i}]")))
        });
        self.set.weather_regions = held.collect::<Result<_>>()?;
        self.regions_revision += 1;
        Ok(())
    }

    /// Keeps some of the weather regions, whose indices are in `kept`, and brings their centres to a position of the
    /// host's world, m, where they rest at full strength.
    pub fn bring_weather_regions(&mut self, kept: &[usize], center_m: DVec3) {
        let brought = |region: &HeldRegion| {
            let plan = RegionPlan { center_m: center_m.into(), velocity_m_s: [0.0; 2], strength: 1.0, ..region.plan };
            HeldRegion { plan, ..region.clone() }
        };
        self.set.weather_regions = kept.iter().map(|i| brought(&self.set.weather_regions[*i])).collect();
        self.regions_revision += 1;
    }

    /// Whether saved weather regions are possible in this world.
    pub(super) fn are_valid_weathers(&self, regions: &[HeldRegion]) -> bool {
        let is_place = |center_m: [f64; 3]| self.frame.place_at("center_m", DVec3::from(center_m)).is_ok();
        regions.len() <= MAX_WEATHER_REGIONS
            && regions
                .iter()
                .all(|held| held.is_valid() && is_place(held.plan.center_m) && held.plan.at_s.abs() <= MAX_TIME_S)
    }
}
