//! Settings that a host may choose for the picture of falling snow.

use crate::{
    error::{Result, check_range},
    gpu::Device,
};

/// With what a view draws snow; what falls is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SnowModel {
    /// Flakes near the camera; under a budget ([`crate::plan`]) none if the picture does not need them.
    #[default]
    Automatic,
    /// No flakes: all snow is extinction. Costs nothing beyond the fog.
    Veil,
    /// Flakes, whatever a budget says.
    Flakes,
}

/// How a view draws falling snow. What falls, and where each flake is, does not depend on it, but for how many are
/// drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnowSettings {
    /// With what it is drawn.
    pub model: SnowModel,
    /// Most flakes that are drawn, [1000, 8 000 000]; further ones are stood for by those that are, or left to the
    /// veil: the more, the farther flakes reach, up to 16 m. `None`, the default: 1 000 000, or 60 000 on a software
    /// driver.
    pub most_flakes: Option<u32>,
    /// Time for which a picture is exposed, s, [1e-4, 0.1]: flakes that move by more than their size in it are streaks.
    /// Default 1/250: an eye follows flakes in a light wind and sees their shapes.
    pub shutter_s: f64,
}

impl Default for SnowSettings {
    fn default() -> Self {
        Self { model: SnowModel::Automatic, most_flakes: None, shutter_s: 1.0 / 250.0 }
    }
}

impl SnowSettings {
    /// Refuses what is outside of its range, by name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        check_range("snow.shutter_s", self.shutter_s, 1e-4, 0.1, "s")?;
        self.most_flakes.map_or(Ok(()), |n| check_range("snow.most_flakes", f64::from(n), 1e3, 8e6, ""))
    }

    /// Most flakes that are drawn on `device`.
    pub(crate) fn most_on(&self, device: &Device) -> u32 {
        self.most_flakes.unwrap_or(if device.caps().software { 60_000 } else { 1_000_000 })
    }
}
