//! Snow on terrain in tiles, through a context: equal to that on a grid of the same heights, independent of the steps
//! of time, kept by a saved state and by tiles that change, and drawn.

use std::time::Duration;

use glam::DVec3;
use welkin::{
    Status,
    context::{Context, ContextDesc, GivenDirection},
    frame::{Stages, View},
    ground::{GroundGrid, GroundModel, SurfaceClass},
    snowpack::{LyingSnowModel, SnowBalance, SnowStrip},
    terrain::{Rows, TerrainCells, TerrainDesc, TileKey},
    weather::{Precipitation, PrecipitationKind, Surface, Weather, Wind},
};

use crate::{
    hills::save,
    host::{Host, SIZE, ground, look},
    terrain::roof,
};

const SIDE: u32 = 32;
const KEYS: [TileKey; 4] = [
    TileKey { east: -1, north: -1 },
    TileKey { east: 0, north: -1 },
    TileKey { east: -1, north: 0 },
    TileKey { east: 0, north: 0 },
];

/// A hill beside the corner of four tiles, and waves.
fn height(x: i32, y: i32) -> f32 {
    let (x, y) = (f64::from(x), f64::from(y));
    (5.0 * (-((x - 3.0).powi(2) + (y + 2.0).powi(2)) / 60.0).exp() + 0.2 * (0.5 * x).sin() * (0.3 * y).cos()) as f32
}

fn heights(low: [i32; 2], size: [u32; 2]) -> Vec<f32> {
    (0..size[0] * size[1]).map(|i| height(low[0] + (i % size[0]) as i32, low[1] + (i / size[0]) as i32)).collect()
}

fn set_tile(context: &mut Context, key: TileKey) {
    let heights = heights([key.east, key.north].map(|k| k * SIDE as i32), [SIDE; 2]);
    context.set_terrain_tile(&TerrainCells { key, heights_m: Rows::of(&heights), ..TerrainCells::default() }).unwrap();
}

fn set_tiles(context: &mut Context) {
    context.set_terrain(Some(TerrainDesc { tile_cells: SIDE, ..TerrainDesc::default() })).unwrap();
    KEYS.iter().for_each(|key| set_tile(context, *key));
}

fn set_grid(context: &mut Context) {
    let low = [-(SIDE as i32); 2];
    let grid = GroundGrid {
        origin: DVec3::new(f64::from(low[0]), f64::from(low[1]), 0.0),
        cell_m: 1.0,
        nodes: [2 * SIDE; 2],
        heights_m: heights(low, [2 * SIDE; 2]),
        classes: Vec::new(),
    };
    context.set_ground_grid(Some(grid)).unwrap();
}

fn context(host: &Host) -> Context {
    let lying_snow = LyingSnowModel::Simulated;
    let desc = ContextDesc { lying_snow, ground: GroundModel::Simulated, seed: 7, ..ContextDesc::default() };
    let mut context = Context::new(host.device.clone(), host.context.shared().clone(), desc).unwrap();
    context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg: 20.0 })).unwrap();
    context
}

fn weather(temperature_c: f64, snow_mm_h: f64, wind_m_s: f64, from_deg: f64) -> Weather {
    Weather {
        temperature_c,
        precipitation: Precipitation::of(PrecipitationKind::Snow, snow_mm_h),
        surface: Surface { snow_depth_m: 0.2, ..Surface::default() },
        wind: Wind { gust_m_s: Some(wind_m_s), ..Wind::of(wind_m_s, from_deg) },
        ..Weather::default()
    }
}

/// Snow, a storm, another from the other side, a thaw, each for some hours; a wall over the border of two tiles.
fn days(host: &Host, set: impl Fn(&mut Context)) -> Context {
    let mut context = context(host);
    context.set_shelters(&[roof([-12.0, 8.0, 4.0], [5.0, 4.0, 0.2]), roof([6.0, 2.0, 1.0], [0.4, 9.0, 1.0])]).unwrap();
    context.set_weather(&weather(-5.0, 2.0, 12.0, 240.0), 0.0, 0.0).unwrap();
    context.set_weather(&weather(-8.0, 0.0, 15.0, 20.0), 6000.0, 300.0).unwrap();
    context.set_weather(&weather(6.0, 0.0, 4.0, 180.0), 30_000.0, 300.0).unwrap();
    set(&mut context);
    context
}

fn at(x: f64, y: f64) -> DVec3 {
    DVec3::new(x, y, 0.0)
}

fn is_balanced(b: &SnowBalance) -> bool {
    let should =
        b.began_kg + b.fallen_kg + b.blown_in_kg - b.blown_out_kg - b.ran_off_kg - b.sublimated_kg - b.taken_kg;
    (should - b.lying_kg).abs() < 1e-6 * b.began_kg
}

#[test]
fn snow_lies_on_tiles_as_on_a_grid_of_the_same_heights() {
    let host = Host::new();
    let (mut tiles, mut grid) = (days(&host, set_tiles), days(&host, set_grid));
    // 1000 steps: the last ones in the thaw.
    for end_s in [4000.0, 20_000.0, 60_000.0] {
        [&mut tiles, &mut grid].into_iter().for_each(|c| c.update(end_s).unwrap());
        let road = SnowStrip { points: vec![at(-20.0, -3.0), at(12.0, 5.0)], width_m: 3.0 };
        let taken = [&mut tiles, &mut grid].map(|c| c.take_snow(&road, 0.05).unwrap());
        let wheels = SnowStrip { points: vec![at(-2.0, -20.0), at(1.0, 20.0)], width_m: 0.5 };
        [&mut tiles, &mut grid].into_iter().for_each(|c| c.press_snow(&wheels).unwrap());
        assert!(taken[0] == taken[1] && taken[0] > 0.0, "{taken:?}");
        let books = tiles.snow_balance().unwrap();
        assert_eq!(books, grid.snow_balance().unwrap(), "after {end_s} s");
        assert!(is_balanced(&books), "{books:?}");
        for i in 0..400 {
            let place = DVec3::new(f64::from(i % 20) * 3.3 - 31.0, f64::from(i / 20) * 3.2 - 31.5, -1.0);
            assert_eq!(tiles.snow_at(place).unwrap(), grid.snow_at(place).unwrap(), "{place} after {end_s} s");
        }
        println!("after {end_s} s: {books:?}");
    }
    let b = tiles.snow_balance().unwrap();
    assert!(b.blown_in_kg > 0.0 && b.blown_out_kg > 0.0 && b.ran_off_kg > 0.0 && b.fallen_kg > 0.0, "{b:?}");
}

/// Makes a hole and fills it again, removes a tile, and removes another one and adds it again.
fn change(context: &mut Context) {
    for class in [None, Some(SurfaceClass::Rock)] {
        let classes = [class; 30];
        let cells = TerrainCells {
            key: KEYS[3],
            first: [4, 8],
            size: [6, 5],
            classes: Rows::of(&classes),
            ..TerrainCells::default()
        };
        context.update_terrain(&cells).unwrap();
    }
    let raised = [7.0; 9];
    let cells = TerrainCells {
        key: KEYS[3],
        first: [20, 20],
        size: [3, 3],
        heights_m: Rows::of(&raised),
        ..Default::default()
    };
    context.update_terrain(&cells).unwrap();
    context.remove_terrain_tile(KEYS[0]).unwrap();
    context.remove_terrain_tile(KEYS[2]).unwrap();
    set_tile(context, KEYS[2]);
}

#[test]
fn tiles_that_change_keep_the_snow_of_cells_that_stay_and_account_for_the_rest() {
    let host = Host::new();
    let mut context = days(&host, set_tiles);
    context.update(7000.0).unwrap();
    let (before, stays) = (context.snow_balance().unwrap(), context.snow_at(at(20.0, -20.0)).unwrap());
    let (hole, country) = (context.snow_at(at(8.0, 11.0)).unwrap(), context.snow_at(at(500.0, 0.0)).unwrap());
    let at_raised = context.snow_at(at(21.0, 21.0)).unwrap();
    assert!(hole.mass_kg_m2 > 1.0, "{hole:?}");
    change(&mut context);
    let after = context.snow_balance().unwrap();
    assert!(is_balanced(&after) && after.taken_kg > before.taken_kg + 2000.0, "{before:?} {after:?}");
    // The tile that was set again begins with the snow of level ground.
    let began = f64::from(SIDE * SIDE) * country.mass_kg_m2;
    assert!((after.began_kg - before.began_kg - began).abs() < 1e-6 * began, "{before:?} {after:?} {began}");
    assert_eq!(context.snow_at(at(-10.0, 20.0)).unwrap().depth_m, country.depth_m);
    assert_eq!(context.snow_at(at(20.0, -20.0)).unwrap(), stays);
    assert_eq!(context.snow_at(at(8.0, 11.0)).unwrap().depth_m, 0.0, "no snow is left of a hole");
    let raised = context.snow_at(at(21.0, 21.0)).unwrap();
    assert_eq!((raised.mass_kg_m2, raised.surface.z > 7.0), (at_raised.mass_kg_m2, true));
    // At the place of the removed tile there is the world's own ground.
    assert_eq!(context.snow_at(at(-20.0, -20.0)).unwrap().depth_m, country.depth_m);
    context.update(9000.0).unwrap();
    assert!(is_balanced(&context.snow_balance().unwrap()));
    context.set_terrain(None).unwrap();
    context.update(9100.0).unwrap();
    assert_eq!(context.snow_balance(), None);
}

#[test]
fn any_division_into_calls_lays_the_same_snow_whatever_is_changed_meanwhile() {
    let host = Host::new();
    let mut whole = days(&host, set_tiles);
    whole.update(7000.0).unwrap();
    change(&mut whole);
    whole.update(9000.0).unwrap();
    let mut parts = days(&host, set_tiles);
    let mut calls = 0;
    while parts.update_within(7000.0, Duration::ZERO).unwrap() == Status::Pending {
        calls += 1;
        if calls == 20 {
            change(&mut parts);
            assert!(is_balanced(&parts.snow_balance().unwrap()));
        }
    }
    while parts.update_within(9000.0, Duration::ZERO).unwrap() == Status::Pending {}
    assert!(calls > 100);
    assert_eq!(parts.snow_balance(), whole.snow_balance());
    assert_eq!(parts.state_hash().unwrap(), whole.state_hash().unwrap());
    assert!(parts.save().unwrap() == whole.save().unwrap());
}

#[test]
fn a_saved_snow_on_tiles_goes_on_as_if_nothing_had_been() {
    let host = Host::new();
    let mut first = days(&host, set_tiles);
    first.update(7777.5).unwrap();
    let (saved, hash) = (first.save().unwrap(), first.state_hash().unwrap());
    let mut second = context(&host);
    set_tiles(&mut second);
    second.update(300.0).unwrap();
    second.load(&saved).unwrap();
    assert_eq!(second.state_hash().unwrap(), hash);
    assert_eq!(second.snow_at(at(7.0, 3.0)).unwrap(), first.snow_at(at(7.0, 3.0)).unwrap());
    [&mut first, &mut second].into_iter().for_each(|c| c.update(9000.0).unwrap());
    assert_ne!(first.state_hash().unwrap(), hash);
    assert_eq!(first.state_hash().unwrap(), second.state_hash().unwrap());
    assert!(first.save().unwrap() == second.save().unwrap());
    assert_eq!(first.snow_balance(), second.snow_balance());
    // The hash covers the snow too.
    first.take_snow(&SnowStrip { points: vec![at(-9.0, -9.0), at(-9.0, -5.0)], width_m: 1.0 }, 0.0).unwrap();
    assert_ne!(first.state_hash().unwrap(), second.state_hash().unwrap());
}

#[test]
fn the_tiles_snow_is_drawn_where_it_lies() {
    let mut host = Host::new();
    let mut context = context(&host);
    context.set_weather(&weather(-5.0, 0.0, 0.0, 0.0), 0.0, 0.0).unwrap();
    set_tiles(&mut context);
    context.update(60.0).unwrap();
    // Across the border of two tiles.
    let road = SnowStrip { points: vec![at(-20.0, -22.0), at(20.0, -22.0)], width_m: 6.0 };
    context.take_snow(&road, 0.0).unwrap();
    host.view = View::new(&context).unwrap();
    host.context = context;
    let eye = DVec3::new(0.0, -22.0, 14.0);
    let camera = look(eye, 0.0, -90.0, 1.0);
    let shoot = |host: &mut Host| host.shoot(camera, Stages::SURFACE, |d| ground(eye, d, [900.0; 3]));
    let pixels = shoot(&mut host);
    let bright = |pixels: &[[f32; 4]], row: u32| {
        let row = &pixels[(row * SIZE.0) as usize..][40..120];
        row.iter().map(|p| f64::from(p[1])).sum::<f64>() / row.len() as f64
    };
    let (side, middle) = (bright(&pixels, SIZE.1 - 3), bright(&pixels, SIZE.1 / 2));
    assert!(side > 4.0 * middle && (middle / 900.0 - 1.0).abs() < 0.3, "{side} {middle}");
    // A later change by the plough is drawn, and a new view draws the same.
    host.context.take_snow(&SnowStrip { points: vec![at(-20.0, -27.5), at(20.0, -27.5)], width_m: 7.0 }, 0.0).unwrap();
    let again = shoot(&mut host);
    assert!(again != pixels && bright(&again, SIZE.1 - 3) < 0.5 * side, "{}", bright(&again, SIZE.1 - 3));
    host.view = View::new(&host.context).unwrap();
    assert!(again == shoot(&mut host));
    let seen = |p: &[f32; 4]| [0, 1, 2].map(|i| 255.0 * (f64::from(p[i]) / 2e4).clamp(0.0, 1.0).powf(1.0 / 2.2));
    save("snow_on_tiles", &again.iter().map(seen).collect::<Vec<_>>());
}

#[test]
fn water_and_snow_about_a_place_are_textures_for_the_hosts_own_materials() {
    let host = Host::new();
    let mut context = context(&host);
    let e = context.terrain_texture(DVec3::ZERO).unwrap_err();
    assert!(e.status == Status::WrongOrder && e.to_string().contains("no tile reaches into the window"), "{e}");
    context.set_weather(&weather(-5.0, 1.0, 12.0, 200.0), 0.0, 0.0).unwrap();
    set_tiles(&mut context);
    assert!(context.terrain_texture(DVec3::ZERO).unwrap().snow.is_none(), "before there is a state");
    context.update(3600.0).unwrap();
    let read = |texture: &wgpu::Texture| welkin::gpu::readback::rgba(&host.device, texture).unwrap();
    let look_at = |context: &mut Context, center: DVec3| {
        let asked = context.terrain_texture(center).unwrap();
        let (water, snow) = (read(&asked.texture), read(asked.snow.as_ref().unwrap()));
        // Cells on both sides of the borders, a hill, and a place without ground.
        for place in [at(-1.0, -1.0), at(0.0, -1.0), at(3.0, -2.0), at(31.0, 31.0), at(-32.0, 8.0), at(40.0, 3.0)] {
            let uv = asked.uv_from_world.map(|row| row.dot(place.extend(1.0)));
            let [x, y] = uv.map(|v| v * 512.0 - 0.5);
            assert!((x - x.round()).abs() < 1e-9 && (y - y.round()).abs() < 1e-9, "{x} {y}");
            let (texel, wet) =
                (snow[y as usize * 512 + x.round() as usize], water[y as usize * 512 + x.round() as usize]);
            let on = place.x < 32.0;
            let here = context.snow_at(place).unwrap();
            let wanted =
                [here.depth_m, here.density_kg_m3, here.wetness, here.albedo].map(|v| if on { v } else { 0.0 });
            let near = (0..4).all(|i| (f64::from(texel[i]) - wanted[i]).abs() <= 1e-3 * wanted[i]);
            assert!(near && (!on || wanted[0] > 0.0), "{place}: {texel:?} {wanted:?}");
            assert!(on || wet[..2] == [0.0; 2], "{place}: {wet:?}");
        }
        asked
    };
    let first = look_at(&mut context, DVec3::ZERO);
    let again = context.terrain_texture(DVec3::ZERO).unwrap();
    assert_eq!((again.revision, &again.texture, &again.snow), (first.revision, &first.texture, &first.snow));
    context.take_snow(&SnowStrip { points: vec![at(-20.0, 9.0), at(20.0, 9.0)], width_m: 3.0 }, 0.1).unwrap();
    let ploughed = look_at(&mut context, DVec3::ZERO);
    assert!(ploughed.revision > first.revision && ploughed.snow == first.snow);
    context.update(7200.0).unwrap();
    let moved = look_at(&mut context, at(100.0, -70.0));
    assert!(moved.uv_from_world != first.uv_from_world && moved.texture == first.texture);
    let e = context.terrain_texture(DVec3::splat(f64::NAN)).unwrap_err();
    assert!(e.status == Status::InvalidArgument && e.to_string().starts_with("center must be"), "{e}");
    assert!(context.terrain_texture(at(5000.0, 0.0)).is_err());
}
