//! Actions of the host on lying snow along a path: clearing it (by ploughs or shovels), and pressing tracks (by
//! wheels).

use glam::{DVec2, DVec3};

use super::{
    column::{Column, UNITS},
    field::SnowField,
    held::{HeldSnow, LyingSnowModel},
    site::Site,
};
use crate::{
    error::{Error, Result, Status, check_range},
    world::World,
};

/// Largest number of points of a strip.
pub const MAX_STRIP_POINTS: usize = 1024;
/// Density to which wheels press snow, kg/m^3: packed roads have 450 to 600.
const PRESSED_KG_M3: f64 = 500.0;
/// Number of samples along each side of a cell from which the share under a strip is computed.
const SAMPLES: usize = 4;

/// Strip of ground: a path with a width. Two points and a width make a rectangle.
#[derive(Clone, Debug, PartialEq)]
pub struct SnowStrip {
    /// Centre line in the host's world, m; 2 to 1024 points, each finite and within 1e12 m of the world's origin.
    /// Heights do not matter.
    pub points: Vec<DVec3>,
    /// Full width, m, \[0.01, 1000\].
    pub width_m: f64,
}

impl SnowStrip {
    /// Checks the strip; the error names the field at fault.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        check_range("strip.width_m", self.width_m, 0.01, 1000.0, "m")?;
        if !(2..=MAX_STRIP_POINTS).contains(&self.points.len()) {
            return Err(Error::range("strip.points.len", "in [2, 1024]", self.points.len()));
        }
        match self.points.iter().position(|p| !(p.is_finite() && p.length() <= 1e12)) {
            None => Ok(()),
            Some(i) => Err(Error::range(&format!("strip.points[{i}]"), "finite and within 1e12 m", self.points[i])),
        }
    }
}

/// Returns whether a point lies on a path of this half width, all in m east and north. The path ends at right angles to
/// its direction; its bends are round.
fn lies_on(path: &[DVec2], half_m: f64, p: DVec2) -> bool {
    let along = path.windows(2).any(|ends| {
        let (way, from) = (ends[1] - ends[0], p - ends[0]);
        let t = way.dot(from) / way.length_squared().max(1e-12);
        (0.0..=1.0).contains(&t) && (from - way * t).length() <= half_m
    });
    along || path[1..path.len() - 1].iter().any(|bend| p.distance(*bend) <= half_m)
}

/// Applies `act` to each column under a strip, with the share of the cell that the strip covers. Returns the sum of the
/// results of `act`. Patches with such columns get this revision.
fn each_under(
    (site, field): (&Site, &mut SnowField),
    strip: &SnowStrip,
    revision: u64,
    mut act: impl FnMut(&mut Column, f64) -> i64,
) -> i64 {
    let half_m = 0.5 * strip.width_m;
    let path: Vec<DVec2> = strip.points.iter().map(|p| site.local(*p).truncate()).collect();
    let low = path.iter().fold(DVec2::INFINITY, |low, p| low.min(*p)) - half_m;
    let high = path.iter().fold(DVec2::NEG_INFINITY, |high, p| high.max(*p)) + half_m;
    let (size, cell_m) = (field.size, field.cell_m);
    let offset = |i: usize| (i as f64 + 0.5) / SAMPLES as f64 - 0.5;
    let mut sum = 0;
    for patch in field.patches.iter_mut().filter(|patch| !patch.is_bare()) {
        let corner = [0, 1].map(|i| f64::from(patch.key[i]) * size[i] as f64);
        // Rows or columns of the patch that the bounding box of the strip touches.
        let span = |i: usize| {
            let low = (low[i] / cell_m - 0.5).floor() - corner[i];
            let high = (high[i] / cell_m + 0.5).ceil() - corner[i] + 1.0;
            low.max(0.0) as usize..high.clamp(0.0, size[i] as f64) as usize
        };
        let mut acted = false;
        for (row, column) in span(1).flat_map(|row| span(0).map(move |column| (row, column))) {
            let middle = DVec2::new(corner[0] + column as f64, corner[1] + row as f64);
            let samples = (0..SAMPLES * SAMPLES)
                .map(|i| (middle + DVec2::new(offset(i % SAMPLES), offset(i / SAMPLES))) * cell_m)
                .filter(|p| lies_on(&path, half_m, *p));
            let covered = samples.count() as f64 / (SAMPLES * SAMPLES) as f64;
            if covered > 0.0 {
                sum += act(&mut patch.columns[row * size[0] + column], covered);
                acted = true;
            }
        }
        if acted {
            patch.changed(revision);
        }
    }
    sum
}

impl HeldSnow {
    /// Checks the strip and returns the terrain's snow for a change by the host.
    fn field_for_change(&mut self, world: &World, strip: &SnowStrip) -> Result<(&Site, &mut SnowField)> {
        strip.validate()?;
        let wanted = "lying snow is changed on the host's terrain, where WK_LYING_SNOW_SIMULATED leads it";
        let has_terrain = world.set.terrain.is_some() || world.set.tiles.is_some();
        if self.model == LyingSnowModel::Reported || !has_terrain {
            return Err(Error::new(Status::WrongOrder, wanted));
        }
        self.be_there(world)?;
        self.field_mut().ok_or_else(|| Error::new(Status::WrongOrder, wanted))
    }

    /// Removes the snow of a strip, except the lowest `left_m`, m, \[0, 100\]. Returns the removed mass, kg. Hosts call
    /// it as [`Context::take_snow`](crate::context::Context::take_snow).
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the field; [`Status::WrongOrder`] without a terrain or simulated snow.
    pub fn take(&mut self, world: &World, strip: &SnowStrip, left_m: f64) -> Result<f64> {
        check_range("left_m", left_m, 0.0, 100.0, "m")?;
        let revision = self.next_revision();
        let (site, field) = self.field_for_change(world, strip)?;
        let area = field.cell_m * field.cell_m;
        let taken = each_under((site, field), strip, revision, |column, covered| {
            let depth = column.depth;
            let over = ((column.depth_m() - left_m).max(0.0) * UNITS * covered) as i64;
            if over > 0 { column.take(over.min(depth), depth).mass() } else { 0 }
        });
        field.books.taken += taken;
        self.changed();
        Ok(taken as f64 / UNITS * area)
    }

    /// Compacts the snow of a strip to `PRESSED_KG_M3` where it is less dense. Hosts call it as
    /// [`Context::press_snow`](crate::context::Context::press_snow).
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the field; [`Status::WrongOrder`] without a terrain or simulated snow.
    pub fn press(&mut self, world: &World, strip: &SnowStrip) -> Result<()> {
        let revision = self.next_revision();
        let (site, field) = self.field_for_change(world, strip)?;
        each_under((site, field), strip, revision, |column, covered| {
            column.press(PRESSED_KG_M3, covered);
            0
        });
        self.changed();
        Ok(())
    }
}
