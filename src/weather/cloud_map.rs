//! Local cloud cover: a map that the host lays over the ground.

use glam::DVec2;

use super::{Conditions, MAX_CLOUD_LAYERS};
use crate::error::{Error, Result, check_range};

/// Maximum number of cells of a map east and north.
pub const MAX_CLOUD_MAP_CELLS: u32 = 128;

/// Factors, 0 to 1, by which the covers of the weather's layers are multiplied over each part of the ground. For a
/// layer with the cover 1, the map gives the cover itself.
///
/// The map does not move over the ground, because a scenario needs a storm or a clearing in a known place. Clouds move
/// through it with their wind, and form and dissolve by its values. The map is level and aligned to north. Values are
/// interpolated between the centres of cells, and constant beyond the outermost centres.
#[derive(Clone, Debug, PartialEq)]
pub struct CloudMap {
    /// Centre of the south-western cell, m east and north of the world's origin, each within 1e7.
    pub first_m: [f64; 2],
    /// Side of a cell, m, \[100, 50 000\].
    pub cell_m: f64,
    /// Numbers of cells east and north, 1 to [`MAX_CLOUD_MAP_CELLS`].
    pub cells: [u32; 2],
    /// Lowest and highest base of the layers that follow the map, m above the station, each in \[-1000, 20 000\], the
    /// second not below the first.
    pub base_m: [f64; 2],
    /// Value of each cell, \[0, 1\], from west to east; rows from south to north.
    pub cover: Vec<f32>,
}

impl CloudMap {
    /// Checks that every field is in range and that there is one value for each cell.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        for (i, v) in self.first_m.into_iter().enumerate() {
            check_range(&format!("cloud_map.first_m[{i}]"), v, -1e7, 1e7, "m")?;
        }
        check_range("cloud_map.cell_m", self.cell_m, 100.0, 5e4, "m")?;
        for (i, n) in self.cells.into_iter().enumerate() {
            check_range(&format!("cloud_map.cells[{i}]"), f64::from(n), 1.0, f64::from(MAX_CLOUD_MAP_CELLS), "")?;
        }
        check_range("cloud_map.base_m[0]", self.base_m[0], -1000.0, 20_000.0, "m")?;
        check_range("cloud_map.base_m[1]", self.base_m[1], self.base_m[0], 20_000.0, "m")?;
        let count = self.cells.iter().map(|n| *n as usize).product::<usize>();
        if self.cover.len() != count {
            return Err(Error::range("cloud_map.cover.len", &format!("{count}, one a cell"), self.cover.len()));
        }
        match self.cover.iter().position(|v| !(0.0..=1.0).contains(v)) {
            None => Ok(()),
            Some(i) => check_range(&format!("cloud_map.cover[{i}]"), f64::from(self.cover[i]), 0.0, 1.0, ""),
        }
    }

    /// Whether a layer with this base above the station follows the map.
    pub fn is_of(&self, base_m: f64) -> bool {
        (self.base_m[0]..=self.base_m[1]).contains(&base_m)
    }

    /// Returns the map's value at a place, m east and north of the world's origin, interpolated between cells.
    pub fn at(&self, place_m: DVec2) -> f64 {
        let last = DVec2::new(f64::from(self.cells[0] - 1), f64::from(self.cells[1] - 1));
        let cell = ((place_m - DVec2::from_array(self.first_m)) / self.cell_m).clamp(DVec2::ZERO, last);
        let low = cell.floor().min((last - 1.0).max(DVec2::ZERO));
        let part = cell - low;
        let at = |east: f64, north: f64| {
            let [x, y] = [(low.x + east).min(last.x), (low.y + north).min(last.y)];
            f64::from(self.cover[y as usize * self.cells[0] as usize + x as usize])
        };
        let south = at(0.0, 0.0) * (1.0 - part.x) + at(1.0, 0.0) * part.x;
        let north = at(0.0, 1.0) * (1.0 - part.x) + at(1.0, 1.0) * part.x;
        south * (1.0 - part.y) + north * part.y
    }
}

impl Conditions {
    /// Returns the weather with the covers of its layers at a place under a map.
    pub(crate) fn under_map(mut self, map: &CloudMap, place_m: DVec2) -> Self {
        let left = map.at(place_m);
        let hidden = 1.0 - super::conditions::clear_between(&self.clouds);
        for slab in self.clouds.iter_mut().take(MAX_CLOUD_LAYERS).filter(|slab| map.is_of(slab.base_m)) {
            slab.cover *= left;
        }
        let still_hidden = 1.0 - super::conditions::clear_between(&self.clouds);
        // While one layer replaces another, the layers hide more of the sky than independent ones would. The excess
        // stays in proportion to the cover that is left.
        if hidden > 0.0 {
            self.clear_sky = 1.0 - (1.0 - self.clear_sky) * (still_hidden / hidden);
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::weather::{CloudKind, CloudLayer, Weather, derive};

    fn map() -> CloudMap {
        let cover = vec![0.0, 0.5, 1.0, 0.25, 0.0, 1.0];
        CloudMap { first_m: [1000.0, -500.0], cell_m: 2000.0, cells: [3, 2], base_m: [0.0, 20e3], cover }
    }

    #[test]
    fn a_map_is_read_between_middles_and_held_beyond() {
        let at = |x: f64, y: f64| map().at(DVec2::new(x, y));
        assert_eq!([at(1000.0, -500.0), at(5000.0, 1500.0), at(3000.0, -500.0)], [0.0, 1.0, 0.5]);
        assert_eq!(at(2000.0, 500.0), 0.25 * (0.0 + 0.5 + 0.25 + 0.0));
        assert_eq!([at(-1e6, -1e6), at(1e6, 1e6), at(5000.0, -9e5)], [0.0, 1.0, 1.0]);
        let one = CloudMap { cells: [1, 1], cover: vec![0.75], ..map() };
        one.validate().unwrap();
        assert_eq!(one.at(DVec2::new(3.0, 4.0)), 0.75);
    }

    #[test]
    fn bad_maps_are_refused_by_name() {
        map().validate().unwrap();
        let refused = |change: fn(&mut CloudMap), name: &str| {
            let mut bad = map();
            change(&mut bad);
            let e = bad.validate().unwrap_err().to_string();
            assert!(e.starts_with(name), "{e}");
        };
        refused(|m| m.first_m[1] = f64::NAN, "cloud_map.first_m[1] must be in");
        refused(|m| m.cell_m = 50.0, "cloud_map.cell_m must be in [100, 50000] m");
        refused(|m| m.cells = [0, 2], "cloud_map.cells[0] must be in [1, 128]");
        refused(|m| m.cells = [3, 129], "cloud_map.cells[1] must be in [1, 128]");
        refused(|m| m.base_m = [500.0, 400.0], "cloud_map.base_m[1] must be in [500, 20000] m");
        refused(|m| m.cover.push(0.5), "cloud_map.cover.len must be 6, one a cell");
        refused(|m| m.cover[4] = f32::NAN, "cloud_map.cover[4] must be in [0, 1]");
        refused(|m| m.cover[5] = 1.5, "cloud_map.cover[5] must be in [0, 1]");
    }

    #[test]
    fn a_place_under_a_map_has_the_light_of_its_cover() {
        let clouds =
            vec![CloudLayer::of(CloudKind::Stratus, 1.0, 500.0), CloudLayer::of(CloudKind::Cirrus, 0.5, 9000.0)];
        let c = derive(&Weather { clouds, ..Weather::default() }).unwrap();
        let low = CloudMap { base_m: [0.0, 2000.0], ..map() };
        let covers = |x: f64| {
            let c = c.under_map(&low, DVec2::new(x, -500.0));
            (c.cloud_slabs().map(|s| s.cover).collect::<Vec<_>>(), c.cloud_cover())
        };
        assert_eq!(covers(1000.0), (vec![0.5], 0.5));
        assert_eq!(covers(5000.0), (vec![1.0, 0.5], 1.0));
        assert_eq!(covers(3000.0), (vec![0.5, 0.5], 0.75));
    }
}
