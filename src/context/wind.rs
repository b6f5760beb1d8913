//! The wind that a context answers for: velocity at any place and time, and how far it has carried the air.

use glam::DVec3;

use super::Context;
use crate::{
    error::Result,
    wind::{Blowing, Drift, WindAt},
};

impl Context {
    fn blowing(&self, time_s: f64) -> Result<Blowing> {
        self.check_time(time_s)?;
        Ok(self.wind.blowing(&self.timeline, self.drifted, time_s))
    }

    /// Wind at `position` and simulation time `time_s`, (east, north, up) of the place. Height counts from the station's altitude: who
    /// has terrain asks as far above the station as the point is above his ground.
    ///
    /// Any thread. Closed form: any time costs the same. Laws: [`crate::wind`].
    ///
    /// # Errors
    /// As [`Context::conditions_at`].
    pub fn wind_at(&self, position: DVec3, time_s: f64) -> Result<WindAt> {
        let place = self.desc.world.frame_at(position).place;
        place.validate()?;
        let conditions = self.weather_at(time_s)?;
        let height_m = place.altitude_m - conditions.air.station_altitude_m;
        Ok(self.blowing(time_s)?.at_height(&conditions.wind, height_m))
    }

    /// How far the wind at 10 m, gusts included, has carried the air since simulation time 0, m (east, north, up): the integral of
    /// its velocity over the timeline, the same at every place. Continuous whatever the weather does: what goes with the air is
    /// moved by its differences, never by velocity times time.
    ///
    /// Any thread. Closed form; the same bits for any sequence of updates, and after saving and loading.
    ///
    /// # Errors
    /// For times as [`Context::conditions_at`].
    pub fn wind_displacement(&self, time_s: f64) -> Result<DVec3> {
        Ok(self.blowing(time_s)?.drift.displacement_m.extend(0.0))
    }

    /// Velocity that [`Context::wind_displacement`] is the integral of, m/s: the wind at 10 m with its gusts, which carries drops.
    ///
    /// # Errors
    /// For times as [`Context::conditions_at`].
    pub fn carrying_wind(&self, time_s: f64) -> Result<DVec3> {
        Ok(self.blowing(time_s)?.velocity_m_s().extend(0.0))
    }

    /// How far the wind has carried the air between two moments, m: the difference of [`Context::wind_displacement`], and
    /// before what the timeline knows the wind of its first moment.
    pub(crate) fn carried(&self, from_s: f64, to_s: f64) -> DVec3 {
        let at = |t: f64| self.wind.blowing(&self.timeline, self.drifted, t);
        let known_s = from_s.max(self.timeline.known_from_s()).min(to_s);
        let first = at(known_s);
        let since = at(to_s).drift.displacement_m - first.drift.displacement_m;
        (since + first.velocity_m_s() * (known_s - from_s)).extend(0.0)
    }

    pub(super) fn drifted(&self) -> Drift {
        self.drifted
    }
}
