//! The interface of an effect that a context keeps: one with a state, or with settings that all views share.

use std::time::Instant;

use super::state::World;
use crate::error::{Error, Result, Status};

/// Simulation time to which states are led, the present at the latest, and how long the update that leads them may go
/// on since it began.
#[derive(Clone, Copy)]
pub(crate) struct Within {
    pub until_s: f64,
    pub begun: Instant,
    pub most: std::time::Duration,
}

/// State of an effect that a context holds for all its views. `src/effects.rs` lists them; a context leads, saves and
/// loads the list.
pub(crate) trait HeldEffect: std::any::Any {
    /// Makes ready to be led from the present to `time_s`.
    fn begin(&mut self, _world: &World, _time_s: f64) -> Result<()> {
        Ok(())
    }

    /// Leads the state on to `budget.until_s`, by steps of a grid that is anchored at time 0, or until the time is
    /// over: one step at least. Says whether it got there.
    fn lead(&mut self, _world: &World, _budget: Within) -> Result<Status> {
        Ok(Status::Ok)
    }

    /// Takes what the host has set of the world into the state, so that it can be saved as it is: after a change, and
    /// after the steps that the change had to wait for.
    fn settle(&mut self, _world: &World) {}

    /// Puts what others read of its state where they read it. Called when the state may have changed.
    fn publish(&mut self, _world: &mut World) {}

    /// Whether what it publishes changes between its state's time and the present, so that effects behind it in the
    /// list must read it as of their own steps.
    fn changes_until(&self, _world: &World) -> bool {
        false
    }

    /// Simulation time, s, at which the next step that reads what others publish ends; none without such steps.
    fn reads_next_s(&self) -> Option<f64> {
        None
    }

    /// Simulation time of the state, if there is one.
    fn stepped_to_s(&self) -> Option<f64> {
        None
    }

    /// Updates what weather, surroundings and time alone decide, and what is therefore not saved.
    fn refresh(&mut self, _world: &World) -> Result<()> {
        Ok(())
    }

    /// Adds what was fixed at creation to what a saved state is compared by.
    fn created(&self, _table: &mut toml::Table) {}

    /// Adds its state and what is set of it to a saved one.
    fn save(&self, _state: &mut toml::Table) -> Result<()> {
        Ok(())
    }

    /// Saves an effect whose state is that of things in the world. `for_hash`: the state is hashed and never loaded, so
    /// hashes may stand for large parts of it.
    fn save_in(&self, _world: &World, _for_hash: bool, state: &mut toml::Table) -> Result<()> {
        self.save(state)
    }
}

/// States of the effects that a context holds, each found by its type.
#[derive(Clone, Copy)]
pub(crate) struct HeldEffects<'a>(pub &'a [&'a dyn HeldEffect]);

impl<'a> HeldEffects<'a> {
    /// Returns the state of one effect.
    ///
    /// # Errors
    /// [`crate::Status::Internal`] where it holds none of this type.
    pub fn of<T: HeldEffect>(&self) -> Result<&'a T> {
        let found = self.0.iter().find_map(|held| (*held as &dyn std::any::Any).downcast_ref());
        found.ok_or_else(|| Error::new(Status::Internal, format!("no state of {}", std::any::type_name::<T>())))
    }
}
