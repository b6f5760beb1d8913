//! Frames and occluder maps for each kind of host: how the host's images are imported for a frame and handed back.
//!
//! One file holds one kind of host; `dispatch.rs` chooses among them by the device's owner.

mod dispatch;
#[cfg_attr(any(target_os = "macos", target_os = "ios"), path = "opengl_absent.rs")]
pub(super) mod opengl;
mod own;
mod target;
#[cfg_attr(any(target_os = "macos", target_os = "ios"), path = "vulkan_absent.rs")]
pub(super) mod vulkan;

pub(super) use dispatch::{native_texture, record, set_occluder_maps};
