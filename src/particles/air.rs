//! Air that what falls near the camera is drawn in, and how much has set in below its cloud.

use glam::DVec3;

use crate::{error::Result, moment::SceneMoment};

/// The air that what is drawn falls in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MovingAir {
    pub displacement_m: DVec3,
    pub velocity_m_s: DVec3,
    pub time_s: f64,
    /// Extinction beside that of what falls, 1/m.
    pub extinction_per_m: f64,
}

impl MovingAir {
    /// The air of a moment, as it carries what falls.
    ///
    /// # Errors
    /// As [`SceneMoment::carrying`].
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

/// Steps in which rain and snow set in below their cloud.
const ONSET_STEPS: f64 = 32.0;

/// Rounds up the share that has left its cloud, so that a climbing camera does not count drops or flakes anew in each
/// frame.
pub(crate) fn begun_in_steps(begun: f64) -> f64 {
    (begun * ONSET_STEPS).ceil() / ONSET_STEPS
}
