//! Structs of Vulkan hosts: the description of a host, its images and semaphores, and the target of a frame.

use std::{
    ffi::{c_char, c_void},
    ptr::{null, null_mut},
};

use super::boundary::{layout::struct_size, numbers::*};

/// The host's vkGetInstanceProcAddr, cast to this type: it returns a function pointer, or NULL.
pub type wk_vulkan_get_proc_fn =
    Option<unsafe extern "system" fn(instance: *mut c_void, name: *const c_char) -> *mut c_void>;

/// Takes or releases the host's lock on its queue.
pub type wk_vulkan_queue_fn = Option<unsafe extern "C" fn(user: *mut c_void)>;

/// The host's Vulkan device. All handles stay the host's and must outlive the wk_device.
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
    /// Index of the queue in the family. Default 0.
    pub queue_index: u32,
    /// Number of enabled_instance_extensions. Default 0.
    pub instance_extension_count: u32,
    /// Names of the instance extensions that the host enabled. Default NULL.
    pub enabled_instance_extensions: *const *const c_char,
    /// Names of the device extensions that the host enabled, VK_KHR_swapchain among them if it presents. Default NULL.
    pub enabled_device_extensions: *const *const c_char,
    /// Number of enabled_device_extensions. Default 0.
    pub device_extension_count: u32,
    /// Must be 0.
    pub reserved0: u32,
    /// The features that the host enabled: the VkDeviceCreateInfo that it gave to vkCreateDevice, or a chain of
    /// VkPhysicalDevice..Features structs. Read during the call. NULL (the default): no feature is enabled.
    pub enabled_features: *const c_void,
    /// Function that takes the host's queue lock. Set it together with unlock_queue, or leave both NULL (the default).
    pub lock_queue: wk_vulkan_queue_fn,
    /// Function that releases the lock.
    pub unlock_queue: wk_vulkan_queue_fn,
    /// Pointer that is passed to both functions. Default NULL.
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
    /// VkFormat that the image was created with. Default 0; must be given.
    pub format: u32,
    /// Width, pixels. Default 0; must be given.
    pub width: u32,
    /// Height, pixels. Default 0; must be given.
    pub height: u32,
    /// Samples of a pixel. Default 1. Colour with several samples needs sampleRateShading in enabled_features of the
    /// wk_vulkan_host_desc.
    pub samples: u32,
    /// VkImageUsageFlags that the image was created with: COLOR_ATTACHMENT and TRANSFER_SRC for colour, SAMPLED for
    /// images that are read, and also DEPTH_STENCIL_ATTACHMENT for depth with WK_DEPTH_ACCESS_READ_WRITE.
    pub usage: u32,
    /// Array layers that the image was created with. Default 1. For an occluder map it must be 1.
    pub array_layers: u32,
    /// Array layer that is handed over, such as one eye of a stereo or multiview host; the others stay untouched.
    /// Default 0.
    pub layer: u32,
    /// VkImageLayout in which the host left the image's handed-over layer. Default 0 (UNDEFINED: its content may be
    /// discarded; colour only).
    pub layout: u32,
    /// VkImageLayout in which Welkin returns the layer. Default 0; must be given. PRESENT_SRC_KHR, here and in
    /// `layout`, needs VK_KHR_swapchain in enabled_device_extensions of the wk_vulkan_host_desc.
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
    /// Value of a timeline semaphore to wait for or to signal. Default 0.
    pub value: u64,
    /// Kind of semaphore. Default WK_VULKAN_SEMAPHORE_BINARY.
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
    /// The image to draw into. Default NULL.
    pub color: *const wk_vulkan_image,
    /// The host's depth, as large as `color` and with as many samples. If `color` has one sample (a resolved picture),
    /// depth may have more; the first sample of each pixel is then used. With NULL (the default) every pixel shows the
    /// sky.
    pub depth: *const wk_vulkan_image,
    /// A mask: where it is 1, the host's pixel stays; where it is 0, Welkin draws weather. It is another image, as
    /// large as `color`, with one sample. Default NULL.
    pub mask: *const wk_vulkan_image,
    /// Semaphores to wait for before drawing, at most 16. The submission that signals a binary one must come before
    /// this call.
    pub wait_semaphores: *const wk_vulkan_semaphore,
    /// Semaphores to signal when all is drawn and the images are in their final layouts. At most 16.
    pub signal_semaphores: *const wk_vulkan_semaphore,
    /// Number of wait_semaphores. Default 0.
    pub wait_count: u32,
    /// Bytes from one wait semaphore to the next: sizeof(wk_vulkan_semaphore) of your header, which is the default.
    pub wait_stride: u32,
    /// Number of signal_semaphores. Default 0.
    pub signal_count: u32,
    /// Bytes from one signal semaphore to the next: sizeof(wk_vulkan_semaphore) of your header, which is the default.
    pub signal_stride: u32,
    /// Each pixel's surface class: the byte of red is a wk_surface_class, or 0 to use the class of the host's terrain
    /// or the context's default. VK_FORMAT_R8_UNORM or the like, as large as `color`, one sample. Default NULL.
    pub surface_classes: *const wk_vulkan_image,
    /// Unit normals, in the host's world or in eye space (WK_FRAME_NORMALS_IN_EYE_SPACE): (n + 1) / 2 in normalised
    /// formats, n in float formats. Where a pixel holds no unit vector (a cleared pixel), Welkin uses the normal of the
    /// host's terrain or depth. As large as `color`, one sample. Default NULL.
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
        wait_semaphores: null(),
        signal_semaphores: null(),
        wait_count: 0,
        wait_stride: struct_size::<wk_vulkan_semaphore>(),
        signal_count: 0,
        signal_stride: struct_size::<wk_vulkan_semaphore>(),
        surface_classes: null(),
        normals: null(),
    };
}
