//! Wind field of a context: it is set for a simulation time, stepped to multiples of its step's length, published to
//! all readers of the wind, saved and loaded.

use serde::{Deserialize, Serialize};

use super::{
    desc::{FieldChange, WindFieldDesc, WindFieldReport},
    live::{LEAP_S, Live, step_s},
    saved::{SavedChange, SavedField},
};
use crate::{
    error::{Error, Result, Status, check_range},
    weather::timeline::MAX_TIME_S,
    wind::WindVolume,
    world::{HeldEffect, UpdateBudget, World, parse_error},
};

/// Largest number of entries of [`HeldFlow::changes`]: the change in force and those to come.
const MAX_CHANGES: usize = 64;
/// Key of the field in a saved state.
const KEY: &str = "wind_field";

/// Wind field of a context, if the host asked for one.
#[derive(Default)]
pub(crate) struct HeldFlow {
    /// Changes in order of time. The first one is in force once its time has come.
    pub(super) changes: Vec<FieldChange>,
    /// Present field; `None` if there is none at this time.
    pub(super) live: Option<Box<Live>>,
    /// Whether the wind that the world reads is the field's present wind.
    is_shown: bool,
}

/// Saved form of the field and its changes.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedFlow {
    /// Changes in order of time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    changes: Vec<SavedChange>,
    /// Present field, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    field: Option<SavedField>,
}

impl HeldFlow {
    /// Sets or ends the field at a time; see [`Context::set_wind_field`](crate::context::Context::set_wind_field).
    ///
    /// # Errors
    /// Errors of `Context::set_wind_field`; nothing changes then.
    pub fn set(&mut self, world: &World, desc: Option<WindFieldDesc>, start_s: f64) -> Result<()> {
        if let Some(desc) = &desc {
            desc.validate()?;
            world.frame.place_at("wind_field.floor_center_m", desc.floor_center)?;
        }
        check_range("start_time_s", start_s, -MAX_TIME_S, MAX_TIME_S, "s")?;
        let earliest = self.changes.last().map_or(world.time_s, |c| c.start_s.max(world.time_s));
        if start_s < earliest {
            let rest = format!("must not lie before the last update or change at {earliest} s, got {start_s}");
            return Err(Error::about(Status::WrongOrder, "start_time_s", rest));
        }
        if self.changes.last().is_some_and(|c| c.start_s == start_s) {
            self.changes.pop();
        }
        if self.changes.len() >= MAX_CHANGES {
            let wanted = format!("one of at most {MAX_CHANGES} changes to come");
            return Err(Error::range("wind_field", &wanted, "one more"));
        }
        self.changes.push(FieldChange { start_s, desc });
        Ok(())
    }

    /// Returns the state of the field; `None` without a field and until the field's start is complete.
    pub fn report(&self) -> Option<WindFieldReport> {
        self.live.as_ref().filter(|live| live.start.is_none()).map(|live| live.report())
    }

    /// Returns the description in force at a time.
    fn at(&self, time_s: f64) -> Option<WindFieldDesc> {
        self.changes.iter().rfind(|c| c.start_s <= time_s)?.desc
    }

    /// Removes changes that later ones have superseded by a time.
    fn forget(&mut self, time_s: f64) {
        if let Some(last) = self.changes.iter().rposition(|c| c.start_s <= time_s) {
            self.changes.drain(..last);
        }
        if let [FieldChange { start_s, desc: None }] = self.changes[..]
            && start_s <= time_s
        {
            self.changes.clear();
        }
    }

    /// Begins a field if one is due by now. Returns whether it has begun one.
    fn begin_field(&mut self, world: &World) -> Result<bool> {
        let now = world.time_s;
        let come = self.changes.iter().filter(|c| c.start_s <= now);
        let last = come.clone().next_back().map(|c| c.start_s);
        let wanted = |c: &&FieldChange| now - c.start_s <= LEAP_S || Some(c.start_s) == last;
        let Some((desc, start_s)) = come.filter(wanted).find_map(|c| Some((c.desc?, c.start_s))) else {
            return Ok(false);
        };
        let step_s = step_s(desc.mode);
        let first_s = if now - start_s > LEAP_S { now.div_euclid(step_s) } else { (start_s / step_s).ceil() } * step_s;
        if first_s > now {
            return Ok(false);
        }
        self.live = Some(Box::new(Live::new(world, desc, first_s)?));
        Ok(true)
    }

    /// Does the next piece of work that is due by `until_s`. Returns whether any was due.
    fn go_on(&mut self, world: &World, until_s: f64) -> Result<bool> {
        let Some(mut live) = self.live.take() else { return self.begin_field(world) };
        let outcome = self.advance_live(&mut live, world, until_s);
        if matches!(outcome, Ok(StepOutcome::Changed)) {
            live.shown_over = live.wind_over(world);
        }
        if !matches!(outcome, Ok(StepOutcome::Gone)) {
            self.live = Some(live);
        }
        match outcome? {
            StepOutcome::Rests => Ok(false),
            StepOutcome::Unchanged => Ok(true),
            StepOutcome::Changed | StepOutcome::Gone => {
                self.is_shown = false;
                Ok(true)
            }
        }
    }

    /// Does the next piece of work on a field. A change of the description may move, restart or end the field.
    fn advance_live(&mut self, live: &mut Live, world: &World, until_s: f64) -> Result<StepOutcome> {
        let changed = |is_over: bool| if is_over { StepOutcome::Changed } else { StepOutcome::Unchanged };
        if live.start.is_some() {
            return live.go_on_with_start(world).map(changed);
        }
        if live.is_left_behind(world.time_s) {
            let Some(desc) = self.at(world.time_s) else { return Ok(StepOutcome::Gone) };
            let step_s = step_s(desc.mode);
            *live = Live::new(world, desc, world.time_s.div_euclid(step_s) * step_s)?;
            return Ok(StepOutcome::Unchanged);
        }
        if live.parts.0 > 0 {
            return live.step_part().map(changed);
        }
        if live.next_s() > until_s {
            return Ok(StepOutcome::Rests);
        }
        let Some(desc) = self.at(live.time_s) else {
            self.forget(live.time_s);
            return Ok(StepOutcome::Gone);
        };
        self.forget(live.time_s);
        if !desc.is_like(&live.desc) {
            let step_s = step_s(desc.mode);
            let first_s = (live.time_s / step_s).ceil() * step_s;
            if first_s > until_s {
                return Ok(StepOutcome::Rests);
            }
            *live = Live::new(world, desc, first_s)?;
            return Ok(StepOutcome::Unchanged);
        }
        if live.follow(world, &desc)? {
            live.restart(world, live.time_s)?;
            return Ok(StepOutcome::Unchanged);
        }
        live.begin_step(world)?;
        Ok(StepOutcome::Unchanged)
    }

    /// Removes the field from a saved state and returns it.
    ///
    /// # Errors
    /// [`Status::Parse`] for values that cannot be a field of this context.
    pub fn read(world: &World, state: &mut toml::Table) -> Result<Self> {
        let Some(value) = state.remove(KEY) else { return Ok(Self::default()) };
        let saved: SavedFlow = value.try_into().map_err(|e| parse_error(format_args!("{KEY}: {e}")))?;
        let of_state = |e: Error| e.with_status(Status::Parse).found_in("saved state");
        let changes = saved.changes.iter().map(|c| c.change().map_err(of_state)).collect::<Result<Vec<_>>>()?;
        if !changes.iter().is_sorted_by(|a, b| a.start_s < b.start_s) || changes.len() > MAX_CHANGES {
            return Err(parse_error("wind_field.changes must be in order of time"));
        }
        let live = saved.field.map(|field| field.live(world).map(Box::new).map_err(of_state)).transpose()?;
        Ok(Self { changes, live, is_shown: false })
    }

    /// Activates a loaded field; `other` then holds the previous one.
    pub fn swap_in(&mut self, world: &mut World, other: &mut Self) {
        std::mem::swap(self, other);
        (self.is_shown, other.is_shown) = (false, false);
        self.publish(world);
    }
}

/// Outcome of one piece of work.
enum StepOutcome {
    /// Nothing is left to do.
    Rests,
    /// The field that others read is unchanged.
    Unchanged,
    /// The field that others read has changed.
    Changed,
    /// The field has ended.
    Gone,
}

impl HeldEffect for HeldFlow {
    fn advance(&mut self, world: &World, budget: UpdateBudget) -> Result<Status> {
        while self.go_on(world, budget.until_s)? {
            if budget.begun.elapsed() >= budget.most {
                return Ok(Status::Pending);
            }
        }
        Ok(Status::Ok)
    }

    fn changes_until(&self, world: &World) -> bool {
        self.live.as_ref().is_some_and(|live| !live.is_left_behind(world.time_s))
    }

    fn publish(&mut self, world: &mut World) {
        let is_ready = |live: &Live| live.start.is_none() && live.parts.0 == 0;
        if self.is_shown {
            // A field that rests keeps its wind, but its time moves on.
            if let (Some(live), Some(volume)) =
                (self.live.as_ref().filter(|live| is_ready(live)), &mut world.solved_wind)
            {
                volume.holds_s = Some(live.holds_s());
            }
            return;
        }
        match &self.live {
            Some(live) if is_ready(live) => {
                let mut volume = world.solved_wind.take().unwrap_or_else(|| Box::new(WindVolume::empty()));
                live.publish(world, &mut volume);
                world.solved_wind = Some(volume);
                self.is_shown = true;
            }
            // Until a start or a step is complete, the wind that was published before stays.
            Some(_) => {}
            None => {
                world.solved_wind = None;
                self.is_shown = true;
            }
        }
    }

    fn stepped_to_s(&self) -> Option<f64> {
        self.live.as_ref().map(|live| live.time_s)
    }

    fn save(&self, state: &mut toml::Table) -> Result<()> {
        if self.changes.is_empty() && self.live.is_none() {
            return Ok(());
        }
        let saved = SavedFlow {
            changes: self.changes.iter().map(SavedChange::of).collect(),
            field: self.live.as_deref().map(SavedField::of),
        };
        let written = |e| Error::new(Status::Internal, format!("the state cannot be written: {e}"));
        state.insert(KEY.into(), toml::Value::try_from(saved).map_err(written)?);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
