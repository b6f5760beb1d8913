//! The world that all views of a simulator share: its place on the planet, the timeline of weathers, the clock and its
//! lights, the wind, and the host's shelters, occluder maps and lamps. It names no effect; effects that have a state of
//! their own are led along with it ([`HeldEffect`]).
//!
//! Everything here is a function of (description, timeline, time, position): two worlds with the same input answer
//! alike on every machine, without a device and a frame.

mod air;
mod binary;
mod held;
mod kept;
mod lights;
mod regions;
mod saved;
mod saved_settings;
mod scene;
mod wind;

use std::{
    cell::OnceCell,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
};

use glam::{DMat3, DVec3};

use air::planet_under;
pub(crate) use binary::{binary_text, text_binary};
pub(crate) use held::{HeldEffect, HeldEffects, Within};
pub(crate) use kept::KeptScene;
pub(crate) use lights::color_of;
pub(crate) use saved::{LoadedWorld, SavedWorld, parse_error};
pub(crate) use saved_settings::{values, words};
pub(crate) use scene::{light_above_clouds, night_share, zenith_depth};
use wind::KeptDetours;

use crate::{
    almanac::{
        ephemeris::Ephemeris,
        sun::{Utc, direction, sun_position},
    },
    error::{Result, check_range},
    falling::FallingLayer,
    light::{Exposure, ToneCurve},
    moment::{Region, Scene, SceneMoment, WeatherOver},
    planet::Planet,
    scene::{HostLight, LocalFrame, Place, WorldFrame},
    surroundings::{LyingSnow, OccluderMaps, Shelter, TerrainHeights, WindTexture},
    terrain::Terrain,
    weather::{CloudMap, CloudSlab, Conditions, Timeline, lifting::lift_snow, timeline::MAX_TIME_S},
    wind::{Drift, LayerDrifts, Wind, WindGrid, WindOver, WindVolume},
};

/// A direction to a light, given by the host in place of the almanac.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenDirection {
    /// Degrees clockwise from true north, [-360, 360].
    pub azimuth_deg: f64,
    /// Degrees above the horizon, without refraction, [-90, 90].
    pub elevation_deg: f64,
}

impl GivenDirection {
    pub(crate) fn validate(&self, name: &str) -> Result<()> {
        check_range(&format!("{name}.azimuth_deg"), self.azimuth_deg, -360.0, 360.0, "deg")?;
        check_range(&format!("{name}.elevation_deg"), self.elevation_deg, -90.0, 90.0, "deg")
    }

    pub(crate) fn unit(&self) -> DVec3 {
        direction(self.azimuth_deg, self.elevation_deg)
    }
}

/// The host's settings of the night sky that decide how much it lights the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NightSettings {
    /// Strength of the airglow, 1 near the sun's least activity.
    pub airglow: f64,
    /// From the equator and equinox of J2000.0 to (east, north, up), in place of the planet's own turning.
    pub celestial_to_world: Option<DMat3>,
}

impl Default for NightSettings {
    fn default() -> Self {
        Self { airglow: 1.0, celestial_to_world: None }
    }
}

/// Settings of the host that decide a step of what is simulated. Steps that an update leaves for another call are done
/// under the settings at the time of the update.
#[derive(Clone)]
pub(crate) struct Settings {
    pub shelters: Vec<Shelter>,
    /// The host's terrain; whatever holds it saves it.
    pub terrain: Option<Arc<TerrainHeights>>,
    /// The host's terrain in tiles, of which the host keeps the heights; never together with `terrain`.
    pub tiles: Option<Arc<Terrain>>,
    pub regions: Vec<Region>,
    /// Where over the ground layers of cloud stand.
    pub cloud_map: Option<Arc<CloudMap>>,
    /// The host's wind that varies in space.
    pub host_wind: Option<Arc<HostWind>>,
    pub given_sun: Option<GivenDirection>,
    pub given_moon: Option<GivenDirection>,
    /// Universal time at simulation time 0.
    pub utc_at_zero: Utc,
    /// A law of the host's stands in for the weather's low layer, which then takes no light.
    pub undimmed: bool,
    pub planet: Planet,
    /// Colours of light at the planet's wavelengths; fitted once, which takes some milliseconds.
    color: [[f64; 3]; 3],
}

/// A wind that varies in space as the host gave it, and in the form that is read.
pub(crate) struct HostWind {
    pub grid: Arc<WindGrid>,
    pub volume: WindVolume,
}

/// Function by which an effect changes the light of a scene.
pub(crate) type Dim = fn(&mut Scene) -> Result<()>;

/// The cloud over rain areas as it stands over a place, `eye` in the host's world.
pub(crate) type CloudOverAreas =
    fn(&WeatherOver<'_>, &Conditions, (&LocalFrame, DVec3), f64) -> Result<Option<CloudSlab>>;

/// Light of the moonless sky on level ground at a time and place, lux, under air of given optical depths straight up.
pub(crate) type NightLux = fn(Utc, &Place, [f64; 3], &NightSettings) -> Result<[f64; 3]>;

/// Functions by which the effects act on every world.
#[derive(Clone, Copy)]
pub(crate) struct Couplings {
    /// Takes the light that the weather's low layer takes.
    pub dim: Dim,
    /// The cloud over rain areas that takes light from a place, with the part of the sky that it covers there.
    pub cloud_over_areas: CloudOverAreas,
    /// Light of the moonless sky on level ground, lux a channel, at a time and place where the air's optical depths
    /// straight up are given.
    pub night_lux: NightLux,
}

/// Place, weather, time and surroundings.
pub(crate) struct World {
    pub frame: WorldFrame,
    pub seed: u64,
    pub exposure: Exposure,
    pub tone: ToneCurve,
    pub timeline: Timeline,
    /// Revision of the timeline: no two worlds share one, and every change of the timeline makes a new one.
    timeline_revision: u64,
    wind: Wind,
    /// How far the wind had carried the air when the last change ended that the timeline has forgotten.
    pub drifted: Drift,
    /// Drifts of the layers of cloud at that time.
    layers_drifted: LayerDrifts,
    pub set: Settings,
    pub night: NightSettings,
    pub maps: Option<Box<OccluderMaps>>,
    pub lights: Vec<HostLight>,
    /// The wind round terrain and boxes, where something has solved for it.
    pub solved_wind: Option<Box<WindVolume>>,
    wind_texture: WindTexture,
    detours: KeptDetours,
    /// The lying snow, where it is led through time.
    pub snow: Option<Box<LyingSnow>>,
    pub time_s: f64,
    ephemeris: Ephemeris,
    couplings: Couplings,
    /// Revision of the rain areas and static shelters.
    pub surroundings_revision: u64,
}

/// A number that no timeline has had.
fn next_revision() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// Description that a world is made from.
pub(crate) struct WorldDesc {
    pub frame: WorldFrame,
    pub planet: Planet,
    pub seed: u64,
    pub exposure: Exposure,
    pub tone: ToneCurve,
    pub utc_at_zero: Utc,
}

impl World {
    /// With a first weather, at time 0.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn new(made: WorldDesc, weather: Conditions, couplings: Couplings) -> Result<Self> {
        let WorldDesc { frame, planet, seed, exposure, tone, utc_at_zero } = made;
        frame.validate()?;
        planet.check()?;
        exposure.validate()?;
        sun_position(utc_at_zero, &frame.origin)?;
        Ok(Self {
            frame,
            seed,
            exposure,
            tone,
            timeline: Timeline::new(weather),
            timeline_revision: next_revision(),
            wind: Wind::new(seed),
            drifted: Drift::ZERO,
            layers_drifted: LayerDrifts::ZERO,
            set: Settings {
                shelters: Vec::new(),
                terrain: None,
                tiles: None,
                regions: Vec::new(),
                cloud_map: None,
                host_wind: None,
                given_sun: None,
                given_moon: None,
                utc_at_zero,
                undimmed: false,
                color: lights::color_columns(&planet),
                planet,
            },
            night: NightSettings::default(),
            maps: None,
            lights: Vec::new(),
            solved_wind: None,
            wind_texture: WindTexture::default(),
            detours: KeptDetours::default(),
            snow: None,
            time_s: 0.0,
            ephemeris: Ephemeris::default(),
            couplings,
            surroundings_revision: 0,
        })
    }

    /// Changes the weather; see [`Timeline::change`].
    ///
    /// # Errors
    /// As [`Timeline::change`]; the weather stays as it was.
    pub fn change_weather(&mut self, to: Conditions, start_s: f64, transition_s: f64) -> Result<()> {
        self.timeline.change(to, start_s, transition_s)?;
        self.timeline_revision = next_revision();
        Ok(())
    }

    /// The weather over all places and times.
    pub fn over(&self) -> WeatherOver<'_> {
        let revision = self.timeline_revision;
        let (kept, kept_layers) = (self.drifted, &self.layers_drifted);
        let wind = WindOver { wind: &self.wind, timeline: &self.timeline, kept, kept_layers, revision };
        WeatherOver { world: &self.frame, wind, regions: &self.set.regions, cloud_map: self.set.cloud_map.as_ref() }
    }

    /// The weather at a time, with what its wind lifts of the snow that lies now.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the time is not finite, out of range or forgotten.
    pub fn weather_at(&self, time_s: f64) -> Result<Conditions> {
        self.over().check_time(time_s)?;
        let mut c = self.timeline.at(time_s);
        if let Some(snow) = &self.snow {
            lift_snow(&mut c, snow.threshold_m_s, snow.cover);
        }
        Ok(c)
    }

    /// The weather at a time with what falls at a place.
    ///
    /// # Errors
    /// As [`World::weather_at`]; for what is no place.
    pub fn conditions_at(&self, position: DVec3, time_s: f64) -> Result<Conditions> {
        self.frame.place_at("position", position)?;
        Ok(self.over().falling_at(position, time_s, self.weather_at(time_s)?))
    }

    /// Lays a map on layers of cloud, in place of the one before.
    ///
    /// # Errors
    /// As [`CloudMap::validate`]; nothing changes then.
    pub fn set_cloud_map(&mut self, map: Option<CloudMap>) -> Result<()> {
        map.as_ref().map_or(Ok(()), CloudMap::validate)?;
        self.set.cloud_map = map.map(Arc::new);
        self.surroundings_revision += 1;
        Ok(())
    }

    /// Universal time at simulation time `time_s`.
    pub fn utc_at(&self, time_s: f64) -> Utc {
        Utc(self.set.utc_at_zero.0 + time_s)
    }

    /// Ties universal time to simulation time: it is `utc` at simulation time `at_s`.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for times out of range.
    pub fn set_clock(&mut self, utc: Utc, at_s: f64) -> Result<()> {
        check_range("time_s", at_s, -MAX_TIME_S, MAX_TIME_S, "s")?;
        let zero = Utc(utc.0 - at_s);
        sun_position(zero, &self.frame.origin)?;
        self.set.utc_at_zero = zero;
        Ok(())
    }

    /// Puts another planet in place of the one before.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_planet(&mut self, planet: Planet) -> Result<()> {
        planet.check()?;
        self.set.color = lights::color_columns(&planet);
        self.set.planet = planet;
        Ok(())
    }

    /// Forgets what has ended, but for what is asked from `keep_s` on.
    pub fn forget_before(&mut self, keep_s: f64) {
        self.drifted = self.drifted.kept(&self.wind, &self.timeline, keep_s);
        self.layers_drifted = self.layers_drifted.kept(&self.timeline, keep_s);
        self.timeline.advance_keeping(self.time_s, keep_s);
    }

    /// Extinction of what falls in the weather `c` outside of all regions; none where a law of the host's stands in for
    /// it.
    pub fn falling(&self, c: &Conditions) -> FallingLayer {
        if self.set.undimmed { FallingLayer::NONE } else { FallingLayer::new(c) }
    }

    /// Returns the moment at a camera that stands at `eye`, which the host calls `name`; `kept` is the scene of an
    /// earlier call, taken again where nothing has changed since.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is not a place on or above the planet.
    pub fn moment(&self, name: &str, eye: DVec3, kept: &mut Option<Box<KeptScene>>) -> Result<SceneMoment<'_>> {
        let KeptScene { scene, here, wind, .. } = self.scene_kept(name, eye, kept)?;
        let weather = self.over();
        let carried = wind.map(|now| weather.wind.carrying_as(self.time_s, now));
        Ok(SceneMoment {
            eye,
            time_s: self.time_s,
            seed: self.seed,
            tone: self.tone,
            exposure: self.exposure,
            planet_radius_m: self.set.planet.bottom_radius_m,
            weather,
            here,
            falling: self.falling(&scene.conditions),
            shelters: &self.set.shelters,
            maps: self.maps.as_deref(),
            lamps: &self.lights,
            wind_volume: self.wind_volume(self.time_s),
            wind_texture: &self.wind_texture,
            detour: self.detour(eye, &scene.conditions, self.time_s),
            carried: carried.map_or_else(OnceCell::new, OnceCell::from),
            flash: OnceCell::new(),
            scene,
        })
    }
}
