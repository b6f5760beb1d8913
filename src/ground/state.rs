//! State of the water on level, open ground: its source, and the values that are simulated.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::water::{Forcing, GroundWater, STEP_S};
use crate::{error::Result, weather::Conditions, world::World};

/// Source of the ground's wetness.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum GroundModel {
    /// Wetness from the present weather: the reported wetness, or the wetness that the present rain keeps up. There is
    /// no state: when rain ends, the wetness that it kept up is gone at once.
    #[default]
    Reported,
    /// Simulated water: rain adds to it, and it drains and dries by wind, sun and humidity ([`crate::ground::water`]).
    /// The simulation begins at time 0 with the ground that the weather reports for that time. An update that moves
    /// time by more than a day restarts it in the same way, one day before the end of the update.
    Simulated,
}

/// Simulated water, and the values that its next step needs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GroundState {
    /// Time up to which the water is simulated, s.
    pub time_s: f64,
    /// Film on the ground, mm.
    film_mm: f64,
    /// Water in the pores, mm.
    soaked_mm: f64,
    /// Water in the hollows, mm over the whole ground.
    hollows_mm: f64,
    /// Sunlight on level ground at its last update, W/m^2.
    pub sunlight_w_m2: f64,
}

impl GroundState {
    /// Returns the water of the level ground.
    pub fn water(&self) -> GroundWater {
        GroundWater { film_mm: self.film_mm, soaked_mm: self.soaked_mm, hollows_mm: self.hollows_mm }
    }

    /// Replaces the water of the level ground.
    pub fn set(&mut self, water: GroundWater) {
        (self.film_mm, self.soaked_mm, self.hollows_mm) = (water.film_mm, water.soaked_mm, water.hollows_mm);
    }

    /// Creates a state that begins at `time_s` with the ground that the weather reports.
    pub fn first(world: &World, time_s: f64) -> Result<Self> {
        let sunlight_w_m2 = world.sunlight_w_m2(time_s)?;
        let mut state = Self { time_s, film_mm: 0.0, soaked_mm: 0.0, hollows_mm: 0.0, sunlight_w_m2 };
        state.set(GroundWater::of_cover(&world.timeline.at(time_s).surface));
        Ok(state)
    }

    /// Returns the end of the next step, s.
    pub fn next_s(&self) -> f64 {
        ((self.time_s / STEP_S).floor() + 1.0) * STEP_S
    }

    /// Returns whether the values of a saved state are in range.
    pub fn is_valid(&self) -> bool {
        let amounts = [self.film_mm, self.soaked_mm, self.hollows_mm, self.sunlight_w_m2];
        self.time_s.is_finite() && amounts.iter().all(|v| (0.0..1e4).contains(v))
    }
}

/// Inputs of a step of level, open ground, in which the grid and the tiles are advanced too.
#[derive(Clone, Copy)]
pub(super) struct GroundStep<'a> {
    /// Beginning of the step, s.
    pub from_s: f64,
    /// Length of the step, s.
    pub seconds: f64,
    /// Weather in the middle of the step.
    pub conditions: &'a Conditions,
    /// Liquid that falls and water that evaporates in the step.
    pub forcing: &'a Forcing,
    /// Sunlight on level ground, W/m^2.
    pub sunlight_w_m2: f64,
    /// Water of level ground at the beginning of the step.
    pub water: &'a GroundWater,
}

impl GroundStep<'_> {
    /// Returns the weather and its effect on the ground at a place; `None` where weather regions do not change the
    /// weather.
    pub fn in_regions(&self, world: &World, place: DVec3) -> Option<(Conditions, Forcing)> {
        if world.set.weather_regions.is_empty() {
            return None;
        }
        let c = world.over().in_regions(place, self.from_s + 0.5 * self.seconds, *self.conditions);
        (c != *self.conditions).then(|| (c, forcing_from(world, &c, self.sunlight_w_m2, self.from_s)))
    }
}

/// Returns the liquid that falls and the water that evaporates under a weather, with the meltwater of lying snow in a
/// step that begins at `from_s`.
pub(super) fn forcing_from(world: &World, c: &Conditions, sunlight_w_m2: f64, from_s: f64) -> Forcing {
    let forcing = Forcing::of(c, sunlight_w_m2);
    let snow = world.snow.as_ref().and_then(|snow| snow.meltwater(from_s));
    snow.map_or(forcing, |water| forcing.under_snow(c, water))
}
