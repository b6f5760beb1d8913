//! Air in which drops and flakes fall near the camera, and the share of precipitation that has begun to fall.

use glam::DVec3;

use crate::{error::Result, moment::SceneMoment};

/// Air in which drops and flakes fall, around a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MovingAir {
    /// Displacement of the air by the wind since time 0, m (east, north, up).
    pub displacement_m: DVec3,
    /// Velocity of the air, m/s (east, north, up).
    pub velocity_m_s: DVec3,
    /// Simulation time, s.
    pub time_s: f64,
    /// Extinction of fog and aerosol, 1/m, without that of the air's molecules and of precipitation.
    pub extinction_per_m: f64,
}

impl MovingAir {
    /// Returns the air of a moment, with the wind that carries precipitation.
    ///
    /// # Errors
    /// The errors of [`SceneMoment::carrying`]: the weather is not known at this time.
    pub fn of(now: &SceneMoment<'_>) -> Result<Self> {
        let (wind, c) = (now.carrying()?, &now.scene.conditions);
        Ok(Self {
            displacement_m: wind.displacement_m(),
            velocity_m_s: wind.velocity_m_s(),
            time_s: now.time_s,
            extinction_per_m: c.fog.extinction_per_m + c.aerosol.extinction_per_m,
        })
    }
}

/// Number of steps to which the share of precipitation that has begun to fall is rounded.
const ONSET_STEPS: f64 = 32.0;

/// Rounds the share of precipitation that has begun to fall ([`crate::weather::Conditions::begun`]) up to the next
/// step, so that drops or flakes are not recounted in each frame of a climbing camera. Precipitation begins inside its
/// cloud, above the base.
pub(crate) fn begun_in_steps(begun: f64) -> f64 {
    (begun * ONSET_STEPS).ceil() / ONSET_STEPS
}
