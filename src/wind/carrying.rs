//! The wind over a timeline, and the displacement of the air by it.

use std::cell::{Cell, RefCell};

use glam::DVec3;

use super::{
    drift::{Blowing, Drift, Wind},
    layers::LayerDrifts,
};
use crate::weather::Timeline;

/// The wind of a seed over a timeline of weathers.
#[derive(Clone, Copy)]
pub(crate) struct WindOver<'a> {
    /// Wind of the seed.
    pub wind: &'a Wind,
    /// Weathers over time.
    pub timeline: &'a Timeline,
    /// Drift of the air at the end of the last change that the timeline has forgotten.
    pub kept: Drift,
    /// Drifts of the cloud layers at the end of the last change that the timeline has forgotten.
    pub kept_layers: &'a LayerDrifts,
    /// Revision of the timeline: no two contexts share one, and every change of the timeline makes a new one.
    pub revision: u64,
}

impl<'a> WindOver<'a> {
    /// Returns the wind at 10 m at a time that the timeline knows, with the displacement of the air since time 0.
    pub fn at(&self, time_s: f64) -> Blowing {
        self.wind.blowing(self.timeline, self.kept, time_s)
    }

    /// Returns the drifts of the cloud layers at a time that the timeline knows.
    pub fn layers_at(&self, time_s: f64) -> LayerDrifts {
        self.kept_layers.until(self.timeline, time_s)
    }

    /// Returns the wind that carries the air, from time 0 to a time.
    pub fn carrying_until(self, time_s: f64) -> Carrying<'a> {
        self.carrying_as(time_s, self.at(time_s))
    }

    /// Returns the wind that carries the air, from time 0 to a time at which the wind is `now`.
    pub fn carrying_as(self, time_s: f64, now: Blowing) -> Carrying<'a> {
        Carrying { over: self, time_s, now }
    }
}

/// The wind that carries the air up to a time, computed once for all queries with different starts.
#[derive(Clone, Copy)]
pub(crate) struct Carrying<'a> {
    /// Wind over the timeline.
    over: WindOver<'a>,
    /// End of the carrying, s of simulation time.
    time_s: f64,
    /// Wind at the end of the carrying.
    now: Blowing,
}

impl Carrying<'_> {
    /// Returns how far the wind has carried the air since time 0, m (east, north, up).
    pub fn displacement_m(&self) -> DVec3 {
        self.now.drift.displacement_m.extend(0.0)
    }

    /// Returns the velocity at 10 m with gusts, m/s. The displacement is its integral.
    pub fn velocity_m_s(&self) -> DVec3 {
        self.now.velocity_m_s().extend(0.0)
    }

    /// Returns how far the wind has carried the air since a time, m. Before the first time that the timeline knows, the
    /// wind of that first time is used.
    pub fn since(&self, from_s: f64, remembered: &Remembered) -> DVec3 {
        let known_s = from_s.max(self.over.timeline.known_from_s()).min(self.time_s);
        let first = remembered.at(&self.over, known_s);
        let since = self.now.drift.displacement_m - first.drift.displacement_m;
        (since + first.velocity_m_s() * (known_s - from_s)).extend(0.0)
    }
}

/// Number of times that are remembered: more than a frame asks for.
const REMEMBERED: usize = 16;

/// Cache of the wind at times that many frames ask for, valid until the timeline changes. Each entry saves a walk over
/// the timeline.
#[derive(Default)]
pub(crate) struct Remembered {
    /// Revision of the timeline for which the entries hold.
    revision: Cell<u64>,
    /// Winds with the bits of their times; if there is no room, the entries are overwritten in turn.
    winds: RefCell<Vec<(u64, Blowing)>>,
    /// Index of the entry that is overwritten next, modulo [`REMEMBERED`].
    next: Cell<usize>,
}

impl Remembered {
    /// Returns the wind at a time, from the cache or from the timeline.
    fn at(&self, wind: &WindOver<'_>, time_s: f64) -> Blowing {
        let mut winds = self.winds.borrow_mut();
        if self.revision.replace(wind.revision) != wind.revision {
            winds.clear();
        }
        if let Some((_, found)) = winds.iter().find(|(bits, _)| *bits == time_s.to_bits()) {
            return *found;
        }
        let found = wind.at(time_s);
        if winds.len() < REMEMBERED {
            let room = REMEMBERED - winds.len();
            winds.reserve_exact(room);
            winds.push((time_s.to_bits(), found));
        } else {
            let place = self.next.get() % REMEMBERED;
            winds[place] = (time_s.to_bits(), found);
            self.next.set(place + 1);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::weather::{Weather, derive};

    #[test]
    fn remembered_displacements_are_those_computed_anew_and_end_with_the_timeline() {
        let wind = Wind::new(7);
        let remembered = Remembered::default();
        let mut weather = Weather::default();
        for (revision, speed) in [(1, 4.0), (2, 11.0)] {
            weather.wind.speed_m_s = speed;
            let timeline = Timeline::new(derive(&weather).unwrap());
            let kept_layers = &LayerDrifts::ZERO;
            let over = WindOver { wind: &wind, timeline: &timeline, kept: Drift::ZERO, kept_layers, revision };
            // More times than there is room for, some of them repeated.
            for i in 0..40 {
                let time_s = f64::from(i % 23) * 1.5;
                assert_eq!(remembered.at(&over, time_s), over.at(time_s), "{revision} {i}");
            }
            assert_eq!(remembered.winds.borrow().len(), REMEMBERED);
        }
    }
}
