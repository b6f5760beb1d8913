//! Vulkan hosts on Apple's systems, where the graphics interface is Metal: refused by name.

use crate::{
    capi::{
        boundary::{DeviceCell, objects::wk_device},
        vulkan_structs::wk_vulkan_host_desc,
    },
    error::{Error, Result, Status},
};

/// # Safety
/// None is needed; as the other systems' function.
pub(in crate::capi) unsafe fn open(_: &wk_vulkan_host_desc) -> Result<*mut wk_device> {
    Err(Error::unsupported("Vulkan hosts: on this system the graphics interface is Metal"))
}

pub(in crate::capi) fn forget_image(_: &DeviceCell, _: u64) -> Result<()> {
    Err(Error::about(Status::Unsupported, "device", "must be a Vulkan host's"))
}
