//! Sky and clear air of a view: the tables for its camera's altitude.

use std::sync::{Arc, Mutex};

use glam::DVec3;

use super::{AirChange, Disc, FollowedSky, Lamp, Observer, SkyModel, SkySettings, SkyVolume, candidates};
use crate::{
    error::{Error, Result, Status},
    gpu::counts::DeviceWork,
    moment::{Light, Scene},
    plan::Price,
    stage::{
        Constant, Contribution, CostItem, DrawContext, DrawnEffect, FrameBlock, FrameContext, Outputs, PutPart,
        Recording, Stages, Traits, flag,
    },
};

/// The sky of a view.
pub(crate) struct SkyView {
    tables: Arc<Mutex<FollowedSky>>,
    volume: SkyVolume,
    /// Value of [`SkyView::rebuild_work`] for the present settings.
    rebuild_work: f64,
}

impl SkyView {
    /// Creates the view's sky from the tables of a context.
    ///
    /// # Errors
    /// A GPU fault.
    pub fn new(tables: &Arc<Mutex<FollowedSky>>) -> Result<Self> {
        let volume = SkyVolume::new(&**tables.lock().map_err(|_| poisoned())?)?;
        Ok(Self { tables: tables.clone(), rebuild_work: rebuild_work(volume.settings()), volume })
    }

    /// Work of building default tables, in units of the work of one pixel of the sky with the view's settings.
    pub fn rebuild_work(&self) -> f64 {
        self.rebuild_work
    }

    /// Returns the tables for shaders that include `sky/lookup.wgsl`: layout and bind group, and the shader constants
    /// that fit them.
    pub fn tables(&self) -> (wgpu::BindGroupLayout, wgpu::BindGroup, [Constant; 2]) {
        let is_marched = self.settings().model == SkyModel::BruteForce;
        let constants = [("SKY_MARCH", flag(is_marched)), ("SKY_LAMPS", f64::from(self.volume.lamp_count()))];
        (self.volume.layout().clone(), self.volume.bind_group().clone(), constants)
    }

    /// Settings with which the last frame's sky was drawn.
    pub fn settings(&self) -> &SkySettings {
        self.volume.settings()
    }

    /// Settings with which the next frame's sky will be drawn.
    pub fn next_settings(&self) -> SkySettings {
        self.tables.lock().map_or(*self.settings(), |tables| *tables.settings())
    }
}

fn rebuild_work(settings: &SkySettings) -> f64 {
    let (work, price) = (candidates::work, Price::default());
    work(&SkySettings::default()).rebuild.at(&price) / work(settings).pixel.at(&price)
}

fn poisoned() -> Error {
    Error::new(Status::Poisoned, "an earlier call panicked while building the sky")
}

impl DrawnEffect for SkyView {
    fn stages(&self) -> Stages {
        Stages::BACKGROUND.with(Stages::MEDIUM)
    }

    /// Updates the tables for air, position and lights. Nothing is drawn if they are up to date.
    fn prepare(&mut self, context: &FrameContext<'_>, recording: &mut Recording<'_>) -> Result<()> {
        let mut tables = self.tables.lock().map_err(|_| poisoned())?;
        if !self.volume.is_of(&tables) {
            self.volume = SkyVolume::new(&tables)?;
            self.rebuild_work = rebuild_work(self.volume.settings());
        }
        let keeps = context.keeps_tables && tables.planet().is_some();
        let now = &context.now.scene.planet;
        let change = AirChange { now, ahead: context.planet_ahead.as_ref().unwrap_or(now) };
        let (frame_id, share) = (context.frame.frame_id, context.table_share);
        let work = !keeps && tables.build_toward(recording.device, recording.encoder, change, frame_id, share)?;
        recording.ends(CostItem::SkyTables, work)?;
        let drawn = self.volume.prepare(
            recording.encoder,
            &tables,
            &Observer::of(&context.now.scene, context.frame.is_pure()),
        )?;
        recording.ends(CostItem::SkyView, drawn)?;
        recording.tables_rebuilt += u32::from(work) + u32::from(drawn);
        let counts = &recording.device.counts;
        counts.add(DeviceWork::SkyTables, u64::from(work));
        counts.add(DeviceWork::ObserverTables, u64::from(drawn));
        Ok(())
    }

    fn parts(&mut self, context: &DrawContext<'_>, stages: Stages, put: &mut PutPart<'_>) {
        let lamps = context.now.scene.lamps();
        let between = context.frame.depth.is_some() && stages.has(Stages::MEDIUM);
        put(&candidates::AIR, between, &[candidates::air_work(lamps)]);
        put(&candidates::SKY, stages.has(Stages::BACKGROUND), &[candidates::sky_work(lamps)]);
    }

    fn compose(&mut self, context: &DrawContext<'_>, _given: &Outputs, added: &mut Contribution) -> Result<()> {
        let [air, sky] = [&candidates::AIR, &candidates::SKY].map(|part| context.share(part, 0));
        let is_marched = self.settings().model == SkyModel::BruteForce;
        added.between_and_veil("SKY_MARCH", flag(is_marched), flag(is_marched));
        added.between("AIR", 1.0, flag(air > 0.0));
        let traits = |veils_drawn| Traits { veils_drawn, is_marched, ..Traits::default() };
        added.set_traits(traits(true), traits(air > 0.0));
        added.between("SKY_LAMPS", 2.0, f64::from(self.volume.lamp_count()));
        added.constant("CLEAR_SKY", 1.0, flag(sky > 0.0));
        added.constant("SKY_DISCS", 2.0, f64::from(self.volume.disc_count()));
        added.constant("SUN_THEN_MOON", 1.0, 1.0);
        added.set_frame_block(FrameBlock::Sky { air, sky });
        added.set_tables(self.volume.layout(), self.volume.bind_group());
        Ok(())
    }
}

impl Observer {
    /// Creates the observer for a camera in a scene.
    pub(crate) fn of(scene: &Scene, exact: bool) -> Self {
        let lamp = |light: &Light, disc| Lamp {
            lights_air: light.matters,
            toward: light.direction.to_array(),
            irradiance: light.spectrum,
            angular_radius: light.angular_radius,
            disc,
        };
        let moon = lamp(&scene.moon, Disc::Moon { lit_from: moon_lit_from(&scene.moon).to_array() });
        Self {
            altitude_m: scene.place.altitude_m.clamp(-1e4, 1e8),
            lamps: [Some(lamp(&scene.sun, Disc::Sun)), moon_shows(scene).then_some(moon)],
            refraction: 1.0,
            exact,
        }
    }
}

/// Sine of the depth under the horizon at which nothing of the moon's disc is visible any more.
const BELOW_HORIZON: f64 = 0.02;

/// Whether the moon is among the lamps: its light matters, or its disc may be above the horizon.
fn moon_shows(scene: &Scene) -> bool {
    let (radius, h) = (scene.planet.bottom_radius_m, scene.place.altitude_m.max(0.0));
    let horizon = -(h * (h + 2.0 * radius)).sqrt() / (radius + h);
    scene.moon.matters || scene.moon.apparent.z > horizon - BELOW_HORIZON
}

/// Direction of the sun as seen from the moon's face. It lies in the plane of the directions to the moon and to its
/// bright limb, at the phase angle from the direction back to the observer.
fn moon_lit_from(moon: &Light) -> DVec3 {
    let cos_phase = (2.0 * moon.lit - 1.0).clamp(-1.0, 1.0);
    let sin_phase = (1.0 - cos_phase * cos_phase).sqrt();
    (moon.bright_limb * sin_phase - moon.direction * cos_phase).normalize()
}
