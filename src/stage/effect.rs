//! The trait that every effect of a frame implements.

use super::{
    composition::{Contribution, MergedFrame},
    context::{DrawContext, FrameContext},
    frame::Frame,
    opaque::OpaqueDraw,
    outputs::{Exchange, Outputs},
    recording::{Recording, Report},
    stages::Stages,
};
use crate::{
    error::Result,
    gpu::Device,
    plan::{StepWork, parts::Part},
};

/// The composed picture, for an effect on the lens to draw over.
#[derive(Clone, Copy)]
pub(crate) struct LensPicture<'a> {
    /// Copy of the picture, to read.
    pub copy: &'a wgpu::Texture,
    /// The picture itself, to draw into.
    pub target: &'a wgpu::TextureView,
}

/// Callback that takes a part, whether a picture has it, and the work of each of its steps.
pub(crate) type PutPart<'a> = dyn FnMut(&Part, bool, &[StepWork]) + 'a;

/// One effect of a view. A call of the frame asks [`DrawnEffect::check`] first, and then calls the other functions in
/// the order given here. It may ask [`DrawnEffect::has_opaque`] and [`DrawnEffect::has_lens`] at any time after
/// [`DrawnEffect::gather`]. Each function reads its context, and returns or fills in what the effect adds. An
/// effect sees other effects only through the outputs that it names.
pub(crate) trait DrawnEffect {
    /// Names the outputs that [`DrawnEffect::gather`] takes from other effects, and those that it gives to them.
    fn gathers(&self) -> Exchange {
        Exchange::NONE
    }

    /// Names the outputs that [`DrawnEffect::compose`] and [`DrawnEffect::draw`] take from other effects, and those
    /// that they give to them.
    fn composes(&self) -> Exchange {
        Exchange::NONE
    }

    /// Finds which parts of the effect are visible from the camera, and writes its outputs.
    fn gather(&mut self, _context: &FrameContext<'_>, _given: &mut Outputs) -> Result<()> {
        Ok(())
    }

    /// Stages in which the effect has something to draw in the gathered moment. A stage that no effect names is left
    /// out, except PREPARE and TONE.
    fn stages(&self) -> Stages;

    /// Refuses a frame with images that the effect cannot draw into.
    fn check(&self, _frame: &Frame<'_>, _stages: Stages) -> Result<()> {
        Ok(())
    }

    /// Allocates what depends on the picture's size, before anything is recorded: memory may be too small for a large
    /// target.
    fn hold(&mut self, _device: &Device, _color: &wgpu::Texture, _stages: Stages) {}

    /// Updates the effect's tables and textures for this moment. Only the first call of a frame does that.
    fn prepare(&mut self, _context: &FrameContext<'_>, _recording: &mut Recording<'_>) -> Result<()> {
        Ok(())
    }

    /// Whether the effect has anything opaque to draw in the gathered moment.
    fn has_opaque(&self) -> bool {
        false
    }

    /// Draws the textures that the effect's opaque geometry reads, in passes of its own.
    fn prepare_opaque(&mut self, _context: &FrameContext<'_>, _recording: &mut Recording<'_>) -> Result<()> {
        Ok(())
    }

    /// Draws the opaque geometry into the host's colour and depth, before the composition of stage SURFACE. Air,
    /// precipitation and the water on surfaces read its depth like that of the host's own objects.
    fn draw_opaque(
        &mut self,
        _context: &DrawContext<'_>,
        _opaque: &OpaqueDraw<'_>,
        _pass: &mut wgpu::RenderPass<'_>,
    ) -> Result<()> {
        Ok(())
    }

    /// Reports each part of the effect: whether a picture of `stages` has the part, and the work of its steps.
    fn parts(&mut self, _context: &DrawContext<'_>, _stages: Stages, _put: &mut PutPart<'_>) {}

    /// Fills in what the effect adds to the composition: constants, blocks, textures. `added` is empty before the call.
    /// It is an argument, not a return value, because copying the contributions of all effects takes a microsecond.
    fn compose(&mut self, _context: &DrawContext<'_>, _given: &Outputs, _added: &mut Contribution) -> Result<()> {
        Ok(())
    }

    /// Draws in the effect's own passes, before the composition.
    fn draw(
        &mut self,
        _context: &DrawContext<'_>,
        _merged: &MergedFrame<'_>,
        _recording: &mut Recording<'_>,
    ) -> Result<()> {
        Ok(())
    }

    /// Returns the shader with which the effect draws the veil for the host's own shaders, and the layout and the bind
    /// group that this shader needs in place of the composition's group 0. `None` if the effect has no such shader.
    fn veil(
        &mut self,
        _context: &DrawContext<'_>,
        _merged: &MergedFrame<'_>,
    ) -> Option<(&'static str, wgpu::BindGroupLayout, wgpu::BindGroup)> {
        None
    }

    /// Whether the effect has anything to draw over the picture.
    fn has_lens(&self) -> bool {
        false
    }

    /// Draws over the picture; `toned` says that this call has tone-mapped it.
    fn draw_lens(
        &mut self,
        _frame: &Frame<'_>,
        _picture: LensPicture<'_>,
        _toned: bool,
        _recording: &mut Recording<'_>,
    ) -> Result<()> {
        Ok(())
    }

    /// GPU memory held for the view, bytes.
    fn bytes(&self) -> u64 {
        0
    }

    /// Fills in the effect's fields of the report.
    fn report(&self, _report: &mut Report) {}

    /// Frees what depends on the picture's size.
    fn forget_picture(&mut self) {}
}
