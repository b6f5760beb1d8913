//! Read-only data of a frame for its effects: [`FrameContext`] before anything is drawn, and a [`DrawContext`] for each
//! draw.

use std::sync::Arc;

use glam::DMat4;

use super::{
    frame::{ColorSpace, Frame},
    stages::Stages,
};
use crate::{
    gpu::{Device, Layer},
    light::ToneCurve,
    moment::SceneMoment,
    plan::parts::{MOST_PARTS, MOST_RUNGS, Part},
    planet::Planet,
    scene::ViewRays,
    world::{HeldEffects, World},
};

/// A frame before any of it is drawn.
pub(crate) struct FrameContext<'a> {
    pub device: &'a Arc<Device>,
    /// Camera, flags and images from the host.
    pub frame: &'a Frame<'a>,
    pub now: &'a SceneMoment<'a>,
    pub world: &'a World,
    /// Simulation state of the effects.
    pub held: HeldEffects<'a>,
    /// Stages that the call asks for.
    pub asked: Stages,
    /// Planet with the air that it will have at the camera some seconds from now. `None` as in
    /// [`World::planet_ahead`].
    pub planet_ahead: Option<Planet>,
    /// Work on tables in this frame, as a share of the work that builds all of them.
    pub table_share: f32,
    /// Whether directions outside the picture are drawn, too: for the cube map of the surroundings.
    pub all_around: bool,
    /// Whether to draw with the existing tables of the planet, even if these belong to another weather.
    pub keeps_tables: bool,
}

/// The host's picture that a call draws into.
#[derive(Clone, Copy)]
pub(crate) struct DrawTarget<'a> {
    pub color: Layer<'a>,
    pub rays: &'a ViewRays,
    /// Display units per cd/m^2.
    pub exposure: f64,
    /// Whether fog and air are drawn over the picture in this call, or have been in an earlier call of the frame.
    pub is_veiled: bool,
}

/// Shares that the plan has chosen for a draw.
#[derive(Clone, Copy)]
pub(crate) struct PlannedShares {
    parts: &'static [Part],
    shares: [[f32; MOST_RUNGS - 1]; MOST_PARTS],
    /// Whether the plan gauges what each part is worth.
    pub is_gauged: bool,
}

impl PlannedShares {
    /// Shares with which everything is drawn.
    pub fn whole(parts: &'static [Part]) -> Self {
        Self { parts, shares: [[1.0; MOST_RUNGS - 1]; MOST_PARTS], is_gauged: false }
    }

    /// Creates the shares from `share`, which takes the index of a part in `parts` and the index of one of its steps
    /// from a rung to the next lower one.
    pub fn new(parts: &'static [Part], is_gauged: bool, share: impl Fn(usize, usize) -> f32) -> Self {
        let mut planned = Self { is_gauged, ..Self::whole(parts) };
        for (part, shares) in planned.shares.iter_mut().enumerate().take(parts.len()) {
            for (step, to) in shares.iter_mut().enumerate().take(parts[part].rungs.len() - 1) {
                *to = share(part, step);
            }
        }
        planned
    }

    /// Drawn share of a part's step; 1 for a part that is not in the list.
    pub fn share(&self, part: &Part, step: usize) -> f32 {
        let place = self.parts.iter().position(|p| p.name == part.name);
        place.map_or(1.0, |i| self.shares[i][step])
    }
}

/// Tone curve that a picture's exposed light has gone through.
pub(crate) type Tone = fn(f64) -> f64;

/// One draw of a frame into the host's picture.
#[derive(Clone, Copy)]
pub(crate) struct DrawContext<'a> {
    pub device: &'a Arc<Device>,
    /// Camera, flags and images from the host.
    pub frame: &'a Frame<'a>,
    pub now: &'a SceneMoment<'a>,
    pub target: DrawTarget<'a>,
    /// Stages of the draw.
    pub stages: Stages,
    pub plan: PlannedShares,
}

impl DrawContext<'_> {
    /// Drawn share of a part's step.
    pub fn share(&self, part: &Part, step: usize) -> f32 {
        self.plan.share(part, step)
    }

    /// The host's picture.
    pub fn picture(&self) -> &wgpu::Texture {
        self.target.color.texture
    }

    /// Number of pixels of the picture.
    pub fn pixels(&self) -> u64 {
        u64::from(self.picture().width()) * u64::from(self.picture().height())
    }

    /// Returns the tone curve that is applied to exposed light in this picture.
    pub fn tone(&self) -> Tone {
        match (self.frame.color_space, self.now.tone) {
            (ColorSpace::SceneLinear, _) | (_, ToneCurve::Linear) => |x| x,
            (_, ToneCurve::Exponential) => |x| ToneCurve::Exponential.apply(x),
            (_, ToneCurve::Filmic) => |x| ToneCurve::Filmic.apply(x),
        }
    }

    /// Matrix from camera-relative (east, north, up) to clip space.
    pub fn clip(&self) -> DMat4 {
        let camera = &self.frame.camera;
        camera.projection * DMat4::from_mat3(camera.rotation() * self.now.scene.world_to_enu.transpose())
    }
}
