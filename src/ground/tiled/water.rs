//! Water on a tiled terrain: its state, its changes when the ground changes, and queries.

use std::{
    collections::BTreeMap,
    sync::atomic::{AtomicU64, Ordering::Relaxed},
};

use glam::DVec2;

use super::{drains::Sink, lakes::Lakes, tile::TileWater};
use crate::{
    ground::{
        terrain::{CellWater, Flows},
        water::{GroundWater, PORES_MM},
    },
    terrain::{CellId, CellRect, Terrain, TileKey},
};

/// Value of standing water for a cell that belongs to no lake, mm.
const BARE_MM: f64 = -50.0;
/// Distance around a change of heights, in cells, within which lakes depend on the changed heights: a lake's own cell,
/// the saddle beside it, and the cell beyond the saddle.
const AROUND_LAKES: i32 = 2;

/// Part of the terrain that has changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Changed {
    /// Revision of the terrain after this change.
    pub revision: u64,
    /// Rectangle of cells that changed.
    pub rect: CellRect,
    /// Whether a tile was removed.
    pub is_removal: bool,
}

/// Progress of a step that only some tiles have done.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StepInParts {
    /// Last tile that is done.
    pub last: Option<TileKey>,
    /// Sums over the tiles that are done.
    pub flows: Flows,
    /// Whether water may have changed in the step, because rain fell or something flows or dries.
    pub changes: bool,
}

/// Water on a tiled terrain.
pub(crate) struct TiledWater {
    /// Identity of the terrain on which the water lies.
    id: u64,
    /// Water of each tile, by the tile's slot in the terrain.
    pub(super) tiles: Vec<Option<Box<TileWater>>>,
    /// Slot of each tile in the terrain, by the tile's key.
    pub(super) keys: BTreeMap<TileKey, u32>,
    /// Standing water.
    pub(super) lakes: Lakes,
    /// Progress of a step, if only some tiles are done.
    pub(super) part: Option<StepInParts>,
    /// Unique number of this water, and the number of its changes so far, without those at cells whose ground changed.
    pub(super) version: (u64, u64),
    /// Number of cells under standing water after the last step.
    pub(super) covered: f64,
    /// Number of all cells.
    pub(super) cells: f64,
}

/// Returns the pit in which the run-off of a cell ends; `None` if it leaves the terrain.
pub(super) fn pit_below(tiles: &[Option<Box<TileWater>>], terrain: &Terrain, mut cell: CellId) -> Option<CellId> {
    loop {
        let (slot, at) = terrain.split(cell);
        match tiles.get(slot)?.as_ref()?.drains.sink(at) {
            Sink::Pit(pit) => return Some(pit),
            Sink::On(next) => cell = next,
            Sink::Out => return None,
        }
    }
}

/// Pours water, mm times cells, into pits, row by row from the south-west pit on. Returns the part that leaves the
/// terrain.
pub(super) fn pour_all(
    (tiles, lakes): (&[Option<Box<TileWater>>], &mut Lakes),
    terrain: &Terrain,
    mut came: Vec<(CellId, f64)>,
) -> f64 {
    let place = |pit: CellId| {
        let [x, y] = terrain.place(pit);
        (y, x)
    };
    came.sort_by_cached_key(|(pit, _)| place(*pit));
    let below = |cell| pit_below(tiles, terrain, cell);
    let mut drained = 0.0;
    for same in came.chunk_by(|a, b| a.0 == b.0) {
        let water: f64 = same.iter().map(|(_, water)| water).sum();
        if water > 0.0 {
            drained += lakes.pour(terrain, &below, same[0].0, water);
        }
    }
    drained
}

impl TiledWater {
    /// Creates the water of a terrain whose tiles are still to be added ([`Self::follow`]).
    pub fn new(terrain: &Terrain) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        Self {
            id: terrain.id,
            tiles: Vec::new(),
            keys: BTreeMap::new(),
            lakes: Lakes::default(),
            part: None,
            version: (NEXT.fetch_add(1, Relaxed), 0),
            covered: 0.0,
            cells: 0.0,
        }
    }

    /// Creates the water of a terrain with all its tiles.
    pub fn of_all(terrain: &Terrain) -> Self {
        let mut new = Self::new(terrain);
        for (_, tile) in terrain.all() {
            let rect = terrain.rect(tile.key);
            new.follow(terrain, &Changed { revision: terrain.revision, rect, is_removal: false });
        }
        new
    }

    /// Returns whether this is the water of `terrain`.
    pub fn is_of(&self, terrain: &Terrain) -> bool {
        self.id == terrain.id
    }

    /// Returns the known tiles that a rectangle touches.
    fn touched(&self, terrain: &Terrain, rect: CellRect) -> Vec<(TileKey, u32)> {
        let keys = terrain.keys_within(rect);
        keys.filter_map(|key| Some((key, *self.keys.get(&key)?))).collect()
    }

    /// Updates the water after a change of the ground. Returns the water that left the terrain, mm times cells: with
    /// removed cells, or when the water of the touched lakes was poured again.
    pub fn follow(&mut self, terrain: &Terrain, change: &Changed) -> f64 {
        let loose = self.let_loose(terrain, change);
        let mut drained = self.follow_tiles(terrain, change);
        let rect = change.rect.grown(1);
        for (key, slot) in self.touched(terrain, rect) {
            if let Some(tile) = self.tiles[slot as usize].as_mut() {
                tile.drains.find(terrain, (slot, key), rect);
            }
        }
        self.version.1 += u64::from(!loose.is_empty());
        let mut came = Vec::with_capacity(loose.len());
        for (place, water) in loose {
            let cell = terrain.cell_at(place);
            if let Some(cell) = cell {
                self.wake(terrain, cell);
            }
            match cell.and_then(|cell| pit_below(&self.tiles, terrain, cell)) {
                Some(pit) => came.push((pit, water)),
                None => drained += water,
            }
        }
        drained + pour_all((&self.tiles, &mut self.lakes), terrain, came)
    }

    /// Removes the lakes that a change touches. Returns the places of their cells and the water on each, mm.
    fn let_loose(&mut self, terrain: &Terrain, change: &Changed) -> Vec<([i32; 2], f64)> {
        let mut lakes = Vec::new();
        let rect = change.rect.grown(AROUND_LAKES);
        for (key, slot) in self.touched(terrain, rect) {
            if self.lakes.has_any(slot as usize) {
                let part = terrain.rect(key).meets(rect).into_iter().flat_map(CellRect::cells);
                lakes.extend(part.filter_map(|p| self.lakes.lake_of(slot as usize, terrain.in_tile(p))));
            }
        }
        lakes.sort_unstable();
        lakes.dedup();
        let mut cells = Vec::new();
        lakes.iter().for_each(|lake| self.lakes.let_loose(terrain, *lake, &mut cells));
        let place = |(cell, water): (CellId, f64)| {
            let (slot, at) = terrain.split(cell);
            let key = self.tiles[slot].as_ref()?.key;
            Some((terrain.place_in(key, at), water))
        };
        cells.into_iter().filter_map(place).collect()
    }

    /// Adds and removes tiles to match the terrain. Returns the water that left with removed cells, mm times cells.
    fn follow_tiles(&mut self, terrain: &Terrain, change: &Changed) -> f64 {
        let mut drained = 0.0;
        for key in terrain.keys_within(change.rect) {
            let (had, has) = (self.keys.get(&key).copied(), terrain.slot(key));
            if let Some(slot) = had.filter(|_| change.is_removal || had != has) {
                drained += self.tiles[slot as usize].take().map_or(0.0, |tile| tile.on_cells());
                self.lakes.clear(slot);
                self.keys.remove(&key);
            }
            let Some(slot) = has else { continue };
            if let Some(tile) = self.tiles.get_mut(slot as usize).and_then(Option::as_mut).filter(|t| t.key == key) {
                drained += tile.follow(terrain.tile(slot), terrain, change.rect);
                continue;
            }
            if self.tiles.len() <= slot as usize {
                self.tiles.resize_with(slot as usize + 1, || None);
            }
            self.lakes.reserve(slot);
            let mut tile = Box::new(TileWater::new(terrain, slot));
            tile.drains.find(terrain, (slot, key), terrain.rect(key));
            self.tiles[slot as usize] = Some(tile);
            self.keys.insert(key, slot);
        }
        drained
    }

    /// Wakes the run of a cell, so that the run is stepped.
    pub(super) fn wake(&mut self, terrain: &Terrain, cell: CellId) {
        let (slot, at) = terrain.split(cell);
        if let Some(tile) = self.tiles.get_mut(slot).and_then(Option::as_mut) {
            tile.wake(at);
        }
    }

    /// Discards all water; the next step begins with the water of level, open ground at that time.
    pub fn begin_anew(&mut self) {
        self.lakes = Lakes::default();
        for (slot, tile) in self.tiles.iter_mut().enumerate() {
            tile.iter_mut().for_each(|tile| tile.begin_anew());
            self.lakes.reserve(slot as u32);
        }
        (self.part, self.covered) = (None, 0.0);
        self.version.1 += 1;
    }

    /// Returns the water of a cell. `even` is the water of level ground, used where a tile has no state of its own.
    pub fn cell(&self, terrain: &Terrain, cell: CellId, even: &GroundWater) -> CellWater {
        let (slot, at) = terrain.split(cell);
        let own = self.tiles.get(slot).and_then(Option::as_ref).filter(|tile| tile.begun);
        let [film_mm, soaked_mm] = own.map_or([even.film_mm, even.soaked_mm], |tile| tile.top(at));
        let lake = self.lakes.lake_of(slot, at);
        let deep = lake.map(|lake| self.lakes.level_mm(lake) - f64::from(terrain.height(cell)) * 1e3);
        CellWater { film_mm, soaked: soaked_mm / PORES_MM, standing_mm: deep.unwrap_or(BARE_MM) }
    }

    /// Returns the water at a place in cells east and north of the origin, interpolated between cells; `None` where
    /// there is no ground.
    pub fn between(&self, terrain: &Terrain, cells: DVec2, even: &GroundWater) -> Option<CellWater> {
        let about = terrain.about(cells)?;
        Some(about.fold(CellWater::default(), |sum, (cell, share)| {
            let c = self.cell(terrain, cell, even);
            CellWater {
                film_mm: sum.film_mm + share * c.film_mm,
                soaked: sum.soaked + share * c.soaked,
                standing_mm: sum.standing_mm + share * c.standing_mm,
            }
        }))
    }

    /// Returns whether there is any water on tiles that have a state of their own.
    pub fn is_wet(&self) -> bool {
        self.lakes.count > 0 || self.tiles.iter().flatten().any(|tile| tile.is_wet())
    }

    /// Returns numbers that differ after each change of the water, except a change at cells whose ground changed.
    pub fn version(&self) -> (u64, u64) {
        self.version
    }

    /// Marks all water as changed.
    pub fn count_version(&mut self) {
        self.version.1 += 1;
    }

    /// Returns whether any water may stand on the neighbours of a cell.
    pub fn has_lakes_near(&self, terrain: &Terrain, cell: CellId) -> bool {
        self.lakes.count > 0 && (self.lakes.has_any(terrain.split(cell).0) || terrain.is_at_border(cell))
    }

    /// Returns the level of the standing water that covers a cell, mm; `None` if there is none.
    pub fn level_mm(&self, terrain: &Terrain, cell: CellId) -> Option<f64> {
        let (slot, at) = terrain.split(cell);
        let level = self.lakes.level_mm(self.lakes.lake_of(slot, at)?);
        (level > f64::from(terrain.height(cell)) * 1e3).then_some(level)
    }

    /// Returns the share of the cells under standing water, as of the last step.
    pub fn puddles(&self) -> f64 {
        if self.cells > 0.0 { self.covered / self.cells } else { 0.0 }
    }

    /// Returns all water, mm times cells.
    #[cfg(test)]
    pub fn total(&self) -> f64 {
        self.tiles.iter().flatten().map(|tile| tile.on_cells()).sum::<f64>() + self.lakes.total()
    }
}
