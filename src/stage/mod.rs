//! Building blocks of a frame: the host's images and what their numbers mean, the stages in which a frame is drawn, and
//! the trait that every effect of a frame implements ([`DrawnEffect`]).
//!
//! A frame goes through its stages in the order in which a host interleaves them with its own drawing. Consecutive
//! stages of one call are drawn as one full-screen draw, the composition. Each effect adds its shader functions,
//! constants, blocks and textures to the composition ([`Composition`]). Effects that cannot be computed pixel by pixel
//! (falling drops, the windscreen) draw in passes of their own.

mod composition;
mod context;
mod diagnostic;
mod effect;
mod frame;
mod opaque;
mod outputs;
mod recording;
mod stages;
mod target;
mod uniform;

pub(crate) use composition::{
    Block, Composition, Constant, Constants, Contribution, MergedFrame, Pipeline, Texture, Traits, flag, veiled,
};
pub(crate) use context::{DrawContext, DrawTarget, FrameContext, PlannedShares, Tone};
pub use diagnostic::Diagnostic;
pub(crate) use effect::{DrawnEffect, LensPicture, PutPart};
pub use frame::{ColorSpace, DepthAccess, Frame, FrameFlags, ImageLayers};
pub(crate) use opaque::{LightLookup, OpaqueDraw, OpaqueTarget};
pub(crate) use outputs::{Exchange, Output, Outputs, ordered};
pub(crate) use recording::Recording;
pub use recording::{CostItem, Costs, RainReport, Report, SnowReport};
pub use stages::Stages;
pub(crate) use target::{
    Sampling, can_be_apart, can_copy, check_classes, check_color, check_depth, check_mask, check_normals,
    check_written, color_copy, is_copy_of, rounding,
};
pub(crate) use uniform::{
    BOW_ENTRIES, BowTable, FlashBlock, FlashUniform, FrameBlock, FrameUniform, FrameUniformBlock, FrameValues,
    is_float, uniform,
};
