//! The windscreen: a frame with water on the glass against one without, and one simulation step of the water,
//! interleaved in one run.

use std::{sync::Arc, time::Instant};

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, Shared, Stages, View},
    glass::{Pane, Windscreen},
    gpu::{Device, DeviceOptions},
    scene::Camera,
    weather::{Precipitation, PrecipitationKind, Weather},
};
use welkin_support::textures;

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

const SIZE: wgpu::Extent3d = wgpu::Extent3d { width: 640, height: 360, depth_or_array_layers: 1 };

fn least(times: &[f64]) -> f64 {
    times.iter().copied().fold(f64::INFINITY, f64::min)
}

/// A car's windscreen: 1.4 m x 0.7 m of glass at a distance of 0.7 m, which is 350 x 175 cells.
pub fn windscreen() -> Windscreen {
    let corners = [(-0.7, -0.35), (0.7, -0.35), (0.7, 0.35), (-0.7, 0.35)].map(|(x, y)| DVec3::new(x, y, -0.7));
    Windscreen { pane: Pane::Quad(corners), velocity_m_s: DVec3::new(0.0, 0.0, -15.0), ..Windscreen::default() }
}

/// Prints the times and their ratios.
pub fn run() -> Fallible<()> {
    let device = Device::headless(&DeviceOptions::default())?;
    let shared = Arc::new(Shared::new(&device)?);
    let mut context = Context::new(device.clone(), shared, ContextDesc::default())?;
    context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg: 40.0 }))?;
    let precipitation = Precipitation { kind: PrecipitationKind::Rain, rate_mm_h: 10.0, ..Default::default() };
    context.set_weather(&Weather { precipitation, visibility_m: 3000.0, ..Weather::default() }, 0.0, 0.0)?;
    let color = textures::texture(&device, (SIZE.width, SIZE.height), wgpu::TextureFormat::Rgba16Float, 1);
    let camera = Camera::look_to(DVec3::new(0.0, 0.0, 10.0), DVec3::Y, DVec3::Z, 0.9, 16.0 / 9.0, 0.1);
    let (mut bare, mut glazed) = (View::new(&context)?, View::new(&context)?);
    glazed.set_windscreen(Some(&windscreen()))?;
    let (mut without, mut with, mut steps) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..60u32 {
        let time = |view: &mut View, context: &Context, id: u32, stages: Stages| -> Fallible<f64> {
            let start = Instant::now();
            view.record(context, &Frame::new(id.into(), camera, &color, None), stages)?;
            device.wait()?;
            Ok(start.elapsed().as_secs_f64() * 1e3)
        };
        context.update(f64::from(i) / 10.0)?;
        // Runs six steps at once, then draws pictures of the same moment.
        time(&mut bare, &context, 3 * i + 1, Stages::PREPARE)?;
        let six = time(&mut glazed, &context, 3 * i + 1, Stages::PREPARE)?;
        let still = time(&mut glazed, &context, 3 * i + 2, Stages::PREPARE)?;
        steps.push((six - still) / 6.0);
        without.push(time(&mut bare, &context, 3 * i + 3, Stages::ALL)?);
        with.push(time(&mut glazed, &context, 3 * i + 3, Stages::ALL)?);
    }
    let (without, with, step) = (least(&without[5..]), least(&with[5..]), least(&steps[5..]));
    println!(
        "windscreen, 640x360 on {}: {with:.2} ms with, {without:.2} ms without, ratio {:.2}; a step of 350 x 175 cells \
         {step:.2} ms, {:.3} of the frame without",
        device.caps().adapter_name,
        with / without,
        step / without
    );
    Ok(())
}
