//! Terrain in tiles through the C interface.

use std::ptr::{null, null_mut};

use super::world::{World, init, message, update};
use welkin::capi::{
    context::*, ground::*, ground_grid::*, status::*, terrain::*, timeline::*, weather::*, weather_kinds::*,
};

const SIDE: usize = 32;
const CELL: u32 = size_of::<wk_ground_cell>() as u32;
const POINT: u32 = size_of::<wk_terrain_point>() as u32;

fn simulated(world: &World) -> *mut wk_context {
    let simulation = wk_simulation_desc { ground_model: WK_GROUND_SIMULATED, ..init("wk_simulation_desc") };
    let desc = wk_context_desc { next: (&raw const simulation).cast(), ..init("wk_context_desc") };
    let mut context = null_mut();
    // SAFETY: live pointers.
    assert_eq!(unsafe { wk_context_create(world.device, &desc, &mut context) }, WK_OK, "{}", message());
    context
}

#[track_caller]
fn refused(status: wk_status, wanted: &str) {
    assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{wanted}: {}", message());
    assert!(message().contains(wanted), "{wanted}: {}", message());
}

/// A tile of these heights.
fn tile(tile: [i32; 2], heights: &[f32]) -> wk_terrain_cells {
    let (heights_m, height_count) = (heights.as_ptr(), heights.len() as u32);
    wk_terrain_cells { tile, heights_m, height_count, ..init("wk_terrain_cells") }
}

/// Two tiles with a trench of 4 x 2 cells across their border, in rain; the bucket then fills a part of it.
#[test]
fn tiles_get_wet_join_and_are_dug() {
    let world = World::new();
    let context = simulated(&world);
    let weather =
        wk_weather { precipitation_kind: WK_PRECIPITATION_RAIN, precipitation_rate_mm_h: 20.0, ..init("wk_weather") };
    let terrain = wk_terrain { tile_cells: SIDE as u32, ..init("wk_terrain") };
    let (mut west, mut east) = ([0.0f32; SIDE * SIDE], [0.0f32; SIDE * SIDE]);
    for row in [15, 16] {
        (west[row * SIDE + 30], west[row * SIDE + 31]) = (-0.3, -0.3);
        (east[row * SIDE], east[row * SIDE + 1]) = (-0.3, -0.3);
    }
    let mut cells = vec![wk_ground_cell { film_mm: 9.0, soaked: 9.0, standing_mm: 9.0, ice: 9.0 }; SIDE * SIDE];
    let (mut revision, mut water) = (9u64, 0u64);
    // SAFETY, for all: live pointers with the sizes given.
    unsafe {
        assert_eq!(wk_context_set_weather(context, &weather, 0.0, 0.0), WK_OK, "{}", message());
        assert_eq!(wk_context_set_terrain_tile(context, &tile([0, 0], &west)), WK_ERROR_WRONG_ORDER);
        assert!(message().contains("wk_context_set_terrain"), "{}", message());
        assert_eq!(wk_context_get_terrain_revision(context, &mut revision), WK_OK);
        assert_eq!(revision, 0);
        assert_eq!(wk_context_set_terrain(context, &terrain), WK_OK, "{}", message());
        assert_eq!(wk_context_set_terrain_tile(context, &tile([0, 0], &west)), WK_OK, "{}", message());
        assert_eq!(wk_context_set_terrain_tile(context, &tile([1, 0], &east)), WK_OK, "{}", message());
        assert_eq!(wk_context_get_terrain_revision(context, &mut revision), WK_OK);
        assert_eq!(revision, 3);
    }
    update(context, 3600.0);
    let get = |cells: &mut [wk_ground_cell], key: [i32; 2], water: &mut u64| unsafe {
        wk_context_get_terrain_water(context, key[0], key[1], cells.as_mut_ptr(), cells.len() as u32, CELL, water)
    };
    refused(get(&mut cells[..1000], [0, 0], &mut water), "capacity must be at least 1024");
    refused(get(&mut cells, [0, 1], &mut water), "tile_east must be with tile_north the key of a tile that was set");
    assert_eq!(get(&mut cells, [0, 0], &mut water), WK_OK, "{}", message());
    let deep = cells[15 * SIDE + 31].standing_mm;
    assert!(deep > 20.0 && cells[SIDE].film_mm > 0.1 && cells[SIDE].standing_mm == 0.0, "{deep}");
    assert_eq!(get(&mut cells, [1, 0], &mut water), WK_OK, "{}", message());
    assert!((cells[16 * SIDE].standing_mm - deep).abs() < 1e-3, "one level on both sides of the border");
    // The bucket tips a metre of rock onto one cell of the trench.
    let (heap, rock, before) = ([1.0f32], [WK_SURFACE_CLASS_ROCK as u8], water);
    let update = wk_terrain_cells {
        tile: [1, 0],
        first_cell: [1, 15],
        cells: [1, 1],
        heights_m: heap.as_ptr(),
        height_count: 1,
        surface_classes: rock.as_ptr(),
        surface_class_count: 1,
        ..init("wk_terrain_cells")
    };
    assert_eq!(unsafe { wk_context_update_terrain(context, &update) }, WK_OK, "{}", message());
    assert_eq!(get(&mut cells, [1, 0], &mut water), WK_OK, "{}", message());
    assert!(water > before && cells[15 * SIDE + 1].standing_mm == 0.0 && cells[15 * SIDE].standing_mm > deep);
    let mut ground = init::<wk_ground>("wk_ground");
    assert_eq!(unsafe { wk_context_get_ground(context, &[33.0, 15.0, 1.0], &mut ground) }, WK_OK);
    assert!(ground.surface_class == WK_SURFACE_CLASS_ROCK && ground.in_puddle == 0);
    assert_eq!(unsafe { wk_context_get_ground(context, &[32.0, 15.0, 0.0], &mut ground) }, WK_OK);
    assert!(ground.in_puddle == 1 && (ground.water_mm / f64::from(cells[15 * SIDE].standing_mm) - 1.0).abs() < 1e-6);
    // A grid replaces the tiles.
    let heights = [0.0f32; 4];
    let grid = wk_ground_grid { heights_m: heights.as_ptr(), height_count: 4, ..init("wk_ground_grid") };
    assert_eq!(unsafe { wk_context_set_ground_grid(context, &grid) }, WK_OK, "{}", message());
    assert_eq!(unsafe { wk_context_get_terrain_revision(context, &mut revision) }, WK_OK);
    assert_eq!(revision, 0);
    assert_eq!(unsafe { wk_context_destroy(context) }, WK_OK);
}

#[test]
fn places_are_answered_by_tile_class_and_height() {
    let world = World::new();
    let context = simulated(&world);
    let terrain = wk_terrain { tile_cells: SIDE as u32, cell_m: 2.0, ..init("wk_terrain") };
    let heights: Vec<f32> = (0..SIDE * SIDE).map(|i| (i % SIDE) as f32 * 0.5).collect();
    let mut classes = [WK_SURFACE_CLASS_SOIL as u8; SIDE * SIDE];
    classes[5 * SIDE + 4] = WK_TERRAIN_HOLE as u8;
    let cells = wk_terrain_cells {
        surface_classes: classes.as_ptr(),
        surface_class_count: classes.len() as u32,
        ..tile([-1, 0], &heights)
    };
    let places = [[-61.0, 3.0, 50.0], [-56.0, 10.0, 0.0], [3.0, 3.0, 0.0]];
    let none = wk_terrain_point {
        height_m: 9.0,
        normal: [9.0; 3],
        revision: 9,
        tile: [9, 9],
        surface_class: 9,
        has_ground: 9,
    };
    let mut points = [none; 3];
    // SAFETY, for all: live pointers with the sizes given.
    unsafe {
        assert_eq!(wk_context_set_terrain(context, &terrain), WK_OK, "{}", message());
        assert_eq!(wk_context_set_terrain_tile(context, &cells), WK_OK, "{}", message());
        let get = |points: &mut [wk_terrain_point], places: *const [f64; 3], size: u32| {
            wk_context_get_terrain_at(context, places, 3, 24, points.as_mut_ptr(), size)
        };
        refused(get(&mut points, places.as_ptr(), 8), "point_size must be");
        refused(get(&mut points, null(), POINT), "positions_m must not be NULL");
        let torn = [places[0], [f64::NAN, 0.0, 0.0], places[2]];
        refused(get(&mut points, torn.as_ptr(), POINT), "positions_m[1]");
        assert_eq!(points[0].height_m, 9.0, "an error writes nothing");
        assert_eq!(get(&mut points, places.as_ptr(), POINT), WK_OK, "{}", message());
    }
    let [on, hole, off] = points;
    assert!((on.height_m - 0.75).abs() < 1e-9 && on.has_ground == 1, "{}", on.height_m);
    assert_eq!((on.tile, on.revision, on.surface_class), ([-1, 0], 2, WK_SURFACE_CLASS_SOIL));
    assert!(on.normal[2] > 0.0 && (on.normal.iter().map(|v| v * v).sum::<f64>() - 1.0).abs() < 1e-12);
    assert_eq!((hole.has_ground, off.has_ground, off.height_m), (0, 0, 0.0));
    assert_eq!(unsafe { wk_context_destroy(context) }, WK_OK);
}

#[test]
fn bad_terrains_are_refused_by_the_names_of_the_header() {
    let world = World::new();
    let context = simulated(&world);
    let heights = [0.0f32; SIDE * SIDE];
    let mut torn = heights;
    torn[40] = f32::INFINITY;
    let good = tile([0, 0], &heights);
    let classes = [8u8; 4];
    // SAFETY, for all: live pointers with the sizes given.
    unsafe {
        let set = |terrain: &wk_terrain| wk_context_set_terrain(context, terrain);
        let new = || init::<wk_terrain>("wk_terrain");
        refused(
            set(&wk_terrain { tile_cells: 100, ..new() }),
            "terrain.tile_cells must be a power of two from 32 to 1024",
        );
        refused(set(&wk_terrain { cell_m: 0.0, ..new() }), "terrain.cell_m must be in [0.01, 10000]");
        refused(set(&wk_terrain { reserved0: 1, ..new() }), "terrain.reserved0 must be 0");
        assert_eq!(set(&wk_terrain { tile_cells: SIDE as u32, ..new() }), WK_OK, "{}", message());
        for (bad, name) in [
            (tile([0, 0], &torn), "heights_m[40] must be finite and within 100000 m, got inf"),
            (wk_terrain_cells { height_count: 1023, ..good }, "height_count must be at least 1024"),
            (wk_terrain_cells { height_stride: 31, ..good }, "height_stride must be 0, or at least 32"),
            (wk_terrain_cells { cells: [33, 1], ..good }, "cells[0] must be at least one cell"),
            (wk_terrain_cells { heights_m: null(), ..good }, "heights_m must not be NULL"),
            (
                wk_terrain_cells { surface_classes: classes.as_ptr(), surface_class_count: 4, ..good },
                "surface_classes[0] must be a WK_SURFACE_CLASS_ value, 0 to 6, or WK_TERRAIN_HOLE, got 8",
            ),
            (wk_terrain_cells { tile: [0, -1_000_001], ..good }, "tile[1] must be in [-1000000, 1000000]"),
        ] {
            let wanted = format!("terrain_cells.{name}");
            refused(wk_context_set_terrain_tile(context, &bad), &wanted);
            refused(wk_context_update_terrain(context, &bad), &wanted);
        }
        refused(wk_context_update_terrain(context, &good), "terrain_cells.tile must be the key of a tile that was set");
        refused(wk_context_remove_terrain_tile(context, 3, 4), "tile_east must be the key of a tile that was set");
        let mut revision = 0;
        assert_eq!(wk_context_get_terrain_revision(context, &mut revision), WK_OK);
        assert_eq!(revision, 1, "nothing has changed");
        assert_eq!(wk_context_set_terrain_tile(context, &good), WK_OK, "{}", message());
        assert_eq!(wk_context_remove_terrain_tile(context, 0, 0), WK_OK, "{}", message());
        assert_eq!(wk_context_destroy(context), WK_OK);
    }
}

/// Cells without data, named or in holes.
#[test]
fn numbers_that_the_host_names_as_no_data_make_holes() {
    let world = World::new();
    let context = simulated(&world);
    let terrain = wk_terrain { tile_cells: SIDE as u32, ..init("wk_terrain") };
    let mut heights = [2.0f32; SIDE * SIDE];
    (heights[0], heights[1], heights[40]) = (-9999.0, f32::NAN, -9999.0);
    let mut classes = [0u8; SIDE * SIDE];
    let place = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [8.0, 1.0, 0.0], [5.0, 5.0, 0.0]];
    let mut points = [wk_terrain_point {
        height_m: 9.0,
        normal: [9.0; 3],
        revision: 9,
        tile: [9; 2],
        surface_class: 9,
        has_ground: 9,
    }; 4];
    // SAFETY, for all: live pointers with the sizes given.
    let mut has_ground = || unsafe {
        let answer = wk_context_get_terrain_at(context, place.as_ptr(), 4, 24, points.as_mut_ptr(), POINT);
        assert_eq!(answer, WK_OK, "{}", message());
        points.map(|p| p.has_ground)
    };
    let set = |cells: &wk_terrain_cells| unsafe { wk_context_set_terrain_tile(context, cells) };
    unsafe { assert_eq!(wk_context_set_terrain(context, &terrain), WK_OK, "{}", message()) };
    let plain = tile([0, 0], &heights);
    refused(set(&plain), "terrain_cells.heights_m[1] must be finite and within 100000 m, got NaN");
    let named = wk_terrain_cells { has_no_data: 1, no_data_m: -9999.0, ..plain };
    assert_eq!(set(&named), WK_OK, "{}", message());
    assert_eq!(has_ground(), [0, 0, 0, 1]);
    // The value for "no data" must not be a height in use: of a cell that its class says is ground, or of a cell
    // outside the rectangle.
    classes[77] = WK_SURFACE_CLASS_ROCK as u8;
    let said = wk_terrain_cells {
        no_data_m: 2.0,
        surface_classes: classes.as_ptr(),
        surface_class_count: classes.len() as u32,
        ..named
    };
    refused(set(&said), "terrain_cells.no_data_m must be no height in use, such as terrain_cells.heights_m[77]");
    let update = wk_terrain_cells { first_cell: [4, 4], cells: [1, 1], height_count: 1, no_data_m: 2.0, ..named };
    let status = unsafe { wk_context_update_terrain(context, &update) };
    refused(status, "terrain_cells.no_data_m must be no height in use, such as that of cell (2, 0)");
    // Cells of the hole class are holes, whatever their heights are.
    (classes[0], classes[1], classes[40]) = (WK_TERRAIN_HOLE as u8, WK_TERRAIN_HOLE as u8, 0);
    let surface_classes = classes.as_ptr();
    let holes = wk_terrain_cells { has_no_data: 0, no_data_m: 0.0, surface_classes, ..said };
    assert_eq!(set(&holes), WK_OK, "{}", message());
    assert_eq!(has_ground(), [0, 0, 1, 1]);
    unsafe { assert_eq!(wk_context_destroy(context), WK_OK) };
}
