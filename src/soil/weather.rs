//! Weather of a site: water that soaks into the bank and drains, and frost.

use super::{
    laws::{frost_depth_m, saturation_after},
    material::depth_units,
    site::{SOIL_STEP_S, SoilSite},
};

/// Number of steps between two times at which the weather acts: a minute.
pub(super) const WEATHER_STEPS: i64 = 60 * 64;
/// Thickest crust of frozen ground that a tool breaks, m.
const THIN_FROST_M: f64 = 0.05;

impl SoilSite {
    /// Applies the weather of the last minute: the bank takes up water and drains, and freezes or thaws in air of this
    /// temperature.
    pub(super) fn weather(&mut self, temperature_c: f64) {
        let seconds = WEATHER_STEPS as f64 * SOIL_STEP_S;
        let at_rest = self.field.materials.saturation;
        let water = &mut self.field.water;
        water.saturation = saturation_after(water.saturation, water.soaked, at_rest, seconds);
        for patch in &mut self.field.patches {
            let held = patch.hold();
            patch.water.saturation = saturation_after(patch.water.saturation, patch.water.soaked, at_rest, seconds);
            // A wall that has lost strength may fall.
            if patch.hold() < held {
                patch.is_unchecked = true;
                self.idle = 0;
            }
        }
        self.freezing_k_s = (self.freezing_k_s - temperature_c * seconds).max(0.0);
        self.freeze();
    }

    /// Updates the depth of the frost.
    pub(super) fn freeze(&mut self) {
        let depth_m = frost_depth_m(self.freezing_k_s);
        self.field.frozen = if depth_m > THIN_FROST_M { depth_units(depth_m) } else { 0 };
    }

    /// Sets the wet share of the surface: `level` for ground that was not dug, and `patch` by key for each patch.
    pub(super) fn wet(&mut self, level: f64, patch: impl Fn([i32; 2]) -> f64) {
        self.field.water.soaked = level;
        self.field.patches.iter_mut().for_each(|dug| dug.water.soaked = patch(dug.key));
    }
}
