//! The host's terrain in tiles.

use glam::DVec3;

use crate::{
    context::Context,
    error::Result,
    ground::{GroundCell, GroundTexture},
    land::TerrainDrawing,
    terrain::{TerrainCells, TerrainDesc, TerrainPoint, TileKey},
};

impl Context {
    /// Replaces the host's terrain, tiles or grid, by one in tiles on this lattice, at first without any tile. `None`
    /// removes the lattice with its tiles, but no grid. If the lattice is the present one, it keeps its tiles.
    ///
    /// With [`GroundModel::Simulated`](crate::ground::GroundModel::Simulated) each cell has water of its own, which
    /// [`Context::save`] keeps. Heights are not saved: set the same tiles before [`Context::load`]. Soil
    /// ([`Context::set_soil`]) lies on the lattice, and is removed when another lattice replaces it.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_terrain(&mut self, desc: Option<TerrainDesc>) -> Result<()> {
        self.held.ground.set_terrain(&mut self.world, desc)?;
        self.held.snowpack.ground_replaced(&self.world);
        self.settle();
        Ok(())
    }

    /// Adds a tile, or replaces all cells of an existing one. A new tile starts as wet as level ground, with as much
    /// simulated snow. An existing one keeps its water, and its snow wherever there is still ground. Heights are those
    /// of the undug ground: soil adds what was dug and heaped there, also on a tile that had been removed.
    ///
    /// # Errors
    /// [`crate::Status::WrongOrder`] without a lattice; [`crate::Status::InvalidArgument`] naming the field, or for
    /// more than [`MAX_TERRAIN_CELLS`](crate::terrain::MAX_TERRAIN_CELLS) in all. Nothing changes then.
    pub fn set_terrain_tile(&mut self, cells: &TerrainCells<'_>) -> Result<()> {
        let waits = self.is_behind();
        self.held.ground.set_tile(&mut self.world, waits, cells)?;
        self.held.snowpack.tile_changed(&mut self.world, cells.key, waits);
        self.let_soil_follow();
        Ok(())
    }

    /// Sets new heights, new classes, or both, in a rectangle of a tile's cells. Water that stands there flows wherever
    /// the new ground lets it. The cost grows with the rectangle and with the pools that it touches, not with the tile
    /// or the terrain.
    ///
    /// # Errors
    /// As [`Context::set_terrain_tile`]; also for a tile that does not exist.
    pub fn update_terrain(&mut self, cells: &TerrainCells<'_>) -> Result<()> {
        let waits = self.is_behind();
        self.held.ground.update_tile(&mut self.world, waits, cells)?;
        self.held.snowpack.tile_changed(&mut self.world, cells.key, waits);
        self.let_soil_follow();
        Ok(())
    }

    /// Removes a tile, with the water and the snow on it. Water of the cells beside it runs off. Soil on the tile stays
    /// in the balance ([`Context::soil_books`]), and comes back when the tile is set again.
    ///
    /// # Errors
    /// [`crate::Status::WrongOrder`] without a lattice; [`crate::Status::InvalidArgument`] for a tile that does not
    /// exist.
    pub fn remove_terrain_tile(&mut self, key: TileKey) -> Result<()> {
        let waits = self.is_behind();
        self.held.ground.remove_tile(&mut self.world, waits, key)?;
        self.held.snowpack.tile_changed(&mut self.world, key, waits);
        self.let_soil_follow();
        Ok(())
    }

    /// Sets whether and how Welkin draws the tiles; `None`, the default, leaves them to the host. They are drawn into
    /// frames with [`DepthAccess::ReadWrite`](crate::frame::DepthAccess::ReadWrite) and the stage
    /// [`Stages::SURFACE`](crate::frame::Stages::SURFACE). Not saved by [`Context::save`].
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_terrain_drawing(&mut self, drawing: Option<TerrainDrawing>) -> Result<()> {
        drawing.iter().try_for_each(TerrainDrawing::validate)?;
        self.held.land.drawing = drawing;
        Ok(())
    }

    /// Returns the settings with which Welkin draws the tiles.
    pub fn terrain_drawing(&self) -> Option<TerrainDrawing> {
        self.held.land.drawing
    }

    /// Adds the change of the soil to tiles that the host has changed.
    fn let_soil_follow(&mut self) {
        if self.soil().is_some() {
            self.settle();
        }
    }

    /// Returns the lattice of the terrain's tiles.
    pub fn terrain(&self) -> Option<TerrainDesc> {
        self.world.set.tiles.as_ref().map(|terrain| terrain.desc)
    }

    /// Returns the keys of the terrain's tiles, by rows from the south.
    pub fn terrain_tiles(&self) -> impl Iterator<Item = TileKey> + '_ {
        self.world.set.tiles.iter().flat_map(|terrain| terrain.all().map(|(_, tile)| tile.key))
    }

    /// Returns a number that grows whenever the host or the soil changes the tiles; 0 without a lattice.
    pub fn terrain_revision(&self) -> u64 {
        self.world.set.tiles.as_ref().map_or(0, |terrain| terrain.revision)
    }

    /// Returns the water of each cell of a tile as of [`Context::state_time_s`], by rows from the south-west; holes are
    /// dry. `None` for a tile that does not exist.
    pub fn terrain_water(&self, key: TileKey) -> Option<impl ExactSizeIterator<Item = GroundCell> + '_> {
        self.held.ground.tile_water(&self.world, key)
    }

    /// Returns the water on the tiles around a place as textures for the host's own materials, up to date, with the
    /// snow where it is simulated. They cover a window of 512 x 512 cells, one texel a cell, which moves in steps of 64
    /// cells so that `center` stays within the middle 64 x 64 cells of the window. Changes since the last call are
    /// uploaded and submitted; after a move that is the whole window. Both textures stay the same objects as long as
    /// the context lives. Where no tile has ground there is neither water nor snow. A host with several cameras calls
    /// this function before it draws the picture of each camera.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if `center` is invalid; [`crate::Status::WrongOrder`] where no tile reaches
    /// into the window; [`crate::Status::DeviceLost`], or a GPU fault.
    pub fn terrain_texture(&mut self, center: DVec3) -> Result<GroundTexture> {
        let device = self.device().clone();
        self.held.ground.terrain_texture(&device, &self.world, center)
    }

    /// Returns the terrain below or above a position; `None` where no tile has ground.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is invalid.
    pub fn terrain_at(&self, position: DVec3) -> Result<Option<TerrainPoint>> {
        self.world.frame.place_at("position", position)?;
        Ok(self.world.set.tiles.as_ref().and_then(|terrain| terrain.point_at(position)))
    }
}
