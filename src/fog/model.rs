//! Model of a frame's fog, prepared in f64. Shaders, their f64 reference and queries read it.

use glam::DVec3;

use super::{curtains::Curtains, laws::DistanceKind, light::Solution};
use crate::{light::PhaseLobes, wind::Detour};

/// Number of plane waves in the patches' pattern: one for each pair of four waves.
pub const PATCH_WAVES: usize = 6;

/// Kind of a fog model, by which shaders branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum FogKind {
    /// No layer.
    Clear = 0,
    /// Slab with linear flanks.
    Slab = 1,
    /// Exponential layer.
    Exponential = 2,
    /// Linear law.
    Linear = 3,
    /// Exponential law.
    ExponentialLaw = 4,
    /// Exponential-squared law.
    ExponentialSquared = 5,
}

/// One source term of scattered light, c(mu) = `even` + mu `odd`, per channel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Term {
    /// Part that does not depend on direction.
    pub even: DVec3,
    /// Factor of the cosine between the view direction and up.
    pub odd: DVec3,
}

impl Term {
    /// Returns the term for the cosine `mu` between the view direction and up.
    pub(super) fn at(&self, mu: f64) -> DVec3 {
        self.even + self.odd * mu
    }
}

/// Fog of a frame, prepared in f64; [`FogModel::uniform`] returns its form for shaders. Radiances and source terms are
/// in the unit of the light's irradiance ([`super::FogLight`]) per steradian.
#[derive(Clone, Debug, PartialEq)]
pub struct FogModel {
    /// Kind of the fog.
    pub kind: FogKind,
    /// Kind of distance of the compatibility laws.
    pub distance: DistanceKind,
    /// Altitude of the camera, m.
    pub altitude: f64,
    /// 1/(planet radius + altitude), 1/m; 0 for a flat world.
    pub curvature: f64,
    /// Altitude of the ground, m, at which descending rays without an object end.
    pub ground: f64,
    /// For a slab: altitudes where the flanks begin and end (base 0, base 1, top 0, top 1), m. For an exponential
    /// layer: reference altitude and scale height.
    pub knots: [f64; 4],
    /// 1/height of the slab's flanks, 1/m.
    pub inverse_flanks: [f64; 2],
    /// Extinction at 550 nm, 1/m; density of the compatibility laws.
    pub extinction: f64,
    /// Start and end of the linear law, m.
    pub linear: [f64; 2],
    /// Height of the band of sky that the compatibility laws cover, rad.
    pub sky_band: f64,
    /// Ratio of each channel's extinction to that at 550 nm.
    pub ratio: DVec3,
    /// Ratio of each channel's delta-scaled optical depth to the depth at 550 nm.
    pub scaling: DVec3,
    /// Optical depth at 550 nm of the layer and the precipitation together, from the top to the ground.
    pub depth_total: f64,
    /// Unit vector towards the sun, or the moon if it is brighter (east, north, up).
    pub to_sun: DVec3,
    /// 1/cosine of the sun's zenith angle, as used in the solution of the slab.
    pub inverse_mu0: f64,
    /// Phase function.
    pub lobes: PhaseLobes,
    /// Share of scattering that counts as forward.
    pub forward: f64,
    /// Asymmetry of the rest of the scattering.
    pub smooth: f64,
    /// Whether a channel absorbs so much that `rise` and `fall` are used.
    pub absorbing: bool,
    /// Diffusion exponent per channel; 0 for a channel without `rise` and `fall`.
    pub k: DVec3,
    /// Constant source term.
    pub constant: Term,
    /// Source term per unit of scaled depth.
    pub slope: Term,
    /// Source term times e^(-depth/mu0).
    pub beam: Term,
    /// Source term times e^(-k depth).
    pub rise: Term,
    /// Source term times e^(-k (total - depth)).
    pub fall: Term,
    /// First scattering, to be multiplied by the phase function and e^(-depth/mu0). For the compatibility laws, their
    /// colour.
    pub first: DVec3,
    /// Mean radiance of the sky above the layer.
    pub sky_radiance: DVec3,
    /// Radiance of the ground below the layer.
    pub ground_radiance: DVec3,
    /// Solutions of the layer's light per channel; `None` without a layer.
    pub solutions: Option<[Solution; 3]>,
    /// Light at the camera as a share of the light above the layer. Inside the layer, the light that clear air
    /// scatters is reduced to this share.
    pub lit: f64,
    /// Strength of the patches, 0 (even) to 1.
    pub patch_amount: f64,
    /// Waves of the patches, as (wave vector, rad/m, phase at the camera, rad).
    pub patch_waves: [(DVec3, f64); PATCH_WAVES],
    /// Lag of the patches where the wind flows round obstacles.
    pub(crate) detour: Option<Detour>,
    /// Precipitation in the layer and above it.
    pub falling: FallingModel,
}

/// Precipitation as a separate medium. Below the altitude where it begins, its extinction is uniform except for
/// curtains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallingModel {
    /// Extinction at 550 nm, 1/m; 0 if nothing falls.
    pub extinction: f64,
    /// Altitudes between which the extinction decreases to 0, m.
    pub top: [f64; 2],
    /// 1/difference of the two altitudes in `top`, 1/m.
    pub inverse_flank: f64,
    /// Curtains of the rain.
    pub curtains: Curtains,
}

impl FallingModel {
    /// No precipitation.
    pub const NONE: Self = Self { extinction: 0.0, top: [0.0; 2], inverse_flank: 1.0, curtains: Curtains::NONE };
}
