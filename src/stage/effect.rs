//! The shape that every effect of a frame has.

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

/// The finished picture, as a lens over it takes it.
#[derive(Clone, Copy)]
pub(crate) struct LensPicture<'a> {
    /// A copy, to read.
    pub copy: &'a wgpu::Texture,
    /// The picture itself, to draw into.
    pub target: &'a wgpu::TextureView,
}

/// Takes a part, whether a picture has it, and the work of each of its steps.
pub(crate) type PutPart<'a> = dyn FnMut(&Part, bool, &[StepWork]) + 'a;

/// One effect of a view, run by these functions in this order. Each reads its context and returns what it adds; none
/// sees another but by the outputs that it names.
pub(crate) trait DrawnEffect {
    /// Names the outputs that [`DrawnEffect::gather`] takes from other effects and gives to them.
    fn gathers(&self) -> Exchange {
        Exchange::NONE
    }

    /// Names the outputs that [`DrawnEffect::compose`] and [`DrawnEffect::draw`] take from other effects and give to
    /// them.
    fn composes(&self) -> Exchange {
        Exchange::NONE
    }

    /// Finds what there is of it at a camera, and writes what it gives.
    fn gather(&mut self, _context: &FrameContext<'_>, _given: &mut Outputs) -> Result<()> {
        Ok(())
    }

    /// Stages in which there is something of it in the moment that was gathered. In others it is not run.
    fn stages(&self) -> Stages;

    /// Refuses a frame whose images it cannot draw into.
    fn check(&self, _frame: &Frame<'_>, _stages: Stages) -> Result<()> {
        Ok(())
    }

    /// Makes what it needs of the picture's size, before anything is recorded: a large target is what memory may be too
    /// small for.
    fn hold(&mut self, _device: &Device, _color: &wgpu::Texture, _stages: Stages) {}

    /// Brings what it keeps up to the moment.
    fn prepare(&mut self, _context: &FrameContext<'_>, _recording: &mut Recording<'_>) -> Result<()> {
        Ok(())
    }

    /// Whether it has anything opaque to draw in the moment that was gathered.
    fn has_opaque(&self) -> bool {
        false
    }

    /// Draws what is opaque, into the host's colour and depth, before the composition of stage SURFACE. What lies on
    /// surfaces, air and what falls see its depth as they see the host's.
    fn draw_opaque(
        &mut self,
        _context: &DrawContext<'_>,
        _opaque: &OpaqueDraw<'_>,
        _pass: &mut wgpu::RenderPass<'_>,
    ) -> Result<()> {
        Ok(())
    }

    /// Names its parts, whether a picture of these stages has them, and their work.
    fn parts(&mut self, _context: &DrawContext<'_>, _stages: Stages, _put: &mut PutPart<'_>) {}

    /// Returns what it adds to the composition: constants, blocks, textures.
    fn compose(&mut self, _context: &DrawContext<'_>, _given: &Outputs) -> Result<Contribution<'_>> {
        Ok(Contribution::none())
    }

    /// Draws in passes of its own, before the composition.
    fn draw(
        &mut self,
        _context: &DrawContext<'_>,
        _merged: &MergedFrame<'_>,
        _recording: &mut Recording<'_>,
    ) -> Result<()> {
        Ok(())
    }

    /// Returns the shader, layout and bind group with which the veil for the host's own shaders is drawn in place of
    /// the composition's group 0, if there are any.
    fn veil(
        &mut self,
        _context: &DrawContext<'_>,
        _merged: &MergedFrame<'_>,
    ) -> Option<(&'static str, wgpu::BindGroupLayout, wgpu::BindGroup)> {
        None
    }

    /// Whether it has anything to draw over the finished picture.
    fn has_lens(&self) -> bool {
        false
    }

    /// Draws over the finished picture; `toned` says that this call has tone-mapped it.
    fn draw_lens(
        &mut self,
        _frame: &Frame<'_>,
        _picture: LensPicture<'_>,
        _toned: bool,
        _recording: &mut Recording<'_>,
    ) -> Result<()> {
        Ok(())
    }

    /// Bytes of GPU memory held for the view.
    fn bytes(&self) -> u64 {
        0
    }

    /// Its lines of the report.
    fn report(&self, _report: &mut Report) {}

    /// Lets go what it holds of the picture's size.
    fn forget_picture(&mut self) {}
}
