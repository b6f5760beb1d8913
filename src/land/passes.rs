//! GPU resources of the drawn terrain: pipeline, mesh of a patch, instances, and the bind group of the pages.

use super::{
    pages::PageTextures,
    selection::PATCH,
    uniforms::{LandUniform, PatchInstance},
};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        blocks::{Blocks, UniformBlock},
    },
    stage::{OpaqueDraw, OpaqueTarget},
};

/// Indices of a patch: two triangles a square.
const INDICES: u32 = (PATCH * PATCH * 6) as u32;
/// Instances that a view begins with.
const FIRST_INSTANCES: usize = 512;

/// Resources of a view.
pub(super) struct LandPass {
    block: UniformBlock,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    indices: wgpu::Buffer,
    instances: wgpu::Buffer,
    /// Pipeline, and the target that it was made for.
    pipeline: Option<(OpaqueTarget, wgpu::RenderPipeline)>,
    /// Bind group, and one of the textures that it was made for.
    group: Option<(wgpu::Texture, wgpu::BindGroup)>,
}

/// Indices of the triangles of a patch, in rows from the south-west. Each square is split from its south-western to its
/// north-eastern corner.
pub(super) fn patch_indices() -> impl Iterator<Item = u16> {
    let vertices = PATCH as u16 + 1;
    (0..PATCH as u16).flat_map(move |j| {
        (0..PATCH as u16).flat_map(move |i| {
            let low = j * vertices + i;
            let (east, north, far) = (low + 1, low + vertices, low + vertices + 1);
            [low, east, far, low, far, north]
        })
    })
}

fn buffer(device: &wgpu::Device, bytes: usize, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("land"),
        size: bytes as u64,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

impl LandPass {
    pub fn new(device: &Device, blocks: &Blocks) -> Self {
        let gpu = &device.device;
        let slots = [
            (0, Slot::Uniform(size_of::<LandUniform>())),
            (1, Slot::Texels),
            (2, Slot::Filtered),
            (3, Slot::Filtered),
            (4, Slot::Filtered),
            (5, Slot::Sampler),
            (6, Slot::Filtered),
        ];
        let list: Vec<u16> = patch_indices().collect();
        let indices = buffer(gpu, size_of_val(list.as_slice()), wgpu::BufferUsages::INDEX);
        device.write_buffer(&indices, 0, bytemuck::cast_slice(&list));
        Self {
            block: blocks.block(device, size_of::<LandUniform>()),
            layout: bind::layout(gpu, "land", wgpu::ShaderStages::VERTEX_FRAGMENT, &slots),
            sampler: gpu.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("land"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
            indices,
            instances: buffer(gpu, FIRST_INSTANCES * size_of::<PatchInstance>(), wgpu::BufferUsages::VERTEX),
            pipeline: None,
            group: None,
        }
    }

    /// GPU memory, bytes.
    pub fn bytes(&self) -> u64 {
        self.indices.size() + self.instances.size()
    }

    /// Draws the patches of a picture.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn draw(
        &mut self,
        device: &Device,
        opaque: &OpaqueDraw<'_>,
        pages: &PageTextures,
        (block, patches): (&LandUniform, &[PatchInstance]),
        pass: &mut wgpu::RenderPass<'_>,
    ) -> Result<()> {
        self.block.write(bytemuck::bytes_of(block));
        let bytes: &[u8] = bytemuck::cast_slice(patches);
        if (self.instances.size() as usize) < bytes.len() {
            let room = bytes.len().next_power_of_two();
            self.instances = buffer(&device.device, room, wgpu::BufferUsages::VERTEX);
        }
        device.write_buffer(&self.instances, 0, bytes);
        let pipeline = match self.pipeline.take() {
            Some((target, pipeline)) if target == opaque.target => pipeline,
            _ => pipeline(device, opaque, &self.layout)?,
        };
        let group = match self.group.take() {
            Some((vertices, group)) if vertices == pages.vertices => group,
            _ => self.bind(&device.device, pages),
        };
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(1, &group, &[]);
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint16);
        pass.set_vertex_buffer(0, self.instances.slice(..));
        pass.draw_indexed(0..INDICES, 0, 0..patches.len() as u32);
        self.pipeline = Some((opaque.target, pipeline));
        self.group = Some((pages.vertices.clone(), group));
        Ok(())
    }

    fn bind(&self, device: &wgpu::Device, pages: &PageTextures) -> wgpu::BindGroup {
        let views = [&pages.vertices, &pages.slopes, &pages.classes[0], &pages.classes[1], &pages.dug]
            .map(|texture| texture.create_view(&Default::default()));
        let texture = |binding: u32, i: usize| bind::view(binding, &views[i]);
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("land"),
            layout: &self.layout,
            entries: &[
                self.block.entry(0),
                texture(1, 0),
                texture(2, 1),
                texture(3, 2),
                texture(4, 3),
                bind::sampler(5, &self.sampler),
                texture(6, 4),
            ],
        })
    }
}

/// Creates the pipeline for a target.
fn pipeline(device: &Device, opaque: &OpaqueDraw<'_>, own: &wgpu::BindGroupLayout) -> Result<wgpu::RenderPipeline> {
    let module = device.shader("land/land.wgsl")?;
    let target = opaque.target;
    let layout = device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("land"),
        bind_group_layouts: &[Some(opaque.layout), Some(own)],
        immediate_size: 0,
    });
    let instances = wgpu::VertexBufferLayout {
        array_stride: size_of::<PatchInstance>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &wgpu::vertex_attr_array![0 => Sint32x2, 1 => Uint32x2],
    };
    Ok(device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("land"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("land_vertex"),
            compilation_options: Default::default(),
            buffers: &[Some(instances)],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(target.depth_test()),
        multisample: wgpu::MultisampleState { count: target.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(if target.logarithmic { "logarithmic" } else { "plain" }),
            compilation_options: Default::default(),
            targets: &[Some(target.color_target())],
        }),
        multiview_mask: None,
        cache: None,
    }))
}
