//! Uniform blocks of fog, and the features that a pipeline needs to draw a model.

use glam::DVec3;

use super::{
    curtains::CURTAIN_WAVES,
    laws::DistanceKind,
    model::{FogKind, FogModel, PATCH_WAVES, Term},
    reference::FORWARD_SPREAD,
};
use crate::{regions::MAX_REGION_CORNERS, wind::DETOUR_SIDE};

/// Largest number of banks in a picture: `MOST_BANKS` of `shaders/fog/uniform.wgsl`.
pub(super) const MOST_BANKS: usize = 8;

/// Depth under the ground or under the camera, whichever is lower, m. A slab's lower edge that lies deeper is left out.
/// The depth is large enough for valleys and pits that hosts draw.
const MARGIN_M: f64 = 2000.0;

impl FogModel {
    /// Returns the fewest features that a pipeline needs to draw this model.
    pub fn variant(&self) -> FogVariant {
        let even = |v: DVec3| v.x == v.y && v.y == v.z;
        FogVariant {
            kinds: 1 << self.kind as u32,
            absorbing: self.absorbing,
            patches: self.patch_amount > 0.0,
            curtains: self.falling.curtains.amount > 0.0,
            falling: self.falling.extinction > 0.0,
            neutral: even(self.ratio) && even(self.scaling) && even(self.k),
            detour: self.detour.is_some(),
            lifted: self.kind == FogKind::Slab && self.knots[1] > self.ground.min(self.altitude) - MARGIN_M,
            bank_shapes: 0,
            banks_overlap: false,
        }
    }

    /// Returns the block that shaders read (`FogUniform` of `fog/uniform.wgsl`).
    #[doc(hidden)]
    pub fn uniform(&self) -> FogUniform {
        let v = |d: DVec3| d.as_vec3().to_array();
        let lobes = &self.lobes;
        // Shaders raise these asymmetries to powers by exponentials of the logarithms. An asymmetry of 0 stays small at
        // any power.
        let log = |x: f64| x.abs().max(1e-9).ln() as f32;
        FogUniform {
            to_sun: v(self.to_sun),
            altitude: self.altitude as f32,
            knots: self.knots.map(|k| k as f32),
            ratio: v(self.ratio),
            extinction: self.extinction as f32,
            scaling: v(self.scaling),
            depth_total: self.depth_total as f32,
            pair: if self.kind == FogKind::Slab { self.inverse_flanks } else { self.linear }.map(|k| k as f32),
            sky_band: self.sky_band as f32,
            plane_distance: u32::from(self.distance == DistanceKind::Plane),
            lobes: [log(lobes.g_hg), log(lobes.g_draine), lobes.alpha as f32, lobes.w_draine as f32],
            radius: if self.curvature > 0.0 { (1.0 / self.curvature) as f32 } else { 1e30 },
            curvature: self.curvature as f32,
            ground: self.ground as f32,
            inverse_mu0: self.inverse_mu0 as f32,
            k: v(self.k),
            absorbing: u32::from(self.absorbing),
            first: v(self.first),
            patch_amount: self.patch_amount as f32,
            sky_radiance: v(self.sky_radiance),
            kind: self.kind as u32,
            ground_radiance: v(self.ground_radiance),
            spread: FORWARD_SPREAD as f32,
            scattering: [(1.0 - lobes.w_draine).ln(), lobes.g_hg.signum(), self.forward, self.smooth].map(|k| k as f32),
            constant: term(&self.constant),
            slope: term(&self.slope),
            beam: term(&self.beam),
            rise: term(&self.rise),
            fall: term(&self.fall),
            patch_waves: self.patch_waves.map(wave),
            curtain_waves: self.falling.curtains.waves.map(wave),
            falling: [self.falling.extinction, self.falling.top[0], self.falling.top[1], self.falling.inverse_flank]
                .map(|k| k as f32),
            lit: self.lit as f32,
            curtain_amount: self.falling.curtains.amount as f32,
            waves: [(self.patch_amount > 0.0, PATCH_WAVES), (self.falling.curtains.amount > 0.0, CURTAIN_WAVES)]
                .map(|(any, count)| if any { count as u32 } else { 0 }),
        }
    }
}

/// Features of a pipeline with `fog/lookup.wgsl`. A GPU skips branches that the uniform does not select, so one
/// pipeline for [`FogVariant::ALL`] serves every fog without detours and banks. Software drivers execute every branch.
/// They are three times as fast with only the features that a model needs ([`FogModel::variant`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FogVariant {
    /// Kinds of fog: bit k is kind k of [`FogKind`].
    pub kinds: u32,
    /// Whether layers may absorb.
    pub absorbing: bool,
    /// Whether layers may have patches.
    pub patches: bool,
    /// Whether patches may flow round obstacles to the wind.
    pub detour: bool,
    /// Whether there may be precipitation.
    pub falling: bool,
    /// Whether rain may have curtains.
    pub curtains: bool,
    /// Whether all channels of a layer are equal.
    pub neutral: bool,
    /// Whether slabs may have a lower edge.
    pub lifted: bool,
    /// Shapes of the fog banks: bit k is kind k of the shaders' `FogBank`; 0 without banks.
    pub bank_shapes: u32,
    /// Whether regions of banks may overlap.
    pub banks_overlap: bool,
}

impl FogVariant {
    /// All features except detours and banks.
    pub const ALL: Self = Self {
        kinds: 63,
        absorbing: true,
        patches: true,
        detour: false,
        falling: true,
        curtains: true,
        neutral: false,
        lifted: true,
        bank_shapes: 0,
        banks_overlap: false,
    };

    /// Returns all features except banks, with detours only if the model has any.
    pub fn all_of(model: &FogModel) -> Self {
        Self { detour: model.detour.is_some(), ..Self::ALL }
    }

    /// Returns the values of the `override` constants of `fog/lookup.wgsl`.
    pub fn constants(&self) -> [(&'static str, f64); 8] {
        let flag = |b: bool| f64::from(u8::from(b));
        [
            ("FOG_KINDS", f64::from(self.kinds)),
            ("FOG_ABSORBING", flag(self.absorbing)),
            ("FOG_PATCHES", flag(self.patches)),
            ("FOG_DETOUR", flag(self.detour)),
            ("FOG_FALLING", flag(self.falling)),
            ("FOG_CURTAINS", flag(self.curtains)),
            ("FOG_NEUTRAL", flag(self.neutral)),
            ("FOG_LIFTED", flag(self.lifted)),
        ]
    }

    /// Returns the values of the `override` constants of `fog/banks.wgsl`, except `BY_PLACE` and those of
    /// `fog/lookup.wgsl`.
    pub(super) fn bank_constants(&self) -> [(&'static str, f64); 2] {
        [("BANK_SHAPES", f64::from(self.bank_shapes)), ("BANKS_OVERLAP", f64::from(u8::from(self.banks_overlap)))]
    }
}

/// Returns a wave as shaders read it: wave vector, rad/m, and phase, rad.
fn wave((k, phase): (DVec3, f64)) -> [f32; 4] {
    [k.x as f32, k.y as f32, k.z as f32, phase as f32]
}

/// Returns a source term as shaders read it: `even`, then `odd`.
fn term(t: &Term) -> [[f32; 4]; 2] {
    [t.even, t.odd].map(|v| [v.x as f32, v.y as f32, v.z as f32, 0.0])
}

/// [`FogModel`] in the layout of the shaders; tests compare the offsets with naga's.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct FogUniform {
    /// Unit vector towards the sun, or the moon if it is brighter (east, north, up).
    pub to_sun: [f32; 3],
    /// Altitude of the camera, m.
    pub altitude: f32,
    /// Slab: altitudes where the flanks begin and end, m. Exponential layer: reference altitude, scale height, m.
    pub knots: [f32; 4],
    /// Ratio of each channel's extinction to that at 550 nm.
    pub ratio: [f32; 3],
    /// Extinction at 550 nm, 1/m; density of the compatibility laws.
    pub extinction: f32,
    /// Ratio of each channel's delta-scaled optical depth to the depth at 550 nm.
    pub scaling: [f32; 3],
    /// Optical depth from the layer's top to the ground, at 550 nm.
    pub depth_total: f32,
    /// Slab: 1/height of the lower and the upper flank, 1/m. Linear law: start and end, m.
    pub pair: [f32; 2],
    /// Height of the band of sky that the compatibility laws cover, rad.
    pub sky_band: f32,
    /// 1 if the compatibility laws measure from the camera's plane, otherwise 0.
    pub plane_distance: u32,
    /// Phase function: ln of Henyey-Greenstein |g|, ln of Draine |g|, Draine alpha, weight of Draine.
    pub lobes: [f32; 4],
    /// Distance of the camera from the planet's centre, m; 1e30 for a flat world.
    pub radius: f32,
    /// 1/(planet radius + altitude), 1/m; 0 for a flat world.
    pub curvature: f32,
    /// Altitude at which rays without an object end, m.
    pub ground: f32,
    /// 1/cosine of the sun's zenith angle.
    pub inverse_mu0: f32,
    /// Diffusion exponent per channel of absorbing layers.
    pub k: [f32; 3],
    /// 1 if the exponential terms `rise` and `fall` are used, otherwise 0.
    pub absorbing: u32,
    /// First scattering, to be multiplied by the phase function and e^(-depth/mu0); colour of the compatibility laws.
    pub first: [f32; 3],
    /// Strength of the patches, 0 to 1.
    pub patch_amount: f32,
    /// Mean radiance of the sky above the layer.
    pub sky_radiance: [f32; 3],
    /// Kind of the fog, a value of [`FogKind`].
    pub kind: u32,
    /// Radiance of the ground below the layer.
    pub ground_radiance: [f32; 3],
    /// Spread of the forward lobe in elevation, rad.
    pub spread: f32,
    /// ln(1 - weight of Draine); sign of the Henyey-Greenstein g; share of scattering that counts as forward; asymmetry
    /// of the rest.
    pub scattering: [f32; 4],
    /// Constant source term c(mu) = [0] + mu [1] of scattered light, where mu is the cosine between the view direction
    /// and up.
    pub constant: [[f32; 4]; 2],
    /// Source term per unit of scaled depth below the top.
    pub slope: [[f32; 4]; 2],
    /// Source term times e^(-depth/mu0).
    pub beam: [[f32; 4]; 2],
    /// Source term times e^(-k depth).
    pub rise: [[f32; 4]; 2],
    /// Source term times e^(-k (total - depth)).
    pub fall: [[f32; 4]; 2],
    /// Waves of the patches: wave vector, rad/m, and phase at the camera, rad.
    pub patch_waves: [[f32; 4]; PATCH_WAVES],
    /// Waves of the curtains of rain: wave vector, rad/m, and phase at the camera, rad.
    pub curtain_waves: [[f32; 4]; CURTAIN_WAVES],
    /// Precipitation: extinction at 550 nm, 1/m; altitudes between which it decreases to 0, m; 1/their difference, 1/m.
    pub falling: [f32; 4],
    /// Light at the camera as a share of the light above the layer. Inside the layer, the light that clear air
    /// scatters is reduced to this share.
    pub lit: f32,
    /// Amplitude of each wave of the curtains, relative to the extinction of all that falls.
    pub curtain_amount: f32,
    /// Numbers of waves of the patches and of the curtains; 0 if there are none.
    pub waves: [u32; 2],
}

/// `FogBank` of `shaders/fog/uniform.wgsl`: the low layer of a weather region, and the region's plan.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct FogBankUniform {
    /// Layer, and its light.
    pub fog: FogUniform,
    /// Unit vectors to the right and ahead on the plan, each (east, north).
    pub axes: [f32; 4],
    /// Position of the camera on the plan, m (right, ahead).
    pub camera: [f32; 2],
    /// Half extents of the shape, m.
    pub half: [f32; 2],
    /// Radius of a rectangle's corners, m.
    pub corner: f32,
    /// Width of the band outside the shape in which the bank fades, m.
    pub perimeter: f32,
    /// Weight of the region inside its shape.
    pub strength: f32,
    /// Distance of the shape's farthest point from its centre, m.
    pub radius: f32,
    /// Kind of the shape: 0 a rectangle, 1 an ellipse, 2 a convex polygon, 3 another polygon.
    pub kind: u32,
    /// Number of a polygon's corners.
    pub count: u32,
    /// Banks whose regions may overlap that of this bank: bit j for bank j.
    pub overlaps: u32,
    /// 1 if the region is averaged with earlier regions, 0 if it covers them.
    pub merges: u32,
    /// Corners of a polygon, two to a vector, counter-clockwise if the polygon is convex.
    pub corners: [[f32; 4]; MAX_REGION_CORNERS / 2],
}

/// `LowAir` of `shaders/fog/uniform.wgsl`: the fog of a frame, its banks, and the detours of its patches round
/// obstacles to the wind.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct LowAirUniform {
    /// Fog of the frame outside all banks.
    pub fog: FogUniform,
    /// Number of nodes in a metre of the map of detours, east and north, 1/m.
    pub detour_scale: [f32; 2],
    /// Position of the camera in the map, in nodes from its south-west corner, east and north.
    pub detour_camera: [f32; 2],
    /// Altitude of the map's floor relative to the camera, m.
    pub detour_floor: f32,
    /// 1/height above the floor at which detours end, 1/m.
    pub detour_fade: f32,
    /// Numbers of all banks, and of those that the camera may see.
    pub bank_count: [u32; 2],
    /// Lags at the nodes, m east and north: how much less far the wind has carried the air than free air. Each vector
    /// has two nodes; nodes are in order from west to east, then south to north.
    pub lags: [[f32; 4]; DETOUR_SIDE * DETOUR_SIDE / 2],
    /// Indices of the banks that the camera may see, from far to near: four bits each, with the farthest bank in the
    /// lowest bits.
    pub bank_order: u32,
    /// Padding, which WGSL adds by itself.
    pub pad: [u32; 3],
    /// Banks in the order of the world's regions.
    pub banks: [FogBankUniform; MOST_BANKS],
}

impl Default for LowAirUniform {
    fn default() -> Self {
        bytemuck::Zeroable::zeroed()
    }
}

impl LowAirUniform {
    /// Returns the size of the block with `banks` banks and without the rest of the list, bytes.
    pub(super) fn size_with(banks: usize) -> usize {
        std::mem::offset_of!(Self, banks) + banks * size_of::<FogBankUniform>()
    }

    /// Sets a frame's fog without banks. If the model has no detours, those of an earlier frame remain in the block,
    /// and no shader reads them.
    pub fn set(&mut self, model: &FogModel) {
        self.fog = model.uniform();
        (self.bank_count, self.bank_order) = ([0; 2], 0);
        let Some(detour) = &model.detour else { return };
        self.detour_scale = detour.scale.as_vec2().to_array();
        self.detour_camera = detour.camera.as_vec2().to_array();
        self.detour_floor = detour.floor_m as f32;
        self.detour_fade = detour.fade_per_m as f32;
        self.lags.as_flattened_mut().copy_from_slice(detour.map.lags_m.as_flattened());
    }
}
