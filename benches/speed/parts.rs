//! Cost per picture of the parts that a plan may leave out, and of the gauge. These are the constants of the rooms'
//! `candidates`, in units of a pixel with none of the parts. Also measures how far times predicted from them are from
//! measured times.

use std::{sync::Arc, time::Instant};

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, PARTS, Shared, Stages, View},
    gpu::{Device, DeviceOptions},
    plan::Budget,
    scene::Camera,
    weather::Weather,
};
use welkin_support::textures;

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

const SIZE: wgpu::Extent3d = wgpu::Extent3d { width: 640, height: 360, depth_or_array_layers: 1 };

/// The rungs of air, fog, sky and rain.
type Rungs = [usize; 4];
const ALL: Rungs = [0; 4];
const NONE: Rungs = [1, 1, 1, 2];

struct Bench {
    device: Arc<Device>,
    context: Context,
    view: View,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    frame_id: u64,
    /// The rung of snow.
    snow: usize,
}

impl Bench {
    fn new() -> Fallible<Self> {
        let device = Device::headless(&DeviceOptions::default())?;
        let shared = Arc::new(Shared::new(&device)?);
        let mut context = Context::new(device.clone(), shared, ContextDesc::default())?;
        context.set_sun(Some(GivenDirection { azimuth_deg: 60.0, elevation_deg: 35.0 }))?;
        let view = View::new(&context)?;
        let texture = |format| textures::texture(&device, (SIZE.width, SIZE.height), format, 1);
        let (color, depth) = (texture(wgpu::TextureFormat::Rgba16Float), texture(wgpu::TextureFormat::R32Float));
        Ok(Self { device, context, view, color, depth, frame_id: 0, snow: 0 })
    }

    /// Draws ground from row `horizon` of the picture down, and sky above it.
    fn world(&self, horizon: u32) {
        let row = |y: u32| if y >= horizon { 0.1 / (30.0 * 180.0 / (y as f32 - 179.0).max(1.0)) } else { 0.0 };
        let texels: Vec<f32> = (0..SIZE.width * SIZE.height).map(|i| row(i / SIZE.width)).collect();
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE.width * 4), rows_per_image: None };
        self.device.queue.write_texture(self.depth.as_image_copy(), bytemuck::cast_slice(&texels), layout, SIZE);
    }

    fn frame(&mut self) -> Fallible<f64> {
        self.frame_id += 1;
        let camera = Camera::look_to(DVec3::new(0.0, 0.0, 10.0), DVec3::Y, DVec3::Z, 0.9, 16.0 / 9.0, 0.1);
        let frame = Frame::new(self.frame_id, camera, &self.color, Some(&self.depth));
        let start = Instant::now();
        self.view.record(&self.context, &frame, Stages::ALL.without(Stages::TONE))?;
        self.device.wait()?;
        Ok(start.elapsed().as_secs_f64() * 1e3)
    }

    fn frame_with(&mut self, rungs: Rungs) -> Fallible<f64> {
        let [air, fog, sky, rain] = rungs;
        self.view.set_budget(Budget::pinned(&[air, fog, sky, rain, 0, self.snow]))?;
        self.frame()
    }

    /// Time of a frame with flakes only, relative to the frame without them before it: the median of many.
    fn ratio_of_snow(&mut self) -> Fallible<f64> {
        let mut ratios = Vec::new();
        for _ in 0..42 {
            self.snow = 1;
            let none = self.frame_with(NONE)?;
            self.snow = 0;
            ratios.push(self.frame_with(NONE)? / none);
        }
        Ok(median(&mut ratios[1..]))
    }

    /// Time of a frame with parts at these rungs, relative to the frame with none before it. The median of many is
    /// taken, so that other load on the machine affects both.
    fn ratio(&mut self, rungs: Rungs) -> Fallible<f64> {
        // The first frame of each choice compiles its pipelines.
        let mut ratios = Vec::new();
        for _ in 0..42 {
            let none = self.frame_with(NONE)?;
            ratios.push(self.frame_with(rungs)? / none);
        }
        Ok(median(&mut ratios[1..]))
    }

    fn set(&mut self, weather: &str, time_s: f64) -> Fallible<()> {
        self.context.set_weather(&Weather::preset(weather)?, time_s, 0.0)?;
        self.context.update(time_s)?;
        // The tables need some frames to follow a new air.
        for _ in 0..40 {
            self.frame()?;
        }
        Ok(())
    }
}

fn median(of: &mut [f64]) -> f64 {
    of.sort_by(f64::total_cmp);
    of[of.len() / 2]
}

/// Runs scenes and sets of parts one after the other. Compares the time predicted before the first frame of each, from
/// the times of earlier ones, with the median measured afterwards. A fixed picture drawn before each frame serves as
/// the clock.
fn predictions(bench: &mut Bench) -> Fallible<()> {
    let (mut within, mut all, mut worst) = (0, 0, 0.0f64);
    let mut clock = View::new(&bench.context)?;
    clock.set_budget(Budget::pinned(&NONE))?;
    let scenes = [
        ("clear", 0),
        ("clear", 180),
        ("fog", 120),
        ("overcast", 300),
        ("mist", 60),
        ("rain", 180),
        ("heavy_rain", 90),
    ];
    for (weather, horizon) in scenes {
        bench.world(horizon);
        bench.set(weather, bench.frame_id as f64 + 1.0)?;
        for rungs in [ALL, [1, 0, 0, 0], [0, 1, 0, 0], NONE, [0, 0, 1, 0], [0, 0, 0, 1], [0, 0, 0, 2], ALL] {
            // In dry weather, skip the reduced rungs of rain.
            if !weather.contains("rain") && rungs[3] != 0 && rungs != NONE {
                continue;
            }
            bench.view.set_budget(Budget { tolerance: Some(0.01), ..Budget::pinned(&rungs) })?;
            let (mut said, mut times) = (None, Vec::new());
            for frame in 0..32 {
                std::mem::swap(&mut bench.view, &mut clock);
                let tick = bench.frame()?;
                std::mem::swap(&mut bench.view, &mut clock);
                let time = bench.frame()? / tick;
                said = said.or(bench.view.report().prediction.milliseconds);
                bench.view.report_time(time)?;
                if frame > 12 {
                    times.push(time);
                }
            }
            let took = median(&mut times);
            if let Some(said) = said {
                let error = said / took - 1.0;
                all += 1;
                within += u32::from(error.abs() <= 0.25);
                worst = worst.max(error.abs());
                println!("  {weather}, ground below row {horizon}, {rungs:?}: {said:.2} predicted, {took:.2} taken");
            }
        }
    }
    println!("  predicted within 25 %: {within} of {all}, the worst off by {:.0} %", 100.0 * worst);
    Ok(())
}

pub fn run() -> Fallible<()> {
    println!("parts of a picture of {} x {}, in shares of one with none of them:", SIZE.width, SIZE.height);
    let mut bench = Bench::new()?;
    for (weather, horizon, part) in [("clear", 0, 0), ("fog", 0, 1), ("mist", 0, 1), ("rain", 0, 1), ("clear", 360, 2)]
    {
        bench.world(horizon);
        bench.set(weather, bench.frame_id as f64 + 1.0)?;
        let mut only = NONE;
        only[part] = 0;
        println!("  {} in {weather}: {:.2}", PARTS[part].name, bench.ratio(only)? - 1.0);
    }
    bench.world(180);
    bench.set("heavy_rain", bench.frame_id as f64 + 1.0)?;
    let cones = bench.ratio([1, 1, 1, 1])? - 1.0;
    let drops = bench.ratio([1, 1, 1, 0])? - 1.0 - cones;
    let each = drops * f64::from(SIZE.width * SIZE.height) / f64::from(bench.view.report().rain.drops.max(1));
    println!("  rain: {cones:.2}; drops {drops:.2}, {each:.2} pixels each");
    bench.set("snow", bench.frame_id as f64 + 1.0)?;
    let snow = bench.ratio_of_snow()? - 1.0;
    let flakes = bench.view.report().snow.flakes;
    let each = snow * f64::from(SIZE.width * SIZE.height) / f64::from(flakes.max(1));
    println!("  snow: {snow:.2}, {flakes} flakes, {each:.2} pixels each");
    bench.set("clear", bench.frame_id as f64 + 1.0)?;
    bench.view.set_budget(Budget { tolerance: Some(1e-6), ..Budget::default() })?;
    for _ in 0..16 {
        bench.frame()?;
    }
    // One frame in eight has a gauge. Collects each frame's time relative to the one before it, by position among the
    // eight.
    let (mut ratios, mut before) = ([const { Vec::new() }; 8], bench.frame()?);
    for i in 0..328 {
        let now = bench.frame()?;
        ratios[i % 8].push(now / before);
        before = now;
    }
    let gauged = ratios.each_mut().map(|r| median(r)).into_iter().fold(0.0, f64::max) - 1.0;
    println!("  gauge: {gauged:.2} of a picture in every eighth frame");
    predictions(&mut bench)
}
