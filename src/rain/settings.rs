//! What a host may ask of the rain's picture.

use super::STATE_BYTES;
use crate::{
    error::{Error, Result, check_range},
    gpu::Device,
};

/// With what a view draws rain; what falls is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum RainModel {
    /// Each drop to 1.9 m, and cones beyond, to 14.8 m; under a budget ([`crate::plan`]) less if the picture does not need it.
    #[default]
    Automatic,
    /// No drops: all rain is extinction. Costs nothing beyond the fog.
    Veil,
    /// Streaks on four nested cones about the camera ([`super::cones`]): the cost is a matter of the picture's size alone, and
    /// less than that of drops only without compute shaders.
    /// No splashes.
    Cones,
    /// Drops alone, to 4 m, each where (seed, number, time) puts it, without a state ([`super::lattice`]); cones beyond where
    /// lamps light the rain.
    Drops,
    /// Drops that are stepped through a wind that varies in space ([`super::integrated`]). Needs compute shaders.
    Integrated,
}

/// How a view draws rain. What falls, and where each drop is, does not depend on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RainSettings {
    /// Time for which a picture is exposed, s, [1e-4, 0.1]: it makes streaks of drops. Default 1/60.
    pub shutter_s: f64,
    /// Most drops that are drawn, [1000, 8 000 000]; further ones are stood for by those that are. `None`, the default:
    /// 400 000, or 100 000 on a software driver.
    pub most_drops: Option<u32>,
    /// With what it is drawn.
    pub model: RainModel,
}

impl Default for RainSettings {
    fn default() -> Self {
        Self { shutter_s: 1.0 / 60.0, most_drops: None, model: RainModel::Automatic }
    }
}

impl RainSettings {
    /// Refuses what is outside of its range, by name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        check_range("rain.shutter_s", self.shutter_s, 1e-4, 0.1, "s")?;
        self.most_drops.map_or(Ok(()), |n| check_range("rain.most_drops", f64::from(n), 1e3, 8e6, ""))
    }

    /// Most drops that are drawn on `device`.
    pub(crate) fn most_on(&self, device: &Device) -> u32 {
        self.most_drops.unwrap_or(if device.caps().software { 100_000 } else { 400_000 })
    }

    /// Refuses what `device` cannot draw, by name.
    pub(crate) fn validate_on(&self, device: &Device) -> Result<()> {
        self.validate()?;
        if self.model != RainModel::Integrated {
            return Ok(());
        }
        if device.caps().tier == 0 {
            return Err(Error::unsupported("rain.model integrated: this device has no compute shaders"));
        }
        let room = device.device.limits().max_storage_buffer_binding_size / STATE_BYTES;
        if u64::from(self.most_on(device)) + 4 > room {
            return Err(Error::unsupported(format!(
                "rain.most_drops above {} with the integrated model on this device",
                room.saturating_sub(4)
            )));
        }
        Ok(())
    }
}
