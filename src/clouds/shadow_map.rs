//! The map of the clouds' shadows that pictures read: a window about the camera in a plane at the station's height, fixed to the air that
//! carries the clouds, so that a frame makes only some rows of it anew.

use glam::{DVec2, DVec3};

use super::{
    field::Shape,
    rows::{self, Rows},
    shadow::LOWEST,
    tables::CloudTables,
    uniforms::ShadowUniform,
};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        flat_texture,
        pass::{self, FullscreenDesc},
    },
    moment::Moment,
    weather::smoothstep,
};

/// Along a side of the map.
const TEXELS: u32 = 512;
/// Metres a texel.
const TEXEL_M: f64 = 40.0;
/// Rows that a frame makes anew: a whole map within a second of frames, in which clouds change by a thousandth of their life.
const ROWS: u32 = 8;
/// Sines of the light's elevation between which shadows begin to be told apart.
const TOLD: [f64; 2] = [LOWEST, 0.07];
/// Time between two frames, s, the light's turn, and the change of a layer's threshold after which nothing of the map is kept.
const LEAPS: (f64, f64, f64) = (10.0, 0.01, 0.05);

/// What the map is made of.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Standing {
    pub time_s: f64,
    pub to_light: DVec3,
    pub threshold_sum: f64,
    pub camera_m: DVec2,
}

/// The map and the pass that makes it.
pub(super) struct ShadowMap {
    pub view: wgpu::TextureView,
    pub block: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    standing: Option<Standing>,
    rows: Rows,
}

/// What the map is made of for a frame, how it lies, and where the camera stands in it.
pub(super) fn lie<'a>(now: &Moment<'_>, shapes: impl Iterator<Item = &'a Shape> + Clone) -> (Standing, ShadowUniform) {
    let scene = &now.scene;
    let plane_m = scene.conditions.air.station_altitude_m;
    let light = scene.brighter();
    let drift_m = shapes.clone().next().map_or(DVec2::ZERO, |s| s.drift_m);
    let period_m = TEXEL_M * f64::from(TEXELS);
    let camera = (DVec2::from_array(scene.map_m) - drift_m) / period_m;
    let lowest_m = shapes.clone().map(|s| s.base_m).fold(f64::INFINITY, f64::min);
    let standing = Standing {
        time_s: now.time_s,
        to_light: light.direction,
        threshold_sum: shapes.map(|s| s.threshold + s.base_m / 1000.0).sum(),
        camera_m: DVec2::from_array(scene.map_m),
    };
    let uniform = ShadowUniform {
        to_light: light.direction.with_z(light.direction.z.max(LOWEST)).as_vec3().to_array(),
        plane: plane_m as f32,
        camera: [camera.x, camera.y].map(|v| v.rem_euclid(1.0) as f32),
        period: period_m as f32,
        eye: (scene.place.altitude_m - plane_m) as f32,
        mean: light.direct_share as f32,
        told: smoothstep(TOLD[0], TOLD[1], light.direction.z) as f32,
        top: (lowest_m - plane_m).max(0.0) as f32,
        pad: 0.0,
    };
    (standing, uniform)
}

impl ShadowMap {
    pub fn new(device: &Device) -> Result<Self> {
        let format = wgpu::TextureFormat::R8Unorm;
        let texture = flat_texture(
            &device.device,
            "shadows of clouds",
            (TEXELS, TEXELS),
            format,
            wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
        );
        let slots = [
            (1, Slot::Uniform(size_of::<super::uniforms::CloudsUniform>())),
            (2, Slot::Filtered),
            (3, Slot::FilteredVolume),
            (5, Slot::Sampler),
            (7, Slot::Uniform(size_of::<ShadowUniform>())),
        ];
        let layout = bind::layout(&device.device, "shadows of clouds", wgpu::ShaderStages::FRAGMENT, &slots);
        let desc = FullscreenDesc {
            shader: "clouds/shadow.wgsl",
            entry: "shadow",
            layouts: &[&layout],
            targets: &[format.into()],
            constants: &[],
            samples: 1,
        };
        Ok(Self {
            view: texture.create_view(&Default::default()),
            block: bind::block(&device.device, "shadows of clouds", size_of::<ShadowUniform>()),
            pipeline: pass::fullscreen(device, &desc)?,
            layout,
            standing: None,
            rows: Rows::default(),
        })
    }

    /// Bytes of GPU memory.
    pub const BYTES: u64 = TEXELS as u64 * TEXELS as u64;

    /// Makes some rows anew, or all of them where nothing of the map holds any more.
    pub fn draw(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        tables: &CloudTables,
        clouds: &wgpu::Buffer,
        (here, block): (Standing, ShadowUniform),
        is_pure: bool,
    ) {
        device.queue.write_buffer(&self.block, 0, bytemuck::bytes_of(&block));
        let rests = self.standing == Some(here);
        let holds = self.standing.is_some_and(|b| !is_pure && !here.leaps_from(&b));
        self.standing = Some(here);
        let Some((first, count)) = self.rows.due(TEXELS, ROWS, rests, holds) else { return };
        let solid = tables.solid.view();
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadows of clouds"),
            layout: &self.layout,
            entries: &[
                bind::buffer(1, clouds),
                bind::view(2, &tables.map),
                bind::view(3, &solid),
                bind::sampler(5, &tables.repeating),
                bind::buffer(7, &self.block),
            ],
        });
        rows::draw(encoder, &self.view, (TEXELS, first, count), &self.pipeline, &[&group]);
    }
}

impl Standing {
    /// Whether nothing of a map of what stood before holds.
    pub fn leaps_from(&self, before: &Self) -> bool {
        let (time_s, turn, threshold) = LEAPS;
        (self.time_s - before.time_s).abs() > time_s
            || self.to_light.dot(before.to_light) < turn.cos()
            || (self.threshold_sum - before.threshold_sum).abs() > threshold
            || self.camera_m.distance(before.camera_m) > 0.1 * TEXEL_M * f64::from(TEXELS)
    }
}
