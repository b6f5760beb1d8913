//! Opaque drawing by effects: into the host's own colour and depth, before the composition of stage SURFACE.

use glam::DMat4;

use super::{composition::Constant, context::DrawContext, frame::Frame};
use crate::{
    gpu::pass,
    scene::{ClipSpace, DepthKind},
};

/// Properties of the target that the pipelines of opaque things depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OpaqueTarget {
    pub color: wgpu::TextureFormat,
    pub depth: wgpu::TextureFormat,
    pub samples: u32,
    /// Whether a depth of 1 is nearest to the eye.
    pub reversed: bool,
    /// Whether the fragment shader writes depth, with `written_depth` of `shaders/common/depth.wgsl`.
    pub logarithmic: bool,
}

impl OpaqueTarget {
    /// Returns the target of a frame that is drawn into `color` and `depth`.
    pub fn of(frame: &Frame<'_>, color: &wgpu::Texture, depth: &wgpu::Texture) -> Self {
        Self {
            color: color.format(),
            depth: depth.format(),
            samples: color.sample_count(),
            reversed: frame.depth_mapping.reversed,
            logarithmic: matches!(frame.depth_mapping.kind, DepthKind::Logarithmic { .. }),
        }
    }

    /// Returns the depth test: nearer fragments pass and are written. At equal depth the host's pixel stays. The
    /// stencil is kept.
    pub fn depth_test(&self) -> wgpu::DepthStencilState {
        let nearer = if self.reversed { wgpu::CompareFunction::Greater } else { wgpu::CompareFunction::Less };
        pass::depth_test(self.depth, nearer, true)
    }

    /// Returns the colour target: colour is replaced, and the host's alpha is kept, as in the composition.
    pub fn color_target(&self) -> wgpu::ColorTargetState {
        wgpu::ColorTargetState { format: self.color, blend: None, write_mask: wgpu::ColorWrites::COLOR }
    }
}

/// Look-up tables of sky and air (group 1), for opaque things that mirror the sky.
pub(crate) struct LightLookup<'a> {
    pub layout: &'a wgpu::BindGroupLayout,
    pub group: &'a wgpu::BindGroup,
    /// Values of the `override` constants of `shaders/sky/lookup.wgsl`.
    pub constants: [Constant; 2],
}

/// Target, layout and clip space for opaque draws. The pass itself has the host's images as its attachments and the
/// group of `shaders/common/opaque.wgsl` as group 0.
pub(crate) struct OpaqueDraw<'a> {
    pub target: OpaqueTarget,
    /// Layout of group 0.
    pub layout: &'a wgpu::BindGroupLayout,
    pub tables: LightLookup<'a>,
    /// Matrix from camera-relative (east, north, up) to wgpu's clip space for these images.
    pub clip: DMat4,
}

impl OpaqueDraw<'_> {
    /// Returns the clip-space matrix of `context` in wgpu's convention: z from 0 to 1, and y towards the first row of
    /// the image.
    pub fn clip_of(context: &DrawContext<'_>) -> DMat4 {
        let rows = context.clip().transpose();
        let (frame, w) = (context.frame, rows.w_axis);
        let z = match (frame.depth_mapping.kind, frame.depth_mapping.clip) {
            // The fragment shader writes the depth; the constant z keeps everything in front of the eye from being
            // clipped.
            (DepthKind::Logarithmic { .. }, _) => 0.5 * w,
            (_, ClipSpace::MinusOneToOne) => 0.5 * (rows.z_axis + w),
            (_, ClipSpace::ZeroToOne) => rows.z_axis,
        };
        let y = if frame.origin_bottom_left { -rows.y_axis } else { rows.y_axis };
        DMat4::from_cols(rows.x_axis, y, z, w).transpose()
    }
}
