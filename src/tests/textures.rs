//! Textures of the tests' hosts.

use crate::gpu::Device;

/// Texture that is drawn into, sampled, copied, and filled from the CPU.
pub fn texture(
    device: &Device,
    (width, height): (u32, u32),
    format: wgpu::TextureFormat,
    samples: u32,
) -> wgpu::Texture {
    use wgpu::TextureUsages as U;
    // Multisampled textures cannot be filled, and not all drivers draw into 32-bit floats.
    let filled = if samples == 1 { U::COPY_DST } else { U::empty() };
    let drawn = if format == wgpu::TextureFormat::R32Float { U::empty() } else { U::RENDER_ATTACHMENT };
    device.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: U::TEXTURE_BINDING | U::COPY_SRC | filled | drawn,
        view_formats: &[],
    })
}
