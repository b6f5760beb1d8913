//! Cost of the sea in half of a picture: whole frames with the sea against the same frames without it, in copies
//! ([`Copying`]). The camera is 10 m above the water.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Shared, View},
    gpu::{Device, DeviceOptions},
    scene::Camera,
    sea::{SeaHull, SeaPoint, SeaSettings},
    weather::{Weather, Wind},
};
use welkin_support::processor::processor_ns;

use crate::{
    copies::{Copying, SETTLED, SIZE, median, size_of},
    host_images::HostImages,
};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

/// Rounds over all scenes; the median of each scene counts.
const ROUNDS: usize = 9;
/// Time between frames of a moving sea, s.
const STEP_S: f64 = 1.0 / 60.0;

/// A wind over the sea, or without sea, and the time between its frames.
struct SeaScene {
    name: &'static str,
    context: Context,
    view: View,
    step_s: f64,
    frames: u64,
    copies: Vec<f64>,
}

impl SeaScene {
    fn new(
        device: &Arc<Device>,
        shared: &Arc<Shared>,
        name: &'static str,
        wind: Option<f64>,
        step_s: f64,
    ) -> Fallible<Self> {
        let mut context = Context::new(device.clone(), shared.clone(), ContextDesc::default())?;
        context.set_sun(Some(GivenDirection { azimuth_deg: 120.0, elevation_deg: 30.0 }))?;
        context.set_weather(
            &Weather { wind: Wind::of(wind.unwrap_or(10.0), 250.0), ..Weather::default() },
            0.0,
            0.0,
        )?;
        context.set_sea(wind.map(|_| SeaSettings::default()))?;
        context.update(0.0)?;
        let view = View::new(&context)?;
        Ok(Self { name, context, view, step_s, frames: 0, copies: Vec::new() })
    }

    /// Processor time of a frame, ns.
    fn ns(&mut self, device: &Device, target: &HostImages, camera: &Camera) -> Fallible<f64> {
        self.frames += 1;
        self.context.update(self.step_s * self.frames as f64)?;
        target.frame_ns(device, (&mut self.view, &self.context), camera, self.frames)
    }

    /// Processor time of one query at a new time, ns: the spectrum's waves and the tiles' transforms.
    fn query_ns(&self, n: usize) -> Fallible<f64> {
        let mut point = [SeaPoint::default()];
        let before = processor_ns();
        self.context.sea_at(&[DVec3::ZERO], 1e4 + n as f64, 0.0, &mut point)?;
        Ok((processor_ns() - before) as f64)
    }
}

/// A hull that goes on for 240 s, and is 60 m before the camera then if it does not turn.
fn hull(turn_deg_s: f64) -> SeaHull {
    let [speed_m_s, at_s] = [6.0, -240.0];
    let position_m = if turn_deg_s > 0.0 { [0.0, 60.0, 0.0] } else { [speed_m_s * at_s + 30.0, 60.0, 0.0] };
    SeaHull { position_m, heading_deg: 90.0, speed_m_s, turn_deg_s: -turn_deg_s, at_s, ..SeaHull::default() }
}

/// Prints the copies of each scene, and what the sea adds.
pub fn run() -> Fallible<()> {
    let device = Device::headless(&DeviceOptions::default())?;
    let shared = Arc::new(Shared::new(&device)?);
    let size = std::env::var("SIZE").map_or(Ok(SIZE), |asked| size_of(&asked))?;
    let target = HostImages::new(&device, size);
    let copying = Copying::new(&device, size)?;
    let camera = Camera::look_to(DVec3::Z * 10.0, DVec3::Y, DVec3::Z, 0.9, 16.0 / 9.0, 0.1);
    let scene = |name, wind, step_s| SeaScene::new(&device, &shared, name, wind, step_s);
    let mut scenes = [
        scene("without sea", None, STEP_S)?,
        scene("wind 10 m/s, time at rest", Some(10.0), 0.0)?,
        scene("wind 10 m/s, each frame a new time", Some(10.0), STEP_S)?,
        scene("storm of 25 m/s, each frame a new time", Some(25.0), STEP_S)?,
        scene("wind 10 m/s, time at rest, the wake of a straight way", Some(10.0), 0.0)?,
        scene("wind 10 m/s, time at rest, the wake of a way that turns", Some(10.0), 0.0)?,
    ];
    scenes[4].context.set_sea_hulls(&[hull(0.0)])?;
    scenes[5].context.set_sea_hulls(&[hull(1.5)])?;
    let (mut queries, mut copies) = (Vec::new(), Vec::new());
    for scene in &mut scenes {
        for _ in 0..SETTLED {
            scene.ns(&device, &target, &camera)?;
        }
    }
    for round in 0..ROUNDS {
        for scene in &mut scenes {
            // A frame that is not counted: a software driver drops the code of shaders that have not run for long.
            scene.ns(&device, &target, &camera)?;
            let before = copying.ns(&device)?;
            let frame = scene.ns(&device, &target, &camera)?;
            let copy = 0.5 * (before + copying.ns(&device)?);
            scene.copies.push(frame / copy);
            copies.push(copy);
        }
        queries.push(scenes[2].query_ns(round)? / copying.ns(&device)?);
    }
    println!(
        "the sea in half of {} x {}, in copies of {:.2} ms, {}:",
        size.0,
        size.1,
        1e-6 * median(&mut copies),
        device.caps().adapter_name
    );
    let without = median(&mut scenes[0].copies);
    println!("  {}: {without:.1}", scenes[0].name);
    for scene in &mut scenes[1..] {
        let copies = median(&mut scene.copies);
        println!("  {}: {copies:.1}, {:.1} more", scene.name, copies - without);
    }
    println!("  of which the surface of a new time, by a query: {:.1}", median(&mut queries));
    Ok(())
}
