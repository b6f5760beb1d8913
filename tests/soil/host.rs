//! A host with four tiles and soil on them, on a device that draws nothing.

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc},
    frame::Shared,
    gpu::{Device, DeviceOptions},
    ground::GroundModel,
    snowpack::LyingSnowModel,
    soil::{SoilSettings, SoilToolPose, SoilToolShape},
    terrain::{Rows, TerrainCells, TerrainDesc, TileKey},
    weather::{Precipitation, PrecipitationKind, Weather, Wind},
};

pub const SIDE: u32 = 32;
pub const CELL_M: f64 = 0.25;
/// Corner of the four tiles in the host's world, m.
pub const ORIGIN: DVec3 = DVec3::new(120.0, -50.0, 7.0);
pub const KEYS: [TileKey; 4] = [
    TileKey { east: -1, north: -1 },
    TileKey { east: 0, north: -1 },
    TileKey { east: -1, north: 0 },
    TileKey { east: 0, north: 0 },
];

/// A context with simulated ground and snow.
pub fn context() -> Context {
    made(GroundModel::Simulated, LyingSnowModel::Simulated)
}

/// A context with this ground, and snow as the weather reports it.
pub fn context_of(ground: GroundModel) -> Context {
    made(ground, LyingSnowModel::Reported)
}

fn made(ground: GroundModel, lying_snow: LyingSnowModel) -> Context {
    static DEVICE: OnceLock<(Arc<Device>, Arc<Shared>)> = OnceLock::new();
    let (device, shared) = DEVICE.get_or_init(|| {
        let options = DeviceOptions { backends: wgpu::Backends::NOOP, ..DeviceOptions::default() };
        let device = Device::headless(&options).unwrap();
        let shared = Arc::new(Shared::new(&device).unwrap());
        (device, shared)
    });
    let desc = ContextDesc { ground, lying_snow, seed: 3, ..ContextDesc::default() };
    Context::new(device.clone(), shared.clone(), desc).unwrap()
}

/// Heights of a tile: they fall by 1 % towards the origin, with small hollows, and are higher by `raised_m`.
pub fn tile(key: TileKey, raised_m: f32) -> Vec<f32> {
    let side = SIDE as i32;
    let height = |i: i32| {
        let (x, y) = (key.east * side + i % side, key.north * side + i / side);
        let (x, y) = (x as f32, y as f32);
        0.0025 * x.hypot(y) + 0.001 * (0.37 * x + 0.91 * y).sin() + raised_m
    };
    (0..side * side).map(height).collect()
}

/// Sets the four tiles.
pub fn tiles(context: &mut Context) {
    let desc = TerrainDesc { origin: ORIGIN, cell_m: CELL_M, tile_cells: SIDE };
    context.set_terrain(Some(desc)).unwrap();
    for key in KEYS {
        let heights = tile(key, 0.0);
        let cells = TerrainCells { key, heights_m: Rows::of(&heights), ..TerrainCells::default() };
        context.set_terrain_tile(&cells).unwrap();
    }
}

/// Sets the four tiles, with 0.3 m of topsoil on loam.
pub fn site(context: &mut Context) {
    tiles(context);
    context.set_soil(Some(SoilSettings::default())).unwrap();
}

pub fn bucket(struck_m3: f64) -> SoilToolShape {
    SoilToolShape::Bucket { struck_m3, heap_rise: 1.0 }
}

/// Pose of a bucket of 1.5 m whose edge lies at a place from the origin, and whose opening looks along the heading and
/// by `tilt` above the horizontal.
pub fn bucket_pose(time_s: f64, edge: DVec3, heading: f64, tilt: f64) -> SoilToolPose {
    let forward = DVec3::new(heading.cos(), heading.sin(), 0.0);
    let left = DVec3::new(-forward.y, forward.x, 0.0);
    let facing = forward * tilt.cos() + DVec3::Z * tilt.sin();
    let up = DVec3::Z * tilt.cos() - forward * tilt.sin();
    let side = |offset: DVec3| [1.0, -1.0].map(|sign| ORIGIN + edge + offset + left * (0.75 * sign));
    SoilToolPose { time_s, edge: side(DVec3::ZERO), upper: side(up * 1.2), facing, load_n: 0.0 }
}

/// Pose of a bucket that is drawn along x at a depth.
pub fn drag(time_s: f64, x: f64, depth_m: f64) -> SoilToolPose {
    bucket_pose(time_s, DVec3::new(x, 0.0, -depth_m), 0.0, 0.2)
}

pub fn rain(rate_mm_h: f64) -> Weather {
    Weather {
        temperature_c: 8.0,
        precipitation: Precipitation::of(PrecipitationKind::Rain, rate_mm_h),
        wind: Wind::of(3.0, 200.0),
        ..Weather::default()
    }
}

pub fn snowfall() -> Weather {
    Weather {
        temperature_c: -3.0,
        precipitation: Precipitation::of(PrecipitationKind::Snow, 4.0),
        wind: Wind::of(7.0, 240.0),
        ..Weather::default()
    }
}
