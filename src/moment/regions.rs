//! The weather over all places and times of a context: its timeline, its wind, its weather regions and its rain areas.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use crate::{
    error::{Error, Result, check_range},
    falling::{
        area::{AreaMotion, RainArea, Shaft},
        drops::factor_in,
        sizes::DropSizes,
    },
    regions::{HeldRegion, RegionsHere},
    scene::WorldFrame,
    weather::{CloudMap, Conditions, Falling, Timeline, WeatherParts, timeline::MAX_TIME_S},
    wind::{Blowing, Carrying, LayerDrifts, WindOver, up_share},
};

/// A rain area of the host, with the wind's displacement from which its drift is counted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Region {
    /// Place, motion and rain of the area.
    pub area: RainArea,
    /// Distance over which the wind had carried the air at the area's own time ([`RainArea::at_s`]), m east and north.
    /// Stored once that time is past, because the timeline forgets the past.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub carried_m: Option<[f64; 2]>,
}

/// Height above the station, m, of the wind that moves a raining cloud: the top of the surface layer, in which the wind
/// does not turn.
const CLOUD_WIND_M: f64 = 100.0;

/// The weather of a context over places and times.
#[derive(Clone, Copy)]
pub(crate) struct WeatherOver<'a> {
    /// Mapping from the host's coordinates to places.
    pub world: &'a WorldFrame,
    /// Wind, with the timeline of the weather.
    pub wind: WindOver<'a>,
    /// Rain areas.
    pub regions: &'a [Region],
    /// Regions with a weather of their own.
    pub weather_regions: &'a [HeldRegion],
    /// The host's map of local cloud cover, if it has set one.
    pub cloud_map: Option<&'a Arc<CloudMap>>,
}

impl<'a> WeatherOver<'a> {
    /// Returns the weathers and the transitions between them.
    pub fn timeline(&self) -> &'a Timeline {
        self.wind.timeline
    }

    /// Returns the weather at a time outside all regions. For an earlier time than the timeline knows, this is the
    /// weather at the first time that it knows.
    pub fn known(&self, time_s: f64) -> Conditions {
        self.timeline().at(time_s)
    }

    /// Returns the weather at a place and time, with the weather regions and without the rain areas there.
    pub fn weather_at(&self, position: DVec3, time_s: f64) -> Conditions {
        self.in_regions(position, time_s, self.known(time_s))
    }

    /// Returns the weather `c`, which holds at a time outside all regions, with the changes by the weather regions over
    /// a place.
    pub fn in_regions(&self, position: DVec3, time_s: f64, c: Conditions) -> Conditions {
        if self.weather_regions.is_empty() {
            return c;
        }
        let here = RegionsHere::new(self.weather_regions, self.world, position, time_s);
        if here.is_empty() { c } else { here.merged(&c) }
    }

    /// Returns the wind at 10 m at a place and time, with gusts, and its upward velocity above 100 m, m/s. The wind of
    /// a weather region is taken as if it had always blown. The displacement by a region's wind is not used: everything
    /// that the wind carries moves by the world's displacement, at every place, so that nothing jumps at a region's
    /// border.
    ///
    /// # Errors
    /// As [`WeatherOver::check_time`].
    pub fn blowing_at(&self, position: DVec3, time_s: f64) -> Result<(Blowing, f64)> {
        let world = self.wind_at(time_s)?;
        if self.weather_regions.is_empty() {
            return Ok((world, 0.0));
        }
        let here = RegionsHere::new(self.weather_regions, self.world, position, time_s);
        let shares = here.shares(WeatherParts::WIND);
        let mut mean = world.shared(shares.base);
        let mut up_m_s = 0.0;
        for (_, region, share) in here.with_shares(shares) {
            let wind = &region.conditions.wind;
            mean = mean.with(&self.wind.wind.steady(wind, time_s).shared(share));
            up_m_s += wind.up_m_s * share;
        }
        Ok((mean, up_m_s))
    }

    /// Checks that the weather is known at a time.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the time is not finite, out of range, or before the time from which the
    /// timeline is known.
    pub fn check_time(&self, time_s: f64) -> Result<()> {
        check_range("time_s", time_s, -MAX_TIME_S, MAX_TIME_S, "s")?;
        let from = self.timeline().known_from_s();
        if time_s < from {
            return Err(Error::range("time_s", &format!("at least {from} s: what was before is forgotten"), time_s));
        }
        Ok(())
    }

    /// Returns the wind that carries the air, from time 0 to a time.
    ///
    /// # Errors
    /// As [`WeatherOver::check_time`].
    pub fn carrying_until(&self, time_s: f64) -> Result<Carrying<'a>> {
        self.check_time(time_s)?;
        Ok(self.wind.carrying_until(time_s))
    }

    /// Returns the wind, m/s (east, north, up), that carries what falls past a place: the wind at 10 m with its gusts,
    /// and the upward wind at the place's height.
    ///
    /// # Errors
    /// As [`WeatherOver::check_time`].
    pub fn carrying_at(&self, position: DVec3, time_s: f64) -> Result<DVec3> {
        let (wind, up_m_s) = self.blowing_at(position, time_s)?;
        if up_m_s == 0.0 {
            return Ok(wind.velocity_m_s().extend(0.0));
        }
        let height_m = self.world.frame_at(position).place.altitude_m - self.known(time_s).air.station_altitude_m;
        Ok(wind.velocity_m_s().extend(up_m_s * up_share(height_m)))
    }

    /// Returns the wind at a time.
    ///
    /// # Errors
    /// As [`WeatherOver::check_time`].
    pub fn wind_at(&self, time_s: f64) -> Result<Blowing> {
        self.check_time(time_s)?;
        Ok(self.wind.at(time_s))
    }

    /// Returns how far the wind has carried the cloud layers by a time.
    ///
    /// # Errors
    /// As [`WeatherOver::check_time`].
    pub fn layers_until(&self, time_s: f64) -> Result<LayerDrifts> {
        self.check_time(time_s)?;
        Ok(self.wind.layers_at(time_s))
    }

    /// Returns how far the wind had carried the air by a rain area's own time, m east and north. It is 0 at time 0,
    /// where the count begins, even if the timeline no longer knows that time.
    ///
    /// # Errors
    /// As [`WeatherOver::check_time`].
    pub fn carried_until(&self, at_s: f64) -> Result<[f64; 2]> {
        if at_s == 0.0 { Ok([0.0; 2]) } else { Ok(self.carrying_until(at_s)?.displacement_m().truncate().to_array()) }
    }

    /// Returns the rain areas at a time as shafts, in their order. `c` is the weather at that time. If there are
    /// weather regions, the weather outside them is used in place of `c`.
    ///
    /// # Errors
    /// As [`WeatherOver::check_time`].
    pub fn shafts_at(self, time_s: f64, c: &Conditions) -> Result<impl Iterator<Item = Shaft> + 'a> {
        // Shafts must not depend on the place from which they are seen.
        let outside = (!self.weather_regions.is_empty()).then(|| self.known(time_s));
        let c = outside.as_ref().unwrap_or(c);
        let wind = DVec2::new(c.wind.east_m_s, c.wind.north_m_s);
        let speed = c.wind.speed_m_s();
        let shear = if speed > 0.0 { c.wind.speed_at_height_m_s(CLOUD_WIND_M) / speed } else { 1.0 };
        let with_wind = self.regions.iter().any(|kept| kept.area.motion == AreaMotion::WithWind);
        let drift = if with_wind { self.carrying_until(time_s)?.displacement_m().truncate() } else { DVec2::ZERO };
        let ground_m = c.air.station_altitude_m;
        let factor = factor_in(&c.air, ground_m);
        Ok(self.regions.iter().enumerate().filter_map(move |(i, kept)| {
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
            let to_world = self.world.frame_at(start).world_to_enu.transpose();
            let center = start + to_world * moved.extend(0.0);
            let sizes = DropSizes::new(&kept.area.falling(), factor);
            let median = sizes.speed_m_s(sizes.median_volume_diameter_mm());
            // Drops fall through air that moves with the mean of the winds at the cloud and at 10 m.
            let column = cloud - wind * (0.5 * (1.0 + shear));
            let altitude = self.world.frame_at(center).place.altitude_m;
            Some(Shaft::new(&kept.area, i as u32, (center, altitude), (median, column), ground_m))
        }))
    }

    /// Returns the sizes of rain and drizzle drops in the air at a position; `c` is the weather at that time.
    ///
    /// # Errors
    /// As [`WeatherOver::check_time`].
    pub fn sizes_at(&self, position: DVec3, time_s: f64, c: &Conditions) -> Result<DropSizes> {
        let local = self.world.frame_at(position);
        let altitude_m = local.place.altitude_m;
        let mut falling = c.precipitation;
        if altitude_m > c.falling_top_m() {
            (falling.rain_mm_h, falling.drizzle_mm_h) = (0.0, 0.0);
        }
        let factor = factor_in(&c.air, altitude_m);
        let mut sizes = DropSizes::new(&falling, factor);
        if self.regions.is_empty() {
            return Ok(sizes);
        }
        for shaft in self.shafts_at(time_s, c)? {
            let share = shaft.share_at(position, &local.world_to_enu, altitude_m);
            if share > 0.0 {
                sizes = sizes.mixed_with(&DropSizes::new(&shaft.falling, factor), share, shaft.begun(altitude_m));
            }
        }
        Ok(sizes)
    }

    /// Returns the weather `c` of a time with the rates of rain and drizzle at a place, where rain areas replace a
    /// share of the weather's own rain. The extinction of the drops changes with the rates. Where the areas cannot be
    /// placed at that time, `c` is returned as it is.
    pub fn at_place(&self, position: DVec3, time_s: f64, c: Conditions) -> Conditions {
        if self.regions.is_empty() {
            return c;
        }
        let local = self.world.frame_at(position);
        let Ok(shafts) = self.shafts_at(time_s, &c) else { return c };
        let mut falling = c.precipitation;
        for shaft in shafts {
            let share = shaft.share_at(position, &local.world_to_enu, local.place.altitude_m);
            let begun = shaft.begun(local.place.altitude_m);
            falling = mixed_with(&falling, &shaft.falling, share, begun);
        }
        with_falling(c, falling)
    }

    /// Returns the weather `c` of a time as it is at a place. The weather's own precipitation falls only below its
    /// cloud. The rain areas' rain is added as in [`WeatherOver::at_place`].
    pub fn falling_at(&self, position: DVec3, time_s: f64, c: Conditions) -> Conditions {
        let altitude_m = self.world.frame_at(position).place.altitude_m;
        let own = if altitude_m > c.falling_top_m() {
            let none = Falling {
                rain_mm_h: 0.0,
                drizzle_mm_h: 0.0,
                snow_mm_h: 0.0,
                ice_pellets_mm_h: 0.0,
                hail_mm_h: 0.0,
                liquid_extinction_per_m: 0.0,
                solid_extinction_per_m: 0.0,
                ..c.precipitation
            };
            with_falling(c, none)
        } else {
            c
        };
        self.at_place(position, time_s, own)
    }
}

/// Returns the weather with `falling` in place of its precipitation, and the total extinction to match.
fn with_falling(c: Conditions, falling: Falling) -> Conditions {
    let changed = falling.extinction_per_m() - c.precipitation.extinction_per_m();
    // Rounding must not bring the extinction below that of clear air.
    let extinction_per_m = (c.extinction_per_m + changed).max(c.air.rayleigh_extinction_per_m);
    Conditions { extinction_per_m, precipitation: falling, ..c }
}

/// Returns rates and extinction of drops where the rain `region` of an area replaces the share `share` of `falling`. Of
/// the area's rain, the share `begun` has already left its cloud.
fn mixed_with(falling: &Falling, region: &Falling, share: f64, begun: f64) -> Falling {
    let (kept, come) = (1.0 - share, share * begun);
    let rain = falling.rain_mm_h * kept + region.rain_mm_h * come;
    let showers = falling.rain_mm_h * falling.showers * kept + region.rain_mm_h * region.showers * come;
    Falling {
        rain_mm_h: rain,
        drizzle_mm_h: falling.drizzle_mm_h * kept + region.drizzle_mm_h * come,
        showers: if rain > 0.0 { (showers / rain).min(1.0) } else { falling.showers },
        liquid_extinction_per_m: falling.liquid_extinction_per_m * kept + region.liquid_extinction_per_m * come,
        ..*falling
    }
}
