//! Vulkan hosts
//!
//! Welkin draws on the host's VkDevice and VkQueue, into the host's VkImages, and submits its own work: when
//! wk_view_record returns, the work is on the queue. Only one thread at a time may use a VkQueue. Either keep other
//! threads away from the queue during calls on its wk_device, or pass lock_queue and unlock_queue, which Welkin calls
//! around every submission. Call no Welkin function inside these two.
//!
//! Welkin takes an image in the layout in which the host left it and returns it in the layout that the host asks for.
//! On one queue no semaphores are needed: Welkin's work waits for what the host submitted before, and what the host
//! submits afterwards waits for Welkin's. Semaphores order work with other queues.
//!
//! Pass handles as Vulkan has them: dispatchable ones as pointers, others as 64-bit numbers.
//!
//! Needed: Vulkan 1.1, or 1.0 with VK_KHR_maintenance1 and VK_KHR_storage_buffer_storage_class; a queue that draws and
//! computes. For each use on the left, enable the extension or feature on the right for the VkDevice, and list it in
//! the wk_vulkan_host_desc:
//!
//! ```text
//!     images in PRESENT_SRC_KHR                     VK_KHR_swapchain in enabled_device_extensions
//!     colour of several samples                     VkPhysicalDeviceFeatures::sampleRateShading in enabled_features
//!     timeline semaphores                           timelineSemaphore in enabled_features
//!     DEPTH_ATTACHMENT and DEPTH_READ_ONLY layouts  separateDepthStencilLayouts in enabled_features
//!     ATTACHMENT and READ_ONLY layouts              synchronization2 in enabled_features
//! ```
//!
//! Welkin uses other extensions and features only if the host lists them.
//!
//! Destroy views, contexts and textures first, then the wk_device, then the VkDevice, then the VkInstance. While a
//! wk_device has children, wk_device_destroy answers WK_ERROR_IN_USE, and the VkDevice must stay too. Vulkan cannot
//! tell whether a VkDevice still lives, so destroying it earlier crashes, as with objects of your own.

pub use super::vulkan_structs::*;
use super::{
    boundary::{
        guard,
        input::out,
        layout::{self, init_struct},
        numbers::*,
        objects::{DeviceObject, wk_device},
    },
    host,
};
use crate::error::Status;

include!(concat!(env!("OUT_DIR"), "/init_vulkan.rs"));

/// Wraps the host's Vulkan device. On success `*out_device` is a new handle for `wk_device_destroy`; call that before
/// you destroy your device. Welkin never destroys the host's objects.
/// Thread: any that may use the queue.
/// Errors: WK_ERROR_INVALID_ARGUMENT names a NULL or foreign handle, or all missing extensions, features and fields;
/// WK_ERROR_UNSUPPORTED names what the driver cannot do; WK_ERROR_ALREADY_WRAPPED if the queue has a wk_device;
/// WK_ERROR_NO_ADAPTER if the instance cannot list its physical devices.
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

/// Waits until the GPU no longer uses a VkImage, and forgets it. Call this function for each image that you handed
/// over, before or after you destroy it (an engine may rebuild its swapchain inside a call), but before you hand over a
/// new one: Vulkan may give the new image the old handle, and Welkin would draw into the dead image. As always, destroy
/// an image only when the GPU has finished with it: after the semaphores that its last wk_view_record signals, or after
/// vkDeviceWaitIdle. An unknown image is no error. Slow: do not call it in every frame.
/// Thread: exclusive on the device.
/// Errors: WK_ERROR_UNSUPPORTED on a device that is not on a Vulkan host.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_device_forget_vulkan_image(device: *mut wk_device, image: u64) -> wk_status {
    guard("wk_device_forget_vulkan_image", |call| {
        let object = call.get::<DeviceObject>("device", device)?;
        host::vulkan::forget_image(&object.cell, image)?;
        Ok(Status::Ok)
    })
}
