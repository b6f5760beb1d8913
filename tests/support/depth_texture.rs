//! A host's depth texture from depths in rows, top row first. Tests and benchmarks use it for occluder maps.

use welkin::gpu::{Device, flat_texture};

pub fn depth_texture(device: &Device, (width, height): (u32, u32), depths: &[f32]) -> wgpu::Texture {
    let texture = flat_texture(
        &device.device,
        "depths",
        (width, height),
        wgpu::TextureFormat::R32Float,
        wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
    );
    let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
    device.queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(depths), rows, texture.size());
    texture
}
