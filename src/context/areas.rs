//! The rain areas of a context: where they are at a time, and what they make of the weather's rain at a place.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::{Context, MAX_TIME_S};
use crate::{
    error::{Error, Result, check_range},
    rain::{AreaMotion, MAX_AREAS, RainArea, Shaft, drops::factor_in, sizes::DropSizes},
    weather::{Conditions, Falling, Timeline, hydrometeors},
};

/// An area and what is known of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct KeptArea {
    area: RainArea,
    /// How far the wind had carried the air at the area's own time, m east and north: kept from when that time is past, for the
    /// timeline forgets.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    carried_m: Option<[f64; 2]>,
}

/// Height above the station for which the wind of a cloud stands, m: the highest that the profile knows.
const CLOUD_WIND_M: f64 = 100.0;

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
            let named = |e: Error| e.renamed("rain_area", &format!("rain_areas[{i}]"));
            self.check_area(area).map_err(named)?;
        }
        self.areas.clear();
        self.areas.extend(areas.iter().map(|area| KeptArea { area: *area, carried_m: None }));
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

    /// How far the wind had carried the air at a time that [`Context::set_rain_areas`] accepts, m east and north: nowhere at time 0,
    /// from which it is counted, whatever the timeline has forgotten since.
    fn carried_until(&self, at_s: f64) -> Result<[f64; 2]> {
        if at_s == 0.0 { Ok([0.0; 2]) } else { Ok(self.wind_displacement(at_s)?.truncate().to_array()) }
    }

    /// Whether saved ones can be some of ours over `timeline`.
    pub(super) fn are_valid(&self, areas: &[KeptArea], timeline: &Timeline) -> bool {
        let is_place = |center_m: [f64; 3]| self.desc.world.place_at("center_m", DVec3::from(center_m)).is_ok();
        let is_timed = |kept: &KeptArea| match (kept.area.motion, kept.carried_m) {
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
            let KeptArea { area, carried_m } = self.areas[i];
            if carried_m.is_none() && area.at_s <= now_s && area.motion == AreaMotion::WithWind {
                self.areas[i].carried_m = Some(self.carried_until(area.at_s)?);
            }
        }
        Ok(())
    }

    /// The areas at a time, in their order; `c` is the weather then.
    pub(crate) fn shafts_at(&self, time_s: f64, c: &Conditions) -> Result<impl Iterator<Item = Shaft>> {
        let wind = DVec2::new(c.wind.east_m_s, c.wind.north_m_s);
        let speed = c.wind.speed_m_s();
        let shear = if speed > 0.0 { c.wind.speed_at_height_m_s(CLOUD_WIND_M) / speed } else { 1.0 };
        let with_wind = self.areas.iter().any(|kept| kept.area.motion == AreaMotion::WithWind);
        let drift = if with_wind { self.wind_displacement(time_s)?.truncate() } else { DVec2::ZERO };
        let ground_m = c.air.station_altitude_m;
        let factor = factor_in(&c.air, ground_m);
        Ok(self.areas.iter().enumerate().filter_map(move |(i, kept)| {
            let (moved, cloud) = match kept.area.motion {
                AreaMotion::WithWind => {
                    let then = match kept.carried_m {
                        Some(carried) => DVec2::from(carried),
                        None => DVec2::from(self.carried_until(kept.area.at_s).ok()?),
                    };
                    (drift - then, wind * shear)
                }
                AreaMotion::Own(v) => (DVec2::from(v) * (time_s - kept.area.at_s), DVec2::from(v)),
            };
            let start = DVec3::from(kept.area.center_m);
            let to_world = self.desc.world.frame_at(start).world_to_enu.transpose();
            let center = start + to_world * moved.extend(0.0);
            let sizes = DropSizes::new(&kept.area.falling(), factor);
            let median = sizes.speed_m_s(sizes.median_volume_diameter_mm());
            // The drops fall through air that goes with the mean of the winds up there and at 10 m.
            let column = cloud - wind * (0.5 * (1.0 + shear));
            let altitude = self.desc.world.frame_at(center).place.altitude_m;
            Some(Shaft::new(&kept.area, i as u32, (center, altitude), (median, column), ground_m))
        }))
    }

    /// The drops of rain and drizzle in the air of a place; `c` is the weather then.
    pub(super) fn sizes_at(&self, position: DVec3, time_s: f64, c: &Conditions) -> Result<DropSizes> {
        let local = self.desc.world.frame_at(position);
        let altitude_m = local.place.altitude_m;
        let mut falling = c.precipitation;
        if altitude_m > c.falling_top_m() {
            (falling.rain_mm_h, falling.drizzle_mm_h) = (0.0, 0.0);
        }
        let factor = factor_in(&c.air, altitude_m);
        let mut sizes = DropSizes::new(&falling, factor);
        if self.areas.is_empty() {
            return Ok(sizes);
        }
        for shaft in self.shafts_at(time_s, c)? {
            let share = shaft.share_at(position, &local.world_to_enu, altitude_m);
            if share > 0.0 {
                sizes = sizes.covered(&DropSizes::new(&shaft.falling, factor), share, shaft.begun(altitude_m));
            }
        }
        Ok(sizes)
    }

    /// The weather with the rates of rain and drizzle that areas make at a place.
    pub(crate) fn with_areas(&self, position: DVec3, time_s: f64, c: Conditions) -> Conditions {
        let mut c = c;
        if self.areas.is_empty() {
            return c;
        }
        let local = self.desc.world.frame_at(position);
        let Ok(shafts) = self.shafts_at(time_s, &c) else { return c };
        let base = c;
        let mut falling = base.precipitation;
        for shaft in shafts {
            let share = shaft.share_at(position, &local.world_to_enu, local.place.altitude_m);
            falling = covered(&falling, &shaft.falling, share, shaft.begun(local.place.altitude_m));
        }
        c.precipitation = falling;
        c
    }

    /// Optical depth at 550 nm that the areas add between a place and another `offset` metres away (east, north, up of the
    /// first), on the mean over their pattern; negative where they thin the weather's rain.
    pub(super) fn areas_depth(&self, position: DVec3, offset: DVec3, time_s: f64, c: &Conditions) -> Result<f64> {
        if self.areas.is_empty() {
            return Ok(0.0);
        }
        let local = self.desc.world.frame_at(position);
        let field = crate::rain::AreaField::new(
            self.shafts_at(time_s, c)?,
            (position, &local.world_to_enu, local.place.altitude_m),
            &self.own_rain(c),
            0.0,
        );
        let range = offset.length();
        Ok(field.depth_along(DVec3::ZERO, offset / range, range))
    }

    /// What the fog's extinction has of the weather's rain.
    pub(crate) fn own_rain(&self, c: &Conditions) -> crate::rain::OwnRain {
        let layer = if self.fog_law.is_some() { None } else { super::fog::fog_layer(c, 0, [0.0; 2]) };
        match layer.map(|l| l.profile) {
            Some(crate::fog::Profile::Slab { top_m, top_softness_m, .. }) => crate::rain::OwnRain {
                extinction_per_m: c.precipitation.extinction_per_m * liquid_share(&c.precipitation),
                top_m: top_m + 0.5 * top_softness_m,
                soft_m: top_softness_m.max(1.0),
            },
            _ => crate::rain::OwnRain { extinction_per_m: 0.0, top_m: 0.0, soft_m: 1.0 },
        }
    }
}

/// Rates where `over` lies with a share over `falling`, of which the share `begun` has left its cloud.
fn covered(falling: &Falling, over: &Falling, share: f64, begun: f64) -> Falling {
    let (kept, come) = (1.0 - share, share * begun);
    let rain = falling.rain_mm_h * kept + over.rain_mm_h * come;
    let showers = falling.rain_mm_h * falling.showers * kept + over.rain_mm_h * over.showers * come;
    Falling {
        rain_mm_h: rain,
        drizzle_mm_h: falling.drizzle_mm_h * kept + over.drizzle_mm_h * come,
        showers: if rain > 0.0 { (showers / rain).min(1.0) } else { falling.showers },
        ..*falling
    }
}

/// Share of the extinction of all that falls that is rain's and drizzle's.
pub(super) fn liquid_share(f: &Falling) -> f64 {
    let [steady, showers] =
        [hydrometeors::rain_extinction_per_m, hydrometeors::shower_extinction_per_m].map(|law| law(f.rain_mm_h));
    let liquid = steady + (showers - steady) * f.showers + hydrometeors::drizzle_extinction_per_m(f.drizzle_mm_h);
    let solid = hydrometeors::snow_extinction_per_m(f.snow_mm_h)
        + hydrometeors::ice_pellet_extinction_per_m(f.ice_pellets_mm_h)
        + hydrometeors::hail_extinction_per_m(f.hail_mm_h);
    if liquid > 0.0 { liquid / (liquid + solid) } else { 0.0 }
}
