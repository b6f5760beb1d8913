//! Picture that stands in for a window's image that can only be drawn to (OpenGL). The effects draw into the stand-in,
//! and read and copy from it what is drawn so far. Only the finished picture goes to the window.

use super::{
    Device,
    bind::{self, Slot},
    pass,
};
use crate::error::Result;

/// Texture of the window's size and format, and the pipeline that copies it to the window's image.
pub(super) struct StandIn {
    pub(super) texture: wgpu::Texture,
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
}

impl StandIn {
    /// Creates a stand-in for images of this format and size.
    ///
    /// # Errors
    /// The errors of [`pass::fullscreen`].
    pub(super) fn new(
        device: &Device,
        (width, height): (u32, u32),
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> Result<Self> {
        let texture = device.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("window stand-in"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: usage | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let layout =
            bind::layout(&device.device, "window stand-in", wgpu::ShaderStages::FRAGMENT, &[(0, Slot::Texels)]);
        let view = texture.create_view(&Default::default());
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("window stand-in"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) }],
        });
        let pipeline = pass::fullscreen(
            device,
            &pass::FullscreenDesc {
                shader: "surface/copy.wgsl",
                entry: "copy_texels",
                layouts: &[&layout],
                targets: &[format.into()],
                constants: &[],
                samples: 1,
            },
        )?;
        Ok(Self { texture, pipeline, group })
    }

    /// Copies the picture to the window's image and submits the copy.
    pub(super) fn copy_to(&self, device: &Device, image: &wgpu::Texture) {
        let mut encoder = device.device.create_command_encoder(&Default::default());
        let view = image.create_view(&Default::default());
        pass::draw(&mut encoder, "window", &self.pipeline, &[&self.group], &view);
        device.submit(encoder);
    }
}
