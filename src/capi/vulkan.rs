//! Vulkan hosts
//!
//! Welkin draws on the host's VkDevice and VkQueue, into the host's VkImages, and submits itself: when wk_view_record
//! returns, its work is on the queue. Vulkan wants a queue used by one thread at a time, so the host stays away from the
//! queue during Welkin's calls on this device, or passes lock_queue and unlock_queue, which Welkin calls round every
//! submission; no Welkin function may be called inside them.
//!
//! An image is taken over in the layout the host left it in and comes back in the one it asks for. What the host
//! submitted to the same queue before is waited for without a semaphore, and so is Welkin's work by what the host
//! submits there afterwards. Semaphores order work with other queues.
//!
//! Handles are passed as Vulkan has them: dispatchable ones as pointers, others as 64-bit numbers.
//!
//! Needed: Vulkan 1.1, or 1.0 with VK_KHR_maintenance1 and VK_KHR_storage_buffer_storage_class; a queue that draws and
//! computes. Besides, enabled on the device and listed here:
//!
//! ```text
//!     images in PRESENT_SRC_KHR                     VK_KHR_swapchain in enabled_device_extensions
//!     colour of several samples                     VkPhysicalDeviceFeatures::sampleRateShading in enabled_features
//!     timeline semaphores                           timelineSemaphore in enabled_features
//!     DEPTH_ATTACHMENT and DEPTH_READ_ONLY layouts  separateDepthStencilLayouts in enabled_features
//!     ATTACHMENT and READ_ONLY layouts              synchronization2 in enabled_features
//! ```
//!
//! Everything else is used if the host says that it enabled it, and else not.
//!
//! Views, contexts and textures go first, then the wk_device, then the VkDevice, then the VkInstance. While anything of
//! a wk_device is alive, wk_device_destroy answers WK_ERROR_IN_USE: the VkDevice must then stay too. Vulkan cannot be
//! asked whether a VkDevice still lives, so destroying it earlier crashes, as with objects of your own.

use std::{
    ffi::{c_char, c_void},
    ptr::{null, null_mut},
};

use super::{
    boundary::guard,
    device::{DeviceObject, wk_device},
    host,
    input::out,
    layout::{self, init_struct, struct_size},
    status::*,
};
use crate::error::Status;

include!(concat!(env!("OUT_DIR"), "/init_vulkan.rs"));

/// The host's vkGetInstanceProcAddr. Cast yours to this type: it answers a function pointer, or NULL.
pub type wk_vulkan_get_proc_fn =
    Option<unsafe extern "system" fn(instance: *mut c_void, name: *const c_char) -> *mut c_void>;

/// Takes or releases the host's lock on its queue.
pub type wk_vulkan_queue_fn = Option<unsafe extern "C" fn(user: *mut c_void)>;

/// The host's Vulkan device. All handles stay the host's and outlive the wk_device.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_vulkan_host_desc {
    /// sizeof(wk_vulkan_host_desc) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_VULKAN_HOST_DESC.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// vkGetInstanceProcAddr. Default NULL; must be given.
    pub get_instance_proc_addr: wk_vulkan_get_proc_fn,
    /// VkInstance. Default NULL; must be given.
    pub instance: *mut c_void,
    /// VkPhysicalDevice. Default NULL; must be given.
    pub physical_device: *mut c_void,
    /// VkDevice. Default NULL; must be given.
    pub device: *mut c_void,
    /// VkApplicationInfo::apiVersion of the instance; 0 (the default) means 1.0, as in Vulkan.
    pub instance_api_version: u32,
    /// Family of the queue; it must draw and compute. Default 0.
    pub queue_family_index: u32,
    /// Which queue of the family. Default 0.
    pub queue_index: u32,
    /// Number of enabled_instance_extensions. Default 0.
    pub instance_extension_count: u32,
    /// Names of the instance extensions that the host enabled. Default NULL.
    pub enabled_instance_extensions: *const *const c_char,
    /// Names of the device extensions that the host enabled; among them VK_KHR_swapchain where it presents. Default NULL.
    pub enabled_device_extensions: *const *const c_char,
    /// Number of enabled_device_extensions. Default 0.
    pub device_extension_count: u32,
    /// Must be 0.
    pub reserved0: u32,
    /// What the host enabled: the VkDeviceCreateInfo it gave to vkCreateDevice, or a chain of VkPhysicalDevice..Features
    /// structs. Read during the call. NULL (the default): no feature is enabled.
    pub enabled_features: *const c_void,
    /// Takes the host's queue lock; with unlock_queue, or both NULL (the default).
    pub lock_queue: wk_vulkan_queue_fn,
    /// Releases it.
    pub unlock_queue: wk_vulkan_queue_fn,
    /// Handed to both. Default NULL.
    pub user: *mut c_void,
}

impl wk_vulkan_host_desc {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_VULKAN_HOST_DESC,
        next: null(),
        get_instance_proc_addr: None,
        instance: null_mut(),
        physical_device: null_mut(),
        device: null_mut(),
        instance_api_version: 0,
        queue_family_index: 0,
        queue_index: 0,
        instance_extension_count: 0,
        enabled_instance_extensions: null(),
        enabled_device_extensions: null(),
        device_extension_count: 0,
        reserved0: 0,
        enabled_features: null(),
        lock_queue: None,
        unlock_queue: None,
        user: null_mut(),
    };
}

/// A host's image, handed over for one wk_view_record. It has one mip level and 1, 2, 4 or 8 samples.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_vulkan_image {
    /// sizeof(wk_vulkan_image) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_VULKAN_IMAGE.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// VkImage. Default 0; must be given.
    pub image: u64,
    /// VkFormat that it was created with. Default 0; must be given.
    pub format: u32,
    /// Pixels. Default 0; must be given.
    pub width: u32,
    /// Pixels. Default 0; must be given.
    pub height: u32,
    /// Samples a pixel. Default 1. Colour of several needs sampleRateShading in enabled_features of the wk_vulkan_host_desc.
    pub samples: u32,
    /// VkImageUsageFlags that it was created with: COLOR_ATTACHMENT and TRANSFER_SRC for colour, SAMPLED for what is read.
    pub usage: u32,
    /// Array layers that it was created with. Default 1. Of an occluder map, 1.
    pub array_layers: u32,
    /// Layer that is handed over, as one eye of a stereo or multiview host; the others stay untouched. Default 0.
    pub layer: u32,
    /// VkImageLayout that the host left it in, of the layer that is handed over. Default 0 (UNDEFINED: its content may be
    /// dropped; colour only).
    pub layout: u32,
    /// VkImageLayout that the host wants it back in. Default 0; must be given. PRESENT_SRC_KHR, here and in `layout`, needs
    /// VK_KHR_swapchain in enabled_device_extensions of the wk_vulkan_host_desc.
    pub final_layout: u32,
    /// Must be 0.
    pub reserved0: u32,
}

impl wk_vulkan_image {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_VULKAN_IMAGE,
        next: null(),
        image: 0,
        format: 0,
        width: 0,
        height: 0,
        samples: 1,
        usage: 0,
        array_layers: 1,
        layer: 0,
        layout: 0,
        final_layout: 0,
        reserved0: 0,
    };
}

/// Kinds of semaphore.
pub type wk_vulkan_semaphore_kind = u32;
/// Binary.
pub const WK_VULKAN_SEMAPHORE_BINARY: wk_vulkan_semaphore_kind = 0;
/// Timeline; needs timelineSemaphore enabled and listed.
pub const WK_VULKAN_SEMAPHORE_TIMELINE: wk_vulkan_semaphore_kind = 1;

/// A host's semaphore.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_vulkan_semaphore {
    /// sizeof(wk_vulkan_semaphore) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_VULKAN_SEMAPHORE.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// VkSemaphore. Default 0; must be given.
    pub semaphore: u64,
    /// Value to wait for or to signal, of a timeline semaphore. Default 0.
    pub value: u64,
    /// Default WK_VULKAN_SEMAPHORE_BINARY.
    pub kind: wk_vulkan_semaphore_kind,
    /// Must be 0.
    pub reserved0: u32,
}

impl wk_vulkan_semaphore {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_VULKAN_SEMAPHORE,
        next: null(),
        semaphore: 0,
        value: 0,
        kind: WK_VULKAN_SEMAPHORE_BINARY,
        reserved0: 0,
    };
}

/// The images of a frame on a host's Vulkan device.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_vulkan_target {
    /// sizeof(wk_vulkan_target) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_VULKAN_TARGET.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// What is drawn into. Default NULL.
    pub color: *const wk_vulkan_image,
    /// The host's depth, as large as `color` and with as many samples. Where `color` has one sample (a resolved picture)
    /// depth may have more: the first of each pixel counts. NULL (the default) shows the sky in every pixel.
    pub depth: *const wk_vulkan_image,
    /// Where 1, the host's pixel stays; where 0, weather is drawn. As large as `color`, one sample, another image. Default NULL.
    pub mask: *const wk_vulkan_image,
    /// Waited for before anything is drawn; a binary one must have its signal submitted. At most 16.
    pub waits: *const wk_vulkan_semaphore,
    /// Signalled when all is drawn and the images are in their final layouts. At most 16.
    pub signals: *const wk_vulkan_semaphore,
    /// Number of waits. Default 0.
    pub wait_count: u32,
    /// Bytes from one wait to the next: sizeof(wk_vulkan_semaphore) of your header, which is the default.
    pub wait_stride: u32,
    /// Number of signals. Default 0.
    pub signal_count: u32,
    /// Bytes from one signal to the next: sizeof(wk_vulkan_semaphore) of your header, which is the default.
    pub signal_stride: u32,
    /// What each pixel shows is made of: the byte of red is a wk_surface_class, 0 where wk_ground_grid or the context's default says
    /// it. VK_FORMAT_R8_UNORM or the like, as large as `color`, one sample. Default NULL.
    pub surface_classes: *const wk_vulkan_image,
    /// Unit normals, in the host's world or in eye space (WK_FRAME_NORMALS_IN_EYE_SPACE): (n + 1) / 2 in normalised formats, n in
    /// float formats. What is no unit vector, as a cleared pixel, leaves it to the host's terrain and depth. As large as `color`, one
    /// sample. Default NULL.
    pub normals: *const wk_vulkan_image,
}

impl wk_vulkan_target {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_VULKAN_TARGET,
        next: null(),
        color: null(),
        depth: null(),
        mask: null(),
        waits: null(),
        signals: null(),
        wait_count: 0,
        wait_stride: struct_size::<wk_vulkan_semaphore>(),
        signal_count: 0,
        signal_stride: struct_size::<wk_vulkan_semaphore>(),
        surface_classes: null(),
        normals: null(),
    };
}

/// Wraps the host's Vulkan device. On success `*out_device` is a new handle for `wk_device_destroy`, to be called before
/// the host destroys its device; nothing of the host's is ever destroyed.
/// Thread: any that may use the queue.
/// Errors: WK_ERROR_INVALID_ARGUMENT names a handle that is NULL or does not belong, or all extensions, features and fields
/// that are missing; WK_ERROR_UNSUPPORTED what the driver cannot do; WK_ERROR_ALREADY_WRAPPED if the queue has a wk_device.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_device_create_vulkan(
    desc: *const wk_vulkan_host_desc,
    out_device: *mut *mut wk_device,
) -> wk_status {
    guard("wk_device_create_vulkan", |_| {
        let place = out("out_device", out_device)?;
        // SAFETY: the caller's promise about `desc`.
        let c = unsafe { layout::read(&"desc", desc)? };
        // SAFETY: as above.
        unsafe { layout::check_chain(&"desc", c.next, &[])? };
        // SAFETY: as above.
        let handle = unsafe { host::vulkan::open(&c)? };
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(handle) };
        Ok(Status::Ok)
    })
}

/// Waits until the GPU no longer uses a VkImage and forgets it. An image that was handed over is forgotten before or after
/// it is destroyed (an engine may rebuild its swapchain inside a call), but before a new one is handed over: Vulkan may give
/// that the old one's number, and Welkin would draw into the dead image. Destroyed it is only when the GPU has done with it, as ever:
/// after the signals of its last wk_view_record, or vkDeviceWaitIdle. A number that Welkin does not know is no error. Not
/// for every frame.
/// Thread: exclusive on the device.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_device_forget_vulkan_image(device: *mut wk_device, image: u64) -> wk_status {
    guard("wk_device_forget_vulkan_image", |call| {
        let object = call.get::<DeviceObject>("device", device)?;
        host::vulkan::forget_image(&object.cell, image)?;
        Ok(Status::Ok)
    })
}
