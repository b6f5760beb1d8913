//! A view: one camera or projector channel, with what it keeps between frames.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use super::{
    Frame, FrameFlags,
    check::rays,
    composite::Variant,
    froxels::{FrameTextures, Froxels},
    measure::{Effect, Recording, Report},
    picture::Bound,
    pipelines::Pipelines,
    planned::{self, AIR, FOG, RAIN, SKY, situation},
    rain::Rain,
    surface,
    target::{ColorSpace, Sampling, Stages, can_be_apart, can_copy},
    uniform::{FrameUniform, uniform},
    unit::UnitWatch,
};
use crate::{
    context::{Context, Scene},
    error::{Error, Result},
    fog::{FogKind, FogUniform, FogVariant},
    glass::Glass,
    gpu::{Device, Layer},
    ground::GroundUniform,
    plan::Planner,
    rain::{RainSettings, Streaks},
    scene::ViewRays,
    sky::SkyVolume,
    surroundings::Around,
};

/// One camera or projector channel. Exclusive: one thread at a time.
pub struct View {
    pub(super) device: Arc<Device>,
    pub(super) shared: Arc<Pipelines>,
    pub(super) uniform: wgpu::Buffer,
    pub(super) fog: wgpu::Buffer,
    pub(super) ground: wgpu::Buffer,
    pub(super) copy: Option<wgpu::Texture>,
    pub(super) bound: Option<(Bound, wgpu::BindGroup, wgpu::TextureView)>,
    pub(super) glass: Option<Box<Glass>>,
    pub(super) sky: SkyVolume,
    pub(super) froxels: Option<Froxels>,
    pub(super) rain: Rain,
    around: Around,
    pub(super) planner: Planner<Streaks>,
    planned_for: Option<u64>,
    light_scale: f32,
    unit: UnitWatch,
    pub(super) recorded: Stages,
    pub(super) report: Report,
    /// What the last measured call took, its wait for earlier work included.
    last_call: Option<Duration>,
}

impl View {
    /// Makes a view of `context`.
    ///
    /// # Errors
    /// [`crate::Status::DeviceLost`], or a GPU fault.
    pub fn new(context: &Context) -> Result<Self> {
        let device = context.device().clone();
        let _entered = device.enter()?;
        let buffer = |label, size: usize| {
            device.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: size as u64,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let (uniform, fog) = (buffer("frame", size_of::<FrameUniform>()), buffer("fog", size_of::<FogUniform>()));
        let ground = buffer("ground", size_of::<GroundUniform>());
        let shared = context.shared().get(|| Pipelines::new(&device))?;
        let sky = SkyVolume::new(&*context.sky()?)?;
        let planner = Planner::new(planned::PARTS, planned::rebuild_work(sky.settings()));
        let rain = Rain::new(&device, RainSettings::default());
        let around = Around::new(&device.device);
        device.check_made()?;
        drop(_entered);
        Ok(Self {
            device,
            shared,
            uniform,
            fog,
            ground,
            copy: None,
            bound: None,
            glass: None,
            sky,
            froxels: None,
            rain,
            around,
            planner,
            planned_for: None,
            light_scale: 0.0,
            unit: UnitWatch::default(),
            recorded: Stages(0),
            report: Report { frame_id: u64::MAX, ..Default::default() },
            last_call: None,
        })
    }

    /// What the last frame took and showed.
    pub fn report(&self) -> &Report {
        &self.report
    }

    /// Sets how rain is drawn. Default: [`RainSettings::default`].
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field and its range; nothing changes then.
    pub fn set_rain(&mut self, settings: RainSettings) -> Result<()> {
        settings.validate_on(&self.device)?;
        self.rain.settings = settings;
        Ok(())
    }

    /// Textures of air and fog for the host's own transparent shaders, filled by [`Stages::MEDIUM`] of every frame from
    /// the first call of this function on.
    ///
    /// # Errors
    /// [`crate::Status::DeviceLost`], or a GPU fault.
    pub fn frame_textures(&mut self) -> Result<FrameTextures> {
        let device = self.device.clone();
        let _entered = device.enter()?;
        let froxels = match &self.froxels {
            Some(froxels) => froxels,
            None => {
                let froxels = Froxels::new(&device);
                device.check_made()?;
                self.froxels.insert(froxels)
            }
        };
        let (light, through) = (froxels.light.clone(), froxels.through.clone());
        Ok(FrameTextures { light, through, light_scale: self.light_scale })
    }

    /// Records the stages of a frame and submits them: when it returns, the work is on the device's queue.
    ///
    /// The calls of one frame share `frame.frame_id` and come in the order of the stages; a new id begins a new frame.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] and [`crate::Status::Unsupported`] naming the field, [`crate::Status::WrongOrder`] if
    /// a stage comes twice or late, [`crate::Status::DeviceLost`]. After an error nothing was drawn by this call.
    pub fn record(&mut self, context: &Context, frame: &Frame<'_>, stages: Stages) -> Result<()> {
        let device = self.device.clone();
        self.check_call(frame, stages)?;
        self.check_images(frame, stages)?;
        let _entered = device.enter()?;
        let recorded = self.recorded_of(frame.frame_id);
        self.record_and_submit(context, frame, stages, &device).inspect_err(|_| self.take_back(recorded))
    }

    /// The stages that were recorded of a frame so far, for [`View::take_back`].
    pub(crate) fn recorded_of(&self, frame_id: u64) -> Stages {
        if frame_id == self.report.frame_id { self.recorded } else { Stages(0) }
    }

    /// After a call that failed once it was recorded: the frame has the stages that it had before, so that the host may record
    /// it again, and nothing is kept that there may have been no memory for.
    pub(crate) fn take_back(&mut self, recorded: Stages) {
        self.recorded = recorded;
        self.forget_images();
    }

    /// Lets go what the view holds of the picture's size.
    fn forget_images(&mut self) {
        (self.bound, self.copy) = (None, None);
        self.rain.forget_picture();
    }

    /// Makes what the view needs of the picture's size, before anything of the frame is recorded: a large target is what memory
    /// may be too small for.
    fn hold_images(&mut self, frame: &Frame<'_>, stages: Stages) -> Result<()> {
        let Some(color) = frame.color else { return Ok(()) };
        let (made, bytes) = (self.hold_copy(color)?, self.rain.bytes());
        if stages.has(Stages::PARTICLES) && self.rain.draws() {
            let _ = self.rain.layer(&self.device, color);
        }
        if made || self.rain.bytes() != bytes { self.device.check_made() } else { Ok(()) }
    }

    fn record_and_submit(
        &mut self,
        context: &Context,
        frame: &Frame<'_>,
        stages: Stages,
        device: &Arc<Device>,
    ) -> Result<()> {
        let mut encoder =
            device.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("welkin") });
        let mut to = Recording::new(device, &mut encoder);
        if frame.flags.has(FrameFlags::MEASURE) {
            let so_far = if frame.frame_id == self.report.frame_id { self.report.costs } else { None };
            to.measure(so_far.unwrap_or_default())?;
        }
        self.record_stages(context, frame, stages, &mut to)?;
        if let Some((costs, inside)) = to.costs() {
            self.report.costs = Some(costs);
            self.last_call = Some(inside);
        }
        device.submit(encoder);
        device.check_made()
    }

    /// Counts what a measured call that began at `start` took beyond its recording: the host's context and images came
    /// and went.
    pub(crate) fn add_hand_over(&mut self, start: Instant) {
        if let (Some(costs), Some(inside)) = (&mut self.report.costs, self.last_call) {
            let ms = (start.elapsed().saturating_sub(inside)).as_secs_f64() * 1e3;
            costs.add(Effect::HandOver, ms);
            costs.whole_ms += ms;
        }
    }

    /// As [`View::record`], into a Rust host's own encoder; the host submits.
    ///
    /// # Errors
    /// As [`View::record`]; [`crate::Status::Unsupported`] with `MEASURE`: timing needs the submission, which the host makes here.
    pub fn record_into(
        &mut self,
        context: &Context,
        frame: &Frame<'_>,
        stages: Stages,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<()> {
        if frame.flags.has(FrameFlags::MEASURE) {
            return Err(Error::unsupported(
                "flags MEASURE where the host submits, or lends its images for one submission: measure there by the host's own \
                 timestamps",
            ));
        }
        if frame.color.is_some_and(|c| !can_copy(c)) {
            return Err(Error::unsupported(
                "color without COPY_SRC where the host submits: the picture is read between submissions; use record",
            ));
        }
        self.check_call(frame, stages)?;
        self.check_images(frame, stages)?;
        let device = self.device.clone();
        let recorded = self.recorded_of(frame.frame_id);
        self.record_stages(context, frame, stages, &mut Recording::new(&device, encoder))
            .inspect_err(|_| self.take_back(recorded))
    }

    fn record_stages(
        &mut self,
        context: &Context,
        frame: &Frame<'_>,
        stages: Stages,
        to: &mut Recording<'_>,
    ) -> Result<()> {
        let scene = context.scene_named("frame.camera.position", frame.camera.position, context.time_s())?;
        let rays = stages.draw().then(|| rays(frame, &scene)).transpose()?;
        // What does not fall is not drawn, nor what is dry.
        let asked = stages;
        self.rain.look(context, &scene, frame.camera.position)?;
        let stages = if self.rain.shows() { stages } else { stages.without(Stages::PARTICLES) };
        let stages = if surface::is_wet(frame, context, &scene) { stages } else { stages.without(Stages::SURFACE) };
        let stages = if self.glass.is_some() { stages } else { stages.without(Stages::LENS) };
        let rays = rays.filter(|_| stages.draw());
        if frame.frame_id != self.report.frame_id {
            self.report = Report { frame_id: frame.frame_id, bytes: self.report.bytes, ..Default::default() };
            self.recorded = Stages(0);
        }
        if rays.is_some() {
            self.hold_images(frame, stages)?;
        }
        if self.recorded == Stages(0) {
            self.prepare(context, frame, &scene, to)?;
            self.prepare_lens(context, frame, &scene, to)?;
        }
        self.rain.veiled = self.recorded.with(asked).has(Stages::MEDIUM);
        if let Some(rays) = rays {
            // The glass lies before the tone curve, where the target can hold the picture between them.
            let mut lens = self.shows_lens(stages);
            let two = |[a, b]: [Stages; 2]| [a, b, Stages(0), Stages(0), Stages(0)];
            let apart = can_be_apart(frame, stages);
            let draws = match apart {
                true if to.is_measured() => stages.each(),
                true if lens => two([stages.without(Stages::TONE), Stages(stages.0 & Stages::TONE.0)]),
                _ => two([stages, Stages(0)]),
            };
            for part in draws.into_iter().filter(|s| s.0 != 0) {
                if lens && part == Stages::TONE {
                    self.draw_lens(frame, false, to)?;
                    lens = false;
                }
                self.draw(context, frame, part, &scene, &rays, to)?;
            }
            if lens {
                self.draw_lens(frame, stages.has(Stages::TONE), to)?;
            }
        }
        self.recorded = self.recorded.with(asked);
        Ok(())
    }

    /// Brings the tables up to date with air, place and lights; nothing is drawn if they are.
    fn prepare(&mut self, context: &Context, frame: &Frame<'_>, scene: &Scene, to: &mut Recording<'_>) -> Result<()> {
        let mut tables = context.sky()?;
        let pure = frame.flags.has(FrameFlags(FrameFlags::NO_HISTORY.0 | FrameFlags::CUT.0));
        let share = if pure { 1.0 } else { self.planner.share_of_tables() };
        let work = tables.follow(&self.device, to.encoder, &scene.planet, frame.frame_id, share)?;
        to.ends(Effect::SkyTables, work)?;
        let drawn = self.sky.prepare(to.encoder, &tables, &scene.observer(pure))?;
        to.ends(Effect::SkyView, drawn)?;
        self.report.tables_rebuilt += u32::from(work) + u32::from(drawn);
        Ok(())
    }

    fn draw(
        &mut self,
        context: &Context,
        frame: &Frame<'_>,
        stages: Stages,
        scene: &Scene,
        rays: &ViewRays,
        to: &mut Recording<'_>,
    ) -> Result<()> {
        let Some(layer) = frame.color_layer() else { return Ok(()) };
        let color = layer.texture;
        let tone = stages.has(Stages::TONE) && frame.color_space == ColorSpace::SceneLinear;
        let stages = if tone { stages } else { stages.without(Stages::TONE) };
        let fog = scene.fog_model(context.fog_law(), context.seed(), context.planet_radius_m())?;
        let mut variant = Variant {
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
            depth_kinds: rays.depth_kinds(),
            march: context.marches_sky(),
            terrain: false,
            around: Default::default(),
            air: true,
            sky: true,
        };
        if variant.stages == Stages(0) {
            return Ok(());
        }
        let exposure = frame.exposure.unwrap_or(context.exposure()).factor(scene.ground.adaptation_cd_m2);
        self.report.exposure = exposure;
        let situation = situation(frame, scene);
        if self.planned_for != Some(frame.frame_id) {
            self.planned_for = Some(frame.frame_id);
            let rain = variant.stages.has(Stages::PARTICLES) && self.rain.is_planned();
            let parts = [
                variant.has_depth && variant.stages.has(Stages::MEDIUM),
                variant.fog.is_some() && variant.stages.has(Stages::MEDIUM),
                variant.stages.has(Stages::BACKGROUND),
                rain,
            ];
            let pixels = u64::from(color.width()) * u64::from(color.height());
            let drops = if rain { self.rain.drops(&self.device, scene) } else { 0 };
            let present = planned::present(parts, pixels, 1 + u32::from(scene.moon.matters), drops);
            let pure = frame.flags.has(FrameFlags(FrameFlags::NO_HISTORY.0 | FrameFlags::CUT.0));
            self.planner.begin(&self.device, &situation, &present, pure);
            self.report.prediction = self.planner.prediction();
        }
        let [air, fog_drawn, sky] = [AIR, FOG, SKY].map(|part| self.planner.drawn(part, 0));
        let drawn = [air, fog_drawn, sky, 1.0];
        self.rain.follow([1, 0].map(|rung| self.planner.drawn(RAIN, rung)));
        let drops = self.rain.draws().then(|| self.rain.layer(&self.device, color).clone());
        if drops.is_none() {
            variant.stages = variant.stages.without(Stages::PARTICLES);
        }
        let [water, terrain] = context.terrain_views(variant.stages.has(Stages::SURFACE));
        self.hold_copy(color)?;
        self.bind(frame, layer, [drops, water, terrain])?;
        let mut block = uniform(frame, scene, rays, color, exposure, context, (tone, drawn));
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
            let told = surface::around(context, scene, frame, near, exposure)?;
            self.around.follow(&self.device, &told);
            if variant.stages.has(Stages::SURFACE) {
                variant.around = told.present();
                variant.terrain = context.ground_grid().is_some();
            }
        }
        if variant.stages.has(Stages::PARTICLES) {
            let (shared, blocks) = ((&self.device, &*self.shared), [&self.uniform, &self.fog]);
            let constants = variant.reduced(drawn).veil_constants();
            let layer = (&mut *to.encoder, frame, color);
            let over = self.rain.draw_areas(shared, layer, (context, scene), (blocks, &self.sky), &constants)?;
            let at = (context, scene, rays);
            let with = (exposure, over, &self.around);
            self.report.rain = self.rain.draw(&self.device, (&mut *to.encoder, frame, color), at, with)?;
            self.report.passes += 1 + u32::from(over);
        }
        if variant.stages.has(Stages::SURFACE) {
            let block = surface::uniform(frame, color, context, scene, &fog)?;
            self.device.queue.write_buffer(&self.ground, 0, bytemuck::bytes_of(&block));
        }
        self.take_picture(layer, to)?;
        if variant.stages.has(Stages::MEDIUM) {
            let white = scene.ground.total_lux / std::f64::consts::PI;
            self.unit.watch(&self.device, to.encoder, frame, (white, self.recorded.has(Stages::BACKGROUND)));
        }
        let Some((_, group, target)) = &self.bound else { return Ok(()) };
        let mut composite = self.shared.composite()?;
        // A GPU branches over what is not drawn; a pipeline of its own would cost it a hitch.
        let least = if self.device.caps().software { variant.reduced(drawn) } else { variant };
        let pipeline = composite.pipeline(&self.device, least)?;
        let groups = [group, self.sky.bind_group(), self.around.bind_group()];
        crate::gpu::pass::draw(to.encoder, "composite", pipeline, &groups, target);
        self.report.passes += 1;
        if variant.stages.has(Stages::MEDIUM)
            && let Some(gauge) = self.planner.due(&situation, || {
                self.rain.streaks(&self.device, (frame, color.height(), exposure), (context, scene, rays))
            })
        {
            let [_, (shader, _)] = variant.sampling.shaders();
            let (constants, layouts) = (variant.constants(), composite.layouts(variant.sampling));
            gauge.record(&self.device, to.encoder, (shader, &constants), &layouts, &groups)?;
            self.report.passes += 1;
        }
        drop(composite);
        to.ends(Effect::of(variant.stages), true)?;
        self.light_scale = match frame.color_space {
            ColorSpace::SceneLinear => (1.0 / (exposure * frame.cd_m2_per_unit)) as f32,
            ColorSpace::DisplayLinear | ColorSpace::DisplaySrgb => 1.0,
        };
        if let (Some(froxels), true) = (&mut self.froxels, stages.has(Froxels::STAGE)) {
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
            to.ends(Effect::Veil, true)?;
        }
        Ok(())
    }
}
