//! View: one camera or projector channel, with its state between frames.

use std::{sync::Arc, time::Instant};

use glam::{DMat4, DVec3};

use super::{
    cache::DrawCache,
    froxels::{FrameTextures, Froxels},
    history::FrameHistory,
    opaque_step::OpaqueStep,
    rehearsed::RehearsedView,
};
use crate::{
    context::Context,
    effects::{Effects, PARTS, UnseenChanges},
    error::{Error, Result},
    gpu::{Device, KeptView, Layer},
    moment::Scene,
    plan::Planner,
    scene::{Camera, ViewRays},
    stage::{
        CostItem, Diagnostic, DrawTarget, Frame, FrameContext, FrameFlags, LensPicture, Recording, Report, Stages,
        can_be_apart, can_copy,
    },
    world::HeldEffects,
};

/// One camera or projector channel. Use it from one thread at a time.
pub struct View {
    pub(crate) device: Arc<Device>,
    pub(crate) effects: Effects,
    pub(super) planner: Planner<UnseenChanges>,
    pub(super) cache: DrawCache,
    pub(super) history: FrameHistory,
    pub(super) rehearsal: RehearsedView,
}

impl View {
    /// Creates a view of `context`.
    ///
    /// # Errors
    /// [`crate::Status::DeviceLost`], or a GPU fault.
    pub fn new(context: &Context) -> Result<Self> {
        let device = context.device().clone();
        let _entered = device.enter()?;
        let cache = DrawCache::new(context, &device)?;
        let effects = Effects::new(&device, (context.shared(), &cache.blocks), &context.held)?;
        let planner = Planner::new(PARTS, effects.rebuild_work());
        device.check_made()?;
        drop(_entered);
        let (history, rehearsal) = (FrameHistory::default(), RehearsedView::default());
        Ok(Self { device, effects, planner, cache, history, rehearsal })
    }

    /// Returns the report on the last frame: its cost and its contents.
    pub fn report(&self) -> &Report {
        &self.history.report
    }

    /// Returns textures of air and fog for the host's own transparent shaders. From this function's first call on,
    /// [`Stages::MEDIUM`] of every frame fills these textures.
    ///
    /// # Errors
    /// [`crate::Status::DeviceLost`], or a GPU fault.
    pub fn frame_textures(&mut self) -> Result<FrameTextures> {
        let device = self.device.clone();
        let _entered = device.enter()?;
        let froxels = match &self.cache.froxels {
            Some(froxels) => froxels,
            None => {
                let froxels = Froxels::new(&device);
                device.check_made()?;
                self.cache.froxels.insert(froxels)
            }
        };
        let (light, through) = (froxels.light.clone(), froxels.through.clone());
        Ok(FrameTextures { light, through, light_scale: self.history.light_scale })
    }

    /// Records the stages of a frame and submits them: on return the work is on the device's queue.
    ///
    /// The calls of one frame have the same `frame.frame_id` and follow the order of the stages; a new id begins a new
    /// frame.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] and [`crate::Status::Unsupported`], which name the field;
    /// [`crate::Status::WrongOrder`] if a stage comes twice or late; [`crate::Status::DeviceLost`] or a GPU fault.
    /// After a GPU fault the picture may be drawn in part; after any other error this call has drawn nothing.
    pub fn record(&mut self, context: &Context, frame: &Frame<'_>, stages: Stages) -> Result<()> {
        match self.rehearses() {
            true => self.record_rehearsed(frame, |view, own| view.record_frame(context, own, stages)),
            false => self.record_frame(context, frame, stages),
        }
    }

    fn record_frame(&mut self, context: &Context, frame: &Frame<'_>, stages: Stages) -> Result<()> {
        let device = self.device.clone();
        self.check_call(frame, stages)?;
        self.check_images(frame, stages)?;
        let _entered = device.enter()?;
        let recorded = self.recorded_of(frame.frame_id);
        self.record_and_submit(context, frame, stages, &device).inspect_err(|_| self.take_back(recorded))
    }

    /// Returns the stages of a frame that have been recorded so far, for [`View::take_back`].
    pub(crate) fn recorded_of(&self, frame_id: u64) -> Stages {
        if frame_id == self.history.report.frame_id { self.history.recorded } else { Stages(0) }
    }

    /// Undoes a call that failed after it was recorded: its stages no longer count as recorded, so that the host may
    /// record them again. Everything of the picture's size is dropped, because memory may have been too small for it.
    pub(crate) fn take_back(&mut self, recorded: Stages) {
        self.history.recorded = recorded;
        self.forget_images();
    }

    /// Drops everything of the picture's size that the view holds.
    fn forget_images(&mut self) {
        self.cache.forget_images();
        self.effects.each().into_iter().for_each(|effect| effect.forget_picture());
    }

    /// Drops the references to a picture that is a window's image. The image goes to the screen next, and DXGI resizes
    /// a window only when nothing refers to its images.
    fn let_go_of_window(&mut self, frame: &Frame<'_>) {
        if frame.color.is_some_and(|color| self.device.is_of_window(color)) {
            self.cache.target = KeptView::default();
            self.cache.opaque.iter_mut().for_each(OpaqueStep::forget_color);
        }
    }

    /// Returns the number of scenes that were computed for the view's calls.
    #[cfg(test)]
    pub(crate) fn scene_count(&self) -> u64 {
        self.history.scene.as_ref().map_or(0, |kept| kept.count)
    }

    /// Makes the view draw the weather at every pixel from now on.
    #[cfg(test)]
    pub(crate) fn forget_grid(&mut self) {
        self.cache.even = None;
    }

    /// Returns the composition pipelines of the device's views: their pixels, shader and entry point, and constants.
    #[cfg(test)]
    pub(crate) fn composes_with(&self) -> Vec<(String, (String, &'static str), crate::stage::Constants)> {
        let held = self.cache.composite.lock().expect("no call has panicked").held();
        held.into_iter().map(|(pixels, program, constants)| (format!("{pixels:?}"), program, constants)).collect()
    }

    /// Creates the resources that have the picture's size, before anything of the frame is recorded, because memory may
    /// be too small for a large target.
    fn hold_images(&mut self, frame: &Frame<'_>, stages: Stages) -> Result<()> {
        let Some(color) = frame.color else { return Ok(()) };
        let (made, bytes) = (self.hold_copy(color)?, self.bytes());
        self.hold_kinds(color)?;
        self.effects.each().into_iter().for_each(|effect| effect.hold(&self.device, color, stages));
        if made || self.bytes() != bytes { self.device.check_made() } else { Ok(()) }
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
        let blocks = self.cache.blocks.clone();
        let mut recording = Recording::new(device, &mut encoder, &blocks);
        if frame.flags.has(FrameFlags::MEASURE) {
            let so_far = if frame.frame_id == self.history.report.frame_id { self.history.report.costs } else { None };
            recording.measure(so_far.unwrap_or_default())?;
        }
        self.record_stages(context, frame, stages, &mut recording)?;
        if let Some((costs, inside)) = recording.costs() {
            self.history.report.costs = Some(costs);
            self.history.last_call = Some(inside);
        }
        device.submit(encoder);
        device.check_made()
    }

    /// Charges the time since `start`, less that of the measured call itself, to [`CostItem::HandOver`]: the time in
    /// which the host's context and images were imported and returned.
    pub(crate) fn add_hand_over(&mut self, start: Instant) {
        if let (Some(costs), Some(inside)) = (&mut self.history.report.costs, self.history.last_call) {
            let ms = (start.elapsed().saturating_sub(inside)).as_secs_f64() * 1e3;
            costs.add(CostItem::HandOver, ms);
            costs.whole_ms += ms;
        }
    }

    /// Records as [`View::record`] does, into a Rust host's own encoder, which the host submits.
    ///
    /// # Errors
    /// The errors of [`View::record`]; [`crate::Status::Unsupported`] with `MEASURE` (timing needs the submission,
    /// which the host makes here), and for images that Welkin would have to copy between submissions: a colour without
    /// COPY_SRC, or a written depth that is a renderbuffer.
    pub fn record_into(
        &mut self,
        context: &Context,
        frame: &Frame<'_>,
        stages: Stages,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<()> {
        if frame.flags.has(FrameFlags::MEASURE) {
            return Err(Error::unsupported(
                "MEASURE where the host submits, or lends its images for one submission: measure there by the host's own \
                 timestamps",
            )
            .within("flags"));
        }
        if frame.color.is_some_and(|c| !can_copy(c)) {
            return Err(Error::unsupported(
                "without COPY_SRC where the host submits: the picture is read between submissions; use record",
            )
            .within("color.usage"));
        }
        self.check_call(frame, stages)?;
        self.check_images(frame, stages)?;
        self.check_depth_is_one(frame)?;
        let device = self.device.clone();
        let (recorded, blocks) = (self.recorded_of(frame.frame_id), self.cache.blocks.clone());
        self.record_stages(context, frame, stages, &mut Recording::new(&device, encoder, &blocks))
            .inspect_err(|_| self.take_back(recorded))
    }

    fn record_stages(
        &mut self,
        context: &Context,
        frame: &Frame<'_>,
        stages: Stages,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        let now = context.moment("frame.camera.position", frame.camera.position, &mut self.history.scene)?;
        let rays = stages.draw().then(|| rays(frame, &now.scene)).transpose()?;
        let asked = stages;
        let frame_context = FrameContext {
            device: &self.device.clone(),
            frame,
            now: &now,
            world: &context.world,
            held: HeldEffects(&context.held.all()),
            asked,
            planet_ahead: context.world.planet_ahead(frame.camera.position, &now.scene.planet),
            table_share: if frame.is_pure() { 1.0 } else { self.planner.share_of_tables() },
            all_around: self.cache.environment.is_some(),
            keeps_tables: self.rehearses(),
        };
        self.effects.gather(&frame_context)?;
        let there = self.effects.all().iter().fold(Stages::PREPARE.with(Stages::TONE), |s, e| s.with(e.stages()));
        let stages = Stages(stages.0 & there.0); // those with something to draw
        let opaque = self.has_opaque(asked);
        let diagnoses = frame.diagnostic != Diagnostic::None;
        let rays = rays.filter(|_| stages.draw() || opaque || diagnoses);
        if frame.frame_id != self.history.report.frame_id {
            self.history.report =
                Report { frame_id: frame.frame_id, bytes: self.history.report.bytes, ..Default::default() };
            self.history.recorded = Stages(0);
        }
        if rays.is_some() {
            self.hold_images(frame, stages)?;
        }
        if self.history.recorded == Stages(0) {
            self.effects.each().into_iter().try_for_each(|effect| effect.prepare(&frame_context, recording))?;
        }
        if let (Some(rays), Some(color)) = (rays, frame.color_layer()) {
            let exposure = frame.exposure.unwrap_or(now.exposure).factor(now.scene.ground.adaptation_cd_m2);
            let is_veiled = self.history.recorded.with(asked).has(Stages::MEDIUM);
            let target = DrawTarget { color, rays: &rays, exposure, is_veiled };
            if opaque {
                self.draw_opaque(&frame_context, target, recording)?;
            }
            match diagnoses {
                true => self.draw_diagnostic(&frame_context, target, [asked, there], recording)?,
                false => self.draw_all(&frame_context, target, stages, recording)?,
            }
        }
        recording.upload();
        self.let_go_of_window(frame);
        self.history.recorded = self.history.recorded.with(asked);
        self.history.report.passes += recording.passes;
        self.history.report.tables_rebuilt += recording.tables_rebuilt;
        self.effects.all().iter().for_each(|effect| effect.report(&mut self.history.report));
        self.history.report.bytes = self.bytes();
        Ok(())
    }

    /// Draws the stages of a call in as few draws as possible. A measured call draws each stage alone where the picture
    /// stays the same, so that each has its own cost.
    fn draw_all<'a>(
        &mut self,
        context: &FrameContext<'a>,
        target: DrawTarget<'a>,
        stages: Stages,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        let frame = context.frame;
        // The lens comes before the tone curve if the target can hold the scene-linear picture.
        let mut lens = stages.has(Stages::LENS) && self.effects.all().iter().any(|effect| effect.has_lens());
        let two = |[a, b]: [Stages; 2]| [a, b, Stages(0), Stages(0), Stages(0)];
        let draws = match can_be_apart(frame, stages) {
            true if recording.is_measured() => stages.each(),
            true if lens => two([stages.without(Stages::TONE), Stages(stages.0 & Stages::TONE.0)]),
            _ => two([stages, Stages(0)]),
        };
        for part in draws.into_iter().filter(|s| s.0 != 0) {
            if lens && part == Stages::TONE {
                self.draw_lens(frame, target.color, false, recording)?;
                lens = false;
            }
            self.draw(context, target, part, recording)?;
        }
        if lens { self.draw_lens(frame, target.color, stages.has(Stages::TONE), recording) } else { Ok(()) }
    }

    /// Draws the lens effects over the picture in the target. `toned` says whether TONE has been applied in this call.
    fn draw_lens(
        &mut self,
        frame: &Frame<'_>,
        color: Layer<'_>,
        toned: bool,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        self.take_picture(color, recording)?;
        let Some(copy) = &self.cache.copy else { return Ok(()) };
        let target = self.cache.target.of(color, Layer::view);
        self.effects
            .each()
            .into_iter()
            .try_for_each(|effect| effect.draw_lens(frame, LensPicture { copy, target }, toned, recording))
    }
}

/// Returns the camera's rays in local east, north, up, in which the shaders work.
fn rays(frame: &Frame<'_>, scene: &Scene) -> Result<ViewRays> {
    let view = DMat4::from_mat3(frame.camera.rotation() * scene.world_to_enu.transpose());
    let local = Camera { position: DVec3::ZERO, view, projection: frame.camera.projection };
    ViewRays::new(&local, &frame.depth_mapping)
}
