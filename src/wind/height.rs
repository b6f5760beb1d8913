//! Wind at a height above ground, `WindAt`: the profile of the mean, and the gusts around it.

use glam::{DVec2, DVec3};

use super::drift::Blowing;
use crate::weather::WindProfile;

/// Least height above ground at which the vertical wind has its full speed, m: the top of the surface layer.
const UP_WHOLE_M: f64 = 100.0;

/// Returns the share of the vertical wind at a height above ground: none at the ground, all of it at 100 m and above.
pub(crate) fn up_share(height_m: f64) -> f64 {
    (height_m / UP_WHOLE_M).clamp(0.0, 1.0)
}

/// Wind at a height above ground, m/s (east, north, up).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindAt {
    /// Velocity with wander and gusts at this time.
    pub velocity_m_s: DVec3,
    /// Mean velocity over ten minutes.
    pub mean_m_s: DVec3,
    /// Standard deviation of gusts along the mean wind, m/s.
    pub gust_deviation_m_s: f64,
}

impl Blowing {
    /// Returns the velocity at 10 m with wander and gusts, m/s. The displacement is its integral.
    pub fn velocity_m_s(&self) -> DVec2 {
        self.mean_m_s + self.turned_m_s + self.gust_m_s
    }

    /// Returns the wind at `height_m` above ground under a `profile`.
    ///
    /// The mean follows [`WindProfile::mean_at_height_m_s`]. Gusts are equally strong at all heights (Panofsky and
    /// Dutton 1984), except where the mean is below half of that at 10 m: there they decrease with it.
    pub fn at_height(&self, profile: &WindProfile, height_m: f64) -> WindAt {
        let speed = profile.speed_m_s();
        let share = DVec2::from_array(profile.relative_at_height(height_m));
        let gusts = (2.0 * share.length()).min(1.0);
        let up_m_s = profile.up_m_s * up_share(height_m);
        let level = |v: DVec2| v.extend(up_m_s);
        WindAt {
            velocity_m_s: level(share.rotate(self.mean_m_s + self.turned_m_s) + self.gust_m_s * gusts),
            mean_m_s: level(share.rotate(self.mean_m_s)),
            gust_deviation_m_s: profile.turbulence_intensity * speed * gusts,
        }
    }
}
