//! Devices, surfaces, hosts' images, shader assembly, pipelines, counters of work and readback: everything that goes
//! beyond plain use of wgpu.
//!
//! A [`Device`] is one native queue or GL context. Welkin creates it (headless or for a window), adopts it from an
//! OpenGL or Vulkan host, or gets it from a Rust host. The rooms of the effects see only `wgpu` objects, and need not
//! know where these come from.

pub(crate) mod bind;
pub(crate) mod blocks;
pub(crate) mod counts;
// For Apple hosts wgpu builds its OpenGL backend only on another library (ANGLE); the backend there is Metal.
#[cfg(not(any(target_os = "macos", target_os = "ios")))]
pub mod gl;
pub mod pass;
pub mod readback;
pub(crate) mod recent;
pub mod shader;
pub mod surface;
// ash does not build for Apple hosts; the backend there is Metal.
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
