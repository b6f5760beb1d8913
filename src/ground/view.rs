//! Water and snow on the ground in a view; nothing is drawn while no surface has water or snow.

use glam::DMat3;

use super::{
    held::HeldGround,
    seen::GroundSeen,
    uniform::{DropsKept, GroundUniform, WetScene},
    window::TerrainWindow,
};
use crate::{
    error::Result,
    gpu::{
        Device,
        blocks::{Blocks, UniformBlock},
    },
    moment::SceneMoment,
    scene::WorldKind,
    stage::{
        Block, Contribution, DrawContext, DrawnEffect, Exchange, Frame, FrameContext, FrameFlags, Output, Outputs,
        Stages, Texture, flag, is_float, rounding,
    },
};

/// Limit for light in units of the host's target: the largest half float, 65 504, less a margin for later passes.
const MOST_UNITS: f64 = 6e4;

/// Ground of a view.
pub(crate) struct GroundView {
    uniform: UniformBlock,
    /// Uniform block of the frame; `None` if no surface has water or snow, or if the frame lacks colour or depth.
    block: Option<GroundUniform>,
    /// Whether the host's terrain is around the camera.
    has_terrain: bool,
    /// Whether there is snow on any surface.
    has_snow: bool,
    /// Whether there is water or clear ice on any surface.
    has_water: bool,
    /// Texture views of the water and the surface of the host's terrain.
    views: [Option<wgpu::TextureView>; 2],
    /// Textures of the host's tiles around the camera.
    window: TerrainWindow,
    drops: DropsKept,
}

impl GroundView {
    /// Creates the ground of a new view.
    pub fn new(device: &Device, blocks: &Blocks) -> Self {
        let uniform = blocks.block(device, size_of::<GroundUniform>());
        let (window, drops) = (TerrainWindow::default(), DropsKept::default());
        let (has_terrain, has_snow, has_water) = (false, false, false);
        Self { uniform, block: None, has_terrain, has_snow, has_water, views: [None, None], window, drops }
    }
}

impl DrawnEffect for GroundView {
    fn gathers(&self) -> Exchange {
        Exchange { needs: &[Output::FogDepth, Output::Sea], ..Exchange::NONE }
    }

    fn gather(&mut self, context: &FrameContext<'_>, given: &mut Outputs) -> Result<()> {
        let (now, frame, held) = (context.now, context.frame, context.held.of::<HeldGround>()?);
        let seen = held.seen(context.world, now);
        let glaze = glaze(now);
        self.has_water = seen.has_wet_terrain || seen.cover.wetness > 0.0 || seen.cover.puddles > 0.0 || glaze > 0.0;
        self.has_terrain = seen.terrain.is_some();
        self.has_snow = seen.snow.depth_m > 0.0 || seen.has_snowy_terrain;
        self.block = None;
        if let (true, Some(color), Some(_)) = (self.has_water || self.has_snow, frame.color, frame.depth) {
            let scene = wet_scene(now, (frame, color), &seen, glaze, given)?;
            self.block = Some(scene.uniform(&mut self.drops));
        }
        // Takes the textures of the host's tiles around the camera, or of its grid. They are updated only if the
        // surface pass is drawn.
        let is_drawn = self.block.is_some() && context.asked.has(Stages::SURFACE);
        self.views = match held.shown_tiles(context.world, now.here.surface.ice) {
            Some(shown) if is_drawn => self.window.views(context.device, now.eye, &shown),
            Some(_) => [None, None],
            None => held.views(context.device, is_drawn, context.world.snow.as_deref()),
        };
        Ok(())
    }

    fn stages(&self) -> Stages {
        if self.block.is_some() { Stages::SURFACE } else { Stages(0) }
    }

    fn compose(&mut self, context: &DrawContext<'_>, _given: &Outputs, added: &mut Contribution) -> Result<()> {
        let drawn = self.block.as_ref().filter(|_| context.stages.has(Stages::SURFACE));
        let has_rings = self.has_water && drawn.is_some_and(GroundUniform::has_rings);
        for (name, is_there) in
            [("TERRAIN", self.has_terrain), ("SNOW", self.has_snow), ("WATER", self.has_water), ("RINGS", has_rings)]
        {
            let value = flag(drawn.is_some() && is_there);
            added.constant(name, value, value);
        }
        if let Some(block) = drawn {
            added.require_panorama();
            self.uniform.write(bytemuck::bytes_of(block));
        }
        added.set_block(Block::OnSurfaces, &self.uniform);
        let [water, surface] = &self.views;
        added.set_texture(Texture::OnGround, water.clone());
        added.set_texture(Texture::Terrain, surface.clone());
        Ok(())
    }
}

/// Returns the share of level ground under clear ice, which forms while freezing rain falls at the camera; otherwise 0.
fn glaze(now: &SceneMoment<'_>) -> f64 {
    let falling = &now.here.precipitation;
    let falls = (falling.rain_mm_h + falling.drizzle_mm_h) * falling.freezing > 0.0;
    if falls { now.here.surface.ice } else { 0.0 }
}

/// Returns the rotation from the axes of the host's normals to east, north, up, and the scale and offset that decode
/// the stored numbers: normalised formats hold (n + 1) / 2.
fn normals(frame: &Frame<'_>, now: &SceneMoment<'_>) -> (DMat3, [f32; 2]) {
    let from_eye = now.scene.world_to_enu * frame.camera.rotation().transpose();
    let turned = if frame.flags.has(FrameFlags::NORMALS_IN_EYE_SPACE) { from_eye } else { now.scene.world_to_enu };
    let signed = frame.normals.is_some_and(|n| is_float(n.format()));
    (turned, if signed { [1.0, 0.0] } else { [2.0, -1.0] })
}

/// Collects the inputs of the block of `shaders/ground/uniform.wgsl`.
fn wet_scene<'a>(
    now: &'a SceneMoment<'_>,
    (frame, color): (&Frame<'_>, &wgpu::Texture),
    held: &'a GroundSeen<'_>,
    glaze: f64,
    given: &Outputs,
) -> Result<WetScene<'a>> {
    let (width, height) = (f64::from(color.width()), f64::from(color.height()));
    let down = if frame.origin_bottom_left { 2.0 } else { -2.0 };
    Ok(WetScene {
        scene: &now.scene,
        cover: &held.cover,
        snow: held.snow,
        terrain_has_snow: held.terrain_has_snow,
        falling: now.here.precipitation,
        glaze,
        hollows: held.hollows,
        position: now.eye,
        time_s: now.time_s,
        curvature: match now.weather.world.kind {
            WorldKind::Flat => 0.0,
            WorldKind::Tangent | WorldKind::Ecef => 1.0 / (now.planet_radius_m + now.scene.place.altitude_m),
        },
        fog_depth: given.fog_depth,
        sea_top_m: given.sea_top_m,
        pixel: [2.0 / width, down / height],
        depth_rounding: frame.depth.map_or([0.0; 2], rounding),
        most_cd_m2: MOST_UNITS * frame.cd_m2_per_unit,
        terrain: held.terrain,
        surface_class: held.surface_class,
        normals: normals(frame, now),
        wind_m_s: now.is_sheltered().then(|| now.carrying().map(|c| c.velocity_m_s())).transpose()?,
    })
}
