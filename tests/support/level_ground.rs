//! Depth of a plain as a host provides it: reversed and infinite, near plane at 0.1 m, vertical field of view 0.9 rad.

use welkin::gpu::Device;

/// Writes the depth of level ground 2 m below a camera that looks `pitch_rad` up.
pub fn level_ground(device: &Device, depth: &wgpu::Texture, pitch_rad: f64) {
    let (width, half) = (depth.width(), 0.5 * f64::from(depth.height()));
    let row = |y: u32| {
        let ahead = (half - 0.5 - f64::from(y)) / half * 0.45f64.tan();
        0.1 * (-pitch_rad.sin() - ahead * pitch_rad.cos()).max(0.0) / 2.0
    };
    let texels: Vec<f32> = (0..width * depth.height()).map(|i| row(i / width) as f32).collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * 4), rows_per_image: None };
    device.queue.write_texture(depth.as_image_copy(), bytemuck::cast_slice(&texels), layout, depth.size());
}
