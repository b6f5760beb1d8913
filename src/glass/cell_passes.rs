//! Passes over the cells: their formats, textures, bind groups and pipelines.

use crate::{
    error::Result,
    gpu::{
        Device, flat_texture,
        pass::{self, FullscreenDesc},
    },
};

/// Format of the water in the cells, and of the moves of their beads.
pub(super) const CELLS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;
/// Format of the shares of the rain that occluder maps let through, and of snow.
pub(super) const WORD: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// Creates a texture to which passes draw.
pub(super) fn texture(
    device: &Device,
    label: &str,
    format: wgpu::TextureFormat,
    [width, height]: [u32; 2],
) -> wgpu::Texture {
    flat_texture(
        &device.device,
        label,
        (width, height),
        format,
        wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC,
    )
}

/// Creates a uniform buffer of `size` bytes.
pub(super) fn buffer(device: &Device, label: &str, size: u64) -> wgpu::Buffer {
    crate::gpu::bind::block(&device.device, label, size as usize)
}

/// Creates the view of a whole texture.
pub(super) fn view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&Default::default())
}

/// Creates a bind group of `resources`, with bindings numbered from 0.
pub(super) fn bind(
    device: &Device,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let numbered = resources.iter().enumerate();
    let entries: Vec<_> =
        numbered.map(|(i, r)| wgpu::BindGroupEntry { binding: i as u32, resource: r.clone() }).collect();
    device.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("glass"), layout, entries: &entries })
}

/// Returns a view as a resource of a bind group.
pub(super) fn tex(view: &wgpu::TextureView) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::TextureView(view)
}

/// Shader of the snow: its steps, and its declared state.
const SETTLE: &str = "glass/settle.wgsl";

/// Creates the pipelines of snow: that of a step, then that of the declared state.
pub(super) fn settle_pipelines(
    device: &Device,
    layout: &wgpu::BindGroupLayout,
    constants: &[(&str, f64)],
) -> Result<[wgpu::RenderPipeline; 2]> {
    let one = |entry| cells_pipeline(device, (SETTLE, entry), layout, constants);
    Ok([one("settle")?, one("declare_snow")?])
}

/// Creates the pipeline of a pass that draws one texel for each cell.
pub(super) fn cells_pipeline(
    device: &Device,
    (shader, entry): (&str, &str),
    layout: &wgpu::BindGroupLayout,
    constants: &[(&str, f64)],
) -> Result<wgpu::RenderPipeline> {
    let format = if shader == SETTLE { WORD } else { CELLS };
    let targets = &[format.into()];
    pass::fullscreen(device, &FullscreenDesc { shader, entry, layouts: &[layout], targets, constants, samples: 1 })
}
