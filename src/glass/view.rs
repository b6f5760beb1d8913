//! Windscreen of a view: its state between frames, and its drawing in the stage LENS.

use std::sync::{Arc, Mutex, MutexGuard};

use super::{
    geometry::Plane,
    lens::LensFrame,
    pane::PaneAt,
    passes::GlassKit,
    reach::Reach,
    reach_pass::Mapped,
    reference::{Cells, Snow},
    state::{AtGlass, Glass, GlassReport, Reached},
    windscreen::Windscreen,
};
use crate::{
    error::{Error, Result, Status},
    falling::{drops::factor_in, sizes::DropSizes},
    gpu::{Device, Shared},
    moment::SceneMoment,
    stage::{ColorSpace, CostItem, DrawnEffect, Frame, FrameContext, LensPicture, Recording, Stages, is_float},
    surroundings::{HostSurroundings, ShelterReach},
};

/// Windscreen of a view, if it has one.
pub(crate) struct GlassView {
    shared: Arc<Shared>,
    glass: Option<Box<Glass>>,
}

impl GlassView {
    pub fn new(shared: &Arc<Shared>) -> Self {
        Self { shared: shared.clone(), glass: None }
    }

    /// Sets the window that the view looks through; `None` removes it.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field and its range; nothing changes then.
    pub fn set(&mut self, screen: Option<&Windscreen>) -> Result<()> {
        let Some(screen) = screen else {
            self.glass = None;
            return Ok(());
        };
        screen.validate()?;
        match &mut self.glass {
            Some(glass) => glass.set(*screen),
            None => self.glass = Some(Box::new(Glass::new(*screen))),
        }
        Ok(())
    }

    /// Returns the water on the glass; `None` without a windscreen. Waits for the GPU.
    ///
    /// # Errors
    /// [`crate::Status::DeviceLost`], or a GPU fault.
    pub fn water(&self, device: &Device) -> Result<Option<GlassReport>> {
        self.glass.as_ref().map(|g| g.report(device)).transpose()
    }

    /// Returns the cells of the water, or `None` on dry glass or without a windscreen. Waits for the GPU.
    ///
    /// # Errors
    /// [`crate::Status::DeviceLost`], or a GPU fault.
    pub fn cells(&self, device: &Device) -> Result<Option<Cells>> {
        self.glass.as_ref().map_or(Ok(None), |g| g.cells(device))
    }

    /// Returns the snow, or `None` without snow or windscreen. Waits for the GPU.
    ///
    /// # Errors
    /// [`crate::Status::DeviceLost`], or a GPU fault.
    pub fn snow(&self, device: &Device) -> Result<Option<Snow>> {
        self.glass.as_ref().map_or(Ok(None), |g| g.snow(device))
    }

    /// Returns the pipelines with which the device draws windscreens, created at first use.
    fn kit(&self, device: &Arc<Device>) -> Result<Arc<Mutex<GlassKit>>> {
        self.shared.get(|| GlassKit::new(device).map(Mutex::new))
    }
}

/// Locks the pipelines; an error if an earlier call panicked.
fn locked(kit: &Mutex<GlassKit>) -> Result<MutexGuard<'_, GlassKit>> {
    kit.lock().map_err(|_| Error::new(Status::Poisoned, "an earlier call panicked over a windscreen"))
}

/// Returns the share of the rain that boxes let through to a pane now, and the host's occluder maps.
fn reached<'a>(now: &'a SceneMoment<'_>, frame: &Frame<'_>, plane: &Plane, screen: &Windscreen) -> Result<Reached<'a>> {
    if !now.is_sheltered() {
        return Ok((Reach::ALL, None));
    }
    let known = now.weather.falling_at(now.eye, now.time_s, now.weather.weather_at(now.eye, now.time_s));
    let sizes = DropSizes::new(&known.precipitation, factor_in(&known.air, now.scene.place.altitude_m));
    let pane = PaneAt::new(&frame.camera, plane, screen);
    let drops = pane.drops(now, &sizes);
    let mapped = now.has_maps().then(|| {
        let around = HostSurroundings { shelters: &[], lights: &[], ..now.host_surroundings(ShelterReach::NONE, 1.0)? };
        Ok(Mapped { around, pane: pane.uniform(&drops, (now.eye, now.scene.world_to_enu)) })
    });
    Ok((pane.reach(now.shelters, &drops), mapped.transpose()?))
}

impl DrawnEffect for GlassView {
    fn stages(&self) -> Stages {
        if self.glass.is_some() { Stages::LENS } else { Stages(0) }
    }

    fn check(&self, frame: &Frame<'_>, stages: Stages) -> Result<()> {
        let several = frame.color.is_some_and(|c| c.sample_count() > 1);
        if several && stages.has(Stages::LENS) && self.glass.is_some() {
            let what = "above 1 in the stage LENS with a windscreen: resolve first, then record LENS";
            return Err(Error::unsupported(what).within("color.samples"));
        }
        Ok(())
    }

    /// Advances the water on the glass to the frame's time.
    fn prepare(&mut self, context: &FrameContext<'_>, recording: &mut Recording<'_>) -> Result<()> {
        if self.glass.is_none() {
            return Ok(());
        }
        let kit = self.kit(recording.device)?;
        let Some(glass) = &mut self.glass else { return Ok(()) };
        let (now, frame) = (context.now, context.frame);
        let moment = AtGlass {
            time_s: now.time_s,
            seed: now.seed,
            camera: &frame.camera,
            up: now.scene.world_to_enu.transpose().z_axis,
            altitude_m: now.scene.place.altitude_m,
            weather: &|t| now.weather.falling_at(now.eye, t, now.weather.weather_at(now.eye, t)),
            reach: &|plane, screen| reached(now, frame, plane, screen),
            cut: frame.is_pure(),
        };
        let passes = glass.advance(recording.device, &mut *locked(&kit)?, recording.encoder, &moment)?;
        recording.passes += passes;
        recording.ends(CostItem::Windscreen, passes > 0)
    }

    fn has_lens(&self) -> bool {
        self.glass.as_ref().is_some_and(|g| g.shows())
    }

    fn draw_lens(
        &mut self,
        frame: &Frame<'_>,
        picture: LensPicture<'_>,
        toned: bool,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        let Some(layer) = frame.color_layer().filter(|_| self.glass.is_some()) else { return Ok(()) };
        let kit = self.kit(recording.device)?;
        let Some(glass) = &mut self.glass else { return Ok(()) };
        let color = layer.texture;
        let plain = !is_float(color.format()) && !color.format().is_srgb();
        let toned = toned && frame.color_space == ColorSpace::SceneLinear;
        let lens = LensFrame {
            camera: &frame.camera,
            picture: picture.copy,
            mask: frame.mask_layer(),
            target: picture.target,
            encoded: plain && (toned || frame.color_space == ColorSpace::DisplaySrgb),
            bottom_left: frame.origin_bottom_left,
        };
        let passes = glass.draw(recording.device, &mut *locked(&kit)?, recording.encoder, &lens)?;
        recording.passes += passes;
        recording.ends(CostItem::Windscreen, passes > 0)
    }

    fn bytes(&self) -> u64 {
        self.glass.as_ref().map_or(0, |g| g.bytes())
    }
}
