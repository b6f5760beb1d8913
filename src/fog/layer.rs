//! Settings of a fog layer, and the law by which fog is drawn: a physical layer, or a fog law of older simulators.

use serde::{Deserialize, Serialize};

use super::laws::CompatibilityLaw;
use crate::{
    error::{Result, check_range},
    light::Phase,
    moment::MAX_EXTINCTION_PER_M,
};

/// Change of the layer's extinction with altitude. Altitudes are in metres above mean sea level.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Profile {
    /// Constant between base and top, with linear flanks at both, so that the optical depth has no kink.
    Slab {
        /// Altitude of the middle of the lower flank, m, \[-1e5, 1e6\]. For fog that lies on the ground this altitude
        /// is far below the ground.
        base_m: f64,
        /// Altitude of the middle of the upper flank, m, \[`base_m`, 1e6\].
        top_m: f64,
        /// Vertical extent of the lower flank, m, \[0, 1e5\].
        base_softness_m: f64,
        /// Vertical extent of the upper flank, m, \[0, 1e5\]. The layer of dust that Welkin derives from a weather is
        /// all flank: by default it is as deep as twice the scale height of the dust, at most 40 km.
        top_softness_m: f64,
    },
    /// Proportional to exp(-(h - reference)/scale) at every altitude h; not cut off above or below.
    Exponential {
        /// Altitude at which the extinction has its stated value, m, \[-1e5, 1e6\].
        reference_m: f64,
        /// Scale height, m, \[1, 1e5\].
        scale_height_m: f64,
    },
}

/// Horizontal patches (METAR BCFG). The extinction is multiplied by 1 + amount (s - 1), where s is a smooth pattern
/// with a mean of 1 that reaches 0 between the patches. The pattern is fixed to the world, shifted by `drift_m`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Patches {
    /// Strength of the pattern, \[0, 1\]: 0 is an even layer, 1 has clear gaps between patches.
    pub amount: f64,
    /// Typical distance between patches, m, \[5, 1e5\].
    pub size_m: f64,
    /// Seed of the pattern.
    #[serde(with = "seed_text")]
    pub seed: u64,
    /// Distance over which the wind has carried the pattern, (east, north), m, each \[-1e12, 1e12\].
    pub drift_m: [f64; 2],
}

/// A low layer of fog or mist.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FogLayer {
    /// Extinction at 550 nm inside the slab, or at the reference altitude, 1/m, \[0, 10\].
    pub extinction_per_m: f64,
    /// Exponent of Angstrom's law sigma ~ wavelength^-a, \[-1, 4\]; 0 for droplets, about 1 for haze.
    pub angstrom: f64,
    /// Single-scattering albedo per channel, \[0, 1\]; 1 for water.
    pub albedo: [f64; 3],
    /// Change of the extinction with altitude.
    pub profile: Profile,
    /// Phase function.
    pub phase: Phase,
    /// Patches, if any.
    pub patches: Option<Patches>,
}

impl FogLayer {
    /// Water fog of this extinction that fills everything below `top_m`, with droplets of 15 um.
    pub fn ground_fog(extinction_per_m: f64, top_m: f64, top_softness_m: f64) -> Self {
        Self {
            extinction_per_m,
            angstrom: 0.0,
            albedo: [1.0; 3],
            profile: Profile::Slab { base_m: -1e4, top_m, base_softness_m: 0.0, top_softness_m },
            phase: Phase::Droplets { diameter_um: 15.0 },
            patches: None,
        }
    }

    /// Checks that every field is within its range.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        check_range("fog.extinction_per_m", self.extinction_per_m, 0.0, MAX_EXTINCTION_PER_M, "1/m")?;
        check_range("fog.angstrom", self.angstrom, -1.0, 4.0, "")?;
        for a in self.albedo {
            check_range("fog.albedo", a, 0.0, 1.0, "")?;
        }
        match self.profile {
            Profile::Slab { base_m, top_m, base_softness_m, top_softness_m } => {
                check_range("fog.base_m", base_m, -1e5, 1e6, "m")?;
                check_range("fog.top_m", top_m, base_m, 1e6, "m")?;
                check_range("fog.base_softness_m", base_softness_m, 0.0, 1e5, "m")?;
                check_range("fog.top_softness_m", top_softness_m, 0.0, 1e5, "m")?;
            }
            Profile::Exponential { reference_m, scale_height_m } => {
                check_range("fog.reference_m", reference_m, -1e5, 1e6, "m")?;
                check_range("fog.scale_height_m", scale_height_m, 1.0, 1e5, "m")?;
            }
        }
        match self.phase {
            Phase::Droplets { diameter_um } => check_range("fog.diameter_um", diameter_um, 5.0, 50.0, "um")?,
            Phase::HenyeyGreenstein { g } => check_range("fog.g", g, -0.95, 0.95, "")?,
            Phase::Between { diameter_um, g, share } => {
                check_range("fog.diameter_um", diameter_um, 5.0, 50.0, "um")?;
                check_range("fog.g", g, -0.95, 0.95, "")?;
                check_range("fog.share", share, 0.0, 1.0, "")?;
            }
        }
        if let Some(p) = &self.patches {
            check_range("fog.patches.amount", p.amount, 0.0, 1.0, "")?;
            check_range("fog.patches.size_m", p.size_m, 5.0, 1e5, "m")?;
            for d in p.drift_m {
                check_range("fog.patches.drift_m", d, -1e12, 1e12, "m")?;
            }
        }
        Ok(())
    }
}

/// Law by which fog is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Law {
    /// No fog.
    Clear,
    /// A physical layer, lit by sun and sky.
    Layer(FogLayer),
    /// A fog law of older simulators.
    Compatibility(CompatibilityLaw),
}

impl Law {
    /// Checks the fields of the layer or of the fog law.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        match self {
            Self::Clear => Ok(()),
            Self::Layer(layer) => layer.validate(),
            Self::Compatibility(law) => law.validate(),
        }
    }
}

/// A 64-bit number as text, because an integer in TOML has 63 bits and a sign.
mod seed_text {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub fn serialize<S: Serializer>(seed: &u64, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(seed)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u64, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(D::Error::custom)
    }
}
