//! Soil of a context, on the tiles of the host's terrain: advanced, saved, and shown to all other effects as the
//! heights and colours of the tiles.
//!
//! The host's tiles are the undug ground. After each step the change of the soil is added to the heights of the tiles
//! where the soil changed, so queries, water, snow and wind see one ground. [`DugGround::changes`] tells the water in
//! which rectangles heights have changed. Once a minute the soil reads from the world how wet the ground is. All
//! effects advance together up to the end of each step of soil ([`HeldEffect::reads_next_s`]), so the same poses give
//! the same bits at any frame rate.

use std::{collections::BTreeMap, sync::Arc, time::Instant};

use super::{
    kind::SoilSettings,
    material::DEPTH_UNITS,
    patch::{CELLS, SIDE, UndugGround},
    saved::SavedSite,
    shown::ShownSoil,
    site::{SOIL_STEP_S, SoilPoint, SoilSite, SoilSiteDesc, steps_until},
    weather::WEATHER_STEPS,
};
use crate::{
    error::{Error, Result, Status, check_range},
    terrain::{CellRect, DugCell, Terrain, TileKey},
    world::{DUG_SIDE, DUG_WATER_S, DugGround, HeldEffect, UpdateBudget, World, parse_error},
};

const _: () = assert!(SIDE as i32 == DUG_SIDE && WEATHER_STEPS as f64 * SOIL_STEP_S == DUG_WATER_S);

/// Wetness of the ground, as the weather reports it, at which its pores are full.
const DAMP: f64 = 0.3;
/// Distance between changes, in cells, up to which they are joined into one.
const NEAR_CELLS: i32 = 2;
/// Key of the soil in a saved state.
const KEY: &str = "soil";

/// Rectangle of a tile in which soil has changed heights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SoilChange {
    /// Key of the tile.
    pub tile: TileKey,
    /// South-western cell of the rectangle, counted east and north within the tile.
    pub first: [u32; 2],
    /// Number of cells of the rectangle east and north.
    pub size: [u32; 2],
    /// Revision of the terrain at the last change.
    pub revision: u64,
}

/// Soil of a context.
#[derive(Default)]
pub(crate) struct HeldSoil {
    pub(super) site: Option<Box<SoilSite>>,
    /// Identity of the terrain on which the soil lies, and the last of the host's revisions of this terrain that the
    /// soil has read.
    ground: (u64, u64),
    /// As `ground`, for the heights that were published last.
    shown: (u64, u64),
    /// Revision of the terrain at which the heights of each patch last changed, by the patch's place, north and east.
    listed: BTreeMap<[i32; 2], u64>,
    /// Beginning of the update in which the last step was done.
    begun: Option<Instant>,
    /// Scratch: patches whose heights have changed, and where.
    changed: Vec<([i32; 2], CellRect)>,
}

/// Soil of a saved state, not yet active, with the tiles that show it.
#[derive(Default)]
pub(crate) struct LoadedSoil {
    site: Option<Box<SoilSite>>,
    tiles: Option<Arc<Terrain>>,
}

impl LoadedSoil {
    /// Returns the tiles with the heights of the loaded soil.
    pub fn tiles(&self) -> Option<&Terrain> {
        self.tiles.as_deref()
    }
}

impl UndugGround for Terrain {
    fn height_m(&self, cell: [i32; 2]) -> Option<f64> {
        self.undug_m(cell)
    }
}

/// Writes the change of the soil into the heights and colours of the tiles. `is_known` says that the host has changed
/// no tile since the last call. Adds each patch that has changed to `changed`, with the rectangle of the changed cells.
fn show(terrain: &mut Terrain, site: &SoilSite, is_known: bool, changed: &mut Vec<([i32; 2], CellRect)>) {
    let (shown, revision) = (terrain.soil_revision, terrain.revision + 1);
    let mut cells = [DugCell::default(); CELLS];
    for slot in site.field.slots.values() {
        let patch = site.field.patch(*slot);
        if is_known && patch.revision <= shown {
            continue;
        }
        let first = patch.key.map(|k| k * DUG_SIDE);
        let Some(tile_slot) = terrain.slot_at(first) else { continue };
        let tile = terrain.tile(tile_slot);
        if patch.revision <= tile.soil_revision {
            continue;
        }
        let mut count = 0;
        for cell in (0..CELLS).filter(|cell| patch.has_ground(*cell)) {
            let at = terrain.in_tile([first[0] + (cell % SIDE) as i32, first[1] + (cell / SIDE) as i32]);
            let (undug_m, change) = (tile.undug_m(at), patch.change(cell));
            let dug_m = (f64::from(undug_m) + change as f64 / DEPTH_UNITS) as f32;
            let color = ShownSoil::of(patch, cell, &site.field.materials).color();
            cells[count] = DugCell { cell: at, height_m: if change == 0 { undug_m } else { dug_m }, color };
            count += 1;
        }
        let rect = terrain.set_dug(tile_slot, &cells[..count], revision);
        changed.extend(rect.map(|rect| (patch.key, rect)));
    }
    for (key, _) in changed.iter() {
        if let Some(slot) = terrain.slot_at(key.map(|k| k * DUG_SIDE)) {
            terrain.note_dug(slot, site.revision());
        }
    }
    terrain.soil_revision = site.revision();
    terrain.surface_soil = ShownSoil::of_surface(&site.field.materials).color();
}

/// Adds rectangles to a list, joined where they lie near each other.
fn join(rects: impl Iterator<Item = CellRect>, list: &mut Vec<CellRect>) {
    for mut rect in rects {
        while let Some(near) = list.iter().position(|other| other.grown(NEAR_CELLS).meets(rect).is_some()) {
            rect = rect.with(list.swap_remove(near));
        }
        list.push(rect);
    }
}

/// Tells a site how wet its surface is.
fn wet(site: &mut SoilSite, world: &World) {
    let time_s = site.time_s();
    let simulated = world.dug.as_ref().and_then(|dug| dug.water.as_ref()).filter(|water| water.time_s == time_s);
    match simulated {
        Some(water) => site.wet(water.level, |key| water.patches.get(&key).copied().unwrap_or(water.level)),
        None => {
            let soaked = (world.timeline.at(time_s).surface.wetness / DAMP).clamp(0.0, 1.0);
            site.wet(soaked, |_| soaked);
        }
    }
}

impl HeldSoil {
    /// Replaces the soil by undug ground with these kinds and layers. `None` removes the soil. Settings equal to the
    /// present ones change nothing.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without tiles, [`Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set(&mut self, world: &mut World, settings: Option<SoilSettings>) -> Result<()> {
        if self.site.as_ref().map(|site| &site.desc().settings) == settings.as_ref() {
            return Ok(());
        }
        let site = match settings {
            None => None,
            Some(settings) => {
                let terrain = world.set.tiles.as_deref().ok_or_else(without_terrain)?;
                let cell_m = terrain.desc.cell_m;
                check_range("terrain.cell_m", cell_m, 0.01, 4.0, "m, where there is soil")?;
                let mut site = SoilSite::new(SoilSiteDesc { cell_m, settings })?;
                site.begin_at(world.time_s);
                self.ground = (terrain.id, terrain.host_revision);
                Some(Box::new(site))
            }
        };
        self.site = site;
        if let Some(tiles) = world.set.tiles.as_mut().filter(|tiles| tiles.soil_revision > 0) {
            let tiles = Arc::make_mut(tiles);
            let rects = tiles.undo_dug();
            let revision = tiles.revision;
            self.listed.values_mut().for_each(|listed| *listed = revision);
            join(rects.into_iter(), &mut world.dug.get_or_insert_default().changes);
        }
        if let Some(dug) = &mut world.dug {
            (dug.patches, dug.water) = (Vec::new(), None);
        }
        Ok(())
    }

    /// Adapts the soil to the host's changes of the tiles. If the terrain is another one, the soil is removed.
    fn follow(&mut self, world: &World) {
        let now = world.set.tiles.as_ref().map(|tiles| (tiles.id, tiles.host_revision));
        if self.site.is_none() || now == Some(self.ground) {
            return;
        }
        let known = world.set.tiles.as_deref().filter(|tiles| tiles.id == self.ground.0);
        match (known, &mut self.site) {
            (Some(tiles), Some(site)) => {
                site.follow_ground(tiles);
                self.ground = (tiles.id, tiles.host_revision);
            }
            _ => {
                self.site = None;
                self.listed.clear();
            }
        }
    }

    /// Returns the site.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without soil.
    pub fn site(&self) -> Result<&SoilSite> {
        self.site.as_deref().ok_or_else(without_soil)
    }

    /// Returns the site, and its undug ground.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without soil.
    pub fn site_mut<'a>(&'a mut self, world: &'a World) -> Result<(&'a mut SoilSite, &'a Terrain)> {
        let tiles = world.set.tiles.as_deref().ok_or_else(without_soil)?;
        Ok((self.site.as_deref_mut().ok_or_else(without_soil)?, tiles))
    }

    /// Returns the rectangles in which heights changed after a revision of the terrain, by rows from the south, on
    /// tiles with sides of `tile_cells` cells.
    pub fn changes_since(&self, revision: u64, tile_cells: u32) -> impl Iterator<Item = SoilChange> + '_ {
        let side = tile_cells as i32;
        let later = self.listed.iter().filter(move |(_, listed)| **listed > revision);
        later.map(move |([north, east], listed)| {
            let first = [east * DUG_SIDE, north * DUG_SIDE];
            SoilChange {
                tile: TileKey::new(first[0].div_euclid(side), first[1].div_euclid(side)),
                first: first.map(|v| v.rem_euclid(side) as u32),
                size: [DUG_SIDE as u32; 2],
                revision: *listed,
            }
        })
    }

    /// Returns the ground of a cell, with the revision of the terrain at its last change.
    pub fn point(&self, site: &SoilSite, place: [i32; 2], terrain: &Terrain) -> Option<SoilPoint> {
        let [east, north] = place.map(|v| v.div_euclid(DUG_SIDE));
        let revision = self.listed.get(&[north, east]).copied().unwrap_or(0);
        site.cell(place, terrain).map(|point| SoilPoint { revision, ..point })
    }

    /// Takes the soil out of a saved state.
    ///
    /// # Errors
    /// [`Status::Parse`] for values that cannot be soil; [`Status::InvalidArgument`] if the tiles are missing, have
    /// cells of another size, or a setting is outside its range.
    pub fn read(&self, world: &World, state: &mut toml::Table) -> Result<LoadedSoil> {
        let saved: Option<SavedSite> =
            state.remove(KEY).map(|v| v.try_into().map_err(|e| parse_error(format_args!("{KEY}: {e}")))).transpose()?;
        let tiles = world.set.tiles.as_ref();
        let site = saved.map(|saved| {
            let wanted = "holds soil on a terrain of tiles: set the terrain and its tiles before";
            let terrain = tiles.ok_or_else(|| Error::invalid("state", wanted))?;
            if terrain.desc.cell_m != saved.cell_m {
                let (own, here) = (saved.cell_m, terrain.desc.cell_m);
                return Err(Error::invalid(
                    "state",
                    format!("holds soil on cells of {own} m, here they have {here} m"),
                ));
            }
            saved.site(&**terrain).map(Box::new)
        });
        let site = site.transpose()?;
        let tiles = tiles.cloned().map(|mut tiles| {
            let has_soil = site.as_ref().is_some_and(|site| !site.field.patches.is_empty());
            if has_soil || tiles.soil_revision > 0 {
                let terrain = Arc::make_mut(&mut tiles);
                terrain.undo_dug();
                terrain.revision += 1;
                site.iter().for_each(|site| show(terrain, site, false, &mut Vec::new()));
            }
            tiles
        });
        Ok(LoadedSoil { site, tiles })
    }

    /// Activates loaded soil and the tiles that show it; `other` then holds the previous ones.
    pub fn swap_in(&mut self, world: &mut World, other: &mut LoadedSoil) {
        std::mem::swap(&mut self.site, &mut other.site);
        std::mem::swap(&mut world.set.tiles, &mut other.tiles);
        let (Some(tiles), true) = (&world.set.tiles, self.site.is_some() || !self.listed.is_empty()) else {
            (self.listed, world.dug) = (BTreeMap::new(), None);
            return;
        };
        self.listed.values_mut().for_each(|listed| *listed = tiles.revision);
        self.ground = (tiles.id, tiles.host_revision);
        (self.shown, self.begun) = (self.ground, None);
        let patches = self.site.iter().flat_map(|site| &site.field.patches).map(|patch| patch.key);
        self.listed.extend(patches.clone().map(|[east, north]| ([north, east], tiles.revision)));
        world.dug = Some(Box::new(DugGround { patches: patches.collect(), ..DugGround::default() }));
    }
}

/// Returns the error for soil before a terrain.
fn without_terrain() -> Error {
    Error::new(Status::WrongOrder, "soil comes after wk_context_set_terrain: there is no terrain")
}

/// Returns the error for calls that need soil.
fn without_soil() -> Error {
    Error::new(Status::WrongOrder, "this comes after wk_context_set_soil: there is no soil")
}

impl HeldEffect for HeldSoil {
    fn advance(&mut self, world: &World, budget: UpdateBudget) -> Result<Status> {
        self.follow(world);
        let (Some(site), Some(terrain)) = (&mut self.site, &world.set.tiles) else { return Ok(Status::Ok) };
        let due = steps_until(budget.until_s);
        while site.steps < due {
            if self.begun == Some(budget.begun) && budget.begun.elapsed() >= budget.most {
                return Ok(Status::Pending);
            }
            self.begun = Some(budget.begun);
            if site.steps % WEATHER_STEPS == 0 {
                wet(site, world);
            }
            let next = (site.steps.div_euclid(WEATHER_STEPS) + 1) * WEATHER_STEPS;
            site.run(due.min(next), &**terrain);
            if site.steps % WEATHER_STEPS == 0 {
                site.weather(world.timeline.at(site.time_s()).air.temperature_c);
            }
        }
        Ok(Status::Ok)
    }

    fn settle(&mut self, world: &World) {
        self.follow(world);
    }

    fn publish(&mut self, world: &mut World) {
        let (Some(site), Some(tiles)) = (&self.site, &mut world.set.tiles) else {
            if world.dug.as_ref().is_some_and(|dug| dug.changes.is_empty()) {
                world.dug = None;
            }
            return;
        };
        let now = (tiles.id, tiles.host_revision);
        let is_known = self.shown == now;
        let dug = world.dug.get_or_insert_default();
        if is_known && tiles.soil_revision == site.revision() {
            return;
        }
        self.changed.clear();
        show(Arc::make_mut(tiles), site, is_known, &mut self.changed);
        self.shown = now;
        self.listed.extend(self.changed.iter().map(|([east, north], _)| ([*north, *east], tiles.revision)));
        let first_new = dug.patches.len();
        dug.patches.extend(site.field.patches[first_new..].iter().map(|patch| patch.key));
        join(self.changed.iter().map(|(_, rect)| *rect), &mut dug.changes);
    }

    fn changes_until(&self, _world: &World) -> bool {
        self.site.is_some()
    }

    fn reads_next_s(&self) -> Option<f64> {
        let site = self.site.as_ref()?;
        let minute = (site.steps.div_euclid(WEATHER_STEPS) + 1) * WEATHER_STEPS;
        let next = if site.is_quiet() { minute } else { site.steps + 1 };
        Some(next as f64 * SOIL_STEP_S)
    }

    fn stepped_to_s(&self) -> Option<f64> {
        self.site.as_ref().map(|site| site.time_s())
    }

    fn save_in(&self, _world: &World, for_hash: bool, table: &mut toml::Table) -> Result<()> {
        let Some(site) = &self.site else { return Ok(()) };
        let written = |e| Error::new(Status::Internal, format!("the state cannot be written: {e}"));
        table.insert(KEY.into(), toml::Value::try_from(SavedSite::of(site, for_hash)).map_err(written)?);
        Ok(())
    }
}
