//! Wind at a height over the ground, `WindAt`: the profile of the mean, and the gusts about it.

use glam::{DVec2, DVec3};

use super::drift::Blowing;
use crate::weather::WindProfile;

/// Wind at a height, m/s (east, north, up).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindAt {
    /// With gusts, at this moment.
    pub velocity_m_s: DVec3,
    /// Mean over ten minutes.
    pub mean_m_s: DVec3,
    /// Standard deviation of gusts along the mean wind, m/s.
    pub gust_deviation_m_s: f64,
}

impl Blowing {
    /// Everything together, at 10 m: what the displacement is the integral of, m/s.
    pub fn velocity_m_s(&self) -> DVec2 {
        self.mean_m_s + self.turned_m_s + self.gust_m_s
    }

    /// The wind at `height_m` above ground under a `profile`.
    ///
    /// The mean follows [`WindProfile::mean_at_height_m_s`]; gusts are as strong at all heights (Panofsky and
    /// Dutton 1984) but where the mean falls below half of that at 10 m: there they die away with it.
    pub fn at_height(&self, profile: &WindProfile, height_m: f64) -> WindAt {
        let speed = profile.speed_m_s();
        let share = DVec2::from_array(profile.relative_at_height(height_m));
        let gusts = (2.0 * share.length()).min(1.0);
        let level = |v: DVec2| v.extend(0.0);
        WindAt {
            velocity_m_s: level(share.rotate(self.mean_m_s + self.turned_m_s) + self.gust_m_s * gusts),
            mean_m_s: level(share.rotate(self.mean_m_s)),
            gust_deviation_m_s: profile.turbulence_intensity * speed * gusts,
        }
    }
}
