//! The wind of a seed along the timeline: the displacement of the air, and its velocity.
//!
//! Between the starts and ends of changes the mean wind is one polynomial of time, which the Gauss-Legendre rule of 8
//! points integrates exactly while at most five changes overlap. Gusts and wander are integrated in closed form.
//! Nothing is stepped, so any time costs the same. The state that is kept when changes are forgotten is the same for
//! any sequence of updates.

use glam::DVec2;

use super::gusts::{GustStretch, Gusts, Stir};
use crate::{
    numerics::GAUSS_8_HALF,
    weather::{Conditions, Timeline, WindProfile, timeline::Change},
};

/// The wind of a seed. Plain data, any thread.
#[derive(Clone, Debug, PartialEq)]
pub struct Wind {
    /// Waves of the gusts.
    gusts: Gusts,
}

impl Wind {
    /// Creates the gusts that the seed defines.
    pub fn new(seed: u64) -> Self {
        Self { gusts: Gusts::new(seed) }
    }

    /// Returns the wind at 10 m at time `t`, s, which must not be before the time from which `timeline` is known.
    /// `kept` is the drift at the end of the last change that the timeline has forgotten ([`Drift::ZERO`] as long as it
    /// has forgotten none).
    pub fn blowing(&self, timeline: &Timeline, kept: Drift, t: f64) -> Blowing {
        Walk::new(&self.gusts, timeline, kept, t).blowing(t)
    }

    /// Returns the wind at 10 m at time `t`, s, of a weather that has always held.
    pub(crate) fn steady(&self, profile: &WindProfile, t: f64) -> Blowing {
        let stir = stir_of(profile);
        Walk { gusts: &self.gusts, base: *profile, changes: &[], at: Drift::ZERO, stir }.steady(t).0
    }
}

/// Displacement of the air at 10 m at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// Simulation time, s.
    pub time_s: f64,
    /// Integral of the mean speed since time 0, m: the path along which gusts pass.
    pub path_m: f64,
    /// Integral of the velocity since time 0, m (east, north).
    pub displacement_m: DVec2,
}

/// Wind at 10 m above ground at a time. Velocities in m/s (east, north).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blowing {
    /// Displacement of the air.
    pub drift: Drift,
    /// Mean wind of the conditions at that time.
    pub mean_m_s: DVec2,
    /// Change of the mean wind by its wandering direction.
    pub turned_m_s: DVec2,
    /// Velocity that gusts add.
    pub gust_m_s: DVec2,
}

impl Blowing {
    /// Returns the wind with its velocities multiplied by a share.
    pub(crate) fn shared(&self, share: f64) -> Self {
        Self {
            drift: self.drift,
            mean_m_s: self.mean_m_s * share,
            turned_m_s: self.turned_m_s * share,
            gust_m_s: self.gust_m_s * share,
        }
    }

    /// Returns the wind with the velocities of another one added.
    pub(crate) fn with(&self, other: &Self) -> Self {
        Self {
            drift: self.drift,
            mean_m_s: self.mean_m_s + other.mean_m_s,
            turned_m_s: self.turned_m_s + other.turned_m_s,
            gust_m_s: self.gust_m_s + other.gust_m_s,
        }
    }
}

impl Drift {
    /// Drift at time 0.
    pub const ZERO: Self = Self { time_s: 0.0, path_m: 0.0, displacement_m: DVec2::ZERO };

    /// Returns the drift at the end of the last change that the timeline will have forgotten once it has advanced to
    /// `now_s`. Call it before the timeline advances, and keep the drift with the timeline.
    pub fn kept(self, wind: &Wind, timeline: &Timeline, now_s: f64) -> Self {
        timeline.ends_before(now_s).map_or(self, |end_s| wind.blowing(timeline, self, end_s).drift)
    }
}

/// Steps along a timeline from one start or end of a change to the next.
struct Walk<'a> {
    /// Gusts of the seed.
    gusts: &'a Gusts,
    /// Mean wind before all of `changes`.
    base: WindProfile,
    /// Changes that have not ended at the walk's time.
    changes: &'a [Change],
    /// Drift at the walk's time.
    at: Drift,
    /// Turbulence at the walk's time.
    stir: Stir,
}

/// Returns the mean wind at 10 m, m/s (east, north).
fn mean(wind: &WindProfile) -> DVec2 {
    DVec2::new(wind.east_m_s, wind.north_m_s)
}

/// Returns the turbulence of a profile.
fn stir_of(wind: &WindProfile) -> Stir {
    Stir::new(mean(wind).normalize_or_zero(), wind.turbulence_intensity, wind.wander_deg.to_radians())
}

impl<'a> Walk<'a> {
    /// Starts at `kept`, the drift at the end of the last change that the timeline has forgotten, to go towards `t`.
    pub fn new(gusts: &'a Gusts, timeline: &'a Timeline, kept: Drift, t: f64) -> Self {
        let (Conditions { wind, .. }, changes) = timeline.parts();
        let mut walk = Self { gusts, base: *wind, changes, at: kept, stir: stir_of(wind) };
        // A timeline that has forgotten nothing may have changes before time 0. The walk then starts at the first of
        // them, with the drift that the steady wind before it has at that time.
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

    /// Drops changes that have ended, as the timeline does. Returns whether there were any.
    fn drop_ended(&mut self) -> bool {
        let now = self.at.time_s;
        let ended = self.changes.iter().rposition(|c| c.start_s <= now && c.end_s() <= now);
        if let Some(i) = ended {
            self.base = self.changes[i].to.wind;
            self.changes = &self.changes[i + 1..];
        }
        ended.is_some()
    }

    /// Returns the turbulence of the mean wind at the walk's time.
    fn stir_now(&self) -> Stir {
        stir_of(&self.wind_at(self.active(), self.at.time_s).0)
    }

    /// Returns the changes that are under way.
    fn active(&self) -> &'a [Change] {
        let count = self.changes.iter().take_while(|c| c.start_s <= self.at.time_s).count();
        &self.changes[..count]
    }

    /// Returns the time at which the next of the `active` changes ends, s.
    fn next_end(active: &[Change]) -> f64 {
        active.iter().map(Change::end_s).fold(f64::INFINITY, f64::min)
    }

    /// Returns the mean wind at `t` under the `active` changes, and the speed that results if the changes blend speeds
    /// instead of velocities. Gusts travel with this speed, which does not drop while the wind turns.
    fn wind_at(&self, active: &[Change], t: f64) -> (WindProfile, f64) {
        active.iter().fold((self.base, self.base.speed_m_s()), |(wind, speed), change| {
            let share = change.share(t);
            let to = &change.to.wind;
            (wind.blend(to, share), speed + (to.speed_m_s() - speed) * share)
        })
    }

    /// Returns the integrals of the mean velocity and of the mean speed over time.
    fn integrals(&self, active: &[Change], from_s: f64, to_s: f64) -> (DVec2, f64) {
        let (middle, half) = (0.5 * (from_s + to_s), 0.5 * (to_s - from_s));
        GAUSS_8_HALF.iter().fold((DVec2::ZERO, 0.0), |(way, path), &(x, weight)| {
            let [(a, va), (b, vb)] = [-x, x].map(|x| self.wind_at(active, middle + half * x));
            (way + (mean(&a) + mean(&b)) * (half * weight), path + (va + vb) * (half * weight))
        })
    }

    /// Returns the wind at `t` if nothing changes until then.
    fn steady(&self, t: f64) -> (Blowing, Stir) {
        let (time, speed) = (t - self.at.time_s, self.base.speed_m_s());
        let stretch = GustStretch { start_m: self.at.path_m, length_m: 0.0, from: self.stir, to: self.stir };
        self.blown((mean(&self.base) * time, speed * time), (mean(&self.base), speed), &stretch, t)
    }

    /// Returns the wind at `t` while the `active` changes are under way, none of which ends before `end_s`.
    ///
    /// The turbulence changes linearly along the path to its state at `end_s`. It must not depend on changes that begin
    /// before `end_s`, because the host may not have given them yet.
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

    /// Returns the wind after a part of the walk, with the turbulence there. `way` and `path` are the integrals of the
    /// mean velocity and of the mean speed over the part, `wind` and `speed` their values at its end, `t`.
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

    /// Returns the wind at `t`, which must not be before the time from which the timeline is known.
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
