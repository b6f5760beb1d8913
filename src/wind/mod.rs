//! Wind: a mean that the weather gives, gusts of a published spectrum about it, and how far it has carried the air.
//!
//! The mean follows the logarithmic profile over the ground's roughness up to 100 m, and above it turns and grows to
//! the geostrophic wind ([`WindProfile::mean_at_height_m_s`]); layers of cloud go with it (`layers`). Gusts are 24
//! waves along and 24 across the wind whose lengths are spread as Kaimal et al. (1972) found them, with the weather's
//! turbulence intensity along the wind and 0.8 of it across (IEC 61400-1, annex C); they pass along the path of the
//! mean wind (Taylor 1938), the same over all the world. Where a report says that the direction varies, a slow wave
//! turns the wind within that range.
//!
//! [`Wind`] and a [`Drift`] answer for any time of a timeline in closed form: velocity, and its integral, the
//! displacement. What the wind carries is moved by the displacement, never by velocity times time: then no change
//! throws it.

mod carrying;
mod detour;
mod drift;
mod grid;
mod gusts;
mod layers;
#[cfg(test)]
mod tests;
mod volume;

use glam::{DVec2, DVec3};

pub(crate) use carrying::{Carrying, Remembered, WindOver};
pub(crate) use detour::{DETOUR_SIDE, Detour, DetourMap};
use drift::Walk;
pub use drift::{Blowing, Drift};
pub use grid::{MAX_NODES, WindGrid, WindGridKind};
use gusts::Gusts;
pub(crate) use gusts::randoms;
pub(crate) use layers::{LayerDrift, LayerDrifts, stretch, stretch_toward};
pub(crate) use volume::WindVolume;

use crate::weather::{Timeline, WindProfile};

/// The wind of a seed. Plain data, any thread.
#[derive(Clone, Debug, PartialEq)]
pub struct Wind {
    gusts: Gusts,
}

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

impl Wind {
    /// The gusts that a seed decides.
    pub fn new(seed: u64) -> Self {
        Self { gusts: Gusts::new(seed) }
    }

    /// The wind at 10 m at time `t`, s, not before what `timeline` knows; `kept` is what was kept of that which it has
    /// forgotten ([`Drift::ZERO`] as long as that is nothing).
    pub fn blowing(&self, timeline: &Timeline, kept: Drift, t: f64) -> Blowing {
        Walk::new(&self.gusts, timeline, kept, t).blowing(t)
    }
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
