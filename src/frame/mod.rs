//! Views of the weather. A view records a host's frame stage by stage: it composes what the effects add, plans what may
//! be left out, and reports.
//!
//! A host hands over a [`Frame`] (camera, colour, depth) and a set of [`Stages`]; a [`View`] records them. No effect is
//! named here; `src/effects.rs` has the list of effects.

mod bound;
mod cache;
mod check;
mod diagnose;
mod draw;
mod environment;
mod environment_map;
mod froxels;
mod history;
mod light;
mod opaque;
mod opaque_step;
mod picture;
mod pixels;
mod planned;
mod rehearsal;
mod rehearsed;
mod unit;
mod view;
mod wind_picture;

pub use crate::effects::PARTS;
pub use crate::gpu::Shared;
pub use crate::light::tone::{self, Exposure, ToneCurve};
pub use crate::stage::{
    ColorSpace, CostItem, Costs, DepthAccess, Diagnostic, Frame, FrameFlags, ImageLayers, Report, Stages,
};
pub use environment::Environment;
pub use froxels::{FrameTextures, SNIPPET_GLSL, SNIPPET_WGSL};
pub use light::FrameLight;
pub(crate) use rehearsal::{MOST_CALLS, MOST_FRAMES, time_limit};
pub use view::View;
