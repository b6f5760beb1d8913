//! Dispatch by the kind of host that owns the device.

use super::own;
#[cfg(not(any(target_os = "macos", target_os = "ios")))]
use super::{opengl, vulkan};
use crate::{
    capi::{
        boundary::{
            Call, DeviceCell, Host,
            objects::{ContextObject, ViewObject},
        },
        frame::wk_frame,
        occluder_map::wk_occluder_map,
    },
    error::{Error, Result},
    frame::Stages,
};

/// Records a checked frame into the host's images, by the functions for the kind of host that owns the device.
///
/// # Safety
/// `frame.target` is NULL or points to a live target struct.
///
/// # Errors
/// The first wrong field by name, and every error of recording.
pub(in crate::capi) unsafe fn record(
    call: &mut Call,
    object: &ViewObject,
    frame: &wk_frame,
    stages: Stages,
) -> Result<()> {
    match &*object.cell.host() {
        // SAFETY: the caller's promise.
        Host::Own => unsafe { own::record(call, object, frame, stages) },
        #[cfg(not(any(target_os = "macos", target_os = "ios")))]
        // SAFETY: the caller's promise.
        Host::OpenGl(host) => unsafe { opengl::record(host, object, frame, stages) },
        #[cfg(not(any(target_os = "macos", target_os = "ios")))]
        // SAFETY: the caller's promise.
        Host::Vulkan(host) => unsafe { vulkan::record(host, object, frame, stages) },
    }
}

/// Sets the occluder maps of a context from the host's images, by the functions for the kind of host that owns the
/// device.
///
/// # Safety
/// The images of `maps` are live and correctly described.
///
/// # Errors
/// The first wrong field by name; the previous maps then stay.
pub(in crate::capi) unsafe fn set_occluder_maps<'a>(
    call: &mut Call,
    object: &ContextObject,
    maps: impl Iterator<Item = &'a wk_occluder_map> + Clone,
) -> Result<()> {
    match &*object.cell.host() {
        Host::Own => own::set_occluder_maps(call, object, maps),
        #[cfg(not(any(target_os = "macos", target_os = "ios")))]
        Host::OpenGl(host) => opengl::set_occluder_maps(host, object, maps),
        #[cfg(not(any(target_os = "macos", target_os = "ios")))]
        // SAFETY: the caller's promise.
        Host::Vulkan(host) => unsafe { vulkan::set_occluder_maps(host, object, maps) },
    }
}

/// Returns the native name of a texture of Welkin's: a VkImage or an OpenGL name.
///
/// # Errors
/// [`crate::Status::Unsupported`] on an own device.
pub(in crate::capi) fn native_texture(cell: &DeviceCell, texture: &wgpu::Texture) -> Result<u64> {
    match &*cell.host() {
        Host::Own => Err(Error::unsupported("native textures of an own device")),
        #[cfg(not(any(target_os = "macos", target_os = "ios")))]
        Host::OpenGl(_) => opengl::native_texture(texture),
        #[cfg(not(any(target_os = "macos", target_os = "ios")))]
        Host::Vulkan(_) => vulkan::native_texture(texture),
    }
}
