//! A depth texture of a host's, from depths by rows from the top: what tests and benchmarks give as occluder maps.

use welkin::gpu::Device;

pub fn depth_texture(device: &Device, (width, height): (u32, u32), depths: &[f32]) -> wgpu::Texture {
    let texture = device.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
    device.queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(depths), rows, texture.size());
    texture
}
