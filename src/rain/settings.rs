//! Settings of the rain's picture that a host may ask for.

use crate::{
    error::{Error, Result, check_range},
    gpu::Device,
    particles::stepping::StepPass,
};

/// With what a view draws rain; what falls is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum RainModel {
    /// Each drop to 1.9 m, and cones beyond, to 14.8 m; under a budget ([`crate::plan`]) less if the picture does not
    /// need it.
    #[default]
    Automatic,
    /// No drops: all rain is extinction. Costs nothing beyond the fog.
    Veil,
    /// Streaks on three nested cones about the camera ([`super::cones`]). The cost depends only on the picture's size;
    /// it is below that of drops only without compute shaders. No splashes.
    Cones,
    /// Drops alone, to 4 m, each where (seed, number, time) puts it, without a state ([`super::lattice`]); cones beyond
    /// where lamps light the rain.
    Drops,
    /// Drops that are stepped through a wind that varies in space (`particles::stepping`), to 4 m. Needs compute
    /// shaders.
    Integrated,
}

/// How a view draws what falls: rain, hail and their splashes. What falls, and where each drop is, does not depend on
/// it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RainSettings {
    /// Time for which a picture is exposed, s, [1e-4, 0.1]: it makes streaks of drops, the longer and the fainter the
    /// longer it is. Default [`RainSettings::SHUTTER_CAMERA_60_S`].
    pub shutter_s: f64,
    /// Most drops that are drawn, [1000, 8 000 000]; further ones are stood for by those that are. `None`, the default:
    /// 400 000, or 100 000 on a software driver.
    pub most_drops: Option<u32>,
    /// With what it is drawn.
    pub model: RainModel,
    /// By how much what falls stands out of the picture more than it does in nature, [1, 16]. 1, the default: as it
    /// does. Beyond that streaks, stones and splashes hide as much as so many of them one before the other, which is
    /// not how rain looks but how an instructor's trainee sees it on a display; the veil gives way by as much, so what
    /// lies some tens of metres off keeps its mean. Nothing else depends on it: no light, no visibility, no water, no
    /// query. Set it alike on all channels of a simulator. [`RainSettings::TRAINER`] has the one for trainers.
    pub contrast_gain: f64,
}

impl Default for RainSettings {
    fn default() -> Self {
        Self { shutter_s: Self::SHUTTER_CAMERA_60_S, most_drops: None, model: RainModel::Automatic, contrast_gain: 1.0 }
    }
}

impl RainSettings {
    /// The time over which an eye adds up what it sees by day, s: streaks as one who stands in the rain sees them
    /// (Bloch's law holds up to some 40 to 100 ms, Barlow 1958).
    pub const SHUTTER_EYE_S: f64 = 1.0 / 20.0;
    /// A video camera's shutter that is open for a whole frame of 60 a second, s.
    pub const SHUTTER_CAMERA_60_S: f64 = 1.0 / 60.0;
    /// A camera's short exposure in good light, s: drops are short streaks.
    pub const SHUTTER_CAMERA_500_S: f64 = 1.0 / 500.0;
    /// The contrast gain for trainers: rain by day shows on a display of eight bits as it does in a film.
    pub const GAIN_TRAINER: f64 = 4.0;
    /// Rain for trainers: [`RainSettings::GAIN_TRAINER`], the rest by default.
    pub const TRAINER: Self = Self {
        shutter_s: Self::SHUTTER_CAMERA_60_S,
        most_drops: None,
        model: RainModel::Automatic,
        contrast_gain: Self::GAIN_TRAINER,
    };

    /// Refuses what is outside of its range, by name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        check_range("rain.shutter_s", self.shutter_s, 1e-4, 0.1, "s")?;
        check_range("rain.contrast_gain", self.contrast_gain, 1.0, 16.0, "")?;
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
            return Err(
                Error::unsupported("integrated needs compute shaders, which this device lacks").within("rain.model")
            );
        }
        let room = StepPass::most(device);
        if u64::from(self.most_on(device)) + 4 > room {
            let what = format!("above {} with the integrated model on this device", room.saturating_sub(4));
            return Err(Error::unsupported(what).within("rain.most_drops"));
        }
        Ok(())
    }
}
