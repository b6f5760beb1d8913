//! Rain on cones on the GPU: the texture of streaks, the uniform block, and one full-screen draw. If boxes or occluder
//! maps near the camera keep rain off, the share of rain that reaches each cell of a coarse grid is drawn first
//! ([`super::open_pass`]).

use super::{
    cones::{ConeUniform, SIDE, STRETCHES, texture},
    open_pass::{self, OpenPass},
};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        blocks::{BlockView, Blocks, UniformBlock},
        pass::{FullscreenDesc, PassPipelines, fullscreen},
    },
    particles::{DepthRead, LAYER_FORMAT},
    stage::Recording,
    surroundings::SurroundingsBlock,
};

/// State that a view keeps for rain on cones, created when the view first draws cones.
pub(super) struct ConePass {
    block: UniformBlock,
    layout: wgpu::BindGroupLayout,
    /// View of the texture of streaks.
    streaks: wgpu::TextureView,
    /// Samplers with repeated coordinates, for streaks, and with clamped ones, for the grid.
    samplers: [wgpu::Sampler; 2],
    /// Bind group with the grid of shelter ([`super::open_pass`]), or with a grid of one cell that is not read.
    group: wgpu::BindGroup,
    /// Pass that draws the grid of shelter, created when the grid is first needed.
    open: Option<OpenPass>,
    /// Bytes of the texture of streaks.
    bytes: u64,
    pipelines: PassPipelines<ConeKind, wgpu::RenderPipeline>,
    /// Whether the pass counts how often each pixel is drawn, instead of drawing light.
    counts: bool,
}

impl ConePass {
    pub fn new(device: &Device, blocks: &Blocks, counts: bool) -> Self {
        let block = blocks.block(device, size_of::<ConeUniform>());
        let layout = layout(&device.device);
        let (streaks, bytes) = upload(device);
        let samplers = [wgpu::AddressMode::Repeat, wgpu::AddressMode::ClampToEdge].map(|mode| {
            device.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("cones"),
                address_mode_u: mode,
                address_mode_v: mode,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                // Uses one level of detail: it hardly changes across a picture, and blending two would cost 1.5 times
                // as much.
                mipmap_filter: wgpu::MipmapFilterMode::Nearest,
                ..Default::default()
            })
        });
        let one = wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: STRETCHES as u32 };
        let none = open_pass::grid(&device.device, one);
        let group = group(&device.device, &layout, &block, &streaks, &samplers, &none);
        Self { block, layout, streaks, samplers, group, open: None, bytes, pipelines: PassPipelines::NONE, counts }
    }

    /// Returns the bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        self.bytes + self.open.as_ref().map_or(0, OpenPass::bytes)
    }

    /// Uploads the block, and compiles the pipeline for `kind` if it does not exist yet.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn prepare(
        &mut self,
        device: &Device,
        block: &ConeUniform,
        [frame, around]: [&wgpu::BindGroupLayout; 2],
        kind: ConeKind,
    ) -> Result<()> {
        self.block.write(bytemuck::bytes_of(block));
        let (own, counts) = (&self.layout, self.counts);
        self.pipelines.prepare(kind, |_| pipeline(device, &[frame, own, around], kind, counts))
    }

    /// Draws the grid of shelter for a picture of the size `picture`. `maps` says whether there are occluder maps.
    /// `blocks` begins with the rain's block. `layout` is the layout of the surroundings' bind group.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn shelter(
        &mut self,
        recording: &mut Recording<'_>,
        blocks: &BlockView,
        layout: &wgpu::BindGroupLayout,
        surroundings: &SurroundingsBlock,
        picture: wgpu::Extent3d,
        maps: bool,
    ) -> Result<()> {
        let device = recording.device;
        let first = self.open.is_none();
        let open = self.open.get_or_insert_with(|| OpenPass::new(&device.device, [blocks, &self.block], picture));
        let (grid, anew) = open.fit(&device.device, picture);
        if first || anew {
            self.group = group(&device.device, &self.layout, &self.block, &self.streaks, &self.samplers, grid);
        }
        open.draw(device, recording.encoder, (layout, surroundings.bind_group()), maps)
    }

    /// Draws the prepared cones. The caller has set the other bind groups.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, kind: ConeKind) {
        if let Some(pipeline) = self.pipelines.get(&kind) {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(1, &self.group, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}

/// Properties that select the pipeline.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct ConeKind {
    pub depth: DepthRead,
    /// Whether a box or an occluder map near the camera keeps rain off.
    pub sheltered: bool,
    /// Whether the rim of a rain area is near.
    pub areas: bool,
    /// Whether the host's lamps light the rain.
    pub lamps: bool,
    /// Whether the layer already contains columns of rain areas.
    pub over: bool,
    /// Whether the innermost cone is drawn, because not all near drops are drawn one by one.
    pub innermost: bool,
    /// Whether one set of streaks is replacing another in a drawn cone.
    pub growing: bool,
}

fn pipeline(
    device: &Device,
    layouts: &[&wgpu::BindGroupLayout],
    kind: ConeKind,
    counts: bool,
) -> Result<wgpu::RenderPipeline> {
    let flag = |name, on| (name, f64::from(u8::from(on)));
    let [has_depth, kinds] = kind.depth.constants();
    let desc = FullscreenDesc {
        shader: &kind.depth.shader("rain/cones_view.wgsl"),
        entry: if counts { "cones_counted" } else { "cones_fragment" },
        layouts,
        targets: &[wgpu::ColorTargetState {
            format: LAYER_FORMAT,
            blend: kind.over.then_some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            write_mask: wgpu::ColorWrites::ALL,
        }],
        constants: &[
            has_depth,
            kinds,
            flag("SHELTERED", kind.sheltered),
            flag("AREAS", kind.areas),
            flag("LAMPS", kind.lamps),
            flag("INNERMOST", kind.innermost),
            flag("GROWING", kind.growing),
        ],
        samples: 1,
    };
    fullscreen(device, &desc)
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let slots = [
        (0, Slot::Uniform(size_of::<ConeUniform>())),
        (1, Slot::Filtered),
        (2, Slot::Sampler),
        (3, Slot::FilteredArray),
        (4, Slot::Sampler),
    ];
    bind::layout(device, "cones", wgpu::ShaderStages::FRAGMENT, &slots)
}

fn group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    block: &BlockView,
    streaks: &wgpu::TextureView,
    [repeated, clamped]: &[wgpu::Sampler; 2],
    open: &wgpu::Texture,
) -> wgpu::BindGroup {
    let open = bind::as_layers(open);
    let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("cones"),
        layout,
        entries: &[
            block.entry(0),
            entry(1, wgpu::BindingResource::TextureView(streaks)),
            entry(2, wgpu::BindingResource::Sampler(repeated)),
            entry(3, wgpu::BindingResource::TextureView(&open)),
            entry(4, wgpu::BindingResource::Sampler(clamped)),
        ],
    })
}

/// Uploads the texture of streaks. Returns its view and its bytes.
fn upload(device: &Device) -> (wgpu::TextureView, u64) {
    let levels = texture();
    let made = device.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("streaks"),
        size: wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 },
        mip_level_count: levels.len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let mut bytes = 0;
    for (mip_level, texels) in levels.iter().enumerate() {
        let side = SIDE >> mip_level;
        let bits: Vec<u16> = texels.iter().flatten().map(|v| v.to_bits()).collect();
        device.write_texture(
            wgpu::TexelCopyTextureInfo { mip_level: mip_level as u32, ..made.as_image_copy() },
            bytemuck::cast_slice(&bits),
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(8 * side), rows_per_image: None },
            wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
        );
        bytes += 2 * bits.len() as u64;
    }
    (made.create_view(&Default::default()), bytes)
}
