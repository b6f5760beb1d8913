//! Moving time: at once for all that is a function of it, step by step for what has state.
//!
//! What an update leaves for another call is done under what the host had set when it was called, so that a state
//! does not depend on how many calls it took.

use std::time::{Duration, Instant};

use super::shared_world::Context;
use crate::{
    error::{Error, Result, Status, check_range, number},
    weather::timeline::MAX_TIME_S,
    world::Within,
};

/// Steps that one update does in one go before it looks whether more remain.
pub(crate) const UPDATE_TIME: Duration = Duration::from_millis(50);

impl Context {
    /// Moves simulation time to `time_s`, [-1e10, 1e10], and all state with it, however long that takes: with
    /// [`GroundModel::Simulated`](crate::ground::GroundModel::Simulated) and the largest terrain some seconds after a
    /// leap of a day ([`Context::update_within`] takes its time by parts). The same time again changes nothing.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] if it is not finite or out of range, [`Status::WrongOrder`] if it lies before the
    /// present; the state stays as it was.
    pub fn update(&mut self, time_s: f64) -> Result<()> {
        while self.update_within(time_s, UPDATE_TIME)? == Status::Pending {}
        Ok(())
    }

    /// As [`Context::update`], with steps of the simulated ground for about as long as `most`, one at least, or of a
    /// terrain in tiles a part of one. [`Status::Pending`] says that steps remain: call it again with the same time,
    /// now or after a frame, until it answers [`Status::Ok`].
    ///
    /// Until then weather and light are of the new time, water is shown and answered as of [`Context::state_time_s`],
    /// and a time that is later still is not taken. What is set meanwhile acts after the steps that remain. So the
    /// state is the same for any `most`, and there is none to save until the last step is done ([`Context::save`]).
    ///
    /// # Errors
    /// As [`Context::update`].
    pub fn update_within(&mut self, time_s: f64, most: Duration) -> Result<Status> {
        let begun = Instant::now();
        check_range("time_s", time_s, -MAX_TIME_S, MAX_TIME_S, "s")?;
        let now = self.world.time_s;
        if time_s < now {
            return Err(Error::new(
                Status::WrongOrder,
                format!("time_s must be at least {} s, got {}", number(now), number(time_s)),
            ));
        }
        if self.behind.is_some() && self.lead(Within { until_s: now, begun, most })? == Status::Pending {
            return Ok(Status::Pending);
        }
        self.world.keep_carried(time_s)?;
        let world = &self.world;
        self.held.each().into_iter().try_for_each(|effect| effect.begin(world, time_s))?;
        self.world.time_s = time_s;
        self.lead(Within { until_s: time_s, begun, most })
    }

    /// Whether an update has left steps for another call.
    pub(crate) fn is_behind(&self) -> bool {
        self.behind.is_some()
    }

    /// Leads all state after the present, as far as the time reaches.
    fn lead(&mut self, budget: Within) -> Result<Status> {
        let led = self.lead_steps(budget)?;
        // What has ended is forgotten, but for what the next step asks.
        let stepped = self.held.all().into_iter().filter_map(|effect| effect.stepped_to_s());
        let keep_s = stepped.fold(self.world.time_s, f64::min);
        self.world.forget_before(keep_s);
        self.refresh()?;
        Ok(led)
    }

    /// Leads the effects on until the present, or until the time is over: one step at least. Says whether they got
    /// there.
    fn lead_steps(&mut self, budget: Within) -> Result<Status> {
        let mut behind = self.behind.take();
        if let Some(then) = &mut behind {
            std::mem::swap(&mut self.world.set, then);
        }
        let mut until_s = self.next_stop_s(f64::NEG_INFINITY, budget.until_s);
        let mut led = self.lead_each(Within { until_s, ..budget });
        while led == Ok(Status::Ok) && until_s < budget.until_s {
            until_s = self.next_stop_s(until_s, budget.until_s);
            led = self.lead_each(Within { until_s, ..budget });
        }
        match (&mut behind, &led) {
            (Some(then), _) => std::mem::swap(&mut self.world.set, then),
            (None, Ok(Status::Pending)) => behind = Some(Box::new(self.world.set.clone())),
            (None, _) => {}
        }
        if led == Ok(Status::Ok) {
            self.settle();
        } else {
            self.behind = behind;
        }
        led
    }

    /// Simulation time, s, until which the effects are led together: the end of the next step that reads what another
    /// publishes, while that changes. Where it does not, `last_s`.
    fn next_stop_s(&self, before_s: f64, last_s: f64) -> f64 {
        let held = self.held.all();
        if !held.iter().any(|effect| effect.changes_until(&self.world)) {
            return last_s;
        }
        let ends = held.iter().filter_map(|effect| effect.reads_next_s()).filter(|end_s| *end_s > before_s);
        ends.fold(last_s, f64::min)
    }

    /// Leads each effect on in turn, as far as the time allows.
    fn lead_each(&mut self, budget: Within) -> Result<Status> {
        let mut led = Ok(Status::Ok);
        for effect in self.held.each() {
            let led_to = effect.lead(&self.world, budget);
            effect.publish(&mut self.world);
            match led_to {
                Ok(Status::Ok) => {}
                // Those after it read what it publishes: how far it gets in a call must not show in them.
                Ok(status) => return Ok(status),
                fault => led = fault,
            }
        }
        led
    }

    /// Lets the effects take what the host has set since their last step, as far as it is a part of their state. While
    /// steps of an update remain it waits for the last of them.
    pub(crate) fn settle(&mut self) {
        if self.behind.is_some() {
            return;
        }
        for effect in self.held.each() {
            effect.settle(&self.world);
            effect.publish(&mut self.world);
        }
    }

    /// Simulation time of what is simulated, s: the present, or earlier as long as [`Context::update_within`] answers
    /// that steps remain. The present if nothing is simulated.
    pub fn state_time_s(&self) -> f64 {
        let stepped = self.held.all().into_iter().filter_map(|effect| effect.stepped_to_s());
        match &self.behind {
            Some(_) => stepped.fold(self.world.time_s, f64::min),
            None => self.world.time_s,
        }
    }
}
