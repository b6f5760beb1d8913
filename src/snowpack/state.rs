//! State of lying snow that is stepped through time, and the lengths of its steps.

use super::{column::Column, field::SnowField};
use crate::{error::Result, surroundings::Meltwater, world::World};

/// Length of a step, s.
pub const STEP_S: f64 = 60.0;

/// Length of a fast-forward step, s. Steep snow also slides at this interval.
pub const COARSE_STEP_S: f64 = 600.0;

/// Density of snow that is reported only by depth, kg/m^3: that of a seasonal pack (Sturm et al. 1995, "prairie").
const REPORTED_KG_M3: f64 = 250.0;

/// Simulated snow, and the values that its next step needs.
#[derive(Clone, Debug)]
pub(super) struct SnowState {
    /// Time to which the snow is simulated, s.
    pub time_s: f64,
    /// Sunlight on level ground at its last update, W/m^2.
    pub sunlight_w_m2: f64,
    /// Snow on level, open ground; it also lies around the host's terrain.
    pub country: Column,
    /// Meltwater of the last step: on the host's terrain if there is one, else on level, open ground.
    pub melted: Meltwater,
    /// Time that was simulated in fast-forward, s.
    pub coarse_s: f64,
    /// Snow on the host's terrain, once there is one.
    pub field: Option<SnowField>,
}

/// Returns snow of a depth that the weather reports, m.
pub(super) fn reported(depth_m: f64) -> Column {
    Column::of(depth_m, REPORTED_KG_M3)
}

impl SnowState {
    /// Creates the state that begins at `time_s` with the reported depth.
    pub fn first(world: &World, time_s: f64) -> Result<Self> {
        Ok(Self {
            time_s,
            sunlight_w_m2: world.sunlight_w_m2(time_s)?,
            country: reported(world.timeline.at(time_s).surface.snow_depth_m),
            melted: Meltwater { covered: 0.0, runoff_mm_h: 0.0 },
            coarse_s: 0.0,
            field: None,
        })
    }

    /// Returns the end of the next step, s: a fast-forward step if it ends by `coarse_until_s`.
    pub fn next_s(&self, coarse_until_s: f64) -> f64 {
        let after = |length: f64| ((self.time_s / length).floor() + 1.0) * length;
        let coarse = after(COARSE_STEP_S);
        if coarse <= coarse_until_s { coarse } else { after(STEP_S) }
    }

    /// Returns whether snow lies on level, open ground or on the host's terrain.
    pub fn lies_anywhere(&self) -> bool {
        self.country.mass() > 0 || self.field.as_ref().is_some_and(|f| f.books.balance() > 0)
    }
}
