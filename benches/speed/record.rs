//! CPU time of `View::record` against that of an empty wgpu pass with its submission, interleaved in one run.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions},
    scene::{Camera, WorldKind},
    weather::{CloudLayer, Fog, FogKind, Precipitation, PrecipitationKind, Weather},
};
use welkin_support::textures;

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

fn texture(device: &Device, format: wgpu::TextureFormat) -> wgpu::Texture {
    textures::texture(device, (64, 36), format, 1)
}

/// Records a pass that draws nothing, optionally with a timestamp at its start.
pub fn empty_pass(
    encoder: &mut wgpu::CommandEncoder,
    target: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
    timestamp: Option<(&wgpu::QuerySet, u32)>,
) {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
        })],
        timestamp_writes: timestamp.map(|(query_set, index)| wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(index),
            end_of_pass_write_index: None,
        }),
        ..Default::default()
    });
}

fn submit_empty_pass(device: &Device, target: &wgpu::TextureView) {
    let mut encoder = device.device.create_command_encoder(&Default::default());
    empty_pass(&mut encoder, target, wgpu::LoadOp::Load, None);
    device.queue.submit([encoder.finish()]);
}

fn median(mut times: Vec<Duration>) -> f64 {
    times.sort();
    times[times.len() / 2].as_secs_f64() * 1e6
}

/// Change from frame to frame.
#[derive(Clone, Copy, PartialEq)]
enum Change {
    /// The camera turns, with a given sun and a clear sky.
    Turn,
    /// The camera drives and turns on a curved world with clouds, rain and fog.
    Drive,
    /// As `Drive`, and time advances at sixty frames per second.
    Time,
    /// As `Time` without the clouds, which have passes of their own.
    RainAlone,
}

fn rainy(has_clouds: bool) -> Weather {
    let layer = |cover, base_m| CloudLayer::new(cover, base_m);
    let precipitation = Precipitation { kind: PrecipitationKind::Rain, rate_mm_h: 2.0, ..Default::default() };
    let all = vec![layer(0.4, 500.0), layer(0.8, 1200.0), layer(0.3, 7000.0)];
    let clouds = if has_clouds { all } else { Vec::new() };
    Weather { visibility_m: 2500.0, fog: Fog::of(FogKind::Mist), clouds, precipitation, ..Weather::default() }
}

/// Waits until the GPU is idle before each timed call, so that only CPU time is counted.
fn compare(change: Change, backends: wgpu::Backends) -> Fallible<()> {
    let device = Device::headless(&DeviceOptions { backends, ..Default::default() })?;
    let shared = Arc::new(Shared::new(&device)?);
    let mut desc = ContextDesc::default();
    if change != Change::Turn {
        desc.world.kind = WorldKind::Tangent;
    }
    let mut context = Context::new(device.clone(), shared, desc)?;
    match change {
        Change::Turn => context.set_sun(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg: 30.0 }))?,
        _ => context.set_weather(&rainy(change != Change::RainAlone), 0.0, 0.0)?,
    }
    let mut view = View::new(&context)?;
    let color = texture(&device, wgpu::TextureFormat::Rgba16Float);
    let depth = texture(&device, wgpu::TextureFormat::Depth32Float);
    let target = color.create_view(&Default::default());
    let (mut ours, mut empty) = (Vec::new(), Vec::new());
    // A software driver draws every frame: a quarter of them gives the median as well.
    let frames: u32 = if backends == wgpu::Backends::NOOP { 2000 } else { 500 };
    for id in 0..frames {
        let angle = f64::from(id) * 0.01;
        let along = if change == Change::Turn { 0.0 } else { 0.2 * f64::from(id) };
        let (place, forward) = (DVec3::new(along, 0.5 * along, 50.0), DVec3::new(angle.sin(), angle.cos(), 0.1));
        let camera = Camera::look_to(place, forward, DVec3::Z, 1.0, 1.6, 0.1);
        let frame = Frame::new(id.into(), camera, &color, Some(&depth));
        if matches!(change, Change::Time | Change::RainAlone) {
            context.update(f64::from(id) / 60.0)?;
        }
        let start = Instant::now();
        view.record(&context, &frame, Stages::ALL)?;
        ours.push(start.elapsed());
        device.wait()?;
        let start = Instant::now();
        submit_empty_pass(&device, &target);
        empty.push(start.elapsed());
        device.wait()?;
    }
    let settled = frames as usize / 10;
    let (ours, empty) = (median(ours.split_off(settled)), median(empty.split_off(settled)));
    let name = match change {
        Change::Turn => "camera turning",
        Change::Drive => "camera driving in rain",
        Change::Time => "camera driving in rain, time running",
        Change::RainAlone => "camera driving in rain without clouds, time running",
    };
    println!(
        "record, {name} ({}): {ours:.1} us, an empty pass with submit {empty:.1} us, ratio {:.2}",
        device.caps().adapter_name,
        ours / empty
    );
    Ok(())
}

pub fn run() -> Fallible<()> {
    for backends in [wgpu::Backends::NOOP, DeviceOptions::default().backends] {
        for change in [Change::Turn, Change::Drive, Change::Time, Change::RainAlone] {
            compare(change, backends)?;
        }
    }
    Ok(())
}
