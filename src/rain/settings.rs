//! Settings for drawing rain.

use crate::{
    error::{Error, Result, check_range},
    gpu::Device,
    particles::stepping::StepPass,
};

/// Method by which a view draws rain. It does not change the precipitation itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum RainModel {
    /// Single drops up to 1.9 m from the camera, and cones from there to 14.8 m. Rain farther away is extinction, drawn
    /// with the fog. On devices with compute shaders the drops are stepped near a wind that varies in space, as with
    /// [`RainModel::Integrated`]. Under a budget ([`crate::plan`]) the drops, or the drops and the cones, are left out
    /// if the picture changes little without them or there is no time for them.
    #[default]
    Automatic,
    /// No drops: all rain is extinction. This costs nothing in addition to the fog.
    Veil,
    /// Streaks on three nested cones around the camera ([`super::cones`]), without splashes. The cost depends only on
    /// the picture's size. This model costs less than drops on devices without compute shaders, but not on other
    /// devices.
    Cones,
    /// Single drops only, up to 4 m from the camera. Each drop's place follows from (seed, number, time), without a
    /// state ([`super::lattice`]). If lamps light the rain, cones show it beyond 4 m.
    Drops,
    /// Drops stepped through a wind that varies in space (`particles::stepping`), up to 4 m from the camera. If lamps
    /// light the rain, cones show it beyond 4 m. This model needs compute shaders.
    Integrated,
}

/// Settings by which a view draws rain, hail and their splashes. They do not change the precipitation itself. Of the
/// settings only `model` affects the places of drops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RainSettings {
    /// Exposure time of the picture, s, [1e-4, 0.1]. A longer exposure makes streaks longer and fainter. Default
    /// [`RainSettings::SHUTTER_CAMERA_60_S`].
    pub shutter_s: f64,
    /// Largest number of drawn drops, [1000, 8 000 000]. If more would be drawn, each drawn drop represents several.
    /// `None`, the default: 400 000, or 100 000 on a software driver.
    pub most_drops: Option<u32>,
    /// Method by which rain is drawn.
    pub model: RainModel,
    /// Factor by which falling rain and hail stand out more than in nature, [1, 16]. Default 1: as in nature. With a
    /// gain g, a streak, stone or splash has the opacity 1 - (1 - c)^g instead of c. Real rain does not look like that;
    /// the gain makes rain visible to trainees on a simulator's display. The extinction of the rain drawn with the fog
    /// is reduced to match, so that objects some tens of metres away are on average as visible as without the gain. The
    /// gain changes only the picture: light, water and the results of queries do not depend on it. Set the same value
    /// in all views of a simulator. [`RainSettings::TRAINER`] has the value for training simulators.
    pub contrast_gain: f64,
}

impl Default for RainSettings {
    fn default() -> Self {
        Self { shutter_s: Self::SHUTTER_CAMERA_60_S, most_drops: None, model: RainModel::Automatic, contrast_gain: 1.0 }
    }
}

impl RainSettings {
    /// Time over which an eye integrates light by day, s: streaks look as they do to a person in the rain. Bloch's law
    /// holds up to some 40 to 100 ms (Barlow 1958).
    pub const SHUTTER_EYE_S: f64 = 1.0 / 20.0;
    /// Exposure of a video camera whose shutter is open for a whole frame at 60 frames a second, s.
    pub const SHUTTER_CAMERA_60_S: f64 = 1.0 / 60.0;
    /// Short exposure of a camera in good light, s: drops are short streaks.
    pub const SHUTTER_CAMERA_500_S: f64 = 1.0 / 500.0;
    /// Contrast gain for training simulators: rain by day is as visible on an 8-bit display as in a film.
    pub const GAIN_TRAINER: f64 = 4.0;
    /// Settings for training simulators: [`RainSettings::GAIN_TRAINER`], all else at its default.
    pub const TRAINER: Self = Self {
        shutter_s: Self::SHUTTER_CAMERA_60_S,
        most_drops: None,
        model: RainModel::Automatic,
        contrast_gain: Self::GAIN_TRAINER,
    };

    /// Checks that every setting is within its range.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the setting.
    pub fn validate(&self) -> Result<()> {
        check_range("rain.shutter_s", self.shutter_s, 1e-4, 0.1, "s")?;
        check_range("rain.contrast_gain", self.contrast_gain, 1.0, 16.0, "")?;
        self.most_drops.map_or(Ok(()), |n| check_range("rain.most_drops", f64::from(n), 1e3, 8e6, ""))
    }

    /// Returns the largest number of drops drawn on `device`.
    pub(crate) fn most_on(&self, device: &Device) -> u32 {
        self.most_drops.unwrap_or(if device.caps().software { 100_000 } else { 400_000 })
    }

    /// Checks the settings, also against the limits of `device`.
    ///
    /// # Errors
    /// The errors of [`RainSettings::validate`]; [`crate::Status::Unsupported`] if the model is
    /// [`RainModel::Integrated`] and the device lacks compute shaders or the memory for so many drops.
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
