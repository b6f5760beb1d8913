//! What the CPU pays for `View::record`: against an empty wgpu pass with its submit, interleaved in one run.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions},
    scene::Camera,
};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

fn texture(device: &Device, format: wgpu::TextureFormat) -> wgpu::Texture {
    use wgpu::TextureUsages as U;
    let color = if format.has_depth_aspect() { U::empty() } else { U::COPY_SRC };
    device.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 64, height: 36, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: U::RENDER_ATTACHMENT | U::TEXTURE_BINDING | color,
        view_formats: &[],
    })
}

fn empty_pass(device: &Device, target: &wgpu::TextureView) {
    let mut encoder = device.device.create_command_encoder(&Default::default());
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    });
    device.queue.submit([encoder.finish()]);
}

fn median(mut times: Vec<Duration>) -> f64 {
    times.sort();
    times[times.len() / 2].as_secs_f64() * 1e6
}

/// The GPU is idle before each timed call, so that only the CPU's part is counted.
fn compare(name: &str, backends: wgpu::Backends) -> Fallible<()> {
    let device = Device::headless(&DeviceOptions { backends, ..Default::default() })?;
    let shared = Arc::new(Shared::new(&device)?);
    let mut context = Context::new(device.clone(), shared, ContextDesc::default())?;
    context.set_sun(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg: 30.0 }))?;
    let mut view = View::new(&context)?;
    let color = texture(&device, wgpu::TextureFormat::Rgba16Float);
    let depth = texture(&device, wgpu::TextureFormat::Depth32Float);
    let target = color.create_view(&Default::default());
    let (mut ours, mut empty) = (Vec::new(), Vec::new());
    for id in 0..2000u64 {
        let angle = id as f64 * 0.01;
        let forward = DVec3::new(angle.sin(), angle.cos(), 0.1);
        let camera = Camera::look_to(DVec3::new(0.0, 0.0, 50.0), forward, DVec3::Z, 1.0, 1.6, 0.1);
        let frame = Frame::new(id, camera, &color, Some(&depth));
        let start = Instant::now();
        view.record(&context, &frame, Stages::ALL)?;
        ours.push(start.elapsed());
        device.wait()?;
        let start = Instant::now();
        empty_pass(&device, &target);
        empty.push(start.elapsed());
        device.wait()?;
    }
    let (ours, empty) = (median(ours.split_off(200)), median(empty.split_off(200)));
    println!(
        "record, camera turning, {name} ({}): {ours:.1} us, an empty pass with submit {empty:.1} us, ratio {:.2}",
        device.caps().adapter_name,
        ours / empty
    );
    Ok(())
}

pub fn run() -> Fallible<()> {
    compare("noop", wgpu::Backends::NOOP)?;
    compare("own device", DeviceOptions::default().backends)
}
