//! Presets for three covers of the source (Tarantilis 2004, section IV.A.1): typical layers of a sky.

use super::opacity::CloudFunction;
use super::settings::{NoiseKind, NoiseSettings};

/// Layer of the source, named by its cover. The share of the sky that is cloud equals the share of texels above the
/// cutoff.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CloudPreset {
    /// 8 oktas: 0.98 to 0.99 of the sky in the mean over seeds, 0.95 to 1 for each seed.
    Overcast,
    /// 5 to 7 oktas: 0.80 to 0.83 of the sky in the mean over seeds, 0.72 to 0.89 for each seed.
    Broken,
    /// 1 to 2 oktas: 0.12 to 0.16 of the sky in the mean over seeds, 0.10 to 0.18 for each seed.
    Few,
}

impl CloudPreset {
    /// All presets, from the largest cover to the smallest.
    pub const ALL: [Self; 3] = [Self::Overcast, Self::Broken, Self::Few];

    /// Returns the name in lower case, as the tool `examples/noise` takes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Overcast => "overcast",
            Self::Broken => "broken",
            Self::Few => "few",
        }
    }

    /// Returns the preset of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|preset| preset.name() == name)
    }

    /// Size of the source's texture: two-dimensional, 1024 x 1024 texels.
    pub const SIZE: [u32; 3] = [1024, 1024, 1];

    /// Returns the settings of the noise from which the layer is cut.
    pub fn noise(self, seed: u64) -> NoiseSettings {
        let (octaves, frequency, amplitude, persistence) = match self {
            Self::Overcast => (10, 3, 0.5, 0.7),
            Self::Broken => (10, 6, 1.0, 0.4),
            Self::Few => (8, 16, 0.8, 0.4),
        };
        NoiseSettings { kind: NoiseKind::Gradient, frequency: [frequency; 3], octaves, amplitude, persistence, seed }
    }

    /// Returns the function that cuts the layer out of the noise.
    pub fn cloud(self) -> CloudFunction {
        let (cutoff, density) = self.cutoff_and_density();
        CloudFunction::of_density(cutoff, density)
    }

    /// Returns cutoff and density for [`CloudFunction::from_density`].
    pub fn cutoff_and_density(self) -> (f64, f64) {
        match self {
            Self::Overcast => (0.6, 0.95),
            Self::Broken => (0.7, 0.96),
            Self::Few => (0.8, 0.96),
        }
    }

    /// Returns the height of the layer above the ground, m.
    pub fn height_m(self) -> f64 {
        match self {
            Self::Overcast => 1400.0,
            Self::Broken => 1200.0,
            Self::Few => 900.0,
        }
    }
}
