//! Rain of the rain areas on each part of the host's terrain.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::{grid::CellGrid, rain_on::GridRain, terrain::RUN, water::Forcing};
use crate::{
    error::Result,
    falling::{MAX_AREAS, area::Shaft},
    weather::{Conditions, Falling},
    world::World,
};

/// A rain area above a grid.
#[derive(Clone, Copy)]
pub(super) struct AreaOverGrid {
    pub shaft: Shaft,
    /// Whether it reaches the grid anywhere.
    pub reaches: bool,
    /// 0 where it does not.
    pub liquid_mm_h: f64,
}

/// Share of each area, and how much of its rain has left its cloud, where both are the same all over a part of the
/// grid; none where they vary.
type Evens = [Option<(f64, f64)>; MAX_AREAS];

/// Areas over a grid, in their order.
pub(super) struct AreasOverGrid {
    list: [Option<AreaOverGrid>; MAX_AREAS],
    /// Shares that are the same all over the grid.
    evens: Evens,
}

impl AreasOverGrid {
    pub fn all(&self) -> impl Iterator<Item = &AreaOverGrid> {
        self.list.iter().flatten()
    }

    fn are_even(&self, evens: &Evens) -> bool {
        self.list.iter().zip(evens).all(|(over, even)| over.is_none() || even.is_some())
    }

    /// Whether any liquid falls on the grid.
    pub fn rain(&self, forcing: &Forcing) -> bool {
        forcing.liquid_mm_h > 0.0 || self.all().any(|o| o.liquid_mm_h > 0.0)
    }

    /// Whether as much falls on each cell.
    pub fn even(&self) -> bool {
        self.are_even(&self.evens)
    }
}

/// Rain and drizzle, mm/h.
pub(super) fn liquid(f: &Falling) -> f64 {
    f.rain_mm_h + f.drizzle_mm_h
}

/// Where some cells of a grid lie: their middle in the host's world, how far they reach from it, lowest and highest
/// altitude, m.
pub(super) struct CellBounds {
    middle: DVec3,
    reach_m: f64,
    altitudes_m: [f64; 2],
}

impl CellBounds {
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
            // A little more, for the rounding.
            reach_m: 0.5 * (high - low).length() * 1.000_001 + 1e-6,
            altitudes_m: [low.z, high.z].map(|z| altitude_m + z),
        }
    }

    /// All of a grid, and each run of its cells.
    pub fn whole_and_runs(grid: &CellGrid<'_>, frame: (&DMat3, f64)) -> (Self, Vec<Self>) {
        let run = |first| Self::new(grid, frame, first..(first + RUN).min(grid.len()));
        (Self::new(grid, frame, 0..grid.len()), (0..grid.len()).step_by(RUN).map(run).collect())
    }

    /// Reaches over another too.
    pub fn reach_over(&mut self, other: &Self) {
        self.reach_m = self.reach_m.max((other.middle - self.middle).length() + other.reach_m);
        let [low, high] = other.altitudes_m;
        self.altitudes_m = [self.altitudes_m[0].min(low), self.altitudes_m[1].max(high)];
    }

    /// Bounds of an area's share here, and the share itself where it is the same everywhere.
    fn even(&self, shaft: &Shaft, to_enu: &DMat3) -> (f64, Option<(f64, f64)>) {
        let [low, high] = self.altitudes_m;
        let [least, most] = shaft.share_within(self.middle, to_enu, 0.5 * (low + high), self.reach_m);
        let begun = [low, high].map(|m| shaft.begun(m));
        let even = least == most && (most == 0.0 || begun[0] == begun[1]);
        (most, even.then_some((most, begun[0])))
    }

    /// Finds share and begun rain of each area over this part, where they are even, as [`Evens`].
    fn evens(&self, overs: &AreasOverGrid, to_enu: &DMat3) -> Evens {
        let mut evens = overs.evens;
        for (even, over) in evens.iter_mut().zip(&overs.list) {
            *even = even.or_else(|| self.even(&over.as_ref()?.shaft, to_enu).1);
        }
        evens
    }
}

impl GridRain {
    /// Rain and drizzle at a cell where the weather has `own`, mm/h.
    fn liquid_with(&self, grid: &CellGrid<'_>, overs: &AreasOverGrid, evens: &Evens, own: f64, cell: usize) -> f64 {
        overs.list.iter().zip(evens).fold(own, |sum, (over, even)| {
            let Some(over) = over else { return sum };
            let (share, begun) = even.unwrap_or_else(|| {
                let altitude = self.altitude_m + f64::from(grid.heights_m[cell]);
                let p = grid.node(cell, &self.to_enu);
                (over.shaft.share_at(p, &self.to_enu, altitude), over.shaft.begun(altitude))
            });
            sum * (1.0 - share) + over.liquid_mm_h * share * begun
        })
    }

    /// Returns rain and drizzle at a cell, mm/h, from what is even over all of the grid.
    pub(super) fn liquid(&self, grid: &CellGrid<'_>, overs: &AreasOverGrid, own: f64, cell: usize) -> f64 {
        self.liquid_with(grid, overs, &overs.evens, own, cell)
    }

    /// Rain and drizzle at each cell, mm/h: asked once for each run of cells on which areas lie evenly.
    pub(super) fn liquids(&self, grid: &CellGrid<'_>, overs: &AreasOverGrid, own: f64, liquids: &mut Vec<f64>) {
        liquids.clear();
        let count = grid.len();
        for (run, part) in self.runs.iter().enumerate() {
            let cells = run * RUN..((run + 1) * RUN).min(count);
            let evens = part.evens(overs, &self.to_enu);
            if overs.are_even(&evens) {
                liquids.resize(cells.end, self.liquid_with(grid, overs, &evens, own, cells.start));
            } else {
                liquids.extend(cells.map(|cell| self.liquid_with(grid, overs, &evens, own, cell)));
            }
        }
    }
}

impl GridRain {
    /// The areas over the terrain at a time; `c` is the weather then.
    pub(super) fn overs(&self, world: &World, time_s: f64, c: &Conditions) -> Result<AreasOverGrid> {
        let mut overs = AreasOverGrid { list: [None; MAX_AREAS], evens: [None; MAX_AREAS] };
        if world.set.regions.is_empty() {
            return Ok(overs);
        }
        let places = overs.list.iter_mut().zip(&mut overs.evens);
        for ((place, even), shaft) in places.zip(world.over().shafts_at(time_s, c)?) {
            let (most, over_all) = self.whole.even(&shaft, &self.to_enu);
            let liquid_mm_h = if most > 0.0 { liquid(&shaft.falling) } else { 0.0 };
            *even = over_all;
            *place = Some(AreaOverGrid { shaft, reaches: most > 0.0, liquid_mm_h });
        }
        Ok(overs)
    }
}
