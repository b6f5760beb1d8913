//! Ground: the host's terrain as a grid, the water on it, and its material.

use glam::DVec3;

use crate::{
    context::Context,
    error::Result,
    ground::{GroundAt, GroundCell, GroundGrid, GroundTexture, GroundWater, Hollows, SurfaceClass},
};

impl Context {
    /// Sets the host's terrain as one grid, on which wetness and puddles are computed cell by cell, in place of tiles.
    /// `None` removes the grid, but no tiles; without either the ground is level everywhere. If the heights are those
    /// of the present grid, it keeps its water. With
    /// [`GroundModel::Simulated`](crate::ground::GroundModel::Simulated) each cell has a state, which starts as wet as
    /// the level ground, and which [`Context::save`] keeps together with the heights. Otherwise the weather's wetness
    /// is spread over the terrain's hollows. Takes some tenths of a second for the largest grids.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_ground_grid(&mut self, grid: Option<GroundGrid>) -> Result<()> {
        let is_set = grid.is_some();
        self.held.ground.set_grid(&self.world, grid)?;
        self.world.set.terrain = self.held.ground.heights();
        if is_set {
            self.held.ground.set_terrain(&mut self.world, None)?;
        }
        self.held.snowpack.ground_replaced(&self.world);
        self.settle();
        Ok(())
    }

    /// Returns the host's terrain, if it is one grid.
    pub fn ground_grid(&self) -> Option<&GroundGrid> {
        self.held.ground.grid()
    }

    /// Returns the present water of each cell of the host's terrain, in the order of its heights; `None` without a
    /// grid.
    pub fn ground_cells(&self) -> Option<impl ExactSizeIterator<Item = GroundCell> + '_> {
        self.held.ground.cells()
    }

    /// Returns a number that changes whenever the water of the cells has changed.
    pub fn ground_revision(&self) -> u64 {
        self.held.ground.revision
    }

    /// Sets the material of ground that has none from the host's grid, tiles or image: [`SurfaceClass::Unspecified`],
    /// the default, is natural ground. Part of the saved state.
    pub fn set_default_surface_class(&mut self, class: SurfaceClass) {
        self.held.ground.surface_class = class;
        self.held.land.surface_class = class;
    }

    /// Returns the material of ground that has none from the host's grid, tiles or image.
    pub fn default_surface_class(&self) -> SurfaceClass {
        self.held.ground.surface_class
    }

    /// Returns the simulated water on level, open ground at [`Context::state_time_s`]; `None` if it is not simulated
    /// ([`GroundModel::Reported`](crate::ground::GroundModel::Reported)).
    pub fn ground_water(&self) -> Option<GroundWater> {
        self.held.ground.water(&self.world)
    }

    /// Returns the water on the ground at `position` as of [`Context::state_time_s`]. On the host's terrain, a grid
    /// ([`Context::set_ground_grid`]) or tiles ([`Context::set_terrain`]), and up to 3 m above the terrain, this is the
    /// water of its cells. Elsewhere it follows the hollows that Welkin draws; the host's own ground may have others.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is invalid.
    pub fn ground_at(&self, position: DVec3) -> Result<GroundAt> {
        self.held.ground.at(&self.world, position)
    }

    /// Returns the water on the host's grid as a texture for the host's own materials, up to date. Changes since the
    /// last call, which come at most every 10 s of simulation time, are uploaded and submitted. The texture stays the
    /// same object until another grid is set or loaded; it is then released at the next call of this function or of a
    /// view.
    ///
    /// # Errors
    /// [`crate::Status::WrongOrder`] without a grid, [`crate::Status::DeviceLost`], or a GPU fault.
    pub fn ground_texture(&mut self) -> Result<GroundTexture> {
        let device = self.device().clone();
        self.held.ground.texture(&device, self.world.snow.as_deref())
    }

    /// Returns the hollows of the ground, in which water stands.
    pub fn hollows(&self) -> &Hollows {
        &self.held.ground.hollows
    }
}
