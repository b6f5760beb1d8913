//! Vulkan hosts on Apple's systems, where the graphics interface is Metal: always unsupported.

use crate::{
    capi::{
        boundary::{DeviceCell, objects::wk_device},
        vulkan_structs::wk_vulkan_host_desc,
    },
    error::{Error, Result, Status},
};

/// Fails: this system has no Vulkan hosts.
///
/// # Safety
/// No requirements; the signature is that of the other systems.
pub(in crate::capi) unsafe fn open(_: &wk_vulkan_host_desc) -> Result<*mut wk_device> {
    Err(Error::unsupported("Vulkan hosts: on this system the graphics interface is Metal"))
}

pub(in crate::capi) fn forget_image(_: &DeviceCell, _: u64) -> Result<()> {
    Err(Error::about(Status::Unsupported, "device", "must be a Vulkan host's"))
}
