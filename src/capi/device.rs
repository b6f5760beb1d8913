//! Devices
//!
//! A wk_device is one native queue or OpenGL context, with everything that the wk_contexts on it share: pipelines,
//! tables, caches. Create one here (an own device, which Welkin makes itself), from the host's OpenGL context, from the
//! host's Vulkan device, or, in Rust, from the host's wgpu device. All later calls are the same for these four kinds of
//! device.
//!
//! Create one device per native queue or OpenGL context: a call that would create a second one returns
//! WK_ERROR_ALREADY_WRAPPED. When the GPU is lost (driver reset, unplugged), every call that needs the GPU returns
//! WK_ERROR_DEVICE_LOST: calls that create, build or draw, calls that read or write GPU resources, and
//! wk_context_get_ambient. A wk_context's weather, time, settings, state and other queries need no GPU and go on
//! working. To recover, save the state with wk_context_save, destroy the views, the contexts and the device, create
//! them again, and load the state.

use std::{
    ffi::{CString, c_char, c_void},
    ptr::null,
    sync::Arc,
};

pub use super::boundary::objects::device::*;
use super::boundary::{
    DeviceCell, Host, guard, handles,
    input::{MAX_BATCH, out},
    layout::{self, init_struct, struct_size},
    numbers::*,
};
use crate::{
    error::{Result, Status},
    gpu::{Device, DeviceOptions},
};

include!(concat!(env!("OUT_DIR"), "/init_device.rs"));

/// Native graphics interfaces, as flags.
pub type wk_backend_flags = u32;
/// No graphics: draws nothing and needs no GPU, for tests of your own code.
pub const WK_BACKEND_NOOP: wk_backend_flags = 1;
/// Vulkan.
pub const WK_BACKEND_VULKAN: wk_backend_flags = 2;
/// Metal.
pub const WK_BACKEND_METAL: wk_backend_flags = 4;
/// Direct3D 12.
pub const WK_BACKEND_DX12: wk_backend_flags = 8;
/// OpenGL or OpenGL ES.
pub const WK_BACKEND_GL: wk_backend_flags = 16;
/// Any of Vulkan, Metal, Direct3D 12 and OpenGL; Welkin takes the best one that works.
pub const WK_BACKEND_ANY: wk_backend_flags = 30;

/// Flags of an own device.
pub type wk_device_flags = u32;
/// Use no compute shaders, even where the device has them. Welkin then draws as on a device with OpenGL 3.3.
pub const WK_DEVICE_FORCE_TIER0: wk_device_flags = 1;
/// Use a software driver, which draws on the CPU.
pub const WK_DEVICE_FORCE_SOFTWARE: wk_device_flags = 2;

/// Settings for an own device.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_device_desc {
    /// sizeof(wk_device_desc) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_DEVICE_DESC.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Native interfaces that may be used. Default WK_BACKEND_ANY.
    pub backends: wk_backend_flags,
    /// Flags of the device. Default 0.
    pub flags: wk_device_flags,
}

impl wk_device_desc {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_DEVICE_DESC,
        next: null(),
        backends: WK_BACKEND_ANY,
        flags: 0,
    };
}

/// Capabilities of a device.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_caps {
    /// sizeof(wk_caps) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_CAPS.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Native interface that the device uses.
    pub backend: wk_backend_flags,
    /// Tier of features: 0 without compute shaders (OpenGL 3.3 to 4.2, OpenGL on macOS), 1 with them. On tier 0 a call
    /// for a feature that needs tier 1 returns WK_ERROR_UNSUPPORTED, with a message that names the feature.
    pub tier: u32,
    /// 1 for a software driver, which draws on the CPU, else 0.
    pub software: u32,
    /// Largest edge of a 2-D texture, pixels.
    pub max_texture_size: u32,
    /// Most cloud layers in a wk_weather.
    pub max_cloud_layers: u32,
    /// Most positions or rays in one batch query.
    pub max_batch: u32,
    /// Name that the adapter reports, UTF-8; lives as long as the device.
    pub adapter_name: *const c_char,
    /// Name and version that the driver reports, UTF-8; lives as long as the device.
    pub driver: *const c_char,
}

impl wk_caps {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_CAPS,
        next: null(),
        backend: 0,
        tier: 0,
        software: 0,
        max_texture_size: 0,
        max_cloud_layers: 0,
        max_batch: 0,
        adapter_name: null(),
        driver: null(),
    };
}

/// Enters a new device into the handle table.
pub(super) fn issue(gpu: Arc<Device>, host: Host) -> Result<*mut wk_device> {
    let text = |s: &str| CString::new(s.replace('\0', " ")).unwrap_or_default();
    let (adapter_name, driver) = (text(&gpu.caps().adapter_name), text(&gpu.caps().driver));
    let cell = DeviceCell::new(gpu, host);
    handles::insert::<_, DeviceObject>(Arc::new(DeviceObject { cell, adapter_name, driver }), None)
}

/// Creates an own device, without a window. `desc` NULL means WK_DEVICE_DESC_INIT. On success `*out_device` is a new
/// handle, which you destroy with `wk_device_destroy`; on failure `*out_device` stays untouched.
/// Thread: any.
/// Errors: WK_ERROR_NO_ADAPTER if no driver fits the request, or if an OpenGL driver draws a few known test texels
/// wrong or does not finish them within 6 s; WK_ERROR_INVALID_ARGUMENT naming the field.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_device_create(desc: *const wk_device_desc, out_device: *mut *mut wk_device) -> wk_status {
    guard("wk_device_create", |_| {
        let place = out("out_device", out_device)?;
        // SAFETY: the caller's promise about `desc`.
        let desc = unsafe { layout::read_or_default(&"desc", desc)? };
        // SAFETY: as above.
        unsafe { layout::check_chain(&"desc", desc.next, &[])? };
        let handle = issue(Device::headless(&options(&desc))?, Host::Own)?;
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(handle) };
        Ok(Status::Ok)
    })
}

/// Converts the settings of an own device to those of the Rust side.
pub(super) fn options(desc: &wk_device_desc) -> DeviceOptions {
    let pairs = [
        (WK_BACKEND_NOOP, wgpu::Backends::NOOP),
        (WK_BACKEND_VULKAN, wgpu::Backends::VULKAN),
        (WK_BACKEND_METAL, wgpu::Backends::METAL),
        (WK_BACKEND_DX12, wgpu::Backends::DX12),
        (WK_BACKEND_GL, wgpu::Backends::GL),
    ];
    let chosen = pairs.iter().filter(|p| desc.backends & p.0 != 0);
    DeviceOptions {
        backends: chosen.fold(wgpu::Backends::empty(), |all, p| all | p.1),
        force_tier0: desc.flags & WK_DEVICE_FORCE_TIER0 != 0,
        force_software: desc.flags & WK_DEVICE_FORCE_SOFTWARE != 0,
    }
}

/// Destroys a device. NULL does nothing.
/// Thread: any, except for a device on an OpenGL context. Destroy such a device on a thread where the context is (or
/// can be made) current. Elsewhere, or when the OpenGL context is already gone, Welkin abandons the device's GPU
/// objects.
/// Errors: WK_ERROR_IN_USE while it has contexts, surfaces or textures; WK_ERROR_DEVICE_LOST if a host's Vulkan device
/// is lost: the wk_device is then destroyed all the same.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_device_destroy(device: *mut wk_device) -> wk_status {
    guard("wk_device_destroy", |_| {
        if !device.is_null() {
            let object = handles::remove::<DeviceObject>("device", device)?;
            let host = object.cell.close();
            drop(object);
            host.close()?;
        }
        Ok(Status::Ok)
    })
}

/// Returns WK_OK while the device works, WK_ERROR_DEVICE_LOST or WK_ERROR_POISONED when it no longer does.
/// Thread: any, at any time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_device_get_status(device: *const wk_device) -> wk_status {
    guard("wk_device_get_status", |call| {
        call.get::<DeviceObject>("device", device)?.cell.check_not_lost()?;
        Ok(Status::Ok)
    })
}

/// Gets the capabilities of a device. The two texts in the answer live as long as the device.
/// Thread: any, at any time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_device_get_caps(device: *const wk_device, out_caps: *mut wk_caps) -> wk_status {
    guard("wk_device_get_caps", |call| {
        let object = call.get::<DeviceObject>("device", device)?;
        // SAFETY: the caller's promise about `out_caps`.
        let place = unsafe { layout::out_struct(&"out_caps", out_caps)? };
        let caps = object.cell.gpu().caps();
        place.set(&wk_caps {
            backend: backend_flag(caps.backend),
            tier: caps.tier,
            software: u32::from(caps.software),
            max_texture_size: caps.max_texture_size,
            max_cloud_layers: 16,
            max_batch: MAX_BATCH as u32,
            adapter_name: object.adapter_name.as_ptr(),
            driver: object.driver.as_ptr(),
            ..wk_caps::INIT
        });
        Ok(Status::Ok)
    })
}

/// Returns the C flag of a graphics interface.
fn backend_flag(backend: wgpu::Backend) -> wk_backend_flags {
    match backend {
        wgpu::Backend::Vulkan => WK_BACKEND_VULKAN,
        wgpu::Backend::Metal => WK_BACKEND_METAL,
        wgpu::Backend::Dx12 => WK_BACKEND_DX12,
        wgpu::Backend::Gl => WK_BACKEND_GL,
        wgpu::Backend::Noop | wgpu::Backend::BrowserWebGpu => WK_BACKEND_NOOP,
    }
}
