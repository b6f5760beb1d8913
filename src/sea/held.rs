//! The sea of a context: its settings, the states of growth after changes that the timeline has forgotten, and the
//! results that queries keep.

use std::sync::{Arc, Mutex, PoisonError};

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::{
    clarity::WaterClarity,
    growth::GrowthState,
    history::DatedGrowth,
    hull::{MAX_SEA_HULLS, SeaHull},
    ice::SeaIce,
    model::{PreparedSea, SeaStatistics, SeaWorkshop, WeatherPast},
    regions::{MAX_SEA_REGIONS, PlacedRegion, SeaRegion, WaterBody, water_at},
    settings::{SeaSettings, SeaSwell, Tide, WindSea},
    single::SingleWave,
    surface::SeaSurface,
    track::HullTrack,
    wake_field::Wake,
};
use crate::{
    error::{Error, Result, Status},
    weather::Timeline,
    world::{HeldEffect, UpdateBudget, World, next_revision, parse_error},
};

/// Sea of a context.
#[derive(Default)]
pub(crate) struct HeldSea {
    sea: Option<PreparedSea>,
    regions: Vec<PlacedRegion>,
    /// Tracks of the hulls that the host lists, and of earlier hulls whose waves are still there.
    tracks: Vec<HullTrack>,
    /// Wakes of the last time that was asked for.
    wakes: Mutex<KeptWakes>,
    /// Revision of the settings: a number that no other settings have had.
    revision: u64,
    /// States of growth at the beginnings and ends of changes, written down because the timeline forgets changes that
    /// have ended.
    kept: Vec<DatedGrowth>,
    /// Values that follow from the settings, from `kept` and from the timeline; empty until the first query.
    workshop: Mutex<Option<Box<SeaWorkshop>>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedSwell {
    height_m: f64,
    period_s: f64,
    from_deg: f64,
    spread_deg: Option<f64>,
}

/// Wakes at a time. The key is the time's bits and the revision of the hulls.
#[derive(Default)]
struct KeptWakes {
    key: Option<(u64, u64)>,
    hulls_revision: u64,
    wakes: Arc<Vec<Wake>>,
}

/// Saved form of the settings and of the state of growth after the changes that the timeline has forgotten.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedSea {
    level_m: f64,
    tide: Option<[f64; 2]>,
    fetch_m: Option<f64>,
    depth_m: f64,
    salinity_g_kg: f64,
    temperature_c: Option<f64>,
    significant_m: Option<f64>,
    peak_period_s: Option<f64>,
    gamma: Option<f64>,
    sea_state: Option<u8>,
    beaufort: Option<f64>,
    from_deg: Option<f64>,
    swells: Option<Vec<SavedSwell>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    waves: Vec<SingleWave>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    ice: Option<SeaIce>,
    #[serde(default, skip_serializing_if = "is_default")]
    clarity: WaterClarity,
    #[serde(default, skip_serializing_if = "is_default")]
    without_whitecaps: bool,
    #[serde(default, skip_serializing_if = "is_default")]
    only_in_regions: bool,
    /// Time, then the fields of the state of growth in the order of [`numbers_of`].
    grown: Option<[f64; 12]>,
}

/// Largest number of tracks: those of the hulls that the host lists, and as many that have ended.
pub(super) const MOST_TRACKS: usize = 2 * MAX_SEA_HULLS;
/// Keys of the sea, of its regions and of its hulls in a saved state.
const KEY: &str = "sea";
const REGIONS_KEY: &str = "sea_regions";
const HULLS_KEY: &str = "sea_hulls";

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

fn numbers_of(dated: &DatedGrowth) -> [f64; 12] {
    let s = &dated.state;
    let [toward, swell] = [s.toward, s.swell_toward];
    [
        dated.time_s,
        s.m0_m2,
        s.given,
        s.peak_rad_s,
        s.gamma,
        toward.x,
        toward.y,
        s.short_wind_m_s,
        s.swell_m2,
        s.swell_peaks,
        swell.x,
        swell.y,
    ]
}

fn dated_of(n: &[f64; 12]) -> DatedGrowth {
    let state = GrowthState {
        m0_m2: n[1],
        given: n[2],
        peak_rad_s: n[3],
        gamma: n[4],
        toward: DVec2::new(n[5], n[6]),
        short_wind_m_s: n[7],
        swell_m2: n[8],
        swell_peaks: n[9],
        swell_toward: DVec2::new(n[10], n[11]),
    };
    DatedGrowth { time_s: n[0], state }
}

impl SavedSea {
    fn new(settings: &SeaSettings, grown: Option<&DatedGrowth>) -> Self {
        let swell = |s: &SeaSwell| SavedSwell {
            height_m: s.height_m,
            period_s: s.period_s,
            from_deg: s.from_deg,
            spread_deg: s.spread_deg,
        };
        let mut saved = Self {
            level_m: settings.level_m,
            tide: settings.tide.map(|tide| [tide.amplitude_m, tide.high_water_s]),
            fetch_m: settings.fetch_m,
            depth_m: settings.depth_m,
            salinity_g_kg: settings.salinity_g_kg,
            temperature_c: settings.temperature_c,
            significant_m: None,
            peak_period_s: None,
            gamma: None,
            sea_state: None,
            beaufort: None,
            from_deg: settings.from_deg,
            swells: settings.swells.as_ref().map(|swells| swells.iter().map(swell).collect()),
            waves: settings.waves.clone(),
            ice: settings.ice,
            clarity: settings.clarity,
            without_whitecaps: settings.without_whitecaps,
            only_in_regions: settings.only_in_regions,
            grown: grown.map(numbers_of),
        };
        match settings.wind_sea {
            WindSea::Weather => {}
            WindSea::Height { significant_m, peak_period_s, gamma } => {
                (saved.significant_m, saved.peak_period_s, saved.gamma) = (Some(significant_m), peak_period_s, gamma);
            }
            WindSea::SeaState(state) => saved.sea_state = Some(state),
            WindSea::Beaufort(number) => saved.beaufort = Some(number),
        }
        saved
    }

    fn settings(&self) -> Result<SeaSettings> {
        let wind_sea = match (self.significant_m, self.sea_state, self.beaufort) {
            (None, None, None) => WindSea::Weather,
            (Some(significant_m), None, None) => {
                WindSea::Height { significant_m, peak_period_s: self.peak_period_s, gamma: self.gamma }
            }
            (None, Some(state), None) => WindSea::SeaState(state),
            (None, None, Some(number)) => WindSea::Beaufort(number),
            _ => return Err(parse_error(format_args!("{KEY}: more than one source of the wave height"))),
        };
        let swell = |s: &SavedSwell| SeaSwell {
            height_m: s.height_m,
            period_s: s.period_s,
            from_deg: s.from_deg,
            spread_deg: s.spread_deg,
        };
        let settings = SeaSettings {
            level_m: self.level_m,
            tide: self.tide.map(|[amplitude_m, high_water_s]| Tide { amplitude_m, high_water_s }),
            fetch_m: self.fetch_m,
            depth_m: self.depth_m,
            salinity_g_kg: self.salinity_g_kg,
            temperature_c: self.temperature_c,
            wind_sea,
            from_deg: self.from_deg,
            swells: self.swells.as_ref().map(|swells| swells.iter().map(swell).collect()),
            waves: self.waves.clone(),
            ice: self.ice,
            clarity: self.clarity,
            without_whitecaps: self.without_whitecaps,
            only_in_regions: self.only_in_regions,
        };
        settings.validate().map_err(|e| e.found_in("saved state"))?;
        Ok(settings)
    }
}

/// Checks regions and places them in the world.
fn placed(world: &World, regions: Vec<SeaRegion>) -> Result<Vec<PlacedRegion>> {
    if regions.len() > MAX_SEA_REGIONS {
        return Err(Error::range("regions", &format!("at most {MAX_SEA_REGIONS} regions"), regions.len()));
    }
    let place =
        |(i, region)| PlacedRegion::new(region, &world.frame).map_err(|e: Error| e.within(&format!("regions[{i}]")));
    regions.into_iter().enumerate().map(place).collect()
}

/// Takes the regions out of a saved state.
fn read_regions(world: &World, state: &mut toml::Table) -> Result<Vec<PlacedRegion>> {
    let Some(value) = state.remove(REGIONS_KEY) else { return Ok(Vec::new()) };
    let regions: Vec<SeaRegion> = value.try_into().map_err(|e| parse_error(format_args!("{REGIONS_KEY}: {e}")))?;
    placed(world, regions).map_err(|e| e.found_in("saved state"))
}

/// Takes the tracks of hulls out of a saved state.
fn read_tracks(state: &mut toml::Table) -> Result<Vec<HullTrack>> {
    let Some(value) = state.remove(HULLS_KEY) else { return Ok(Vec::new()) };
    let tracks: Vec<HullTrack> = value.try_into().map_err(|e| parse_error(format_args!("{HULLS_KEY}: {e}")))?;
    if tracks.len() > MOST_TRACKS {
        return Err(parse_error(format_args!("{HULLS_KEY}: more than {MOST_TRACKS} tracks")));
    }
    for (i, track) in tracks.iter().enumerate() {
        track.check().map_err(|e| e.within(&format!("{HULLS_KEY}[{i}]")).found_in("saved state"))?;
    }
    Ok(tracks)
}

impl HeldSea {
    /// Returns the settings; `None` without a sea.
    pub fn settings(&self) -> Option<&SeaSettings> {
        self.sea.as_ref().map(|sea| &sea.settings)
    }

    /// Returns a number that changes with the settings.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Sets the sea, or takes it away.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set(&mut self, settings: Option<SeaSettings>, seed: u64) -> Result<()> {
        settings.as_ref().map_or(Ok(()), SeaSettings::validate)?;
        if settings.is_none() {
            self.kept.clear();
        }
        self.sea = settings.map(|settings| PreparedSea::new(settings, seed));
        self.revision = next_revision();
        *self.workshop.get_mut().unwrap_or_else(PoisonError::into_inner) = None;
        Ok(())
    }

    /// Removes the sea's keys from a saved state and reads them.
    ///
    /// # Errors
    /// [`Status::Parse`] for a value of another form, for more than one source of the wave height, for a number that is
    /// not finite, and for tracks that are too many or out of order. [`Status::InvalidArgument`] naming a field that is
    /// out of range.
    pub fn read(world: &World, state: &mut toml::Table) -> Result<Self> {
        let (regions, tracks) = (read_regions(world, state)?, read_tracks(state)?);
        let Some(value) = state.remove(KEY) else { return Ok(Self { regions, tracks, ..Self::default() }) };
        let saved: SavedSea = value.try_into().map_err(|e| parse_error(format_args!("{KEY}: {e}")))?;
        if saved.grown.is_some_and(|numbers| numbers.iter().any(|n| !n.is_finite())) {
            return Err(parse_error(format_args!("{KEY}: numbers must be finite")));
        }
        let sea = Some(PreparedSea::new(saved.settings()?, world.seed));
        let kept = saved.grown.iter().map(dated_of).collect();
        let wakes = Mutex::default();
        Ok(Self { sea, regions, tracks, wakes, revision: next_revision(), kept, workshop: Mutex::default() })
    }

    /// Replaces the regions.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] for too many regions, or naming the region and its field; nothing changes then.
    pub fn set_regions(&mut self, world: &World, regions: Vec<SeaRegion>) -> Result<()> {
        self.regions = placed(world, regions)?;
        Ok(())
    }

    /// Returns the regions.
    pub fn regions(&self) -> impl ExactSizeIterator<Item = &SeaRegion> {
        self.regions.iter().map(|placed| &placed.region)
    }

    /// Replaces the hulls. A hull that was listed before continues its track. The waves of a hull that is no longer
    /// listed stay until they have faded.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] for too many hulls, for two hulls with the same `id`, or naming the hull and its
    /// field; nothing changes then.
    pub fn set_hulls(&mut self, world: &World, hulls: &[SeaHull]) -> Result<()> {
        if hulls.len() > MAX_SEA_HULLS {
            return Err(Error::range("hulls", &format!("at most {MAX_SEA_HULLS} hulls"), hulls.len()));
        }
        for (i, hull) in hulls.iter().enumerate() {
            if hulls[..i].iter().any(|other| other.id == hull.id) {
                return Err(Error::range(&format!("hulls[{i}].id"), "unlike those of the hulls before it", hull.id));
            }
            HullTrack::new(*hull, world).map_err(|e| e.within(&format!("hulls[{i}]")))?;
        }
        for track in &mut self.tracks {
            if hulls.iter().all(|hull| hull.id != track.hull.id) {
                track.end(world.time_s);
            }
        }
        for hull in hulls {
            match self.tracks.iter_mut().find(|track| track.hull.id == hull.id) {
                Some(track) => track.set(*hull, world)?,
                None => self.tracks.push(HullTrack::new(*hull, world)?),
            }
        }
        self.tracks.retain(|track| track.has_waves(world.time_s));
        // Of the tracks that have ended, the one that was added first goes first.
        while self.tracks.len() > MOST_TRACKS {
            let gone = self.tracks.iter().position(|track| track.ended_s.is_some()).unwrap_or(0);
            self.tracks.remove(gone);
        }
        let kept = self.wakes.get_mut().unwrap_or_else(PoisonError::into_inner);
        (kept.key, kept.hulls_revision) = (None, next_revision());
        Ok(())
    }

    /// Returns the hulls that are listed, as they were set.
    pub fn hulls(&self) -> impl Iterator<Item = &SeaHull> {
        self.tracks.iter().filter(|track| track.ended_s.is_none()).map(|track| &track.hull)
    }

    /// Returns the wakes at a time, kept from an earlier query or worked out now.
    pub fn wakes(&self, time_s: f64) -> Arc<Vec<Wake>> {
        let mut kept = self.wakes.lock().unwrap_or_else(PoisonError::into_inner);
        let key = Some((time_s.to_bits(), kept.hulls_revision));
        if kept.key != key {
            kept.key = key;
            let wakes = Arc::make_mut(&mut kept.wakes);
            wakes.resize_with(self.tracks.len(), Wake::default);
            wakes.iter_mut().zip(&self.tracks).for_each(|(wake, track)| wake.fill(track, time_s));
        }
        Arc::clone(&kept.wakes)
    }

    /// Returns the regions as they lie in the world.
    pub(super) fn placed_regions(&self) -> &[PlacedRegion] {
        &self.regions
    }

    /// Returns the water at a position and time; in a dry region, the water that would be there without the region.
    /// `None` if there is no such water.
    pub fn water_at(&self, position: DVec3, time_s: f64) -> Option<WaterBody> {
        let is_sea = self.settings().is_some_and(|settings| !settings.only_in_regions);
        water_at(&self.regions, is_sea, position, time_s)
    }

    /// Calls `act` with the sea's workshop.
    fn with<T>(
        &self,
        (timeline, revision): (&Timeline, u64),
        act: impl FnOnce(&mut SeaWorkshop, &PreparedSea, &WeatherPast<'_>) -> T,
    ) -> Result<T> {
        let Some(sea) = &self.sea else {
            return Err(Error::new(Status::WrongOrder, "the context has no sea: set one first"));
        };
        let mut kept = self.workshop.lock().unwrap_or_else(PoisonError::into_inner);
        let workshop = kept.get_or_insert_with(|| Box::new(SeaWorkshop::new(sea)));
        Ok(act(workshop, sea, &WeatherPast { timeline, revision, kept: &self.kept }))
    }

    /// Returns the surface at a time, kept from an earlier query or worked out now.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without a sea; for a time that is refused, the error of [`World::weather_at`].
    pub fn surface(&self, world: &World, time_s: f64) -> Result<Arc<SeaSurface>> {
        world.over().check_time(time_s)?;
        let past = (&world.timeline, world.timeline_revision());
        self.with(past, |workshop, sea, past| workshop.surface(sea, past, time_s))
    }

    /// Returns the statistics at a time.
    ///
    /// # Errors
    /// As [`HeldSea::surface`].
    pub fn statistics(&self, world: &World, time_s: f64) -> Result<SeaStatistics> {
        world.over().check_time(time_s)?;
        let past = (&world.timeline, world.timeline_revision());
        self.with(past, |workshop, sea, past| workshop.statistics(sea, past, time_s))
    }
}

impl HeldEffect for HeldSea {
    fn advance(&mut self, world: &World, _within: UpdateBudget) -> Result<Status> {
        // The timeline is about to forget changes that have ended. Their waves stay.
        if self.sea.is_some() && world.timeline.ends_before(world.time_s).is_some() {
            let known_s = world.timeline.known_from_s();
            let past = (&world.timeline, world.timeline_revision());
            let ended = |dated: &&DatedGrowth| (known_s..=world.time_s).contains(&dated.time_s);
            let kept = self.with(past, |workshop, sea, past| {
                workshop.history(sea, past).dated.iter().filter(ended).copied().collect::<Vec<_>>()
            })?;
            self.kept = kept;
        }
        Ok(Status::Ok)
    }

    fn save_in(&self, world: &World, _for_hash: bool, state: &mut toml::Table) -> Result<()> {
        let written = |e| Error::new(Status::Internal, format!("the state cannot be written: {e}"));
        if !self.regions.is_empty() {
            let regions: Vec<&SeaRegion> = self.regions().collect();
            state.insert(REGIONS_KEY.into(), toml::Value::try_from(regions).map_err(written)?);
        }
        if !self.tracks.is_empty() {
            state.insert(HULLS_KEY.into(), toml::Value::try_from(&self.tracks).map_err(written)?);
        }
        let Some(sea) = &self.sea else { return Ok(()) };
        let known_s = world.timeline.known_from_s();
        let grown = self.kept.iter().find(|dated| dated.time_s == known_s);
        let value = toml::Value::try_from(SavedSea::new(&sea.settings, grown)).map_err(written)?;
        state.insert(KEY.into(), value);
        Ok(())
    }
}
