//! One draw of a view: from stages and scene to the composition's pass, what lies before it, and what is made of it.

use super::{
    ColorSpace, Frame, FrameFlags, View,
    composite::Variant,
    froxels::Froxels,
    measure::{Effect, Recording},
    planned::{self, AIR, FOG, RAIN, SKY, situation},
    surface,
    target::{Sampling, Stages},
    uniform::uniform,
};
use crate::{
    context::{Context, Scene},
    error::Result,
    fog::{FogKind, FogModel, FogVariant},
    gpu::{Layer, pass},
    scene::ViewRays,
};

/// What a draw is of.
pub(super) struct Shot<'a> {
    pub context: &'a Context,
    pub frame: &'a Frame<'a>,
    pub scene: &'a Scene,
    pub rays: &'a ViewRays,
    pub color: Layer<'a>,
    /// Display units per cd/m^2.
    pub exposure: f64,
}

impl View {
    /// Draws stages that neighbour each other into the host's picture.
    pub(super) fn draw(&mut self, at: &Shot<'_>, stages: Stages, to: &mut Recording<'_>) -> Result<()> {
        let Shot { context, frame, scene, .. } = *at;
        let tone = stages.has(Stages::TONE) && frame.color_space == ColorSpace::SceneLinear;
        let stages = if tone { stages } else { stages.without(Stages::TONE) };
        let fog = scene.fog_model(context.fog_law(), context.seed(), context.planet_radius_m())?;
        let mut variant = self.variant(at, stages, &fog);
        if variant.stages == Stages(0) {
            return Ok(());
        }
        self.report.exposure = at.exposure;
        self.plan_frame(at, &variant);
        let [air, fog_drawn, sky] = [AIR, FOG, SKY].map(|part| self.planner.drawn(part, 0));
        let drawn = [air, fog_drawn, sky, 1.0];
        self.bind_picture(at, &mut variant)?;
        self.upload(at, &mut variant, &fog, (tone, drawn))?;
        self.draw_falling(at, &variant.reduced(drawn), to)?;
        self.take_picture(at.color, to)?;
        if variant.stages.has(Stages::MEDIUM) {
            let white = scene.ground.total_lux / std::f64::consts::PI;
            self.unit.watch(&self.device, to.encoder, frame, (white, self.recorded.has(Stages::BACKGROUND)));
        }
        // A GPU branches over what is not drawn; a pipeline of its own would cost it a hitch.
        let least = if self.device.caps().software { variant.reduced(drawn) } else { variant };
        self.compose(at, &variant, least, to)?;
        to.ends(Effect::of(variant.stages), true)?;
        self.light_scale = match frame.color_space {
            ColorSpace::SceneLinear => (1.0 / (at.exposure * frame.cd_m2_per_unit)) as f32,
            ColorSpace::DisplayLinear | ColorSpace::DisplaySrgb => 1.0,
        };
        if stages.has(Froxels::STAGE) {
            self.fill_veil(at, &variant, to)?;
        }
        Ok(())
    }

    /// What the composition must be able to draw, with all parts.
    fn variant(&self, at: &Shot<'_>, stages: Stages, fog: &FogModel) -> Variant {
        let (frame, color) = (at.frame, at.color.texture);
        Variant {
            stages: stages.without(Stages::PREPARE.with(Stages::LENS)),
            format: color.format(),
            samples: color.sample_count(),
            sampling: Sampling::of(color, frame.depth),
            has_depth: frame.depth.is_some(),
            has_mask: frame.mask.is_some(),
            has_classes: frame.surface_classes.is_some(),
            has_normals: frame.normals.is_some(),
            // A GPU keeps one pipeline for all fogs: exchanging it would cost a hitch when the weather changes.
            fog: (fog.kind != FogKind::Clear)
                .then(|| if self.device.caps().software { fog.variant() } else { FogVariant::ALL }),
            depth_kinds: at.rays.depth_kinds(),
            march: at.context.marches_sky(),
            terrain: false,
            around: Default::default(),
            air: true,
            sky: true,
        }
    }

    /// Plans the frame, once for all its draws.
    fn plan_frame(&mut self, at: &Shot<'_>, variant: &Variant) {
        let Shot { frame, scene, .. } = *at;
        if self.planned_for != Some(frame.frame_id) {
            self.planned_for = Some(frame.frame_id);
            let rain = variant.stages.has(Stages::PARTICLES) && self.rain.is_planned();
            let parts = [
                variant.has_depth && variant.stages.has(Stages::MEDIUM),
                variant.fog.is_some() && variant.stages.has(Stages::MEDIUM),
                variant.stages.has(Stages::BACKGROUND),
                rain,
            ];
            let pixels = u64::from(at.color.texture.width()) * u64::from(at.color.texture.height());
            let drops = if rain { self.rain.drops(&self.device, scene) } else { 0 };
            let present = planned::present(parts, pixels, 1 + u32::from(scene.moon.matters), drops);
            let pure = frame.flags.has(FrameFlags(FrameFlags::NO_HISTORY.0 | FrameFlags::CUT.0));
            self.planner.begin(&self.device, &situation(frame, scene), &present, pure);
            self.report.prediction = self.planner.prediction();
        }
        self.rain.follow([1, 0].map(|rung| self.planner.drawn(RAIN, rung)));
    }

    /// Binds the host's picture and the layers that lie on and before it.
    fn bind_picture(&mut self, at: &Shot<'_>, variant: &mut Variant) -> Result<()> {
        let color = at.color.texture;
        let drops = self.rain.draws().then(|| self.rain.layer(&self.device, color).clone());
        if drops.is_none() {
            variant.stages = variant.stages.without(Stages::PARTICLES);
        }
        let [water, terrain] = at.context.terrain_views(variant.stages.has(Stages::SURFACE));
        self.hold_copy(color)?;
        self.bind(at.frame, at.color, [drops, water, terrain])
    }

    /// Brings the blocks up that the shaders read.
    fn upload(
        &mut self,
        at: &Shot<'_>,
        variant: &mut Variant,
        fog: &FogModel,
        (tone, drawn): (bool, [f32; 4]),
    ) -> Result<()> {
        let Shot { context, frame, scene, .. } = *at;
        let color = at.color.texture;
        let mut block = uniform(frame, scene, at.rays, color, at.exposure, context, (tone, drawn));
        if self.rain.shows() {
            (block.drops, block.drawn[3]) = self.rain.hidden(&self.device, context, scene);
        }
        block.compositions = self.planner.compositions(self.rain.is_planned());
        self.device.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&block));
        if variant.fog.is_some() {
            self.device.queue.write_buffer(&self.fog, 0, bytemuck::bytes_of(&fog.uniform()));
        }
        if variant.stages.has(Stages::SURFACE.with(Stages::PARTICLES)) {
            let near = self.rain.slowest_and_reach(&self.device, scene);
            let told = surface::around(context, scene, frame, near, at.exposure)?;
            self.around.follow(&self.device, &told);
            if variant.stages.has(Stages::SURFACE) {
                variant.around = told.present();
                variant.terrain = context.ground_grid().is_some();
            }
        }
        if variant.stages.has(Stages::SURFACE) {
            let block = surface::uniform(frame, color, context, scene, fog)?;
            self.device.queue.write_buffer(&self.ground, 0, bytemuck::bytes_of(&block));
        }
        Ok(())
    }

    /// Draws the layer before the picture: columns of rain areas, and what falls near the camera.
    fn draw_falling(&mut self, at: &Shot<'_>, variant: &Variant, to: &mut Recording<'_>) -> Result<()> {
        if !variant.stages.has(Stages::PARTICLES) {
            return Ok(());
        }
        let Shot { context, frame, scene, rays, .. } = *at;
        let color = at.color.texture;
        let (shared, blocks) = ((&self.device, &*self.shared), [&self.uniform, &self.fog]);
        let constants = variant.veil_constants();
        let layer = (&mut *to.encoder, frame, color);
        let over = self.rain.draw_areas(shared, layer, (context, scene), (blocks, &self.sky), &constants)?;
        let with = (at.exposure, over, &self.around);
        let layer = (&mut *to.encoder, frame, color);
        self.report.rain = self.rain.draw(&self.device, layer, (context, scene, rays), with)?;
        self.report.passes += 1 + u32::from(over);
        Ok(())
    }

    /// The one full-screen draw, by the pipeline of `least`; and the gauge of all of it, if one is due.
    fn compose(&mut self, at: &Shot<'_>, variant: &Variant, least: Variant, to: &mut Recording<'_>) -> Result<()> {
        let Shot { context, frame, scene, rays, .. } = *at;
        let Some((_, group, target)) = &self.bound else { return Ok(()) };
        let mut composite = self.shared.composite()?;
        let pipeline = composite.pipeline(&self.device, least)?;
        let groups = [group, self.sky.bind_group(), self.around.bind_group()];
        pass::draw(to.encoder, "composite", pipeline, &groups, target);
        self.report.passes += 1;
        if variant.stages.has(Stages::MEDIUM)
            && let Some(gauge) = self.planner.due(&situation(frame, scene), || {
                let picture = (frame, at.color.texture.height(), at.exposure);
                self.rain.streaks(&self.device, picture, (context, scene, rays))
            })
        {
            let [_, (shader, _)] = variant.sampling.shaders();
            let (constants, layouts) = (variant.constants(), composite.layouts(variant.sampling));
            gauge.record(&self.device, to.encoder, (shader, &constants), &layouts, &groups)?;
            self.report.passes += 1;
        }
        Ok(())
    }

    /// Fills the textures of the veil for the host's own shaders, if it has asked for them.
    fn fill_veil(&mut self, at: &Shot<'_>, variant: &Variant, to: &mut Recording<'_>) -> Result<()> {
        let (Some(froxels), Some((_, group, _))) = (&mut self.froxels, &self.bound) else { return Ok(()) };
        let Shot { context, frame, scene, .. } = *at;
        let groups = [group, self.sky.bind_group(), self.around.bind_group()];
        let areas = self.rain.veiling_areas(&self.device, frame, (context, scene), [&self.uniform, &self.fog]);
        let own = areas.map(|(_, group)| [group, self.sky.bind_group()]);
        // That of areas has no colour in it.
        let several = frame.depth_layer().is_some_and(Layer::is_multisampled);
        let sampling = match areas {
            Some(_) if several => Sampling::Multi,
            Some(_) => Sampling::Single,
            None => variant.sampling,
        };
        let variant = (sampling, variant.fog.is_some(), variant.march);
        let groups = (areas.map(|(layout, _)| layout), own.as_ref().map_or(&groups[..], |g| &g[..]));
        froxels.draw(&self.device, &self.shared, to.encoder, variant, groups)?;
        self.report.passes += 1;
        to.ends(Effect::Veil, true)
    }
}
