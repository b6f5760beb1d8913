//! Painting: the world's picture encoded for a display, and the panel over it, into a window's image or into one that a
//! file is written from.

use std::{path::Path, sync::Arc};

use welkin::gpu::{Device, readback};

/// Format of the pictures: numbers by the sRGB curve, as the panel's renderer wants them.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Renderer of the panel, and the pass that encodes the picture for it.
pub struct Painter {
    gpu: Arc<Device>,
    panel: egui_wgpu::Renderer,
    encode: wgpu::RenderPipeline,
    bound: wgpu::BindGroupLayout,
    /// Encoded picture of the world, and its name in the panel.
    shown: Option<(wgpu::Texture, egui::TextureId)>,
}

impl Painter {
    /// Creates it for images of one format.
    pub fn new(gpu: &Arc<Device>, format: wgpu::TextureFormat) -> Self {
        let device = &gpu.device;
        let options = egui_wgpu::RendererOptions { dithering: false, ..Default::default() };
        let module = device.create_shader_module(wgpu::include_wgsl!("encode.wgsl"));
        let bound = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("studio: encode"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            }],
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("studio: encode"),
            bind_group_layouts: &[Some(&bound)],
            immediate_size: 0,
        });
        let encode = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("studio: encode"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("encode"),
                compilation_options: Default::default(),
                targets: &[Some(FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { gpu: gpu.clone(), panel: egui_wgpu::Renderer::new(device, format, options), encode, bound, shown: None }
    }

    /// Takes over a picture of the world. Returns its name in the panel.
    pub fn show(&mut self, picture: &wgpu::Texture) -> egui::TextureId {
        let device = &self.gpu.device;
        let fits = |shown: &wgpu::Texture| shown.size() == picture.size();
        if !self.shown.as_ref().is_some_and(|(shown, _)| fits(shown)) {
            let texture = target(device, [picture.width(), picture.height()]);
            let view = texture.create_view(&Default::default());
            let linear = wgpu::FilterMode::Linear;
            let id = match self.shown.take() {
                Some((_, id)) => {
                    self.panel.update_egui_texture_from_wgpu_texture(device, &view, linear, id);
                    id
                }
                None => self.panel.register_native_texture(device, &view, linear),
            };
            self.shown = Some((texture, id));
        }
        let Some((shown, id)) = &self.shown else { return egui::TextureId::default() };
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("studio: encode"),
            layout: &self.bound,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&picture.create_view(&Default::default())),
            }],
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut pass = begin(&mut encoder, &shown.create_view(&Default::default()));
        pass.set_pipeline(&self.encode);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        self.gpu.queue.submit([encoder.finish()]);
        *id
    }

    /// Paints the panel into an image.
    pub fn paint(&mut self, context: &egui::Context, mut output: egui::FullOutput, into: &wgpu::Texture) {
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let screen = egui_wgpu::ScreenDescriptor {
            size_in_pixels: [into.width(), into.height()],
            pixels_per_point: output.pixels_per_point,
        };
        let mut textures = std::mem::take(&mut output.textures_delta);
        let triangles = context.tessellate(std::mem::take(&mut output.shapes), output.pixels_per_point);
        for (id, delta) in
            textures.set.drain().flat_map(|(id, deltas)| deltas.into_iter().map(move |delta| (id, delta)))
        {
            self.panel.update_texture(device, queue, id, &delta);
        }
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut commands = self.panel.update_buffers(device, queue, &mut encoder, &triangles, &screen);
        let mut pass = begin(&mut encoder, &into.create_view(&Default::default())).forget_lifetime();
        self.panel.render(&mut pass, &triangles, &screen);
        drop(pass);
        commands.push(encoder.finish());
        queue.submit(commands);
        for id in textures.free.drain() {
            self.panel.free_texture(&id);
        }
    }

    /// Writes the world's picture, without the panel, as PNG.
    ///
    /// # Errors
    /// A sentence with the file's name.
    pub fn write_shown(&self, path: &Path) -> Result<(), String> {
        let (shown, _) = self.shown.as_ref().ok_or("no picture has been drawn yet")?;
        write(&self.gpu, shown, path)
    }
}

fn begin<'a>(encoder: &'a mut wgpu::CommandEncoder, view: &wgpu::TextureView) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("studio"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    })
}

/// Creates an image that is painted into and written to a file.
pub fn target(device: &wgpu::Device, [width, height]: [u32; 2]) -> wgpu::Texture {
    use wgpu::TextureUsages as U;
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("studio"),
        size: wgpu::Extent3d { width: width.max(1), height: height.max(1), depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: U::RENDER_ATTACHMENT | U::TEXTURE_BINDING | U::COPY_SRC,
        view_formats: &[],
    })
}

/// Writes an image as PNG.
///
/// # Errors
/// A sentence with the file's name.
pub fn write(gpu: &Device, image: &wgpu::Texture, path: &Path) -> Result<(), String> {
    let bytes = readback::bytes(gpu, image, 0).map_err(|e| e.to_string())?;
    let rgb: Vec<u8> = bytes.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    welkin_command_line::write_png(path, &rgb, [image.width(), image.height()]).map_err(|e| e.to_string())
}
