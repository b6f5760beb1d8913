//! Cost of a step of a wind field: per cell, and relative to the simulated time.

use std::time::Instant;

use glam::{DVec3, dvec3};
use welkin::flow::{FlowBox, FlowField, FlowObstacles, FlowSettings};

/// Numbers of cells of the fields; each field has twice as many as the one before.
const SIZES: [[u32; 3]; 4] = [[64, 64, 16], [64, 64, 32], [128, 64, 32], [128, 128, 32]];
/// Length of a step, s: as in a running simulation.
const STEP_S: f64 = 0.5;

pub fn run() -> Result<(), Box<dyn std::error::Error>> {
    let mut before = None;
    for cells in SIZES {
        let settings =
            FlowSettings { cells, tolerance: 1e-3, has_eddies: true, roughness_m: 0.03, ..FlowSettings::default() };
        let house = [FlowBox::level(dvec3(100.0, 100.0, 10.0), dvec3(20.0, 20.0, 12.0), 20.0)];
        let obstacles = FlowObstacles { terrain: None, boxes: &house };
        let mut field = FlowField::new(&settings, &obstacles, |p| DVec3::X * (4.0 + 0.1 * p.z))?;
        field.step(STEP_S)?;
        let one = |field: &mut FlowField| -> Result<f64, Box<dyn std::error::Error>> {
            let began = Instant::now();
            field.step(STEP_S)?;
            Ok(began.elapsed().as_secs_f64())
        };
        let mut times = Vec::new();
        for _ in 0..9 {
            times.push(one(&mut field)?);
        }
        times.sort_by(f64::total_cmp);
        let (least, count) = (times[0], f64::from(cells.iter().product::<u32>()));
        println!(
            "{cells:?} cells: a step takes {:.2} of the {STEP_S} s that it leads over, {:.2} us a cell",
            least / STEP_S,
            1e6 * least / count
        );
        if let Some(smaller) = before.replace(least) {
            println!("twice the cells take {:.2} times as long", least / smaller);
        }
    }
    Ok(())
}
