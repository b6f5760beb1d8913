//! Reading of textures back to the CPU, for queries, probes, tests and pictures. Reading waits for the GPU. So no frame
//! reads a texture, except for the first texel of the sky's tables on OpenGL (`src/sky/kit/first.rs`).

use half::f16;

use super::{counts::DeviceWork, device::Device};
use crate::error::{Error, Result, Status};

/// Returns the number of bytes of a texel, for the formats that can be read back.
fn texel_bytes(format: wgpu::TextureFormat) -> Result<u32> {
    use wgpu::TextureFormat as F;
    match format {
        F::R8Unorm => Ok(1),
        F::Rg8Unorm => Ok(2),
        F::Rgba8Unorm | F::Rgba8UnormSrgb | F::Bgra8Unorm | F::Bgra8UnormSrgb => Ok(4),
        F::R32Float | F::R32Uint | F::Rg16Float => Ok(4),
        F::Rgba16Float => Ok(8),
        F::Rgba32Float | F::Rgba32Uint => Ok(16),
        other => Err(Error::unsupported(format!("reading back a texture of format {other:?}"))),
    }
}

/// Reads the bytes of mip 0 of a 2-D texture (or of `layer` of an array), with rows tightly packed.
///
/// # Errors
/// [`Status::Unsupported`] for a format that cannot be read back; [`Status::OutOfMemory`]; [`Status::DeviceLost`] or a
/// GPU fault.
pub fn bytes(device: &Device, texture: &wgpu::Texture, layer: u32) -> Result<Vec<u8>> {
    let size = wgpu::Extent3d { depth_or_array_layers: 1, ..texture.size() };
    let origin = wgpu::Origin3d { x: 0, y: 0, z: layer };
    copied(device, wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() }, size)
}

/// Reads the bytes of a mip level with all its layers or slices, with rows tightly packed.
///
/// # Errors
/// The errors of [`bytes`].
pub(crate) fn level(device: &Device, texture: &wgpu::Texture, level: u32) -> Result<Vec<u8>> {
    let size = texture.size().mip_level_size(level, texture.dimension());
    copied(device, wgpu::TexelCopyTextureInfo { mip_level: level, ..texture.as_image_copy() }, size)
}

/// Reads the bytes of a region of a texture, which is as wide as the mip level, with rows tightly packed.
fn copied(device: &Device, source: wgpu::TexelCopyTextureInfo<'_>, size: wgpu::Extent3d) -> Result<Vec<u8>> {
    let row = size.width * texel_bytes(source.texture.format())?;
    let rows = u64::from(size.height) * u64::from(size.depth_or_array_layers);
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: u64::from(padded) * rows,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    device.check_made()?;
    let mut encoder = device.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        source,
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded),
                rows_per_image: Some(size.height),
            },
        },
        size,
    );
    device.submit(encoder);
    device.counts.add(DeviceWork::Readbacks, 1);
    let (done, answer) = std::sync::mpsc::channel();
    buffer.map_async(wgpu::MapMode::Read, .., move |r| {
        let _ = done.send(r);
    });
    device.wait()?;
    // Another thread's poll may have taken this callback and be about to run it.
    match answer.recv_timeout(std::time::Duration::from_secs(30)) {
        Ok(Ok(())) => {}
        _ => return Err(Error::new(Status::DeviceLost, "the GPU did not give a texture back")),
    }
    let map = |e| Error::new(Status::Internal, format!("mapping a readback buffer failed: {e}"));
    let view = buffer.get_mapped_range(..).map_err(map)?;
    let mut packed = Vec::new();
    let total = row as usize * rows as usize;
    let full =
        |_| Error::new(Status::OutOfMemory, format!("there are no {total} bytes of memory for a texture read back"));
    packed.try_reserve_exact(total).map_err(full)?;
    view.chunks_exact(padded as usize).for_each(|line| packed.extend_from_slice(&line[..row as usize]));
    Ok(packed)
}

/// Reads the texels of mip 0 as RGBA in f32, from a texture with four channels of 8 bits, or of format R32Float,
/// Rg16Float, Rgba16Float or Rgba32Float. Missing colour channels are 0, a missing alpha is 1. 8-bit values are divided
/// by 255 and not linearised.
///
/// # Errors
/// The errors of [`bytes`]. With debug assertions also [`Status::Internal`] if an Rgba16Float or Rgba32Float texture
/// holds a value that is not finite.
pub fn rgba(device: &Device, texture: &wgpu::Texture) -> Result<Vec<[f32; 4]>> {
    use wgpu::TextureFormat as F;
    let raw = bytes(device, texture, 0)?;
    let h = |b: &[u8], i: usize| f16::from_le_bytes([b[2 * i], b[2 * i + 1]]).to_f32();
    let s = |b: &[u8], i: usize| f32::from_le_bytes([b[4 * i], b[4 * i + 1], b[4 * i + 2], b[4 * i + 3]]);
    let u = |b: u8| f32::from(b) / 255.0;
    let size = texel_bytes(texture.format())? as usize;
    let texel = |b: &[u8]| match texture.format() {
        F::Rgba16Float => [h(b, 0), h(b, 1), h(b, 2), h(b, 3)],
        F::Rg16Float => [h(b, 0), h(b, 1), 0.0, 1.0],
        F::Rgba32Float => [s(b, 0), s(b, 1), s(b, 2), s(b, 3)],
        F::R32Float => [s(b, 0), 0.0, 0.0, 1.0],
        F::Bgra8Unorm | F::Bgra8UnormSrgb => [u(b[2]), u(b[1]), u(b[0]), u(b[3])],
        _ => [u(b[0]), u(b[1]), u(b[2]), u(b[3])],
    };
    let texels: Vec<[f32; 4]> = raw.chunks_exact(size).map(texel).collect();
    let is_faulty = |t: &[f32; 4]| !t.iter().all(|v| v.is_finite());
    if cfg!(debug_assertions)
        && matches!(texture.format(), F::Rgba16Float | F::Rgba32Float)
        && let Some(at) = texels.iter().position(is_faulty)
    {
        let (x, y) = (at % texture.width() as usize, at / texture.width() as usize);
        let message = format!("texel ({x}, {y}) of a picture is not finite: {:?}", texels[at]);
        return Err(Error::new(Status::Internal, message));
    }
    Ok(texels)
}
