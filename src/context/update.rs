//! Moving time: at once for all that is a function of it, step by step for what has state.
//!
//! What an update leaves for another call is done under what the host had set when it was called ([`Behind`]), so that a state
//! does not depend on how many calls it took.

use std::time::{Duration, Instant};

use super::{Context, GivenDirection, MAX_TIME_S};
use crate::{
    error::{Error, Result, Status, check_range},
    fog::Law,
    moment::Region,
    rain::Shelter,
    sky::sun::Utc,
};

/// Steps that one update does in one go before it looks whether more remain.
pub(crate) const UPDATE_TIME: Duration = Duration::from_millis(50);

/// What decides the steps that an update has left for another call: all as it was when the update was called.
pub(super) struct Behind {
    shelters: Vec<Shelter>,
    areas: Vec<Region>,
    given: [Option<GivenDirection>; 2],
    fog_law: Option<Law>,
    utc_at_zero: Utc,
    /// A terrain that was set since then has no part in the steps before this, s.
    pub terrain_from_s: f64,
}

impl Context {
    /// Moves simulation time to `time_s`, [-1e10, 1e10], and all state with it, however long that takes: with
    /// [`GroundModel::Simulated`](super::GroundModel::Simulated) and the largest terrain some seconds after a leap of a day ([`Context::update_within`] takes its
    /// time by parts). The same time again changes nothing.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] if it is not finite or out of range, [`Status::WrongOrder`] if it lies before the
    /// present; the state stays as it was.
    pub fn update(&mut self, time_s: f64) -> Result<()> {
        while self.update_within(time_s, UPDATE_TIME)? == Status::Pending {}
        Ok(())
    }

    /// As [`Context::update`], with steps of the simulated ground for about as long as `most`, one at least. [`Status::Pending`]
    /// says that steps remain: call it again with the same time, now or after a frame, until it answers [`Status::Ok`].
    ///
    /// Until then weather and light are of the new time, water is shown and answered as of [`Context::state_time_s`], and a time
    /// that is later still is not taken. What is set meanwhile acts after the steps that remain. So the state is the same for any
    /// `most`, and there is none to save until the last step is done ([`Context::save`]).
    ///
    /// # Errors
    /// As [`Context::update`].
    pub fn update_within(&mut self, time_s: f64, most: Duration) -> Result<Status> {
        let begun = Instant::now();
        check_range("time_s", time_s, -MAX_TIME_S, MAX_TIME_S, "s")?;
        if time_s < self.time_s {
            let now = self.time_s;
            return Err(Error::new(Status::WrongOrder, format!("time_s must be at least {now} s, got {time_s}")));
        }
        if self.behind.is_some() && self.follow(begun, most)? == Status::Pending {
            return Ok(Status::Pending);
        }
        self.keep_carried(time_s)?;
        self.begin_ground(time_s)?;
        self.time_s = time_s;
        self.follow(begun, most)
    }

    /// Leads all state after the present, as far as `most` since `begun` reaches.
    fn follow(&mut self, begun: Instant, most: Duration) -> Result<Status> {
        let led = self.follow_ground(begun, most)?;
        // What has ended is forgotten, but for what the next step asks.
        let keep_s = self.stepped_to_s();
        self.drifted = self.drifted.kept(&self.wind, &self.timeline, keep_s);
        self.timeline.advance_keeping(self.time_s, keep_s);
        self.show_terrain()?;
        Ok(led)
    }

    /// Leads the simulated water on until the present, or until `most` is over: one step at least. Says whether it got there.
    pub(super) fn follow_ground(&mut self, begun: Instant, most: Duration) -> Result<Status> {
        let mut behind = self.behind.take();
        if let Some(then) = &mut behind {
            self.exchange(then);
        }
        let led = self.lead_ground(begun, most, behind.as_ref().map_or(f64::NEG_INFINITY, |b| b.terrain_from_s));
        match (&mut behind, &led) {
            (Some(then), _) => self.exchange(then),
            (None, Ok(Status::Pending)) => behind = Some(Box::new(self.as_set())),
            (None, _) => {}
        }
        if led != Ok(Status::Ok) {
            self.behind = behind;
        }
        led
    }

    /// What the host has set of all that decides a step.
    fn as_set(&self) -> Behind {
        Behind {
            shelters: self.shelters.clone(),
            areas: self.areas.clone(),
            given: [self.given_sun, self.given_moon],
            fog_law: self.fog_law,
            utc_at_zero: self.desc.utc_at_zero,
            terrain_from_s: f64::NEG_INFINITY,
        }
    }

    /// Puts what was set then in the place of what is set now, and back.
    fn exchange(&mut self, then: &mut Behind) {
        use std::mem::swap;
        let Behind { shelters, areas, given: [sun, moon], fog_law, utc_at_zero, terrain_from_s: _ } = then;
        swap(&mut self.shelters, shelters);
        swap(&mut self.areas, areas);
        swap(&mut self.given_sun, sun);
        swap(&mut self.given_moon, moon);
        swap(&mut self.fog_law, fog_law);
        swap(&mut self.desc.utc_at_zero, utc_at_zero);
    }
}
