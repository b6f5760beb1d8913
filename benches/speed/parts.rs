//! What the parts that a plan may leave out cost a picture, and what the gauge costs: the constants of
//! `plan::planner`, in units of a pixel with none of them.

use std::{sync::Arc, time::Instant};

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions},
    plan::Budget,
    scene::Camera,
    weather::Weather,
};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

const SIZE: wgpu::Extent3d = wgpu::Extent3d { width: 640, height: 360, depth_or_array_layers: 1 };

struct Bench {
    device: Arc<Device>,
    context: Context,
    view: View,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    frame_id: u64,
}

impl Bench {
    fn new() -> Fallible<Self> {
        let device = Device::headless(&DeviceOptions::default())?;
        let shared = Arc::new(Shared::new(&device)?);
        let mut context = Context::new(device.clone(), shared, ContextDesc::default())?;
        context.set_sun(Some(GivenDirection { azimuth_deg: 60.0, elevation_deg: 35.0 }))?;
        let view = View::new(&context)?;
        let texture = |format| {
            use wgpu::TextureUsages as U;
            device.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: SIZE,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: U::RENDER_ATTACHMENT | U::TEXTURE_BINDING | U::COPY_SRC | U::COPY_DST,
                view_formats: &[],
            })
        };
        let (color, depth) = (texture(wgpu::TextureFormat::Rgba16Float), texture(wgpu::TextureFormat::R32Float));
        Ok(Self { device, context, view, color, depth, frame_id: 0 })
    }

    /// Ground from row `horizon` of the picture down, sky above it.
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

    /// The least time of a frame, ms, with these parts.
    fn time(&mut self, parts: [bool; 3]) -> Fallible<f64> {
        self.view.set_budget(Budget { pinned: Some(parts), ..Budget::default() })?;
        let mut least = f64::INFINITY;
        for _ in 0..31 {
            least = least.min(self.frame()?);
        }
        Ok(least)
    }

    fn set(&mut self, weather: &str, time_s: f64) -> Fallible<()> {
        self.context.set_weather(&Weather::preset(weather)?, time_s, 0.0)?;
        self.context.update(time_s)?;
        // The tables follow a new air for some frames.
        for _ in 0..40 {
            self.frame()?;
        }
        Ok(())
    }
}

pub fn run() -> Fallible<()> {
    println!("parts of a picture of {} x {}, in shares of one with none of them:", SIZE.width, SIZE.height);
    let mut bench = Bench::new()?;
    for (name, weather, horizon, part) in [("air", "clear", 0, 0), ("fog", "fog", 0, 1), ("sky", "clear", 360, 2)] {
        bench.world(horizon);
        bench.set(weather, bench.frame_id as f64 + 1.0)?;
        let mut only = [false; 3];
        let none = bench.time(only)?;
        only[part] = true;
        let with = bench.time(only)?;
        println!("  {name}: {:.2} ({none:.2} ms without, {with:.2} ms with)", with / none - 1.0);
    }
    bench.world(180);
    bench.set("clear", bench.frame_id as f64 + 1.0)?;
    let pinned = bench.time([true; 3])?;
    bench.view.set_budget(Budget { tolerance: Some(1e-6), ..Budget::default() })?;
    for _ in 0..16 {
        bench.frame()?;
    }
    // One frame in eight has a gauge: the least time of each of the eight.
    let mut least = [f64::INFINITY; 8];
    for i in 0..400 {
        least[i % 8] = least[i % 8].min(bench.frame()?);
    }
    let gauged = least.iter().copied().fold(0.0, f64::max);
    println!(
        "  gauge: {:.2} ms in every eighth frame, {:.3} of the pictures' {pinned:.1} ms",
        gauged - pinned,
        (gauged - pinned) / 8.0 / pinned
    );
    Ok(())
}
