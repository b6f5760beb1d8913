//! A context: the weather, the time and the place that all views of a simulator share.
//!
//! Everything here is a function of (description, timeline, time, position): two contexts that were told the same
//! answer alike on every machine. The queries need no device and no frame.

mod air;
mod areas;
mod ground;
mod ground_texture;
mod lights;
mod queries;
mod rain;
mod saved_settings;
mod scene;
mod sky;
mod state;
mod terrain;
mod terrain_rain;
mod terrain_saved;
mod update;
mod wind;

use std::{
    cell::OnceCell,
    path::PathBuf,
    sync::{Arc, Mutex},
};

use glam::DVec3;

pub use crate::moment::{GroundLight, Light, Scene};
use crate::moment::{Moment, OwnRain, Region, WeatherOver};
pub use ground::{GroundAt, GroundModel};
pub use queries::{Between, LightAt};
pub use rain::{RainAt, RainOn, RainSurface};
pub use terrain::GroundCell;
pub(crate) use update::UPDATE_TIME;

use crate::{
    error::{Error, Result, check_range},
    fog::Law,
    gpu::{Device, Shared},
    ground::{Hollows, SurfaceClass, texture::TerrainTextures},
    light::{Exposure, ToneCurve},
    scene::{HostLight, MAX_LIGHTS, WorldFrame},
    sky::{
        FollowedSky, Planet, SkySettings,
        ephemeris::Ephemeris,
        sun::{Utc, direction},
    },
    surroundings::{MAX_SHELTERS, OccluderMap, OccluderMaps, Shelter},
    weather::{Conditions, Overrides, Timeline, Weather, derive, derive_with, timeline::MAX_TIME_S},
    wind::{Drift, Wind, WindGrid, WindOver},
};

/// How to make a context.
#[derive(Clone, Debug)]
pub struct ContextDesc {
    /// How the host's world lies on the planet.
    pub world: WorldFrame,
    /// Air, ground and sun. Default the Earth.
    pub planet: Planet,
    /// Seed of everything that chance decides.
    pub seed: u64,
    /// Exposure of frames that bring none.
    pub exposure: Exposure,
    /// From luminance to the display.
    pub tone: ToneCurve,
    /// Universal time at simulation time 0. Default 2026-06-21 10:00 UTC.
    pub utc_at_zero: Utc,
    /// How the sky is drawn. Default the directional tables.
    pub sky: SkySettings,
    /// Where the wetness of the ground comes from. Default the weather of the moment.
    pub ground: GroundModel,
    /// A directory for the sky's finished tables, made if it is not there: the next start with the same planet, settings
    /// and weather reads them. What goes wrong with its files is logged, never an error. Default none.
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
            cache_dir: None,
        }
    }
}

/// A direction to a light, given by the host in place of the almanac.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenDirection {
    /// Degrees clockwise from true north, [-360, 360].
    pub azimuth_deg: f64,
    /// Degrees above the horizon, without refraction, [-90, 90].
    pub elevation_deg: f64,
}

impl GivenDirection {
    fn validate(&self, name: &str) -> Result<()> {
        check_range(&format!("{name}.azimuth_deg"), self.azimuth_deg, -360.0, 360.0, "deg")?;
        check_range(&format!("{name}.elevation_deg"), self.elevation_deg, -90.0, 90.0, "deg")
    }

    fn unit(&self) -> DVec3 {
        direction(self.azimuth_deg, self.elevation_deg)
    }
}

/// The weather, the time and the place that all views of a simulator share.
///
/// Thread rule: `&Context` from any number of threads, `&mut Context` exclusive.
pub struct Context {
    device: Arc<Device>,
    shared: Arc<Shared>,
    sky: Arc<Mutex<FollowedSky>>,
    /// Colours of light at the planet's wavelengths; fitted once, which takes some milliseconds.
    color: [[f64; 3]; 3],
    desc: ContextDesc,
    timeline: Timeline,
    wind: Wind,
    /// How far the wind had carried the air when the last change ended that the timeline has forgotten.
    drifted: Drift,
    given_sun: Option<GivenDirection>,
    given_moon: Option<GivenDirection>,
    fog_law: Option<Law>,
    shelters: Vec<Shelter>,
    areas: Vec<Region>,
    maps: Option<Box<OccluderMaps>>,
    lights: Vec<HostLight>,
    wind_grid: Option<Arc<WindGrid>>,
    time_s: f64,
    ephemeris: Ephemeris,
    hollows: Hollows,
    ground: Option<ground::GroundState>,
    behind: Option<Box<update::Behind>>,
    host_ground: Option<Box<terrain::HostGround>>,
    ground_revision: u64,
    /// Another number for each grid.
    ground_generation: u64,
    /// Incremented whenever the host says anew what its terrain is made of.
    classes_revision: u64,
    /// Of ground of which nothing else is said.
    surface_class: SurfaceClass,
    terrain_textures: Mutex<TerrainTextures>,
    /// Counts what the host has told of areas and of standing shelter.
    told: u64,
}

impl Context {
    /// Makes a context on `device`, with the default weather, at time 0. Contexts of one device share `shared`.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field of `desc`.
    pub fn new(device: Arc<Device>, shared: Arc<Shared>, desc: ContextDesc) -> Result<Self> {
        desc.world.validate()?;
        desc.planet.check()?;
        desc.exposure.validate()?;
        crate::sky::sun::sun_position(desc.utc_at_zero, &desc.world.origin)?;
        let timeline = Timeline::new(derive(&Weather::default())?);
        let sky = FollowedSky::new(
            &device,
            &*shared.get(|| Ok(crate::sky::SkyLibrary::default()))?,
            &desc.sky,
            desc.cache_dir.clone(),
        )?;
        let sky = Arc::new(Mutex::new(sky));
        let color = lights::color_columns(&desc.planet);
        let hollows = Hollows::new(desc.seed);
        Ok(Self {
            device,
            shared,
            sky,
            color,
            wind: Wind::new(desc.seed),
            drifted: Drift::ZERO,
            desc,
            timeline,
            given_sun: None,
            given_moon: None,
            fog_law: None,
            shelters: Vec::new(),
            areas: Vec::new(),
            maps: None,
            lights: Vec::new(),
            wind_grid: None,
            time_s: 0.0,
            ephemeris: Ephemeris::default(),
            hollows,
            ground: None,
            behind: None,
            host_ground: None,
            ground_revision: 0,
            ground_generation: 0,
            classes_revision: 0,
            surface_class: SurfaceClass::Unspecified,
            terrain_textures: Mutex::default(),
            told: 0,
        })
    }

    /// The device it was made on.
    pub fn device(&self) -> &Arc<Device> {
        &self.device
    }

    /// Pipelines and tables it shares with other contexts of the device.
    pub fn shared(&self) -> &Arc<Shared> {
        &self.shared
    }

    /// Where the host's world lies.
    pub fn world(&self) -> &WorldFrame {
        &self.desc.world
    }

    /// Exposure of frames that bring none.
    pub fn exposure(&self) -> Exposure {
        self.desc.exposure
    }

    /// Sets the exposure of frames that bring none.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn set_exposure(&mut self, exposure: Exposure) -> Result<()> {
        exposure.validate()?;
        self.desc.exposure = exposure;
        Ok(())
    }

    /// From luminance to the display.
    pub fn tone_curve(&self) -> ToneCurve {
        self.desc.tone
    }

    /// Changes the weather, beginning at simulation time `start_s` and lasting `transition_s`; see
    /// [`Timeline::change`].
    ///
    /// # Errors
    /// As [`derive()`] and [`Timeline::change`]; the weather stays as it was.
    pub fn set_weather(&mut self, weather: &Weather, start_s: f64, transition_s: f64) -> Result<()> {
        self.timeline.change(derive(weather)?, start_s, transition_s)?;
        self.show_terrain()
    }

    /// As [`Context::set_weather`], with the host's own figures in place of some couplings.
    ///
    /// # Errors
    /// As [`derive_with`] and [`Timeline::change`]; the weather stays as it was.
    pub fn set_weather_with(
        &mut self,
        weather: &Weather,
        overrides: &Overrides,
        start_s: f64,
        transition_s: f64,
    ) -> Result<()> {
        self.timeline.change(derive_with(weather, overrides)?, start_s, transition_s)?;
        self.show_terrain()
    }

    /// Draws one of the older simulators' fog laws in place of the weather's fog; `None` returns to the weather's.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the parameter.
    pub fn set_fog_law(&mut self, law: Option<Law>) -> Result<()> {
        law.as_ref().map_or(Ok(()), Law::validate)?;
        self.fog_law = law;
        Ok(())
    }

    /// What keeps rain off, in place of what did before: roofs, bridges, cabs. A moving box is set anew every frame.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for more than [`MAX_SHELTERS`], or naming the field; nothing changes then.
    pub fn set_shelters<'a>(&mut self, shelters: impl IntoIterator<Item = &'a Shelter, IntoIter: Clone>) -> Result<()> {
        let shelters = shelters.into_iter();
        let count = shelters.clone().count();
        if count > MAX_SHELTERS {
            return Err(Error::range("shelters", &format!("at most {MAX_SHELTERS}"), count));
        }
        shelters.clone().try_for_each(Shelter::validate)?;
        let same = self.shelters.iter().filter(|s| s.stands()).eq(shelters.clone().filter(|s| s.stands()));
        self.shelters.clear();
        self.shelters.extend(shelters);
        if same {
            return Ok(());
        }
        self.told += 1;
        self.show_terrain()
    }

    /// What keeps rain off, as depth textures of the host's own, in place of those before; an empty list takes them away. What
    /// they show is taken over in a submission of its own, after what is submitted already: the host may then draw into them
    /// again. At most [`crate::rain::MAX_OCCLUDER_MAPS`]. Best taken along [`RainAt::fall_velocity_m_s`]. Not part of a saved state: each
    /// channel may have its own.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] or [`crate::Status::Unsupported`] naming the map and its field, [`crate::Status::DeviceLost`]; nothing
    /// changes then.
    pub fn set_occluder_maps(&mut self, maps: &[OccluderMap<'_>]) -> Result<()> {
        let device = self.device.clone();
        let _entered = device.enter()?;
        let label = wgpu::CommandEncoderDescriptor { label: Some("occluder maps") };
        let mut encoder = device.device.create_command_encoder(&label);
        self.record_occluder_maps(maps, &mut encoder)?;
        device.submit(encoder);
        device.check()
    }

    /// As [`Context::set_occluder_maps`], into an encoder that is submitted before the next frame.
    pub(crate) fn record_occluder_maps(
        &mut self,
        maps: &[OccluderMap<'_>],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<()> {
        let device = self.device.clone();
        let mut held = match self.maps.take() {
            Some(held) => held,
            None if maps.is_empty() => return Ok(()),
            None => Box::new(OccluderMaps::new(&device)?),
        };
        let outcome = held.set(&device, encoder, maps);
        self.maps = Some(held);
        outcome
    }

    /// The host's lamps, in place of those before: they light what Welkin draws in their beams (today rain). A moving lamp is
    /// set anew every frame.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for more than [`MAX_LIGHTS`], or naming the field; nothing changes then.
    pub fn set_lights<'a>(&mut self, lights: impl IntoIterator<Item = &'a HostLight, IntoIter: Clone>) -> Result<()> {
        let lights = lights.into_iter();
        let count = lights.clone().count();
        if count > MAX_LIGHTS {
            return Err(Error::range("lights", &format!("at most {MAX_LIGHTS}"), count));
        }
        lights.clone().try_for_each(HostLight::validate)?;
        self.lights.clear();
        self.lights.extend(lights);
        Ok(())
    }

    /// The host's lamps.
    pub fn lights(&self) -> &[HostLight] {
        &self.lights
    }

    /// What keeps rain off.
    pub fn shelters(&self) -> &[Shelter] {
        &self.shelters
    }

    /// The fog law that the host asked for.
    pub fn fog_law(&self) -> Option<&Law> {
        self.fog_law.as_ref()
    }

    /// Seed of everything that chance decides.
    pub fn seed(&self) -> u64 {
        self.desc.seed
    }

    /// Hollows of the ground, in which water stands.
    pub fn hollows(&self) -> &Hollows {
        &self.hollows
    }

    /// Radius of the planet's ground, m.
    pub fn planet_radius_m(&self) -> f64 {
        self.desc.planet.bottom_radius_m
    }

    /// Ties universal time to simulation time: it is `utc` at simulation time `at_s`.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for times out of range.
    pub fn set_clock(&mut self, utc: Utc, at_s: f64) -> Result<()> {
        check_range("time_s", at_s, -MAX_TIME_S, MAX_TIME_S, "s")?;
        let zero = Utc(utc.0 - at_s);
        crate::sky::sun::sun_position(zero, &self.desc.world.origin)?;
        self.desc.utc_at_zero = zero;
        Ok(())
    }

    /// Puts the sun where the host says; `None` returns it to the almanac.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the angle.
    pub fn set_sun(&mut self, sun: Option<GivenDirection>) -> Result<()> {
        sun.map_or(Ok(()), |s| s.validate("sun"))?;
        self.given_sun = sun;
        Ok(())
    }

    /// Puts the moon where the host says (its phase follows from the sun's place); `None` returns it to the almanac.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the angle.
    pub fn set_moon(&mut self, moon: Option<GivenDirection>) -> Result<()> {
        moon.map_or(Ok(()), |m| m.validate("moon"))?;
        self.given_moon = moon;
        Ok(())
    }

    /// Simulation time, s.
    pub fn time_s(&self) -> f64 {
        self.time_s
    }

    /// Universal time at simulation time `time_s`.
    pub fn utc_at(&self, time_s: f64) -> Utc {
        Utc(self.desc.utc_at_zero.0 + time_s)
    }

    /// The weather's conditions over `position` at simulation time `time_s`, past or to come, at the station's height
    /// (each field says so). One weather reaches over all of the world in this version: the position must be a place, and
    /// every place answers alike.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is no place, or the time is not finite, out of range, or before what
    /// the timeline still knows ([`Timeline::known_from_s`]).
    pub fn conditions_at(&self, position: DVec3, time_s: f64) -> Result<Conditions> {
        self.desc.world.place_at("position", position)?;
        self.weather_at(time_s)
    }

    /// Refuses a time of which the weather is not known.
    ///
    /// # Errors
    /// As [`Context::conditions_at`].
    pub fn check_time(&self, time_s: f64) -> Result<()> {
        self.over().check_time(time_s)
    }

    /// The weather over all places and times.
    pub(crate) fn over(&self) -> WeatherOver<'_> {
        let wind = WindOver { wind: &self.wind, timeline: &self.timeline, kept: self.drifted };
        WeatherOver { world: &self.desc.world, wind, regions: &self.areas }
    }

    /// What holds now at a camera that stands at `eye`, which the host calls `name`.
    ///
    /// # Errors
    /// As [`Context::scene_at`].
    pub(crate) fn moment(&self, name: &str, eye: DVec3) -> Result<Moment<'_>> {
        let scene = self.scene_named(name, eye, self.time_s)?;
        let weather = self.over();
        Ok(Moment {
            eye,
            time_s: self.time_s,
            seed: self.desc.seed,
            tone: self.desc.tone,
            exposure: self.desc.exposure,
            planet_radius_m: self.desc.planet.bottom_radius_m,
            weather,
            here: weather.at_place(eye, self.time_s, scene.conditions),
            own_rain: if self.areas.is_empty() { OwnRain::NONE } else { self.own_rain(&scene.conditions) },
            shelters: &self.shelters,
            maps: self.maps.as_deref(),
            lamps: &self.lights,
            wind_grid: self.wind_grid.as_ref(),
            carried: OnceCell::new(),
            scene,
        })
    }

    fn weather_at(&self, time_s: f64) -> Result<Conditions> {
        self.check_time(time_s)?;
        Ok(self.timeline.at(time_s))
    }
}
