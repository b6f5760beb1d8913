//! GPU resources of shadow maps: the textures, and the passes that draw the ground into them.

use crate::{
    error::Result,
    gpu::{
        Device, Layer,
        bind::{self, Slot},
        blocks::{Blocks, UniformBlock},
        pass::{self, FullscreenDesc},
    },
    land::{
        pages::PageTextures,
        patch::{PatchMesh, patch_layout},
        uniforms::{CASCADES, LandUniform, PatchInstance},
    },
};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Texels of a map along a side of a block, which is one texel of [`ShadowMaps`]' `tops`;
/// `shaders/land/shadow_block.wgsl` has the same.
pub(super) const BLOCK: u32 = 16;

/// Maps of a view.
pub(in crate::land) struct ShadowMaps {
    /// Texels along a side.
    pub side: u32,
    /// Depths of the ground as seen from the light, one layer a map, and the depth nearest to the light in each block
    /// of texels.
    depths: wgpu::Texture,
    tops: wgpu::Texture,
    /// Views of each map's layer, in `depths` and in `tops`.
    layers: [[wgpu::TextureView; 2]; CASCADES],
    block: [UniformBlock; CASCADES],
    draw: wgpu::RenderPipeline,
    reduction: Reduction,
    draw_layout: wgpu::BindGroupLayout,
    mesh: PatchMesh,
}

/// Pass that finds the depth nearest to the light in each block of a map.
struct Reduction {
    pipeline: wgpu::RenderPipeline,
    /// Bind group of each map, and the uniform block that the group binds.
    groups: [(UniformBlock, wgpu::BindGroup); CASCADES],
}

impl Reduction {
    fn new(device: &Device, blocks: &Blocks, depths: &wgpu::TextureView) -> Result<Self> {
        let slots = [(0, Slot::Uniform(16)), (1, Slot::TexelsArray)];
        let layout = bind::layout(&device.device, "land shadow tops", wgpu::ShaderStages::FRAGMENT, &slots);
        let desc = FullscreenDesc {
            shader: "land/shadow_tops.wgsl",
            entry: "shadow_top",
            layouts: &[&layout],
            targets: &[],
            constants: &[],
            samples: 1,
        };
        let written = pass::depth_test(FORMAT, wgpu::CompareFunction::Always, true);
        let pipeline = pass::fullscreen_at(device, &desc, Some((0.0, written)))?;
        let groups = std::array::from_fn(|i| {
            let block = blocks.block(device, 16);
            block.write(bytemuck::bytes_of(&[i as u32, 0, 0, 0]));
            let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("land shadow tops"),
                layout: &layout,
                entries: &[block.entry(0), bind::view(1, depths)],
            });
            (block, group)
        });
        Ok(Self { pipeline, groups })
    }
}

/// Array of depth textures with `layers` layers.
fn depth_layers(device: &wgpu::Device, side: u32, layers: u32) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("land shadows"),
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

/// Creates placeholders to bind where there are no maps, as [`ShadowMaps::views`] returns them.
pub(in crate::land) fn no_maps(device: &wgpu::Device) -> [wgpu::TextureView; 2] {
    let nothing = bind::as_layers(&depth_layers(device, 1, CASCADES as u32));
    [nothing.clone(), nothing]
}

/// Begins a pass that writes the depths of a layer. They are cleared to 0, the depth farthest from the light.
fn begin<'a>(encoder: &'a mut wgpu::CommandEncoder, view: &wgpu::TextureView) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("land shadows"),
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}

impl ShadowMaps {
    /// Creates maps with `side` texels along a side.
    ///
    /// # Errors
    /// [`crate::Status::Internal`] if a shader file is missing.
    pub fn new(device: &Device, blocks: &Blocks, side: u32) -> Result<Self> {
        let gpu = &device.device;
        let depths = depth_layers(gpu, side, CASCADES as u32);
        let tops = depth_layers(gpu, side / BLOCK, CASCADES as u32);
        let layer = |texture, index| Layer { texture, index }.attached_view();
        let layers = [0, 1, 2, 3].map(|i| [layer(&depths, i), layer(&tops, i)]);
        let block = std::array::from_fn(|_| blocks.block(device, size_of::<LandUniform>()));
        let uniform = (0, Slot::Uniform(size_of::<LandUniform>()));
        let draw_layout = bind::layout(gpu, "land shadows", wgpu::ShaderStages::VERTEX, &[uniform, (1, Slot::Texels)]);
        let whole = bind::as_layers(&depths);
        let reduction = Reduction::new(device, blocks, &whole)?;
        Ok(Self {
            side,
            layers,
            draw: draw_pipeline(device, &draw_layout)?,
            reduction,
            depths,
            tops,
            block,
            draw_layout,
            mesh: PatchMesh::new(device),
        })
    }

    /// Depths of the maps, and the depths nearest to the light in their blocks, as the ground's shader reads them.
    pub fn views(&self) -> [wgpu::TextureView; 2] {
        [&self.depths, &self.tops].map(bind::as_layers)
    }

    /// Texture of the depths. A bind group is made anew when this texture is another one.
    pub fn texture(&self) -> &wgpu::Texture {
        &self.depths
    }

    /// GPU memory, bytes.
    pub fn bytes(&self) -> u64 {
        let texels = |side: u32| 4 * CASCADES as u64 * u64::from(side).pow(2);
        texels(self.side) + texels(self.side / BLOCK) + self.mesh.bytes()
    }

    /// Writes the patches of all maps that a frame draws.
    pub fn write_patches(&mut self, device: &Device, patches: &[PatchInstance]) {
        self.mesh.write(device, patches);
    }

    /// Draws a range of the patches into a map, and finds the depths of the map's blocks.
    pub fn draw(
        &self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        (map, block): (usize, &LandUniform),
        pages: &PageTextures,
        patches: std::ops::Range<u32>,
    ) {
        self.block[map].write(bytemuck::bytes_of(block));
        let vertices = pages.vertices.create_view(&Default::default());
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("land shadows"),
            layout: &self.draw_layout,
            entries: &[self.block[map].entry(0), bind::view(1, &vertices)],
        });
        let [depths, tops] = &self.layers[map];
        let mut pass = begin(encoder, depths);
        pass.set_pipeline(&self.draw);
        pass.set_bind_group(1, &group, &[]);
        self.mesh.draw(&mut pass, patches);
        drop(pass);
        let mut pass = begin(encoder, tops);
        pass.set_pipeline(&self.reduction.pipeline);
        pass.set_bind_group(0, &self.reduction.groups[map].1, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn draw_pipeline(device: &Device, own: &wgpu::BindGroupLayout) -> Result<wgpu::RenderPipeline> {
    let module = device.shader("land/shadow.wgsl")?;
    let layout = device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("land shadows"),
        bind_group_layouts: &[None, Some(own)],
        immediate_size: 0,
    });
    Ok(device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("land shadows"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("shadow_vertex"),
            compilation_options: Default::default(),
            buffers: &[Some(patch_layout())],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(pass::depth_test(FORMAT, wgpu::CompareFunction::Greater, true)),
        multisample: Default::default(),
        fragment: None,
        multiview_mask: None,
        cache: None,
    }))
}
