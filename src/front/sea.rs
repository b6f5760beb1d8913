//! The sea: its settings and regions, and queries of its surface and statistics.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::{
    context::Context,
    error::{Error, Result, check_range},
    sea::{SeaHull, SeaPoint, SeaRegion, SeaSettings, SeaStatistics, SeaSurface, Wake},
    terrain::SurfaceClass,
};

/// Longest wave that a query may leave out, m.
const MOST_SHORTEST_M: f64 = 1e4;

/// The sea of a context at a time, for many places.
pub(crate) struct SeaQuery<'a> {
    context: &'a Context,
    surface: Arc<SeaSurface>,
    wakes: Arc<Vec<Wake>>,
    time_s: f64,
    shortest_wave_m: f64,
}

impl SeaQuery<'_> {
    /// Returns the sea at a position.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if `position` is not a place.
    pub fn at(&self, position: DVec3) -> Result<SeaPoint> {
        let world = &self.context.world;
        let local = world.frame.place_at("position", position)?;
        let Some(water) = self.context.held.sea.water_at(position, self.time_s) else {
            return Ok(SeaPoint::dry(position));
        };
        let map_m = DVec2::from_array(world.map_place(position, &local));
        let mut point = self.surface.within(&water, map_m, self.shortest_wave_m);
        point.add_wakes(&self.wakes, map_m, self.shortest_wave_m);
        if let Some(bed) = self.context.sea_bed(position, local.place.altitude_m) {
            let depth_m = point.height_m - bed.altitude_m;
            if depth_m > 0.0 {
                point.depth_m = depth_m;
            } else if !bed.is_water {
                return Ok(SeaPoint::dry(position));
            }
        }
        let up = local.world_to_enu.transpose().z_axis;
        point.surface = position + up * (point.height_m - local.place.altitude_m);
        Ok(point)
    }
}

/// The host's terrain under a place.
struct SeaBed {
    altitude_m: f64,
    /// Whether the host's terrain is water there. Its heights then need not be those of the sea bed.
    is_water: bool,
}

impl Context {
    /// Sets the sea; `None` removes it. Part of the saved state. Set it before the first update, because its fetch
    /// applies to all weather that the timeline still knows.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_sea(&mut self, settings: Option<SeaSettings>) -> Result<()> {
        self.held.sea.set(settings, self.world.seed)
    }

    /// Returns the settings of the sea; `None` without a sea.
    pub fn sea(&self) -> Option<&SeaSettings> {
        self.held.sea.settings()
    }

    /// Replaces the regions of water and of dry places; an empty list removes all. Part of the saved state. Regions
    /// that move at a constant velocity move by themselves; set them again when the velocity changes.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for more than [`MAX_SEA_REGIONS`](crate::sea::MAX_SEA_REGIONS), or naming the
    /// region and its field; nothing changes then.
    pub fn set_sea_regions(&mut self, regions: Vec<SeaRegion>) -> Result<()> {
        self.held.sea.set_regions(&self.world, regions)
    }

    /// Returns the regions of water and of dry places, as they were set.
    pub fn sea_regions(&self) -> impl ExactSizeIterator<Item = &SeaRegion> {
        self.held.sea.regions()
    }

    /// Replaces the hulls that raise wakes; an empty list removes all. A hull goes on at its speed and rate of turn;
    /// set the hulls again when these change, in every frame if you like. A hull whose number was in the list before
    /// continues its track, unless it is more than two of its lengths away from that track. The waves of a hull that is
    /// no longer in the list fade with time. Part of the saved state.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for more than [`MAX_SEA_HULLS`](crate::sea::MAX_SEA_HULLS), for two of the
    /// same number, or naming the hull and its field; nothing changes then.
    pub fn set_sea_hulls(&mut self, hulls: &[SeaHull]) -> Result<()> {
        self.held.sea.set_hulls(&self.world, hulls)
    }

    /// Returns the hulls that raise wakes, as they were set.
    pub fn sea_hulls(&self) -> impl Iterator<Item = &SeaHull> {
        self.held.sea.hulls()
    }

    /// Writes the sea at each of `positions` and at simulation time `time_s`, past or future, into `points`. The height
    /// of a position has no influence. There is no water where the terrain's tiles lie above the surface, except in
    /// cells of [`SurfaceClass::Water`]. In dry regions a point has no water, and its numbers are those of the water
    /// around. Waves shorter than `shortest_wave_m`, m, [0, 1e4], are left out, and so are the sea's tiles that hold
    /// only such waves; 0 leaves out none. [`SeaPoint::height_error_m`] says by how much the height may be off.
    ///
    /// The first query of a time sums the short waves (some milliseconds); the sums of the last two times are kept.
    /// Nothing is allocated after the first queries.
    ///
    /// # Errors
    /// [`crate::Status::WrongOrder`] without a sea; [`crate::Status::InvalidArgument`] if a position is not a place,
    /// `shortest_wave_m` is out of range or `points` is of another length; for times as [`Context::conditions_at`].
    /// `points` stays as it was then.
    pub fn sea_at(
        &self,
        positions: &[DVec3],
        time_s: f64,
        shortest_wave_m: f64,
        points: &mut [SeaPoint],
    ) -> Result<()> {
        if points.len() != positions.len() {
            let accepted = format!("as long as positions, {}", positions.len());
            return Err(Error::range("points", &accepted, points.len()));
        }
        for (i, position) in positions.iter().enumerate() {
            let named = |e: Error| e.renamed("position", &format!("positions[{i}]"));
            self.world.frame.place_at("position", *position).map_err(named)?;
        }
        let query = self.sea_query(time_s, shortest_wave_m)?;
        for (position, point) in positions.iter().zip(points) {
            *point = query.at(*position)?;
        }
        Ok(())
    }

    /// Returns the sea at a time, for queries of many places.
    ///
    /// # Errors
    /// As [`Context::sea_at`].
    pub(crate) fn sea_query(&self, time_s: f64, shortest_wave_m: f64) -> Result<SeaQuery<'_>> {
        check_range("shortest_wave_m", shortest_wave_m, 0.0, MOST_SHORTEST_M, "m")?;
        let surface = self.held.sea.surface(&self.world, time_s)?;
        let wakes = self.held.sea.wakes(time_s);
        Ok(SeaQuery { context: self, surface, wakes, time_s, shortest_wave_m })
    }

    /// Checks a position of a query.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if `position` is not a place.
    pub(crate) fn check_sea_position(&self, position: DVec3) -> Result<()> {
        self.world.frame.place_at("position", position).map(|_| ())
    }

    /// Returns the ground of the terrain's tiles under a position, whose altitude is `altitude_m`; `None` where no tile
    /// has ground.
    fn sea_bed(&self, position: DVec3, altitude_m: f64) -> Option<SeaBed> {
        let terrain = self.world.set.tiles.as_ref()?;
        let found = terrain.point_at(position)?;
        let (_, above_origin_m) = terrain.cells_at(position);
        let is_water = found.surface_class == SurfaceClass::Water;
        Some(SeaBed { altitude_m: altitude_m - above_origin_m + found.height_m, is_water })
    }

    /// Returns the statistics of the sea at simulation time `time_s`: heights, period, direction, slopes, whitecaps.
    ///
    /// # Errors
    /// [`crate::Status::WrongOrder`] without a sea; for times as [`Context::conditions_at`].
    pub fn sea_statistics(&self, time_s: f64) -> Result<SeaStatistics> {
        self.held.sea.statistics(&self.world, time_s)
    }
}
