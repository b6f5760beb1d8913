//! State of the water on level, open ground: where it comes from, and what is led through time.

use serde::{Deserialize, Serialize};

use super::water::{Forcing, GroundWater, STEP_S};
use crate::{error::Result, weather::Conditions, world::World};

/// Where the wetness of the ground comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum GroundModel {
    /// From the weather of the moment: as reported, or as the rain of the moment keeps it. No state: rain that ends
    /// leaves dry ground.
    #[default]
    Reported,
    /// A state that rain fills and that drains and dries by wind, sun and humidity ([`crate::ground::water`]). It
    /// begins at simulation time 0 as the weather of that moment reports the ground. An update that moves time by more
    /// than a day begins it anew, in the same way, a day before its end.
    Simulated,
}

/// The simulated water and what its next step needs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GroundState {
    pub time_s: f64,
    film_mm: f64,
    soaked_mm: f64,
    hollows_mm: f64,
    /// Sunlight on level ground since the last look at it.
    pub sunlight_w_m2: f64,
}

impl GroundState {
    pub fn water(&self) -> GroundWater {
        GroundWater { film_mm: self.film_mm, soaked_mm: self.soaked_mm, hollows_mm: self.hollows_mm }
    }

    pub fn set(&mut self, water: GroundWater) {
        (self.film_mm, self.soaked_mm, self.hollows_mm) = (water.film_mm, water.soaked_mm, water.hollows_mm);
    }

    /// A state that begins at `time_s` as the weather reports the ground.
    pub fn first(world: &World, time_s: f64) -> Result<Self> {
        let sunlight_w_m2 = world.sunlight_w_m2(time_s)?;
        let mut state = Self { time_s, film_mm: 0.0, soaked_mm: 0.0, hollows_mm: 0.0, sunlight_w_m2 };
        state.set(GroundWater::of_cover(&world.timeline.at(time_s).surface));
        Ok(state)
    }

    /// Where its next step ends, s.
    pub fn next_s(&self) -> f64 {
        ((self.time_s / STEP_S).floor() + 1.0) * STEP_S
    }

    /// Whether a saved one can be one of ours.
    pub fn is_valid(&self) -> bool {
        let amounts = [self.film_mm, self.soaked_mm, self.hollows_mm, self.sunlight_w_m2];
        self.time_s.is_finite() && amounts.iter().all(|v| (0.0..1e4).contains(v))
    }
}

/// A step of level, open ground, for the grid and the tiles beside it.
#[derive(Clone, Copy)]
pub(super) struct GroundStep<'a> {
    pub from_s: f64,
    pub seconds: f64,
    pub conditions: &'a Conditions,
    pub forcing: &'a Forcing,
    /// Water of level ground at the step's beginning.
    pub water: &'a GroundWater,
}
