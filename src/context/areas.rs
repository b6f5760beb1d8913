//! The rain areas of a context: where they are at a time, and what they make of the weather's rain at a place.

use glam::DVec3;

use super::{Context, MAX_TIME_S};
use crate::{
    error::{Error, Result, check_range},
    moment::{OwnRain, Region},
    rain::{AreaMotion, MAX_AREAS, RainArea},
    weather::{Conditions, Timeline},
};

impl Context {
    /// Regions with rain of their own, in place of those before.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for more than [`MAX_AREAS`], or naming the field; nothing changes then.
    pub fn set_rain_areas(&mut self, areas: &[RainArea]) -> Result<()> {
        if areas.len() > MAX_AREAS {
            return Err(Error::range("rain_areas", &format!("at most {MAX_AREAS}"), areas.len()));
        }
        for (i, area) in areas.iter().enumerate() {
            let named =
                |e: Error| Error::new(e.status, e.message.replacen("rain_area.", &format!("rain_areas[{i}]."), 1));
            self.check_area(area).map_err(named)?;
        }
        self.areas.clear();
        self.areas.extend(areas.iter().map(|area| Region { area: *area, carried_m: None }));
        self.keep_carried(self.time_s)?;
        self.told += 1;
        self.show_terrain()
    }

    fn check_area(&self, area: &RainArea) -> Result<()> {
        area.validate()?;
        self.desc.world.place_at("rain_area.center_m", DVec3::from(area.center_m))?;
        check_range("rain_area.at_s", area.at_s, -MAX_TIME_S, MAX_TIME_S, "s")?;
        let known_s = self.timeline.known_from_s();
        if area.motion == AreaMotion::WithWind && area.at_s != 0.0 && area.at_s < known_s {
            let accepted =
                format!("0, or at least {known_s} s where the wind moves it: how it blew before is forgotten");
            return Err(Error::range("rain_area.at_s", &accepted, area.at_s));
        }
        Ok(())
    }

    /// Whether saved ones can be some of ours over `timeline`.
    pub(super) fn are_valid(&self, areas: &[Region], timeline: &Timeline) -> bool {
        let is_place = |center_m: [f64; 3]| self.desc.world.place_at("center_m", DVec3::from(center_m)).is_ok();
        let is_timed = |kept: &Region| match (kept.area.motion, kept.carried_m) {
            (AreaMotion::Own(_), carried) => carried.is_none(),
            (AreaMotion::WithWind, Some(carried)) => carried.iter().all(|v| v.is_finite()),
            (AreaMotion::WithWind, None) => kept.area.at_s >= timeline.known_from_s(),
        };
        areas.len() <= MAX_AREAS
            && areas.iter().all(|kept| {
                let area = &kept.area;
                area.validate().is_ok()
                    && is_place(area.center_m)
                    && area.at_s.abs() <= super::MAX_TIME_S
                    && is_timed(kept)
            })
    }

    /// The regions with rain of their own, as they were set.
    pub fn rain_areas(&self) -> impl ExactSizeIterator<Item = &RainArea> {
        self.areas.iter().map(|kept| &kept.area)
    }

    /// Keeps what the timeline, which goes on to `now_s`, is about to forget.
    pub(super) fn keep_carried(&mut self, now_s: f64) -> Result<()> {
        for i in 0..self.areas.len() {
            let Region { area, carried_m } = self.areas[i];
            if carried_m.is_none() && area.at_s <= now_s && area.motion == AreaMotion::WithWind {
                self.areas[i].carried_m = Some(self.over().carried_until(area.at_s)?);
            }
        }
        Ok(())
    }

    /// Optical depth at 550 nm that the areas add between a place and another `offset` metres away (east, north, up of the
    /// first), on the mean over their pattern; negative where they thin the weather's rain.
    pub(super) fn areas_depth(&self, position: DVec3, offset: DVec3, time_s: f64, c: &Conditions) -> Result<f64> {
        if self.areas.is_empty() {
            return Ok(0.0);
        }
        let local = self.desc.world.frame_at(position);
        let field = crate::rain::AreaField::new(
            self.over().shafts_at(time_s, c)?,
            (position, &local.world_to_enu, local.place.altitude_m),
            &self.own_rain(c),
            0.0,
        );
        let range = offset.length();
        Ok(field.depth_along(DVec3::ZERO, offset / range, range))
    }

    /// What the fog's extinction has of the weather's rain.
    pub(crate) fn own_rain(&self, c: &Conditions) -> OwnRain {
        let layer = if self.fog_law.is_some() { None } else { crate::fog::fog_layer(c, 0, [0.0; 2]) };
        match layer.map(|l| l.profile) {
            Some(crate::fog::Profile::Slab { top_m, top_softness_m, .. }) => OwnRain {
                extinction_per_m: c.precipitation.extinction_per_m * crate::falling::liquid_share(&c.precipitation),
                top_m: top_m + 0.5 * top_softness_m,
                soft_m: top_softness_m.max(1.0),
            },
            _ => OwnRain::NONE,
        }
    }
}
