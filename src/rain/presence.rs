//! Presence of rain and ice in front of a view's picture, and the weather's own rain at an altitude.

use crate::{
    particles::begun_in_steps,
    weather::{Conditions, Falling},
};

/// Returns the weather's own precipitation, without that of rain areas. Rain, drizzle and both extinctions are reduced
/// to the share that has begun to fall above an altitude. The share changes in small steps.
pub(super) fn begun_at(c: &Conditions, altitude_m: f64) -> Falling {
    let share = begun_in_steps(c.begun(altitude_m));
    let f = c.precipitation;
    Falling {
        rain_mm_h: f.rain_mm_h * share,
        drizzle_mm_h: f.drizzle_mm_h * share,
        liquid_extinction_per_m: f.liquid_extinction_per_m * share,
        solid_extinction_per_m: f.solid_extinction_per_m * share,
        ..f
    }
}

/// Presence of rain and ice that a view draws in front of its picture.
#[derive(Clone, Copy)]
pub(super) struct RainPresence {
    /// Drops near the camera, drawn as streaks or cones.
    pub drops: bool,
    /// Hail and ice pellets near the camera.
    pub stones: bool,
    /// Columns of rain areas.
    pub columns: bool,
}

impl RainPresence {
    /// Returns whether drops or stones are drawn near the camera.
    pub fn is_near(self) -> bool {
        self.drops || self.stones
    }

    /// Returns whether anything is drawn.
    pub fn is_any(self) -> bool {
        self.is_near() || self.columns
    }
}
