//! One draw of a view: the effects' passes before the composition, the composition, and after it the host's cube map
//! and veil.

use super::{
    froxels::{FroxelKind, Froxels},
    pixels::{
        draws::{DrawKey, Draws, PipelineNotReady},
        pixel_kind::Pixels,
        variant::Variant,
    },
    planned::{present, situation},
    view::View,
};
use crate::{
    effects::PARTS,
    error::Result,
    gpu::Layer,
    stage::{
        ColorSpace, Composition, CostItem, DrawContext, DrawTarget, FrameContext, FrameValues, MergedFrame,
        PlannedShares, Recording, Sampling, Stages, flag, uniform,
    },
};

/// Returns the frame's uniform block for a draw. `tone` says whether the whole picture is tone-mapped.
pub(super) fn frame_block(context: &DrawContext<'_>, tone: bool) -> FrameValues {
    let target = &context.target;
    uniform(context.frame, context.now, target.rays, context.picture(), target.exposure, tone)
}

impl View {
    /// Draws consecutive stages into the host's picture.
    pub(super) fn draw<'a>(
        &mut self,
        frame_context: &FrameContext<'a>,
        target: DrawTarget<'a>,
        stages: Stages,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        let frame = frame_context.frame;
        let tone = stages.has(Stages::TONE) && frame.color_space == ColorSpace::SceneLinear;
        let stages = if tone { stages } else { stages.without(Stages::TONE) };
        let drawn = stages.without(Stages::PREPARE.with(Stages::LENS));
        if drawn == Stages(0) {
            return Ok(());
        }
        self.history.report.exposure = target.exposure;
        let context = self.planned(frame_context, target, drawn);
        let mut composition = Composition::new(context.stages, frame_block(&context, tone));
        self.compose_effects(&context, &mut composition, self.cache.environment.is_some())?;
        let variant = self.variant(&context, &mut composition)?;
        composition.set_compositions(self.planner.compositions(self.effects.weighs_unseen()));
        self.draw_effects(&context, &composition, recording)?;
        if composition.stages().has(Stages::MEDIUM) {
            let white = frame_context.now.scene.ground.total_lux / std::f64::consts::PI;
            self.history.unit.watch(
                &self.device,
                recording.encoder,
                frame,
                (white, self.history.recorded.has(Stages::BACKGROUND)),
            );
        }
        self.compose(&context, &composition, &variant, recording)?;
        recording.ends(CostItem::of(composition.stages()), true)?;
        self.fill_environment(&context, &composition, recording)?;
        self.history.light_scale = match frame.color_space {
            ColorSpace::SceneLinear => (1.0 / (target.exposure * frame.cd_m2_per_unit)) as f32,
            ColorSpace::DisplayLinear | ColorSpace::DisplaySrgb => 1.0,
        };
        if stages.has(Froxels::STAGE) {
            self.fill_veil(&context, &composition, recording)?;
        }
        Ok(())
    }

    /// Merges the contributions of all effects into `composition`. The merging is done in place because a composition
    /// is large. `has_cube_map` says whether the host has asked for the cube map.
    pub(super) fn compose_effects(
        &mut self,
        context: &DrawContext<'_>,
        composition: &mut Composition,
        has_cube_map: bool,
    ) -> Result<()> {
        self.effects.compose(context, composition)?;
        composition.finish(has_cube_map);
        Ok(())
    }

    /// Draws the passes of the effects, and copies the picture for the composition to read.
    pub(super) fn draw_effects(
        &mut self,
        context: &DrawContext<'_>,
        composition: &Composition,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        self.hold_copy(context.picture())?;
        self.bind(context, composition)?;
        composition.write_block(&mut self.cache.uniform);
        let merged = MergedFrame { composition, block: &self.cache.uniform, surroundings: &self.cache.surroundings };
        self.effects.draw(context, &merged, recording)?;
        self.take_picture(context.target.color, recording)
    }

    /// Plans the frame, once for all its draws, and returns the context of a draw with the plan's choices.
    pub(super) fn planned<'a>(
        &mut self,
        frame_context: &FrameContext<'a>,
        target: DrawTarget<'a>,
        stages: Stages,
    ) -> DrawContext<'a> {
        let (frame, now) = (frame_context.frame, frame_context.now);
        let mut context =
            DrawContext { device: frame_context.device, frame, now, target, stages, plan: PlannedShares::whole(PARTS) };
        // A rehearsal draws every part, and its pictures do not enter the plan.
        if self.rehearses() {
            return context;
        }
        if self.history.planned_for != Some(frame.frame_id) {
            self.history.planned_for = Some(frame.frame_id);
            self.planner.rebuild = self.effects.rebuild_work();
            let present = present(&mut self.effects, &context, stages);
            let here = situation(frame, &now.scene);
            self.planner.begin(&self.device, &here, &present, frame.is_pure());
            self.history.report.prediction = self.planner.prediction();
        }
        let is_gauged = self.planner.budget().gauges();
        context.plan = PlannedShares::new(PARTS, is_gauged, |part, step| self.planner.drawn_share(part, step));
        context
    }

    /// Returns the variant that the composition needs, and sets the frame's own constants in the composition. If
    /// surfaces or particles are drawn, updates the block of the host's surroundings.
    pub(super) fn variant(&mut self, context: &DrawContext<'_>, composition: &mut Composition) -> Result<Variant<()>> {
        let (frame, color) = (context.frame, context.picture());
        let stages = composition.stages();
        composition.set_between("DEPTH_KINDS", f64::from(context.target.rays.depth_kinds()));
        let block = composition.block();
        let target = [
            ("COLOR_SPACES", f64::from(1u32 << block.color_space)),
            ("ENCODES", f64::from(block.encode)),
            ("DITHERS", flag(block.dither_step > 0.0)),
        ];
        let curve = f64::from(1u32 << block.tone);
        target.into_iter().for_each(|(name, value)| composition.set_constant(name, value, value));
        composition.set_constant("CURVES", 7.0, curve);
        let mut around = Default::default();
        if stages.has(Stages::SURFACE.with(Stages::PARTICLES)) {
            let host = context.now.host_surroundings(composition.near(), context.target.exposure)?;
            self.cache.surroundings.update(&self.device, &host);
            around = if stages.has(Stages::SURFACE) { host.present() } else { around };
        }
        for (name, is_there) in [("SHELTER", around.shelter), ("MAPS", around.maps), ("LAMPS", around.lamps)] {
            composition.set_constant(name, flag(is_there), flag(is_there));
        }
        Ok(Variant {
            stages,
            format: color.format(),
            samples: color.sample_count(),
            sampling: Sampling::of(color, frame.depth),
            images: [frame.depth, frame.mask, frame.surface_classes, frame.normals].map(|image| image.is_some()),
            constants: (),
            pixels: Pixels::All,
        })
    }

    /// Draws the composition over the picture. Then draws the gauge, with every part of the weather, if one is due and
    /// the stages include MEDIUM. A rehearsal has no gauge.
    fn compose(
        &mut self,
        context: &DrawContext<'_>,
        composition: &Composition,
        variant: &Variant<()>,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        let (Some((_, group)), Some((_, tables))) = (&self.cache.bound, &composition.tables()) else { return Ok(()) };
        let target = self.cache.target.of(context.target.color, Layer::view);
        let groups = [group, tables, self.cache.surroundings.bind_group()];
        // On a GPU, branches skip the parts that are not drawn. Compiling another pipeline without these parts would
        // delay a frame.
        let splits = self.device.caps().software;
        let constants = if splits { composition.least() } else { composition.whole() };
        let has_grid = self.cache.even.is_some();
        // A picture without history compiles all its pipelines at once, so that it does not depend on the number of
        // frames drawn before it.
        let how = (splits, splits || context.frame.is_pure());
        let make = || {
            let drawn = DrawKey { of: variant.with(constants), has_grid };
            let draws = Draws::new(&self.device, &mut *self.cache.composite.lock()?, &drawn, how)?;
            Ok((drawn, draws))
        };
        let held = (self.cache.kinds.as_ref(), self.cache.even.as_ref());
        recording.passes += match self.cache.draws.get_or_make(|drawn| drawn.is(variant, constants, has_grid), make) {
            Ok(draws) => draws.record(recording.encoder, held, &groups, target),
            Err(PipelineNotReady::Coming(draws)) => draws.record(recording.encoder, held, &groups, target),
            Err(PipelineNotReady::Failed(error)) => return Err(error),
        };
        if !composition.stages().has(Stages::MEDIUM) || self.rehearses() {
            return Ok(());
        }
        let here = situation(context.frame, &context.now.scene);
        let effects = &mut self.effects;
        if let Some(gauge) = self.planner.due(&here, || effects.unseen(context)) {
            let [_, (shader, _)] = variant.sampling.shaders();
            let composite = self.cache.composite.lock()?;
            let layouts = composite.layouts(variant.sampling);
            let whole = variant.with(composition.whole());
            gauge.record(&self.device, recording.encoder, (shader, whole.constants().all()), &layouts, &groups)?;
            recording.passes += 1;
        }
        Ok(())
    }

    /// Fills the veil's textures for the host's own shaders, if the host has asked for these textures.
    fn fill_veil(
        &mut self,
        context: &DrawContext<'_>,
        composition: &Composition,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        let (Some(froxels), Some((_, group)), Some((_, tables))) =
            (&mut self.cache.froxels, &self.cache.bound, &composition.tables())
        else {
            return Ok(());
        };
        let merged = MergedFrame { composition, block: &self.cache.uniform, surroundings: &self.cache.surroundings };
        let own = self.effects.each().into_iter().find_map(|effect| effect.veil(context, &merged));
        let (composite, of_veil) = (self.cache.composite.lock()?, composition.whole().of_veil);
        match &own {
            Some((shader, layout, own)) => {
                // An effect's own veil shader does not read the colour, so only depth's samples matter.
                let several = context.frame.depth_layer().is_some_and(Layer::is_multisampled);
                let sampling = if several { Sampling::Multi } else { Sampling::Single };
                let layouts = [layout, composite.layouts(sampling)[1]];
                let kind = FroxelKind { shader, sampling, constants: of_veil };
                froxels.draw(recording, kind, &layouts, &[own, tables])?;
            }
            None => {
                let sampling = Sampling::of(context.picture(), context.frame.depth);
                let groups = [group, tables, self.cache.surroundings.bind_group()];
                let kind = FroxelKind { shader: Froxels::SHADER, sampling, constants: of_veil };
                froxels.draw(recording, kind, &composite.layouts(sampling), &groups)?;
            }
        }
        recording.passes += 1;
        recording.ends(CostItem::Veil, true)
    }
}
