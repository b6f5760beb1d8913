//! Advancing time: at once for everything that is a function of time, step by step for simulated state.
//!
//! Steps that an update leaves for a later call run with the host's settings as they were when that update was called.
//! The state therefore does not depend on the number of calls.

use std::time::{Duration, Instant};

use super::shared_world::Context;
use crate::{
    error::{Error, Result, Status, check_range, number},
    weather::timeline::MAX_TIME_S,
    world::UpdateBudget,
};

/// Time limit of each call of [`Context::update_within`] by [`Context::update`], which repeats the call until no steps
/// remain.
pub(crate) const UPDATE_TIME: Duration = Duration::from_millis(50);

impl Context {
    /// Advances simulation time to `time_s`, [-1e10, 1e10], and all state with it, however long that takes. A leap of a
    /// day takes some seconds with the largest terrain and
    /// [`GroundModel::Simulated`](crate::ground::GroundModel::Simulated); [`Context::update_within`] can spread them
    /// over several calls. The same time again changes nothing.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] if the time is not finite or out of range, [`Status::WrongOrder`] if it lies before
    /// the present; the state stays as it was.
    pub fn update(&mut self, time_s: f64) -> Result<()> {
        while self.update_within(time_s, UPDATE_TIME)? == Status::Pending {}
        Ok(())
    }

    /// Advances time as [`Context::update`] does, but runs steps of simulated states only for about as long as `most`:
    /// at least one step, or for terrain in tiles a part of one. [`Status::Pending`] says that steps remain: call this
    /// function again with the same time, now or after a frame, until it returns [`Status::Ok`].
    ///
    /// Until then weather and light are those of the new time, simulated water and snow are those of
    /// [`Context::state_time_s`], and a call with a later time first runs the remaining steps. Time advances only when
    /// no steps remain. Settings made meanwhile take effect after the remaining steps. The state is therefore the same
    /// for any `most`, and it can be saved only after the last step ([`Context::save`]).
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
        if self.behind.is_some() && self.advance(UpdateBudget { until_s: now, begun, most })? == Status::Pending {
            return Ok(Status::Pending);
        }
        self.world.keep_carried(time_s)?;
        let world = &self.world;
        self.held.each().into_iter().try_for_each(|effect| effect.begin(world, time_s))?;
        self.world.time_s = time_s;
        self.advance(UpdateBudget { until_s: time_s, begun, most })
    }

    /// Whether an update has left steps for a later call.
    pub(crate) fn is_behind(&self) -> bool {
        self.behind.is_some()
    }

    /// Advances all state towards the present, as far as the budget allows.
    fn advance(&mut self, budget: UpdateBudget) -> Result<Status> {
        let advanced = self.advance_steps(budget)?;
        // The timeline forgets ended changes, except those that the next steps need.
        let stepped = self.held.all().into_iter().filter_map(|effect| effect.stepped_to_s());
        let keep_s = stepped.fold(self.world.time_s, f64::min);
        self.world.forget_before(keep_s);
        self.refresh()?;
        Ok(advanced)
    }

    /// Advances the effects to the present, or until the budget is used up, by at least one step. Returns
    /// [`Status::Ok`] if they reached the present.
    fn advance_steps(&mut self, budget: UpdateBudget) -> Result<Status> {
        let mut behind = self.behind.take();
        if let Some(then) = &mut behind {
            std::mem::swap(&mut self.world.set, then);
        }
        let mut until_s = f64::NEG_INFINITY;
        let advanced = loop {
            until_s = self.next_stop_s(until_s, budget.until_s);
            let advanced = self.advance_each(UpdateBudget { until_s, ..budget });
            if advanced != Ok(Status::Ok) || until_s >= budget.until_s {
                break advanced;
            }
        };
        match (&mut behind, &advanced) {
            (Some(then), _) => std::mem::swap(&mut self.world.set, then),
            (None, Ok(Status::Pending)) => behind = Some(Box::new(self.world.set.clone())),
            (None, _) => {}
        }
        if advanced == Ok(Status::Ok) {
            self.settle();
        } else {
            self.behind = behind;
        }
        advanced
    }

    /// Returns the simulation time, s, up to which the effects advance together: the end of the next step that reads
    /// another effect's published state. If no such state changes, `last_s`.
    fn next_stop_s(&self, before_s: f64, last_s: f64) -> f64 {
        let held = self.held.all();
        if !held.iter().any(|effect| effect.changes_until(&self.world)) {
            return last_s;
        }
        let ends = held.iter().filter_map(|effect| effect.reads_next_s()).filter(|end_s| *end_s > before_s);
        ends.fold(last_s, f64::min)
    }

    /// Advances each effect in turn, as far as the budget allows.
    fn advance_each(&mut self, budget: UpdateBudget) -> Result<Status> {
        let mut advanced = Ok(Status::Ok);
        for effect in self.held.each() {
            let reached = effect.advance(&self.world, budget);
            effect.publish(&mut self.world);
            match reached {
                Ok(Status::Ok) => {}
                // Later effects read the published state of this one. They must not depend on how far it gets in one
                // call.
                Ok(status) => return Ok(status),
                fault => advanced = fault,
            }
        }
        advanced
    }

    /// Lets each effect apply the settings that the host has made since its last step and that are part of its state.
    /// While steps of an update remain, this does nothing; the last step calls it.
    pub(crate) fn settle(&mut self) {
        if self.behind.is_some() {
            return;
        }
        for effect in self.held.each() {
            effect.settle(&self.world);
            effect.publish(&mut self.world);
        }
    }

    /// Returns the simulation time of the simulated state, s: the present, or an earlier time as long as steps of
    /// [`Context::update_within`] remain. Without simulated state it is the present.
    pub fn state_time_s(&self) -> f64 {
        let stepped = self.held.all().into_iter().filter_map(|effect| effect.stepped_to_s());
        match &self.behind {
            Some(_) => stepped.fold(self.world.time_s, f64::min),
            None => self.world.time_s,
        }
    }
}
