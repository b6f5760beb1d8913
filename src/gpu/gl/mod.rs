//! Hosts that draw with OpenGL: a wgpu device round the host's context, and the host's images as wgpu textures.
//!
//! # Two modes
//! [`GlMode::Shared`]: the host makes a second context that shares objects with its own, and a callback that makes one
//! or the other current. Welkin draws in the second one, so none of the host's state can change. Fences order the two:
//! the host's commands end before Welkin's begin, and the other way round. Framebuffers are not shared, so targets are
//! textures and renderbuffers.
//!
//! [`GlMode::HostContext`]: Welkin draws in the host's own context. Its state is saved, set to what wgpu takes for
//! granted, and put back (see the `state` room). Any framebuffer can be a target, the window's too, by copies in and
//! out.
//!
//! # What is upside down
//! OpenGL counts rows from the bottom, wgpu from the top. wgpu's backend turns every vertex shader's y round
//! (`gl_Position.y` is negated), so wgpu's top row lies in memory where OpenGL has its bottom row. A host's image is
//! the other way round, and rows are never copied to mend that. Instead:
//! - Geometry: multiply wgpu's clip-space y by -1 ([`CLIP_Y_SIGN`]). The two turns cancel, and wgpu's
//!   front faces are clockwise then (`wgpu::FrontFace::Cw`), because it does not know of this turn.
//! - Full-screen passes: `@builtin(position).xy` is the host's texel, counted from its first row, in colour and depth
//!   alike: `textureLoad` needs no turn. Only the way from texel to ray does: y in clip space is `2 (y + 0.5) / h - 1`
//!   for a host's image, and not `1 - 2 (y + 0.5) / h`.
//!
//! Both are the sign [`CLIP_Y_SIGN`] on clip-space y. A host whose clip control has its origin at the upper left while
//! it draws stores its rows from the top as wgpu does; it says so with its projection, whose y is then negated.
//!
//! # Depth
//! What comes to wgpu is the depth as stored, the window's from 0 to 1. Bind it as a `texture_2d<f32>` with an
//! unfilterable sample type and use `textureLoad`: a `texture_depth_2d` becomes a shadow sampler in GLSL and fails.

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

/// Sign of clip-space y with which wgpu's picture comes out the right way up in a host's image.
pub const CLIP_Y_SIGN: f32 = -1.0;
