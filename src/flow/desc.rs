//! Description that the host gives of a field of wind about a place.

use glam::DVec3;

use crate::error::{Error, Result, check_range};

/// How a field is led through time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WindFieldMode {
    /// The mean wind round terrain and boxes: solved for over the first moments after the wind or an obstacle has
    /// changed, then it rests at no cost. Gusts are as strong, against the weather's, as the mean is there.
    #[default]
    Steady,
    /// The wind with gusts, the whirls that come in with it and those that obstacles shed: stepped all the time.
    Running,
}

/// Friction of terrain and boxes on air that passes along them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WindWalls {
    /// They slow it, by the weather's roughness length.
    #[default]
    Rough,
    /// It slides.
    Smooth,
}

/// A field of wind about a place, level and aligned to north: the air in a box of cells goes round the host's terrain
/// ([`Context::set_ground_grid`](crate::context::Context::set_ground_grid)) and boxes
/// ([`Context::set_shelters`](crate::context::Context::set_shelters)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindFieldDesc {
    /// The middle of the field's floor, in the host's world: no higher than the lowest ground that matters. The field
    /// moves with it by whole cells.
    pub floor_center: DVec3,
    /// Size of a cell east, north and up, m, \[0.05, 1000\], the longest at most 8 times the shortest. Default 4.
    pub cell_m: DVec3,
    /// Cells east, north and up, \[8, 4096\] each. Default 128, 128, 32.
    pub cells: [u32; 3],
    /// Default [`WindFieldMode::Steady`].
    pub mode: WindFieldMode,
    /// Default [`WindWalls::Rough`].
    pub walls: WindWalls,
    /// Memory that the field may take, bytes, \[1 MiB, 16 GiB\]. Default 1 GiB.
    pub most_bytes: u64,
}

impl Default for WindFieldDesc {
    fn default() -> Self {
        Self {
            floor_center: DVec3::ZERO,
            cell_m: DVec3::splat(4.0),
            cells: [128, 128, 32],
            mode: WindFieldMode::default(),
            walls: WindWalls::default(),
            most_bytes: 1 << 30,
        }
    }
}

/// Least and most memory that may be allowed, bytes.
const MEMORY_BYTES: [u64; 2] = [1 << 20, 16 << 30];
/// Cells may be so many times as long along one axis as along another.
const LONGEST: f64 = 8.0;

impl WindFieldDesc {
    /// Bytes of memory that a field of this size takes at most, by the arrays that it holds.
    pub fn bytes(&self) -> u64 {
        let product = |more: u64| self.cells.iter().map(|n| u64::from(*n) + more).product::<u64>();
        // Of each face with ghosts five velocities, open shares and what pushes, twice, its layer and its place in
        // lists; of each cell pressures and their equation on all grids; of each corner what queries and shaders read.
        product(5) * 3 * (9 * 4 + 1 + 12) + product(0) * (22 * 4) + product(1) * 24
    }

    /// Refuses what is no field, by name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`]; for a field that is too large it says how much memory it needs and may take.
    pub fn validate(&self) -> Result<()> {
        if !(self.floor_center.is_finite() && self.floor_center.length() <= 1e12) {
            return Err(Error::range("wind_field.floor_center_m", "finite and within 1e12 m", self.floor_center));
        }
        for i in 0..3 {
            check_range(&format!("wind_field.cell_m[{i}]"), self.cell_m[i], 0.05, 1e3, "m")?;
            check_range(&format!("wind_field.cells[{i}]"), f64::from(self.cells[i]), 8.0, 4096.0, "")?;
        }
        if self.cell_m.max_element() > LONGEST * self.cell_m.min_element() {
            let wanted = format!("no more than {LONGEST} times as long along one axis as along another");
            return Err(Error::range("wind_field.cell_m", &wanted, self.cell_m));
        }
        let [least, most] = MEMORY_BYTES.map(|b| b as f64);
        check_range("wind_field.most_bytes", self.most_bytes as f64, least, most, "bytes")?;
        let needed = self.bytes();
        if needed > self.most_bytes {
            let wanted = format!("few enough for wind_field.most_bytes, {}", self.most_bytes);
            let got = format!("{:?}, which need {needed} bytes", self.cells);
            return Err(Error::range("wind_field.cells", &wanted, got));
        }
        Ok(())
    }

    /// Whether a field of one goes over into one of the other by moving: all but the place is alike.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        Self { floor_center: other.floor_center, most_bytes: other.most_bytes, ..*self } == *other
    }
}

/// How a field stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindFieldReport {
    /// Simulation time of the field, s: the present, or up to one step before it.
    pub time_s: f64,
    /// When it last began from a steady field, s: as it was first set, after a leap of more than a minute, or far off.
    pub begun_s: f64,
    /// Length of its steps, s.
    pub step_s: f64,
    /// It is steady and rests: nothing is stepped.
    pub rests: bool,
    /// Its lowest corner, farthest to the south-west, in the host's world.
    pub corner: DVec3,
    /// Size of a cell, m, and cells east, north and up.
    pub cell_m: DVec3,
    /// Cells east, north and up.
    pub cells: [u32; 3],
    /// The largest component of the wind anywhere in it, m/s.
    pub fastest_m_s: f64,
    /// Memory that it may take, bytes ([`WindFieldDesc::bytes`]).
    pub bytes: u64,
}

/// From when on there is a field, or none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FieldChange {
    pub start_s: f64,
    pub desc: Option<WindFieldDesc>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_field_is_refused_by_name() {
        let good = WindFieldDesc::default();
        good.validate().expect("the default");
        for (bad, sentence) in [
            (WindFieldDesc { floor_center: DVec3::NAN, ..good }, "wind_field.floor_center_m must be finite"),
            (WindFieldDesc { cell_m: DVec3::new(1.0, 0.0, 1.0), ..good }, "wind_field.cell_m[1] must be in [0.05"),
            (WindFieldDesc { cell_m: DVec3::new(1.0, 9.0, 1.0), ..good }, "wind_field.cell_m must be no more than 8"),
            (WindFieldDesc { cells: [128, 7, 32], ..good }, "wind_field.cells[1] must be in [8, 4096]"),
            (WindFieldDesc { most_bytes: 0, ..good }, "wind_field.most_bytes must be in"),
            (WindFieldDesc { cells: [512, 512, 128], ..good }, "few enough for wind_field.most_bytes, 1073741824"),
        ] {
            let e = bad.validate().expect_err(sentence).to_string();
            assert!(e.contains(sentence), "{e}");
        }
        let large = WindFieldDesc { cells: [512, 512, 128], ..good };
        assert!(large.validate().expect_err("large").to_string().contains(&format!("need {} bytes", large.bytes())));
        WindFieldDesc { most_bytes: large.bytes(), ..large }.validate().expect("allowed");
    }
}
