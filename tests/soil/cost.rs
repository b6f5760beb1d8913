//! Cost of digging on a context's terrain, against the same digging alone: heights, lists, and the water that finds the
//! pit.

use std::time::Instant;

use glam::DVec3;
use welkin::{
    context::Context,
    ground::GroundModel,
    soil::{SOIL_STEP_S, SoilSettings, SoilSite, SoilSiteDesc, SoilToolPose, SoilToolShape, UndugGround},
    terrain::{Rows, TerrainCells, TerrainDesc},
};
use welkin_support::processor::{holds, median};

use crate::host::{bucket, context_of, rain};

const FRAMES: i32 = 180;

struct Level;

impl UndugGround for Level {
    fn height_m(&self, _cell: [i32; 2]) -> Option<f64> {
        Some(0.0)
    }
}

/// A context with a level tile of 256 x 256 cells of 0.1 m and soil on it, in rain.
fn site(ground: GroundModel) -> Context {
    let mut context = context_of(ground);
    context.set_weather(&rain(10.0), 0.0, 0.0).unwrap();
    let origin = DVec3::new(-12.8, -12.8, 0.0);
    context.set_terrain(Some(TerrainDesc { origin, cell_m: 0.1, tile_cells: 256 })).unwrap();
    let heights = vec![0.0; 256 * 256];
    context.set_terrain_tile(&TerrainCells { heights_m: Rows::of(&heights), ..TerrainCells::default() }).unwrap();
    context.set_soil(Some(SoilSettings::default())).unwrap();
    context.update(0.0).unwrap();
    context
}

/// Pose of a bucket of 3 m that is drawn along x, 0.3 m deep.
fn drawn(frame: i32) -> SoilToolPose {
    let x = -2.0 + f64::from(frame) / 60.0;
    let side = |x: f64, z: f64| [1.5, -1.5].map(|y| DVec3::new(x, y, z));
    let (edge, upper) = (side(x, -0.3), side(x - 0.2, 0.9));
    SoilToolPose { time_s: f64::from(frame) * SOIL_STEP_S, edge, upper, facing: DVec3::new(1.0, 0.0, 0.2), load_n: 0.0 }
}

/// Seconds of the middle frame, of the frames that `act` does.
fn frame_s(mut act: impl FnMut(i32)) -> f64 {
    let time = |frame: i32| {
        let begun = Instant::now();
        act(frame);
        begun.elapsed().as_secs_f64()
    };
    median(&mut (1..=FRAMES).map(time).collect::<Vec<_>>())
}

fn in_context_s(ground: GroundModel, shape: SoilToolShape) -> f64 {
    let mut context = site(ground);
    let tool = context.add_soil_tool(shape, &drawn(0)).unwrap();
    frame_s(|frame| {
        context.move_soil_tool(tool, &drawn(frame)).unwrap();
        context.update(f64::from(frame) * SOIL_STEP_S).unwrap();
    })
}

#[test]
fn heights_and_water_cost_little_beside_the_digging() {
    holds("a frame of digging in a context, without and with water, against digging alone", &[7.0, 7.0], || {
        let shape = bucket(1.0);
        let mut alone = SoilSite::new(SoilSiteDesc::default()).unwrap();
        let tool = alone.add_tool(shape, &drawn(0)).unwrap();
        let alone_s = frame_s(|frame| {
            alone.move_tool(tool, &drawn(frame)).unwrap();
            alone.advance(f64::from(frame) * SOIL_STEP_S, &Level).unwrap();
        });
        [GroundModel::Reported, GroundModel::Simulated].map(|ground| in_context_s(ground, shape) / alone_s).to_vec()
    });
}
