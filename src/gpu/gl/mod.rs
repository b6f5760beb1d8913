//! Hosts that draw with OpenGL: a wgpu device on the host's context, and the host's images as wgpu textures.
//!
//! # Two modes
//! [`GlMode::Shared`]: the host creates a second context that shares objects with its own, and gives a callback that
//! makes either one current. Welkin draws in the second context, so it cannot change the host's state. Fences (or
//! flushes, see [`Handover`]) order the two: the host's commands end before Welkin's begin, and Welkin's end before the
//! host's next commands begin. Framebuffers are not shared between contexts, so targets are textures and renderbuffers.
//!
//! [`GlMode::HostContext`]: Welkin draws in the host's own context. It saves the host's state, sets the state that wgpu
//! assumes, and restores the host's state at the end (`src/gpu/gl/state`). Any framebuffer can be a target, the
//! window's too: the picture is copied in and out.
//!
//! # What is upside down
//! OpenGL counts rows from the bottom, wgpu from the top. wgpu's OpenGL backend negates y in every vertex shader
//! (`gl_Position.y`), so wgpu's top row lies in memory where OpenGL has its bottom row. A host's image has the opposite
//! order. Rows are never copied to correct that. Instead:
//! - Geometry: multiply wgpu's clip-space y by -1 ([`CLIP_Y_SIGN`]). This undoes the backend's negation. wgpu does not
//!   know of the multiplication, so front faces are then clockwise to wgpu (`wgpu::FrontFace::Cw`).
//! - Full-screen passes: `@builtin(position).xy` is the host's texel, counted from its first row, in colour and depth
//!   alike, so `textureLoad` needs no change. Only the step from texel to ray changes: in row y of a host's image of
//!   height h, clip-space y is `2 (y + 0.5) / h - 1`, not `1 - 2 (y + 0.5) / h`.
//!
//! In both cases clip-space y has the sign [`CLIP_Y_SIGN`]. A host that draws with its clip control's origin at the
//! upper left stores rows from the top, as wgpu does. Such a host passes a projection with y negated.
//!
//! # Depth
//! wgpu gets the depth as stored: window depth from 0 to 1. Bind it as a `texture_2d<f32>` with an unfilterable sample
//! type and read it with `textureLoad`: a `texture_depth_2d` becomes a shadow sampler in GLSL and fails.

mod api;
mod blit;
mod build;
mod cache;
mod check;
mod counting;
mod desc;
mod face;
mod formats;
mod gate;
mod host;
mod image;
mod later;
mod mark;
pub(crate) mod names;
mod object;
mod open;
mod side;
mod state;
mod switch;
mod target;
mod window;
mod windows;

pub(super) use api::raised_in_welkin;
pub use check::{GlInfo, GlProfile};
pub use desc::{GetProc, GlHostDesc, GlMode, Handover};
pub use host::{Current, GlHost};
pub use image::GlImage;
pub use open::{GlDevice, adopt};
pub use switch::{MakeCurrent, WhichContext};
pub use target::{GlTarget, GlTargetDesc, Multisample};

/// Sign of clip-space y that turns wgpu's picture the right way up in a host's image.
pub const CLIP_Y_SIGN: f32 = -1.0;
