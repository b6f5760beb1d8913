//! Terrain in tiles through a context: updated in several calls, saved and loaded, changed meanwhile, and drawn like a
//! grid of the same heights.

use std::time::Duration;

use glam::DVec3;
use welkin::{
    Status,
    context::Context,
    frame::{Stages, View},
    ground::{GroundCell, GroundGrid, SurfaceClass},
    rain::{AreaMotion, AreaShape, RainArea},
    terrain::{Rows, TerrainCells, TerrainDesc, TileKey},
    weather::{Weather, Wind},
};

use crate::{
    hills::save,
    host::{Host, SIZE, ground, look},
    terrain::{rain, roof, simulated},
};

const SIDE: u32 = 32;
const CELL_M: f64 = 0.5;

/// Gentle waves with hollows of some centimetres, at a cell of the lattice.
fn height(x: i32, y: i32) -> f32 {
    let (x, y) = (f64::from(x) * CELL_M, f64::from(y) * CELL_M);
    (0.08 * (0.9 * x + 0.4).cos() * (0.7 * y).cos() - 0.002 * y) as f32
}

/// Heights of a rectangle of cells.
fn heights(low: [i32; 2], size: [u32; 2], raised_m: f32) -> Vec<f32> {
    let at = |i: u32| height(low[0] + (i % size[0]) as i32, low[1] + (i / size[0]) as i32) + raised_m;
    (0..size[0] * size[1]).map(at).collect()
}

fn corner(key: TileKey) -> [i32; 2] {
    [key.east, key.north].map(|k| k * SIDE as i32)
}

const KEYS: [TileKey; 4] = [
    TileKey { east: -1, north: -1 },
    TileKey { east: 0, north: -1 },
    TileKey { east: -1, north: 0 },
    TileKey { east: 0, north: 0 },
];

fn set_tile(context: &mut Context, key: TileKey) {
    let heights = heights(corner(key), [SIDE; 2], 0.0);
    context.set_terrain_tile(&TerrainCells { key, heights_m: Rows::of(&heights), ..TerrainCells::default() }).unwrap();
}

/// Four tiles about the origin.
fn set_tiles(context: &mut Context) {
    let desc = TerrainDesc { cell_m: CELL_M, tile_cells: SIDE, ..TerrainDesc::default() };
    context.set_terrain(Some(desc)).unwrap();
    KEYS.iter().for_each(|key| set_tile(context, *key));
}

/// A bucket that raises or lowers a rectangle of a tile.
fn dig(context: &mut Context, key: TileKey, first: [u32; 2], raised_m: f32) {
    let size = [10, 7];
    let low = [0, 1].map(|i| corner(key)[i] + first[i] as i32);
    let heights = heights(low, size, raised_m);
    let cells = TerrainCells { key, first, size, heights_m: Rows::of(&heights), ..TerrainCells::default() };
    context.update_terrain(&cells).unwrap();
}

fn water(context: &Context) -> Vec<GroundCell> {
    KEYS.iter().filter_map(|key| context.terrain_water(*key)).flatten().collect()
}

/// Showers and sun on the tiles, an area over a part of them, a roof.
fn day(host: &Host) -> Context {
    let mut context = simulated(host);
    let clear = Weather { wind: Wind::of(6.0, 200.0), ..Weather::preset("clear").unwrap() };
    for hour in 0..2 {
        let start_s = f64::from(hour) * 3600.0;
        context.set_weather(&rain(12.0, 4.0), start_s + 100.0, 137.0).unwrap();
        context.set_weather(&clear, start_s + 1500.0, 61.0).unwrap();
    }
    context.set_shelters(&[roof([-6.0, 4.0, 4.0], [3.0, 2.0, 0.2])]).unwrap();
    let area = RainArea {
        center_m: [16.0, 0.0, 0.0],
        shape: AreaShape::Ellipse([10.0, 10.0]),
        rim_m: 5.0,
        rate_mm_h: 40.0,
        motion: AreaMotion::Own([-0.001, 0.0]),
        ..RainArea::default()
    };
    context.set_rain_areas(&[area]).unwrap();
    set_tiles(&mut context);
    context
}

/// Digs, removes a tile, and adds another one again with changes.
fn change(context: &mut Context) {
    dig(context, KEYS[3], [0, 12], -0.15);
    dig(context, KEYS[1], [20, 4], 0.3);
    context.remove_terrain_tile(KEYS[0]).unwrap();
    context.remove_terrain_tile(KEYS[2]).unwrap();
    set_tile(context, KEYS[2]);
}

#[test]
fn any_division_into_calls_gives_the_same_water_whatever_is_dug_meanwhile() {
    let host = Host::new();
    let mut whole = day(&host);
    whole.update(3005.0).unwrap();
    change(&mut whole);
    whole.update(5000.0).unwrap();
    assert!(water(&whole).iter().any(|c| c.standing_mm > 5.0));
    for most_us in [0, 200, 20_000] {
        let most = Duration::from_micros(most_us);
        let mut parts = day(&host);
        let mut calls = 0;
        while parts.update_within(3005.0, most).unwrap() == Status::Pending {
            calls += 1;
            if calls == 1 {
                change(&mut parts);
            }
        }
        if calls == 0 {
            change(&mut parts);
        }
        // Each call steps at least one tile, and exactly one if it has no time.
        assert!(most_us > 0 || calls == 4 * 300 - 1, "{calls}");
        while parts.update_within(5000.0, most).unwrap() == Status::Pending {}
        assert!(water(&parts) == water(&whole), "{most_us} us, {calls} calls");
        assert_eq!(parts.state_hash().unwrap(), whole.state_hash().unwrap(), "{most_us} us, {calls} calls");
        assert!(parts.save().unwrap() == whole.save().unwrap());
    }
}

#[test]
fn saved_tiles_go_on_where_the_host_has_set_them() {
    let host = Host::new();
    let mut first = day(&host);
    first.update(1234.5).unwrap();
    dig(&mut first, KEYS[3], [0, 12], -0.15);
    first.update(1800.0).unwrap();
    let saved = first.save().unwrap();
    let hash = first.state_hash().unwrap();
    first.update(2500.0).unwrap();
    assert_ne!(first.state_hash().unwrap(), hash, "water is in the hash");
    // Without the tiles, and with others, a state is refused by name.
    let mut second = simulated(&host);
    let e = second.load(&saved).unwrap_err();
    assert!(e.status == Status::InvalidArgument && e.to_string().contains("set the terrain and its tiles"), "{e}");
    set_tiles(&mut second);
    let e = second.load(&saved).unwrap_err();
    assert!(e.status == Status::InvalidArgument && e.to_string().contains("tile (0, 0) has other cells here"), "{e}");
    dig(&mut second, KEYS[3], [0, 12], -0.15);
    second.load(&saved).unwrap();
    assert_eq!(second.state_hash().unwrap(), hash);
    second.update(2500.0).unwrap();
    assert!(water(&first) == water(&second));
    assert_eq!(first.save().unwrap(), second.save().unwrap());
    // A state saved without tiles keeps the tiles, as wet as level ground. A state with a grid does not fit a context
    // with tiles.
    let mut bare = simulated(&host);
    bare.set_weather(&rain(12.0, 4.0), 0.0, 0.0).unwrap();
    bare.update(1000.0).unwrap();
    second.load(&bare.save().unwrap()).unwrap();
    assert_eq!(second.terrain_tiles().count(), 4);
    let level = bare.ground_water().unwrap();
    assert!(water(&second).iter().all(|c| (f64::from(c.film_mm) - level.film_mm).abs() < 1e-6));
    bare.set_ground_grid(Some(crate::terrain::grid())).unwrap();
    let e = second.load(&bare.save().unwrap()).unwrap_err();
    assert!(e.to_string().contains("remove the tiles of the terrain before"), "{e}");
}

#[test]
fn it_is_dry_under_a_roof_and_wet_in_hollows_over_borders() {
    let host = Host::new();
    let mut context = simulated(&host);
    context.set_weather(&rain(20.0, 0.0), 0.0, 0.0).unwrap();
    context.set_shelters(&[roof([-6.0, 4.0, 4.0], [3.0, 2.0, 0.2])]).unwrap();
    set_tiles(&mut context);
    context.update(1500.0).unwrap();
    let at = |x: f64, y: f64| context.ground_at(DVec3::new(x, y, 0.1)).unwrap();
    assert_eq!((at(-6.0, 4.0).water_mm, at(-6.0, 4.0).in_puddle), (0.0, false), "under the roof");
    assert!(at(10.0, 10.0).water_mm > 0.3, "{:?}", at(10.0, 10.0));
    // A hollow of the waves lies over the border of two tiles, at y = 0.
    let deep = [-0.5, 0.5].map(|y| at(3.0, y));
    assert!(deep.iter().all(|g| g.in_puddle), "{deep:?}");
    assert!(deep[0].puddles > 0.01 && deep[0].puddles < 0.6, "{deep:?}");
    // High above it, and beside it, queries return the world's ground.
    assert!(context.ground_at(DVec3::new(3.0, -4.4, 9.0)).unwrap().surface_class == SurfaceClass::Unspecified);
    let beside = context.ground_at(DVec3::new(40.0, 0.0, 0.0)).unwrap();
    assert_eq!(beside.film_mm, context.ground_water().unwrap().film_mm);
    // A reported ground, which is not simulated, is the same on tiles as on level ground.
    let mut reported = Host::new();
    set_tiles(&mut reported.context);
    reported.context.set_weather(&rain(20.0, 0.0), 0.0, 0.0).unwrap();
    let got = reported.context.ground_at(DVec3::new(3.0, -4.4, 0.0)).unwrap();
    assert!(got.film_mm > 0.1 && !got.in_puddle, "{got:?}");
}

/// Compares pictures of one ground, once as four tiles and once as a grid, seen across the borders of the tiles.
#[test]
fn a_wet_terrain_of_tiles_looks_like_the_grid_of_its_heights() {
    let mut host = Host::new();
    let camera = look(DVec3::new(0.3, -10.0, 1.8), 0.0, -14.0, 0.9);
    let mut shoot = |name: &str, set: &dyn Fn(&mut Context)| {
        let mut context = simulated(&host);
        context.set_default_surface_class(SurfaceClass::Paved);
        set(&mut context);
        context.set_weather(&rain(15.0, 0.0), 0.0, 0.0).unwrap();
        context.update(900.0).unwrap();
        let calm = Weather { wind: Wind::of(0.0, 0.0), ..Weather::preset("clear").unwrap() };
        context.set_weather(&calm, 900.0, 0.0).unwrap();
        context.update(1200.0).unwrap();
        host.view = View::new(&context).unwrap();
        host.context = context;
        let all = Stages::ALL;
        let asphalt = |d: DVec3| ground(camera.position, d, [1800.0, 1750.0, 1700.0]);
        let pixels = host.shoot(camera, all, asphalt);
        let shown: Vec<[f64; 3]> = pixels.iter().map(|p| [0, 1, 2].map(|i| shown(p[i]))).collect();
        save(name, &shown);
        shown
    };
    let tiles = shoot("tiles", &|context| set_tiles(context));
    let low = [-(SIDE as i32); 2];
    let grid = shoot("tiles_as_grid", &|context| {
        let grid = GroundGrid {
            origin: DVec3::new(f64::from(low[0]), f64::from(low[1]), 0.0) * CELL_M,
            cell_m: CELL_M,
            nodes: [2 * SIDE; 2],
            heights_m: heights(low, [2 * SIDE; 2], 0.0),
            classes: Vec::new(),
        };
        context.set_ground_grid(Some(grid)).unwrap();
    });
    let bare = shoot("tiles_none", &|_| {});
    // The lower half lies on the terrain, well within its border.
    let half = (SIZE.0 * SIZE.1 / 2) as usize;
    let far = |a: &[[f64; 3]], b: &[[f64; 3]]| {
        let off =
            |(p, q): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|i| (p[i] - q[i]).abs()).into_iter().fold(0.0, f64::max);
        let mut all: Vec<f64> = a[half..].iter().zip(&b[half..]).map(off).collect();
        all.sort_by(f64::total_cmp);
        (all[all.len() / 2], all[all.len() * 99 / 100])
    };
    let (same, other) = (far(&tiles, &grid), far(&tiles, &bare));
    println!("of 255, half and 99 % of the pixels differ by at most {same:?} from the grid, {other:?} from no terrain");
    assert!(same.0 <= 1.0 && same.1 <= 4.0, "{same:?}");
    assert!(other.1 > 20.0, "{other:?}");
}

fn shown(v: f32) -> f64 {
    let v = f64::from(v).clamp(0.0, 1.0);
    255.0 * if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

#[test]
fn a_window_follows_the_camera_and_what_is_dug() {
    let mut host = Host::new();
    let mut context = simulated(&host);
    context.set_default_surface_class(SurfaceClass::Paved);
    set_tiles(&mut context);
    context.set_weather(&rain(15.0, 0.0), 0.0, 0.0).unwrap();
    context.update(600.0).unwrap();
    host.view = View::new(&context).unwrap();
    host.context = context;
    let camera = look(DVec3::new(0.3, -10.0, 1.8), 0.0, -14.0, 0.9);
    let surface = Stages::PREPARE.with(Stages::SURFACE);
    let asphalt = |d: DVec3| ground(camera.position, d, [1800.0, 1750.0, 1700.0]);
    let before = host.shoot(camera, surface, asphalt);
    assert!(before == host.shoot(camera, surface, asphalt), "nothing changes by itself");
    dig(&mut host.context, KEYS[1], [0, 14], 0.3);
    let dug = host.shoot(camera, surface, asphalt);
    assert!(dug != before, "a raised rectangle shows");
    // A new view draws the same.
    host.view = View::new(&host.context).unwrap();
    assert!(dug == host.shoot(camera, surface, asphalt), "what is uploaded by rectangles is all that there is");
    // The water is gone with its tile, and is not drawn from far away.
    host.context.remove_terrain_tile(KEYS[1]).unwrap();
    assert!(dug != host.shoot(camera, surface, asphalt));
}
