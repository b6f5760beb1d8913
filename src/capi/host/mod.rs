//! Whose device it is, and how a frame's images come in and go back: one file a kind of host.

#[cfg_attr(any(target_os = "macos", target_os = "ios"), path = "opengl_absent.rs")]
pub(super) mod opengl;
pub(super) mod own;
#[cfg_attr(any(target_os = "macos", target_os = "ios"), path = "vulkan_absent.rs")]
pub(super) mod vulkan;

use std::ffi::c_void;

use super::{
    boundary::Call, context::ContextObject, device_cell::DeviceCell, frame::wk_frame, layout,
    occluder::wk_occluder_map, status::wk_struct_type, view::ViewObject,
};
use crate::{
    error::{Error, Result},
    frame::Stages,
};

/// Owner of a device, as the boundary keeps it.
pub(super) enum Host {
    /// Welkin's own device.
    Own,
    /// The host's OpenGL context, or one that shares its objects.
    #[cfg(not(any(target_os = "macos", target_os = "ios")))]
    OpenGl(std::sync::Arc<crate::gpu::gl::GlHost>),
    /// The host's Vulkan device.
    #[cfg(not(any(target_os = "macos", target_os = "ios")))]
    Vulkan(Box<crate::gpu::vulkan::VulkanHost>),
}

impl Host {
    /// Whether GPU objects may only be released where the host's context can be entered.
    pub(super) fn needs_context(&self) -> bool {
        match self {
            Self::Own => false,
            #[cfg(not(any(target_os = "macos", target_os = "ios")))]
            Self::OpenGl(_) => true,
            #[cfg(not(any(target_os = "macos", target_os = "ios")))]
            Self::Vulkan(_) => false,
        }
    }

    /// # Errors
    /// [`Status::Unsupported`] about `param`, for `what` is made for a host's own shaders, of which this device has
    /// none.
    pub(super) fn check_own_shaders(&self, param: &str, what: &str) -> Result<()> {
        match self {
            Self::Own => {
                let text = format!("{what} are for hosts that draw with OpenGL, Vulkan or wgpu themselves");
                Err(Error::unsupported(text).within(param))
            }
            #[cfg(not(any(target_os = "macos", target_os = "ios")))]
            Self::OpenGl(_) | Self::Vulkan(_) => Ok(()),
        }
    }

    /// Gives the host its device back.
    ///
    /// # Errors
    /// Whatever the host should know before it destroys its device.
    pub(super) fn close(self) -> Result<()> {
        match self {
            Self::Own => Ok(()),
            #[cfg(not(any(target_os = "macos", target_os = "ios")))]
            Self::OpenGl(_) => Ok(()),
            #[cfg(not(any(target_os = "macos", target_os = "ios")))]
            Self::Vulkan(host) => host.close(),
        }
    }
}

/// Records a checked frame into the images of the device's kind of host.
///
/// # Safety
/// `frame.target` is NULL or leads to a live target struct.
///
/// # Errors
/// The first wrong field by name, and everything that recording may answer.
pub(super) unsafe fn record(call: &mut Call, object: &ViewObject, frame: &wk_frame, stages: Stages) -> Result<()> {
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

/// Takes over the occluder maps of a context from the images of the device's kind of host.
///
/// # Safety
/// The images of `maps` are live and truly described.
///
/// # Errors
/// The first wrong field by name; the maps before stay.
pub(super) unsafe fn set_occluder_maps<'a>(
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

/// The host's own name for a texture of Welkin's: a VkImage or an OpenGL name.
///
/// # Errors
/// [`Status::Unsupported`] on an own device.
pub(super) fn native_texture(cell: &DeviceCell, texture: &wgpu::Texture) -> Result<u64> {
    match &*cell.host() {
        Host::Own => Err(Error::unsupported("native textures of an own device")),
        #[cfg(not(any(target_os = "macos", target_os = "ios")))]
        Host::OpenGl(_) => opengl::native_texture(texture),
        #[cfg(not(any(target_os = "macos", target_os = "ios")))]
        Host::Vulkan(_) => vulkan::native_texture(texture),
    }
}

/// Reads a target struct and checks its chain; NULL gives the default, which has no images.
///
/// # Safety
/// `p` is NULL or leads to a live tagged struct.
unsafe fn target<T: layout::Layout>(p: *const c_void) -> Result<T> {
    // SAFETY: the caller's promise.
    let target = unsafe { layout::read_or_default(&"frame.target", p.cast::<T>())? };
    let next = layout::head_of(&target).next;
    let none: [wk_struct_type; 0] = [];
    // SAFETY: as above.
    unsafe { layout::check_chain(&"frame.target", next, &none)? };
    Ok(target)
}

/// An occluder map's error with the field's name in the header: `image` is the one that holds the depth on this host.
fn in_map(image: &'static str) -> impl Fn(Error) -> Error {
    move |e| e.map_field(|field| field.replacen("].depth", &format!("].{image}"), 1))
}
