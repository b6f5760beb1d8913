//! Lying snow of a context: as the weather reports it, or simulated over the timeline if the host asks for it.

use std::sync::Arc;

use glam::DVec2;

use super::{
    column::{Column, ColumnForcing, Settling, UNITS},
    field::SnowField,
    inputs::{CellWind, FallsAt, FieldWind, SnowStep},
    laws, published,
    saved::SavedSnow,
    site::Site,
    state::{COARSE_STEP_S, STEP_S, SnowState, reported},
};
use crate::{
    error::{Error, Result, Status},
    regions::RegionsOver,
    surroundings::{Meltwater, TerrainHeights},
    terrain::{Terrain, TileKey},
    weather::snow_cover,
    world::{HeldEffect, UpdateBudget, World, parse_error},
};

/// Source of the lying snow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum LyingSnowModel {
    /// Snow everywhere of the depth that the present weather reports.
    #[default]
    Reported,
    /// Simulated state: snowfall fills it, and it settles, drifts, slides and melts ([`crate::snowpack`]). It begins
    /// with the depth that the weather reports. An update that moves time by more than a day is done in fast-forward
    /// ([`crate::context::Context::accumulate`]). Of an update by more than 30 days only the last 30 days are
    /// simulated.
    Simulated,
}

/// Interval at which the sunlight for melting is updated, s.
const SUN_EVERY_S: f64 = 300.0;
/// Length of an update above which it is done in fast-forward, s.
const LONGEST_S: f64 = 86_400.0;
/// Longest time that an update simulates, s; earlier time is left out.
const MOST_S: f64 = 30.0 * 86_400.0;
/// Key of the snow in a saved state.
const KEY: &str = "lying_snow";

/// Lying snow of a context.
pub(crate) struct HeldSnow {
    pub model: LyingSnowModel,
    /// Whether updates are done in fast-forward.
    pub is_fast: bool,
    /// Simulated snow; `None` with reported snow, and before the first update.
    state: Option<SnowState>,
    /// Host's terrain under the snow, once there is one.
    site: Option<Site>,
    /// Tiles that changed while steps remained, each with the terrain after the change.
    waiting: Vec<(TileKey, Arc<Terrain>)>,
    /// Grounds to which the snow is still to be adapted, in order: the one that the host set last, or an empty ground
    /// and then the one set last. The empty ground removes the snow. It is there if the host has set several grounds
    /// since the last adaptation, and one of them does not keep the snow of the one before.
    grounds: Vec<SnowGround>,
    /// Table of settling for the step in progress.
    settling: Settling,
    /// End of the time that is simulated in fast-forward, s.
    coarse_until_s: f64,
    /// Incremented whenever the snow may have changed.
    revision: u64,
    /// Revision that was last published to the world; 0 before the first.
    published: u64,
    /// Meltwater from the snow since it was last published: beginning and length of each step, s, and its water.
    melts: Vec<(f64, f64, Meltwater)>,
    /// Whether the meltwater published so far belongs to a state that a loaded one has replaced. The next `publish`
    /// then deletes it.
    forgets: bool,
}

/// Ground of the host on which snow lies: a grid, tiles, or neither.
#[derive(Clone)]
struct SnowGround {
    /// Heights of the host's grid.
    grid: Option<Arc<TerrainHeights>>,
    /// Tiles, if there is no grid.
    tiles: Option<Arc<Terrain>>,
}

impl SnowGround {
    /// Returns the ground of the world as it is now.
    fn of(world: &World) -> Self {
        Self { grid: world.set.terrain.clone(), tiles: world.set.tiles.clone() }
    }

    /// Returns whether snow on `other` stays if this ground replaces it.
    fn keeps_snow_of(&self, other: &Self) -> bool {
        match (self, other) {
            (Self { grid: Some(a), .. }, Self { grid: Some(b), .. }) => a.has_nodes_of(b),
            (Self { grid: None, tiles: Some(a) }, Self { grid: None, tiles: Some(b) }) => a.id == b.id,
            _ => false,
        }
    }
}

/// Snow of a saved state, not yet active.
pub(crate) struct LoadedSnow(Option<SnowState>);

impl HeldSnow {
    /// Creates a context's snow before anything has fallen.
    pub fn new(model: LyingSnowModel) -> Self {
        Self {
            model,
            is_fast: false,
            state: None,
            site: None,
            waiting: Vec::new(),
            grounds: Vec::new(),
            settling: Settling::new(),
            coarse_until_s: f64::NEG_INFINITY,
            revision: 1,
            published: 0,
            melts: Vec::new(),
            forgets: false,
        }
    }

    /// Returns the snow on level, open ground.
    pub(super) fn country(&self, world: &World) -> Column {
        match &self.state {
            Some(state) => state.country,
            None => reported(world.timeline.at(world.time_s).surface.snow_depth_m),
        }
    }

    /// Returns the site and the snow field of the host's terrain; `None` without a terrain or without simulated snow.
    pub(super) fn field(&self) -> Option<(&Site, &SnowField)> {
        Some((self.site.as_ref()?, self.state.as_ref()?.field.as_ref()?))
    }

    /// Returns the field and its site, if there are both.
    pub(super) fn field_mut(&mut self) -> Option<(&Site, &mut SnowField)> {
        Some((self.site.as_ref()?, self.state.as_mut()?.field.as_mut()?))
    }

    /// Returns the time that was simulated in fast-forward, s.
    pub fn coarse_s(&self) -> f64 {
        self.state.as_ref().map_or(0.0, |s| s.coarse_s)
    }

    /// Returns the revision for patches that change now.
    pub(super) fn next_revision(&self) -> u64 {
        self.revision + 1
    }

    /// Marks the snow as changed.
    pub(super) fn changed(&mut self) {
        self.revision += 1;
    }

    /// Creates the state if the snow is simulated and has none, and adapts the snow to the world's terrain.
    pub(super) fn be_there(&mut self, world: &World) -> Result<()> {
        if self.model == LyingSnowModel::Simulated && self.state.is_none() {
            self.state = Some(SnowState::first(world, world.time_s)?);
        }
        self.settle_on(&SnowGround::of(world));
        Ok(())
    }

    /// Notes that the host has replaced the ground.
    pub fn ground_replaced(&mut self, world: &World) {
        let ground = SnowGround::of(world);
        match self.grounds.last_mut() {
            Some(last) if ground.keeps_snow_of(last) => *last = ground,
            Some(_) => self.grounds = vec![SnowGround { grid: None, tiles: None }, ground],
            None => self.grounds.push(ground),
        }
    }

    /// Adapts the snow to a terrain. Cells that stay keep their snow; new cells start with the snow of level, open
    /// ground.
    fn settle_on(&mut self, ground: &SnowGround) {
        match (&ground.grid, &ground.tiles) {
            (Some(grid), _) => {
                let Some(state) = &mut self.state else { return };
                if state.field.is_none() || !self.site.as_ref().is_some_and(|site| site.is_of(grid)) {
                    self.site = Some(Site::of_grid(grid, self.site.as_ref(), &mut state.field, state.country));
                    self.revision += 1;
                }
            }
            (None, Some(tiles)) => self.settle_on_tiles(tiles),
            (None, None) => {
                let had = self.site.take().is_some() | self.state.as_mut().is_some_and(|s| s.field.take().is_some());
                self.revision += u64::from(had);
            }
        }
    }

    /// Adapts the snow to tiles: first to the changes that waited for steps, then to all others.
    fn settle_on_tiles(&mut self, terrain: &Terrain) {
        let mut waiting = std::mem::take(&mut self.waiting);
        waiting.retain(|(key, then)| {
            let later = then.revision > terrain.revision;
            if then.id == terrain.id && !later {
                self.follow_tile(then, *key);
            }
            then.id == terrain.id && later
        });
        self.waiting = waiting;
        let revision = self.next_revision();
        let Some(state) = &mut self.state else { return };
        let known = self.site.as_ref().and_then(|site| site.seen(terrain));
        if state.field.is_some() && known == Some(terrain.revision) {
            return;
        }
        let old = self.site.take();
        let mut site = match old {
            Some(site) if known.is_some() && state.field.is_some() => site,
            old => Site::of_tiles(terrain, old.as_ref(), &mut state.field),
        };
        if let Some(field) = &mut state.field {
            site.follow_all(terrain, field, state.country, revision);
        }
        self.site = Some(site);
        self.revision = revision;
    }

    /// Updates the snow after a change of one tile. The rest of the terrain must already be known.
    fn follow_tile(&mut self, terrain: &Terrain, key: TileKey) {
        let revision = self.next_revision();
        let Some(SnowState { field: Some(field), country, .. }) = &mut self.state else { return };
        let Some(site) = self.site.as_mut().filter(|site| site.seen(terrain).is_some()) else { return };
        site.follow(terrain, key, field, *country, revision);
        site.mark_known(terrain);
        self.revision = revision;
    }

    /// Notes that the host has set, changed or removed a tile. If `waits`, steps from before the change are still to be
    /// done.
    pub fn tile_changed(&mut self, world: &mut World, key: TileKey, waits: bool) {
        let Some(terrain) = world.set.tiles.clone().filter(|_| self.state.is_some()) else { return };
        if waits {
            self.waiting.push((key, terrain));
            return;
        }
        if self.site.as_ref().is_some_and(|site| site.seen(&terrain).is_some()) {
            self.follow_tile(&terrain, key);
        } else {
            self.settle_on_tiles(&terrain);
        }
        self.publish(world);
    }

    /// Advances the snow to `end_s`, in one step.
    fn step(&mut self, world: &World, end_s: f64) -> Result<()> {
        let Some(state) = &mut self.state else { return Ok(()) };
        let (from_s, seconds) = (state.time_s, end_s - state.time_s);
        if from_s.rem_euclid(SUN_EVERY_S) == 0.0 || seconds > STEP_S {
            // A long step takes the sunlight of its middle.
            let at_s = if seconds > STEP_S { from_s + 0.5 * seconds } else { from_s };
            state.sunlight_w_m2 = world.sunlight_w_m2(at_s)?;
        }
        state.coarse_s += if seconds > STEP_S { seconds } else { 0.0 };
        state.time_s = end_s;
        let middle_s = from_s + 0.5 * seconds;
        let c = world.timeline.at(middle_s);
        let f = &c.precipitation;
        let by_place = !(world.set.regions.is_empty() && world.set.weather_regions.is_empty());
        let snows = f.snow_mm_h + f.ice_pellets_mm_h + f.hail_mm_h > 0.0 || by_place;
        if !snows && !state.lies_anywhere() {
            state.melted = Meltwater { covered: 0.0, runoff_mm_h: 0.0 };
            self.melts.push((from_s, seconds, state.melted));
            return Ok(());
        }
        let forcing = ColumnForcing::new(&c, f, state.sunlight_w_m2, seconds);
        self.settling.set(c.air.temperature_c, seconds);
        let ran_off = state.country.step(&forcing, &self.settling, 1.0).ran_off;
        state.melted = Meltwater {
            covered: snow_cover(state.country.depth_m()),
            runoff_mm_h: ran_off as f64 / UNITS * 3600.0 / seconds,
        };
        if let (Some(site), Some(field)) = (&mut self.site, &mut state.field) {
            let revision = self.revision + 1;
            // Takes the wind at the end of the step: a solved wind field has no earlier state.
            let air = site.air(world, end_s, &c);
            if site.shade(field, &c, &world.set.shelters, air.as_ref()) {
                field.clear_blocked(revision);
            }
            let over = air.as_ref().map(|air| |place: [i32; 2], surface_m: f64| air.over(place, surface_m));
            let local = over.as_ref().map(|over| over as CellWind<'_>);
            let site = &*site;
            let sunlight_w_m2 = state.sunlight_w_m2;
            let regions = RegionsOver::new(&world.set.weather_regions, &world.frame, middle_s);
            let falls = |place: [i32; 2], height_m: f64| {
                let position = site.place(place, height_m);
                let here = if regions.is_empty() { c } else { regions.weather_at(position, &c) };
                let falling = world.over().falling_at(position, middle_s, here).precipitation;
                ColumnForcing::new(&here, &falling, sunlight_w_m2, seconds)
            };
            let mean = DVec2::new(c.wind.east_m_s, c.wind.north_m_s);
            field.step(&SnowStep {
                seconds,
                even: &forcing,
                falls: by_place.then_some(&falls as FallsAt<'_>),
                settling: &self.settling,
                wind: FieldWind { mean, local },
                country: &state.country,
                slides: end_s.rem_euclid(COARSE_STEP_S) == 0.0,
                revision,
            });
            state.melted = Meltwater { covered: field.cover, runoff_mm_h: field.runoff_mm_h };
        }
        self.melts.push((from_s, seconds, state.melted));
        self.revision += 1;
        Ok(())
    }

    /// Takes the snow's entry out of a saved state.
    ///
    /// # Errors
    /// [`Status::Parse`] for values that cannot be snow of this context.
    pub fn read(&self, saved: &mut toml::Table) -> Result<LoadedSnow> {
        let saved: Option<SavedSnow> =
            saved.remove(KEY).map(|v| v.try_into().map_err(|e| parse_error(format_args!("{KEY}: {e}")))).transpose()?;
        let wanted = "lying_snow must be a simulated one with whole amounts of snow from 0 on";
        let state = saved.map(|s| s.state().filter(|_| self.model == LyingSnowModel::Simulated));
        state.map_or(Ok(LoadedSnow(None)), |s| Ok(LoadedSnow(Some(s.ok_or_else(|| parse_error(wanted))?))))
    }

    /// Activates a loaded snow; `other` then holds the previous one.
    pub fn swap_in(&mut self, world: &mut World, other: &mut LoadedSnow) {
        std::mem::swap(&mut self.state, &mut other.0);
        self.site = None;
        self.waiting.clear();
        self.grounds.clear();
        self.coarse_until_s = f64::NEG_INFINITY;
        self.settle_on(&SnowGround::of(world));
        self.changed();
        self.forgets = true;
        self.melts.clear();
        self.melts.extend(self.state.as_ref().map(|s| (s.time_s - STEP_S, STEP_S, s.melted)));
        self.publish(world);
    }
}

impl HeldEffect for HeldSnow {
    fn begin(&mut self, world: &World, time_s: f64) -> Result<()> {
        self.be_there(world)?;
        let Some(state) = &mut self.state else { return Ok(()) };
        if self.is_fast || time_s - world.time_s > LONGEST_S {
            self.coarse_until_s = time_s;
        }
        // Time before `earliest_s` passes without steps. `earliest_s` is a multiple of COARSE_STEP_S, so long updates
        // that end at slightly different times begin at the same time.
        let earliest_s = ((time_s - MOST_S) / COARSE_STEP_S).floor() * COARSE_STEP_S;
        state.time_s = state.time_s.max(earliest_s);
        Ok(())
    }

    fn settle(&mut self, world: &World) {
        // Applies all grounds in turn: a ground that is removed and set again loses its snow.
        for ground in std::mem::take(&mut self.grounds) {
            self.settle_on(&ground);
        }
        self.settle_on(&SnowGround::of(world));
    }

    fn advance(&mut self, world: &World, budget: UpdateBudget) -> Result<Status> {
        for steps in 0.. {
            let Some(end_s) = self.state.as_ref().map(|s| s.next_s(self.coarse_until_s)) else { break };
            if end_s > budget.until_s {
                break;
            }
            if steps > 0 && budget.begun.elapsed() >= budget.most {
                return Ok(Status::Pending);
            }
            // Soil may have changed the heights of the tiles since the update began.
            if let Some(tiles) = world.set.tiles.as_ref().filter(|_| world.dug.is_some()) {
                self.settle_on_tiles(tiles);
            }
            self.step(world, end_s)?;
        }
        Ok(Status::Ok)
    }

    fn reads_next_s(&self) -> Option<f64> {
        self.state.as_ref().map(|state| state.next_s(self.coarse_until_s))
    }

    fn publish(&mut self, world: &mut World) {
        let Some(state) = &self.state else {
            world.snow = None;
            return;
        };
        let snow = world.snow.get_or_insert_default();
        if std::mem::take(&mut self.forgets) {
            snow.forget();
        }
        self.melts.drain(..).for_each(|(from_s, seconds, water)| snow.melts(from_s, seconds, water));
        if self.published == self.revision {
            return;
        }
        self.published = self.revision;
        snow.country = published::seen(&state.country);
        snow.cover = snow_cover(state.country.depth_m());
        snow.threshold_m_s = laws::threshold_m_s(state.country.is_wet(), state.country.density_kg_m3());
        match &state.field {
            Some(field) => published::publish(field, snow),
            None => snow.show_none(),
        }
        snow.revision += 1;
    }

    fn stepped_to_s(&self) -> Option<f64> {
        self.state.as_ref().map(|state| state.time_s)
    }

    fn created(&self, table: &mut toml::Table) {
        if self.model == LyingSnowModel::Simulated {
            table.insert("lying_snow_model".into(), format!("{:?}", self.model).into());
        }
    }

    fn save_in(&self, _world: &World, for_hash: bool, table: &mut toml::Table) -> Result<()> {
        let written = |e| Error::new(Status::Internal, format!("the state cannot be written: {e}"));
        if let Some(state) = &self.state {
            table.insert(KEY.into(), toml::Value::try_from(SavedSnow::of(state, for_hash)).map_err(written)?);
        }
        Ok(())
    }
}
