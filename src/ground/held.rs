//! Water on the ground of a context, shared by its views. By default it is the water that the weather reports. If the
//! host asks for a simulation, the water is simulated over the timeline, on level, open ground and on each cell of the
//! host's terrain.

use std::sync::{Arc, Mutex};

use super::{
    class::SurfaceClass,
    grid::GroundGrid,
    hollows::{Hollows, pattern_axes},
    host::{GroundCell, HostGround},
    saved::SavedGround,
    seen::GroundSeen,
    state::{GroundModel, GroundState, GroundStep, forcing_from},
    terrain::CellWater,
    texture::TerrainTextures,
    tiled::{Changed, SavedTiles, TiledWater},
    water::{Forcing, GroundWater, STEP_S, depth_at_mm},
    window::{DrawnTerrain, TerrainWindow},
};
use crate::{
    error::{Error, Result, Status},
    moment::SceneMoment,
    surroundings::{SnowHere, TerrainHeights},
    terrain::Terrain,
    weather::{Conditions, SurfaceCover, cover_under_rain},
    world::{HeldEffect, UpdateBudget, World, parse_error},
};
use glam::{DMat3, DVec2, DVec3};

/// Water at a place on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundAt {
    /// Depth of water, mm: the film plus the standing water of a hollow. Tyre models can use it.
    pub water_mm: f64,
    /// Film on level ground outside hollows, mm; on the host's terrain the film at the place.
    pub film_mm: f64,
    /// Wetness of the ground. On the host's terrain it is that of the place, elsewhere that of level, open ground. 0 is
    /// dry, 0.3 damp, 1 under a closed film.
    pub wetness: f64,
    /// Share of the ground under standing water. On the host's terrain it is the share of the whole terrain, elsewhere
    /// that of level, open ground.
    pub puddles: f64,
    /// Whether standing water covers the place. Off the host's terrain only paved ground has puddles.
    pub in_puddle: bool,
    /// Surface class at the place: from the host's terrain, else the context's default.
    pub surface_class: SurfaceClass,
}

/// Interval at which the sunlight for evaporation is updated, s: a multiple of the step.
const SUN_EVERY_S: f64 = 300.0;
/// Longest leap of time that is simulated, s. A longer update restarts the state this long before its end, or up to
/// [`SUN_EVERY_S`] earlier.
const LONGEST_S: f64 = 86_400.0;

/// Ground of a context.
pub(crate) struct HeldGround {
    pub model: GroundModel,
    /// Pattern of hollows in which water stands where heights are unknown.
    pub hollows: Hollows,
    /// Simulated water of level, open ground; `None` before the first update.
    pub(super) state: Option<GroundState>,
    /// Host's grid and the water on it.
    pub(super) host: Option<Box<HostGround>>,
    /// Incremented whenever the water of the cells has changed.
    pub revision: u64,
    /// Incremented when the host sets a grid with other heights or removes the grid, and when a loaded state has
    /// another one.
    pub generation: u64,
    /// Incremented whenever the grid's classes may have changed: with new classes, a new grid or a loaded state.
    pub classes_revision: u64,
    /// Surface class of ground for which the host gives none.
    pub surface_class: SurfaceClass,
    /// Start of the 10-s slot in which the host set the grid, s. Steps that begin earlier leave the grid out.
    terrain_from_s: f64,
    /// Time, s, and revision of the water that was last published for the soil.
    pub(super) published: Option<(f64, u64)>,
    /// Textures of the host's grid and of the water on it.
    pub(super) textures: Mutex<TerrainTextures>,
    /// Water on the host's tiles.
    pub(super) tiled: Option<Box<TiledWater>>,
    /// Changes of tiles that are not yet applied to the water, each with the terrain after the change.
    pub(super) waiting: Vec<(Changed, Arc<Terrain>)>,
    /// Window of tile textures for the host's own shaders; `None` until the host asks for one.
    pub(super) host_window: Option<Box<TerrainWindow>>,
}

/// Ground of a saved state, not yet active: fields of [`HeldGround`].
pub(crate) struct LoadedGround {
    state: Option<GroundState>,
    host: Option<Box<HostGround>>,
    surface_class: SurfaceClass,
    terrain_from_s: f64,
    tiled: Option<Box<TiledWater>>,
    waiting: Vec<(Changed, Arc<Terrain>)>,
}

/// Key of the level ground in a saved state.
const STATE_KEY: &str = "ground";
/// Key of the grid and its water.
const TERRAIN_KEY: &str = "terrain";
/// Key of the water on tiles.
pub(super) const TILES_KEY: &str = "terrain_tiles";
/// Key of the class of the level ground.
const CLASS_KEY: &str = "surface_class";

impl HeldGround {
    /// Creates the ground of a new context: without a grid or tiles, and without simulated water.
    pub fn new(model: GroundModel, seed: u64) -> Self {
        Self {
            model,
            hollows: Hollows::new(seed),
            state: None,
            host: None,
            revision: 0,
            generation: 0,
            classes_revision: 0,
            surface_class: SurfaceClass::Unspecified,
            terrain_from_s: f64::NEG_INFINITY,
            published: None,
            textures: Mutex::default(),
            tiled: None,
            waiting: Vec::new(),
            host_window: None,
        }
    }

    /// Replaces the grid or, with `None`, removes it, for
    /// [`Context::set_ground_grid`](crate::context::Context::set_ground_grid). A grid with the same heights keeps its
    /// water.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_grid(&mut self, world: &World, grid: Option<GroundGrid>) -> Result<()> {
        let Some(grid) = grid else {
            self.host = None;
            self.generation += 1;
            return Ok(());
        };
        grid.validate()?;
        world.frame.place_at("ground_grid.origin_m", grid.origin)?;
        if let Some(held) = self.host.as_mut().filter(|held| held.terrain.grid.has_heights_of(&grid)) {
            if held.terrain.grid.classes != grid.classes {
                held.terrain.grid.classes = grid.classes;
                self.classes_revision += 1;
            }
            return Ok(());
        }
        self.host = Some(Box::new(HostGround::new(grid, &world.frame)));
        (self.generation, self.classes_revision) = (self.generation + 1, self.classes_revision + 1);
        self.terrain_from_s = (world.time_s / STEP_S).floor() * STEP_S;
        self.refresh(world)
    }

    /// Returns the host's grid; `None` without one.
    pub fn grid(&self) -> Option<&GroundGrid> {
        self.host.as_ref().map(|held| &held.terrain.grid)
    }

    /// Returns the heights of the host's grid, for everything that depends on the terrain's shape; `None` without a
    /// grid.
    pub fn heights(&self) -> Option<Arc<TerrainHeights>> {
        let held = self.host.as_ref()?;
        let g = &held.terrain.grid;
        Some(Arc::new(TerrainHeights::new((g.origin, held.to_enu), g.cell_m, g.nodes, g.heights_m.clone())))
    }

    /// Returns the water of each cell of the host's grid; `None` without one.
    pub fn cells(&self) -> Option<impl ExactSizeIterator<Item = GroundCell> + '_> {
        let held = self.host.as_ref()?;
        Some((0..held.terrain.grid.len()).map(move |cell| {
            let c = held.water.cell(cell);
            GroundCell {
                film_mm: c.film_mm as f32,
                soaked: c.soaked as f32,
                standing_mm: c.standing_mm.max(0.0) as f32,
                ice: held.ice(cell),
            }
        }))
    }

    /// Returns the surface class at a place: that of the grid's nearest cell or of the tile's cell, else the context's
    /// default.
    fn surface_class_at(&self, world: &World, position: DVec3) -> SurfaceClass {
        let tile = self.tile_class_at(world, position);
        let cell = self.host.as_ref().and_then(|held| {
            let about = held.terrain.grid.on_terrain(position, held.to_enu)?;
            let nearest = about.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
            Some(held.terrain.grid.class(nearest.0))
        });
        cell.or(tile).unwrap_or_default().or(self.surface_class)
    }

    /// Returns the water at a place on the host's grid, and the share of the grid under standing water; `None`
    /// elsewhere.
    fn terrain_at(&self, position: DVec3) -> Option<(CellWater, f64)> {
        let held = self.host.as_ref()?;
        let about = held.terrain.grid.on_terrain(position, held.to_enu)?;
        Some((held.water.between(&about), held.water.puddles()))
    }

    /// Returns the host's grid, and the rotation from the host's axes to east, north, up at the grid's origin.
    pub fn drawn_terrain(&self) -> Option<(&GroundGrid, DMat3)> {
        self.host.as_ref().map(|held| (&held.terrain.grid, held.to_enu))
    }

    /// Returns whether the water's next step ends at or before the present time and is therefore still to be done.
    fn is_behind(&self, world: &World) -> bool {
        self.state.is_some_and(|state| state.next_s() <= world.time_s)
    }

    /// Returns the simulated water on level, open ground at the present time; before the first update that of the
    /// reported cover. `None` if the water is not simulated.
    pub fn water(&self, world: &World) -> Option<GroundWater> {
        match (self.model, self.state) {
            (GroundModel::Reported, _) => None,
            (GroundModel::Simulated, Some(state)) if !self.is_behind(world) && world.time_s > state.time_s => {
                let c = world.timeline.at(0.5 * (state.time_s + world.time_s));
                Some(state.water().after(&forcing(world, &c, &state), world.time_s - state.time_s))
            }
            (GroundModel::Simulated, Some(state)) => Some(state.water()),
            (GroundModel::Simulated, None) => Some(GroundWater::of_cover(&world.timeline.at(world.time_s).surface)),
        }
    }

    /// Returns the cover of the ground now: `reported`, with the wetness and puddles of the water if it is simulated.
    fn cover(&self, world: &World, reported: SurfaceCover) -> SurfaceCover {
        match self.water(world).map(|w| w.cover()) {
            Some((wetness, puddles)) => SurfaceCover { wetness, puddles, ..reported },
            None => reported,
        }
    }

    /// Returns the cover at a place. In a rain area or a weather region the ground is at least as wet as the steady
    /// rain there would keep it.
    fn cover_at(&self, world: &World, position: DVec3, reported: SurfaceCover) -> SurfaceCover {
        let cover = self.cover(world, reported);
        if world.set.regions.is_empty() && world.set.weather_regions.is_empty() {
            return cover;
        }
        let weather = world.over().weather_at(position, world.time_s);
        let here = world.over().at_place(position, world.time_s, weather).precipitation;
        if here == world.timeline.at(world.time_s).precipitation {
            return cover;
        }
        let kept = cover_under_rain(&here, weather.air.relative_humidity);
        SurfaceCover {
            wetness: cover.wetness.max(kept.0 * (1.0 - cover.ice)),
            puddles: cover.puddles.max(kept.1 * (1.0 - cover.ice)),
            ..cover
        }
    }

    /// Returns the state of the ground that a view's camera needs.
    pub fn seen(&self, world: &World, now: &SceneMoment<'_>) -> GroundSeen<'_> {
        let has_cells = self.host.is_some() || self.tiled.is_some();
        GroundSeen {
            cover: self.cover_at(world, now.eye, now.scene.conditions.surface),
            hollows: &self.hollows,
            terrain: match self.drawn_terrain() {
                Some((grid, to_enu)) => Some(DrawnTerrain::of_grid(grid, to_enu)),
                None => world.set.tiles.as_ref().and_then(|terrain| DrawnTerrain::window(terrain, now.eye)),
            },
            has_wet_terrain: self.host.as_ref().is_some_and(|held| !held.water.is_dry())
                || self.tiled.as_ref().is_some_and(|tiled| tiled.is_wet()),
            snow: snow_about(world, now),
            terrain_has_snow: has_cells && world.snow.is_some(),
            has_snowy_terrain: has_cells && world.snow.as_ref().is_some_and(|snow| snow.has_cells),
            surface_class: self.surface_class,
        }
    }

    /// Returns the water on the ground at a position in the host's world, for
    /// [`Context::ground_at`](crate::context::Context::ground_at).
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] if the position is not finite, farther than 1e12 m from the world's origin, or not
    /// at an altitude in \[-1e4, 1e9\] m.
    pub fn at(&self, world: &World, position: DVec3) -> Result<GroundAt> {
        let frame = world.frame.place_at("position", position)?;
        let surface_class = self.surface_class_at(world, position);
        if let Some((cell, puddles)) = self.terrain_at(position).or_else(|| self.tiles_at(world, position)) {
            return Ok(GroundAt {
                water_mm: cell.depth_mm(),
                film_mm: cell.film_mm,
                wetness: cell.wetness(),
                puddles,
                in_puddle: cell.standing_mm > 0.0,
                surface_class,
            });
        }
        let reported = world.over().weather_at(position, world.time_s).surface;
        let cover = self.cover_at(world, position, reported);
        let kept = GroundWater::of_cover(&cover);
        let water = match self.water(world) {
            Some(state) if cover == self.cover(world, reported) => state,
            Some(state) => state.max(&kept),
            None => kept,
        };
        let at = DVec2::from(pattern_axes(&frame.world_to_enu).map(|a| a.dot(position)));
        let hollow_mm = depth_at_mm(&water, self.hollows.depth(at));
        let water_mm = if surface_class.has_hollows() { hollow_mm } else { water.film_mm };
        Ok(GroundAt {
            water_mm,
            film_mm: water.film_mm,
            wetness: cover.wetness,
            puddles: cover.puddles,
            in_puddle: water_mm > water.film_mm,
            surface_class,
        })
    }

    /// Takes the ground's values out of a saved state. `tiles` is the terrain on which saved water of tiles must lie.
    ///
    /// # Errors
    /// [`Status::Parse`] for values that cannot be a ground of this context. [`Status::InvalidArgument`] if the state
    /// has a grid and the context has tiles, or if the saved water lies on other tiles.
    pub fn read(&self, world: &World, tiles: Option<&Terrain>, saved: &mut toml::Table) -> Result<LoadedGround> {
        let fault = |key: &str, e: toml::de::Error| parse_error(format_args!("{key}: {e}"));
        // Removes all keys first: even if a value here is wrong, the table is left without the ground's keys.
        let [state, terrain, class, tile_water] =
            [STATE_KEY, TERRAIN_KEY, CLASS_KEY, TILES_KEY].map(|key| saved.remove(key));
        let simulated = self.model == GroundModel::Simulated;
        let state: Option<GroundState> = state.map(|v| v.try_into().map_err(|e| fault(STATE_KEY, e))).transpose()?;
        if state.is_some_and(|g| !simulated || !g.is_valid()) {
            return Err(parse_error("ground must be a simulated one with finite amounts of water from 0 on"));
        }
        let terrain: Option<SavedGround> =
            terrain.map(|v| v.try_into().map_err(|e| fault(TERRAIN_KEY, e))).transpose()?;
        let host = terrain.map(|t| {
            let of_a_state = simulated && state.is_some();
            let loaded = t.host_ground(&world.frame).filter(|held| of_a_state || !held.begun);
            let wanted = "terrain must be a grid of heights and the water that it can hold";
            loaded.map(Box::new).ok_or_else(|| parse_error(wanted))
        });
        let class: u8 =
            class.map_or(Ok(SurfaceClass::Unspecified as u8), |v| v.try_into().map_err(|e| fault(CLASS_KEY, e)))?;
        let class = SurfaceClass::from_number("surface_class", class);
        let tile_water: Option<SavedTiles> =
            tile_water.map(|v| v.try_into().map_err(|e| fault(TILES_KEY, e))).transpose()?;
        if host.is_some() && tiles.is_some() {
            let wanted = "holds a ground grid: remove the tiles of the terrain before, with wk_context_set_terrain";
            return Err(Error::invalid("state", wanted));
        }
        let tiled = match tile_water {
            Some(saved) => Some(Box::new(saved.water(tiles)?)),
            None => tiles.map(|terrain| Box::new(TiledWater::of_all(terrain))),
        };
        Ok(LoadedGround {
            tiled,
            waiting: Vec::new(),
            state,
            host: host.transpose()?,
            surface_class: class.map_err(|e| e.with_status(Status::Parse).found_in("saved state"))?,
            terrain_from_s: f64::NEG_INFINITY,
        })
    }

    /// Activates a loaded ground; `other` then holds the previous one.
    pub fn swap_in(&mut self, other: &mut LoadedGround) {
        let same = match (self.grid(), other.host.as_ref().map(|held| &held.terrain.grid)) {
            (Some(old), Some(new)) => old.has_heights_of(new),
            (old, new) => old.is_none() && new.is_none(),
        };
        (self.revision, self.classes_revision) = (self.revision + 1, self.classes_revision + 1);
        self.generation += u64::from(!same);
        std::mem::swap(&mut self.state, &mut other.state);
        std::mem::swap(&mut self.host, &mut other.host);
        std::mem::swap(&mut self.surface_class, &mut other.surface_class);
        std::mem::swap(&mut self.terrain_from_s, &mut other.terrain_from_s);
        std::mem::swap(&mut self.tiled, &mut other.tiled);
        std::mem::swap(&mut self.waiting, &mut other.waiting);
    }
}

impl HeldEffect for HeldGround {
    fn begin(&mut self, world: &World, time_s: f64) -> Result<()> {
        if self.model == GroundModel::Reported {
            return Ok(());
        }
        self.state = Some(if time_s - world.time_s > LONGEST_S {
            // The start is a multiple of SUN_EVERY_S, so leaps that end at slightly different times start alike.
            let begin_s = ((time_s - LONGEST_S) / SUN_EVERY_S).floor() * SUN_EVERY_S;
            let state = GroundState::first(world, begin_s.max(world.time_s))?;
            self.host.iter_mut().for_each(|host| host.begin_anew());
            self.tiled.iter_mut().for_each(|tiled| tiled.begin_anew());
            state
        } else {
            self.state.map_or_else(|| GroundState::first(world, world.time_s), Ok)?
        });
        Ok(())
    }

    fn settle(&mut self, world: &World) {
        self.follow_late(world);
        self.follow_dug(world);
    }

    fn publish(&mut self, world: &mut World) {
        let Some(mut dug) = world.dug.take() else { return };
        dug.changes.clear();
        self.publish_water(world, &mut dug);
        world.dug = Some(dug);
    }

    fn advance(&mut self, world: &World, budget: UpdateBudget) -> Result<Status> {
        self.follow_late(world);
        self.follow_dug(world);
        let Some(mut state) = self.state else { return Ok(Status::Ok) };
        for steps in 0.. {
            let end_s = state.next_s();
            if end_s > budget.until_s {
                break;
            }
            if steps > 0 && budget.begun.elapsed() >= budget.most {
                return Ok(Status::Pending);
            }
            if state.time_s.rem_euclid(SUN_EVERY_S) == 0.0 {
                state.sunlight_w_m2 = world.sunlight_w_m2(state.time_s)?;
            }
            let (before, from_s, seconds) = (state.water(), state.time_s, end_s - state.time_s);
            let c = world.timeline.at(0.5 * (from_s + end_s));
            let forcing = forcing(world, &c, &state);
            let step = GroundStep {
                from_s,
                seconds,
                conditions: &c,
                forcing: &forcing,
                sunlight_w_m2: state.sunlight_w_m2,
                water: &before,
            };
            if !self.step_tiles(world, &step, budget)? {
                return Ok(Status::Pending);
            }
            state.set(before.after(&forcing, seconds));
            state.time_s = end_s;
            if let Some(host) = self.host.as_mut().filter(|_| from_s >= self.terrain_from_s) {
                let stepped = host.advance(world, &step)?;
                self.revision += u64::from(stepped);
            }
            self.state = Some(state);
        }
        Ok(Status::Ok)
    }

    fn reads_next_s(&self) -> Option<f64> {
        self.state.map(|state| state.next_s())
    }

    fn stepped_to_s(&self) -> Option<f64> {
        self.state.map(|state| state.time_s)
    }

    fn refresh(&mut self, world: &World) -> Result<()> {
        let Some(host) = &mut self.host else { return Ok(()) };
        self.revision += u64::from(host.refresh(world, self.model, self.state.as_ref())?);
        Ok(())
    }

    fn created(&self, table: &mut toml::Table) {
        table.insert("ground_model".into(), format!("{:?}", self.model).into());
    }

    fn save_in(&self, world: &World, for_hash: bool, table: &mut toml::Table) -> Result<()> {
        self.save(table)?;
        self.save_tiles(world, for_hash, table)
    }

    fn save(&self, table: &mut toml::Table) -> Result<()> {
        let written = |e| Error::new(Status::Internal, format!("the state cannot be written: {e}"));
        if let Some(state) = &self.state {
            table.insert(STATE_KEY.into(), toml::Value::try_from(state).map_err(written)?);
        }
        if let Some(host) = &self.host {
            table.insert(TERRAIN_KEY.into(), toml::Value::try_from(SavedGround::of(host)).map_err(written)?);
        }
        if self.surface_class != SurfaceClass::Unspecified {
            table.insert(CLASS_KEY.into(), i64::from(self.surface_class as u8).into());
        }
        Ok(())
    }
}

/// Returns the liquid (rain or meltwater) and the evaporation that act on the ground from the state's time on, in the
/// weather `c`.
fn forcing(world: &World, c: &Conditions, state: &GroundState) -> Forcing {
    forcing_from(world, c, state.sunlight_w_m2, state.time_s)
}

/// Returns the snow on level, open ground: the simulated snow, else the reported depth of snow with the density and
/// albedo of snow some days old.
fn snow_about(world: &World, now: &SceneMoment<'_>) -> SnowHere {
    if let Some(snow) = &world.snow {
        return snow.country;
    }
    let (depth_m, thaws) = (now.scene.conditions.surface.snow_depth_m, now.scene.conditions.air.temperature_c > 0.0);
    let wetness = if thaws { 0.7 } else { 0.0 };
    SnowHere { depth_m, density_kg_m3: 250.0, wetness, albedo: 0.82 }
}
