//! Cost of drawn terrain in half of a picture, in copies ([`Copying`]): whole frames with it against the same frames
//! without it, and against frames over the same ground as a host draws it. The camera is 2 m above hills of 8 x 8 km.

use std::{f64::consts::TAU, sync::Arc};

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Shared, View},
    gpu::{Device, DeviceOptions},
    land::TerrainDrawing,
    scene::Camera,
    terrain::{Rows, TerrainCells, TerrainDesc, TileKey},
};

use crate::{
    copies::{Copying, SETTLED, SIZE, median, quantile, size_of},
    host_images::HostImages,
};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

/// Rounds over all scenes, and frames of each scene in a round.
const ROUNDS: usize = 5;
const FRAMES: usize = 24;
/// Time between frames, s, and pace of the sun and speed of the camera while they move.
const STEP_S: f64 = 1.0 / 60.0;
const SUN_DEG_S: f64 = 0.25;
const SPEED_M_S: f64 = 10.0;
/// Cells along a side of a tile, tiles along a side of the terrain, and side of a cell, m.
const SIDE: u32 = 256;
const TILES: i32 = 8;
const CELL_M: f64 = 4.0;

fn height(x: f64, y: f64) -> f64 {
    (0..7)
        .map(|octave| {
            let length = 900.0 * libm::pow(0.47, f64::from(octave));
            let (sine, cosine) = libm::sincos(1.1 * f64::from(octave));
            let (u, v) = (cosine * x + sine * y, cosine * y - sine * x);
            0.02 * length * (libm::sin(u * TAU / length) + libm::sin(v * TAU / (1.3 * length)))
        })
        .sum()
}

/// Frames over a terrain, or without one.
struct LandScene {
    name: &'static str,
    context: Context,
    view: View,
    moves: bool,
    frames: u64,
    copies: Vec<f64>,
}

impl LandScene {
    fn new(
        (device, shared): (&Arc<Device>, &Arc<Shared>),
        name: &'static str,
        shadows_to_m: Option<f64>,
        moves: bool,
    ) -> Fallible<Self> {
        let mut context = Context::new(device.clone(), shared.clone(), ContextDesc::default())?;
        if let Some(shadows_to_m) = shadows_to_m {
            let desc = TerrainDesc { cell_m: CELL_M, tile_cells: SIDE, ..TerrainDesc::default() };
            context.set_terrain(Some(desc))?;
            for key in (0..TILES * TILES).map(|i| TileKey::new(i % TILES - TILES / 2, i / TILES - TILES / 2)) {
                let side = SIDE as i32;
                let place = |i: i32| [key.east * side + i % side, key.north * side + i / side].map(f64::from);
                let height = |i: i32| height(CELL_M * place(i)[0], CELL_M * place(i)[1]) as f32;
                let heights: Vec<f32> = (0..side * side).map(height).collect();
                context.set_terrain_tile(&TerrainCells {
                    key,
                    heights_m: Rows::of(&heights),
                    ..TerrainCells::default()
                })?;
            }
            context.set_terrain_drawing(Some(TerrainDrawing { shadows_to_m, ..TerrainDrawing::default() }))?;
        }
        let view = View::new(&context)?;
        Ok(Self { name, context, view, moves, frames: 0, copies: Vec::new() })
    }

    /// Processor time of a frame, ns.
    fn ns(&mut self, device: &Device, target: &HostImages) -> Fallible<f64> {
        self.frames += 1;
        let time_s = if self.moves { STEP_S * self.frames as f64 } else { 0.0 };
        let elevation_deg = 20.0 + SUN_DEG_S * time_s;
        self.context.set_sun(Some(GivenDirection { azimuth_deg: 120.0, elevation_deg }))?;
        self.context.update(0.0)?;
        let north = SPEED_M_S * time_s;
        let eye = DVec3::new(0.0, north, height(0.0, north) + 2.0);
        let camera = Camera::look_to(eye, DVec3::Y, DVec3::Z, 0.9, 16.0 / 9.0, 0.1);
        target.frame_ns(device, (&mut self.view, &self.context), &camera, self.frames)
    }
}

/// Prints the copies of each scene, and what the terrain adds: in the median, and in the 99th percentile.
pub fn run() -> Fallible<()> {
    let device = Device::headless(&DeviceOptions::default())?;
    let shared = Arc::new(Shared::new(&device)?);
    let size = std::env::var("SIZE").map_or(Ok(SIZE), |asked| size_of(&asked))?;
    let (target, copying) = (HostImages::new(&device, size), Copying::new(&device, size)?);
    let scene = |name, shadows, moves| LandScene::new((&device, &shared), name, shadows, moves);
    let mut scenes = [
        scene("without terrain", None, false)?,
        scene("over the same ground of the host's own", None, false)?,
        scene("terrain", Some(0.0), false)?,
        scene("terrain with shadows", Some(1e4), false)?,
        scene("without terrain, the camera at 10 m/s, the sun at 60 times its pace", None, true)?,
        scene("terrain, both moving", Some(0.0), true)?,
        scene("terrain with shadows, both moving", Some(1e4), true)?,
    ];
    scenes[2].ns(&device, &target)?;
    let hosts_own = target.kept(&device)?;
    let images = |i: usize| if i == 1 { &hosts_own } else { &target };
    for (i, scene) in scenes.iter_mut().enumerate() {
        for _ in 0..SETTLED {
            scene.ns(&device, images(i))?;
        }
    }
    let mut copies = Vec::new();
    for _ in 0..ROUNDS {
        for (i, scene) in scenes.iter_mut().enumerate() {
            // A frame that is not counted: a software driver drops the code of shaders that have not run for long.
            scene.ns(&device, images(i))?;
            for _ in 0..FRAMES {
                let copy = copying.ns(&device)?;
                let frame = scene.ns(&device, images(i))?;
                scene.copies.push(frame / copy);
                copies.push(copy);
            }
        }
    }
    let adapter = &device.caps().adapter_name;
    println!(
        "terrain in half of {} x {}, in copies of {:.2} ms, {adapter}:",
        size.0,
        size.1,
        1e-6 * median(&mut copies)
    );
    let (rest, moving) = scenes.split_at_mut(4);
    for half in [rest, moving] {
        let without = high(&mut half[0].copies);
        println!("  {}: {:.1} (99 %: {:.1})", half[0].name, without[0], without[1]);
        for scene in &mut half[1..] {
            let [middle, most] = high(&mut scene.copies);
            println!("  {}: {:.1} more ({:.1})", scene.name, middle - without[0], most - without[1]);
        }
    }
    Ok(())
}

/// Median and 99th percentile.
fn high(values: &mut [f64]) -> [f64; 2] {
    [0.5, 0.99].map(|share| quantile(values, share))
}
