//! The list of effects: the state that a context holds for each, and the part of a view that draws each.
//!
//! Of all code above the effects' rooms, only this file, the front room and the C boundary may name those rooms. A new
//! effect adds a field to [`Effects`], a line in [`Effects::each`] and [`Effects::all`], and its parts to [`PARTS`]. An
//! effect with simulation state also adds a field to [`Held`], with a line in [`Held::each`] and [`Held::all`].

#[cfg(test)]
pub(crate) mod plane;

use std::{
    path::PathBuf,
    sync::{Arc, Mutex},
};

use glam::DVec2;

use crate::{
    almanac::sun::Utc,
    bow::BowView,
    clouds::{self, CloudsView, HeldClouds},
    error::Result,
    flow::HeldFlow,
    fog::{self, FogView, HeldFog, LowAirUniform},
    glass::GlassView,
    gpu::{Device, Shared, blocks::Blocks},
    ground::{GroundModel, GroundUniform, GroundView, HeldGround, LoadedGround},
    land::{HeldLand, LandView},
    light::{Exposure, ToneCurve},
    lightning::{HeldLightning, LightningView},
    moment::Scene,
    particles::FallingTexture,
    plan::{
        self, StepWork,
        parts::{MOST_RUNGS, Part},
    },
    planet::Planet,
    rain::{self, RainSettings, RainView, Streaks},
    scene::WorldFrame,
    sea::{HeldSea, SeaView},
    sky::{self, FollowedSky, SkySettings, SkyView, SkyVolume},
    snow::{self, FlakeContrast, SnowSettings, SnowView},
    snowpack::{HeldSnow, LoadedSnow, LyingSnowModel},
    soil::{HeldSoil, LoadedSoil},
    stage::{
        Composition, Constant, Contribution, DrawContext, DrawnEffect, FrameContext, MergedFrame, Outputs, Recording,
        ordered,
    },
    stars::{self, HeldStars, StarsView},
    world::{Couplings, HeldEffect, World},
};

/// Settings for a new context.
#[derive(Clone, Debug)]
pub struct ContextDesc {
    /// Mapping of the host's world onto the planet. Default a flat world, z up, at latitude 50 and longitude 10
    /// degrees.
    pub world: WorldFrame,
    /// Air, ground and sun. Default the Earth.
    pub planet: Planet,
    /// Seed of everything random. Default 0.
    pub seed: u64,
    /// Exposure of frames that set none. Default automatic.
    pub exposure: Exposure,
    /// Tone curve, from luminance to display values. Default exponential.
    pub tone: ToneCurve,
    /// Universal time at simulation time 0. Default 2026-06-21 10:00 UTC.
    pub utc_at_zero: Utc,
    /// Settings of the sky. Default the directional tables.
    pub sky: SkySettings,
    /// Source of the ground's wetness. Default the present weather.
    pub ground: GroundModel,
    /// Source of the lying snow. Default the present weather.
    pub lying_snow: LyingSnowModel,
    /// Directory that caches the sky's finished tables; it is created if it does not exist. The next start with the
    /// same planet, settings and weather reads the tables from there. Faults of the files are logged and are never an
    /// error. Default none.
    pub cache_dir: Option<PathBuf>,
}

impl Default for ContextDesc {
    fn default() -> Self {
        Self {
            world: WorldFrame::default(),
            planet: Planet::earth(),
            seed: 0,
            exposure: Exposure::default(),
            tone: ToneCurve::default(),
            utc_at_zero: Utc(1_782_036_000.0),
            sky: SkySettings::default(),
            ground: GroundModel::default(),
            lying_snow: LyingSnowModel::default(),
            cache_dir: None,
        }
    }
}

/// Functions by which a world learns how effects change the light and the clouds of a place. All worlds use the same
/// functions.
pub(crate) const COUPLINGS: Couplings =
    Couplings { dim: fog::dim, cloud_over_areas: clouds::cloud_over_areas, night_lux: stars::night_lux };

/// Simulation state of the effects of a context, shared by all its views.
pub(crate) struct Held {
    pub sky: Arc<Mutex<FollowedSky>>,
    /// Solved wind; it is advanced before the others, which may query the wind.
    pub flow: HeldFlow,
    /// Soil; it is advanced before snow and water, which lie on its heights.
    pub soil: HeldSoil,
    /// Lying snow; it is advanced before the ground, which takes its meltwater.
    pub snowpack: HeldSnow,
    pub fog: HeldFog,
    pub ground: HeldGround,
    pub stars: HeldStars,
    pub clouds: HeldClouds,
    pub lightning: HeldLightning,
    pub sea: HeldSea,
    pub land: HeldLand,
}

/// State of the effects that was read from a saved state and is not yet in use.
pub(crate) struct LoadedHeld {
    flow: HeldFlow,
    soil: LoadedSoil,
    snowpack: LoadedSnow,
    fog: HeldFog,
    ground: LoadedGround,
    stars: HeldStars,
    clouds: HeldClouds,
    lightning: HeldLightning,
    sea: HeldSea,
}

impl Held {
    /// Creates the state of a new context.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field of `desc`, or a GPU fault.
    pub fn new(device: &Arc<Device>, shared: &Shared, desc: &ContextDesc) -> Result<Self> {
        let library = shared.get(|| Ok(sky::SkyLibrary::default()))?;
        let sky = FollowedSky::new(device, &library, &desc.sky, desc.cache_dir.clone())?;
        Ok(Self {
            sky: Arc::new(Mutex::new(sky)),
            flow: HeldFlow::default(),
            soil: HeldSoil::default(),
            snowpack: HeldSnow::new(desc.lying_snow),
            fog: HeldFog::default(),
            ground: HeldGround::new(desc.ground, desc.seed),
            stars: HeldStars::default(),
            clouds: HeldClouds::default(),
            lightning: HeldLightning::default(),
            sea: HeldSea::default(),
            land: HeldLand::default(),
        })
    }

    /// Returns all effects with simulation state, in the order in which they are advanced.
    pub fn each(&mut self) -> [&mut dyn HeldEffect; 10] {
        [
            &mut self.flow,
            &mut self.soil,
            &mut self.snowpack,
            &mut self.fog,
            &mut self.ground,
            &mut self.stars,
            &mut self.clouds,
            &mut self.lightning,
            &mut self.sea,
            &mut self.land,
        ]
    }

    /// As [`Self::each`], by shared reference.
    pub fn all(&self) -> [&dyn HeldEffect; 10] {
        [
            &self.flow,
            &self.soil,
            &self.snowpack,
            &self.fog,
            &self.ground,
            &self.stars,
            &self.clouds,
            &self.lightning,
            &self.sea,
            &self.land,
        ]
    }

    /// Takes the effects' entries out of a saved state and reads them.
    ///
    /// # Errors
    /// [`crate::Status::Parse`] or [`crate::Status::InvalidArgument`], naming the entry that does not fit.
    pub fn read(&self, world: &World, state: &mut toml::Table) -> Result<LoadedHeld> {
        // Each effect takes its own entries out, even if those of another are wrong.
        let flow = HeldFlow::read(world, state);
        let soil = self.soil.read(world, state);
        let snowpack = self.snowpack.read(state);
        let fog = HeldFog::read(state);
        // The water of a state lies on tiles with the soil of that state.
        let tiles = soil.as_ref().map_or(world.set.tiles.as_deref(), |soil| soil.tiles());
        let ground = self.ground.read(world, tiles, state);
        let stars = HeldStars::read(state, self.stars.settings.stars.clone());
        let clouds = HeldClouds::read(state);
        let lightning = self.lightning.read(state);
        let sea = HeldSea::read(world, state);
        Ok(LoadedHeld {
            flow: flow?,
            soil: soil?,
            snowpack: snowpack?,
            fog: fog?,
            ground: ground?,
            stars: stars?,
            clouds: clouds?,
            lightning: lightning?,
            sea: sea?,
        })
    }

    /// Swaps a loaded state in; `other` then holds the previous one.
    pub fn swap_in(&mut self, world: &mut World, other: &mut LoadedHeld) {
        std::mem::swap(&mut self.fog, &mut other.fog);
        world.set.undimmed = self.fog.law.is_some();
        self.soil.swap_in(world, &mut other.soil);
        self.ground.swap_in(&mut other.ground);
        world.set.terrain = self.ground.heights();
        self.land.surface_class = self.ground.surface_class;
        self.snowpack.swap_in(world, &mut other.snowpack);
        std::mem::swap(&mut self.stars, &mut other.stars);
        std::mem::swap(&mut self.clouds, &mut other.clouds);
        std::mem::swap(&mut self.lightning, &mut other.lightning);
        std::mem::swap(&mut self.sea, &mut other.sea);
        world.night = self.stars.night();
        self.flow.swap_in(world, &mut other.flow);
        // The soil reads what the ground publishes before the ground is advanced again.
        self.ground.publish(world);
    }
}

/// Parts of the weather that a picture can reduce or leave out, in the order of all lists of parts.
pub const PARTS: &[Part] = &[
    sky::candidates::AIR,
    fog::candidates::FOG,
    sky::candidates::SKY,
    rain::candidates::RAIN,
    stars::candidates::STARS,
    clouds::candidates::CLOUDS,
    snow::candidates::SNOW,
];

/// Returns the two parts that cost extra work where both are drawn, and that extra work under the sun and the moon of
/// `scene`.
pub(crate) fn together(scene: &Scene) -> ([&'static Part; 2], StepWork) {
    ([&sky::candidates::AIR, &fog::candidates::FOG], sky::candidates::air_before_fog_work(scene.lamps()))
}

/// Sizes of the uniform blocks, indexed by [`Block`](crate::stage::Block).
pub(crate) const BLOCK_BYTES: [usize; 2] = [size_of::<LowAirUniform>(), size_of::<GroundUniform>()];

/// Creates the bind group layout of the look-up tables for the background and the air in front of objects.
pub(crate) fn tables_layout(device: &Device) -> wgpu::BindGroupLayout {
    SkyVolume::view_layout(device)
}

/// Changes of a picture by streaks and flakes, which the planner's gauge cannot see. They are computed in closed form.
#[derive(Clone, Copy)]
pub(crate) struct UnseenChanges {
    rain: Option<Streaks>,
    snow: Option<FlakeContrast>,
}

impl plan::Unseen for UnseenChanges {
    fn change(&self, part: &Part, pixel: usize, ndc: DVec2, picture: [f64; 2]) -> [f32; MOST_RUNGS - 1] {
        let found = match (&self.rain, &self.snow) {
            (Some(rain), _) if part.name == rain::candidates::RAIN.name => Some(rain.change(pixel, ndc, picture)),
            (_, Some(snow)) if part.name == snow::candidates::SNOW.name => Some(snow.change(pixel, ndc, picture)),
            _ => None,
        };
        found.unwrap_or_default()
    }
}

/// The effects of a view.
pub(crate) struct Effects {
    pub sky: SkyView,
    pub fog: FogView,
    pub ground: GroundView,
    pub rain: RainView,
    pub snow: SnowView,
    pub glass: GlassView,
    pub stars: StarsView,
    pub clouds: CloudsView,
    pub lightning: LightningView,
    pub bow: BowView,
    pub land: LandView,
    pub sea: SeaView,
    #[cfg(test)]
    pub plane: plane::PlaneView,
    /// Indices into [`Effects::each`]: the order in which effects gather, and the order in which they compose and draw.
    gathers: [usize; COUNT],
    composes: [usize; COUNT],
}

/// Number of effects of a view.
const COUNT: usize = if cfg!(test) { 13 } else { 12 };

impl Effects {
    /// Creates the effects of a view.
    ///
    /// # Errors
    /// A GPU fault.
    pub fn new(device: &Arc<Device>, (shared, blocks): (&Arc<Shared>, &Blocks), held: &Held) -> Result<Self> {
        let falling = FallingTexture::default();
        let mut effects = Self {
            sky: SkyView::new(&held.sky)?,
            fog: FogView::new(device, blocks),
            ground: GroundView::new(device, blocks),
            rain: RainView::new(device, blocks, RainSettings::default(), falling.clone()),
            snow: SnowView::new(SnowSettings::default(), falling),
            glass: GlassView::new(shared),
            stars: StarsView::default(),
            clouds: CloudsView::default(),
            lightning: LightningView::default(),
            bow: BowView::default(),
            land: LandView::new(blocks),
            sea: SeaView::default(),
            #[cfg(test)]
            plane: plane::PlaneView::default(),
            gathers: [0; COUNT],
            composes: [0; COUNT],
        };
        effects.gathers = ordered(effects.all().map(|effect| effect.gathers()))?;
        effects.composes = ordered(effects.all().map(|effect| effect.composes()))?;
        Ok(effects)
    }

    /// Returns all effects of a view. The order in which they run is not this one: it follows from the outputs that
    /// they exchange.
    pub fn each(&mut self) -> [&mut dyn DrawnEffect; COUNT] {
        [
            &mut self.sky,
            &mut self.fog,
            &mut self.ground,
            &mut self.stars,
            &mut self.clouds,
            &mut self.rain,
            &mut self.snow,
            &mut self.glass,
            &mut self.lightning,
            &mut self.bow,
            &mut self.land,
            &mut self.sea,
            #[cfg(test)]
            &mut self.plane,
        ]
    }

    /// As [`Self::each`], by shared reference.
    pub fn all(&self) -> [&dyn DrawnEffect; COUNT] {
        [
            &self.sky,
            &self.fog,
            &self.ground,
            &self.stars,
            &self.clouds,
            &self.rain,
            &self.snow,
            &self.glass,
            &self.lightning,
            &self.bow,
            &self.land,
            &self.sea,
            #[cfg(test)]
            &self.plane,
        ]
    }

    /// Lets each effect find what the camera can see of it, in the order of the outputs that the effects exchange.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the parameter.
    pub fn gather(&mut self, context: &FrameContext<'_>) -> Result<()> {
        let (order, mut given) = (self.gathers, Outputs::default());
        let mut effects = self.each();
        for place in order {
            let effect = &mut effects[place];
            let exchange = effect.gathers();
            let mut own = given.only(exchange.needs);
            effect.gather(context, &mut own)?;
            given.take(&own, exchange.gives);
        }
        Ok(())
    }

    /// Merges the contributions of all effects to a draw, in the order of the outputs that they exchange.
    ///
    /// # Errors
    /// A GPU fault.
    pub fn compose(&mut self, context: &DrawContext<'_>, composition: &mut Composition) -> Result<()> {
        let (order, mut given) = (self.composes, Outputs::default());
        let mut effects = self.each();
        for place in order {
            let effect = &mut effects[place];
            let exchange = effect.composes();
            let taken = (!exchange.needs.is_empty()).then(|| given.only(exchange.needs));
            let mut added = Contribution::none();
            effect.compose(context, taken.as_ref().unwrap_or(&Outputs::NONE), &mut added)?;
            given.take_layers(&added, exchange.gives);
            composition.merge(&mut added);
        }
        Ok(())
    }

    /// Draws the passes of all effects, in the order in which they are composed.
    ///
    /// # Errors
    /// A GPU fault.
    pub fn draw(
        &mut self,
        context: &DrawContext<'_>,
        merged: &MergedFrame<'_>,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        let order = self.composes;
        let mut effects = self.each();
        order.into_iter().try_for_each(|place| effects[place].draw(context, merged, recording))
    }

    /// Returns the changes of a picture by streaks and flakes, if the plan decides about streaks or flakes.
    pub fn unseen(&mut self, context: &DrawContext<'_>) -> Option<UnseenChanges> {
        let unseen = UnseenChanges { rain: self.rain.streaks(context), snow: self.snow.contrast(context) };
        (unseen.rain.is_some() || unseen.snow.is_some()).then_some(unseen)
    }

    /// Whether the plan decides about a part that its gauge cannot see.
    pub fn weighs_unseen(&self) -> bool {
        self.rain.is_planned() || self.snow.is_planned()
    }

    /// Returns the look-up tables of sky and air for opaque draws: layout, bind group, and constants.
    pub fn light_tables(&self) -> (wgpu::BindGroupLayout, wgpu::BindGroup, [Constant; 2]) {
        self.sky.tables()
    }

    /// Returns the work of building the tables of the sky's default settings, in units of the work of one pixel of the
    /// sky with the view's settings.
    pub fn rebuild_work(&self) -> f64 {
        self.sky.rebuild_work()
    }

    /// Returns the settings with which a plan is saved.
    pub fn saved_with(&self) -> plan::PlanSettings<'_> {
        let settings = self.sky.next_settings();
        plan::PlanSettings {
            model: settings.model.name(),
            check_model: |name| sky::SkyModel::from_name(name).map(|_| ()),
            numbers: settings.numbers().to_vec(),
        }
    }
}
