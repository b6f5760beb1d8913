//! Diagnostic picture in place of a frame's picture: it uses the composition's bindings and constants with another
//! shader. The picture of the wind has a bind group of its own in place of the composition's tables and surroundings.

use super::{draw::frame_block, view::View};
use crate::{
    error::Result,
    gpu::{Layer, pass},
    stage::{
        ColorSpace, Composition, CostItem, Diagnostic, DrawTarget, FrameContext, Recording, Stages, flag, is_float,
    },
};

impl View {
    /// Draws the frame's diagnostic picture if its stage is among those `asked` for. `there` are the stages in which
    /// there is something to draw.
    pub(super) fn draw_diagnostic<'a>(
        &mut self,
        frame_context: &FrameContext<'a>,
        target: DrawTarget<'a>,
        [asked, there]: [Stages; 2],
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        let frame = frame_context.frame;
        let stage = frame.diagnostic.stage();
        if !asked.has(stage) {
            return Ok(());
        }
        self.history.report.exposure = target.exposure;
        // The plan is that of the normal picture of this frame.
        let mut context =
            self.planned(frame_context, target, Stages(asked.0 & there.0).without(Stages::PREPARE.with(Stages::LENS)));
        let behind = if frame.diagnostic == Diagnostic::PlanError { asked.0 & Stages::BACKGROUND.0 } else { 0 };
        context.stages = stage.with(Stages(behind));
        let color = target.color.texture;
        let mut composition = Composition::new(context.stages, frame_block(&context, false));
        self.compose_effects(&context, &mut composition, false)?;
        let is_there = there.has(stage) && composition.stages().has(stage);
        if !is_there {
            composition.leave_out(stage);
        }
        let plain = !is_float(color.format()) && !color.format().is_srgb();
        let encoded = plain && frame.color_space != ColorSpace::DisplayLinear;
        let own = [
            ("DIAGNOSTIC", f64::from(frame.diagnostic as u32)),
            ("ABSENT", flag(!is_there)),
            ("ENCODED", flag(encoded)),
        ];
        own.into_iter().for_each(|(name, value)| composition.set_constant(name, value, value));
        let variant = self.variant(&context, &mut composition)?.with(composition.whole());
        self.draw_effects(&context, &composition, recording)?;
        let (Some((_, group)), Some((_, tables))) = (&self.cache.bound, &composition.tables()) else { return Ok(()) };
        let target = self.cache.target.of(target.color, Layer::view);
        let mut composite = self.cache.composite.lock()?;
        if frame.diagnostic == Diagnostic::Wind {
            let (pipeline, wind) = composite.wind(&self.device, variant, frame_context.now)?;
            pass::draw(recording.encoder, "wind", &pipeline, &[group, &wind], target);
        } else {
            let pipeline = composite.pipeline(&self.device, variant)?;
            let groups = [group, tables, self.cache.surroundings.bind_group()];
            pass::draw(recording.encoder, "diagnostic", pipeline, &groups, target);
        }
        recording.passes += 1;
        recording.ends(CostItem::Composition, true)
    }
}
