//! The wind of a seed along the timeline: how far the air has come, and how fast it goes.
//!
//! Between the starts and ends of changes the mean wind is one polynomial of time, which eight points of Gauss and
//! Legendre integrate exactly while at most five changes overlap; gusts and wander are integrated in closed form.
//! Nothing is stepped: any time costs the same, and what is carried over ended changes is the same for any sequence of
//! updates.

use glam::DVec2;

use super::gusts::{GustStretch, Gusts, Stir};
use crate::{
    numerics::GAUSS_8_HALF,
    weather::{Conditions, Timeline, WindProfile, timeline::Change},
};

/// The wind of a seed. Plain data, any thread.
#[derive(Clone, Debug, PartialEq)]
pub struct Wind {
    gusts: Gusts,
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

/// How far the air at 10 m has come at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// The moment, s.
    pub time_s: f64,
    /// Integral of the mean speed since time 0, m: the way along which gusts pass.
    pub path_m: f64,
    /// Integral of the velocity since time 0, m (east, north).
    pub displacement_m: DVec2,
}

/// The wind at 10 m at a moment. Velocities in m/s (east, north).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blowing {
    /// How far the air has come.
    pub drift: Drift,
    /// The mean wind, as the conditions have it.
    pub mean_m_s: DVec2,
    /// Change of the mean by the wandering direction.
    pub turned_m_s: DVec2,
    /// Velocity that gusts add.
    pub gust_m_s: DVec2,
}

impl Drift {
    /// Time 0.
    pub const ZERO: Self = Self { time_s: 0.0, path_m: 0.0, displacement_m: DVec2::ZERO };

    /// At the end of the last change that the timeline will have forgotten once it has advanced to `now_s`: what must
    /// be kept beside it. To be asked before it advances.
    pub fn kept(self, wind: &Wind, timeline: &Timeline, now_s: f64) -> Self {
        timeline.ends_before(now_s).map_or(self, |end_s| wind.blowing(timeline, self, end_s).drift)
    }
}

/// Goes along a timeline from one start or end of a change to the next.
struct Walk<'a> {
    gusts: &'a Gusts,
    base: WindProfile,
    changes: &'a [Change],
    at: Drift,
    stir: Stir,
}

fn mean(wind: &WindProfile) -> DVec2 {
    DVec2::new(wind.east_m_s, wind.north_m_s)
}

fn stir_of(wind: &WindProfile) -> Stir {
    Stir::new(mean(wind).normalize_or_zero(), wind.turbulence_intensity, wind.wander_deg.to_radians())
}

impl<'a> Walk<'a> {
    /// From `kept`, which belongs to what the timeline has forgotten, towards `t`.
    pub fn new(gusts: &'a Gusts, timeline: &'a Timeline, kept: Drift, t: f64) -> Self {
        let (Conditions { wind, .. }, changes) = timeline.parts();
        let mut walk = Self { gusts, base: *wind, changes, at: kept, stir: stir_of(wind) };
        // Counting begins at time 0, wherever the changes do.
        match changes.first() {
            Some(first) if timeline.known_since_ever() && t < first.start_s => walk.changes = &[],
            Some(first) if timeline.known_since_ever() && first.start_s < kept.time_s => {
                walk.at = walk.steady(first.start_s).0.drift;
            }
            _ => {}
        }
        walk.drop_ended();
        walk.stir = walk.stir_now();
        walk
    }

    /// Leaves behind what has ended, as the timeline does; whether anything has.
    fn drop_ended(&mut self) -> bool {
        let now = self.at.time_s;
        let ended = self.changes.iter().rposition(|c| c.start_s <= now && c.end_s() <= now);
        if let Some(i) = ended {
            self.base = self.changes[i].to.wind;
            self.changes = &self.changes[i + 1..];
        }
        ended.is_some()
    }

    fn stir_now(&self) -> Stir {
        stir_of(&self.wind_at(self.active(), self.at.time_s).0)
    }

    /// Changes that are under way.
    fn active(&self) -> &'a [Change] {
        let count = self.changes.iter().take_while(|c| c.start_s <= self.at.time_s).count();
        &self.changes[..count]
    }

    /// When the next of the `active` changes is over, s.
    fn next_end(active: &[Change]) -> f64 {
        active.iter().map(Change::end_s).fold(f64::INFINITY, f64::min)
    }

    /// The mean wind at `t` under the `active` changes, and the mean of their speeds: what carries gusts does not rest
    /// while the wind turns.
    fn wind_at(&self, active: &[Change], t: f64) -> (WindProfile, f64) {
        active.iter().fold((self.base, self.base.speed_m_s()), |(wind, speed), change| {
            let share = change.share(t);
            let to = &change.to.wind;
            (wind.blend(to, share), speed + (to.speed_m_s() - speed) * share)
        })
    }

    /// Integrals of the mean velocity and of the mean speed over time.
    fn integrals(&self, active: &[Change], from_s: f64, to_s: f64) -> (DVec2, f64) {
        let (middle, half) = (0.5 * (from_s + to_s), 0.5 * (to_s - from_s));
        GAUSS_8_HALF.iter().fold((DVec2::ZERO, 0.0), |(way, path), &(x, weight)| {
            let [(a, va), (b, vb)] = [-x, x].map(|x| self.wind_at(active, middle + half * x));
            (way + (mean(&a) + mean(&b)) * (half * weight), path + (va + vb) * (half * weight))
        })
    }

    /// The wind at `t` if nothing changes between now and then.
    fn steady(&self, t: f64) -> (Blowing, Stir) {
        let (time, speed) = (t - self.at.time_s, self.base.speed_m_s());
        let stretch = GustStretch { start_m: self.at.path_m, length_m: 0.0, from: self.stir, to: self.stir };
        self.blown((mean(&self.base) * time, speed * time), (mean(&self.base), speed), &stretch, t)
    }

    /// The wind at `t` while the `active` changes are under way, none of which is over before `end_s`.
    ///
    /// The stirring goes evenly along the path to what it will be at that end. It must not look at changes that begin
    /// before it: they may not have been told yet.
    fn changing(&self, active: &[Change], end_s: f64, t: f64) -> (Blowing, Stir) {
        let from = self.at.time_s;
        let stretch = GustStretch {
            start_m: self.at.path_m,
            length_m: self.integrals(active, from, end_s).1,
            from: self.stir,
            to: stir_of(&self.wind_at(active, end_s).0),
        };
        let (wind, speed) = self.wind_at(active, t);
        self.blown(self.integrals(active, from, t), (mean(&wind), speed), &stretch, t)
    }

    fn blown(
        &self,
        (way, path): (DVec2, f64),
        (wind, speed): (DVec2, f64),
        stretch: &GustStretch,
        t: f64,
    ) -> (Blowing, Stir) {
        let stirred = self.gusts.over(stretch, path);
        let displacement_m = self.at.displacement_m + way + stirred.way_m;
        let drift = Drift { time_s: t, path_m: self.at.path_m + path, displacement_m };
        let (turned_m_s, gust_m_s) = (stirred.turned * speed, stirred.gust * speed);
        (Blowing { drift, mean_m_s: wind, turned_m_s, gust_m_s }, stretch.stir_after(path))
    }

    /// The wind at `t`, not before what the timeline knows.
    pub fn blowing(mut self, t: f64) -> Blowing {
        loop {
            let active = self.active();
            let end = Self::next_end(active);
            let start = self.changes.get(active.len()).map_or(f64::INFINITY, |c| c.start_s);
            let next = end.min(start);
            let stop = if next <= t { next } else { t };
            let (blowing, stir) = if active.is_empty() { self.steady(stop) } else { self.changing(active, end, stop) };
            if next > t {
                return blowing;
            }
            self.at = blowing.drift;
            self.stir = stir;
            if self.drop_ended() {
                self.stir = self.stir_now();
            }
        }
    }
}
