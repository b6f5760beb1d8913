//! Adoption of a host's Vulkan device: its handles are checked and passed to wgpu.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use ash::vk;
use wgpu::hal::vulkan::Api as Vulkan;

use super::desc::VulkanHostDesc;
use super::dispatch::{self, HostRecord, QueueLock};
use super::host::VulkanHost;
use super::{checks, facts, image};
use crate::error::{Error, Result, Status};
use crate::gpu::device::Device;

/// Wraps a host's Vulkan device for drawing.
///
/// # Errors
/// [`Status::InvalidArgument`], which names a null handle, a physical device or queue that does not belong to the rest,
/// or properties that contradict each other; [`Status::Unsupported`], which names what the host's Vulkan lacks;
/// [`Status::AlreadyWrapped`] if the queue already has a Welkin device; [`Status::NoAdapter`] if the instance's
/// physical devices cannot be listed; [`Status::OutOfMemory`], [`Status::DeviceLost`] and [`Status::Internal`] from the
/// driver.
///
/// # Safety
/// Every handle in `desc` must be live, belong to the others as Vulkan requires, and outlive the result and all wgpu
/// objects made from it. The listed extensions and features must be enabled on `device`. The queue must be used as the
/// [module's contract](super) demands. Callbacks and `user` must allow use from every thread that calls Welkin.
pub unsafe fn adopt(desc: &VulkanHostDesc<'_>) -> Result<VulkanHost> {
    let handles = checks::handles(desc)?;
    let extensions = facts::known_extensions(desc.enabled_device_extensions);
    // SAFETY: the caller vouches for the handles; each step checks what the next one relies on.
    let (loaded, api_version, device, real) = unsafe {
        let loaded = checks::load_instance(desc, &handles)?;
        let api_version = checks::api_version(desc, &handles, &loaded)?;
        checks::queue_family(desc, &loaded)?;
        checks::extensions(desc.instance_api_version, api_version, &extensions, &desc.enabled_features)?;
        let (device, real) = checks::load_device(desc, &handles, &loaded, api_version, &extensions)?;
        (loaded, api_version, device, real)
    };
    // SAFETY: family and index were checked for the physical device.
    let queue = unsafe { device.get_device_queue(desc.queue_family_index, desc.queue_index) };
    if queue == vk::Queue::null() {
        let rest = "must name a queue that device was created with: vkGetDeviceQueue gave NULL";
        return Err(Error::invalid("queue_index", rest));
    }
    let lock = desc.lock_queue.zip(desc.unlock_queue);
    let record = Arc::new(HostRecord {
        instance: desc.instance,
        physical_device: desc.physical_device,
        device: desc.device,
        queue,
        queue_family_index: desc.queue_family_index,
        api_version,
        extensions,
        enabled: desc.enabled_features,
        lock: lock.map(|(lock, unlock)| QueueLock { lock, unlock, user: desc.user }),
        real,
    });
    if !dispatch::register(&record) {
        let message = "the queue already belongs to a Welkin device; use that one, or destroy it first";
        return Err(Error::new(Status::AlreadyWrapped, message));
    }
    let opened = dispatch::while_adopting(&record, || open(desc, loaded, device, &record));
    if opened.is_err() {
        dispatch::unregister(queue);
    }
    opened
}

/// Passes the checked handles to wgpu's functions for foreign devices.
fn open(
    desc: &VulkanHostDesc<'_>,
    loaded: checks::LoadedInstance,
    device: ash::Device,
    record: &Arc<HostRecord>,
) -> Result<VulkanHost> {
    // Queries of property chains are core from 1.1 on; the loader function also finds them by the extension's names.
    let chained = ash::khr::get_physical_device_properties2::NAME;
    let has_chained = record.api_version >= vk::API_VERSION_1_1 || desc.enabled_instance_extensions.contains(&chained);
    let released = Arc::new(AtomicBool::new(false));
    let (queue, on_release) = (record.queue, Arc::clone(&released));
    let drop_instance = Box::new(move || {
        dispatch::unregister(queue);
        on_release.store(true, Ordering::Release);
    });
    // The host has chosen its adapter, so wgpu's filter of non-conformant drivers must not hide it.
    let flags = wgpu::InstanceFlags::ALLOW_UNDERLYING_NONCOMPLIANT_ADAPTER;
    // SAFETY: entry and instance are the host's; the extension list says what may be called; the callback keeps wgpu
    // from destroying the host's instance.
    let hal_instance = unsafe {
        wgpu::hal::vulkan::Instance::from_raw(
            loaded.entry,
            loaded.instance,
            record.api_version,
            0,
            None,
            if has_chained { vec![chained] } else { Vec::new() },
            flags,
            wgpu::MemoryBudgetThresholds::default(),
            false,
            Some(drop_instance),
        )
    }
    .map_err(|e| Error::new(Status::Internal, format!("wrapping the host's VkInstance failed: {e}")))?;
    let exposed = hal_instance.expose_adapter(desc.physical_device).ok_or_else(|| {
        Error::unsupported("wgpu's Vulkan backend cannot draw on this physical device (see its log for the reason)")
    })?;
    let features = exposed.features & (image::FORMAT_FEATURES | desc.wanted_features);
    let limits = exposed.capabilities.limits.clone();
    // Small memory blocks, because the device's memory is mostly for the host.
    let hints = wgpu::MemoryHints::MemoryUsage;
    let raw = device.clone();
    // SAFETY: the device was made from this physical device with these extensions; capability queries return only what
    // is enabled; the callback keeps wgpu from destroying the host's device.
    let opened = unsafe {
        exposed.adapter.device_from_raw(
            device,
            Some(Box::new(|| {})),
            &record.extensions,
            features,
            &limits,
            &hints,
            desc.queue_family_index,
            desc.queue_index,
        )
    }
    .map_err(device_error)?;
    // SAFETY: each hal object was made from the one before.
    let (instance, adapter, device, queue) = unsafe {
        let instance = wgpu::Instance::from_hal::<Vulkan>(hal_instance);
        let adapter = instance.create_adapter_from_hal(exposed);
        let wants = wgpu::DeviceDescriptor {
            label: Some("welkin on the host's Vulkan device"),
            required_features: features,
            required_limits: limits,
            memory_hints: hints,
            ..wgpu::DeviceDescriptor::default()
        };
        let (device, queue) = adapter
            .create_device_from_hal(opened, &wants)
            .map_err(|e| Error::unsupported(format!("wgpu cannot use the host's Vulkan device: {e}")))?;
        (instance, adapter, device, queue)
    };
    let device = Device::adopt(instance, adapter, device, queue, false, None)?;
    let record = Arc::clone(record);
    Ok(VulkanHost { device, record, raw, released, images: Mutex::default(), brackets: Mutex::default() })
}

fn device_error(e: wgpu::hal::DeviceError) -> Error {
    let status = match e {
        wgpu::hal::DeviceError::OutOfMemory => Status::OutOfMemory,
        wgpu::hal::DeviceError::Lost => Status::DeviceLost,
        wgpu::hal::DeviceError::Unexpected => Status::Internal,
    };
    Error::new(status, format!("the host's Vulkan device refused: {e}"))
}
