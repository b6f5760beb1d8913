//! Description by which a host asks for a wind field around a place.

use glam::DVec3;

use super::{advect::Scheme, multigrid, pressure::PressureMethod};
use crate::error::{Error, Result, check_range};

/// Mode in which a field advances through time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WindFieldMode {
    /// Mean wind around terrain and boxes. It is solved for after the weather's mean wind or an obstacle has changed.
    /// Then the field rests at no cost. Gusts at a place are those of the weather, times the ratio of the field's mean
    /// wind there to the weather's mean wind.
    #[default]
    Steady,
    /// Wind with gusts, the eddies of the inflow, and those that obstacles shed. The field is stepped all the time.
    Running,
}

/// Friction of terrain and boxes on the air that passes along them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WindWalls {
    /// Friction by the weather's roughness length.
    #[default]
    Rough,
    /// No friction: air slides along terrain and boxes.
    Smooth,
}

/// Wind field around a place, level and aligned to north: a box of cells in which air flows around the host's terrain
/// ([`Context::set_ground_grid`](crate::context::Context::set_ground_grid), or without a grid the tiles of
/// [`Context::set_terrain_tile`](crate::context::Context::set_terrain_tile)) and boxes
/// ([`Context::set_shelters`](crate::context::Context::set_shelters)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindFieldDesc {
    /// Centre of the field's floor in the host's world, within 1e12 m of the origin, and not higher than the lowest
    /// ground that matters. The field moves with it by whole cells.
    pub floor_center: DVec3,
    /// Size of a cell east, north and up, m, \[0.05, 1000\], the longest at most 8 times the shortest. Default 4.
    pub cell_m: DVec3,
    /// Numbers of cells east, north and up, \[8, 4096\] each. Default 128, 128, 32.
    pub cells: [u32; 3],
    /// Mode of the field. Default [`WindFieldMode::Steady`].
    pub mode: WindFieldMode,
    /// Friction of walls. Default [`WindWalls::Rough`].
    pub walls: WindWalls,
    /// Scheme that carries velocity. Default [`Scheme::Reflection`].
    pub scheme: Scheme,
    /// Method that solves for the pressure. Default at most 50 V-cycles.
    pub pressure: PressureMethod,
    /// Limit of the memory of the field, bytes, \[1 MiB, 16 GiB\]. Default 1 GiB.
    pub most_bytes: u64,
}

impl Default for WindFieldDesc {
    /// Returns a field of 128 x 128 x 32 cells of 4 m around the origin.
    fn default() -> Self {
        Self {
            floor_center: DVec3::ZERO,
            cell_m: DVec3::splat(4.0),
            cells: [128, 128, 32],
            mode: WindFieldMode::default(),
            walls: WindWalls::default(),
            scheme: Scheme::default(),
            pressure: PressureMethod::default(),
            most_bytes: 1 << 30,
        }
    }
}

/// Range of the memory limit, bytes.
const MEMORY_BYTES: [u64; 2] = [1 << 20, 16 << 30];
/// Largest ratio of a cell's sides.
const LONGEST: f64 = 8.0;

impl WindFieldDesc {
    /// Returns the memory that a field of this size needs at most, bytes: the sum of its arrays.
    pub fn bytes(&self) -> u64 {
        let product = |more: u64| self.cells.iter().map(|n| u64::from(*n) + more).product::<u64>();
        // For each face with ghosts: five velocities; open shares and pushing velocities, twice; its layer inside
        // obstacles, and its position in lists of faces; MacCormack's bounds. For each cell: potentials, divergence,
        // correction, and whether it has air. For each corner: the values that queries and shaders read.
        let bounds = if self.scheme == Scheme::MacCormack { 8 } else { 0 };
        let faces = product(5) * 3 * (9 * 4 + 1 + 12 + bounds);
        let equation = 4 * multigrid::values(self.cells, self.cell_m.as_vec3());
        faces + product(0) * (4 * 4 + 1) + equation + product(1) * 24
    }

    /// Checks the description; the error names the parameter at fault.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`]. For a field that is too large, the error says how much memory it needs and
    /// how much is allowed.
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
        self.pressure.check("wind_field.pressure")?;
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

    /// Whether a field of this description only has to move to become a field of the description `other`: both are
    /// equal but for the place and the memory limit.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        Self { floor_center: other.floor_center, most_bytes: other.most_bytes, ..*self } == *other
    }
}

/// State of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindFieldReport {
    /// Simulation time of the field, s: the present, or up to one step before it.
    pub time_s: f64,
    /// Simulation time of the last start, s. A start sets the whole field to the steady flow of the mean wind. The
    /// field starts when it is set, after a change of its description other than of its place and memory limit, after a
    /// leap of time of more than a minute, and after a move of half its size or more along an axis (in a curved world
    /// also of about 10 km).
    pub begun_s: f64,
    /// Length of the field's steps, s.
    pub step_s: f64,
    /// Whether the field is steady and rests: nothing is stepped.
    pub rests: bool,
    /// Lowest corner, farthest to the south-west, in the host's world.
    pub corner: DVec3,
    /// Size of a cell, m.
    pub cell_m: DVec3,
    /// Cells east, north and up.
    pub cells: [u32; 3],
    /// Largest component of the wind anywhere in the field, m/s.
    pub fastest_m_s: f64,
    /// Memory that the field may take, bytes ([`WindFieldDesc::bytes`]).
    pub bytes: u64,
}

/// Change at a time: from then on there is a field of this description, or none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FieldChange {
    /// Simulation time of the change, s.
    pub start_s: f64,
    /// Description from then on; `None` for no field.
    pub desc: Option<WindFieldDesc>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_fields_are_refused_by_name() {
        let good = WindFieldDesc::default();
        good.validate().expect("the default");
        for (bad, sentence) in [
            (WindFieldDesc { floor_center: DVec3::NAN, ..good }, "wind_field.floor_center_m must be finite"),
            (WindFieldDesc { cell_m: DVec3::new(1.0, 0.0, 1.0), ..good }, "wind_field.cell_m[1] must be in [0.05"),
            (WindFieldDesc { cell_m: DVec3::new(1.0, 9.0, 1.0), ..good }, "wind_field.cell_m must be no more than 8"),
            (WindFieldDesc { cells: [128, 7, 32], ..good }, "wind_field.cells[1] must be in [8, 4096]"),
            (
                WindFieldDesc { pressure: PressureMethod::Multigrid { max_cycles: 0 }, ..good },
                "wind_field.pressure.max_cycles must be in [1, 1000]",
            ),
            (
                WindFieldDesc { pressure: PressureMethod::Sor { relaxation: [1.7, 2.0], max_iterations: 5 }, ..good },
                "wind_field.pressure.relaxation[1] must be in (0, 2)",
            ),
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
