//! The list of effects: what a view holds of each, in the order in which they are run, and what each takes from its context.
//!
//! This is the one place above their rooms that names them. A new effect adds a field here, its line in [`Effects::each`], what it
//! gathers in [`Effects::gather`], and its parts in [`PARTS`].

use crate::{
    context::Context,
    error::Result,
    fog::{self, FogUniform, FogView},
    glass::GlassView,
    gpu::Device,
    ground::{GroundUniform, GroundView},
    moment::{Moment, Scene},
    plan::{self, Price, StepWork, parts::Part},
    rain::{self, RainSettings, RainView, Streaks},
    sky::{self, SkyView, SkyVolume},
    stage::{DrawnEffect, Frame, Shot, Stages},
};

/// The parts of the weather that a picture may do with less of, in the order of every list of them.
pub const PARTS: &[Part] = &[sky::candidates::AIR, fog::candidates::FOG, sky::candidates::SKY, rain::candidates::RAIN];

/// Two parts of the list that cost more beside each other, and how much under the lamps of a scene.
pub(crate) fn together(scene: &Scene) -> ([usize; 2], StepWork) {
    ([0, 1], sky::candidates::air_before_fog_work(scene.lamps()))
}

/// Sizes of the blocks by [`Block`](crate::stage::Block).
pub(crate) const BLOCK_BYTES: [usize; 2] = [size_of::<FogUniform>(), size_of::<GroundUniform>()];

/// Layout of the look-up tables of what lies behind and between.
pub(crate) fn tables_layout(device: &Device) -> wgpu::BindGroupLayout {
    SkyVolume::view_layout(device)
}

/// What the planner compares by closed forms, since its gauge cannot see it.
pub(crate) type Unseen = Streaks;

/// The effects of a view.
pub(crate) struct Effects {
    pub sky: SkyView,
    pub fog: FogView,
    pub ground: GroundView,
    pub rain: RainView,
    pub glass: GlassView,
}

impl Effects {
    /// Those of a view of `context`.
    ///
    /// # Errors
    /// A GPU fault.
    pub fn new(context: &Context) -> Result<Self> {
        let device = context.device();
        Ok(Self {
            sky: SkyView::new(context.sky_tables())?,
            fog: FogView::new(device),
            ground: GroundView::new(device),
            rain: RainView::new(device, RainSettings::default()),
            glass: GlassView::new(context.shared()),
        })
    }

    /// All of them, in their order.
    pub fn each(&mut self) -> [&mut dyn DrawnEffect; 5] {
        [&mut self.sky, &mut self.fog, &mut self.ground, &mut self.rain, &mut self.glass]
    }

    /// The same to look at.
    pub fn all(&self) -> [&dyn DrawnEffect; 5] {
        [&self.sky, &self.fog, &self.ground, &self.rain, &self.glass]
    }

    /// Takes what there is of each in a moment, of a frame in which `stages` are asked for.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the parameter.
    pub fn gather(&mut self, context: &Context, now: &Moment<'_>, frame: &Frame<'_>, stages: Stages) -> Result<()> {
        self.fog.gather(now, context.fog_law())?;
        let fog_depth = self.fog.depth_above(now.scene.place.altitude_m);
        let wet = self.ground.gather(now, frame, &context.ground_held(now), fog_depth)?;
        self.ground.set_terrain(context.terrain_views(wet && stages.has(Stages::SURFACE)));
        self.rain.gather(now)
    }

    /// What streaks are worth in a picture, if the plan decides about them.
    pub fn unseen(&mut self, shot: &Shot<'_>) -> Option<Unseen> {
        self.rain.streaks(shot)
    }

    /// Whether the plan decides about anything that its gauge cannot see.
    pub fn weighs_unseen(&self) -> bool {
        self.rain.is_planned()
    }

    /// Work of building default tables, in pixels of a picture with these settings.
    pub fn rebuild_work(&self) -> f64 {
        let (work, price) = (sky::candidates::work, Price::default());
        work(&sky::SkySettings::default()).rebuild.at(&price) / work(self.sky.settings()).pixel.at(&price)
    }

    /// What a plan is saved with.
    pub fn saved_with(&self) -> plan::Settings<'_> {
        let settings = self.sky.settings();
        plan::Settings {
            model: settings.model.name(),
            check_model: |name| sky::SkyModel::from_name(name).map(|_| ()),
            numbers: settings.numbers().to_vec(),
        }
    }
}
