//! Tiles as data: found, changed by rectangles, refused by name.

use glam::{DVec2, DVec3};

use super::*;
use crate::scene::WorldFrame;

const SIDE: u32 = 32;

fn desc() -> TerrainDesc {
    TerrainDesc { origin: DVec3::new(10.0, -20.0, 5.0), cell_m: 2.0, tile_cells: SIDE }
}

/// A plane that rises to the east and the north, in steps that single precision holds.
fn plane(x: i32, y: i32) -> f32 {
    0.25 * x as f32 + 0.5 * y as f32
}

fn heights(key: TileKey) -> Vec<f32> {
    let side = SIDE as i32;
    let at = |i: i32| plane(key.east * side + i % side, key.north * side + i / side);
    (0..side * side).map(at).collect()
}

/// Four tiles about the origin.
fn four() -> Terrain {
    let mut terrain = Terrain::new(desc(), &WorldFrame::default()).unwrap();
    for key in [TileKey::new(0, 0), TileKey::new(-1, 0), TileKey::new(0, -1), TileKey::new(-1, -1)] {
        let heights = heights(key);
        let cells = TerrainCells { key, heights_m: Rows::of(&heights), ..TerrainCells::default() };
        terrain.set_tile(&cells).unwrap();
    }
    terrain
}

#[test]
fn heights_go_on_over_the_borders_of_tiles() {
    let terrain = four();
    for at in [[-0.5, -0.25], [0.0, 0.0], [-0.001, 7.5], [12.25, -31.9], [-32.0, 31.0], [30.9, -0.5]] {
        let got = terrain.height_at(DVec2::from(at)).unwrap();
        assert!((got - (0.25 * at[0] + 0.5 * at[1])).abs() < 1e-9, "{at:?}: {got}");
    }
    let place = DVec3::new(10.0 - 3.0, -20.0 + 1.0, 40.0);
    let point = terrain.point_at(place).unwrap();
    assert!((point.height_m - (0.25 * -1.5 + 0.5 * 0.5)).abs() < 1e-9, "{point:?}");
    assert_eq!((point.tile, point.revision), (TileKey::new(-1, 0), 3));
    for at in [[32.0, 0.0], [-32.6, 0.0], [f64::NAN, 0.0], [1e300, 0.0]] {
        assert_eq!(terrain.height_at(DVec2::from(at)), None, "{at:?}");
    }
    assert_eq!(terrain.height_near(DVec2::new(1e9, -1e9)), Some(f64::from(plane(31, -32))));
}

#[test]
fn every_cell_has_the_neighbours_that_lie_about_it() {
    let terrain = four();
    for at in [[0, 0], [-1, -1], [31, 5], [-32, -32], [7, 8], [-1, 30]] {
        let id = terrain.cell_at(at).unwrap();
        assert_eq!(terrain.place(id), at);
        assert_eq!(terrain.height(id), plane(at[0], at[1]));
        for ([dx, dy], near) in AROUND.into_iter().zip(terrain.around(id)) {
            assert_eq!(near, terrain.cell_at([at[0] + dx, at[1] + dy]), "{at:?} {dx} {dy}");
        }
    }
    let edge = terrain.cell_at([31, 5]).unwrap();
    assert_eq!(terrain.around(edge).iter().filter(|n| n.is_none()).count(), 3);
}

#[test]
fn a_rectangle_changes_its_cells_alone_and_hashes_follow() {
    let mut terrain = four();
    let (before, copy) = (terrain.hash, terrain.clone());
    let key = TileKey::new(-1, 0);
    // Rows of five values, of which the first three lie in the rectangle.
    let (values, classes) = ([9.0f32; 10], [Some(SurfaceClass::Rock); 6]);
    let cells = TerrainCells {
        key,
        first: [4, 30],
        size: [3, 2],
        heights_m: Rows { values: &values, stride: 5 },
        classes: Rows::of(&classes),
        no_data_m: None,
    };
    let rect = terrain.update(&cells).unwrap().unwrap();
    assert_eq!(rect, CellRect { low: [-28, 30], high: [-25, 32] });
    for [x, y] in terrain.rect(key).cells() {
        let inside = rect.cells().any(|c| c == [x, y]);
        let id = terrain.cell_at([x, y]).unwrap();
        assert_eq!(terrain.height(id), if inside { 9.0 } else { plane(x, y) });
    }
    let changed = terrain.tile(terrain.slot(key).unwrap());
    assert_eq!((changed.revision, terrain.revision), (6, 6));
    assert_eq!(copy.hash, before, "a copy stays as it was");
    assert_ne!(terrain.hash, before);
    let near = |t: &Terrain, x: f64| t.hash_within(DVec2::new(x, 0.0), DVec2::new(x + 1.0, 1.0));
    assert_ne!(near(&terrain, -30.0), near(&copy, -30.0));
    assert_eq!(near(&terrain, 600.0), near(&copy, 600.0), "far from it nothing has changed");
    // The old heights again: the hash depends only on the cells, not on how they were set.
    let old = heights(key);
    let none = vec![Some(SurfaceClass::Unspecified); old.len()];
    terrain
        .update(&TerrainCells { key, heights_m: Rows::of(&old), classes: Rows::of(&none), ..cells_of(key) })
        .unwrap();
    assert_eq!(terrain.hash, before);
    assert_eq!(terrain.update(&TerrainCells { key, heights_m: Rows::of(&old), ..cells_of(key) }).unwrap(), None);
    assert_eq!(terrain.revision, 7, "the same heights again are no change");
    terrain.remove(key).unwrap();
    assert!(terrain.cell_at([-1, 0]).is_none() && terrain.all().len() == 3);
    terrain.set_tile(&TerrainCells { key, heights_m: Rows::of(&old), ..cells_of(key) }).unwrap();
    assert_eq!(terrain.hash, before);
}

fn cells_of(key: TileKey) -> TerrainCells<'static> {
    TerrainCells { key, ..TerrainCells::default() }
}

#[test]
fn a_hole_takes_away_the_triangles_that_meet_it() {
    let mut terrain = four();
    let hole = [None];
    let cells = TerrainCells { first: [3, 3], size: [1, 1], classes: Rows::of(&hole), ..TerrainCells::default() };
    terrain.update(&cells).unwrap();
    assert_eq!(terrain.cell_at([3, 3]), None);
    assert_eq!(terrain.height_at(DVec2::new(3.2, 2.9)), None);
    assert_eq!(terrain.height_at(DVec2::new(3.0, 2.4)), None);
    assert!(terrain.height_at(DVec2::new(2.6, 2.2)).is_none() && terrain.height_at(DVec2::new(3.5, 3.4)).is_none());
    // Triangles without a corner at the hole stay, and so do the cells around it.
    let beside = terrain.height_at(DVec2::new(3.6, 2.4)).unwrap();
    assert!((beside - (0.25 * 3.6 + 0.5 * 2.4)).abs() < 1e-12, "{beside}");
    assert_eq!(terrain.height_at(DVec2::new(3.0, 2.0)), Some(f64::from(plane(3, 2))));
    let left = terrain.cell_at([2, 3]).unwrap();
    assert_eq!(terrain.around(left).iter().filter(|n| n.is_none()).count(), 1);
    let ground = [Some(SurfaceClass::Soil)];
    terrain.update(&TerrainCells { classes: Rows::of(&ground), ..cells }).unwrap();
    assert_eq!(terrain.height(terrain.cell_at([3, 3]).unwrap()), plane(3, 3), "the height was kept");
}

#[test]
fn bad_terrains_are_refused_by_name() {
    let new = |d: TerrainDesc| Terrain::new(d, &WorldFrame::default()).unwrap_err().to_string();
    for (bad, name) in [
        (TerrainDesc { origin: DVec3::splat(f64::NAN), ..desc() }, "terrain.origin_m must be finite"),
        (TerrainDesc { cell_m: f64::NAN, ..desc() }, "terrain.cell_m must be in [0.01, 10000] m, got NaN"),
        (TerrainDesc { tile_cells: 48, ..desc() }, "terrain.tile_cells must be a power of two from 32 to 1024"),
        (TerrainDesc { tile_cells: 2048, ..desc() }, "terrain.tile_cells must be a power of two"),
    ] {
        assert!(new(bad).contains(name), "{}", new(bad));
    }
    let mut terrain = four();
    let before = terrain.clone();
    let mut torn = vec![0.0; 1024];
    torn[77] = f32::NAN;
    let heights = vec![0.0; 1024];
    let all = TerrainCells { heights_m: Rows::of(&heights), ..TerrainCells::default() };
    let far = TileKey::new(2_000_000, 0);
    for (bad, name) in [
        (
            TerrainCells { heights_m: Rows::of(&torn), ..all },
            "heights_m[77] must be finite and within 100000 m, got NaN",
        ),
        (
            TerrainCells { first: [30, 0], size: [3, 1], ..all },
            "cells[0] must be at least one cell, and within the tile's 32",
        ),
        (TerrainCells { first: [0, u32::MAX], size: [1, u32::MAX], ..all }, "cells[1] must be"),
        (TerrainCells { size: [0, 4], ..all }, "cells[0] must be at least one cell"),
        (
            TerrainCells { heights_m: Rows { values: &heights, stride: 31 }, ..all },
            "heights_m_stride must be 0, or at least 32",
        ),
        (
            TerrainCells { heights_m: Rows { values: &heights, stride: 40 }, ..all },
            "heights_m.len must be at least 1272",
        ),
        (TerrainCells { classes: Rows::of(&[None; 3]), ..all }, "surface_classes.len must be at least 1024"),
        (TerrainCells { key: far, ..all }, "tile[0] must be in [-1000000, 1000000], got 2000000"),
    ] {
        for result in [terrain.set_tile(&bad), terrain.update(&bad)] {
            let e = result.unwrap_err().to_string();
            assert!(e.contains(&format!("terrain_cells.{name}")), "{name}: {e}");
        }
    }
    let unknown = terrain.update(&TerrainCells { key: TileKey::new(5, 6), ..all }).unwrap_err().to_string();
    assert!(unknown.contains("terrain_cells.tile must be the key of a tile that was set, got (5, 6)"), "{unknown}");
    let unknown = terrain.remove(TileKey::new(5, 6)).unwrap_err().to_string();
    assert!(unknown.starts_with("tile must be the key"), "{unknown}");
    let part = terrain.set_tile(&TerrainCells { size: [4, 4], ..all }).unwrap_err().to_string();
    assert!(part.contains("terrain_cells.cells must be the whole tile, 32 x 32"), "{part}");
    assert_eq!(terrain, before, "nothing has changed");
}

#[test]
fn a_terrain_holds_the_stated_number_of_tiles_and_no_more() {
    let big = TerrainDesc { tile_cells: 1024, ..desc() };
    let mut terrain = Terrain::new(big, &WorldFrame::default()).unwrap();
    assert_eq!(big.most_tiles(), 16);
    let heights = vec![0.0; 1024 * 1024];
    for i in 0..17 {
        let key = TileKey::new(i % 4, i / 4);
        let set = terrain.set_tile(&TerrainCells { key, heights_m: Rows::of(&heights), ..TerrainCells::default() });
        if i < 16 {
            set.unwrap();
        } else {
            let e = set.unwrap_err().to_string();
            assert!(e.contains("one of at most 16 tiles of 1024 x 1024, 16777216 cells"), "{e}");
        }
    }
}

#[test]
fn heights_of_holes_are_not_read_and_no_data_make_holes() {
    let mut terrain = Terrain::new(desc(), &WorldFrame::default()).unwrap();
    let key = TileKey::new(0, 0);
    let mut heights = vec![2.0_f32; 1024];
    let mut classes = vec![Some(SurfaceClass::Unspecified); 1024];
    // The height of a hole may be any number.
    for (cell, height) in [(3, f32::NAN), (4, f32::INFINITY), (5, 1e30), (6, -9999.0), (7, 5.0)] {
        (heights[cell], classes[cell]) = (height, None);
    }
    let all =
        TerrainCells { key, heights_m: Rows::of(&heights), classes: Rows::of(&classes), ..TerrainCells::default() };
    terrain.set_tile(&all).unwrap();
    let tile = terrain.tile(terrain.slot(key).unwrap());
    assert!(tile.heights_m.iter().all(|h| h.is_finite()) && (3..8).all(|cell| !tile.has_ground(cell)));
    assert_eq!((tile.has_ground(2), tile.heights_m[3], tile.heights_m[7]), (true, 0.0, 5.0));
    // An update of heights alone keeps the holes and ignores their heights. A cell that becomes ground needs a valid
    // height.
    terrain.update(&TerrainCells { classes: Rows::default(), ..all }).unwrap();
    let mut opened = classes.clone();
    opened[3] = Some(SurfaceClass::Unspecified);
    let e = terrain.update(&TerrainCells { classes: Rows::of(&opened), ..all }).unwrap_err().to_string();
    assert!(e.contains("terrain_cells.heights_m[3] must be finite and within 100000 m, got NaN"), "{e}");

    for none in [-9999.0, -32768.0, 0.0, f32::MAX, f32::NAN] {
        let key = TileKey::new(1, 0);
        let mut heights = vec![2.0_f32; 1024];
        (heights[0], heights[40]) = (none, none);
        let of = TerrainCells { key, heights_m: Rows::of(&heights), no_data_m: Some(none), ..TerrainCells::default() };
        let of = TerrainCells { no_data_m: Some(if none.is_nan() { -9999.0 } else { none }), ..of };
        terrain.set_tile(&of).unwrap();
        let tile = terrain.tile(terrain.slot(key).unwrap()).clone();
        let holes: Vec<_> = (0..1024).filter(|cell| !tile.has_ground(*cell)).collect();
        assert_eq!((holes, tile.heights_m[0]), (vec![0, 40], 0.0), "{none}");
        assert!(tile.heights_m[1..40].iter().all(|h| *h == 2.0));
        // Without `no_data_m` every number must be a valid height.
        terrain.remove(key).unwrap();
        let plain = terrain.clone().set_tile(&TerrainCells { no_data_m: None, ..of });
        assert_eq!(plain.is_ok(), none.abs() < 1e5, "{none}");
    }
}

#[test]
fn a_number_for_no_data_that_is_a_height_in_use_is_refused_by_name() {
    let mut terrain = Terrain::new(desc(), &WorldFrame::default()).unwrap();
    let key = TileKey::new(0, 0);
    let heights = vec![2.0_f32; 1024];
    let mut classes = vec![Some(SurfaceClass::Unspecified); 1024];
    classes[9] = Some(SurfaceClass::Rock);
    let all = TerrainCells { key, heights_m: Rows::of(&heights), ..TerrainCells::default() };
    let said = TerrainCells { classes: Rows::of(&classes), no_data_m: Some(2.0), ..all };
    let e = terrain.set_tile(&said).unwrap_err().to_string();
    assert_eq!(
        e,
        "terrain_cells.no_data_m must be no height in use, such as terrain_cells.heights_m[9] with a class of ground, got 2"
    );
    terrain.set_tile(&all).unwrap();
    let part =
        TerrainCells { first: [4, 4], size: [2, 2], heights_m: Rows::of(&[2.0; 4]), no_data_m: Some(2.0), ..all };
    let e = terrain.update(&part).unwrap_err().to_string();
    assert_eq!(e, "terrain_cells.no_data_m must be no height in use, such as that of cell (0, 0) of this tile, got 2");
    terrain.update(&TerrainCells { no_data_m: Some(3.0), ..part }).unwrap();
    for bad in [f32::NAN, f32::INFINITY] {
        let e = terrain.update(&TerrainCells { no_data_m: Some(bad), ..part }).unwrap_err().to_string();
        assert!(e.starts_with("terrain_cells.no_data_m must be finite"), "{e}");
    }
}
