//! Falling snow of a view: the flakes that it draws for a scene and a camera.

use super::{
    candidates,
    contrast::FlakeContrast,
    lattice::Flakes,
    passes::{FlakeDraw, SnowPass},
    settings::{SnowModel, SnowSettings},
    stepped,
    uniforms::FlakesUniform,
};
use crate::{
    error::Result,
    falling::{drops, flakes::FlakeSizes},
    gpu::Device,
    moment::LightAround,
    particles::{
        FallingTexture, MovingAir, StreakCamera, begun_in_steps,
        stepping::{self, StepPass, Stepped},
    },
    stage::{
        Contribution, Diagnostic, DrawContext, DrawnEffect, Exchange, FrameBlock, FrameContext, MergedFrame, Output,
        Outputs, PutPart, Recording, Report, SnowReport, Stages, Texture,
    },
    surroundings::ShelterReach,
    weather::Falling,
    wind::Remembered,
};

/// Conditions that determine the number of flakes.
#[derive(Clone, Copy, PartialEq)]
struct Counted {
    falling: Falling,
    /// Temperature of the air, C.
    temperature_c: f64,
    /// Factor on fall speeds by the air's density ([`drops::factor_in`]).
    factor: f64,
    /// Share of the flakes that begin to fall above the camera's altitude, inside their cloud
    /// ([`crate::weather::Conditions::begun`]), rounded by [`begun_in_steps`].
    begun: f64,
    /// Largest number of drawn flakes.
    most: u32,
}

/// State that a view keeps for its flakes.
pub(crate) struct SnowView {
    pub settings: SnowSettings,
    /// Layer in front of the picture, shared by all that falls.
    layer: FallingTexture,
    pass: Option<Box<SnowPass>>,
    /// Conditions of the last count, and the flakes that it gave.
    counted: Option<Box<(Counted, Flakes)>>,
    /// Whether flakes fall at the camera and the settings allow their drawing.
    is_there: bool,
    /// Whether the pass counts how often pixels are drawn, instead of showing the flakes' light.
    counts: bool,
    /// Share of the flakes' opacity that the plan draws, 0 to 1.
    share: f32,
    /// Whether the layer already contains rain in this frame.
    over: bool,
    /// Whether flakes were stepped in the last frame.
    is_stepped: bool,
    /// Cache of the wind at earlier times. A step of the flakes needs the displacement of the air since the last step.
    last_wind: Remembered,
    /// Identifier of the last drawn frame, and the report of its snow.
    drawn: (u64, SnowReport),
}

impl SnowView {
    pub fn new(settings: SnowSettings, layer: FallingTexture) -> Self {
        Self {
            settings,
            layer,
            pass: None,
            counted: None,
            is_there: false,
            counts: false,
            share: 1.0,
            over: false,
            is_stepped: false,
            last_wind: Remembered::default(),
            drawn: (u64::MAX, SnowReport::default()),
        }
    }

    /// Returns the flakes of the last count; `None` before the first count.
    fn flakes(&self) -> Option<&Flakes> {
        self.counted.as_ref().map(|kept| &kept.1)
    }

    /// Returns whether the plan decides about the flakes.
    pub fn is_planned(&self) -> bool {
        self.settings.model == SnowModel::Automatic && self.is_there
    }

    /// Returns whether the plan keeps any flakes in this frame.
    fn is_kept(&self) -> bool {
        self.is_there && self.share > 0.0
    }

    /// Returns the contrast of the flakes in a picture, if the plan decides about them.
    pub fn contrast(&self, context: &DrawContext<'_>) -> Option<FlakeContrast> {
        let flakes = self.flakes().filter(|_| self.is_planned())?;
        let wind = context.now.carrying().ok()?.velocity_m_s();
        let light = (LightAround::of(&context.now.scene).exposed(context.target.exposure), context.tone());
        let camera = StreakCamera::new(context, self.settings.shutter_s, 1.0);
        Some(FlakeContrast::new((flakes, wind), &camera, light, context.now.has_lamps()))
    }
}

impl DrawnEffect for SnowView {
    fn composes(&self) -> Exchange {
        Exchange { needs: &[Output::Rain], gives: &[Output::Snow] }
    }

    fn gather(&mut self, context: &FrameContext<'_>, _given: &mut Outputs) -> Result<()> {
        self.counts = context.frame.diagnostic == Diagnostic::Overdraw;
        let scene = &context.now.scene;
        let c = &scene.conditions;
        let falling = c.precipitation;
        let begun = c.begun(scene.place.altitude_m);
        self.is_there = falling.snow_mm_h > 0.0 && begun > 0.0 && self.settings.model != SnowModel::Veil;
        if !self.is_there {
            return Ok(());
        }
        let counted = Counted {
            falling,
            temperature_c: c.air.temperature_c,
            factor: drops::factor_in(&c.air, c.air.station_altitude_m),
            begun: begun_in_steps(begun),
            most: self.settings.most_on(context.device),
        };
        if self.counted.as_ref().is_none_or(|kept| kept.0 != counted) {
            let sizes = FlakeSizes::new(&falling, counted.temperature_c, counted.factor);
            let flakes = Flakes::new(&sizes, counted.begun, counted.most);
            match &mut self.counted {
                Some(kept) => **kept = (counted, flakes),
                None => self.counted = Some(Box::new((counted, flakes))),
            }
        }
        self.is_there = self.flakes().is_some_and(|f| f.drawn > 0);
        Ok(())
    }

    fn stages(&self) -> Stages {
        if self.is_there { Stages::PARTICLES } else { Stages(0) }
    }

    fn hold(&mut self, device: &Device, color: &wgpu::Texture, stages: Stages) {
        if stages.has(Stages::PARTICLES) && self.is_kept() {
            let _ = self.layer.view(device, color.size());
        }
    }

    fn parts(&mut self, context: &DrawContext<'_>, stages: Stages, put: &mut PutPart<'_>) {
        let is_there = stages.has(Stages::PARTICLES) && self.is_planned();
        let flakes = if is_there { self.flakes().map_or(0, |f| f.drawn) } else { 0 };
        put(&candidates::SNOW, is_there, &candidates::snow_work(context.pixels(), flakes));
    }

    /// Fills in the contribution of snow to a draw: the extinction that flakes replace in the fog, the layer in front
    /// of the picture, and the reach within which shelters matter to flakes.
    fn compose(&mut self, context: &DrawContext<'_>, given: &Outputs, added: &mut Contribution) -> Result<()> {
        self.share = if self.is_planned() { context.share(&candidates::SNOW, 0) } else { 1.0 };
        self.over = given.before.is_some();
        let Some(flakes) = self.flakes().copied().filter(|_| self.is_there) else { return Ok(()) };
        let hidden = [flakes.hidden_per_m, flakes.hidden_m()].map(|v| v as f32);
        added.set_frame_block(FrameBlock::Snow { hidden, share: self.share });
        let is_drawn = self.is_kept() && context.stages.has(Stages::PARTICLES);
        if is_drawn {
            added.set_texture(Texture::Before, Some(self.layer.view(context.device, context.picture().size())));
        }
        if context.stages.has(Stages::SURFACE) || (is_drawn || self.over) && context.stages.has(Stages::PARTICLES) {
            added.set_near(ShelterReach { slowest_m_s: flakes.slowest_m_s(), reach_m: flakes.reach_m() });
        }
        Ok(())
    }

    fn draw(
        &mut self,
        context: &DrawContext<'_>,
        merged: &MergedFrame<'_>,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        if !merged.composition.stages().has(Stages::PARTICLES) || !self.is_kept() {
            return Ok(());
        }
        let Some(flakes) = self.flakes().copied() else { return Ok(()) };
        let now = context.now;
        let (wind, air) = (now.carrying()?, MovingAir::of(now)?);
        let light = LightAround::of(&now.scene).exposed(context.target.exposure);
        let camera = StreakCamera::new(context, self.settings.shutter_s, 1.0);
        let block = FlakesUniform { share: self.share, ..FlakesUniform::new(now.seed, &flakes, &light, &camera, &air) };
        let target = self.layer.view(recording.device, context.picture().size());
        if self.pass.as_ref().is_some_and(|pass| pass.counts() != self.counts) {
            self.pass = None;
        }
        let pass =
            self.pass.get_or_insert_with(|| Box::new(SnowPass::new(recording.device, recording.blocks, self.counts)));
        let is_pure = context.frame.is_pure();
        self.is_stepped = u64::from(flakes.drawn) <= StepPass::most(recording.device)
            && stepping::is_due(now, recording.device, flakes.reach_m(), self.is_stepped, is_pure);
        let carried = |from| wind.since(from, &self.last_wind);
        let stepped = self.is_stepped.then(|| Stepped {
            anew: is_pure,
            ..stepped::stepped((now.seed, &flakes), (&camera, &air), &carried, now.wind_texture(recording.device))
        });
        let drawn = FlakeDraw {
            block: &block,
            stepped: stepped.as_ref(),
            rays: context.target.rays,
            surroundings: merged.surroundings,
            maps: now.has_maps(),
            target: &target,
            over: self.over,
            depth: context.frame.depth_layer(),
        };
        pass.draw(recording, &drawn)?;
        self.drawn = (context.frame.frame_id, SnowReport { flakes: flakes.drawn, flakes_to_m: flakes.reach_m() });
        recording.passes += 1;
        Ok(())
    }

    /// Returns the bytes of GPU memory held, without the layer, which `RainView` counts.
    fn bytes(&self) -> u64 {
        self.pass.as_ref().map_or(0, |pass| pass.bytes())
    }

    fn report(&self, report: &mut Report) {
        if self.drawn.0 == report.frame_id {
            report.snow = self.drawn.1;
        }
    }

    fn forget_picture(&mut self) {
        self.layer.forget();
    }
}
