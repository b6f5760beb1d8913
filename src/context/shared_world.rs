//! The context's settings and queries that concern the world: weather, time, place, light and surroundings.

use std::sync::Arc;

use glam::DVec3;

use crate::{
    almanac::sun::Utc,
    effects::{COUPLINGS, ContextDesc, Held},
    error::{Error, Result},
    gpu::{Device, Shared},
    light::{Exposure, ToneCurve},
    moment::{GroundLight, Light, Scene, SceneMoment},
    scene::{HostLight, MAX_LIGHTS, WorldFrame},
    surroundings::{MAX_SHELTERS, OccluderMap, OccluderMaps, Shelter},
    weather::{AirAtHeight, Conditions, Overrides, Weather, derive, derive_with},
    world::{GivenDirection, KeptScene, Settings, World, WorldDesc},
};

/// Sun and moon as seen from a place, and the light that arrives there from both and from the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightAt {
    /// Sun, with directions in (east, north, up) of the place.
    pub sun: Light,
    /// Moon, with directions in (east, north, up) of the place.
    pub moon: Light,
    /// Light that arrives, after air, clouds and fog.
    pub arriving: GroundLight,
}

/// The weather, the time and the place that all views of a simulator share.
///
/// Thread rule: `&Context` from any number of threads, `&mut Context` exclusive.
pub struct Context {
    pub(super) device: Arc<Device>,
    pub(super) shared: Arc<Shared>,
    pub(crate) world: World,
    pub(crate) held: Held,
    /// Settings at the beginning of the update whose steps are not all done; `None` if no steps remain.
    pub(super) behind: Option<Box<Settings>>,
}

impl Context {
    /// Creates a context on `device`, with the default weather, at time 0. Contexts of one device share `shared`.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field of `desc`.
    pub fn new(device: Arc<Device>, shared: Arc<Shared>, desc: ContextDesc) -> Result<Self> {
        let made = WorldDesc {
            frame: desc.world,
            planet: desc.planet,
            seed: desc.seed,
            exposure: desc.exposure,
            tone: desc.tone,
            utc_at_zero: desc.utc_at_zero,
        };
        let world = World::new(made, derive(&Weather::default())?, COUPLINGS)?;
        let held = Held::new(&device, &shared, &desc)?;
        Ok(Self { device, shared, world, held, behind: None })
    }

    /// Returns the device of the context.
    pub fn device(&self) -> &Arc<Device> {
        &self.device
    }

    /// Returns the pipelines and tables that all contexts of the device share.
    pub fn shared(&self) -> &Arc<Shared> {
        &self.shared
    }

    /// Returns the placement of the host's world on the planet.
    pub fn world(&self) -> &WorldFrame {
        &self.world.frame
    }

    /// Returns the exposure of frames that set none of their own.
    pub fn exposure(&self) -> Exposure {
        self.world.exposure
    }

    /// Sets the exposure of frames that set none of their own.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn set_exposure(&mut self, exposure: Exposure) -> Result<()> {
        exposure.validate()?;
        self.world.exposure = exposure;
        Ok(())
    }

    /// Returns the curve from luminance to display values.
    pub fn tone_curve(&self) -> ToneCurve {
        self.world.tone
    }

    /// Sets the curve from luminance to display values, from the next frame on.
    pub fn set_tone_curve(&mut self, tone: ToneCurve) {
        self.world.tone = tone;
    }

    /// Changes the weather, beginning at simulation time `start_s` and lasting `transition_s`; see
    /// [`Timeline::change`](crate::weather::Timeline::change).
    ///
    /// # Errors
    /// As [`derive()`] and [`Timeline::change`](crate::weather::Timeline::change); the weather stays as it was.
    pub fn set_weather(&mut self, weather: &Weather, start_s: f64, transition_s: f64) -> Result<()> {
        self.world.change_weather(derive(weather)?, start_s, transition_s)?;
        self.refresh()
    }

    /// Changes the weather as [`Context::set_weather`] does, with the host's own values in place of some of the laws
    /// that derive one part of the weather from another.
    ///
    /// # Errors
    /// As [`derive_with`] and [`Timeline::change`](crate::weather::Timeline::change); the weather stays as it was.
    pub fn set_weather_with(
        &mut self,
        weather: &Weather,
        overrides: &Overrides,
        start_s: f64,
        transition_s: f64,
    ) -> Result<()> {
        self.world.change_weather(derive_with(weather, overrides)?, start_s, transition_s)?;
        self.refresh()
    }

    /// Sets the boxes that keep rain off (roofs, bridges, cabs), in place of those before. Set a moving box again every
    /// frame.
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
        let same = self.world.set.shelters.iter().filter(|s| s.stands()).eq(shelters.clone().filter(|s| s.stands()));
        self.world.set.shelters.clear();
        self.world.set.shelters.extend(shelters);
        if same {
            return Ok(());
        }
        self.world.surroundings_revision += 1;
        self.refresh()
    }

    /// Sets the occluder maps, in place of those before: depth textures of the host with the surfaces that keep rain
    /// off. An empty list removes them. Their content is copied in a submission of its own, after everything that is
    /// submitted already; the host may then draw into the textures again. There may be at most
    /// [`MAX_OCCLUDER_MAPS`](crate::surroundings::MAX_OCCLUDER_MAPS). Maps work best if drawn along
    /// [`RainAt::fall_velocity_m_s`](crate::rain::RainAt::fall_velocity_m_s). They are not part of a saved state: each
    /// channel may have its own.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] or [`crate::Status::Unsupported`] naming the map and its field,
    /// [`crate::Status::DeviceLost`]; nothing changes then.
    pub fn set_occluder_maps(&mut self, maps: &[OccluderMap<'_>]) -> Result<()> {
        let device = self.device.clone();
        let _entered = device.enter()?;
        let label = wgpu::CommandEncoderDescriptor { label: Some("occluder maps") };
        let mut encoder = device.device.create_command_encoder(&label);
        self.record_occluder_maps(maps, &mut encoder)?;
        device.submit(encoder);
        device.check()
    }

    /// Records [`Context::set_occluder_maps`] into an encoder that is submitted before the next frame.
    pub(crate) fn record_occluder_maps(
        &mut self,
        maps: &[OccluderMap<'_>],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<()> {
        let device = self.device.clone();
        let mut held = match self.world.maps.take() {
            Some(held) => held,
            None if maps.is_empty() => return Ok(()),
            None => Box::new(OccluderMaps::new(&device)?),
        };
        let outcome = held.set(&device, encoder, maps);
        self.world.maps = Some(held);
        outcome
    }

    /// Sets the host's lamps, in place of those before. They light the drops, flakes, clouds and wet or snowy ground in
    /// their beams. Set a moving lamp again every frame.
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
        self.world.lights.clear();
        self.world.lights.extend(lights);
        Ok(())
    }

    /// Returns the host's lamps.
    pub fn lights(&self) -> &[HostLight] {
        &self.world.lights
    }

    /// Returns the shelters that keep rain off.
    pub fn shelters(&self) -> &[Shelter] {
        &self.world.set.shelters
    }

    /// Returns the seed of everything random.
    pub fn seed(&self) -> u64 {
        self.world.seed
    }

    /// Returns the radius of the planet's ground, m.
    pub fn planet_radius_m(&self) -> f64 {
        self.world.set.planet.bottom_radius_m
    }

    /// Sets the clock: universal time is `utc` at simulation time `at_s`.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for times out of range.
    pub fn set_clock(&mut self, utc: Utc, at_s: f64) -> Result<()> {
        self.world.set_clock(utc, at_s)
    }

    /// Places the sun at the host's direction; `None` returns it to the almanac.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the angle.
    pub fn set_sun(&mut self, sun: Option<GivenDirection>) -> Result<()> {
        sun.map_or(Ok(()), |s| s.validate("sun"))?;
        self.world.set.given_sun = sun;
        Ok(())
    }

    /// Places the moon at the host's direction; `None` returns it to the almanac. If the host has set either direction,
    /// the moon's phase follows from both.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the angle.
    pub fn set_moon(&mut self, moon: Option<GivenDirection>) -> Result<()> {
        moon.map_or(Ok(()), |m| m.validate("moon"))?;
        self.world.set.given_moon = moon;
        Ok(())
    }

    /// Returns the simulation time, s.
    pub fn time_s(&self) -> f64 {
        self.world.time_s
    }

    /// Returns the universal time at simulation time `time_s`.
    pub fn utc_at(&self, time_s: f64) -> Utc {
        self.world.utc_at(time_s)
    }

    /// Returns the conditions at `position` and a past or future simulation time `time_s`, with the weather regions
    /// there ([`Context::set_weather_regions`]). Precipitation is that at the position itself: it includes the rain
    /// areas there ([`Context::set_rain_areas`]), weighted by their rims, and is zero above the cloud that it falls
    /// from. Rain and drizzle are those of [`Context::rain_at`]. The extinction of the precipitation, the total
    /// extinction and the visibility are those with this precipitation. All other fields hold at the station's height,
    /// as the doc of each says.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is invalid, or if the time is not finite, out of range, or
    /// before the earliest time that the timeline still knows
    /// ([`Timeline::known_from_s`](crate::weather::Timeline::known_from_s)).
    pub fn conditions_at(&self, position: DVec3, time_s: f64) -> Result<Conditions> {
        self.world.conditions_at(position, time_s)
    }

    /// Returns temperature, humidity and pressure at the place and altitude of `position`, at a past or future
    /// simulation time `time_s`, with the weather regions there; see [`Conditions::air_at_altitude_m`].
    ///
    /// # Errors
    /// As [`Context::conditions_at`].
    pub fn air_at(&self, position: DVec3, time_s: f64) -> Result<AirAtHeight> {
        let altitude_m = self.world.frame.place_at("position", position)?.place.altitude_m;
        Ok(self.world.weather_at(position, time_s)?.air_at_altitude_m(altitude_m))
    }

    /// Checks that the weather at a time is known.
    ///
    /// # Errors
    /// As [`Context::conditions_at`].
    pub fn check_time(&self, time_s: f64) -> Result<()> {
        self.world.over().check_time(time_s)
    }

    /// Returns the moment at a camera at `eye`; errors call this position `name`. `kept` is the scene of an earlier
    /// call, which is reused if nothing has changed since.
    ///
    /// # Errors
    /// As [`Context::scene_at`].
    pub(crate) fn moment(&self, name: &str, eye: DVec3, kept: &mut Option<Box<KeptScene>>) -> Result<SceneMoment<'_>> {
        self.world.moment(name, eye, kept)
    }

    /// Returns the scene from which a camera at `position` draws at a past or future simulation time `time_s`. It is a
    /// closed form and needs no device.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position does not lie on or above the planet; for times as
    /// [`Context::conditions_at`].
    pub fn scene_at(&self, position: DVec3, time_s: f64) -> Result<Scene> {
        self.world.scene_named("position", position, time_s)
    }

    /// Returns the sun and the moon above the air, and the light of sun, moon and sky that arrives at `position` at
    /// simulation time `time_s`, after air, clouds and fog.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is invalid; for times as [`Context::conditions_at`].
    pub fn light_at(&self, position: DVec3, time_s: f64) -> Result<LightAt> {
        let scene = self.scene_at(position, time_s)?;
        Ok(LightAt { sun: scene.sun, moon: scene.moon, arriving: scene.ground })
    }

    /// Updates the state that effects derive from weather and surroundings.
    pub(crate) fn refresh(&mut self) -> Result<()> {
        let world = &self.world;
        self.held.each().into_iter().try_for_each(|effect| effect.refresh(world))
    }
}
