//! Description of a host's Vulkan device: its handles, and the extensions and features that the host enabled.

use std::ffi::{CStr, c_void};

use ash::vk;

use super::facts::EnabledFeatures;

/// Description of a host's Vulkan device. All handles remain the host's and must outlive the
/// [`VulkanHost`](super::VulkanHost).
#[derive(Clone, Copy, Debug)]
pub struct VulkanHostDesc<'a> {
    /// Host's `vkGetInstanceProcAddr` (from its loader, GLFW, SDL, volk, ...).
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
    /// Family of the queue to submit to; it must support graphics and compute.
    pub queue_family_index: u32,
    /// Index of the queue in that family; the queue must have been created without flags.
    pub queue_index: u32,
    /// Callback that takes the host's queue lock; given together with `unlock_queue` or not at all.
    pub lock_queue: Option<unsafe extern "C" fn(user: *mut c_void)>,
    /// Callback that releases the host's queue lock.
    pub unlock_queue: Option<unsafe extern "C" fn(user: *mut c_void)>,
    /// Argument of both callbacks.
    pub user: *mut c_void,
    /// wgpu features to enable; those that the host's device does not allow are left out.
    pub wanted_features: wgpu::Features,
}
