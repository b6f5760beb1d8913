//! Visibility and fog drawn into the host's picture from its depth.
//!
//! # Model
//! A reported visibility V is the meteorological optical range: the distance at which a black target keeps 5 % of its
//! contrast at 550 nm, so the **total** extinction at the station is -ln(0.05)/V = 2.996/V (Koschmieder 1924; WMO-No.
//! 8, 2018, chapter 9). Air and tall haze have their own room; what they leave is a **layer** near the ground: fog or
//! mist between a base and a soft top ([`Profile::Slab`]), or thinning exponentially ([`Profile::Exponential`]), and
//! what **falls** through it from the clouds ([`FallingLayer`]), on a flat or curved planet.
//!
//! * Transmittance along a ray is closed form: path lengths between the layer's altitudes on a sphere
//!   ([`reference::layer_path`]), exact to f32.
//! * Fog and what falls have heights and an optical depth of their own. What is drawn as drops, flakes or stones near
//!   the camera is left out of the latter ([`reference::fog_beside_drops`]).
//! * Light: the layer is lit by the direct sun and the sky above and the ground below. Multiple scattering is the
//!   delta-Eddington solution (Joseph, Wiscombe and Weinman 1976) of the layer, solved per channel in f64 once a frame
//!   ([`light`]); the first scattering keeps its true phase function (Nakajima and Tanaka 1988). Both are integrated
//!   along the pixel's ray in closed form. So fog conserves energy: it neither glows nor blackens, is bright at noon,
//!   brighter toward a low sun, dark at night, and everything far away converges to the same radiance, ground or sky.
//! * Patches are waves whose mean along a ray is closed form too ([`patterns`]). They go with the air; where the wind
//!   goes round something, a ray over that place takes the lag of the air there in eight parts (`wind/detour.rs`).
//! * The compatibility laws of older simulators (linear, exponential, exponential squared, on range or plane
//!   distance) are [`CompatibilityLaw`].
//!
//! # Error
//! The shader follows [`mod@reference`] to f32. The light of [`mod@reference`] itself, against adding and doubling over
//! optical depths from 0.3 to 16 and three heights of the sun, more than 8 degrees from the sun: median 4.5 %, 95th
//! percentile 19 %, the mean over directions within 12 %, in haze and in droplets
//! (`cargo test --test fog adding_and_doubling`). A layer's transmittance is exact. The mean of led patches along a ray
//! is within 1.4 % of the layer's mean density of a fine sum at p95 (`cargo test --lib tests::detour -- --nocapture`).
//!
//! # Cost
//! One function call in the full-screen composition (`shaders/fog/lookup.wgsl`, `fog_along`): no loop, no texture, no
//! table; about 12 exponentials and 12 square roots a pixel, fewer where light is neutral. On a software driver a frame
//! in patches takes 25 copies of a picture, and 38 where the wind leads them (`cargo bench --bench speed -- copies`).
//!
//! # Axes
//! Rays and directions are (east, north, up) at the camera, as everywhere in a frame.
//!
//! # What it needs of others
//! [`FogLight`]: direct sun at the layer's top, sky irradiance, ground albedo. [`Viewpoint`]: altitude of the
//! camera, planet and ground. Extinctions of air, haze and what falls, by species, at the station.
//!
//! # What is not here
//! No `passes.rs`: the composition draws the layer, which has no pass of its own.

#[cfg(not(feature = "lab"))]
pub(crate) mod candidates;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod candidates;
mod held;
pub mod laws;
pub mod light;
mod of_weather;
mod path;
pub mod patterns;
pub mod phase;
mod probe;
pub mod queries;
pub mod reference;
mod uniforms;
mod view;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, check_range};

pub use crate::{falling::FallingLayer, light::Phase, moment::MAX_EXTINCTION_PER_M};
pub use laws::{CompatibilityLaw, DistanceKind, cull_distance_m};
pub use probe::probe;
pub use queries::{
    Between, extinction_of_rvr_per_m, lights_range_m, runway_visual_range_m, transmittance_between,
    vertical_visibility_m, visibility_between_m,
};
pub use reference::{FallingModel, FogKind, FogModel, FogSample};
pub use uniforms::FogVariant;
#[cfg(not(feature = "lab"))]
pub(crate) use uniforms::{FogUniform, LowAirUniform};
#[cfg(feature = "lab")]
#[doc(hidden)]
pub use uniforms::{FogUniform, LowAirUniform};

pub(crate) use held::HeldFog;
pub(crate) use of_weather::{LowAir, dim};
pub(crate) use view::FogView;

/// Contrast left at the meteorological optical range (WMO-No. 8).
pub const CONTRAST_THRESHOLD: f64 = 0.05;

/// Total extinction at 550 nm, 1/m, of a visibility, m: -ln(0.05)/V (Koschmieder 1924 with the WMO threshold).
pub fn koschmieder_extinction_per_m(visibility_m: f64) -> f64 {
    -CONTRAST_THRESHOLD.ln() / visibility_m
}

/// Visibility, m, of a total extinction at 550 nm, 1/m; infinite for none. The inverse of
/// [`koschmieder_extinction_per_m`].
pub fn koschmieder_visibility_m(extinction_per_m: f64) -> f64 {
    -CONTRAST_THRESHOLD.ln() / extinction_per_m
}

/// How the layer's extinction changes with altitude. Altitudes in metres above mean sea level.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Profile {
    /// Constant between base and top with linear flanks, so that the optical depth has no kink.
    Slab {
        /// Where the lower flank is half-way, m; far below the ground for fog that lies on it.
        base_m: f64,
        /// Where the upper flank is half-way, m.
        top_m: f64,
        /// Height of the lower flank, m, \[0, 1e5\].
        base_softness_m: f64,
        /// Height of the upper flank, m, \[0, 1e5\]: dust thins out to twice its scale height, 40 km at most.
        top_softness_m: f64,
    },
    /// Falls as exp(-(h - reference)/scale); not cut off above or below.
    Exponential {
        /// Altitude at which the extinction has its stated value, m.
        reference_m: f64,
        /// Scale height, m, \[1, 1e5\].
        scale_height_m: f64,
    },
}

/// Horizontal patches (METAR BCFG): the extinction is multiplied by 1 + amount (s - 1), where s is a smooth pattern of
/// mean 1, fixed to the world, that reaches 0 between the patches.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Patches {
    /// 0 = even layer, 1 = clear gaps between patches.
    pub amount: f64,
    /// Typical distance between patches, m, \[5, 1e5\].
    pub size_m: f64,
    /// Chooses the pattern.
    #[serde(with = "seed_text")]
    pub seed: u64,
    /// How far the wind has carried the pattern (east, north), m.
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
    /// Shape in altitude.
    pub profile: Profile,
    /// Phase function.
    pub phase: Phase,
    /// Patches, if any.
    pub patches: Option<Patches>,
}

impl FogLayer {
    /// Water fog with the extinction of a budget's layer, lying on everything below `top_m`; droplets of 15 um.
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

    /// Refuses what is not a layer, by name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
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

/// The light that falls on the layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogLight {
    /// Unit vector to the sun, or at night to the moon: (east, north, up).
    pub to_sun: DVec3,
    /// Its direct irradiance at the layer's top, facing it, per channel (any unit; radiance comes out per that unit
    /// and steradian).
    pub sun_irradiance: [f64; 3],
    /// Irradiance of the sky on a horizontal surface at the layer's top, per channel.
    pub sky_irradiance: [f64; 3],
    /// Diffuse reflectance of the ground, per channel, \[0, 1\].
    pub ground_albedo: [f64; 3],
}

impl FogLight {
    /// Refuses light that is negative or not finite, by name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        if !(self.to_sun.length() - 1.0).abs().lt(&1e-3) {
            return Err(Error::range("fog.to_sun", "a unit vector", self.to_sun));
        }
        for i in 0..3 {
            check_range("fog.sun_irradiance", self.sun_irradiance[i], 0.0, 1e12, "")?;
            check_range("fog.sky_irradiance", self.sky_irradiance[i], 0.0, 1e12, "")?;
            check_range("fog.ground_albedo", self.ground_albedo[i], 0.0, 1.0, "")?;
        }
        Ok(())
    }
}

/// Where the camera is, as the fog sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Altitude of the camera above mean sea level, m, \[-1e4, 1e9\].
    pub altitude_m: f64,
    /// Place on the map, m east and north of any fixed point: only the patches' pattern depends on it.
    pub map_m: [f64; 2],
    /// Radius of the planet, m; infinite for a flat world.
    pub planet_radius_m: f64,
    /// Altitude of the planet's ground where the host drew none, m.
    pub ground_m: f64,
}

impl Viewpoint {
    /// A camera at `altitude_m` over a flat world.
    pub fn flat(altitude_m: f64) -> Self {
        Self { altitude_m, map_m: [0.0; 2], planet_radius_m: f64::INFINITY, ground_m: 0.0 }
    }

    /// Refuses what is not a viewpoint, by name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        check_range("altitude_m", self.altitude_m, -1e5, 1e9, "m")?;
        check_range("fog.ground_m", self.ground_m, -1e5, 1e5, "m")?;
        if self.planet_radius_m.is_nan() || self.planet_radius_m <= 1e3 {
            return Err(Error::range("planet_radius_m", "above 1000 m, or infinite", self.planet_radius_m));
        }
        for v in self.map_m {
            check_range("map_m", v, -2e12, 2e12, "m")?;
        }
        Ok(())
    }
}

/// Fog that is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Law {
    /// None.
    Clear,
    /// A physical layer, lit by sun and sky.
    Layer(FogLayer),
    /// One of the older simulators' laws.
    Compatibility(CompatibilityLaw),
}

impl Law {
    /// Refuses what is not a law, by name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        match self {
            Self::Clear => Ok(()),
            Self::Layer(layer) => layer.validate(),
            Self::Compatibility(law) => law.validate(),
        }
    }
}

/// A number of 64 bits as text: TOML's end at 63.
mod seed_text {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub fn serialize<S: Serializer>(seed: &u64, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(seed)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<u64, D::Error> {
        String::deserialize(from)?.parse().map_err(D::Error::custom)
    }
}
