//! Flakes on the GPU: their block, their step where they are stepped, and their draw into the layer before the picture.

use super::{stepped, uniforms::FlakesUniform};
use crate::{
    error::Result,
    gpu::{
        Device, KeptLayer, Layer,
        bind::{self, Slot},
        blocks::{Blocks, UniformBlock},
        is_kept,
        pass::{self, QuadsDesc},
    },
    stage::{
        LAYER_FORMAT, Recording,
        stepping::{STATE_BYTES, StepPass, Stepped},
    },
    surroundings::{self, SurroundingsBlock},
};

/// What a frame draws with and into.
pub(super) struct FlakeDraw<'a> {
    pub block: &'a FlakesUniform,
    /// By what they are stepped, if they are.
    pub stepped: Option<&'a Stepped<'a>>,
    pub surroundings: &'a SurroundingsBlock,
    /// Whether occluder maps are among them.
    pub maps: bool,
    /// The layer before the picture, and whether something lies in it already, before which the flakes come.
    pub target: &'a wgpu::TextureView,
    pub over: bool,
    /// The host's depth.
    pub depth: Option<Layer<'a>>,
}

/// What a view holds for flakes, made when the first ones fall.
pub(super) struct SnowPass {
    block: UniformBlock,
    /// Layout of group 0 for depth with one and with several samples.
    layouts: [wgpu::BindGroupLayout; 2],
    surroundings: wgpu::BindGroupLayout,
    /// By whether depth has several samples, is there at all, whether there are occluder maps, and whether flakes are stepped.
    pipelines: [Option<wgpu::RenderPipeline>; 16],
    step: Option<Box<StepPass>>,
    none: wgpu::TextureView,
    bound: Option<(Option<KeptLayer>, wgpu::BindGroup)>,
    /// Whether it counts how often pixels are drawn, in place of the flakes' light.
    counts: bool,
}

impl SnowPass {
    pub fn new(device: &Device, blocks: &Blocks, counts: bool) -> Self {
        let own = &device.device;
        let layout = |several: bool| {
            let slots = [(0, Slot::Uniform(size_of::<FlakesUniform>())), (1, Slot::texels(several))];
            bind::layout(own, "snow", wgpu::ShaderStages::VERTEX_FRAGMENT, &slots)
        };
        Self {
            block: blocks.block(device, size_of::<FlakesUniform>()),
            layouts: [layout(false), layout(true)],
            surroundings: surroundings::layout(own),
            pipelines: [const { None }; 16],
            step: None,
            none: bind::nothing(own, wgpu::TextureFormat::Rgba8Unorm),
            bound: None,
            counts,
        }
    }

    /// Whether it counts.
    pub fn counts(&self) -> bool {
        self.counts
    }

    /// Bytes of GPU memory that it holds.
    pub fn bytes(&self) -> u64 {
        self.step.as_ref().map_or(0, |step| step.bytes())
    }

    /// Draws all flakes.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn draw(&mut self, to: &mut Recording<'_>, drawn: &FlakeDraw<'_>) -> Result<()> {
        let device = to.device;
        self.block.write(bytemuck::bytes_of(drawn.block));
        let several = drawn.depth.is_some_and(Layer::is_multisampled);
        self.bind(device, drawn.depth, several);
        let kind = [several, drawn.depth.is_some(), drawn.maps, drawn.stepped.is_some()];
        let place = kind.into_iter().fold(0, |k, bit| 2 * k + usize::from(bit));
        if self.pipelines[place].is_none() {
            self.pipelines[place] = Some(self.pipeline(device, kind)?);
        }
        match drawn.stepped {
            Some(by) => {
                let step = self.step.get_or_insert_with(|| Box::new(stepped::pass(device, to.blocks)));
                step.step(device, to.encoder, self.block.range(0, self.block.bytes()), by)?;
            }
            None => self.step = None,
        }
        let (Some(pipeline), Some((_, group))) = (&self.pipelines[place], &self.bound) else { return Ok(()) };
        let load = if drawn.over { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) };
        let mut pass = to.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("snow"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: drawn.target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_bind_group(0, group, &[]);
        pass.set_bind_group(2, drawn.surroundings.bind_group(), &[]);
        pass.set_pipeline(pipeline);
        match &self.step {
            // The farthest first.
            Some(step) => step.shells().rev().for_each(|(states, count)| {
                pass.set_vertex_buffer(0, states);
                pass.draw(0..4, 0..count);
            }),
            None => pass.draw(0..4, 0..drawn.block.count),
        }
        Ok(())
    }

    fn bind(&mut self, device: &Device, depth: Option<Layer<'_>>, several: bool) {
        if self.bound.as_ref().is_some_and(|(d, _)| is_kept(depth, d.as_ref())) {
            return;
        }
        let view = depth.map(Layer::view);
        let texels = wgpu::BindingResource::TextureView(view.as_ref().unwrap_or(&self.none));
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("snow"),
            layout: &self.layouts[usize::from(several)],
            entries: &[self.block.entry(0), wgpu::BindGroupEntry { binding: 1, resource: texels }],
        });
        self.bound = Some((depth.map(Layer::kept), group));
    }

    fn pipeline(
        &self,
        device: &Device,
        [several, has_depth, maps, stepped]: [bool; 4],
    ) -> Result<wgpu::RenderPipeline> {
        let module = device.shader(if several { "snow/flakes_view.wgsl:multi" } else { "snow/flakes_view.wgsl" })?;
        let yes = |b: bool| f64::from(u8::from(b));
        let state = [Some(wgpu::VertexBufferLayout {
            array_stride: STATE_BYTES,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &wgpu::vertex_attr_array![0 => Uint32x3, 1 => Uint32, 2 => Float32x3],
        })];
        pass::quads(
            device,
            &QuadsDesc {
                label: "snow",
                vertex: (&module, if stepped { "stepped_vertex" } else { "flake_vertex" }, &[("MAPS", yes(maps))]),
                fragment: (&module, "flake_fragment", &[("HAS_DEPTH", yes(has_depth))]),
                layouts: &[Some(&self.layouts[usize::from(several)]), None, Some(&self.surroundings)],
                buffers: if stepped { &state } else { &[] },
                format: LAYER_FORMAT,
                counts: self.counts,
            },
        )
    }
}
