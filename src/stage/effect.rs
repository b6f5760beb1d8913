//! The shape that every effect of a frame has.

use std::sync::Arc;

use glam::DMat4;

use super::{ColorSpace, Composition, Frame, FrameFlags, OpaqueDraw, Recording, Report, Stages, Tone};
use crate::{
    error::Result,
    gpu::{Device, Layer, blocks::BlockView},
    light::ToneCurve,
    moment::Moment,
    plan::{
        StepWork,
        parts::{MOST_PARTS, MOST_RUNGS, Part},
    },
    scene::ViewRays,
    surroundings::SurroundingsBlock,
};

/// Inputs of [`DrawnEffect::prepare`], before the first draw of a frame.
pub(crate) struct Prepare<'a> {
    pub frame: &'a Frame<'a>,
    pub now: &'a Moment<'a>,
    /// Work for tables in this frame, as a share of building all of them.
    pub share: f32,
}

/// The finished picture, as a lens over it takes it.
#[derive(Clone, Copy)]
pub(crate) struct LensPicture<'a> {
    /// A copy, to read.
    pub copy: &'a wgpu::Texture,
    /// The picture itself, to draw into.
    pub target: &'a wgpu::TextureView,
}

/// Inputs that all effects share in one draw.
pub(crate) struct Shot<'a> {
    pub device: &'a Arc<Device>,
    pub frame: &'a Frame<'a>,
    pub now: &'a Moment<'a>,
    pub rays: &'a ViewRays,
    pub color: Layer<'a>,
    /// Display units per cd/m^2.
    pub exposure: f64,
    /// Fog and air lie before the picture in this call, or have been drawn in an earlier one of the frame.
    pub veiled: bool,
    /// The parts of the plan, and the share of each step of each of them that is drawn.
    pub parts: &'static [Part],
    pub shares: [[f32; MOST_RUNGS - 1]; MOST_PARTS],
    /// The plan gauges what parts are worth.
    pub is_gauged: bool,
}

impl Shot<'_> {
    /// Share of a part's step that is drawn.
    pub fn share(&self, part: &Part, step: usize) -> f32 {
        let place = self.parts.iter().position(|p| p.name == part.name);
        place.map_or(1.0, |i| self.shares[i][step])
    }

    /// Pixels of the picture.
    pub fn pixels(&self) -> u64 {
        u64::from(self.color.texture.width()) * u64::from(self.color.texture.height())
    }

    /// What is made of exposed light in its picture.
    pub fn tone(&self) -> Tone {
        match (self.frame.color_space, self.now.tone) {
            (ColorSpace::SceneLinear, _) | (_, ToneCurve::Linear) => |x| x,
            (_, ToneCurve::Exponential) => |x| ToneCurve::Exponential.apply(x),
            (_, ToneCurve::Filmic) => |x| ToneCurve::Filmic.apply(x),
        }
    }

    /// From camera-relative east-north-up to clip space.
    pub fn clip(&self) -> DMat4 {
        let camera = &self.frame.camera;
        camera.projection * DMat4::from_mat3(camera.rotation() * self.now.scene.world_to_enu.transpose())
    }
}

impl Frame<'_> {
    /// Whether nothing of earlier frames may show.
    pub(crate) fn is_pure(&self) -> bool {
        self.flags.has(FrameFlags(FrameFlags::NO_HISTORY.0 | FrameFlags::CUT.0))
    }
}

/// What passes of an effect's own draw with, once all effects have added to the composition.
pub(crate) struct Drawing<'a> {
    pub composition: &'a Composition,
    /// The frame's block on the GPU.
    pub block: &'a BlockView,
    pub surroundings: &'a SurroundingsBlock,
}

/// Takes a part, whether a picture has it, and the work of each of its steps.
pub(crate) type PutPart<'a> = dyn FnMut(&Part, bool, &[StepWork]) + 'a;

/// One effect of a view. `src/effects.rs` lists them and hands each what a context holds of it (`gather`); all else goes through these,
/// in this order.
pub(crate) trait DrawnEffect {
    /// Stages in which there is something of it in the moment that was gathered. In others it is not run.
    fn stages(&self) -> Stages;

    /// Refuses a frame whose images it cannot draw into.
    fn check(&self, _frame: &Frame<'_>, _stages: Stages) -> Result<()> {
        Ok(())
    }

    /// Makes what it needs of the picture's size, before anything is recorded: a large target is what memory may be too small for.
    fn hold(&mut self, _device: &Device, _color: &wgpu::Texture, _stages: Stages) {}

    /// Brings what it keeps up to the moment.
    fn prepare(&mut self, _at: &Prepare<'_>, _to: &mut Recording<'_>) -> Result<()> {
        Ok(())
    }

    /// Whether it has anything opaque to draw in the moment that was gathered.
    fn has_opaque(&self) -> bool {
        false
    }

    /// Draws what is opaque, into the host's colour and depth, before the composition of stage SURFACE. What lies on surfaces, air and
    /// what falls see its depth as they see the host's.
    fn draw_opaque(
        &mut self,
        _shot: &Shot<'_>,
        _with: &OpaqueDraw<'_>,
        _pass: &mut wgpu::RenderPass<'_>,
    ) -> Result<()> {
        Ok(())
    }

    /// Names its parts, whether a picture of these stages has them, and their work.
    fn parts(&mut self, _shot: &Shot<'_>, _stages: Stages, _put: &mut PutPart<'_>) {}

    /// Adds to the composition: constants, blocks, textures.
    fn compose(&mut self, shot: &Shot<'_>, to: &mut Composition) -> Result<()>;

    /// Draws in passes of its own, before the composition.
    fn draw(&mut self, _shot: &Shot<'_>, _with: &Drawing<'_>, _to: &mut Recording<'_>) -> Result<()> {
        Ok(())
    }

    /// What the veil for the host's own shaders is drawn with in place of the composition's group 0, if anything is.
    fn veil(
        &mut self,
        _shot: &Shot<'_>,
        _with: &Drawing<'_>,
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
        _to: &mut Recording<'_>,
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
