//! Rain areas over a grid, and bounds of groups of the grid's cells. Within such bounds the share of an area may be
//! uniform.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::{grid::CellGrid, terrain::RUN, water::Forcing};
use crate::{
    falling::{MAX_AREAS, area::Shaft},
    weather::Falling,
};

/// Rain area of the world, and its rain on a grid.
#[derive(Clone, Copy)]
pub(super) struct AreaOverGrid {
    pub shaft: Shaft,
    /// Whether the area reaches the grid anywhere.
    pub reaches: bool,
    /// Rain and drizzle of the area, mm/h; 0 if it does not reach the grid.
    pub liquid_mm_h: f64,
}

/// Uniform values of each area over a part of the grid: the area's share in the precipitation, and the share of its
/// rain that has left its cloud. `None` for an area whose values vary there.
pub(super) type Evens = [Option<(f64, f64)>; MAX_AREAS];

/// Rain areas over a grid, in the order of the world's list.
pub(super) struct AreasOverGrid {
    /// Present areas; `None` at unused places.
    pub list: [Option<AreaOverGrid>; MAX_AREAS],
    /// Shares that are uniform over the whole grid.
    pub evens: Evens,
}

impl AreasOverGrid {
    /// Returns all present areas, with those that do not reach the grid.
    pub fn all(&self) -> impl Iterator<Item = &AreaOverGrid> {
        self.list.iter().flatten()
    }

    /// Returns whether each area over the grid has a uniform value in `evens`.
    pub fn are_even(&self, evens: &Evens) -> bool {
        self.list.iter().zip(evens).all(|(over, even)| over.is_none() || even.is_some())
    }

    /// Returns whether any liquid falls on the grid.
    pub fn rain(&self, forcing: &Forcing) -> bool {
        forcing.liquid_mm_h > 0.0 || self.all().any(|o| o.liquid_mm_h > 0.0)
    }

    /// Returns whether every cell gets the same rain, apart from shelter.
    pub fn even(&self) -> bool {
        self.are_even(&self.evens)
    }
}

/// Returns rain and drizzle together, mm/h.
pub(super) fn liquid(f: &Falling) -> f64 {
    f.rain_mm_h + f.drizzle_mm_h
}

/// Bounds of some cells of a grid.
pub(super) struct CellBounds {
    /// Middle of the cells in the host's world, m.
    pub(super) middle: DVec3,
    /// Radius around the middle within which the cells lie, m.
    reach_m: f64,
    /// Lowest and highest altitude of the cells, m.
    altitudes_m: [f64; 2],
}

impl CellBounds {
    /// Computes the bounds of a range of cells. `to_enu` is the rotation from the host's axes to east, north, up at the
    /// grid's origin, and `altitude_m` the altitude there.
    pub fn new(grid: &CellGrid<'_>, (to_enu, altitude_m): (&DMat3, f64), cells: Range<usize>) -> Self {
        let ends = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let columns = grid.nodes[0] as usize;
        let (low, high) = cells.fold(ends, |(low, high), cell| {
            let height = f64::from(grid.heights_m[cell]);
            let at = DVec3::new((cell % columns) as f64 * grid.cell_m, (cell / columns) as f64 * grid.cell_m, height);
            (low.min(at), high.max(at))
        });
        Self {
            middle: grid.origin + to_enu.transpose() * (0.5 * (low + high)),
            // Adds a small margin for rounding.
            reach_m: 0.5 * (high - low).length() * 1.000_001 + 1e-6,
            altitudes_m: [low.z, high.z].map(|z| altitude_m + z),
        }
    }

    /// Returns the bounds of the whole grid, and of each run of its cells.
    pub fn whole_and_runs(grid: &CellGrid<'_>, frame: (&DMat3, f64)) -> (Self, Vec<Self>) {
        let run = |first| Self::new(grid, frame, first..(first + RUN).min(grid.len()));
        (Self::new(grid, frame, 0..grid.len()), (0..grid.len()).step_by(RUN).map(run).collect())
    }

    /// Extends the bounds so that they include `other`.
    pub fn reach_over(&mut self, other: &Self) {
        self.reach_m = self.reach_m.max((other.middle - self.middle).length() + other.reach_m);
        let [low, high] = other.altitudes_m;
        self.altitudes_m = [self.altitudes_m[0].min(low), self.altitudes_m[1].max(high)];
    }

    /// Returns the largest share of an area within the bounds and, if the area is uniform there, its share and the
    /// share of its rain that has left the cloud.
    pub fn even(&self, shaft: &Shaft, to_enu: &DMat3) -> (f64, Option<(f64, f64)>) {
        let [low, high] = self.altitudes_m;
        let [least, most] = shaft.share_within(self.middle, to_enu, 0.5 * (low + high), self.reach_m);
        let begun = [low, high].map(|m| shaft.begun(m));
        let even = least == most && (most == 0.0 || begun[0] == begun[1]);
        (most, even.then_some((most, begun[0])))
    }

    /// Returns the [`Evens`] of this part of the grid.
    pub fn evens(&self, overs: &AreasOverGrid, to_enu: &DMat3) -> Evens {
        let mut evens = overs.evens;
        for (even, over) in evens.iter_mut().zip(&overs.list) {
            *even = even.or_else(|| self.even(&over.as_ref()?.shaft, to_enu).1);
        }
        evens
    }
}
