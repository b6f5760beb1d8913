//! Substitutes for a few Vulkan functions between wgpu and a host's device. Capability queries are answered by what the
//! host enabled. Queue calls are made under the host's queue lock. The creation of descriptor set layouts leaves out a
//! structure that Vulkan before 1.2 does not know.
//!
//! Vulkan entry points have no user pointer, so a substitute finds its host's record by the handle in its first
//! argument. Every other function goes straight to the driver.

use std::cell::{Cell, RefCell};
use std::ffi::{CStr, c_char, c_void};
use std::sync::{Arc, PoisonError, RwLock};

use ash::vk;

use super::facts::{EnabledFeatures, visible_extension};

/// Host's lock for its queue. Both callbacks run on the thread that calls Welkin, never nested.
#[derive(Clone, Copy, Debug)]
pub struct QueueLock {
    /// Callback that Welkin calls just before it uses the queue.
    pub lock: unsafe extern "C" fn(user: *mut c_void),
    /// Callback that Welkin calls just after it has used the queue.
    pub unlock: unsafe extern "C" fn(user: *mut c_void),
    /// Argument of both callbacks.
    pub user: *mut c_void,
}

// SAFETY: the host promises (VulkanHostDesc) that the callbacks and `user` may be used from any thread that
// calls Welkin.
unsafe impl Send for QueueLock {}
// SAFETY: as above; the struct itself is never changed.
unsafe impl Sync for QueueLock {}

/// Real entry points that the substitutes below call.
pub(super) struct RealFunctions {
    pub get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    pub enumerate_device_extensions: vk::PFN_vkEnumerateDeviceExtensionProperties,
    pub get_properties: vk::PFN_vkGetPhysicalDeviceProperties,
    pub get_features: vk::PFN_vkGetPhysicalDeviceFeatures,
    pub get_features2: Option<vk::PFN_vkGetPhysicalDeviceFeatures2>,
    pub get_queue_families: vk::PFN_vkGetPhysicalDeviceQueueFamilyProperties,
    pub queue_submit: vk::PFN_vkQueueSubmit,
    pub queue_wait_idle: vk::PFN_vkQueueWaitIdle,
    pub create_descriptor_set_layout: vk::PFN_vkCreateDescriptorSetLayout,
}

/// Properties of one adopted device. Never changed after creation.
pub(super) struct HostRecord {
    pub instance: vk::Instance,
    pub physical_device: vk::PhysicalDevice,
    pub device: vk::Device,
    pub queue: vk::Queue,
    pub queue_family_index: u32,
    /// Lower of the instance's and the physical device's versions. It says which functions may be called.
    pub api_version: u32,
    pub extensions: Vec<&'static CStr>,
    pub enabled: EnabledFeatures,
    pub lock: Option<QueueLock>,
    pub real: RealFunctions,
}

static HOSTS: RwLock<Vec<Arc<HostRecord>>> = RwLock::new(Vec::new());

thread_local! {
    /// Record of the host that this thread is adopting. Two devices may share one physical device with different
    /// features, so this decides which record answers wgpu's capability queries.
    static ADOPTING: RefCell<Option<Arc<HostRecord>>> = const { RefCell::new(None) };
}

/// Adds the record to the list of adopted hosts, unless its queue is already there; returns whether it was added.
pub(super) fn register(record: &Arc<HostRecord>) -> bool {
    let mut hosts = HOSTS.write().unwrap_or_else(PoisonError::into_inner);
    if hosts.iter().any(|h| h.queue == record.queue) {
        return false;
    }
    hosts.push(Arc::clone(record));
    true
}

/// Removes the record of `queue`; nothing may use that queue through Welkin afterwards.
pub(super) fn unregister(queue: vk::Queue) {
    HOSTS.write().unwrap_or_else(PoisonError::into_inner).retain(|h| h.queue != queue);
}

/// Runs `f` while `record` answers the capability queries of this thread.
pub(super) fn while_adopting<R>(record: &Arc<HostRecord>, f: impl FnOnce() -> R) -> R {
    /// Guard that ends the adoption, after a panic too.
    struct Reset;
    impl Drop for Reset {
        fn drop(&mut self) {
            ADOPTING.with_borrow_mut(|a| *a = None);
        }
    }
    ADOPTING.with_borrow_mut(|a| *a = Some(Arc::clone(record)));
    let _reset = Reset;
    f()
}

thread_local! {
    /// Command buffers to run before and after the commands of this thread's next submission to a queue.
    static BRACKET: Cell<Option<(vk::Queue, [vk::CommandBuffer; 2])>> = const { Cell::new(None) };
}

/// Runs `f`, which submits once to `queue`, with `bracket` around the commands. Returns whether `f` did submit.
pub(super) fn with_bracket<R>(queue: vk::Queue, bracket: [vk::CommandBuffer; 2], f: impl FnOnce() -> R) -> bool {
    BRACKET.set(Some((queue, bracket)));
    f();
    BRACKET.take().is_none()
}

/// Returns the host that `matches`: the one that this thread is adopting, or else an adopted one.
fn find(matches: impl Fn(&HostRecord) -> bool) -> Option<Arc<HostRecord>> {
    let adopting = ADOPTING.with_borrow(|a| a.as_ref().filter(|h| matches(h)).map(Arc::clone));
    adopting.or_else(|| {
        let hosts = HOSTS.read().unwrap_or_else(PoisonError::into_inner);
        hosts.iter().find(|h| matches(h)).map(Arc::clone)
    })
}

/// Returns the substitute for `name` in the instance's table, if there is one.
pub(super) fn instance_substitute(name: &CStr) -> Option<*const c_void> {
    Some(match name.to_bytes() {
        b"vkEnumerateDeviceExtensionProperties" => enumerate_device_extensions as *const c_void,
        b"vkGetPhysicalDeviceProperties" => get_properties as *const c_void,
        b"vkGetPhysicalDeviceFeatures" => get_features as *const c_void,
        b"vkGetPhysicalDeviceFeatures2" | b"vkGetPhysicalDeviceFeatures2KHR" => get_features2 as *const c_void,
        b"vkGetPhysicalDeviceQueueFamilyProperties" => get_queue_families as *const c_void,
        _ => return None,
    })
}

/// Returns the substitute for `name` in the device's table, if there is one.
pub(super) fn device_substitute(name: &CStr) -> Option<*const c_void> {
    Some(match name.to_bytes() {
        b"vkQueueSubmit" => queue_submit as *const c_void,
        b"vkQueueWaitIdle" => queue_wait_idle as *const c_void,
        b"vkCreateDescriptorSetLayout" => create_descriptor_set_layout as *const c_void,
        _ => return None,
    })
}

/// Looks up an instance function by `name`. A name that ends in `KHR` and is not found is looked up without this
/// suffix, as the core function that replaced the extension's (a host on Vulkan 1.1 need not enable
/// `VK_KHR_get_physical_device_properties2`).
///
/// # Safety
/// `get` must be the host's `vkGetInstanceProcAddr`, and `instance` a live instance.
pub(super) unsafe fn lookup(
    get: vk::PFN_vkGetInstanceProcAddr,
    instance: vk::Instance,
    name: &CStr,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: the caller vouches for both, and `name` ends with a zero.
    let found = unsafe { get(instance, name.as_ptr()) };
    if found.is_some() {
        return found;
    }
    let core = name.to_bytes().strip_suffix(b"KHR")?;
    let mut buffer = [0_u8; 96];
    buffer.get_mut(..core.len())?.copy_from_slice(core);
    let core = CStr::from_bytes_until_nul(&buffer).ok()?;
    // SAFETY: as above.
    unsafe { get(instance, core.as_ptr()) }
}

/// `vkGetInstanceProcAddr` for wgpu.
pub(super) unsafe extern "system" fn get_instance_proc_addr(
    instance: vk::Instance,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    let host = find(|h| h.instance == instance)?;
    // SAFETY: Vulkan requires `name` to be a valid string.
    let name = unsafe { CStr::from_ptr(name) };
    // SAFETY: the record's function and instance are the host's, live while it is registered.
    let real = unsafe { lookup(host.real.get_instance_proc_addr, instance, name) }?;
    // SAFETY: each substitute has the signature of the function that it is named for, and a function pointer may be
    // passed as an untyped pointer.
    Some(
        instance_substitute(name).map_or(real, |s| unsafe { std::mem::transmute::<_, unsafe extern "system" fn()>(s) }),
    )
}

unsafe extern "system" fn enumerate_device_extensions(
    physical_device: vk::PhysicalDevice,
    layer: *const c_char,
    count: *mut u32,
    properties: *mut vk::ExtensionProperties,
) -> vk::Result {
    let Some(host) = find(|h| h.physical_device == physical_device) else {
        return vk::Result::ERROR_INITIALIZATION_FAILED;
    };
    let real = host.real.enumerate_device_extensions;
    let mut all: Vec<vk::ExtensionProperties> = Vec::new();
    let mut n = 0;
    // SAFETY: the two calls follow the Vulkan protocol: first the count, then that number of elements.
    unsafe {
        let status = real(physical_device, layer, &raw mut n, std::ptr::null_mut());
        if status != vk::Result::SUCCESS {
            return status;
        }
        all.resize(n as usize, vk::ExtensionProperties::default());
        let status = real(physical_device, layer, &raw mut n, all.as_mut_ptr());
        if status.as_raw() < 0 {
            return status;
        }
    }
    all.truncate(n as usize);
    all.retain(|e| {
        e.extension_name_as_c_str().is_ok_and(|name| visible_extension(name, &host.extensions, host.api_version))
    });
    // SAFETY: `count` is valid, and `properties`, when not null, has room for `*count` elements, as Vulkan requires.
    unsafe {
        let visible = u32::try_from(all.len()).unwrap_or(u32::MAX);
        if properties.is_null() {
            *count = visible;
            return vk::Result::SUCCESS;
        }
        let written = visible.min(*count);
        std::ptr::copy_nonoverlapping(all.as_ptr(), properties, written as usize);
        *count = written;
        if written < visible { vk::Result::INCOMPLETE } else { vk::Result::SUCCESS }
    }
}

unsafe extern "system" fn get_properties(
    physical_device: vk::PhysicalDevice,
    properties: *mut vk::PhysicalDeviceProperties,
) {
    let Some(host) = find(|h| h.physical_device == physical_device) else { return };
    // SAFETY: the arguments are passed on unchanged; `properties` is then filled and valid.
    unsafe {
        (host.real.get_properties)(physical_device, properties);
        (*properties).api_version = (*properties).api_version.min(host.api_version);
    }
}

unsafe extern "system" fn get_features(physical_device: vk::PhysicalDevice, features: *mut vk::PhysicalDeviceFeatures) {
    let Some(host) = find(|h| h.physical_device == physical_device) else { return };
    // SAFETY: the arguments are passed on unchanged; `features` is then filled and valid.
    unsafe {
        (host.real.get_features)(physical_device, features);
        host.enabled.narrow_core(&mut *features);
    }
}

unsafe extern "system" fn get_features2(
    physical_device: vk::PhysicalDevice,
    features: *mut vk::PhysicalDeviceFeatures2<'_>,
) {
    let Some(host) = find(|h| h.physical_device == physical_device) else { return };
    let Some(real) = host.real.get_features2 else { return };
    // SAFETY: the arguments are passed on unchanged; the chain is then filled and valid.
    unsafe {
        real(physical_device, features);
        host.enabled.narrow_chain(features);
    }
}

/// Returns the host's own queue family only, because wgpu judges a device by its first family.
unsafe extern "system" fn get_queue_families(
    physical_device: vk::PhysicalDevice,
    count: *mut u32,
    families: *mut vk::QueueFamilyProperties,
) {
    let Some(host) = find(|h| h.physical_device == physical_device) else { return };
    // SAFETY: the driver is called by the Vulkan protocol; `count` is valid and `families`, when not null, has room for
    // `*count` elements.
    unsafe {
        if families.is_null() {
            *count = 1;
            return;
        }
        let mut n = host.queue_family_index + 1;
        let mut all = vec![vk::QueueFamilyProperties::default(); n as usize];
        (host.real.get_queue_families)(physical_device, &raw mut n, all.as_mut_ptr());
        if *count > 0 {
            *families = all[host.queue_family_index as usize];
            *count = 1;
        }
    }
}

/// Guard of the host's queue lock.
struct QueueGuard<'a>(Option<&'a QueueLock>);

impl<'a> QueueGuard<'a> {
    fn new(host: &'a HostRecord) -> Self {
        let lock = host.lock.as_ref();
        if let Some(l) = lock {
            // SAFETY: the host promised a function that may be called with `user` on this thread.
            unsafe { (l.lock)(l.user) };
        }
        Self(lock)
    }
}

impl Drop for QueueGuard<'_> {
    fn drop(&mut self) {
        if let Some(l) = self.0 {
            // SAFETY: as in `new`.
            unsafe { (l.unlock)(l.user) };
        }
    }
}

unsafe extern "system" fn queue_submit(
    queue: vk::Queue,
    count: u32,
    submits: *const vk::SubmitInfo<'_>,
    fence: vk::Fence,
) -> vk::Result {
    let Some(host) = find(|h| h.queue == queue) else { return vk::Result::ERROR_DEVICE_LOST };
    let _held = QueueGuard::new(&host);
    let real = host.real.queue_submit;
    let bracket = BRACKET.get().filter(|b| b.0 == queue && count == 1);
    if bracket.is_some() {
        BRACKET.set(None);
    }
    // SAFETY: `submits` has `count` valid elements. The bracketed one is copied with the same command buffers, between
    // two more. The queue lock is held.
    unsafe {
        let Some((_, [before, after])) = bracket else { return real(queue, count, submits, fence) };
        let theirs = std::slice::from_raw_parts((*submits).p_command_buffers, (*submits).command_buffer_count as usize);
        let mut few = [vk::CommandBuffer::null(); 16];
        let many: Vec<vk::CommandBuffer>;
        let all = if theirs.len() + 2 <= few.len() {
            few[0] = before;
            few[1..=theirs.len()].copy_from_slice(theirs);
            few[theirs.len() + 1] = after;
            &few[..theirs.len() + 2]
        } else {
            many = std::iter::once(before).chain(theirs.iter().copied()).chain([after]).collect();
            &many[..]
        };
        let whole =
            vk::SubmitInfo { p_command_buffers: all.as_ptr(), command_buffer_count: all.len() as u32, ..*submits };
        real(queue, 1, &raw const whole, fence)
    }
}

unsafe extern "system" fn queue_wait_idle(queue: vk::Queue) -> vk::Result {
    let Some(host) = find(|h| h.queue == queue) else { return vk::Result::ERROR_DEVICE_LOST };
    let _held = QueueGuard::new(&host);
    // SAFETY: the argument is passed on unchanged, and the queue lock is held.
    unsafe { (host.real.queue_wait_idle)(queue) }
}

/// Creates a descriptor set layout; below Vulkan 1.2 without the structure of binding flags. wgpu chains that structure
/// (Vulkan 1.2, `VK_EXT_descriptor_indexing`) to every layout; it is empty without binding arrays, which Welkin never
/// uses. Below Vulkan 1.2 this structure must not be passed.
unsafe extern "system" fn create_descriptor_set_layout(
    device: vk::Device,
    info: *const vk::DescriptorSetLayoutCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    layout: *mut vk::DescriptorSetLayout,
) -> vk::Result {
    let Some(host) = find(|h| h.device == device) else { return vk::Result::ERROR_DEVICE_LOST };
    let real = host.real.create_descriptor_set_layout;
    // SAFETY: the arguments are passed on unchanged, except for the optional structure left out; `info` is valid.
    unsafe {
        if host.api_version >= vk::API_VERSION_1_2 {
            return real(device, info, allocator, layout);
        }
        let plain = vk::DescriptorSetLayoutCreateInfo { p_next: std::ptr::null(), ..*info };
        real(device, &raw const plain, allocator, layout)
    }
}
