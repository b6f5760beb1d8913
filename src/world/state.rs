//! State of a world, `World`: place, weather, time and surroundings, and the host's settings of each.

use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

use glam::DVec3;

use super::{
    color::color_columns,
    couplings::Couplings,
    detours::KeptDetours,
    dug::DugGround,
    settings::{NightSettings, Settings},
};
use crate::{
    almanac::{
        ephemeris::Ephemeris,
        sun::{Utc, sun_position},
    },
    error::{Result, check_range},
    falling::FallingLayer,
    light::{Exposure, ToneCurve},
    moment::WeatherOver,
    planet::Planet,
    scene::{Figure, HostLight, WorldFrame},
    surroundings::{LyingSnow, OccluderMaps, WindTexture},
    weather::{CloudMap, Conditions, GroundLayer, Timeline, lifting::lift_snow, timeline::MAX_TIME_S},
    wind::{Drift, LayerDrifts, Wind, WindOver, WindVolume},
};

/// Place, weather, time and surroundings.
pub(crate) struct World {
    pub frame: WorldFrame,
    pub seed: u64,
    pub exposure: Exposure,
    pub tone: ToneCurve,
    pub timeline: Timeline,
    /// Revision of the timeline. No two worlds share a revision, and every change of the timeline makes a new revision.
    pub(super) timeline_revision: u64,
    pub(super) wind: Wind,
    /// Drift of the air at the end of the last change that the timeline has forgotten.
    pub drifted: Drift,
    /// Drifts of the cloud layers at the time of `drifted`.
    pub(super) layers_drifted: LayerDrifts,
    pub set: Settings,
    pub night: NightSettings,
    pub maps: Option<Box<OccluderMaps>>,
    pub lights: Vec<HostLight>,
    /// Wind around terrain and boxes, if an effect has solved for it.
    pub solved_wind: Option<Box<WindVolume>>,
    pub(super) wind_texture: WindTexture,
    pub(super) detours: KeptDetours,
    /// The lying snow, if it is simulated.
    pub snow: Option<Box<LyingSnow>>,
    /// Ground that was dug, if the context has soil.
    pub dug: Option<Box<DugGround>>,
    pub time_s: f64,
    pub(super) ephemeris: Ephemeris,
    pub(super) couplings: Couplings,
    /// Revision of the rain areas, the static shelters and the map of cloud cover.
    pub surroundings_revision: u64,
    /// Revision of the weather regions.
    pub(super) regions_revision: u64,
}

/// Returns a number that no timeline and no settings have had.
pub(crate) fn next_revision() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// Description from which a world is created.
pub(crate) struct WorldDesc {
    pub frame: WorldFrame,
    pub planet: Planet,
    pub seed: u64,
    pub exposure: Exposure,
    pub tone: ToneCurve,
    pub utc_at_zero: Utc,
}

impl World {
    /// Creates a world with its first weather, at time 0.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn new(made: WorldDesc, weather: Conditions, couplings: Couplings) -> Result<Self> {
        let WorldDesc { frame, planet, seed, exposure, tone, utc_at_zero } = made;
        frame.validate()?;
        planet.check()?;
        let frame = WorldFrame { figure: Figure::of_radius(planet.bottom_radius_m), ..frame };
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
                weather_regions: Vec::new(),
                cloud_map: None,
                host_wind: None,
                given_sun: None,
                given_moon: None,
                utc_at_zero,
                undimmed: false,
                color: color_columns(&planet),
                planet,
            },
            night: NightSettings::default(),
            maps: None,
            lights: Vec::new(),
            solved_wind: None,
            wind_texture: WindTexture::default(),
            detours: KeptDetours::default(),
            snow: None,
            dug: None,
            time_s: 0.0,
            ephemeris: Ephemeris::default(),
            couplings,
            surroundings_revision: 0,
            regions_revision: 0,
        })
    }

    /// Changes the weather; see [`Timeline::change`].
    ///
    /// # Errors
    /// As [`Timeline::change`]; the weather stays as it was.
    pub fn change_weather(&mut self, weather: Conditions, start_s: f64, transition_s: f64) -> Result<()> {
        self.timeline.change(weather, start_s, transition_s)?;
        self.timeline_revision = next_revision();
        Ok(())
    }

    /// Returns the revision of the timeline. Every change of the timeline makes a new revision, and no two worlds share
    /// a revision.
    pub fn timeline_revision(&self) -> u64 {
        self.timeline_revision
    }

    /// Returns the weather over all places and times.
    pub fn over(&self) -> WeatherOver<'_> {
        let revision = self.timeline_revision;
        let (kept, kept_layers) = (self.drifted, &self.layers_drifted);
        let wind = WindOver { wind: &self.wind, timeline: &self.timeline, kept, kept_layers, revision };
        WeatherOver {
            world: &self.frame,
            wind,
            regions: &self.set.regions,
            weather_regions: &self.set.weather_regions,
            cloud_map: self.set.cloud_map.as_ref(),
        }
    }

    /// Returns the weather at a time outside all regions, with the snow that its wind lifts from the snow lying now.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the time is out of range or not finite, or if the weather at the time is
    /// forgotten.
    pub fn weather_outside(&self, time_s: f64) -> Result<Conditions> {
        self.over().check_time(time_s)?;
        Ok(self.with_lifted_snow(self.timeline.at(time_s)))
    }

    /// Returns the weather's low layer outside all regions at `time_s`. `c` is the weather at any place at that time.
    ///
    /// # Errors
    /// As [`World::weather_outside`].
    pub fn outer_fog(&self, c: &Conditions, time_s: f64) -> Result<GroundLayer> {
        Ok(if self.set.weather_regions.is_empty() { c.fog } else { self.weather_outside(time_s)?.fog })
    }

    /// Returns the weather at a place and time, with the weather regions there and the snow that the wind lifts from
    /// the snow lying now, without the rain areas. The position must be a place.
    ///
    /// # Errors
    /// As [`World::weather_outside`].
    pub fn weather_at(&self, position: DVec3, time_s: f64) -> Result<Conditions> {
        self.over().check_time(time_s)?;
        Ok(self.with_lifted_snow(self.over().weather_at(position, time_s)))
    }

    /// Returns a weather with the snow that its wind lifts from the snow lying now.
    fn with_lifted_snow(&self, mut c: Conditions) -> Conditions {
        if let Some(snow) = &self.snow {
            lift_snow(&mut c, snow.threshold_m_s, snow.cover);
        }
        c
    }

    /// Returns the weather at a place and time with the precipitation there.
    ///
    /// # Errors
    /// As [`World::weather_at`], and [`crate::Status::InvalidArgument`] for a position that is not a place.
    pub fn conditions_at(&self, position: DVec3, time_s: f64) -> Result<Conditions> {
        self.frame.place_at("position", position)?;
        Ok(self.over().falling_at(position, time_s, self.weather_at(position, time_s)?))
    }

    /// Sets the map of cloud cover, which replaces the earlier one.
    ///
    /// # Errors
    /// As [`CloudMap::validate`]; the earlier map then stays.
    pub fn set_cloud_map(&mut self, map: Option<CloudMap>) -> Result<()> {
        map.as_ref().map_or(Ok(()), CloudMap::validate)?;
        self.set.cloud_map = map.map(Arc::new);
        self.surroundings_revision += 1;
        Ok(())
    }

    /// Returns universal time at simulation time `time_s`.
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

    /// Replaces the planet.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; the planet then stays as it was.
    pub fn set_planet(&mut self, planet: Planet) -> Result<()> {
        planet.check()?;
        self.set.color = color_columns(&planet);
        self.frame.figure = Figure::of_radius(planet.bottom_radius_m);
        self.set.planet = planet;
        Ok(())
    }

    /// Forgets changes of the weather that ended before `keep_s`, the earliest time of later queries.
    pub fn forget_before(&mut self, keep_s: f64) {
        self.drifted = self.drifted.kept(&self.wind, &self.timeline, keep_s);
        self.layers_drifted = self.layers_drifted.kept(&self.timeline, keep_s);
        self.timeline.advance_keeping(self.time_s, keep_s);
    }

    /// Returns the precipitation of `c`, the weather outside all rain areas, as a layer with its extinction. The layer
    /// is empty if the host's fog law replaces the weather's low layer.
    pub fn falling(&self, c: &Conditions) -> FallingLayer {
        if self.set.undimmed { FallingLayer::NONE } else { FallingLayer::new(c) }
    }
}
