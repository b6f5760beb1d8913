//! Textures of the veil of air and fog, for the host's own transparent shaders (glass, lamps, smoke).
//!
//! Created when the host first calls `frame_textures`, and drawn in each frame from then on. The mapping from the
//! view's frustum to texels is that of `shaders/frame/froxels.wgsl` and of the published snippets.

use crate::{
    error::Result,
    gpu::{
        Device, flat_texture,
        pass::{self, FullscreenDesc},
        recent::LruCache,
    },
    stage::{Constants, Recording, Sampling, Stages, veiled},
};

/// Texels of one distance slice, and numbers of slices side by side and one above the other.
const TILE: (u32, u32) = (32, 18);
const TILES: (u32, u32) = (8, 4);

/// Textures for a host's transparent shaders; valid until the view is destroyed.
#[derive(Clone, Debug)]
pub struct FrameTextures {
    /// Light that air and fog add, RGB, linear and exposed; tone-mapped too if the host's colour is. Multiplied by
    /// [`light_scale`](Self::light_scale), the light is in units of the host's colour.
    pub light: wgpu::Texture,
    /// Transmittance of air and fog for the light behind them, RGB.
    pub through: wgpu::Texture,
    /// Factor from `light` to units of the host's colour in the last frame; 1 if that colour is tone-mapped, 0 before
    /// the first frame.
    pub light_scale: f32,
}

/// WGSL source of the functions that sample [`FrameTextures`].
pub const SNIPPET_WGSL: &str = include_str!("../../shaders/snippets/welkin_veil.wgsl");
/// GLSL 3.30 source of the functions that sample [`FrameTextures`].
pub const SNIPPET_GLSL: &str = include_str!("../../shaders/snippets/welkin_veil.glsl");

/// Properties for which a froxel pipeline is compiled.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct FroxelKind {
    pub shader: &'static str,
    /// Sampling of the host's images.
    pub sampling: Sampling,
    pub constants: Constants,
}

/// Largest number of cached pipelines of a view: with and without fog, and an effect's own, for one host's images.
const MOST_PIPELINES: usize = 8;

/// Textures of the veil, and the pipelines that fill them.
pub(super) struct Froxels {
    pub light: wgpu::Texture,
    pub through: wgpu::Texture,
    views: [wgpu::TextureView; 2],
    pipelines: LruCache<FroxelKind, wgpu::RenderPipeline, MOST_PIPELINES>,
}

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

impl Froxels {
    pub fn new(device: &Device) -> Self {
        let texture = |label| {
            flat_texture(
                &device.device,
                label,
                (TILE.0 * TILES.0, TILE.1 * TILES.1),
                FORMAT,
                wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING
                    | wgpu::TextureUsages::COPY_SRC,
            )
        };
        let (light, through) = (texture("froxel light"), texture("froxel transmittance"));
        let views = [light.create_view(&Default::default()), through.create_view(&Default::default())];
        Self { light, through, views, pipelines: LruCache::new() }
    }

    pub fn bytes(&self) -> u64 {
        2 * 8 * u64::from(TILE.0 * TILES.0 * TILE.1 * TILES.1)
    }

    /// Shader that fills the textures if no effect has its own.
    pub const SHADER: &'static str = "frame/froxels.wgsl";

    /// Fills the textures with the shader, sampling and constants of `kind`.
    pub fn draw(
        &mut self,
        recording: &mut Recording<'_>,
        kind: FroxelKind,
        layouts: &[&wgpu::BindGroupLayout],
        groups: &[&wgpu::BindGroup],
    ) -> Result<()> {
        let device = recording.device;
        let pipeline = self.pipelines.get_or_make(
            |made| *made == kind,
            || {
                let target = wgpu::ColorTargetState { format: FORMAT, blend: None, write_mask: wgpu::ColorWrites::ALL };
                let desc = FullscreenDesc {
                    shader: &veiled(kind.shader, kind.constants.all()),
                    entry: "froxels",
                    layouts,
                    targets: &[target.clone(), target],
                    constants: kind.constants.all(),
                    samples: 1,
                };
                Ok((kind, pass::fullscreen(device, &desc)?))
            },
        )?;
        let attach = |view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })
        };
        let mut pass = recording.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("froxels"),
            color_attachments: &[attach(&self.views[0]), attach(&self.views[1])],
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        for (i, group) in groups.iter().enumerate() {
            pass.set_bind_group(i as u32, *group, &[]);
        }
        pass.draw(0..3, 0..1);
        Ok(())
    }

    /// Stage after which the textures hold the frame's veil.
    pub const STAGE: Stages = Stages::MEDIUM;
}
