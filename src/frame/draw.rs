//! One draw of a view: from stages and moment to the composition's pass, what effects draw before it, and what is made of it.

use std::sync::Arc;

use super::{
    View,
    composite::Variant,
    draws::{DrawKey, Draws, PipelineNotReady},
    froxels::Froxels,
    kinds::Pixels,
    planned::{present, situation},
};
use crate::{
    effects::PARTS,
    error::Result,
    gpu::{Device, Layer},
    moment::Moment,
    plan::parts::{MOST_PARTS, MOST_RUNGS},
    scene::ViewRays,
    stage::{ColorSpace, Composition, CostItem, Drawing, Frame, Recording, Sampling, Shot, Stages, flag, uniform},
};

/// What the draws of one call have in common.
pub(super) struct Call<'a> {
    pub device: &'a Arc<Device>,
    pub frame: &'a Frame<'a>,
    pub now: &'a Moment<'a>,
    pub rays: &'a ViewRays,
    pub color: Layer<'a>,
    /// Display units per cd/m^2.
    pub exposure: f64,
    /// Fog and air lie before the picture in this call, or have been drawn in an earlier one of the frame.
    pub veiled: bool,
}

impl<'a> Call<'a> {
    /// As the effects see it, before the plan has chosen.
    pub(super) fn shot(&self) -> Shot<'a> {
        Shot {
            device: self.device,
            frame: self.frame,
            now: self.now,
            rays: self.rays,
            color: self.color,
            exposure: self.exposure,
            veiled: self.veiled,
            parts: PARTS,
            shares: [[1.0; MOST_RUNGS - 1]; MOST_PARTS],
            is_gauged: false,
        }
    }
}

impl View {
    /// Draws stages that neighbour each other into the host's picture.
    pub(super) fn draw(&mut self, call: &Call<'_>, stages: Stages, to: &mut Recording<'_>) -> Result<()> {
        let (frame, color) = (call.frame, call.color.texture);
        let tone = stages.has(Stages::TONE) && frame.color_space == ColorSpace::SceneLinear;
        let stages = if tone { stages } else { stages.without(Stages::TONE) };
        let drawn = stages.without(Stages::PREPARE.with(Stages::LENS));
        if drawn == Stages(0) {
            return Ok(());
        }
        self.report.exposure = call.exposure;
        let mut shot = call.shot();
        self.plan_frame(&mut shot, drawn);
        let block = uniform(frame, call.now, call.rays, color, call.exposure, tone);
        let mut composition = Composition::new(drawn, block);
        for effect in self.effects.each() {
            effect.compose(&shot, &mut composition)?;
        }
        composition.needs_panorama |= self.environment.is_some();
        let variant = self.variant(&shot, &mut composition)?;
        self.hold_copy(color)?;
        self.bind(&shot, &composition)?;
        composition.block.compositions = self.planner.compositions(self.effects.weighs_unseen());
        self.uniform.write(bytemuck::bytes_of(&composition.block));
        for effect in self.effects.each() {
            let with = Drawing { composition: &composition, block: &self.uniform, surroundings: &self.surroundings };
            effect.draw(&shot, &with, to)?;
        }
        self.take_picture(call.color, to)?;
        if composition.stages.has(Stages::MEDIUM) {
            let white = call.now.scene.ground.total_lux / std::f64::consts::PI;
            self.unit.watch(&self.device, to.encoder, frame, (white, self.recorded.has(Stages::BACKGROUND)));
        }
        self.compose(&shot, &composition, &variant, to)?;
        to.ends(CostItem::of(composition.stages), true)?;
        self.fill_environment(&shot, &composition, to)?;
        self.light_scale = match frame.color_space {
            ColorSpace::SceneLinear => (1.0 / (call.exposure * frame.cd_m2_per_unit)) as f32,
            ColorSpace::DisplayLinear | ColorSpace::DisplaySrgb => 1.0,
        };
        if stages.has(Froxels::STAGE) {
            self.fill_veil(&shot, &composition, to)?;
        }
        Ok(())
    }

    /// Plans the frame, once for all its draws, and gives a draw what the plan has chosen.
    pub(super) fn plan_frame(&mut self, shot: &mut Shot<'_>, stages: Stages) {
        let frame = shot.frame;
        if self.planned_for != Some(frame.frame_id) {
            self.planned_for = Some(frame.frame_id);
            self.planner.rebuild = self.effects.rebuild_work();
            let present = present(&mut self.effects, shot, stages);
            let here = situation(frame, &shot.now.scene);
            self.planner.begin(&self.device, &here, &present, frame.is_pure());
            self.report.prediction = self.planner.prediction();
        }
        shot.is_gauged = self.planner.budget().gauges();
        for (part, shares) in shot.shares.iter_mut().enumerate().take(PARTS.len()) {
            for (step, share) in shares.iter_mut().enumerate().take(PARTS[part].rungs.len() - 1) {
                *share = self.planner.drawn_share(part, step);
            }
        }
    }

    /// What the composition must be able to draw, with the constants that are the frame's own; and what is around it, brought up to
    /// date.
    pub(super) fn variant(&mut self, shot: &Shot<'_>, composition: &mut Composition) -> Result<Variant> {
        let (frame, color) = (shot.frame, shot.color.texture);
        let stages = composition.stages;
        let kinds = f64::from(shot.rays.depth_kinds());
        composition.between("DEPTH_KINDS", kinds, kinds);
        let block = &composition.block;
        let target = [
            ("COLOR_SPACES", f64::from(1u32 << block.color_space)),
            ("ENCODES", f64::from(block.encode)),
            ("DITHERS", flag(block.dither_step > 0.0)),
        ];
        let curve = f64::from(1u32 << block.tone);
        target.into_iter().for_each(|(name, value)| composition.constant(name, value, value));
        composition.constant("CURVES", 7.0, curve);
        let mut around = Default::default();
        if stages.has(Stages::SURFACE.with(Stages::PARTICLES)) {
            let host = shot.now.host_surroundings(composition.near, shot.exposure)?;
            self.surroundings.update(&self.device, &host);
            around = if stages.has(Stages::SURFACE) { host.present() } else { around };
        }
        for (name, is_there) in [("SHELTER", around.shelter), ("MAPS", around.maps), ("LAMPS", around.lamps)] {
            composition.constant(name, flag(is_there), flag(is_there));
        }
        Ok(Variant {
            stages,
            format: color.format(),
            samples: color.sample_count(),
            sampling: Sampling::of(color, frame.depth),
            images: [frame.depth, frame.mask, frame.surface_classes, frame.normals].map(|image| image.is_some()),
            constants: composition.whole,
            pixels: Pixels::All,
        })
    }

    /// The pass over the picture; and the gauge of all of it, if one is due.
    fn compose(
        &mut self,
        shot: &Shot<'_>,
        composition: &Composition,
        whole: &Variant,
        to: &mut Recording<'_>,
    ) -> Result<()> {
        let (Some((_, group)), Some((_, tables))) = (&self.bound, &composition.tables) else { return Ok(()) };
        let target = self.target.of(shot.color, Layer::view);
        let groups = [group, tables, self.surroundings.bind_group()];
        // A GPU branches over what is not drawn; a pipeline of its own would cost it a hitch.
        let splits = self.device.caps().software;
        let constants = if splits { &composition.least } else { &composition.whole };
        let has_grid = self.even.is_some();
        // A pure picture does not depend on how many frames were drawn before it.
        let how = (splits, splits || shot.frame.is_pure());
        let make = || {
            let drawn = DrawKey { of: Variant { constants: *constants, ..*whole }, has_grid };
            let draws = Draws::new(&self.device, &mut *self.composite.lock()?, &drawn, how)?;
            Ok((drawn, draws))
        };
        let held = (self.kinds.as_ref(), self.even.as_ref());
        to.passes += match self.draws.get_or_make(|drawn| drawn.is(whole, constants, has_grid), make) {
            Ok(draws) => draws.record(to.encoder, held, &groups, target),
            Err(PipelineNotReady::Coming(draws)) => draws.record(to.encoder, held, &groups, target),
            Err(PipelineNotReady::Failed(error)) => return Err(error),
        };
        if !composition.stages.has(Stages::MEDIUM) {
            return Ok(());
        }
        let here = situation(shot.frame, &shot.now.scene);
        let effects = &mut self.effects;
        if let Some(gauge) = self.planner.due(&here, || effects.unseen(shot)) {
            let [_, (shader, _)] = whole.sampling.shaders();
            let composite = self.composite.lock()?;
            let layouts = composite.layouts(whole.sampling);
            gauge.record(&self.device, to.encoder, (shader, whole.constants().all()), &layouts, &groups)?;
            to.passes += 1;
        }
        Ok(())
    }

    /// Fills the textures of the veil for the host's own shaders, if it has asked for them.
    fn fill_veil(&mut self, shot: &Shot<'_>, composition: &Composition, to: &mut Recording<'_>) -> Result<()> {
        let (Some(froxels), Some((_, group)), Some((_, tables))) =
            (&mut self.froxels, &self.bound, &composition.tables)
        else {
            return Ok(());
        };
        let with = Drawing { composition, block: &self.uniform, surroundings: &self.surroundings };
        let own = self.effects.each().into_iter().find_map(|effect| effect.veil(shot, &with));
        let (composite, of_veil) = (self.composite.lock()?, composition.whole.of_veil);
        match &own {
            Some((shader, layout, own)) => {
                // That of an effect has no colour in it.
                let several = shot.frame.depth_layer().is_some_and(Layer::is_multisampled);
                let sampling = if several { Sampling::Multi } else { Sampling::Single };
                let layouts = [layout, composite.layouts(sampling)[1]];
                froxels.draw(to, (shader, sampling, of_veil), &layouts, &[own, tables])?;
            }
            None => {
                let sampling = Sampling::of(shot.color.texture, shot.frame.depth);
                let groups = [group, tables, self.surroundings.bind_group()];
                froxels.draw(to, (Froxels::SHADER, sampling, of_veil), &composite.layouts(sampling), &groups)?;
            }
        }
        to.passes += 1;
        to.ends(CostItem::Veil, true)
    }
}
