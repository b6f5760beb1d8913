//! Cost per frame of the cube map of the camera's surroundings: one face, and all six, interleaved with frames without
//! it.

use std::{sync::Arc, time::Instant};

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, FrameFlags, Shared, Stages, View},
    gpu::{Device, DeviceOptions},
    scene::Camera,
    weather::Weather,
};
use welkin_support::{depth_texture::depth_texture, textures::texture};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

const SIZE: (u32, u32) = (1280, 720);

/// Time of a frame until the GPU has finished it, ms.
fn ms(device: &Device, context: &Context, view: &mut View, frame: &Frame<'_>) -> Fallible<f64> {
    let start = Instant::now();
    view.record(context, frame, Stages::ALL)?;
    device.wait()?;
    Ok(start.elapsed().as_secs_f64() * 1e3)
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Prints both costs next to that of the frame.
pub fn run() -> Fallible<()> {
    let device = Device::headless(&DeviceOptions::default())?;
    let shared = Arc::new(Shared::new(&device)?);
    // Sky in the upper half of the picture, a plain in the lower half.
    let half = (SIZE.0 * SIZE.1 / 2) as usize;
    let depths: Vec<f32> = (0..2 * half).map(|i| if i < half { 0.0 } else { 1e-3 }).collect();
    for name in ["clear", "fog"] {
        let mut context = Context::new(device.clone(), shared.clone(), ContextDesc::default())?;
        context.set_weather(&Weather::preset(name)?, 0.0, 0.0)?;
        context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg: 30.0 }))?;
        let (color, depth) =
            (texture(&device, SIZE, wgpu::TextureFormat::Rgba16Float, 1), depth_texture(&device, SIZE, &depths));
        let camera = Camera::look_to(DVec3::new(0.0, 0.0, 2.0), DVec3::Y, DVec3::Z, 1.0, 16.0 / 9.0, 0.1);
        let [mut without, mut with] = [View::new(&context)?, View::new(&context)?];
        with.environment()?;
        let mut costs = [Vec::new(), Vec::new(), Vec::new()];
        for id in 0..120u64 {
            let mut frame = Frame::new(id, camera, &color, Some(&depth));
            let whole = id == 0 || id % 4 == 0;
            // Draws all faces; the sky's tables are complete after the first frame.
            frame.flags = if whole { FrameFlags::NO_HISTORY } else { FrameFlags(0) };
            let plain = ms(&device, &context, &mut without, &frame)?;
            let more = ms(&device, &context, &mut with, &frame)? - plain;
            if id > 20 {
                costs[0].push(plain);
                costs[if whole { 2 } else { 1 }].push(more);
            }
        }
        let [plain, one, all] = costs.map(median);
        println!(
            "environment, {name}, 1280x720, {}: a frame {plain:.1} ms; one face {one:.2} ms more, all six {all:.2} ms more",
            device.caps().adapter_name
        );
    }
    Ok(())
}
