//! Drawn terrain on the software driver, against rays through every triangle of the ground.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::opaque::host::{Host, Mapped, ndc, pixels, view_of};
use crate::{
    chance::RandomStream,
    frame::Stages,
    gpu::Device,
    land::{TerrainDrawing, reference::ray_to_ground},
    scene::{Camera, ClipSpace, DepthKind, DepthMapping, depth::RANGE_SKY_M},
    terrain::{Rows, SurfaceClass, Terrain, TerrainCells, TerrainDesc, TileKey},
};

const ASPECT: f64 = 64.0 / 36.0;
const SIDE: u32 = 128;
/// Origin of the lattice in the host's world, m.
const ORIGIN: DVec3 = DVec3::new(-250.0, -260.0, 20.0);

/// Hills with a root mean square slope of about 0.3: sums of sines whose lengths and directions have no common period.
fn height(x: f64, y: f64) -> f64 {
    let mut sum = 0.0;
    for octave in 0..7 {
        let length = 300.0 * libm::pow(0.47, f64::from(octave));
        let (sine, cosine) = libm::sincos(1.1 * f64::from(octave));
        let (u, v) = (cosine * x + sine * y, cosine * y - sine * x);
        sum += 0.012 * length * (libm::sin(u * TAU / length) + libm::sin(v * TAU / (1.3 * length)));
    }
    sum
}

fn heights(key: TileKey, height: impl Fn(f64, f64) -> f64) -> Vec<f32> {
    let side = SIDE as i32;
    let at = |i: i32| [key.east * side + i % side, key.north * side + i / side].map(f64::from);
    (0..side * side).map(|i| height(at(i)[0], at(i)[1]) as f32).collect()
}

/// A host whose context draws 4 x 4 tiles with cells of this side and heights of cells as `height` says.
pub fn host_with(cell_m: f64, height: impl Fn(f64, f64) -> f64) -> Host {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float, wgpu::TextureFormat::Depth32Float, 1);
    let desc = TerrainDesc { origin: ORIGIN, cell_m, tile_cells: SIDE };
    host.context.set_terrain(Some(desc)).unwrap();
    for north in 0..4 {
        for east in 0..4 {
            let key = TileKey::new(east, north);
            let cells = heights(key, &height);
            let cells = TerrainCells { key, heights_m: Rows::of(&cells), ..TerrainCells::default() };
            host.context.set_terrain_tile(&cells).unwrap();
        }
    }
    host.context.set_terrain_drawing(Some(TerrainDrawing::default())).unwrap();
    host
}

/// A host with hills, in cells of 1 m.
fn host() -> Host {
    host_with(1.0, height)
}

/// Clears a host's picture to black and to the far depth 0.
pub fn clear_images(device: &Device, [color, depth]: [&wgpu::Texture; 2]) {
    let store = wgpu::StoreOp::Store;
    let mut encoder = device.device.create_command_encoder(&Default::default());
    let (color, depth) = (view_of(color), view_of(depth));
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &color,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    device.submit_and_wait(encoder).unwrap();
}

impl Host {
    fn terrain(&self) -> &Terrain {
        self.context.world.set.tiles.as_ref().expect("tiles are set")
    }

    fn draw(&mut self, case: &Mapped) {
        clear_images(&self.device, [&self.color, &self.depth]);
        self.record(case, Stages::SURFACE, |_| ());
    }
}

pub fn looking(eye: DVec3, forward: DVec3) -> Mapped {
    looking_through(eye, forward, 0.8)
}

/// Camera with a vertical field of view in radians.
pub fn looking_through(eye: DVec3, forward: DVec3, fov: f64) -> Mapped {
    let camera = Camera::look_to(eye, forward, DVec3::Z, fov, ASPECT, 0.2);
    let mapping = DepthMapping { kind: DepthKind::Perspective, reversed: true, clip: ClipSpace::ZeroToOne };
    Mapped { camera, mapping }
}

/// Vertical distance of a place from the ground, as pixels of a picture from `eye`; positive below the ground. `None`
/// beside the ground.
fn below_px(terrain: &Terrain, eye: DVec3, place: DVec3, pixel: f64) -> Option<f64> {
    let ground = terrain.height_at(DVec2::new(place.x, place.y) / terrain.desc.cell_m)?;
    let way = place - eye;
    let level = DVec2::new(way.x, way.y).length() / way.length();
    Some((ground - place.z) * level.max(0.05) / (way.length() * pixel))
}

/// Differences between the drawn ground and the true one at each pixel, pixels: how far a drawn place lies off the
/// ground, or how deep the ray passes through ground that was not drawn.
fn errors_px(host: &Host, case: &Mapped) -> Vec<f64> {
    let (rays, terrain, depths) = (case.rays(), host.terrain(), host.depths(0));
    let eye = case.camera.position - terrain.desc.origin;
    let pixel = rays.pixel_angle(36);
    pixels()
        .filter_map(|i| {
            let direction = rays.view_ray(ndc(i)).direction;
            let drawn = rays.view_range(f64::from(depths[i]), ndc(i));
            let truth = ray_to_ground(terrain, eye, direction, 2000.0);
            let off = |range: f64| below_px(terrain, eye, eye + direction * range, pixel);
            match truth {
                None if drawn >= RANGE_SKY_M => None,
                None => Some(off(drawn).map_or(0.0, f64::abs)),
                Some(range) => {
                    let end = drawn.min(range + 600.0);
                    let parts = if end > range { 64 } else { 0 };
                    let deepest = (1..parts)
                        .filter_map(|k| off(range + (end - range) * f64::from(k) / f64::from(parts)))
                        .fold(0.0, f64::max);
                    let own = if drawn < RANGE_SKY_M { off(drawn).map_or(0.0, f64::abs) } else { 0.0 };
                    Some(deepest.max(own))
                }
            }
        })
        .collect()
}

#[test]
fn the_ground_is_drawn_where_rays_through_every_triangle_meet_it() {
    let mut host = host();
    let mut all = Vec::new();
    let mut chance = RandomStream::new(3, 3);
    for view in 0..6 {
        let at = [chance.unit(), chance.unit()].map(|v| 60.0 + 380.0 * v);
        let over = [1.7, 4.0, 15.0, 60.0, 200.0, 900.0][view];
        let ground = host.terrain().height_at(at.into()).unwrap();
        let eye = ORIGIN + DVec3::new(at[0], at[1], ground + over);
        let towards = ORIGIN + DVec3::new(250.0, 250.0, 0.0) - eye;
        let down = if over < 50.0 { -0.04 } else { towards.z / towards.truncate().length() };
        let forward = DVec3::new(towards.x, towards.y, down * towards.truncate().length());
        // Pixels as large as those of a picture of 360 rows.
        let case = looking_through(eye, forward, 0.08);
        host.draw(&case);
        let errors = errors_px(&host, &case);
        assert!(errors.len() > 400, "view {view}: {} pixels of ground", errors.len());
        all.extend(errors);
    }
    all.sort_by(f64::total_cmp);
    let (held, worst) = (all[all.len() * 997 / 1000], all[all.len() - 1]);
    println!("{} pixels: 99.7 % within {held} px, all within {worst} px", all.len());
    assert!(held <= 1.0 && worst <= 1.5, "99.7 %: {held} px, worst: {worst} px");
}

#[test]
fn a_changed_rectangle_shows_in_the_next_frame() {
    let mut host = host();
    let eye = ORIGIN + DVec3::new(200.0, 180.0, 30.0);
    let case = looking(eye, DVec3::new(0.2, 1.0, -0.5));
    host.draw(&case);
    let before = (host.depths(0), host.colors());
    let written = host.view.effects.land.texels_written();
    // A mound of 30 x 30 cells in front of the camera.
    let bump = |v: i32| libm::sin(std::f64::consts::PI * f64::from(v) / 29.0).powi(2);
    let raised = |i: i32| {
        let ground = height(f64::from(200 + i % 30), f64::from(205 + i / 30));
        (ground + 6.0 * bump(i % 30) * bump(i / 30)) as f32
    };
    let raised: Vec<f32> = (0..900).map(raised).collect();
    let key = TileKey::new(1, 1);
    let cells =
        TerrainCells { key, first: [72, 77], size: [30, 30], heights_m: Rows::of(&raised), ..Default::default() };
    host.context.update_terrain(&cells).unwrap();
    host.draw(&case);
    let after = (host.depths(0), host.colors());
    let changed = pixels().filter(|i| before.0[*i] != after.0[*i]).count();
    assert!(changed > 200, "{changed} pixels");
    assert!(errors_px(&host, &case).iter().all(|e| *e < 1.5));
    let cost = host.view.effects.land.texels_written() - written;
    assert!(cost < 12 * 900, "{cost} texels for 900 cells");
    // Without a change nothing is written, and the picture rests once all shadow maps have the mound.
    (0..3).for_each(|_| host.draw(&case));
    let rests = (host.depths(0), host.colors());
    host.draw(&case);
    assert_eq!(host.view.effects.land.texels_written() - written, cost);
    assert!(rests == (host.depths(0), host.colors()) && rests.0 == after.0);
}

#[test]
fn the_finest_level_is_the_ground_of_the_queries() {
    let mut host = host();
    let ground = host.terrain().height_at(DVec2::new(201.3, 188.7)).unwrap();
    let eye = ORIGIN + DVec3::new(201.3, 188.7, ground + 15.0);
    let case = looking(eye, DVec3::new(0.01, 0.02, -1.0));
    host.draw(&case);
    let (rays, depths) = (case.rays(), host.depths(0));
    let mut worst: f64 = 0.0;
    for i in pixels() {
        let direction = rays.view_ray(ndc(i)).direction;
        let drawn = rays.view_range(f64::from(depths[i]), ndc(i));
        let place = eye + direction * drawn;
        let point = host.context.terrain_at(place).unwrap().unwrap();
        worst = worst.max((place.z - ORIGIN.z - point.height_m).abs());
        let [a, b] = [DVec3::X, DVec3::Y].map(|axis| host.context.terrain_at(place + axis * 1e-4).unwrap().unwrap());
        let facet = DVec3::new(point.height_m - a.height_m, point.height_m - b.height_m, 1e-4).normalize();
        if a.normal == point.normal && b.normal == point.normal {
            assert!((facet - point.normal).length() < 1e-6, "{facet} {point:?}");
        }
    }
    println!("within {worst} m");
    assert!(worst < 1e-3, "{worst} m");
}

#[test]
fn the_underside_of_the_ground_is_not_drawn() {
    let mut host = host();
    let ground = host.terrain().height_at(DVec2::new(201.3, 188.7)).unwrap();
    let below = ORIGIN + DVec3::new(201.3, 188.7, ground - 6.0);
    host.draw(&looking(below, DVec3::new(0.01, 0.02, 1.0)));
    assert!(host.depths(0).iter().all(|depth| *depth == 0.0));
    host.draw(&looking(below + DVec3::Z * 12.0, DVec3::new(0.01, 0.02, -1.0)));
    assert!(host.depths(0).iter().all(|depth| *depth > 0.0));
}

#[test]
fn a_hole_is_not_drawn_and_what_lies_behind_it_is_seen() {
    let mut host = host();
    let hole = [None; 35];
    let cells = TerrainCells { key: TileKey::new(1, 1), first: [70, 58], size: [7, 5], ..TerrainCells::default() };
    host.context.update_terrain(&TerrainCells { classes: Rows::of(&hole), ..cells }).unwrap();
    let ground = host.terrain().height_at(DVec2::new(201.0, 182.0)).unwrap();
    let eye = ORIGIN + DVec3::new(201.0, 182.0, ground + 12.0);
    let case = looking(eye, DVec3::new(0.0, 0.35, -1.0));
    host.draw(&case);
    let (rays, depths) = (case.rays(), host.depths(0));
    let truth = |at: DVec2| ray_to_ground(host.terrain(), eye - ORIGIN, rays.view_ray(at).direction, 2000.0).is_some();
    let mut counts = [0; 2];
    for i in pixels() {
        let near = [-0.02, 0.02].map(|off| truth(ndc(i) + DVec2::splat(off)) == truth(ndc(i)));
        if near == [true; 2] {
            assert_eq!(depths[i] > 0.0, truth(ndc(i)), "pixel {i}");
            counts[usize::from(truth(ndc(i)))] += 1;
        }
    }
    assert!(counts.iter().all(|count| *count > 100), "{counts:?}");
}

#[test]
fn pages_whose_holes_are_filled_are_whole_again() {
    let mut host = host();
    let ground = host.terrain().height_at(DVec2::new(201.0, 182.0)).unwrap();
    let case = looking(ORIGIN + DVec3::new(201.0, 182.0, ground + 12.0), DVec3::new(0.0, 0.35, -1.0));
    let mut pages_after = |rows: u32, class: Option<SurfaceClass>| {
        let classes = vec![class; 7 * rows as usize];
        let cells = TerrainCells { key: TileKey::new(1, 1), first: [70, 58], size: [7, rows], ..Default::default() };
        host.context.update_terrain(&TerrainCells { classes: Rows::of(&classes), ..cells }).unwrap();
        host.draw(&case);
        host.view.effects.land.pages_with_holes()
    };
    let whole = pages_after(5, Some(SurfaceClass::Soil));
    let holed = pages_after(5, None);
    assert!(holed[0] > whole[0] && holed[1] > whole[1], "{whole:?}, {holed:?}");
    let half = pages_after(2, Some(SurfaceClass::Soil));
    assert!(half[0] > whole[0] && half[1] > whole[1], "{whole:?}, {half:?}");
    assert_eq!(pages_after(5, Some(SurfaceClass::Soil)), whole);
}

#[test]
fn the_horizon_of_a_planet_is_where_a_sphere_has_it() {
    const RADIUS_M: f64 = 6_371_000.0;
    let cell_m = 500.0;
    let drop = |v: f64| (v - 256.0) * cell_m;
    let sphere = |x: f64, y: f64| (RADIUS_M * RADIUS_M - drop(x).powi(2) - drop(y).powi(2)).sqrt() - RADIUS_M;
    let mut host = host_with(cell_m, sphere);
    for over in [300.0, 1000.0] {
        let eye = ORIGIN + DVec3::new(256.0 * cell_m, 256.0 * cell_m, over);
        let case = looking_through(eye, DVec3::new(0.6, 0.8, -0.01), 0.05);
        host.draw(&case);
        let (rays, depths) = (case.rays(), host.depths(0));
        let pixel = rays.pixel_angle(36);
        let dip = -(RADIUS_M / (RADIUS_M + over)).acos();
        let mut edges = 0;
        for i in pixels() {
            let elevation = rays.view_ray(ndc(i)).direction.z.asin();
            if (elevation - dip).abs() > 0.5 * pixel {
                assert_eq!(depths[i] > 0.0, elevation < dip, "{over} m, pixel {i}: {elevation} {dip}");
            } else {
                edges += 1;
            }
        }
        assert!((20..200).contains(&edges), "{edges} pixels on the horizon");
    }
}

#[test]
fn the_mean_colour_of_the_ground_is_the_same_at_every_distance() {
    let mut host = host_with(50.0, |_, _| 0.0);
    host.context.set_default_surface_class(SurfaceClass::Soil);
    let mut chance = RandomStream::new(9, 9);
    let mut mean = |host: &mut Host, over: f64, views: u32| {
        let mut sum = DVec3::ZERO;
        for _ in 0..views {
            let at = [chance.unit(), chance.unit()].map(|v| 8000.0 + 9600.0 * v);
            let case = looking(ORIGIN + DVec3::new(at[0], at[1], over), DVec3::new(0.0, 1e-3, -1.0));
            host.draw(&case);
            let colors = host.colors();
            assert!(colors.iter().all(|c| c[0] > 0.0));
            sum += colors.iter().map(|c| DVec3::new(c[0].into(), c[1].into(), c[2].into())).sum::<DVec3>()
                / colors.len() as f64;
        }
        sum / f64::from(views)
    };
    // The light differs by the air between the heights of the camera, not on the ground.
    let far = mean(&mut host, 9000.0, 2);
    for (over, views) in [(1.0, 200), (30.0, 200), (1500.0, 20)] {
        let near = mean(&mut host, over, views);
        let off = (near / far - 1.0).abs() * DVec3::new(0.19, 0.14, 0.095);
        println!("{over} m: {off}");
        assert!(off.max_element() < 1.0 / 255.0, "{over} m: {near} {far}");
    }
}

#[test]
fn without_tiles_or_with_drawing_off_nothing_is_drawn() {
    let mut host = host();
    let case = looking(ORIGIN + DVec3::new(200.0, 180.0, 40.0), DVec3::new(0.2, 1.0, -1.2));
    host.context.set_terrain_drawing(None).unwrap();
    host.draw(&case);
    assert_eq!(host.view.report().passes, 0);
    assert!(host.depths(0).iter().all(|depth| *depth == 0.0));
    host.context.set_terrain_drawing(Some(TerrainDrawing::default())).unwrap();
    host.context.set_terrain(None).unwrap();
    host.draw(&case);
    assert_eq!(host.view.report().passes, 0);
    let fine = TerrainDrawing::default();
    let mut refused = |drawing| host.context.set_terrain_drawing(Some(drawing)).unwrap_err().to_string();
    let error = refused(TerrainDrawing { error_px: f64::NAN, ..fine });
    assert!(error.contains("terrain_drawing.error_px must be in [0.25, 16] px, got NaN"), "{error}");
    for bad in [-1.0, 99.0, 2e5, f64::NAN] {
        let error = refused(TerrainDrawing { shadows_to_m: bad, ..fine });
        assert!(error.contains("terrain_drawing.shadows_to_m must be 0 or in [100, 100000] m, got"), "{error}");
    }
    assert_eq!(host.context.terrain_drawing(), Some(TerrainDrawing::default()));
}
