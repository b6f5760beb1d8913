//! Textures of an own device
//!
//! These textures are for hosts without graphics of their own: programs that want pictures in memory, or that draw with
//! Welkin only. Hosts with OpenGL, Vulkan or wgpu pass their own images instead and do not need these textures.

use std::{
    ffi::c_void,
    ptr::null,
    sync::{Arc, Mutex, PoisonError},
};

pub use super::boundary::objects::texture::*;
use super::boundary::{
    DeviceCell, guard, handles,
    input::{self, Named, out},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{DeviceObject, wk_device},
};
use crate::{
    error::{Error, Result, Status, check_range},
    gpu::readback,
};

include!(concat!(env!("OUT_DIR"), "/init_texture.rs"));

/// Texel formats, little-endian, channels in the order of the name.
pub type wk_format = u32;
/// 8-bit normalised, 4 bytes: colour that is display-encoded or display-linear.
pub const WK_FORMAT_RGBA8_UNORM: wk_format = 1;
/// 8-bit normalised with the sRGB curve, 4 bytes.
pub const WK_FORMAT_RGBA8_SRGB: wk_format = 2;
/// 8-bit normalised, 4 bytes.
pub const WK_FORMAT_BGRA8_UNORM: wk_format = 3;
/// 8-bit normalised with the sRGB curve, 4 bytes.
pub const WK_FORMAT_BGRA8_SRGB: wk_format = 4;
/// Half floats, 8 bytes: scene-linear colour.
pub const WK_FORMAT_RGBA16_FLOAT: wk_format = 5;
/// Floats, 16 bytes: scene-linear colour. Some drivers do not support it as a target.
pub const WK_FORMAT_RGBA32_FLOAT: wk_format = 6;
/// One float, 4 bytes: depth as the host's projection gives it.
pub const WK_FORMAT_R32_FLOAT: wk_format = 7;
/// 8-bit normalised, 1 byte: a mask.
pub const WK_FORMAT_R8_UNORM: wk_format = 8;

/// Settings for a new texture.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_texture_desc {
    /// sizeof(wk_texture_desc) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_TEXTURE_DESC.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Width, pixels. Range [1, wk_caps.max_texture_size], default 1.
    pub width: u32,
    /// Height, pixels. Range [1, wk_caps.max_texture_size], default 1.
    pub height: u32,
    /// Texel format. Default WK_FORMAT_RGBA8_UNORM.
    pub format: wk_format,
    /// Must be 0.
    pub reserved0: u32,
}

impl wk_texture_desc {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_TEXTURE_DESC,
        next: null(),
        width: 1,
        height: 1,
        format: WK_FORMAT_RGBA8_UNORM,
        reserved0: 0,
    };
}

/// Returns the header's name of a checked constant.
pub(super) fn name_of(format: wk_format) -> &'static str {
    layout::WK_FORMAT.values.iter().find(|v| v.1 == u64::from(format)).map_or("?", |v| v.0)
}

/// Returns the wgpu format of a checked constant.
fn format(format: wk_format) -> wgpu::TextureFormat {
    match format {
        WK_FORMAT_RGBA8_SRGB => wgpu::TextureFormat::Rgba8UnormSrgb,
        WK_FORMAT_BGRA8_UNORM => wgpu::TextureFormat::Bgra8Unorm,
        WK_FORMAT_BGRA8_SRGB => wgpu::TextureFormat::Bgra8UnormSrgb,
        WK_FORMAT_RGBA16_FLOAT => wgpu::TextureFormat::Rgba16Float,
        WK_FORMAT_RGBA32_FLOAT => wgpu::TextureFormat::Rgba32Float,
        WK_FORMAT_R32_FLOAT => wgpu::TextureFormat::R32Float,
        WK_FORMAT_R8_UNORM => wgpu::TextureFormat::R8Unorm,
        _ => wgpu::TextureFormat::Rgba8Unorm,
    }
}

/// Creates a texture, filled with zeros. On success `*out_texture` is a new handle for `wk_texture_destroy`.
/// Thread: any.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range; WK_ERROR_UNSUPPORTED if the device cannot make the
/// format, or cannot draw into a format of colour; WK_ERROR_OUT_OF_MEMORY.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_texture_create(
    device: *mut wk_device,
    desc: *const wk_texture_desc,
    out_texture: *mut *mut wk_texture,
) -> wk_status {
    guard("wk_texture_create", |call| {
        let object = call.get::<DeviceObject>("device", device)?;
        // SAFETY: the caller's promise about `desc`.
        let desc = unsafe { layout::read(&"desc", desc)? };
        // SAFETY: as above.
        unsafe { layout::check_chain(&"desc", desc.next, &[])? };
        let place = out("out_texture", out_texture)?;
        let texture = create(&object.cell, &desc)?;
        let (cell, format) = (object.cell.clone(), desc.format);
        let texture = TextureObject { cell, texture, format, transfer: Mutex::new(()) };
        let handle = handles::insert::<_, DeviceObject>(Arc::new(texture), Some(device))?;
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(handle) };
        Ok(Status::Ok)
    })
}

fn create(cell: &DeviceCell, desc: &wk_texture_desc) -> Result<wgpu::Texture> {
    let gpu = cell.gpu();
    let most = f64::from(gpu.caps().max_texture_size);
    check_range("desc.width", f64::from(desc.width), 1.0, most, "pixels")?;
    check_range("desc.height", f64::from(desc.height), 1.0, most, "pixels")?;
    let format = format(desc.format);
    let mut usage =
        wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST;
    // WebGPU guarantees more than some drivers support: OpenGL drivers need not draw into 32-bit float textures.
    let mut allowed = format.guaranteed_format_features(gpu.device.features()).allowed_usages;
    if !gpu.adapter.get_downlevel_capabilities().is_webgpu_compliant() {
        allowed &= gpu.adapter.get_texture_format_features(format).allowed_usages;
    }
    let only_read = matches!(desc.format, WK_FORMAT_R32_FLOAT | WK_FORMAT_R8_UNORM);
    if !only_read || allowed.contains(wgpu::TextureUsages::RENDER_ATTACHMENT) {
        usage |= wgpu::TextureUsages::RENDER_ATTACHMENT;
    }
    if !allowed.contains(usage) {
        let rest = "must be one that this device can make and draw into: WK_FORMAT_RGBA16_FLOAT always is";
        let rest = format!("{rest}, got {}", name_of(desc.format));
        return Err(Error::about(Status::Unsupported, "desc.format", rest));
    }
    let _entered = cell.enter()?;
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("host texture"),
        size: wgpu::Extent3d { width: desc.width, height: desc.height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    });
    gpu.check_made()?;
    Ok(texture)
}

/// Destroys a texture. NULL does nothing. Views that use the texture keep it alive for as long as they need it.
/// Thread: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_texture_destroy(texture: *mut wk_texture) -> wk_status {
    guard("wk_texture_destroy", |_| {
        if !texture.is_null() {
            let object = handles::remove::<TextureObject>("texture", texture)?;
            object.cell.clone().retire(object);
        }
        Ok(Status::Ok)
    })
}

/// Fills a texture from memory: all rows of the texture, `bytes_per_row` bytes each, from the top of the picture down.
/// `data_size` is the number of bytes at `data`: at least `bytes_per_row` times the texture's height. Copied during the
/// call.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT for a `bytes_per_row` or a `data_size` that is too small; WK_ERROR_DEVICE_LOST.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_texture_write(
    texture: *mut wk_texture,
    data: *const c_void,
    data_size: usize,
    bytes_per_row: u32,
) -> wk_status {
    guard("wk_texture_write", |call| {
        let object = call.get::<TextureObject>("texture", texture)?;
        // SAFETY: the caller promises `data_size` readable bytes.
        let bytes = unsafe { input::slice("data", data.cast::<u8>(), Named("data_size", data_size), usize::MAX)? };
        check_rows(&object.texture, data_size, bytes_per_row)?;
        let _one = object.transfer.lock().unwrap_or_else(PoisonError::into_inner);
        let _entered = object.cell.enter()?;
        let gpu = object.cell.gpu();
        gpu.queue.write_texture(
            object.texture.as_image_copy(),
            bytes,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(bytes_per_row), rows_per_image: None },
            object.texture.size(),
        );
        gpu.check()?;
        Ok(Status::Ok)
    })
}

/// Waits for the GPU and copies a texture to memory: all rows of the texture, `bytes_per_row` bytes each, from the top
/// of the picture down. `data_size` is the number of bytes available at `data`: at least `bytes_per_row` times the
/// texture's height. Slow: do not call it in every frame.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT for a `bytes_per_row` or a `data_size` that is too small; WK_ERROR_DEVICE_LOST.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_texture_read(
    texture: *mut wk_texture,
    data: *mut c_void,
    data_size: usize,
    bytes_per_row: u32,
) -> wk_status {
    guard("wk_texture_read", |call| {
        let object = call.get::<TextureObject>("texture", texture)?;
        layout::check_pointer(&"data", data.cast::<u8>())?;
        check_rows(&object.texture, data_size, bytes_per_row)?;
        let _one = object.transfer.lock().unwrap_or_else(PoisonError::into_inner);
        let entered = object.cell.enter()?;
        let packed = readback::bytes(object.cell.gpu(), &object.texture, 0)?;
        drop(entered);
        // SAFETY: the caller promises `data_size` writable bytes.
        let room = unsafe { input::slice_mut("data", data.cast::<u8>(), Named("data_size", data_size), usize::MAX)? };
        let row = packed.len() / object.texture.height() as usize;
        for (from, to) in packed.chunks_exact(row).zip(room.chunks_mut(bytes_per_row as usize)) {
            to[..row].copy_from_slice(from);
        }
        Ok(Status::Ok)
    })
}

/// Checks that `bytes_per_row` holds a row, and `data_size` all rows.
fn check_rows(texture: &wgpu::Texture, data_size: usize, bytes_per_row: u32) -> Result<()> {
    let texel = u64::from(texture.format().block_copy_size(None).unwrap_or(1));
    let row = u64::from(texture.width()) * texel;
    if u64::from(bytes_per_row) < row {
        let accepted = format!("at least {row} (width times {texel} bytes)");
        return Err(Error::range("bytes_per_row", &accepted, bytes_per_row));
    }
    let all = u64::from(bytes_per_row) * u64::from(texture.height());
    if (data_size as u64) < all {
        return Err(Error::range("data_size", &format!("at least {all} (bytes_per_row times height)"), data_size));
    }
    Ok(())
}
