//! Devices, surfaces, targets, shader assembly, timing and readback: everything that touches wgpu's edges.
//!
//! A [`Device`] is one native queue or GL context, however it came to us: made here (headless or for a window),
//! adopted from an OpenGL or Vulkan host, or handed over by a Rust host. The rooms of the effects see only
//! `wgpu` objects and never ask whose they are.

// wgpu builds its OpenGL backend for Apple hosts only round another library; there the backend is Metal.
pub(crate) mod bind;
pub(crate) mod blocks;
#[cfg(not(any(target_os = "macos", target_os = "ios")))]
pub mod gl;
pub mod pass;
pub mod readback;
pub(crate) mod recent;
pub mod shader;
pub mod surface;
// ash does not build for Apple hosts here: there the backend is Metal.
#[cfg(not(any(target_os = "macos", target_os = "ios")))]
pub mod vulkan;

mod device;
mod instance;
mod known;
mod layer;
mod opening;
mod shared;
mod stand_in;
mod texture;
mod win32;
mod x11;
pub use device::{AttachedDepth, Caps, Device, DeviceOptions, Entered, HostBinding};
pub(crate) use layer::{KeptLayer, KeptView, Layer, check_depth_format, is_kept};
pub use shared::Shared;
pub use texture::flat_texture;
