//! Soil on the tiles of the terrain: kinds and layers, tools, queries, and the list of what has changed.

use glam::DVec3;

use crate::{
    context::Context,
    error::{Error, Result, Status},
    soil::{
        SoilBlade, SoilBooks, SoilChange, SoilKindId, SoilPoint, SoilSettings, SoilToolId, SoilToolPose,
        SoilToolReport, SoilToolShape, laws::CuttingForce,
    },
    terrain::{Terrain, TileKey},
};

/// Largest number of cells in a queried rectangle.
const MOST_CELLS: u64 = 1 << 20;
/// Returns a place of the host's world in metres east, north and up of the lattice's origin.
fn local(terrain: &Terrain, position: DVec3) -> DVec3 {
    terrain.to_enu * (position - terrain.desc.origin)
}

/// Returns a pose of the host's world in metres east, north and up of the lattice's origin.
///
/// # Errors
/// [`Status::InvalidArgument`] for an edge that is not over a tile.
fn local_pose(terrain: &Terrain, pose: &SoilToolPose) -> Result<SoilToolPose> {
    let edge = pose.edge.map(|point| local(terrain, point));
    for (i, point) in edge.iter().enumerate().filter(|(_, point)| point.is_finite() && point.length() <= 1e7) {
        let cell = (point.truncate() / terrain.desc.cell_m).round();
        if terrain.slot_at([cell.x as i32, cell.y as i32]).is_none() {
            let accepted = "over a tile of the terrain: end the tool before it leaves";
            return Err(Error::range(&format!("pose.edge[{i}]"), accepted, pose.edge[i]));
        }
    }
    let upper = pose.upper.map(|point| local(terrain, point));
    Ok(SoilToolPose { edge, upper, facing: terrain.to_enu * pose.facing, ..*pose })
}

impl Context {
    /// Sets the soil of the terrain's tiles: the kinds and layers of the ground that is dug. The tiles are then the
    /// undug ground. Soil adds what was dug and heaped, and [`Context::terrain_at`], water, snow and wind see the sum.
    /// The ground is undug at first; `None` removes the soil and everything dug. Equal settings change nothing. Soil is
    /// part of the saved state.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without a terrain in tiles, and while steps of an update remain;
    /// [`Status::InvalidArgument`] naming the field, or `terrain.cell_m` for cells of more than 4 m. Nothing changes
    /// then.
    pub fn set_soil(&mut self, settings: Option<SoilSettings>) -> Result<()> {
        self.check_advanced()?;
        self.held.soil.set(&mut self.world, settings)?;
        self.settle();
        Ok(())
    }

    /// Returns the settings of the soil; `None` without soil.
    pub fn soil(&self) -> Option<&SoilSettings> {
        self.held.soil.site().ok().map(|site| &site.desc().settings)
    }

    /// Adds a tool at its first pose, which is in the host's world. There are at most
    /// [`MAX_SOIL_TOOLS`](crate::soil::MAX_SOIL_TOOLS) tools at a time.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without soil, while steps of an update remain, or for a pose before the present;
    /// [`Status::InvalidArgument`] naming the field. Nothing changes then.
    pub fn add_soil_tool(&mut self, shape: SoilToolShape, pose: &SoilToolPose) -> Result<SoilToolId> {
        self.check_advanced()?;
        let now_s = self.world.time_s;
        let (site, terrain) = self.held.soil.site_mut(&self.world)?;
        let pose = local_pose(terrain, pose)?;
        if pose.time_s < now_s {
            let rest = format!("must be at least {now_s} s, the time of the last update, got {}", pose.time_s);
            return Err(Error::about(Status::WrongOrder, "pose.time_s", rest));
        }
        site.add_tool(shape, &pose)
    }

    /// Adds the next pose of a tool, in the host's world. Send a pose before the update that reaches its time: the tool
    /// moves evenly between its poses, and stands still at the last one. The ground then depends on the poses alone,
    /// not on the times of the updates.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without soil, while steps of an update remain, or for a time that is not after the last
    /// pose and the last update; [`Status::InvalidArgument`] naming the field, also for an edge that leaves the tiles,
    /// and for a pose more than 600 s after the last one or more than 20 m from it. Nothing changes then.
    pub fn move_soil_tool(&mut self, tool: SoilToolId, pose: &SoilToolPose) -> Result<()> {
        self.check_advanced()?;
        let now_s = self.world.time_s;
        let (site, terrain) = self.held.soil.site_mut(&self.world)?;
        let pose = local_pose(terrain, pose)?;
        site.move_standing_tool(tool, &pose, now_s)
    }

    /// Ends a tool at its last pose. The soil that it still holds then leaves with it.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without soil, while steps of an update remain, or for a tool that has ended;
    /// [`Status::InvalidArgument`] for an unknown one.
    pub fn end_soil_tool(&mut self, tool: SoilToolId) -> Result<()> {
        self.check_advanced()?;
        self.held.soil.site_mut(&self.world)?.0.end_tool(tool)
    }

    /// Returns the soil that a tool holds and the ground that it met in the last step, as of [`Context::state_time_s`].
    /// [`SoilToolReport::centre`] is in the host's world.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without soil, [`Status::InvalidArgument`] for an unknown tool.
    pub fn soil_tool(&self, tool: SoilToolId) -> Result<SoilToolReport> {
        let report = self.held.soil.site()?.report(tool)?;
        let Some(terrain) = &self.world.set.tiles else { return Ok(report) };
        Ok(SoilToolReport { centre: terrain.desc.origin + terrain.to_enu.transpose() * report.centre, ..report })
    }

    /// Returns the force on the edge of a tool that cuts as deep as it did in the last step, in the soil that it met
    /// there ([`cutting_force`](crate::soil::laws::cutting_force)). Closed form, for the physics of the host's machine.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without soil, [`Status::InvalidArgument`] for an unknown tool, or naming a field of
    /// `blade`.
    pub fn soil_resistance(&self, tool: SoilToolId, blade: &SoilBlade) -> Result<CuttingForce> {
        self.held.soil.site()?.resistance(tool, blade)
    }

    /// Drops loose soil that the host brings onto a place, at once. Returns whether there is ground to take it.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without soil or while steps of an update remain; [`Status::InvalidArgument`] naming the
    /// parameter: a place, a known kind, a mass in \[0, 1e6\] kg, and loose soil at most 1000 m deep.
    pub fn bring_soil(&mut self, place: DVec3, kind: SoilKindId, mass_kg: f64) -> Result<bool> {
        self.check_advanced()?;
        let (site, terrain) = self.held.soil.site_mut(&self.world)?;
        let lands = site.bring(local(terrain, place), kind, mass_kg, terrain)?;
        self.settle();
        Ok(lands)
    }

    /// Returns the ground at a place; `None` where there is none. [`SoilPoint::revision`] is the value of
    /// [`Context::terrain_revision`] at the last change near the place.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without soil, [`Status::InvalidArgument`] for an invalid place.
    pub fn soil_at(&self, place: DVec3) -> Result<Option<SoilPoint>> {
        let site = self.held.soil.site()?;
        self.world.frame.place_at("place", place)?;
        let Some(terrain) = self.world.set.tiles.as_deref() else { return Ok(None) };
        let cell = (local(terrain, place).truncate() / terrain.desc.cell_m).round();
        if cell.abs().max_element() > f64::from(1 << 30) {
            return Ok(None);
        }
        let cell = [cell.x as i32, cell.y as i32];
        Ok(self.held.soil.point(site, cell, terrain))
    }

    /// Returns the rectangles in which soil has changed heights after a revision of the terrain
    /// ([`Context::terrain_revision`]), by rows from the south; 0 returns all. A host with its own physics or network
    /// follows the ground with this list. It must not set these heights as tiles, which are the undug ground.
    pub fn soil_changes(&self, since: u64) -> impl Iterator<Item = SoilChange> + '_ {
        let side = self.terrain().map_or(1, |terrain| terrain.tile_cells);
        self.held.soil.changes_since(since, side)
    }

    /// Returns the ground of a rectangle of a tile's cells, by rows from the south-west; `None` for holes.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without soil; [`Status::InvalidArgument`] naming the parameter, for the key of no tile,
    /// or for more than 2^20 cells.
    pub fn soil_cells(
        &self,
        tile: TileKey,
        first: [u32; 2],
        size: [u32; 2],
    ) -> Result<impl ExactSizeIterator<Item = Option<SoilPoint>> + '_> {
        let site = self.held.soil.site()?;
        let terrain = self.world.set.tiles.as_deref().filter(|terrain| terrain.slot(tile).is_some());
        let got = || format!("({}, {})", tile.east, tile.north);
        let terrain = terrain.ok_or_else(|| Error::range("tile", "the key of a tile that was set", got()))?;
        for i in [0, 1] {
            if size[i] == 0 || u64::from(first[i]) + u64::from(size[i]) > u64::from(terrain.desc.tile_cells) {
                let accepted = format!("at least 1, and with first[{i}] at most {}", terrain.desc.tile_cells);
                return Err(Error::range(&format!("size[{i}]"), &accepted, size[i]));
            }
        }
        if u64::from(size[0]) * u64::from(size[1]) > MOST_CELLS {
            return Err(Error::range("size", &format!("at most {MOST_CELLS} cells"), format!("{size:?}")));
        }
        let low = terrain.rect(tile).low;
        Ok((0..(size[0] * size[1]) as usize).map(move |i| {
            let at = [first[0] + i as u32 % size[0], first[1] + i as u32 / size[0]];
            self.held.soil.point(site, [0, 1].map(|axis| low[axis] + at[axis] as i32), terrain)
        }))
    }

    /// Returns the balance of the soil's mass, in whole micrograms; `None` without soil.
    pub fn soil_books(&self) -> Option<SoilBooks> {
        self.held.soil.site().ok().map(|site| site.books())
    }
}
