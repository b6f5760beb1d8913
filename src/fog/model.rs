//! Model of a frame's fog, prepared in f64: shaders, their twin and queries read it.

use glam::DVec3;

use super::{curtains::Curtains, laws::DistanceKind, light::Solution};
use crate::{light::PhaseLobes, wind::Detour};

/// Number of plane waves in the patches' pattern: the pairs of four.
pub const PATCH_WAVES: usize = 6;

/// Kind of a fog model: the shader's switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum FogKind {
    /// Nothing.
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

/// One light source term c(mu) = `even` + mu `odd`, per channel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Term {
    /// Independent of direction.
    pub even: DVec3,
    /// Times the cosine of the view with up.
    pub odd: DVec3,
}

impl Term {
    pub(super) fn at(&self, mu: f64) -> DVec3 {
        self.even + self.odd * mu
    }
}

/// All that a frame's fog needs, prepared in f64; [`FogModel::uniform`] is its form for shaders.
#[derive(Clone, Debug, PartialEq)]
pub struct FogModel {
    /// Kind of fog that is drawn.
    pub kind: FogKind,
    /// Distance of the compatibility laws.
    pub distance: DistanceKind,
    /// Altitude of the camera, m.
    pub altitude: f64,
    /// 1/(planet radius + altitude), 1/m; 0 for a flat world.
    pub curvature: f64,
    /// Altitude at which rays without an object end in the ground, m.
    pub ground: f64,
    /// Slab: altitudes where the flanks begin and end (base 0, base 1, top 0, top 1), m. Exponential: reference
    /// altitude, scale height.
    pub knots: [f64; 4],
    /// 1/height of the slab's flanks, 1/m.
    pub inverse_flanks: [f64; 2],
    /// Extinction at 550 nm, 1/m; density of the compatibility laws.
    pub extinction: f64,
    /// Start and end of the linear law, m.
    pub linear: [f64; 2],
    /// Band of the sky that the compatibility laws cover, rad.
    pub sky_band: f64,
    /// Extinction of each channel over that at 550 nm.
    pub ratio: DVec3,
    /// Scaled (delta) optical depth over depth at 550 nm.
    pub scaling: DVec3,
    /// Depth at 550 nm from the layer's top to the ground.
    pub depth_total: f64,
    /// Unit vector to the sun.
    pub to_sun: DVec3,
    /// 1/cosine of the sun's zenith angle, as the slab was solved.
    pub inverse_mu0: f64,
    /// Phase function.
    pub lobes: PhaseLobes,
    /// Share of scattering counted as forward, and asymmetry of the rest.
    pub forward: f64,
    /// See `forward`.
    pub smooth: f64,
    /// Whether the exponential terms are used.
    pub absorbing: bool,
    /// Diffusion exponent per channel.
    pub k: DVec3,
    /// Source terms: constant, per scaled depth, beam, from the top, from the bottom.
    pub constant: Term,
    /// Per scaled depth.
    pub slope: Term,
    /// Times e^(-depth/mu0).
    pub beam: Term,
    /// Times e^(-k depth).
    pub rise: Term,
    /// Times e^(-k (total - depth)).
    pub fall: Term,
    /// First scattering: times phase and e^(-depth/mu0). The colour of the compatibility laws.
    pub first: DVec3,
    /// Mean radiance of the sky above the layer.
    pub sky_radiance: DVec3,
    /// Radiance of the ground below it.
    pub ground_radiance: DVec3,
    /// The layer's light per channel, as it was solved; `None` without a layer.
    pub solutions: Option<[Solution; 3]>,
    /// Share of the light above the layer that reaches the camera: that of the air inside it.
    pub lit: f64,
    /// Patches: share, and waves as (wave vector, phase at the camera).
    pub patch_amount: f64,
    /// See `patch_amount`.
    pub patch_waves: [(DVec3, f64); PATCH_WAVES],
    /// How obstacles to the wind lead the patches.
    pub(crate) detour: Option<Detour>,
    /// Precipitation through it and above it.
    pub falling: FallingModel,
}

/// Precipitation as a medium of its own: the same everywhere below the altitude where it begins, and in curtains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallingModel {
    /// Extinction at 550 nm, 1/m; 0 where nothing falls.
    pub extinction: f64,
    /// Altitudes between which it falls off to nothing, m.
    pub top: [f64; 2],
    /// 1/their distance, 1/m.
    pub inverse_flank: f64,
    /// Curtains of the rain among it.
    pub curtains: Curtains,
}

impl FallingModel {
    /// Nothing falls.
    pub const NONE: Self = Self { extinction: 0.0, top: [0.0; 2], inverse_flank: 1.0, curtains: Curtains::NONE };
}
