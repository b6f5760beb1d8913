//! The wind over a timeline, and what it has carried up to a moment.

use glam::DVec3;

use super::{Blowing, Drift, Wind};
use crate::weather::Timeline;

/// The wind of a seed over a timeline of weathers.
#[derive(Clone, Copy)]
pub(crate) struct WindOver<'a> {
    pub wind: &'a Wind,
    pub timeline: &'a Timeline,
    /// How far it had carried the air when the last change ended that the timeline has forgotten.
    pub kept: Drift,
}

impl<'a> WindOver<'a> {
    /// The wind at 10 m at a time that the timeline knows, and how far it has carried the air since time 0.
    pub fn at(&self, time_s: f64) -> Blowing {
        self.wind.blowing(self.timeline, self.kept, time_s)
    }

    /// The wind that carries the air, up to a moment.
    pub fn carrying_until(self, time_s: f64) -> Carrying<'a> {
        Carrying { over: self, time_s, now: self.at(time_s) }
    }
}

/// The wind that carries the air, up to a moment: worked out once for all that asks since when.
#[derive(Clone, Copy)]
pub(crate) struct Carrying<'a> {
    over: WindOver<'a>,
    time_s: f64,
    now: Blowing,
}

impl Carrying<'_> {
    /// How far it has carried the air since time 0, m (east, north, up).
    pub fn displacement_m(&self) -> DVec3 {
        self.now.drift.displacement_m.extend(0.0)
    }

    /// Velocity at 10 m with gusts, of which the displacement is the integral, m/s.
    pub fn velocity_m_s(&self) -> DVec3 {
        self.now.velocity_m_s().extend(0.0)
    }

    /// How far the wind has carried the air since a moment, m, and before what the timeline knows with the wind of its first one.
    pub fn since(&self, from_s: f64) -> DVec3 {
        let known_s = from_s.max(self.over.timeline.known_from_s()).min(self.time_s);
        let first = self.over.at(known_s);
        let since = self.now.drift.displacement_m - first.drift.displacement_m;
        (since + first.velocity_m_s() * (known_s - from_s)).extend(0.0)
    }
}
