//! Water on the host's grid terrain: film and pores of every cell of a [`GroundGrid`] by the laws of [`super::water`],
//! and run-off that collects in the hollows of the terrain.
//!
//! Water that a cell sheds in a step reaches its hollow by the end of the step ([`super::basins`]). A full hollow
//! spills into a neighbouring one, and water that reaches the grid's border leaves. Nothing flows in from outside.
//! Standing water loses Penman's evaporation to the air and a leakage to the ground below, and takes all rain that
//! falls on it. The balance is: rain = change of film, pores and standing water + evaporated + leaked + drained.

use half::f16;

use super::{
    basins::{Basins, OUT},
    grid::GroundGrid,
    pools::Pools,
    water::{GroundWater, PORES_MM, Step, SurfaceWater, wetness_of},
};

/// Number of cells in a run. A run is skipped in a step if nothing falls, flows or dries on any of its cells.
pub(crate) const RUN: usize = 64;
/// Standing water, mm, of a cell in a dry hollow or in no hollow. The more negative this value, the closer the
/// interpolated edge of a puddle lies to the cells under water.
const BARE_MM: f32 = -50.0;

/// Terrain of the host and its hollows.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct GridTerrain {
    pub grid: GroundGrid,
    basins: Basins,
}

impl GridTerrain {
    /// Finds the hollows of a grid.
    pub fn new(grid: GroundGrid) -> Self {
        let basins = Basins::new(&grid.heights_m, grid.nodes[0] as usize);
        Self { grid, basins }
    }
}

/// Water that a step added (rain) or removed, mm times cells.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(crate) struct Flows {
    /// Rain that fell on the cells.
    pub rain: f64,
    /// Water that evaporated.
    pub evaporated: f64,
    /// Water that leaked into the ground below.
    pub leaked: f64,
    /// Run-off that left at the border.
    pub drained: f64,
}

/// Water of one cell.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(crate) struct CellWater {
    /// Film on the cell, mm.
    pub film_mm: f64,
    /// Water in the pores, as a share of their capacity.
    pub soaked: f64,
    /// Depth of standing water above the ground, mm. Negative where none stands: minus the height of the ground above
    /// its hollow's water level, or [`BARE_MM`].
    pub standing_mm: f64,
}

impl CellWater {
    /// Returns the depth of water over the ground, mm.
    pub fn depth_mm(&self) -> f64 {
        self.film_mm + self.standing_mm.max(0.0)
    }

    /// Returns the wetness, as [`SurfaceCover::wetness`](crate::weather::SurfaceCover::wetness).
    pub fn wetness(&self) -> f64 {
        if self.standing_mm > 0.0 { 1.0 } else { wetness_of(self.film_mm, self.soaked * PORES_MM) }
    }
}

/// Water on a terrain.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TerrainWater {
    /// Water of each cell in its film and in its pores, mm.
    pub top: Vec<[f64; 2]>,
    /// Standing water in the hollows.
    pools: Pools,
    /// Depths as in [`CellWater::standing_mm`].
    standing: Vec<f32>,
    /// Whether there is no water at all.
    dry: bool,
    /// For each run, whether a step without rain may change it: true if one of its cells has a film, or wet pores that
    /// are not under water.
    awake: Vec<bool>,
    /// Cached water level of each hollow.
    levels: Vec<WaterLevel>,
    /// Scratch space for a step: the water that flows into each pit.
    inflow: Vec<f64>,
}

/// Cached water level in a hollow.
#[derive(Clone, Copy, Debug, PartialEq)]
struct WaterLevel {
    /// Height of the level, mm, above the origin from which the cells' heights are measured.
    mm: f64,
    /// Volume for which `mm` was computed, mm times cells; `None` if the water belongs to a larger hollow.
    of: Option<f64>,
}

impl TerrainWater {
    /// Creates the water of a terrain on which each cell is as wet as `water` says for open, level ground. The water in
    /// hollows is gathered from the cells that drain to each pit, and then stands in these pits.
    pub fn new(terrain: &GridTerrain, water: impl Fn(usize) -> GroundWater) -> Self {
        let basins = &terrain.basins;
        let top: Vec<GroundWater> = (0..terrain.grid.len()).map(water).collect();
        let mut inflow = vec![0.0; basins.list.len()];
        for (w, pit) in top.iter().zip(&basins.drains_to).filter(|(_, pit)| **pit != OUT) {
            inflow[*pit as usize] += w.hollows_mm;
        }
        let mut pools = Pools::new(basins);
        inflow.iter().enumerate().filter(|(_, v)| **v > 0.0).for_each(|(pit, v)| {
            pools.pour(basins, pit as u32, *v);
        });
        Self::with(terrain, top.iter().map(|w| [w.film_mm, w.soaked_mm]).collect(), pools)
    }

    /// Creates the water of a saved state; `None` if the saved water does not fit this terrain.
    pub fn from_parts(terrain: &GridTerrain, top: Vec<[f64; 2]>, held: Vec<f64>) -> Option<Self> {
        let sound = |[film, soaked]: &[f64; 2]| (0.0..1e4).contains(film) && (0.0..=PORES_MM).contains(soaked);
        let pools = Pools::from_held(&terrain.basins, held)?;
        (top.len() == terrain.grid.len() && top.iter().all(sound)).then(|| Self::with(terrain, top, pools))
    }

    /// Creates water from the film and the soaked water of each cell, mm, and the water in the hollows.
    fn with(terrain: &GridTerrain, top: Vec<[f64; 2]>, pools: Pools) -> Self {
        let hollows = terrain.basins.list.len();
        let mut new = Self {
            dry: top.iter().all(|t| *t == [0.0; 2]) && pools.are_dry(),
            standing: vec![BARE_MM; top.len()],
            top,
            pools,
            inflow: vec![0.0; hollows],
            levels: vec![WaterLevel { mm: f64::INFINITY, of: None }; hollows],
            awake: Vec::new(),
        };
        new.level(&terrain.basins);
        let cells = new.top.iter().zip(&new.standing);
        let stirs = |([film, soaked], standing): (&[f64; 2], &f32)| *film > 0.0 || (*soaked > 0.0 && *standing <= 0.0);
        let stirring: Vec<bool> = cells.map(stirs).collect();
        new.awake = stirring.chunks(RUN).map(|run| run.contains(&true)).collect();
        new
    }

    /// Returns the volume of water in each hollow, mm times cells, in the form of [`Pools::held`].
    pub fn held(&self) -> &[f64] {
        &self.pools.held
    }

    /// Returns whether there is no water at all.
    pub fn is_dry(&self) -> bool {
        self.dry
    }

    /// Advances the water by a step. `rain_mm` returns the rain on a cell, mm; `rains` returns whether any rain falls
    /// on a run. Runs on which nothing falls, flows or dries are skipped. Skipping changes no bit of the result.
    pub fn step(
        &mut self,
        terrain: &GridTerrain,
        step: &Step,
        rains: impl Fn(usize) -> bool,
        rain_mm: impl Fn(usize) -> f64,
    ) -> Flows {
        let basins = &terrain.basins;
        let mut flows = Flows::default();
        let mut wet = false;
        // Caches the last result: neighbours mostly have the same water and the same rain.
        let mut last: Option<([f64; 2], f64, bool, SurfaceWater)> = None;
        for (run, tops) in self.top.chunks_mut(RUN).enumerate() {
            if !self.awake[run] && !rains(run) {
                continue;
            }
            let mut stirs = false;
            for (cell, top) in (run * RUN..).zip(tops) {
                let (rain, under) = (rain_mm(cell), self.standing[cell] > 0.0);
                let next = match &last {
                    Some((same, fell, below, next)) if same == top && *fell == rain && *below == under => *next,
                    _ if under => step.below_water(top[0], top[1], rain),
                    _ => step.surface(top[0], top[1], rain),
                };
                last = Some((*top, rain, under, next));
                *top = [next.film_mm, next.soaked_mm];
                stirs |= next.film_mm > 0.0 || (next.soaked_mm > 0.0 && !under);
                flows.rain += rain;
                flows.evaporated += next.evaporated_mm;
                match basins.drains_to[cell] {
                    OUT => flows.drained += next.ran_off_mm,
                    pit => self.inflow[pit as usize] += next.ran_off_mm,
                }
            }
            self.awake[run] = stirs;
            wet |= stirs;
        }
        for (pit, water) in self.inflow.iter_mut().enumerate().filter(|(_, v)| **v > 0.0) {
            flows.drained += self.pools.pour(basins, pit as u32, std::mem::take(water));
        }
        if !self.pools.are_dry() {
            let sinks = step.evaporated_mm + step.leaked_mm;
            let gone = self.pools.sink(basins, sinks);
            flows.evaporated += gone * step.evaporated_mm / sinks;
            flows.leaked += gone * step.leaked_mm / sinks;
            wet = true;
        }
        self.dry = !wet;
        self.level(basins);
        flows
    }

    /// Updates the depths from the volumes in the hollows.
    fn level(&mut self, basins: &Basins) {
        // Visits the list in reverse, so that a hollow comes before its parts, which take its level.
        for hollow in (0..self.levels.len()).rev() {
            let before = self.levels[hollow];
            let now = match self.pools.whole_of(basins, hollow) {
                Some(whole) => WaterLevel { mm: self.levels[whole].mm, of: None },
                None if before.of == Some(self.pools.held[hollow]) => continue,
                None => WaterLevel { mm: self.pools.level(basins, hollow), of: Some(self.pools.held[hollow]) },
            };
            self.levels[hollow] = now;
            if now.mm == before.mm {
                continue;
            }
            for (cell, height_mm) in basins.own_cells(hollow) {
                let depth = (now.mm - height_mm) as f32;
                let depth = if depth.is_finite() { depth } else { BARE_MM };
                if depth <= 0.0 && self.standing[cell] > 0.0 {
                    // Ground from which water has withdrawn begins to dry.
                    self.awake[cell / RUN] = true;
                }
                self.standing[cell] = depth;
            }
        }
    }

    /// Returns the water of a cell.
    pub fn cell(&self, cell: usize) -> CellWater {
        let [film_mm, soaked_mm] = self.top[cell];
        CellWater { film_mm, soaked: soaked_mm / PORES_MM, standing_mm: f64::from(self.standing[cell]) }
    }

    /// Returns the mean water of four cells with these weights.
    pub fn between(&self, shares: &[(usize, f64); 4]) -> CellWater {
        shares.iter().fold(CellWater::default(), |sum, (cell, share)| {
            let c = self.cell(*cell);
            CellWater {
                film_mm: sum.film_mm + share * c.film_mm,
                soaked: sum.soaked + share * c.soaked,
                standing_mm: sum.standing_mm + share * c.standing_mm,
            }
        })
    }

    /// Fills `texels` with each cell by rows ([`super::GroundTexture`]): film, mm, soaked share of the pores, depth of
    /// standing water as in [`CellWater`], mm, and the share under ice.
    pub fn texels(&self, ice: impl Fn(usize) -> f32, texels: &mut Vec<[u16; 4]>) {
        texels.clear();
        // Values beyond the range of a half float are clamped.
        let half = |v: f32| f16::from_f32(v.clamp(f16::MIN.to_f32(), f16::MAX.to_f32())).to_bits();
        texels.extend(self.top.iter().zip(&self.standing).enumerate().map(|(cell, ([film, soaked], standing))| {
            [*film as f32, (soaked / PORES_MM) as f32, *standing, ice(cell)].map(half)
        }));
    }

    /// Returns the share of the cells under standing water.
    pub fn puddles(&self) -> f64 {
        self.standing.iter().filter(|s| **s > 0.0).count() as f64 / self.standing.len() as f64
    }

    /// Returns all water, mm times cells.
    #[cfg(test)]
    fn total(&self, terrain: &GridTerrain) -> f64 {
        self.top.iter().map(|t| t[0] + t[1]).sum::<f64>() + self.pools.total(&terrain.basins)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::ground::{
        basins::tests::rough,
        water::{Forcing, STEP_S},
    };

    /// Creates a terrain with cells of 1 m; `heights_m` is row by row from the south-west.
    fn terrain(columns: u32, rows: u32, heights_m: Vec<f32>) -> GridTerrain {
        let grid =
            GroundGrid { origin: DVec3::ZERO, cell_m: 1.0, nodes: [columns, rows], heights_m, classes: Vec::new() };
        grid.validate().unwrap();
        GridTerrain::new(grid)
    }

    /// Returns a step in this rain and evaporation, and the depth of rain that falls in it, mm.
    fn rain(mm_h: f64, evaporation_mm_h: f64) -> (Step, f64) {
        let forcing = Forcing { liquid_mm_h: mm_h, evaporation_mm_h };
        (Step::new(&forcing, STEP_S), mm_h * STEP_S / 3600.0)
    }

    #[test]
    fn rain_is_on_the_ground_or_in_the_reported_losses() {
        let terrain = terrain(48, 40, rough(48, 40, 2));
        let mut water = TerrainWater::new(&terrain, |_| GroundWater::default());
        assert!(water.is_dry());
        let (mut fallen, mut gone) = (0.0, 0.0);
        for i in 0..2400 {
            // Two showers that differ between east and west, with roofs; then wind and sun.
            let (step, mm) = rain(if i % 1200 < 500 { 9.0 } else { 0.0 }, if i % 1200 < 500 { 0.02 } else { 0.6 });
            let over = |cell: usize| if cell % 48 < 20 { mm } else { mm * ((cell / 48) % 4) as f64 / 3.0 };
            let flows = water.step(&terrain, &step, |_| true, over);
            fallen += flows.rain;
            gone += flows.evaporated + flows.leaked + flows.drained;
            let held = water.total(&terrain);
            assert!((fallen - gone - held).abs() <= 1e-6 * fallen, "step {i}: {fallen} {gone} {held}");
            assert!(flows.evaporated >= 0.0 && flows.leaked >= 0.0 && flows.drained >= 0.0, "{flows:?}");
        }
        assert!(fallen > 30_000.0 && gone > 0.3 * fallen, "{fallen} {gone}");
    }

    #[test]
    fn a_puddle_stands_in_the_deepest_cell_first_and_dries_last() {
        let size = 25u32;
        let bowl = |i: u32| {
            let (x, y) = (f64::from(i % size) - 14.0, f64::from(i / size) - 9.0);
            (0.002 * (x * x + y * y)).min(0.12) as f32
        };
        let terrain = terrain(size, size, (0..size * size).map(bowl).collect());
        let deepest = (9 * size + 14) as usize;
        let mut water = TerrainWater::new(&terrain, |_| GroundWater::default());
        let under = |w: &TerrainWater| (0..w.top.len()).filter(|c| w.cell(*c).standing_mm > 0.0).collect::<Vec<_>>();
        let (wet, mm) = rain(20.0, 0.0);
        let mut first = Vec::new();
        for _ in 0..360 {
            water.step(&terrain, &wet, |_| true, |_| mm);
            if first.is_empty() {
                first = under(&water);
            }
        }
        assert_eq!(first, [deepest]);
        let full = under(&water).len();
        let deep = water.cell(deepest);
        assert!(
            full > 50 && deep.standing_mm > 40.0 && deep.film_mm == 0.0 && deep.wetness() == 1.0,
            "{full} {deep:?}"
        );
        let level = (0..water.top.len())
            .filter(|c| water.cell(*c).standing_mm > 0.0)
            .map(|c| f64::from(terrain.grid.heights_m[c]) * 1e3 + water.cell(c).standing_mm)
            .collect::<Vec<_>>();
        assert!(level.iter().all(|l| (l - level[0]).abs() < 1e-2), "water is level: {level:?}");
        let (dry, _) = rain(0.0, 0.5);
        let (mut hours, mut left) = (0.0, full);
        while !water.is_dry() && hours < 400.0 {
            water.step(&terrain, &dry, |_| false, |_| 0.0);
            hours += STEP_S / 3600.0;
            let now = under(&water);
            // The last of the film still flows in for a while.
            assert!((hours < 1.0 || now.len() <= left) && (now.is_empty() || now.contains(&deepest)));
            left = now.len();
        }
        assert!((40.0..200.0).contains(&hours), "{hours} h");
        assert_eq!(water.puddles(), 0.0);
    }

    /// Hours of showers and sun on rough ground: skipping gives the same bits as stepping all cells and hollows, in
    /// less time.
    #[test]
    fn skipping_cells_at_rest_changes_no_bit_and_saves_most_of_the_time() {
        let (columns, rows) = (256, 256);
        let terrain = terrain(columns, rows, rough(columns as usize, rows as usize, 8));
        let dry = || TerrainWater::new(&terrain, |_| GroundWater::default());
        let (mut water, mut every) = (dry(), dry());
        // A shower over a third of the ground, then eleven hours of sun.
        let mut seconds = [[0.0f64; 2]; 12];
        for i in 0..4320 {
            let hour = i / 360;
            let (step, mm) = rain(if hour == 0 { 9.0 } else { 0.0 }, if hour == 0 { 0.02 } else { 0.6 });
            let rains = |run: usize| mm > 0.0 && run.is_multiple_of(4);
            let falls = |cell: usize| if rains(cell / RUN) { mm } else { 0.0 };
            let begun = std::time::Instant::now();
            water.step(&terrain, &step, rains, falls);
            let passed = begun.elapsed().as_secs_f64();
            every.awake.fill(true);
            every.levels.iter_mut().for_each(|level| level.of = None);
            let begun = std::time::Instant::now();
            every.step(&terrain, &step, |_| true, falls);
            seconds[hour][0] += passed;
            seconds[hour][1] += begun.elapsed().as_secs_f64();
            if i % 60 == 0 {
                assert!(water.top == every.top && water.standing == every.standing, "step {i}");
                assert!(water.held() == every.held() && water.is_dry() == every.is_dry(), "step {i}");
            }
        }
        let ms = |[passed, all]: [f64; 2]| format!("{:.3} of {:.3} ms", passed / 0.36, all / 0.36);
        println!(
            "a step of 256^2 in the shower {}, an hour later {}, at last {}",
            ms(seconds[0]),
            ms(seconds[2]),
            ms(seconds[11])
        );
        assert!(!water.is_dry(), "puddles are left");
        assert!(seconds[11][0] < 0.5 * seconds[11][1], "{seconds:?}");
    }

    #[test]
    fn as_much_water_as_is_reported_stands_in_the_hollows() {
        let terrain = terrain(60, 50, rough(60, 50, 4));
        let reported = GroundWater { film_mm: 0.2, soaked_mm: 0.4, hollows_mm: 0.9 };
        let water = TerrainWater::new(&terrain, |_| reported);
        let caught = terrain.basins.drains_to.iter().filter(|d| **d != OUT).count() as f64;
        let standing = water.pools.total(&terrain.basins);
        // Some hollows hold less than the water that drains into them.
        assert!((0.95..1.0).contains(&(standing / (0.9 * caught))), "{standing} of {caught}");
        assert!(water.puddles() > 0.02, "{}", water.puddles());
        let again = TerrainWater::from_parts(&terrain, water.top.clone(), water.held().to_vec()).unwrap();
        assert_eq!(again, water);
        let mut bad = water.top.clone();
        bad[3][1] = f64::NAN;
        assert!(TerrainWater::from_parts(&terrain, bad, water.held().to_vec()).is_none());
    }
}
