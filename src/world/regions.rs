//! The regions of a world with rain of their own.

use glam::DVec3;

use super::state::World;
use crate::{
    error::{Error, Result, check_range},
    falling::{
        MAX_AREAS,
        area::{AreaMotion, RainArea},
    },
    moment::Region,
    weather::{Timeline, timeline::MAX_TIME_S},
};

impl World {
    /// Replaces the regions.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for more than [`MAX_AREAS`], or naming the field; the regions then stay as
    /// they were.
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

    /// Checks a region's fields and its own time.
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

    /// Whether saved regions could have been set in this world with `timeline`.
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

    /// Stores the displacements that the timeline is about to forget by advancing to `now_s`.
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
}
