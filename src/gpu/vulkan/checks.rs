//! Checks of everything that would abort or panic inside the Vulkan backend: each returns an error that names the
//! fault.

use std::ffi::{CStr, c_void};

use ash::vk;

use super::desc::VulkanHostDesc;
use super::dispatch::{self, RealFunctions};
use super::facts::EnabledFeatures;
use crate::error::{Error, Result, Status};

/// Loader function and instance version of a host's description, after the checks that need no driver call.
pub(super) struct Handles {
    pub get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    pub instance_api_version: u32,
}

fn version_text(v: u32) -> String {
    format!("{}.{}", vk::api_version_major(v), vk::api_version_minor(v))
}

/// Joins up to four names for a sentence, and says how many more there are.
fn first_of(names: &[String]) -> String {
    let (shown, rest) = names.split_at(names.len().min(4));
    let more = if rest.is_empty() { String::new() } else { format!(" and {} more", rest.len()) };
    format!("{}{more}", shown.join(", "))
}

/// Checks for null pointers, callbacks without their counterpart, and impossible versions.
pub(super) fn handles(desc: &VulkanHostDesc<'_>) -> Result<Handles> {
    let get = desc.get_instance_proc_addr;
    let get = get.ok_or_else(|| Error::range("get_instance_proc_addr", "vkGetInstanceProcAddr", "NULL"))?;
    for (name, null) in [
        ("instance", desc.instance == vk::Instance::null()),
        ("physical_device", desc.physical_device == vk::PhysicalDevice::null()),
        ("device", desc.device == vk::Device::null()),
    ] {
        if null {
            return Err(Error::range(name, "a live Vulkan handle", "VK_NULL_HANDLE"));
        }
    }
    if desc.lock_queue.is_some() != desc.unlock_queue.is_some() {
        return Err(Error::invalid("lock_queue", "must be given together with unlock_queue or not at all"));
    }
    // VkApplicationInfo::apiVersion 0 means 1.0 (Vulkan specification, VkApplicationInfo).
    let v = if desc.instance_api_version == 0 { vk::API_VERSION_1_0 } else { desc.instance_api_version };
    if vk::api_version_variant(v) != 0 || vk::api_version_major(v) != 1 {
        let accepted = "VkApplicationInfo::apiVersion, variant 0 and major version 1 (or 0 for 1.0)";
        return Err(Error::range("instance_api_version", accepted, format_args!("{v:#x}")));
    }
    Ok(Handles { get_instance_proc_addr: get, instance_api_version: v })
}

/// Host's instance as wgpu sees it, with some queries redirected, and the real functions of the host's instance.
pub(super) struct LoadedInstance {
    pub instance: ash::Instance,
    pub entry: ash::Entry,
    plain: ash::Instance,
    get_features2: Option<vk::PFN_vkGetPhysicalDeviceFeatures2>,
}

/// Loads the instance's functions. A Vulkan 1.0 function that the host's loader does not find is an error, because a
/// call of it would abort the process.
///
/// # Safety
/// `handles` and `desc.instance` must be the host's, as [`VulkanHostDesc`] demands.
pub(super) unsafe fn load_instance(desc: &VulkanHostDesc<'_>, handles: &Handles) -> Result<LoadedInstance> {
    let get = handles.get_instance_proc_addr;
    let address = |name: &CStr| {
        // SAFETY: the caller vouches for the loader function and the instance.
        let f = unsafe { dispatch::lookup(get, desc.instance, name) };
        f.map_or(std::ptr::null(), |f| f as *const c_void)
    };
    let mut missing = Vec::new();
    let v1_0 = ash::InstanceFnV1_0::load(|name| {
        let found = address(name);
        if found.is_null() {
            missing.push(name.to_string_lossy().into_owned());
        }
        found
    });
    if !missing.is_empty() {
        let names = first_of(&missing);
        let rest = format!("must serve Vulkan 1.0, but it answers NULL for {names}");
        return Err(Error::invalid("get_instance_proc_addr", rest));
    }
    let redirected = |name: &CStr| match dispatch::instance_substitute(name) {
        Some(s) if !address(name).is_null() => s,
        _ => address(name),
    };
    // SAFETY: every pointer comes from the host's loader or is a substitute of the same signature.
    let instance = unsafe { ash::Instance::load_with(redirected, desc.instance) };
    let plain = ash::Instance::from_parts_1_3(
        desc.instance,
        v1_0,
        ash::InstanceFnV1_1::load(address),
        ash::InstanceFnV1_3::load(address),
    );
    let features2 = address(c"vkGetPhysicalDeviceFeatures2KHR");
    // SAFETY: a non-null result for this name has this signature.
    let get_features2 =
        unsafe { std::mem::transmute::<*const c_void, Option<vk::PFN_vkGetPhysicalDeviceFeatures2>>(features2) };
    let global = |name: &CStr| {
        // SAFETY: the loader function accepts global names with a null instance.
        let f = unsafe { get(vk::Instance::null(), name.as_ptr()) };
        f.map_or(std::ptr::null(), |f| f as *const c_void)
    };
    let entry = ash::Entry::from_parts_1_1(
        ash::StaticFn { get_instance_proc_addr: dispatch::get_instance_proc_addr },
        ash::EntryFnV1_0::load(global),
        ash::EntryFnV1_1::load(global),
    );
    Ok(LoadedInstance { instance, entry, plain, get_features2 })
}

/// Checks that the physical device belongs to the instance. Returns the version in force: the lower one of the
/// instance's and the physical device's.
///
/// # Safety
/// The requirements of [`load_instance`].
pub(super) unsafe fn api_version(desc: &VulkanHostDesc<'_>, handles: &Handles, loaded: &LoadedInstance) -> Result<u32> {
    // SAFETY: the instance is live.
    let devices = unsafe { loaded.plain.enumerate_physical_devices() };
    let devices = devices.map_err(|e| {
        Error::new(Status::NoAdapter, format!("vkEnumeratePhysicalDevices on the host's instance failed: {e}"))
    })?;
    if !devices.contains(&desc.physical_device) {
        return Err(Error::invalid("physical_device", "must be one that vkEnumeratePhysicalDevices(instance) lists"));
    }
    // SAFETY: the physical device was just found in the instance's list.
    let properties = unsafe { loaded.plain.get_physical_device_properties(desc.physical_device) };
    Ok(properties.api_version.min(handles.instance_api_version))
}

/// Checks that the queue exists and supports graphics and compute.
///
/// # Safety
/// The requirements of [`load_instance`]; the physical device must have been checked.
pub(super) unsafe fn queue_family(desc: &VulkanHostDesc<'_>, loaded: &LoadedInstance) -> Result<()> {
    // SAFETY: the physical device was checked.
    let families = unsafe { loaded.plain.get_physical_device_queue_family_properties(desc.physical_device) };
    let Some(family) = families.get(desc.queue_family_index as usize) else {
        let accepted = format!("below the device's {} queue families", families.len());
        return Err(Error::range("queue_family_index", &accepted, desc.queue_family_index));
    };
    if desc.queue_index >= family.queue_count {
        let accepted = format!("below the {} queues of family {}", family.queue_count, desc.queue_family_index);
        return Err(Error::range("queue_index", &accepted, desc.queue_index));
    }
    let needed = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    if !family.queue_flags.contains(needed) {
        let accepted = "a family with VK_QUEUE_GRAPHICS_BIT and VK_QUEUE_COMPUTE_BIT";
        let got = format!("family {} with {:?}", desc.queue_family_index, family.queue_flags);
        return Err(Error::range("queue_family_index", accepted, got));
    }
    Ok(())
}

/// Checks for everything that the backend needs beyond Vulkan 1.0, and for features that the host claims but cannot
/// have. Reports all faults at once.
pub(super) fn extensions(
    claimed_version: u32,
    api_version: u32,
    enabled: &[&'static CStr],
    features: &EnabledFeatures,
) -> Result<()> {
    let has = |name| enabled.contains(&name);
    let mut lacks = Vec::new();
    let needed = [ash::khr::maintenance1::NAME, ash::khr::storage_buffer_storage_class::NAME];
    let missing: Vec<_> = needed.into_iter().filter(|name| !has(name)).map(CStr::to_string_lossy).collect();
    if api_version < vk::API_VERSION_1_1 && !missing.is_empty() {
        let (field, version) = match claimed_version {
            0 => (
                "instance_api_version",
                "0 means Vulkan 1.0: say there what the instance's VkApplicationInfo::apiVersion is, raise both to 1.1 or \
                 later"
                    .to_owned(),
            ),
            v if v < vk::API_VERSION_1_1 => (
                "instance_api_version",
                format!("is {}: raise it and the instance's VkApplicationInfo::apiVersion to 1.1", version_text(v)),
            ),
            _ => ("physical_device", "serves Vulkan 1.0 only: take another".to_owned()),
        };
        let missing = missing.join(" and ");
        let rest = format!("{version}, or enable {missing} on the device and list them in enabled_device_extensions");
        lacks.push(Error::invalid(field, rest));
    }
    if features.timeline_semaphore && api_version < vk::API_VERSION_1_2 && !has(ash::khr::timeline_semaphore::NAME) {
        let rest = format!(
            "lists timelineSemaphore, which Vulkan {} has by VK_KHR_timeline_semaphore only: enable and list that in \
             enabled_device_extensions, raise both versions to 1.2, or leave the feature out",
            version_text(api_version),
        );
        lacks.push(Error::invalid("enabled_features", rest));
    }
    Error::all(lacks)
}

/// Loads the device's functions, with two queue calls and the creation of descriptor set layouts redirected. Also
/// returns the real functions that the substitutes call. A missing function of Vulkan 1.0, or of enabled timeline
/// semaphores, is an error.
///
/// # Safety
/// The requirements of [`load_instance`]; `desc.device` must be live and made from `desc.physical_device`.
pub(super) unsafe fn load_device(
    desc: &VulkanHostDesc<'_>,
    handles: &Handles,
    loaded: &LoadedInstance,
    api_version: u32,
    extensions: &[&'static CStr],
) -> Result<(ash::Device, RealFunctions)> {
    let get_device = loaded.plain.fp_v1_0().get_device_proc_addr;
    let address = |name: &CStr| {
        // SAFETY: the caller vouches for the device.
        let f = unsafe { get_device(desc.device, name.as_ptr()) };
        f.map_or(std::ptr::null(), |f| f as *const c_void)
    };
    let mut missing = Vec::new();
    let v1_0 = ash::DeviceFnV1_0::load(|name| {
        let found = address(name);
        if found.is_null() {
            missing.push(name.to_string_lossy().into_owned());
        }
        found
    });
    if desc.enabled_features.timeline_semaphore {
        let khr = extensions.contains(&ash::khr::timeline_semaphore::NAME);
        let names = if khr {
            [c"vkGetSemaphoreCounterValueKHR", c"vkWaitSemaphoresKHR"]
        } else {
            [c"vkGetSemaphoreCounterValue", c"vkWaitSemaphores"]
        };
        missing.extend(names.iter().filter(|n| address(n).is_null()).map(|n| n.to_string_lossy().into_owned()));
    }
    if !missing.is_empty() {
        let rest = format!(
            "must serve Vulkan {} as instance_api_version and enabled_device_extensions say, but vkGetDeviceProcAddr \
             answers NULL for {}",
            version_text(api_version),
            first_of(&missing),
        );
        return Err(Error::invalid("device", rest));
    }
    let redirected = |name: &CStr| dispatch::device_substitute(name).unwrap_or_else(|| address(name));
    // SAFETY: every pointer comes from the host's loader or is a substitute of the same signature.
    let device = unsafe { ash::Device::load_with(redirected, desc.device) };
    let instance_fns = loaded.plain.fp_v1_0();
    let real = RealFunctions {
        get_instance_proc_addr: handles.get_instance_proc_addr,
        enumerate_device_extensions: instance_fns.enumerate_device_extension_properties,
        get_properties: instance_fns.get_physical_device_properties,
        get_features: instance_fns.get_physical_device_features,
        get_features2: loaded.get_features2,
        get_queue_families: instance_fns.get_physical_device_queue_family_properties,
        queue_submit: v1_0.queue_submit,
        queue_wait_idle: v1_0.queue_wait_idle,
        create_descriptor_set_layout: v1_0.create_descriptor_set_layout,
    };
    Ok((device, real))
}
