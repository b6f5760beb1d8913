//! The ground by its name: the host's terrain, the water on it, what it is made of.

use glam::DVec3;

use crate::{
    context::Context,
    error::Result,
    ground::{GroundAt, GroundCell, GroundGrid, GroundTexture, GroundWater, Hollows, SurfaceClass},
};

impl Context {
    /// The host's terrain as one grid, over which wetness and puddles are found cell by cell, in place of tiles; `None`
    /// leaves level ground everywhere. The grid whose heights are set already keeps its water. With
    /// [`GroundModel::Simulated`](crate::ground::GroundModel::Simulated) each cell has a state, which begins as the
    /// ground has it and which [`Context::save`] keeps together with the heights; else the weather's wetness is spread
    /// over the terrain's hollows. Takes some tenths of a second for the largest grids.
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

    /// The host's terrain.
    pub fn ground_grid(&self) -> Option<&GroundGrid> {
        self.held.ground.grid()
    }

    /// Water of each cell of the host's terrain now, in the order of its heights; `None` without one.
    pub fn ground_cells(&self) -> Option<impl ExactSizeIterator<Item = GroundCell> + '_> {
        self.held.ground.cells()
    }

    /// A number that is another whenever the water of the cells has changed.
    pub fn ground_revision(&self) -> u64 {
        self.held.ground.revision
    }

    /// Sets the material of the ground where neither the host's grid nor its image says it:
    /// [`SurfaceClass::Unspecified`], the default, is natural ground. Part of the saved state.
    pub fn set_default_surface_class(&mut self, class: SurfaceClass) {
        self.held.ground.surface_class = class;
    }

    /// Returns the material of ground of which nothing else is said.
    pub fn default_surface_class(&self) -> SurfaceClass {
        self.held.ground.surface_class
    }

    /// The simulated water on level, open ground at [`Context::state_time_s`]; `None` if it is not simulated
    /// ([`GroundModel::Reported`](crate::ground::GroundModel::Reported)).
    pub fn ground_water(&self) -> Option<GroundWater> {
        self.held.ground.water(&self.world)
    }

    /// Water on the ground at `position`, now, or while steps remain at [`Context::state_time_s`]: on the host's
    /// terrain ([`Context::set_ground_grid`]), up to 3 m above it, that of its cells; elsewhere by the hollows that are
    /// drawn, wherever the host's own ground has its own.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is no place.
    pub fn ground_at(&self, position: DVec3) -> Result<GroundAt> {
        self.held.ground.at(&self.world, position)
    }

    /// The water on the host's terrain as a texture for the host's own materials, up to date: what has changed since is
    /// uploaded and submitted, which is every 10 s of simulation time at most. It stays the same object until another
    /// grid is set or loaded; then it goes, at this function's or a view's next call.
    ///
    /// # Errors
    /// [`crate::Status::WrongOrder`] without a terrain, [`crate::Status::DeviceLost`], or a GPU fault.
    pub fn ground_texture(&mut self) -> Result<GroundTexture> {
        let device = self.device().clone();
        self.held.ground.texture(&device, self.world.snow.as_deref())
    }

    /// Hollows of the ground, in which water stands.
    pub fn hollows(&self) -> &Hollows {
        &self.held.ground.hollows
    }
}
