//! Film and pores of one tile's cells.

use std::sync::OnceLock;

use super::{drains::Drains, lakes::Lakes};
use crate::{
    ground::{
        grid::CellGrid,
        rain_on::GridRain,
        terrain::{Flows, RUN},
        water::{GroundWater, Step, SurfaceWater},
    },
    terrain::{CellRect, Terrain, Tile, TileKey},
};

/// Water on the cells of a tile.
pub(super) struct TileWater {
    /// Index of the tile, (east, north).
    pub key: TileKey,
    /// Sinks of the tile's cells.
    pub drains: Drains,
    /// Rain on the tile's cells.
    pub rain: GridRain,
    /// Whether the tile has a state of its own; otherwise the water of level ground lies on it.
    pub begun: bool,
    /// Water of each cell in its film and in its pores, mm; empty while all cells are dry.
    top: Vec<[f32; 2]>,
    /// Whether anything flows or dries on each run of cells.
    awake: Vec<bool>,
    /// Whether any run of cells is awake.
    any_awake: bool,
    /// Cached hash of film and pores, until they change.
    hash: OnceLock<u64>,
}

/// Returns a tile's cells in the form that [`GridRain`] needs.
pub(super) fn cells_of<'a>(terrain: &Terrain, tile: &'a Tile) -> CellGrid<'a> {
    CellGrid {
        origin: terrain.origin_of(tile.key),
        cell_m: terrain.desc.cell_m,
        nodes: [terrain.desc.tile_cells; 2],
        heights_m: &tile.heights_m,
    }
}

/// Returns the largest f32 that is not above `v`.
fn rounded_down(v: f64) -> f32 {
    let near = v as f32;
    if f64::from(near) > v { near.next_down() } else { near }
}

impl TileWater {
    /// Creates the water of a tile, without a state of its own and with all sinks unknown.
    pub fn new(terrain: &Terrain, slot: u32) -> Self {
        let tile = terrain.tile(slot);
        let runs = tile.heights_m.len().div_ceil(RUN);
        Self {
            key: tile.key,
            drains: Drains::new(terrain),
            rain: GridRain::new(&cells_of(terrain, tile), (terrain.to_enu, terrain.altitude_m)),
            begun: false,
            top: Vec::new(),
            awake: vec![false; runs],
            any_awake: false,
            hash: OnceLock::new(),
        }
    }

    /// Returns film and pores of a cell, mm.
    pub fn top(&self, cell: usize) -> [f64; 2] {
        self.top.get(cell).map_or([0.0; 2], |top| top.map(f64::from))
    }

    /// Returns film and pores of all cells; empty if all are dry.
    pub fn tops(&self) -> &[[f32; 2]] {
        &self.top
    }

    /// Returns the water on the cells and in their pores, mm times cells.
    pub fn on_cells(&self) -> f64 {
        self.top.iter().flatten().map(|v| f64::from(*v)).sum()
    }

    /// Returns whether there is any water on the tile's cells.
    pub fn is_wet(&self) -> bool {
        self.begun && !self.top.is_empty()
    }

    /// Returns whether something flows or dries on any run.
    pub fn is_awake(&self) -> bool {
        self.any_awake
    }

    /// Marks the run of a cell as one on which something flows or dries.
    pub fn wake(&mut self, cell: usize) {
        if self.begun {
            (self.awake[cell / RUN], self.any_awake) = (true, true);
        }
    }

    /// Returns a hash that is equal for equal film and pores.
    pub fn hash(&self) -> u64 {
        *self.hash.get_or_init(|| {
            let fold = |hash: u64, top: &[f32; 2]| {
                let bits = u64::from(top[0].to_bits()) << 32 | u64::from(top[1].to_bits());
                (hash ^ bits).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29)
            };
            self.top.iter().fold(0xcbf2_9ce4_8422_2325 ^ u64::from(self.begun), fold)
        })
    }

    /// Discards the state; the next step begins a new one.
    pub fn begin_anew(&mut self) {
        (self.begun, self.any_awake, self.top) = (false, false, Vec::new());
        self.awake.fill(false);
        self.hash.take();
    }

    /// Updates the cells that the terrain changed. Returns the water that left with cells that are no longer ground.
    pub fn follow(&mut self, tile: &Tile, terrain: &Terrain, rect: CellRect) -> f64 {
        let Some(part) = terrain.rect(self.key).meets(rect) else { return 0.0 };
        let cells: Vec<usize> = part.cells().map(|place| terrain.in_tile(place)).collect();
        let mut runs: Vec<usize> = cells.iter().map(|cell| cell / RUN).collect();
        runs.sort_unstable();
        runs.dedup();
        self.rain.heights_changed(&cells_of(terrain, tile), runs.into_iter());
        let mut gone = 0.0;
        for cell in cells {
            self.wake(cell);
            if let Some(top) = self.top.get_mut(cell).filter(|_| !tile.has_ground(cell)) {
                gone += f64::from(top[0]) + f64::from(top[1]);
                *top = [0.0; 2];
                self.hash.take();
            }
        }
        gone
    }

    /// Restores saved film and pores.
    pub fn restore(&mut self, top: Vec<[f32; 2]>) {
        (self.begun, self.top) = (true, top);
        self.any_awake = !self.top.is_empty();
        self.awake.fill(self.any_awake);
        self.hash.take();
    }

    /// Begins the state with the water that the weather has left on each cell. Returns that water, mm times cells.
    pub fn begin(&mut self, tile: &Tile, water: &[GroundWater]) -> f64 {
        self.begin_anew();
        self.begun = true;
        let mut on_cells = 0.0;
        if water.iter().any(|w| w.total_mm() > 0.0) {
            self.top = vec![[0.0; 2]; water.len()];
            for (cell, w) in water.iter().enumerate().filter(|(cell, _)| tile.has_ground(*cell)) {
                self.top[cell] = [w.film_mm, w.soaked_mm].map(rounded_down);
                on_cells += w.hollows_mm + f64::from(self.top[cell][0]) + f64::from(self.top[cell][1]);
                if w.hollows_mm > 0.0 {
                    self.drains.add(cell, w.hollows_mm);
                }
            }
            self.awake.fill(true);
            self.any_awake = true;
        }
        on_cells
    }

    /// Advances film and pores by a step, and adds the run-off to the sinks. Runs that are not awake and on which
    /// nothing falls are skipped. `rains` says whether anything falls on the tile.
    pub fn step(&mut self, tile: &Tile, (slot, lakes): (usize, &Lakes), step: &Step, rains: bool) -> Flows {
        let mut flows = Flows::default();
        if !rains && !self.any_awake {
            return flows;
        }
        self.hash.take();
        if self.top.is_empty() {
            self.top = vec![[0.0; 2]; tile.heights_m.len()];
        }
        let has_lakes = lakes.has_any(slot);
        self.any_awake = false;
        let mut last: Option<([f32; 2], f64, bool, SurfaceWater)> = None;
        for run in 0..self.awake.len() {
            let rained_on = rains && self.rain.rains_on(run);
            if !self.awake[run] && !rained_on {
                continue;
            }
            let mut stirs = false;
            for cell in run * RUN..(run + 1) * RUN {
                if !tile.has_ground(cell) {
                    continue;
                }
                let top = self.top[cell];
                let rain = if rains { self.rain.fallen_mm(cell) } else { 0.0 };
                let under = has_lakes && lakes.is_under(slot, cell, tile.heights_m[cell]);
                let next = match &last {
                    Some((same, fell, below, next)) if *same == top && *fell == rain && *below == under => *next,
                    _ => {
                        let [film, soaked] = top.map(f64::from);
                        if under { step.below_water(film, soaked, rain) } else { step.surface(film, soaked, rain) }
                    }
                };
                last = Some((top, rain, under, next));
                let kept = [next.film_mm, next.soaked_mm].map(rounded_down);
                let rounding = (next.film_mm - f64::from(kept[0])) + (next.soaked_mm - f64::from(kept[1]));
                self.top[cell] = kept;
                stirs |= kept[0] > 0.0 || (kept[1] > 0.0 && !under);
                flows.rain += rain;
                flows.evaporated += next.evaporated_mm;
                let runs_off = next.ran_off_mm + rounding;
                if runs_off > 0.0 {
                    self.drains.add(cell, runs_off);
                }
            }
            self.awake[run] = stirs;
            self.any_awake |= stirs;
        }
        if !self.any_awake && self.top.iter().all(|top| *top == [0.0; 2]) {
            self.top = Vec::new();
        }
        flows
    }
}
