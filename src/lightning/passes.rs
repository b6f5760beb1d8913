//! Pass that draws channels into the layer in front of the picture.

use std::sync::Arc;

use super::uniforms::{ChannelUniform, PartInstance};
use crate::{
    error::Result,
    gpu::{
        Device, KeptLayer, Layer,
        bind::{self, Slot},
        blocks::{BlockView, Blocks, UniformBlock},
        is_kept,
        pass::{self, QuadsDesc},
        recent::LruCache,
    },
    stage::{Block, Constant, FrameUniform, MergedFrame, Recording, Texture, flag, veiled},
};

/// Format of the layer in front of the picture.
pub(super) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Largest number of parts that are drawn: those of two or three simultaneous flashes.
pub(super) const MOST_PARTS: usize = 4096;
/// Number of cached pipelines of a view, for the weathers that alternate.
const MOST_PIPELINES: usize = 4;

/// Key of a pipeline besides the veil's constants: whether the depth texture has several samples, and whether there is
/// a depth texture.
type DepthKey = (bool, bool);

/// Pass and its resources, created when there is a channel to draw.
pub(super) struct ChannelPass {
    /// Block with [`ChannelUniform`].
    block: UniformBlock,
    /// Instances of the parts that are drawn.
    parts: wgpu::Buffer,
    /// Layouts for a depth of one sample, and of several.
    layouts: [wgpu::BindGroupLayout; 2],
    /// Placeholder for a missing depth.
    none: wgpu::TextureView,
    /// Placeholder for a missing layer of clouds.
    no_layers: wgpu::TextureView,
    /// Pipelines that were used last.
    pipelines: LruCache<(DepthKey, Vec<Constant>), wgpu::RenderPipeline, MOST_PIPELINES>,
    /// Depth, layer of clouds and block of the veil for which the bind group of the last draw was made, and this group.
    bound: Option<(Option<KeptLayer>, Option<wgpu::TextureView>, BlockView, wgpu::BindGroup)>,
}

/// Creates the layout of the bind group, for a depth of one sample or of several.
fn layout(device: &wgpu::Device, multisampled: bool) -> wgpu::BindGroupLayout {
    // The block of the veil belongs to another room, so its size is left open.
    let slots = [
        (0, Slot::Uniform(size_of::<FrameUniform>())),
        (1, Slot::texels(multisampled)),
        (4, Slot::Uniform(0)),
        (7, Slot::Uniform(size_of::<ChannelUniform>())),
        (11, Slot::FilteredArray),
    ];
    bind::layout(device, "flashes", wgpu::ShaderStages::VERTEX_FRAGMENT, &slots)
}

impl ChannelPass {
    /// Creates the resources of the pass.
    pub fn new(device: &Device, blocks: &Blocks) -> Self {
        let parts = device.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("flashes"),
            size: (MOST_PARTS * size_of::<PartInstance>()) as u64,
            usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let none = bind::nothing(&device.device, wgpu::TextureFormat::Rgba8Unorm);
        Self {
            block: blocks.block(device, size_of::<ChannelUniform>()),
            parts,
            layouts: [false, true].map(|multi| layout(&device.device, multi)),
            no_layers: bind::no_layers(&device.device),
            none,
            pipelines: LruCache::new(),
            bound: None,
        }
    }

    /// Returns the bytes of GPU memory in use.
    pub fn bytes(&self) -> u64 {
        self.parts.size()
    }

    /// Adds parts to the layer `target`. The layer is cleared first unless it has content already (`over`).
    ///
    /// # Errors
    /// [`crate::Status::Internal`] if a shader file is missing.
    pub fn draw(
        &mut self,
        recording: &mut Recording<'_>,
        (block, parts): (&ChannelUniform, &[PartInstance]),
        merged: &MergedFrame<'_>,
        depth: Option<Layer<'_>>,
        (target, over): (&wgpu::TextureView, bool),
    ) -> Result<()> {
        let Some((tables_layout, tables)) = merged.composition.tables() else { return Ok(()) };
        let device = recording.device;
        self.block.write(bytemuck::bytes_of(block));
        device.write_buffer(&self.parts, 0, bytemuck::cast_slice(parts));
        let kind = (depth.is_some_and(Layer::is_multisampled), depth.is_some());
        self.bind(device, merged, depth, kind.0);
        let pipeline = self.pipeline(device, tables_layout, kind, merged.composition.least().between.all())?;
        let Some((.., group)) = &self.bound else { return Ok(()) };
        let clear = wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT);
        let mut pass = recording.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("flashes"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: if over { wgpu::LoadOp::Load } else { clear },
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.set_bind_group(1, tables, &[]);
        pass.set_vertex_buffer(0, self.parts.slice(..));
        pass.draw(0..4, 0..parts.len() as u32);
        Ok(())
    }

    /// Creates the bind group, unless the last one fits.
    fn bind(&mut self, device: &Device, merged: &MergedFrame<'_>, depth: Option<Layer<'_>>, multi: bool) {
        let Some(between) = merged.composition.own_block(Block::Between) else { return };
        let sky_layers = merged.composition.texture(Texture::Behind);
        if self
            .bound
            .as_ref()
            .is_some_and(|(d, h, b, _)| is_kept(depth, d.as_ref()) && h.as_ref() == sky_layers && b == between)
        {
            return;
        }
        let view = depth.map(Layer::view);
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("flashes"),
            layout: &self.layouts[usize::from(multi)],
            entries: &[
                merged.block.entry(0),
                bind::view(1, view.as_ref().unwrap_or(&self.none)),
                between.entry(4),
                self.block.entry(7),
                bind::view(11, sky_layers.unwrap_or(&self.no_layers)),
            ],
        });
        self.bound = Some((depth.map(Layer::kept), sky_layers.cloned(), between.clone(), group));
    }

    /// Returns the pipeline for these constants, compiled at its first use.
    fn pipeline(
        &mut self,
        device: &Arc<Device>,
        tables: &wgpu::BindGroupLayout,
        (multi, has_depth): DepthKey,
        constants: &[Constant],
    ) -> Result<wgpu::RenderPipeline> {
        let own = &self.layouts[usize::from(multi)];
        let make = || {
            let name = if multi { "lightning/channel.wgsl:multi" } else { "lightning/channel.wgsl" };
            let module = device.shader(&veiled(name, constants))?;
            let mut all = constants.to_vec();
            all.push(("HAS_DEPTH", flag(has_depth)));
            let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4];
            let instances = wgpu::VertexBufferLayout {
                array_stride: size_of::<PartInstance>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &attributes,
            };
            let pipeline = pass::quads(
                device,
                &QuadsDesc {
                    label: "flashes",
                    vertex: (&module, "channel_vertex", &[]),
                    fragment: (&module, "channel_fragment", &all),
                    layouts: &[Some(own), Some(tables)],
                    buffers: &[Some(instances)],
                    format: FORMAT,
                    counts: false,
                },
            );
            Ok((((multi, has_depth), constants.to_vec()), pipeline?))
        };
        self.pipelines.get_or_make(|(k, c)| *k == (multi, has_depth) && c == constants, make).cloned()
    }
}
