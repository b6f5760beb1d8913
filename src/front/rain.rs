//! Rain: areas, and precipitation at places and on surfaces.

use glam::DVec3;

use crate::{
    context::Context,
    error::Result,
    rain::{AreaField, EyeInWorld, RainArea, RainAt, RainOn, RainSurface, rain_at, rain_on},
    weather::Conditions,
};

impl Context {
    /// Sets the rain areas, which have rain of their own, in place of those before. Where clouds are a volume
    /// ([`Context::set_cloud_model`]), each area has cloud above it.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for more than [`MAX_AREAS`](crate::rain::MAX_AREAS), or naming the field;
    /// nothing changes then.
    pub fn set_rain_areas(&mut self, areas: &[RainArea]) -> Result<()> {
        self.world.set_regions(areas)?;
        self.refresh()
    }

    /// Returns the rain areas, as they were set.
    pub fn rain_areas(&self) -> impl ExactSizeIterator<Item = &RainArea> {
        self.world.set.regions.iter().map(|kept| &kept.area)
    }

    /// Returns the precipitation at `position` and simulation time `time_s`.
    ///
    /// Any thread. [`crate::rain::sizes`] has the laws of rain and drizzle, [`crate::rain::ice`] those of hail and
    /// pellets.
    ///
    /// # Errors
    /// As [`Context::conditions_at`].
    pub fn rain_at(&self, position: DVec3, time_s: f64) -> Result<RainAt> {
        rain_at(&self.world, position, time_s)
    }

    /// Returns the precipitation that lands on a surface, or comes through a window, at simulation time `time_s`. Each
    /// drop size has its own slant, from the wind and the surface's own motion. Precipitation that a box
    /// ([`Context::set_shelters`]) keeps off does not land; the box is where its velocity has carried it by that time.
    /// The test follows the path of each size to a point 5 cm in front of the surface, so that a face of a box is not
    /// inside that box. Occluder maps have no influence on the result.
    ///
    /// Any thread.
    ///
    /// # Errors
    /// As [`Context::conditions_at`]; [`crate::Status::InvalidArgument`] naming the field of `surface`.
    pub fn rain_on(&self, surface: &RainSurface, time_s: f64) -> Result<RainOn> {
        rain_on(&self.world, surface, time_s)
    }

    /// Returns the optical depth at 550 nm that the rain areas add over `offset`, metres (east, north, up) from
    /// `position`: the mean over their curtains. The depth is negative where the areas thin the weather's rain. With
    /// weather regions, the weather's rain is that outside all of them. Without regions, it is the rain of `c`.
    pub(super) fn areas_depth(&self, position: DVec3, offset: DVec3, time_s: f64, c: &Conditions) -> Result<f64> {
        let (over, world) = (self.world.over(), &self.world);
        if over.regions.is_empty() {
            return Ok(0.0);
        }
        let outside = (!over.weather_regions.is_empty()).then(|| over.known(time_s));
        let c = outside.as_ref().unwrap_or(c);
        let local = world.frame.frame_at(position);
        let field = AreaField::new(
            over.shafts_at(time_s, c)?,
            EyeInWorld { position, to_enu: &local.world_to_enu, altitude_m: local.place.altitude_m },
            &world.falling(c),
            0.0,
        );
        let range = offset.length();
        Ok(field.depth_along(DVec3::ZERO, offset / range, range))
    }
}
