//! The stage LENS: the view's windscreen.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::{
    Frame, FrameFlags, View,
    measure::{Effect, Recording},
    rain::has_maps,
    surface::around,
    target::{ColorSpace, Stages},
    uniform::is_float,
};
use crate::{
    context::{Context, PaneAt, Scene},
    error::{Error, Result},
    falling::{drops::factor_in, sizes::DropSizes},
    glass::{
        Glass, GlassReport, LensFrame, Mapped, Moment, PaneUniform, Plane, Reach, SIZES, Windscreen, reference::Cells,
    },
    scene::Camera,
    surroundings::Told,
};

/// Where a pane of the camera's is in the host's world.
fn pane_at(camera: &Camera, plane: &Plane, screen: &Windscreen) -> PaneAt {
    let to_world = camera.rotation().transpose();
    PaneAt {
        eye: camera.position,
        origin: camera.position + to_world * plane.origin,
        along: to_world * (plane.u * plane.size_m.x),
        up: to_world * (plane.v * plane.size_m.y),
        out: to_world * plane.out,
        air_m_s: to_world * -screen.velocity_m_s,
    }
}

/// The same for the maps' pass, from a camera at `eye` whose axes `to_enu` turns.
fn pane_uniform(pane: &PaneAt, drops: &[(DVec3, f64); SIZES], (eye, to_enu): (DVec3, DMat3)) -> PaneUniform {
    let row = |v: DVec3, w: f64| (to_enu * v).extend(w).as_vec4().to_array();
    PaneUniform {
        origin: row(pane.before() - eye, 0.0),
        along: row(pane.along, 0.0),
        up: row(pane.up, 0.0),
        drops: drops.map(|(velocity, share)| row(velocity, share)),
    }
}

impl View {
    /// Sets the window that the view looks through; `None` takes it away. A host that drives, turns its head or wipes sets it
    /// anew before each frame: the water stays on the glass while its size does. Unchanged after an error.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field and its range.
    pub fn set_windscreen(&mut self, screen: Option<&Windscreen>) -> Result<()> {
        let Some(screen) = screen else {
            let device = self.device.clone();
            let _entered = device.enter()?;
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

    /// Water on the windscreen as of the last frame, or `None` without one. Reads it back and waits for the GPU: not for
    /// every frame.
    ///
    /// # Errors
    /// [`crate::Status::DeviceLost`], or a GPU fault.
    pub fn windscreen_report(&self) -> Result<Option<GlassReport>> {
        let _entered = self.device.enter()?;
        self.glass.as_ref().map(|g| g.report(&self.device)).transpose()
    }

    /// The cells of the windscreen's water, or `None` where it is dry; for tests and tools. Waits for the GPU.
    ///
    /// # Errors
    /// As [`View::windscreen_report`].
    pub fn windscreen_cells(&self) -> Result<Option<Cells>> {
        let _entered = self.device.enter()?;
        self.glass.as_ref().map_or(Ok(None), |g| g.cells(&self.device))
    }

    /// Refuses a frame whose LENS cannot be drawn.
    pub(super) fn check_lens(&self, frame: &Frame<'_>, stages: Stages) -> Result<()> {
        let several = frame.color.is_some_and(|c| c.sample_count() > 1);
        if several && stages.has(Stages::LENS) && self.glass.is_some() {
            return Err(Error::unsupported(
                "above 1 in the stage LENS with a windscreen: resolve first, then record LENS",
            )
            .within("color.samples"));
        }
        Ok(())
    }

    /// Brings the water on the glass to the frame's time.
    pub(super) fn prepare_lens(
        &mut self,
        context: &Context,
        frame: &Frame<'_>,
        scene: &Scene,
        to: &mut Recording<'_>,
    ) -> Result<()> {
        let Some(glass) = &mut self.glass else { return Ok(()) };
        let weather = |t: f64| context.with_areas(frame.camera.position, t, context.known_weather(t));
        let eye = frame.camera.position;
        let reach = |plane: &Plane, screen: &Windscreen| {
            if context.shelters().is_empty() && !has_maps(context) {
                return Ok((Reach::ALL, None));
            }
            let now = weather(context.time_s());
            let sizes = DropSizes::new(&now.precipitation, factor_in(&now.air, scene.place.altitude_m));
            let pane = pane_at(&frame.camera, plane, screen);
            let drops = context.drops_on_pane(&sizes, &pane);
            let mapped = has_maps(context).then(|| {
                let told = around(context, scene, frame, (1.0, 0.0), 1.0)?;
                let uniform = pane_uniform(&pane, &drops, (eye, scene.world_to_enu));
                Ok(Mapped { told: Told { shelters: &[], lights: &[], ..told }, pane: uniform })
            });
            Ok((context.reach_of_pane(&drops, &pane), mapped.transpose()?))
        };
        let moment = Moment {
            time_s: context.time_s(),
            seed: context.seed(),
            camera: &frame.camera,
            up: scene.world_to_enu.transpose().z_axis,
            altitude_m: scene.place.altitude_m,
            weather: &weather,
            reach: &reach,
            cut: frame.flags.has(FrameFlags(FrameFlags::NO_HISTORY.0 | FrameFlags::CUT.0)),
        };
        let (device, encoder) = (&self.device, &mut *to.encoder);
        let passes = self.shared.with_glass(device, |kit| glass.advance(device, kit, encoder, &moment))?;
        self.report.passes += passes;
        to.ends(Effect::Windscreen, passes > 0)
    }

    /// Whether LENS is among the stages and has anything to show.
    pub(super) fn shows_lens(&self, stages: Stages) -> bool {
        stages.has(Stages::LENS) && self.glass.as_ref().is_some_and(|g| g.shows())
    }

    /// Draws the glass over what the target holds; `toned` says that TONE has been over it in this call.
    pub(super) fn draw_lens(&mut self, frame: &Frame<'_>, toned: bool, to: &mut Recording<'_>) -> Result<()> {
        let Some(layer) = frame.color_layer() else { return Ok(()) };
        let color = layer.texture;
        self.take_picture(layer, to)?;
        let (Some(glass), Some(copy)) = (&mut self.glass, &self.copy) else { return Ok(()) };
        let plain = !is_float(color.format()) && !color.format().is_srgb();
        let toned = toned && frame.color_space == ColorSpace::SceneLinear;
        let lens = LensFrame {
            camera: &frame.camera,
            picture: copy,
            mask: frame.mask_layer(),
            target: layer,
            encoded: plain && (toned || frame.color_space == ColorSpace::DisplaySrgb),
            bottom_left: frame.origin_bottom_left,
        };
        let (device, encoder): (&Arc<_>, _) = (&self.device, &mut *to.encoder);
        let passes = self.shared.with_glass(device, |kit| glass.draw(device, kit, encoder, &lens))?;
        self.report.passes += passes;
        self.report.bytes = self.bytes();
        to.ends(Effect::Windscreen, passes > 0)
    }
}
