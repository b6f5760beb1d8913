//! Stones on the GPU: their block and their two draws, in the drops' pass.

use super::stones::{StoneUniform, Stones};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        blocks::{Blocks, UniformBlock},
        pass::{self, QuadsDesc},
    },
};

/// What a frame draws of stones.
#[derive(Clone, Copy)]
pub(crate) struct StoneDraw {
    pub block: StoneUniform,
    /// Stones in the air, and slots of landings.
    pub falling: u32,
    pub landings: u32,
}

impl StoneDraw {
    pub fn new(stones: &Stones, block: StoneUniform) -> Self {
        Self { block, falling: stones.drawn, landings: stones.landings() }
    }
}

/// What a view holds for stones, made when the first ones fall.
pub(super) struct StonePass {
    block: UniformBlock,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    /// Falling and hopping, for each kind of depth.
    pipelines: [[Option<wgpu::RenderPipeline>; 2]; 8],
    counts: bool,
}

/// The kind of depth that a pass has: several samples, any at all; and whether there are occluder maps.
pub(super) type Depth = (bool, bool, bool);

fn key((multi, any, maps): Depth) -> usize {
    usize::from(maps) * 4 + usize::from(multi) * 2 + usize::from(any)
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
        Self { block, layout, group, pipelines: [const { [None, None] }; 8], counts }
    }

    /// Brings the block up, and makes the pipelines for a kind of depth if they are not there. `rain` and `around` are the
    /// layouts of the drops' own groups, `format` that of their layer.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn prepare(
        &mut self,
        device: &Device,
        drawn: &StoneDraw,
        [rain, around]: [&wgpu::BindGroupLayout; 2],
        format: wgpu::TextureFormat,
        depth: Depth,
    ) -> Result<()> {
        self.block.write(bytemuck::bytes_of(&drawn.block));
        for (slot, vertex) in self.pipelines[key(depth)].iter_mut().zip(["falling_vertex", "hopping_vertex"]) {
            if slot.is_none() {
                let layouts = [Some(rain), Some(&self.layout), Some(around)];
                *slot = Some(pipeline(device, &layouts, (format, self.counts), vertex, depth)?);
            }
        }
        Ok(())
    }

    /// Draws what was prepared, in a pass whose group 0 is the drops'.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, depth: Depth, drawn: &StoneDraw) {
        let [Some(falling), Some(hopping)] = &self.pipelines[key(depth)] else { return };
        pass.set_bind_group(1, &self.group, &[]);
        pass.set_pipeline(falling);
        pass.draw(0..4, 0..drawn.falling);
        if depth.1 && drawn.landings > 0 {
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
    (multi, has_depth, maps): Depth,
) -> Result<wgpu::RenderPipeline> {
    let module = device.shader(if multi { "rain/stones_view.wgsl:multi" } else { "rain/stones_view.wgsl" })?;
    let constants = [("HAS_DEPTH", f64::from(u8::from(has_depth)))];
    let near = [("MAPS", f64::from(u8::from(maps)))];
    pass::quads(
        device,
        &QuadsDesc {
            label: "stones",
            vertex: (&module, vertex, &near),
            fragment: (&module, "stone_fragment", &constants),
            layouts,
            buffers: &[],
            format,
            counts,
        },
    )
}
