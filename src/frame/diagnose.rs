//! A diagnostic picture in place of a frame's: the composition's bindings and constants, another shader.

use super::{View, draw::Call};
use crate::{
    error::Result,
    gpu::{Layer, pass},
    stage::{ColorSpace, Composition, CostItem, Diagnostic, Drawing, Recording, Stages, flag, is_float, uniform},
};

impl View {
    /// Draws the frame's diagnostic picture if its stage is among those `asked` for; `there` are those of which there is anything.
    pub(super) fn draw_diagnostic(
        &mut self,
        call: &Call<'_>,
        [asked, there]: [Stages; 2],
        to: &mut Recording<'_>,
    ) -> Result<()> {
        let (frame, color) = (call.frame, call.color.texture);
        let stage = frame.diagnostic.stage();
        if !asked.has(stage) {
            return Ok(());
        }
        self.report.exposure = call.exposure;
        let mut shot = call.shot();
        // Planned as the picture itself would be.
        self.plan_frame(&mut shot, Stages(asked.0 & there.0).without(Stages::PREPARE.with(Stages::LENS)));
        let behind = if frame.diagnostic == Diagnostic::PlanError { asked.0 & Stages::BACKGROUND.0 } else { 0 };
        let block = uniform(frame, call.now, call.rays, color, call.exposure, false);
        let mut composition = Composition::new(stage.with(Stages(behind)), block);
        for effect in self.effects.each() {
            effect.compose(&shot, &mut composition)?;
        }
        let is_there = there.has(stage) && composition.stages.has(stage);
        if !is_there {
            composition.stages = composition.stages.without(stage);
        }
        let plain = !is_float(color.format()) && !color.format().is_srgb();
        let encoded = plain && frame.color_space != ColorSpace::DisplayLinear;
        let own = [
            ("DIAGNOSTIC", f64::from(frame.diagnostic as u32)),
            ("ABSENT", flag(!is_there)),
            ("ENCODED", flag(encoded)),
        ];
        own.into_iter().for_each(|(name, value)| composition.constant(name, value, value));
        let variant = self.variant(&shot, &mut composition)?;
        self.hold_copy(color)?;
        self.bind(&shot, &composition)?;
        self.uniform.write(bytemuck::bytes_of(&composition.block));
        for effect in self.effects.each() {
            let with = Drawing { composition: &composition, block: &self.uniform, surroundings: &self.surroundings };
            effect.draw(&shot, &with, to)?;
        }
        self.take_picture(call.color, to)?;
        let (Some((_, group)), Some((_, tables))) = (&self.bound, &composition.tables) else { return Ok(()) };
        let target = self.target.of(call.color, Layer::view);
        let mut composite = self.composite.lock()?;
        if frame.diagnostic == Diagnostic::Wind {
            let (pipeline, wind) = composite.wind(&self.device, variant, call.now)?;
            pass::draw(to.encoder, "wind", &pipeline, &[group, &wind], target);
        } else {
            let pipeline = composite.pipeline(&self.device, variant)?;
            let groups = [group, tables, self.surroundings.bind_group()];
            pass::draw(to.encoder, "diagnostic", pipeline, &groups, target);
        }
        to.passes += 1;
        to.ends(CostItem::Composition, true)
    }
}
