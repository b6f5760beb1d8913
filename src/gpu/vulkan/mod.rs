//! Hosts that own a Vulkan device: Welkin draws on the host's own `VkDevice` and `VkQueue`, into its images.
//!
//! # The queue contract
//! Welkin submits on the host's queue itself: when a record call returns, its work *is submitted*. Vulkan wants
//! a queue used by one thread at a time, so either the host stays away from the queue while any Welkin call
//! with this device runs (record, create, destroy), or it passes [`VulkanHostDesc::lock_queue`] and
//! `unlock_queue`, which Welkin calls round every `vkQueueSubmit` and `vkQueueWaitIdle` and nothing else.
//! Inside the callbacks no Welkin function may be called.
//!
//! # Images and order
//! An image, or one layer of an array, is handed over for one submission ([`VulkanHost::submit`]) in the layout that
//! the host left it in and comes back in the layout that it asks for. Work that the host submitted to the *same queue*
//! before is waited for without a semaphore, and so is Welkin's by what the host submits to that queue afterwards: no
//! barrier of the host's own is needed. Semaphores order work with other queues.
//!
//! # What the host must have enabled
//! Nothing beyond Vulkan 1.1 and a queue that draws and computes, except `VK_KHR_swapchain` for images in
//! `PRESENT_SRC_KHR` and `sampleRateShading` for colour of several samples. Timeline semaphores, robust access, 16-bit
//! storage and the like are used where the host says that it enabled them ([`EnabledFeatures`]), and otherwise not:
//! wgpu is shown only what is enabled. On Vulkan 1.0 the device needs `VK_KHR_maintenance1` and
//! `VK_KHR_storage_buffer_storage_class`.

mod bracket;
mod checks;
mod dispatch;
mod facts;
mod frame;
mod image;
mod layouts;

use std::ffi::{CStr, c_void};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use ash::vk;
use wgpu::hal::vulkan::Api as Vulkan;

pub use dispatch::QueueLock;
pub use facts::EnabledFeatures;
pub use frame::{HandOver, HostSemaphore};
pub use image::{HostImage, ImageRole};

use super::Device;
use crate::error::{Error, Result, Status};
use dispatch::HostRecord;

/// Description of a host's Vulkan device. All handles stay the host's and must outlive the [`VulkanHost`].
#[derive(Clone, Copy, Debug)]
pub struct VulkanHostDesc<'a> {
    /// The host's `vkGetInstanceProcAddr` (from its loader, GLFW, SDL, volk, ...).
    pub get_instance_proc_addr: Option<vk::PFN_vkGetInstanceProcAddr>,
    /// Instance that `physical_device` came from.
    pub instance: vk::Instance,
    /// `VkApplicationInfo::apiVersion` that the instance was created with; 0 means 1.0, as in Vulkan.
    pub instance_api_version: u32,
    /// Instance extensions that the host enabled.
    pub enabled_instance_extensions: &'a [&'a CStr],
    /// Physical device behind `device`.
    pub physical_device: vk::PhysicalDevice,
    /// Device to draw on.
    pub device: vk::Device,
    /// Device extensions that the host enabled.
    pub enabled_device_extensions: &'a [&'a CStr],
    /// Device features that the host enabled; see [`EnabledFeatures::from_chain`].
    pub enabled_features: EnabledFeatures,
    /// Family of the queue to submit on; it must draw and compute.
    pub queue_family_index: u32,
    /// Index of the queue in that family, as created without flags.
    pub queue_index: u32,
    /// Takes the host's queue lock; given together with `unlock_queue` or not at all.
    pub lock_queue: Option<unsafe extern "C" fn(user: *mut c_void)>,
    /// Releases the host's queue lock.
    pub unlock_queue: Option<unsafe extern "C" fn(user: *mut c_void)>,
    /// Handed to both callbacks.
    pub user: *mut c_void,
    /// wgpu features to enable where the host's device allows them; the rest is dropped.
    pub wanted_features: wgpu::Features,
}

/// Welkin's device over a host's Vulkan device, with what the host handed over. Dropping it destroys nothing of
/// the host's.
pub struct VulkanHost {
    /// The device for contexts and views; it shows only what the host enabled.
    pub device: Arc<Device>,
    record: Arc<HostRecord>,
    raw: ash::Device,
    released: Arc<AtomicBool>,
    images: Mutex<image::Imports>,
    /// Held through a submission: semaphores and barriers belong to the next one, so staging them and submitting
    /// is one step.
    brackets: Mutex<bracket::Brackets>,
}

impl std::fmt::Debug for VulkanHost {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("VulkanHost").field("queue", &self.record.queue).finish_non_exhaustive()
    }
}

impl VulkanHost {
    /// Returns the features that the host enabled on its device.
    pub fn enabled_features(&self) -> &EnabledFeatures {
        &self.record.enabled
    }

    /// Waits for the GPU (and so for every semaphore that was to be waited for), gives everything back and says whether
    /// the host may now destroy its device.
    ///
    /// # Errors
    /// [`Status::InUse`] if contexts, views or textures made from this device are still alive: they keep it open,
    /// and it closes when the last of them goes. [`Status::DeviceLost`] if the device was lost meanwhile.
    pub fn close(self) -> Result<()> {
        let waited = self.device.wait();
        let released = Arc::clone(&self.released);
        drop(self);
        if !released.load(Ordering::Acquire) {
            let message = "the Vulkan device is still used by contexts, views or textures made from it: destroy them";
            return Err(Error::new(Status::InUse, message));
        }
        waited
    }
}

impl Drop for VulkanHost {
    fn drop(&mut self) {
        // A device that is lost has nothing pending either.
        let _ = self.device.wait();
        let brackets = self.brackets.get_mut().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the queue's work was waited for, and the host's device lives longer than this.
        unsafe { brackets.destroy(&self.raw) };
    }
}

/// Wraps a host's Vulkan device for drawing.
///
/// # Errors
/// [`Status::InvalidArgument`] names a null handle, a physical device or queue that does not belong, or facts
/// that contradict each other; [`Status::Unsupported`] names what the host's Vulkan lacks;
/// [`Status::AlreadyWrapped`] says that the queue has a Welkin device already; [`Status::OutOfMemory`] and
/// [`Status::DeviceLost`] come from the driver.
///
/// # Safety
/// Every handle in `desc` is live, belongs together as Vulkan requires and outlives the result and all wgpu
/// objects made from it; the extensions and features listed are enabled on `device`; the queue is used by the
/// contract in the [module's words](self); callbacks and `user` may be used from every thread that calls Welkin.
pub unsafe fn adopt(desc: &VulkanHostDesc<'_>) -> Result<VulkanHost> {
    let handles = checks::handles(desc)?;
    let extensions = facts::known_extensions(desc.enabled_device_extensions);
    // SAFETY: the caller vouches for the handles; each step checks what the next relies on.
    let (loaded, api_version, device, real) = unsafe {
        let loaded = checks::load_instance(desc, &handles)?;
        let api_version = checks::api_version(desc, &handles, &loaded)?;
        checks::queue_family(desc, &loaded)?;
        checks::extensions(desc.instance_api_version, api_version, &extensions, &desc.enabled_features)?;
        let (device, real) = checks::load_device(desc, &handles, &loaded, api_version, &extensions)?;
        (loaded, api_version, device, real)
    };
    // SAFETY: family and index were checked against the physical device.
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

/// Leads the checked handles through wgpu's doors for foreign devices.
fn open(
    desc: &VulkanHostDesc<'_>,
    loaded: checks::LoadedInstance,
    device: ash::Device,
    record: &Arc<HostRecord>,
) -> Result<VulkanHost> {
    // Property queries by chain are core from 1.1; the loader function answers for the extension's names too.
    let chained = ash::khr::get_physical_device_properties2::NAME;
    let has_chained = record.api_version >= vk::API_VERSION_1_1 || desc.enabled_instance_extensions.contains(&chained);
    let released = Arc::new(AtomicBool::new(false));
    let (queue, on_release) = (record.queue, Arc::clone(&released));
    let drop_instance = Box::new(move || {
        dispatch::unregister(queue);
        on_release.store(true, Ordering::Release);
    });
    // The host has chosen its adapter: wgpu's own taste in conformant drivers must not hide it.
    let flags = wgpu::InstanceFlags::ALLOW_UNDERLYING_NONCOMPLIANT_ADAPTER;
    // SAFETY: entry and instance are the host's; the extension list is what may be called; the callback keeps
    // wgpu from destroying the host's instance.
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
    // Small blocks: the device's memory is mostly the host's.
    let hints = wgpu::MemoryHints::MemoryUsage;
    let raw = device.clone();
    // SAFETY: the device was made from this physical device with these extensions; capability queries were
    // narrowed to what is enabled; the callback keeps wgpu from destroying the host's device.
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
