//! Interface of an effect that a context holds: one with a state, or with settings that all views share.

use std::time::Instant;

use super::state::World;
use crate::error::{Error, Result, Status};

/// Target and time limit of an update.
#[derive(Clone, Copy)]
pub(crate) struct UpdateBudget {
    /// Simulation time to which states are advanced, s; the present at the latest.
    pub until_s: f64,
    /// Time at which the update began.
    pub begun: Instant,
    /// Longest time that the update may take.
    pub most: std::time::Duration,
}

/// State of an effect that a context holds for all its views. `src/effects.rs` lists these effects; a context advances,
/// saves and loads each effect in the list.
pub(crate) trait HeldEffect: std::any::Any {
    /// Prepares the state for being advanced from the present to `time_s`.
    fn begin(&mut self, _world: &World, _time_s: f64) -> Result<()> {
        Ok(())
    }

    /// Advances the state to `budget.until_s`, or until the time limit is reached, by at least one step. Steps end at
    /// whole multiples of their length since time 0. Returns [`Status::Pending`] if the time limit stopped the steps.
    fn advance(&mut self, _world: &World, _budget: UpdateBudget) -> Result<Status> {
        Ok(Status::Ok)
    }

    /// Applies the host's changes of the world to the state, so that the state can be saved. Called after a change, and
    /// after the steps that the change had to wait for.
    fn settle(&mut self, _world: &World) {}

    /// Writes into the world the parts of the state that other effects read. Called when the state may have changed.
    fn publish(&mut self, _world: &mut World) {}

    /// Whether the published values change between the state's time and the present. Effects later in the list must
    /// then read them at the times of their own steps.
    fn changes_until(&self, _world: &World) -> bool {
        false
    }

    /// Returns the simulation time, s, at which the next step that reads published values ends; `None` without such
    /// steps.
    fn reads_next_s(&self) -> Option<f64> {
        None
    }

    /// Returns the simulation time of the state, s; `None` without one.
    fn stepped_to_s(&self) -> Option<f64> {
        None
    }

    /// Updates values that follow from weather, surroundings and time alone and are therefore not saved.
    fn refresh(&mut self, _world: &World) -> Result<()> {
        Ok(())
    }

    /// Adds the values that were fixed at creation to the table with which saved states are compared.
    fn created(&self, _table: &mut toml::Table) {}

    /// Adds the effect's state and settings to a saved state.
    fn save(&self, _state: &mut toml::Table) -> Result<()> {
        Ok(())
    }

    /// Saves an effect whose state depends on things in the world. With `for_hash` the state is hashed and never
    /// loaded, so hashes may replace large parts of it.
    fn save_in(&self, _world: &World, _for_hash: bool, state: &mut toml::Table) -> Result<()> {
        self.save(state)
    }
}

/// States of the effects that a context holds, each found by its type.
#[derive(Clone, Copy)]
pub(crate) struct HeldEffects<'a>(pub &'a [&'a dyn HeldEffect]);

impl<'a> HeldEffects<'a> {
    /// Returns the state of the effect with this type.
    ///
    /// # Errors
    /// [`crate::Status::Internal`] if no effect has this type.
    pub fn of<T: HeldEffect>(&self) -> Result<&'a T> {
        let found = self.0.iter().find_map(|held| (*held as &dyn std::any::Any).downcast_ref());
        found.ok_or_else(|| Error::new(Status::Internal, format!("no state of {}", std::any::type_name::<T>())))
    }
}
