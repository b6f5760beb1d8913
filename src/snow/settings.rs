//! Settings for drawing falling snow.

use crate::{
    error::{Result, check_range},
    gpu::Device,
};

/// Method by which a view draws snow. It does not change the snowfall itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SnowModel {
    /// Flakes near the camera. Under a budget ([`crate::plan`]) the flakes are left out if the picture changes little
    /// without them.
    #[default]
    Automatic,
    /// No flakes: all snow is extinction. This costs nothing in addition to the fog.
    Veil,
    /// Flakes, under any budget.
    Flakes,
}

/// Settings by which a view draws falling snow. They change how many flakes are drawn and how long their streaks are,
/// but neither the snowfall itself nor the place of any flake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnowSettings {
    /// Method by which snow is drawn. Default [`SnowModel::Automatic`].
    pub model: SnowModel,
    /// Largest number of drawn flakes, [1000, 8 000 000]. More flakes reach farther, up to 16 m. Flakes beyond this
    /// number are represented by drawn flakes, or are extinction, drawn with the fog. `None`, the default: 1 000 000,
    /// or 60 000 on a software driver.
    pub most_flakes: Option<u32>,
    /// Exposure time of the picture, s, [1e-4, 0.1]. Flakes that move by more than their size during the exposure are
    /// streaks. Default 1/250: short enough to show the shapes of flakes in a light wind. A person sees these shapes
    /// because the eye follows the flakes.
    pub shutter_s: f64,
}

impl Default for SnowSettings {
    fn default() -> Self {
        Self { model: SnowModel::Automatic, most_flakes: None, shutter_s: 1.0 / 250.0 }
    }
}

impl SnowSettings {
    /// Checks that every setting is within its range.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the setting.
    pub fn validate(&self) -> Result<()> {
        check_range("snow.shutter_s", self.shutter_s, 1e-4, 0.1, "s")?;
        self.most_flakes.map_or(Ok(()), |n| check_range("snow.most_flakes", f64::from(n), 1e3, 8e6, ""))
    }

    /// Returns the largest number of flakes drawn on `device`.
    pub(crate) fn most_on(&self, device: &Device) -> u32 {
        self.most_flakes.unwrap_or(if device.caps().software { 60_000 } else { 1_000_000 })
    }
}
