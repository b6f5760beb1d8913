//! Tiles of the host's terrain in a context, and the water on them.

use std::sync::Arc;

use glam::DVec3;

use super::{
    class::SurfaceClass,
    grid::ABOVE_M,
    held::{HeldGround, TILES_KEY},
    host::GroundCell,
    state::GroundStep,
    terrain::CellWater,
    tiled::{Changed, SavedTiles, TiledStep, TiledWater},
    water::{GroundWater, PORES_MM},
    window::Shown,
};
use crate::{
    error::{Error, Result, Status},
    terrain::{CellId, CellRect, Terrain, TerrainCells, TerrainDesc, TileKey},
    world::{DUG_SIDE, DUG_WATER_S, DugGround, UpdateBudget, World},
};

/// Returns the error for a tile that is set before a terrain.
fn without_terrain() -> Error {
    Error::new(Status::WrongOrder, "tiles come after wk_context_set_terrain: there is no terrain")
}

impl HeldGround {
    /// Sets the lattice of a terrain that has no tiles yet, or removes the terrain; see
    /// [`Context::set_terrain`](crate::context::Context::set_terrain). A new lattice also removes the host's grid.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_terrain(&mut self, world: &mut World, desc: Option<TerrainDesc>) -> Result<()> {
        if world.set.tiles.as_ref().map(|t| t.desc) == desc {
            return Ok(());
        }
        let terrain = desc.map(|desc| Terrain::new(desc, &world.frame)).transpose()?;
        if terrain.is_some() {
            self.set_grid(world, None)?;
            world.set.terrain = None;
        }
        self.tiled = terrain.as_ref().map(|terrain| Box::new(TiledWater::new(terrain)));
        self.waiting.clear();
        self.revision += 1;
        world.set.tiles = terrain.map(Arc::new);
        Ok(())
    }

    /// Changes the tiles by `change`, which returns the cells that it touched. If `waits`, steps from before the change
    /// are still to be done, and the water is updated later.
    fn change(
        &mut self,
        world: &mut World,
        waits: bool,
        is_removal: bool,
        change: impl FnOnce(&mut Terrain) -> Result<Option<CellRect>>,
    ) -> Result<()> {
        let terrain = Arc::make_mut(world.set.tiles.as_mut().ok_or_else(without_terrain)?);
        let Some(rect) = change(terrain)? else { return Ok(()) };
        let changed = Changed { revision: terrain.revision, rect, is_removal };
        let Some(terrain) = &world.set.tiles else { return Ok(()) };
        if waits {
            self.waiting.push((changed, terrain.clone()));
        } else {
            self.follow_change(&changed, terrain);
        }
        Ok(())
    }

    /// Updates the water after a change of its terrain.
    fn follow_change(&mut self, changed: &Changed, terrain: &Terrain) {
        if let Some(tiled) = self.tiled.as_mut().filter(|tiled| tiled.is_of(terrain)) {
            tiled.follow(terrain, changed);
            self.revision += 1;
        }
    }

    /// Sets a tile; see [`Context::set_terrain_tile`](crate::context::Context::set_terrain_tile).
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without a terrain, [`Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_tile(&mut self, world: &mut World, waits: bool, cells: &TerrainCells<'_>) -> Result<()> {
        self.change(world, waits, false, |terrain| terrain.set_tile(cells))
    }

    /// Updates cells of a tile; see [`Context::update_terrain`](crate::context::Context::update_terrain).
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without a terrain, [`Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn update_tile(&mut self, world: &mut World, waits: bool, cells: &TerrainCells<'_>) -> Result<()> {
        self.change(world, waits, false, |terrain| terrain.update(cells))
    }

    /// Removes a tile; see [`Context::remove_terrain_tile`](crate::context::Context::remove_terrain_tile).
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without a terrain, [`Status::InvalidArgument`] if the tile is not set; nothing changes
    /// then.
    pub fn remove_tile(&mut self, world: &mut World, waits: bool, key: TileKey) -> Result<()> {
        self.change(world, waits, true, |terrain| terrain.remove(key).map(Some))
    }

    /// Updates the water after the changes that had to wait, up to the world's present terrain. Each change is applied
    /// with the terrain that resulted from it.
    pub(super) fn follow_late(&mut self, world: &World) {
        let Some(now) = world.set.tiles.as_ref().filter(|_| !self.waiting.is_empty()) else { return };
        let count = self.waiting.iter().take_while(|(changed, _)| changed.revision <= now.revision).count();
        for (changed, terrain) in self.waiting.drain(..count).collect::<Vec<_>>() {
            self.follow_change(&changed, &terrain);
        }
        // Marks all water as changed: windows already have the new ground, but the old water.
        self.tiled.iter_mut().for_each(|tiled| tiled.count_version());
    }

    /// Updates the water after changes of the heights by soil.
    pub(super) fn follow_dug(&mut self, world: &World) {
        let (Some(terrain), Some(dug)) = (&world.set.tiles, &world.dug) else { return };
        for rect in &dug.changes {
            let changed = Changed { revision: terrain.revision, rect: *rect, is_removal: false };
            self.follow_change(&changed, terrain);
        }
    }

    /// Publishes how wet the dug ground is, at the times at which the soil reads it.
    pub(super) fn publish_water(&mut self, world: &World, dug: &mut DugGround) {
        let Some(state) = self.state.filter(|state| state.time_s.rem_euclid(DUG_WATER_S) == 0.0) else { return };
        let is_published = dug.water.as_ref().is_some_and(|water| water.time_s == state.time_s);
        if is_published && self.published == Some((state.time_s, self.revision)) {
            return;
        }
        self.published = Some((state.time_s, self.revision));
        let even = state.water();
        let water = dug.water.get_or_insert_default();
        (water.time_s, water.level) = (state.time_s, even.soaked_mm / PORES_MM);
        water.patches.clear();
        let (Some(terrain), Some(tiled)) = (&world.set.tiles, &self.tiled) else { return };
        let soaked = |cell: CellId| {
            let c = tiled.cell(terrain, cell, &even);
            if c.standing_mm > 0.0 { 1.0 } else { c.soaked }
        };
        for key in &dug.patches {
            let place = |i: i32| [key[0] * DUG_SIDE + 2 + 4 * (i % 4), key[1] * DUG_SIDE + 2 + 4 * (i / 4)];
            let cells = (0..16).filter_map(|i| terrain.cell_at(place(i)));
            let (sum, count) = cells.fold((0.0, 0.0), |(sum, count), cell| (sum + soaked(cell), count + 1.0));
            water.patches.insert(*key, if count > 0.0 { sum / count } else { water.level });
        }
    }

    /// Advances the water on the tiles by a step, or on some of them within the budget. Returns whether all tiles are
    /// done.
    pub(super) fn step_tiles(&mut self, world: &World, step: &GroundStep<'_>, budget: UpdateBudget) -> Result<bool> {
        let (Some(terrain), Some(tiled)) = (world.set.tiles.as_ref(), self.tiled.as_mut()) else { return Ok(true) };
        if !tiled.is_of(terrain) {
            return Ok(true);
        }
        let step = TiledStep { world, terrain, ground: *step };
        let stepped = tiled.step(&step, Some(budget))?;
        self.revision += u64::from(stepped.is_some_and(|s| s.changes));
        Ok(stepped.is_some())
    }

    /// Returns the water of level ground, simulated or else of the reported cover. Tiles without a state of their own
    /// have the same water.
    pub(super) fn even_water(&self, world: &World) -> GroundWater {
        self.water(world).unwrap_or_else(|| GroundWater::of_cover(&world.timeline.at(world.time_s).surface))
    }

    /// Returns the class of a tile's cell at a place; `None` off the tiles, and at [`ABOVE_M`] or more above their
    /// ground.
    pub(super) fn tile_class_at(&self, world: &World, position: DVec3) -> Option<SurfaceClass> {
        let terrain = world.set.tiles.as_ref()?;
        let (_, height) = terrain.cells_at(position);
        let point = terrain.point_at(position)?;
        (height < point.height_m + ABOVE_M).then_some(point.surface_class)
    }

    /// Returns the water at a place on the tiles, and the share of all tiles under standing water; `None` elsewhere.
    pub(super) fn tiles_at(&self, world: &World, position: DVec3) -> Option<(CellWater, f64)> {
        let (terrain, tiled) = (world.set.tiles.as_ref()?, self.tiled.as_ref()?);
        if !tiled.is_of(terrain) {
            return None;
        }
        self.tile_class_at(world, position)?;
        let (cells, _) = terrain.cells_at(position);
        Some((tiled.between(terrain, cells, &self.even_water(world))?, tiled.puddles()))
    }

    /// Returns the data from which a view fills its window; `None` without tiles.
    pub(super) fn shown_tiles<'a>(&'a self, world: &'a World, ice: f64) -> Option<Shown<'a>> {
        let terrain = world.set.tiles.as_deref()?;
        let water = self.tiled.as_ref().filter(|tiled| tiled.is_of(terrain))?;
        let snow = world.snow.as_deref();
        Some(Shown { terrain, water, even: self.even_water(world), ice: ice as f32, snow })
    }

    /// Returns the water of each cell of a tile; `None` if there is no such tile. A cell without ground has no water.
    pub fn tile_water<'a>(
        &'a self,
        world: &'a World,
        key: TileKey,
    ) -> Option<impl ExactSizeIterator<Item = GroundCell> + 'a> {
        let terrain = world.set.tiles.as_ref()?;
        let slot = terrain.slot(key)?;
        let tiled = self.tiled.as_ref().filter(|tiled| tiled.is_of(terrain))?;
        let (tile, even) = (terrain.tile(slot), self.even_water(world));
        let ice = world.timeline.at(world.time_s).surface.ice as f32;
        Some((0..tile.heights_m.len()).map(move |cell| {
            if !tile.has_ground(cell) {
                return GroundCell::default();
            }
            let c = tiled.cell(terrain, terrain.joined(slot, cell), &even);
            GroundCell {
                film_mm: c.film_mm as f32,
                soaked: c.soaked as f32,
                standing_mm: c.standing_mm.max(0.0) as f32,
                ice,
            }
        }))
    }

    /// Adds the water on the tiles to a saved state. If `for_hash`, film and pores of each tile are given only by their
    /// hash.
    pub(super) fn save_tiles(&self, world: &World, for_hash: bool, table: &mut toml::Table) -> Result<()> {
        let (Some(terrain), Some(tiled)) = (&world.set.tiles, &self.tiled) else { return Ok(()) };
        let saved = toml::Value::try_from(SavedTiles::of(tiled, terrain, for_hash));
        let written = |e| Error::new(Status::Internal, format!("the state cannot be written: {e}"));
        table.insert(TILES_KEY.into(), saved.map_err(written)?);
        Ok(())
    }
}
