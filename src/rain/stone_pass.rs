//! Stones (hail and ice pellets) on the GPU: their block and their two draws in the drops' pass.

use super::stones::{StoneUniform, Stones};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        blocks::{Blocks, UniformBlock},
        pass::{self, PassPipelines, QuadsDesc},
    },
    particles::DepthRead,
};

/// Stones that a frame draws.
#[derive(Clone, Copy)]
pub(crate) struct StoneDraw {
    pub block: StoneUniform,
    /// Number of drawn stones in the air.
    pub falling: u32,
    /// Number of slots of landings.
    pub landings: u32,
}

impl StoneDraw {
    /// Creates the draw of `stones` with their uniform block.
    pub fn new(stones: &Stones, block: StoneUniform) -> Self {
        Self { block, falling: stones.drawn, landings: stones.landings() }
    }
}

/// State for stones that a view holds, created when the first ones fall.
pub(super) struct StonePass {
    block: UniformBlock,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    /// Pipelines of stones in the air and of stones that hop on the ground.
    pipelines: PassPipelines<StoneKind, [wgpu::RenderPipeline; 2]>,
    /// Whether the pass counts how often each pixel is drawn, instead of drawing light.
    counts: bool,
}

/// Properties that select the pipelines: how depth is read, and whether there are occluder maps.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct StoneKind {
    pub depth: DepthRead,
    pub maps: bool,
}

impl StonePass {
    pub fn new(device: &Device, blocks: &Blocks, counts: bool) -> Self {
        let block = blocks.block(device, size_of::<StoneUniform>());
        let device = &device.device;
        let slots = [(0, Slot::Uniform(size_of::<StoneUniform>()))];
        let layout = bind::layout(device, "stones", wgpu::ShaderStages::VERTEX, &slots);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("stones"),
            layout: &layout,
            entries: &[block.entry(0)],
        });
        Self { block, layout, group, pipelines: PassPipelines::NONE, counts }
    }

    /// Uploads the block, and compiles the pipelines for `kind` if they do not exist yet. `rain` is the layout of group
    /// 0 of the drops' pass, `around` that of the surroundings; `format` is that of the layer.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn prepare(
        &mut self,
        device: &Device,
        drawn: &StoneDraw,
        [rain, around]: [&wgpu::BindGroupLayout; 2],
        format: wgpu::TextureFormat,
        kind: StoneKind,
    ) -> Result<()> {
        self.block.write(bytemuck::bytes_of(&drawn.block));
        let layouts = [Some(rain), Some(&self.layout), Some(around)];
        let make = |vertex| pipeline(device, &layouts, (format, self.counts), vertex, kind);
        self.pipelines.prepare(kind, |_| Ok([make("falling_vertex")?, make("hopping_vertex")?]))
    }

    /// Draws the prepared stones in a pass whose group 0 is that of the drops. Stones on the ground are drawn only if
    /// there is depth.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, kind: StoneKind, drawn: &StoneDraw) {
        let Some([falling, hopping]) = self.pipelines.get(&kind) else { return };
        pass.set_bind_group(1, &self.group, &[]);
        pass.set_pipeline(falling);
        pass.draw(0..4, 0..drawn.falling);
        if kind.depth.any && drawn.landings > 0 {
            pass.set_pipeline(hopping);
            pass.draw(0..4, 0..drawn.landings);
        }
    }
}

fn pipeline(
    device: &Device,
    layouts: &[Option<&wgpu::BindGroupLayout>],
    (format, counts): (wgpu::TextureFormat, bool),
    vertex: &str,
    StoneKind { depth, maps }: StoneKind,
) -> Result<wgpu::RenderPipeline> {
    let module = device.shader(&depth.shader("rain/stones_view.wgsl"))?;
    let near = [("MAPS", f64::from(u8::from(maps)))];
    pass::quads(
        device,
        &QuadsDesc {
            label: "stones",
            vertex: (&module, vertex, &near),
            fragment: (&module, "stone_fragment", &depth.constants()),
            layouts,
            buffers: &[],
            format,
            counts,
        },
    )
}
