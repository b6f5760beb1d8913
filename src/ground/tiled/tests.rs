//! Tests of water on tiles: against one grid, across borders, its balance where the ground changes, and its saved
//! state.

use std::time::Instant;

use glam::DVec3;

use super::{
    lakes::saved::LakeBranch,
    saved::SavedTiles,
    step::{SteppedTiles, TiledStep},
    water::{Changed, TiledWater},
};
use crate::{
    almanac::sun::Utc,
    ground::{
        basins::tests::{flooded, rough},
        grid::GroundGrid,
        state::GroundStep,
        terrain::{CellWater, GridTerrain, TerrainWater},
        water::{Forcing, GroundWater, STEP_S, Step},
    },
    light::{Exposure, ToneCurve},
    planet::Planet,
    scene::WorldFrame,
    terrain::{CellId, CellRect, Rows, SurfaceClass, Terrain, TerrainCells, TerrainDesc, TileKey},
    weather::{Conditions, Weather, derive},
    world::{Couplings, World, WorldDesc},
};

/// Side of a tile, cells.
const SIDE: i32 = 32;

/// A terrain and its water, stepped without a context, with the sums of rain and of losses.
struct Bench {
    world: World,
    terrain: Terrain,
    water: TiledWater,
    /// Rain so far, mm times cells.
    fallen: f64,
    /// Water that evaporated, leaked, drained or was removed with its cells so far, mm times cells.
    gone: f64,
}

/// Creates a world in the default weather.
fn world() -> World {
    let made = WorldDesc {
        frame: WorldFrame::default(),
        planet: Planet::earth(),
        seed: 3,
        exposure: Exposure::default(),
        tone: ToneCurve::default(),
        utc_at_zero: Utc(1_782_036_000.0),
    };
    // These tests compute no light.
    let couplings =
        Couplings { dim: |_| Ok(()), cloud_over_areas: |_, _, _, _| Ok(None), night_lux: |_, _, _, _| Ok([0.0; 3]) };
    World::new(made, derive(&Weather::default()).unwrap(), couplings).unwrap()
}

/// Returns the default weather with rain of this rate, mm/h.
fn conditions(rain_mm_h: f64) -> Conditions {
    let mut c = derive(&Weather::default()).unwrap();
    c.precipitation.rain_mm_h = rain_mm_h;
    c
}

/// Returns the forcing of a step from both rates.
fn forcing(rain_mm_h: f64, evaporation_mm_h: f64) -> Forcing {
    Forcing { liquid_mm_h: rain_mm_h, evaporation_mm_h }
}

impl Bench {
    /// Creates `tiles` tiles from the key `low` on, with `heights` of the places of the lattice, m.
    fn new(side: u32, [low, tiles]: [[i32; 2]; 2], heights: impl Fn([i32; 2]) -> f32) -> Self {
        let world = world();
        let desc = TerrainDesc { origin: DVec3::ZERO, cell_m: 1.0, tile_cells: side };
        let mut terrain = Terrain::new(desc, &world.frame).unwrap();
        for key in (0..tiles[0] * tiles[1]).map(|i| TileKey::new(low[0] + i % tiles[0], low[1] + i / tiles[0])) {
            let heights_m: Vec<f32> = terrain.rect(key).cells().map(&heights).collect();
            terrain
                .set_tile(&TerrainCells { key, heights_m: Rows::of(&heights_m), ..TerrainCells::default() })
                .unwrap();
        }
        let water = TiledWater::of_all(&terrain);
        Self { world, terrain, water, fallen: 0.0, gone: 0.0 }
    }

    /// Takes a step of [`STEP_S`] and adds its flows to the sums.
    fn step(&mut self, rain_mm_h: f64, evaporation_mm_h: f64) -> SteppedTiles {
        let (c, f) = (conditions(rain_mm_h), forcing(rain_mm_h, evaporation_mm_h));
        let ground = GroundStep {
            from_s: 0.0,
            seconds: STEP_S,
            conditions: &c,
            forcing: &f,
            sunlight_w_m2: 0.0,
            water: &GroundWater::default(),
        };
        let now = TiledStep { world: &self.world, terrain: &self.terrain, ground };
        let stepped = self.water.step(&now, None).unwrap().unwrap();
        self.fallen += stepped.flows.rain;
        self.gone += stepped.flows.evaporated + stepped.flows.leaked + stepped.flows.drained;
        stepped
    }

    /// Changes the heights and classes of the cells in a rectangle, tile by tile.
    fn change(&mut self, rect: CellRect, height: impl Fn([i32; 2]) -> f32, class: Option<SurfaceClass>) {
        for key in self.terrain.keys_within(rect).collect::<Vec<_>>() {
            let Some(part) = self.terrain.rect(key).meets(rect) else { continue };
            let heights: Vec<f32> = part.cells().map(&height).collect();
            let classes = vec![class; heights.len()];
            let low = self.terrain.rect(key).low;
            let cells = TerrainCells {
                key,
                first: [0, 1].map(|i| (part.low[i] - low[i]) as u32),
                size: [0, 1].map(|i| (part.high[i] - part.low[i]) as u32),
                heights_m: Rows::of(&heights),
                classes: Rows::of(&classes),
                no_data_m: None,
            };
            if let Some(rect) = self.terrain.update(&cells).unwrap() {
                self.follow(rect, false);
            }
        }
    }

    /// Updates the water after the ground in `rect` has changed or, with `is_removal`, has been removed.
    fn follow(&mut self, rect: CellRect, is_removal: bool) {
        let change = Changed { revision: self.terrain.revision, rect, is_removal };
        self.gone += self.water.follow(&self.terrain, &change);
    }

    /// Returns the water on the cell at this place of the lattice, (east, north) in cells.
    fn at(&self, place: [i32; 2]) -> CellWater {
        self.water.cell(&self.terrain, self.terrain.cell_at(place).unwrap(), &GroundWater::default())
    }

    #[track_caller]
    fn holds_its_water(&self, situation: &str) {
        let held = self.water.total();
        let off = (self.fallen - self.gone - held).abs();
        assert!(
            off <= 1e-6 * self.fallen,
            "{situation}: {} fell, {} gone, {held} held: off by {off}",
            self.fallen,
            self.gone
        );
    }

    /// Checks that all pits of a lake have the same water level.
    fn lies_level(&self) {
        for (branches, _) in self.water.lakes.saved() {
            let pits = branches.iter().filter_map(|b| if let LakeBranch::Pit(pit) = b { Some(*pit) } else { None });
            let level = |pit: CellId| {
                let (slot, at) = self.terrain.split(pit);
                let lake = self.water.lakes.lake_of(slot, at).expect("a lake");
                self.water.lakes.level_mm(lake)
            };
            let levels: Vec<f64> = pits.map(level).collect();
            assert!(levels.iter().all(|l| *l == levels[0]), "{levels:?}");
        }
    }
}

/// Compares the water on four tiles with that on one grid of the same heights, cell by cell, over hours of rain and
/// sun.
#[test]
fn four_tiles_have_the_water_of_one_grid() {
    let size = 2 * SIDE as usize;
    let heights = rough(size, size, 2);
    let mut tiles =
        Bench::new(SIDE as u32, [[-1, -1], [2, 2]], |[x, y]| heights[(y + SIDE) as usize * size + (x + SIDE) as usize]);
    let grid = GroundGrid {
        origin: DVec3::ZERO,
        cell_m: 1.0,
        nodes: [size as u32; 2],
        heights_m: heights.clone(),
        classes: Vec::new(),
    };
    let grid = GridTerrain::new(grid);
    let mut one = TerrainWater::new(&grid, |_| GroundWater::default());
    let (mut wettest, mut other): (f64, usize) = (0.0, 0);
    for i in 0..1600 {
        let (rain, sun) = if i % 800 < 400 { (14.0, 0.02) } else { (0.0, 0.8) };
        tiles.step(rain, sun);
        one.step(&grid, &Step::new(&forcing(rain, sun), STEP_S), |_| true, |_| rain * STEP_S / 3600.0);
        if i % 80 != 79 {
            continue;
        }
        for cell in 0..size * size {
            let place = [(cell % size) as i32 - SIDE, (cell / size) as i32 - SIDE];
            let (here, there) = (tiles.at(place), one.cell(cell));
            let off = [here.film_mm - there.film_mm, here.soaked - there.soaked, here.depth_mm() - there.depth_mm()];
            other += usize::from(off[0].abs() > 1e-4 || off[1].abs() > 1e-4 || off[2].abs() > 0.02);
            wettest = wettest.max(there.standing_mm);
        }
        tiles.holds_its_water("in the weather");
        tiles.lies_level();
    }
    // Where three hollows meet in one cell, tiles and grid join them in a different order.
    let share = other as f64 / (20 * size * size) as f64;
    println!("{:.2} % of the cells differ, at most {wettest:.0} mm deep", 100.0 * share);
    assert!(wettest > 50.0 && share < 0.02, "{wettest} {share}");
}

/// Compares the levels after long heavy rain with those of the priority-flood algorithm.
#[test]
fn endless_rain_stands_as_high_as_each_hollow_spills() {
    let size = 2 * SIDE as usize;
    for seed in [3, 4] {
        let heights = rough(size, size, seed);
        let mut bench = Bench::new(SIDE as u32, [[0, 0], [2, 2]], |[x, y]| heights[y as usize * size + x as usize]);
        for _ in 0..40 {
            bench.step(20_000.0, 0.0);
        }
        let levels = flooded(&heights, size);
        for (cell, level) in levels.iter().enumerate() {
            let depth = bench.at([(cell % size) as i32, (cell / size) as i32]).standing_mm.max(0.0);
            let wanted = level - f64::from(heights[cell]) * 1e3;
            // 0.001 mm leaks into the ground in a step.
            assert!((depth - wanted).abs() < 0.01, "{cell}: {depth} mm deep, {wanted} mm by the flood");
        }
    }
}

/// Fills a bowl that spans four tiles and checks that its water has one level.
#[test]
fn a_puddle_lies_level_across_the_borders_of_tiles() {
    let bowl = |[x, y]: [i32; 2]| {
        let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        (0.002 * (x * x + y * y)).min(0.3) as f32
    };
    let mut bench = Bench::new(SIDE as u32, [[-1, -1], [2, 2]], bowl);
    for _ in 0..720 {
        bench.step(20.0, 0.0);
    }
    let level = |place: [i32; 2]| f64::from(bowl(place)) * 1e3 + bench.at(place).standing_mm;
    let places = [[0, 0], [-1, 0], [0, -1], [-1, -1], [3, 2], [-4, 1], [2, -5]];
    assert!(places.iter().all(|p| bench.at(*p).standing_mm > 20.0), "{:?}", bench.at([3, 2]));
    assert!(places.iter().all(|p| (level(*p) - level([0, 0])).abs() < 1e-6));
    assert_eq!(bench.water.lakes.saved().filter(|(b, held)| !b.is_empty() && *held > 1e3).count(), 1, "one water");
    bench.holds_its_water("after the rain");
}

/// Raises, lowers, removes and restores ground in rain and sun, and checks the balance of water after each change.
#[test]
fn no_water_is_lost_where_the_ground_changes() {
    let size = 3 * SIDE as usize;
    let heights = rough(size, size, 5);
    let at = |[x, y]: [i32; 2]| heights[y as usize * size + x as usize];
    let mut bench = Bench::new(SIDE as u32, [[0, 0], [3, 3]], at);
    let random = |i: u32, n: i32| (crate::falling::random3([i, 9, 4])[0] % n as u32) as i32;
    for i in 0..500u32 {
        let (rain, sun) = if i % 200 < 120 { (25.0, 0.02) } else { (0.0, 0.8) };
        bench.step(rain, sun);
        bench.holds_its_water(&format!("step {i}"));
        let low = [random(3 * i, 80), random(3 * i + 1, 80)];
        let rect = CellRect { low, high: low.map(|v| v + 1 + random(3 * i + 2, 16)) };
        let by = 0.4 * (random(7 * i, 100) as f32 / 100.0 - 0.5);
        let class = if i % 11 == 3 { None } else { Some(SurfaceClass::Soil) };
        bench.change(rect, |p| at(p) + by, class);
        bench.holds_its_water(&format!("change {i}"));
        bench.lies_level();
        if i % 50 == 49 {
            let key = TileKey::new(random(i, 3), random(i + 1, 3));
            let rect = bench.terrain.remove(key).unwrap();
            bench.follow(rect, true);
            bench.holds_its_water(&format!("removal {i}"));
            let heights: Vec<f32> = rect.cells().map(at).collect();
            let cells = TerrainCells { key, heights_m: Rows::of(&heights), ..TerrainCells::default() };
            bench.terrain.set_tile(&cells).unwrap();
            bench.follow(rect, false);
            bench.holds_its_water(&format!("return {i}"));
        }
    }
    assert!(
        bench.gone > 0.2 * bench.fallen && bench.water.lakes.count > 20,
        "{} {}",
        bench.gone,
        bench.water.lakes.count
    );
}

/// Checks that a changed terrain has the same state as one created with the changed heights.
#[test]
fn changes_leave_the_same_ground_as_setting_it_anew() {
    let size = 2 * SIDE as usize;
    let heights = rough(size, size, 11);
    let at = |[x, y]: [i32; 2]| heights[y as usize * size + x as usize];
    let pit = CellRect { low: [25, 20], high: [41, 36] };
    let dug = |p: [i32; 2]| if pit.cells().any(|c| c == p) { at(p) - 0.3 } else { at(p) };
    let mut changed = Bench::new(SIDE as u32, [[0, 0], [2, 2]], at);
    for key in [0, 1, 2, 3].map(|i| TileKey::new(i % 2, i / 2)) {
        let part = changed.terrain.rect(key).meets(pit).unwrap();
        changed.change(part, |p| at(p) - 0.3, Some(SurfaceClass::Unspecified));
    }
    let mut anew = Bench::new(SIDE as u32, [[0, 0], [2, 2]], dug);
    assert_eq!(changed.terrain.hash, anew.terrain.hash);
    for _ in 0..300 {
        changed.step(20.0, 0.1);
        anew.step(20.0, 0.1);
    }
    let state = |b: &Bench| toml::to_string(&SavedTiles::of(&b.water, &b.terrain, false)).unwrap();
    assert_eq!(state(&changed), state(&anew));
}

#[test]
fn a_raised_floor_lifts_its_water_over_the_rim() {
    // A trench of 8 x 3 cells, half a metre deep, across the border of two tiles in a plain that slopes gently to the
    // east.
    let trench = CellRect { low: [28, 10], high: [36, 13] };
    let plain = |p: [i32; 2]| -0.002 * p[0] as f32;
    let ground = |p: [i32; 2]| if trench.cells().any(|c| c == p) { -0.5 } else { plain(p) };
    let mut bench = Bench::new(SIDE as u32, [[0, 0], [2, 1]], ground);
    for _ in 0..2000 {
        bench.step(30.0, 0.0);
    }
    assert!((bench.at([30, 11]).standing_mm - 430.0).abs() < 10.0, "{:?}", bench.at([30, 11]));
    let (before, gone) = (bench.water.lakes.total(), bench.gone);
    bench.change(trench, |_| -0.2, Some(SurfaceClass::Soil));
    bench.holds_its_water("raised");
    let spilled = bench.gone - gone;
    assert!((before - bench.water.lakes.total() - spilled).abs() < 1e-6 * before);
    assert!((spilled / (24.0 * 300.0) - 1.0).abs() < 0.02, "{spilled} mm times cells went over the rim");
    assert!((bench.at([30, 11]).standing_mm - 130.0).abs() < 10.0, "{:?}", bench.at([30, 11]));
}

#[test]
fn saved_water_goes_on_to_the_bit_and_damage_is_refused() {
    let size = 2 * SIDE as usize;
    let heights = rough(size, size, 7);
    let at = |[x, y]: [i32; 2]| heights[y as usize * size + x as usize];
    let mut first = Bench::new(SIDE as u32, [[0, 0], [2, 2]], at);
    first.change(CellRect { low: [20, 20], high: [40, 30] }, |p| at(p) - 0.2, Some(SurfaceClass::Paved));
    for i in 0..400 {
        first.step(if i < 250 { 18.0 } else { 0.0 }, 0.4);
    }
    let saved = |b: &Bench, hash| toml::to_string(&SavedTiles::of(&b.water, &b.terrain, hash)).unwrap();
    let text = saved(&first, false);
    let read = |text: &str, terrain: &Terrain| toml::from_str::<SavedTiles>(text).unwrap().water(Some(terrain));
    let water = read(&text, &first.terrain).unwrap();
    let mut second = Bench { world: world(), terrain: first.terrain.clone(), water, fallen: 0.0, gone: 0.0 };
    assert_eq!(saved(&second, false), text);
    assert_eq!(saved(&second, true), saved(&first, true));
    for i in 0..300 {
        let rain = if i > 100 { 12.0 } else { 0.0 };
        first.step(rain, 0.3);
        second.step(rain, 0.3);
    }
    assert_eq!(saved(&second, false), saved(&first, false));
    assert_eq!(saved(&second, true), saved(&first, true));
    let held = text.lines().find(|l| l.starts_with("held")).unwrap();
    let lakes = text.lines().find(|l| l.starts_with("lakes")).unwrap();
    let water = text.lines().find(|l| l.starts_with("water")).unwrap();
    for (from, to) in [
        (held, "held = \"7ff8000000000000\"".to_string()),
        (held, "held = \"\"".into()),
        (lakes, "lakes = \"\"".into()),
        (lakes, lakes.replacen("lakes = \"1 ", "lakes = \"2 ", 1)),
        (lakes, lakes.replacen("lakes = \"1 ", "lakes = \"ffffffffffffffff ", 1)),
        (water, "water = \"AAAA\"".into()),
        (water, water.replacen("water = \"", "water = \"/////w", 1)),
    ] {
        let broken = text.replacen(from, &to, 1);
        assert_ne!(broken, text, "{to}");
        assert!(read(&broken, &first.terrain).is_err(), "{to}");
    }
    let mut other = first.terrain.clone();
    other.remove(TileKey::new(1, 0)).unwrap();
    let e = read(&text, &other).err().unwrap().to_string();
    assert!(e.contains("tile (1, 0) must be set as it was"), "{e}");
    first.change(CellRect { low: [3, 3], high: [4, 4] }, |p| at(p) + 1.0, Some(SurfaceClass::Unspecified));
    let e = read(&text, &first.terrain).err().unwrap().to_string();
    assert!(e.contains("tile (0, 0) has other cells here"), "{e}");
}

/// Creates `tiles` by `tiles` tiles of rough hills, each of 256 by 256 cells.
fn hills(tiles: i32) -> Bench {
    let patch = rough(256, 256, 8);
    Bench::new(256, [[0, 0], [tiles, tiles]], move |[x, y]| {
        patch[((y & 255) * 256 + (x & 255)) as usize] + 0.05 * ((x + y) % 97) as f32
    })
}

/// Returns the duration of the fastest of 24 changes of `side` by `side` cells at different places, s.
fn change_s(bench: &mut Bench, side: i32) -> f64 {
    let mut fastest = f64::INFINITY;
    for i in 0..24 {
        let low = [70 + 3 * i, 90 + 2 * i];
        let heights: Vec<f32> = (0..side * side).map(|c| 0.01 * ((c + i) % 7) as f32 - 0.5).collect();
        let cells = TerrainCells {
            first: low.map(|v| v as u32),
            size: [side as u32; 2],
            heights_m: Rows::of(&heights),
            ..TerrainCells::default()
        };
        let begun = Instant::now();
        let rect = bench.terrain.update(&cells).unwrap().unwrap();
        bench.follow(rect, false);
        fastest = fastest.min(begun.elapsed().as_secs_f64());
    }
    fastest
}

/// Returns the number of tiles along a side of the large terrain: 4, or 16 (4096 cells) with `WELKIN_ACCEPT=1`.
fn large() -> i32 {
    if std::env::var_os("WELKIN_ACCEPT").is_some() { 16 } else { 4 }
}

#[test]
fn a_change_takes_as_long_as_its_rectangle_is_large() {
    let (mut small, mut big) = (hills(1), hills(large()));
    for bench in [&mut small, &mut big] {
        (0..30).for_each(|_| {
            bench.step(20.0, 0.0);
        });
    }
    let one = change_s(&mut small, 16);
    let many = change_s(&mut big, 16);
    let wide = change_s(&mut big, 96);
    let heights: Vec<f32> = rough(256, 256, 3);
    let key = TileKey::new(large(), 0);
    let begun = Instant::now();
    let removed = big.terrain.remove(TileKey::new(0, 0)).unwrap();
    big.follow(removed, true);
    let added = TerrainCells { key, heights_m: Rows::of(&heights), ..TerrainCells::default() };
    let rect = big.terrain.set_tile(&added).unwrap().unwrap();
    big.follow(rect, false);
    println!("a tile of 256 x 256 cells less and one more: {:.1} ms", begun.elapsed().as_secs_f64() * 1e3);
    let begun = Instant::now();
    big.step(20.0, 0.0);
    println!("a step of all of it in rain: {:.1} ms", begun.elapsed().as_secs_f64() * 1e3);
    println!(
        "16 x 16 cells: {:.3} ms on 256 x 256, {:.3} ms on {n} x {n}; 96 x 96 cells: {:.3} ms",
        one * 1e3,
        many * 1e3,
        wide * 1e3,
        n = 256 * large(),
    );
    // The large terrain has at least 16 times the cells; the factor 3 allows for other work on the machine.
    assert!(many < 3.0 * one, "{many} s on the large terrain, {one} s on the small one");
    assert!(wide > 2.0 * many && wide < 72.0 * many, "36 times the cells: {wide} s after {many} s");
}

#[test]
fn tiles_at_rest_cost_nothing() {
    let mut none = Bench::new(32, [[0, 0], [0, 0]], |_| 0.0);
    let mut many = Bench::new(32, [[0, 0], [8, 8]], |p| 0.01 * p[0] as f32);
    let seconds = |bench: &mut Bench| {
        bench.step(0.0, 0.1);
        // Fastest of ten batches: other work on the machine only slows batches down.
        let batch = |_| {
            let begun = Instant::now();
            (0..40).for_each(|_| {
                bench.step(0.0, 0.1);
            });
            begun.elapsed().as_secs_f64() / 40.0
        };
        (0..10).map(batch).fold(f64::INFINITY, f64::min)
    };
    let (empty, quiet) = (seconds(&mut none), seconds(&mut many));
    println!("a step: {:.2} us without tiles, {:.2} us with 64 dry ones", empty * 1e6, quiet * 1e6);
    assert!(!many.step(0.0, 0.1).changes);
    assert!(quiet - empty < 2e-5, "{quiet} s for 64 tiles at rest");
}
