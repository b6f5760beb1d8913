//! The layer of drops before a picture: its texture, its pipelines, and the draw.

use std::sync::Arc;

use super::{
    LocalUniform, StoneDraw,
    cone_pass::ConePass,
    cones::ConeUniform,
    lattice::SHELLS,
    shelter::MAX_SHELTERS,
    splash::SplashUniform,
    step_pass::{StepPass, Stepped},
    stone_pass::StonePass,
    uniforms::RainUniform,
};
use crate::{
    error::Result,
    gpu::Device,
    scene::{LightUniform, MAX_LIGHTS},
};

/// Light of the drops times the picture's exposure, and the share of what lies behind that they hide.
pub(super) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Drops as one more veil before the picture: premultiplied, one sample a pixel.
pub(crate) struct RainLayer {
    /// All blocks one after the other, so that one upload brings them.
    blocks: wgpu::Buffer,
    staged: Vec<u8>,
    /// Layout of group 0 for depth with one and with several samples.
    layouts: [wgpu::BindGroupLayout; 2],
    /// Of drops and of splashes, for each kind of depth, with and without rims of areas near.
    pipelines: [[Option<wgpu::RenderPipeline>; 2]; 8],
    cones: Option<ConePass>,
    stepped: Option<StepPass>,
    /// Hail and pellets, when some fell.
    stones: Option<StonePass>,
    none: Option<wgpu::TextureView>,
    texture: Option<(wgpu::Texture, wgpu::TextureView)>,
    bound: Option<(Option<wgpu::Texture>, bool, wgpu::BindGroup)>,
}

/// What one frame draws.
pub(crate) struct Drawn<'a> {
    pub rain: &'a RainUniform,
    /// Cones in place of drops and splashes.
    pub cones: Option<&'a ConeUniform>,
    /// Drops that are stepped in place of those without a state.
    pub stepped: Option<&'a Stepped<'a>>,
    /// Rows and velocities of the boxes that keep rain off ([`super::Shelter`]).
    pub shelters: &'a [[[f32; 4]; 4]],
    /// The host's lamps.
    pub lights: &'a [LightUniform],
    /// Splashes, and how many slots of them there are.
    pub splash: &'a SplashUniform,
    pub splashes: u32,
    /// How many drops fall where, if a rim of a rain area is near.
    pub local: Option<&'a LocalUniform>,
    /// Whether something lies in the layer already, before which the drops come.
    pub over: bool,
    /// Hail and pellets, if any fall.
    pub stones: Option<StoneDraw>,
}

fn layout(device: &wgpu::Device, multisampled: bool) -> wgpu::BindGroupLayout {
    let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
    let uniform = |binding, size: usize| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: both,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: wgpu::BufferSize::new(size as u64),
        },
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("rain"),
        entries: &[
            uniform(0, size_of::<RainUniform>()),
            wgpu::BindGroupLayoutEntry {
                binding: 1,
                visibility: both,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled,
                },
                count: None,
            },
            uniform(2, SHELTER_BYTES),
            uniform(3, size_of::<SplashUniform>()),
            uniform(4, LIGHT_BYTES),
            uniform(7, COLUMNS_BYTES),
            uniform(8, size_of::<LocalUniform>() - COLUMNS_BYTES),
        ],
    })
}

/// A count, and the boxes after it.
pub(super) const SHELTER_BYTES: usize = 16 + MAX_SHELTERS * 64;
/// Likewise.
const LIGHT_BYTES: usize = 16 + MAX_LIGHTS * size_of::<LightUniform>();
/// The columns of [`LocalUniform`], which are a block of their own.
const COLUMNS_BYTES: usize = std::mem::offset_of!(LocalUniform, counts);
/// Where each block begins: rain, splashes, shelters, lights, columns of areas, drops of areas; and the end.
pub(super) const STARTS: [usize; 7] = {
    let splash = size_of::<RainUniform>().next_multiple_of(256);
    let shelters = splash + size_of::<SplashUniform>().next_multiple_of(256);
    let lights = shelters + SHELTER_BYTES.next_multiple_of(256);
    let columns = lights + LIGHT_BYTES.next_multiple_of(256);
    let local = columns + COLUMNS_BYTES.next_multiple_of(256);
    [0, splash, shelters, lights, columns, local, local + size_of::<LocalUniform>() - COLUMNS_BYTES]
};

impl RainLayer {
    pub fn new(device: &Device) -> Self {
        Self {
            blocks: device.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("rain"),
                size: STARTS[6] as u64,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            staged: vec![0; STARTS[6]],
            layouts: [layout(&device.device, false), layout(&device.device, true)],
            pipelines: [const { [None, None] }; 8],
            cones: None,
            stepped: None,
            stones: None,
            none: None,
            texture: None,
            bound: None,
        }
    }

    /// Bytes of GPU memory that the layer holds.
    pub fn bytes(&self) -> u64 {
        let layer = self.texture.as_ref().map_or(0, |(t, _)| 8 * u64::from(t.width()) * u64::from(t.height()));
        let cones = self.cones.as_ref().map_or(0, ConePass::bytes);
        layer + cones + self.stepped.as_ref().map_or(0, StepPass::bytes)
    }

    /// The layer for a picture of this size, made anew if that changed; its content is what was drawn last.
    pub fn view(&mut self, device: &Device, size: wgpu::Extent3d) -> &wgpu::TextureView {
        let fits = |(t, _): &(wgpu::Texture, wgpu::TextureView)| (t.width(), t.height()) == (size.width, size.height);
        if !self.texture.as_ref().is_some_and(fits) {
            self.texture = None;
        }
        &self
            .texture
            .get_or_insert_with(|| {
                let texture = device.device.create_texture(&wgpu::TextureDescriptor {
                    label: Some("drops"),
                    size: wgpu::Extent3d { depth_or_array_layers: 1, ..size },
                    mip_level_count: 1,
                    sample_count: 1,
                    dimension: wgpu::TextureDimension::D2,
                    format: FORMAT,
                    usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
                    view_formats: &[],
                });
                let view = texture.create_view(&Default::default());
                (texture, view)
            })
            .1
    }

    /// Draws the drops for a picture like `color` with the host's `depth`, and where there is depth their splashes.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn draw(
        &mut self,
        device: &Arc<Device>,
        encoder: &mut wgpu::CommandEncoder,
        drawn: &Drawn<'_>,
        color: &wgpu::Texture,
        depth: Option<&wgpu::Texture>,
    ) -> Result<()> {
        self.write(device, drawn);
        let multi = depth.is_some_and(|d| d.sample_count() > 1);
        self.bind(device, depth, multi);
        self.view(device, color.size());
        let kind = (multi, depth.is_some());
        let areas = drawn.local.is_some();
        let key = usize::from(areas) * 4 + usize::from(multi) * 2 + usize::from(depth.is_some());
        let layout = &self.layouts[usize::from(multi)];
        if let Some(stones) = &drawn.stones {
            self.stones.get_or_insert_with(|| StonePass::new(device)).prepare(device, stones, layout, FORMAT, kind)?;
        }
        if let Some(block) = drawn.cones {
            self.cones.get_or_insert_with(|| ConePass::new(device)).prepare(device, block, layout, kind)?;
            self.draw_into(encoder, drawn.over, |pass, layer| {
                layer.cones.iter().for_each(|c| c.draw(pass, kind));
                layer.draw_stones(pass, kind, drawn);
            });
            return Ok(());
        }
        if let Some(stepped) = drawn.stepped {
            let pass = self.stepped.get_or_insert_with(|| StepPass::new(device));
            pass.prepare_draw(device, layout, kind, areas)?;
            pass.step(device, encoder, &self.blocks, stepped)?;
        }
        for (slot, vertex) in self.pipelines[key].iter_mut().zip(["rain_vertex", "splash_vertex"]) {
            if slot.is_none() {
                *slot = Some(pipeline(device, layout, vertex, multi, [depth.is_some(), areas])?);
            }
        }
        self.draw_into(encoder, drawn.over, |pass, layer| {
            let [Some(falling), Some(splashing)] = &layer.pipelines[key] else { return };
            match (&layer.stepped, drawn.stepped) {
                (Some(stepped), Some(_)) => stepped.draw(pass, kind, areas),
                _ => {
                    pass.set_pipeline(falling);
                    pass.draw(0..4, 0..drawn.rain.per_shell * SHELLS as u32);
                }
            }
            if depth.is_some() && drawn.splashes > 0 {
                pass.set_pipeline(splashing);
                pass.draw(0..4, 0..drawn.splashes);
            }
            layer.draw_stones(pass, kind, drawn);
        });
        Ok(())
    }

    fn draw_stones(&self, pass: &mut wgpu::RenderPass<'_>, kind: (bool, bool), drawn: &Drawn<'_>) {
        if let (Some(stones), Some(own)) = (&drawn.stones, &self.stones) {
            own.draw(pass, kind, stones);
        }
    }

    /// Draws into the layer, over what is there or a clear one.
    fn draw_into(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        over: bool,
        draw: impl FnOnce(&mut wgpu::RenderPass<'_>, &Self),
    ) {
        let (Some((.., group)), Some((_, target))) = (&self.bound, &self.texture) else { return };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("drops"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: if over { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) },
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_bind_group(0, group, &[]);
        draw(&mut pass, self);
    }

    fn write(&mut self, device: &Device, drawn: &Drawn<'_>) {
        let staged = &mut self.staged;
        let mut put = |at: usize, bytes: &[u8]| staged[at..at + bytes.len()].copy_from_slice(bytes);
        let boxes = &drawn.shelters[..drawn.shelters.len().min(MAX_SHELTERS)];
        let lights = &drawn.lights[..drawn.lights.len().min(MAX_LIGHTS)];
        put(STARTS[0], bytemuck::bytes_of(drawn.rain));
        put(STARTS[1], bytemuck::bytes_of(drawn.splash));
        put(STARTS[2], &(boxes.len() as u32).to_ne_bytes());
        put(STARTS[2] + 16, bytemuck::cast_slice(boxes));
        put(STARTS[3], &(lights.len() as u32).to_ne_bytes());
        put(STARTS[3] + 16, bytemuck::cast_slice(lights));
        // What lies behind the last lamp is not read, if no rim of an area is near.
        let mut end = STARTS[3] + 16 + size_of_val(lights);
        if let Some(local) = drawn.local {
            let (columns, counts) = bytemuck::bytes_of(local).split_at(COLUMNS_BYTES);
            put(STARTS[4], columns);
            put(STARTS[5], counts);
            end = STARTS[6];
        }
        device.queue.write_buffer(&self.blocks, 0, &self.staged[..end]);
    }

    fn bind(&mut self, device: &Device, depth: Option<&wgpu::Texture>, multi: bool) {
        if self.bound.as_ref().is_some_and(|(d, m, _)| d.as_ref() == depth && *m == multi) {
            return;
        }
        let view = depth.map(|t| {
            let aspect =
                if t.format().has_depth_aspect() { wgpu::TextureAspect::DepthOnly } else { wgpu::TextureAspect::All };
            t.create_view(&wgpu::TextureViewDescriptor { aspect, ..Default::default() })
        });
        let none = self.none.get_or_insert_with(|| nothing(&device.device));
        let block = |binding, offset: usize, size: usize| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &self.blocks,
                offset: offset as u64,
                size: wgpu::BufferSize::new(size as u64),
            }),
        };
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain"),
            layout: &self.layouts[usize::from(multi)],
            entries: &[
                block(0, 0, size_of::<RainUniform>()),
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::TextureView(view.as_ref().unwrap_or(none)),
                },
                block(2, STARTS[2], SHELTER_BYTES),
                block(3, STARTS[1], size_of::<SplashUniform>()),
                block(4, STARTS[3], LIGHT_BYTES),
                block(7, STARTS[4], COLUMNS_BYTES),
                block(8, STARTS[5], size_of::<LocalUniform>() - COLUMNS_BYTES),
            ],
        });
        self.bound = Some((depth.cloned(), multi, group));
    }
}

/// A texture that stands for a depth the host does not give.
fn nothing(device: &wgpu::Device) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("no depth"),
        size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}

fn pipeline(
    device: &Device,
    layout: &wgpu::BindGroupLayout,
    vertex: &str,
    multi: bool,
    [has_depth, areas]: [bool; 2],
) -> Result<wgpu::RenderPipeline> {
    let module = device.shader(if multi { "rain/drops_multi.wgsl" } else { "rain/drops_single.wgsl" })?;
    let layout = device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("drops"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    let constants = [("HAS_DEPTH", f64::from(u8::from(has_depth)))];
    // Mixtures take each column by itself: what lies over what is in their order.
    let near = [("AREAS", f64::from(u8::from(areas))), ("OVERLAPS", 0.0)];
    Ok(device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("drops"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(vertex),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &near, ..Default::default() },
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::TriangleStrip, ..Default::default() },
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("rain_fragment"),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            targets: &[Some(wgpu::ColorTargetState {
                format: FORMAT,
                blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    }))
}
