//! Devices on every driver that is there: faults, waits and losses.

use std::time::Instant;

use super::*;

#[test]
fn a_noop_device_exists_everywhere() {
    let options = DeviceOptions { backends: wgpu::Backends::NOOP, ..Default::default() };
    let device = Device::headless(&options).unwrap();
    assert_eq!(device.caps().backend, wgpu::Backend::Noop);
}

/// Submits a draw of `side` x `side` texels, each with a long loop; returns the time until the GPU has finished, s.
fn busy(device: &Device, side: u32) -> Result<f64> {
    let text = "@vertex fn v(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
            return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
        }
        @fragment fn f(@builtin(position) p: vec4f) -> @location(0) vec4f {
            var x = p.x;
            for (var i = 0u; i < 20000u; i++) { x = fract(sin(x) * 43758.5 + p.y); }
            return vec4f(x);
        }";
    let source = wgpu::ShaderSource::Wgsl(text.into());
    let module = device.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let pipeline = device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("v"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("f"),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
    let target = crate::gpu::flat_texture(&device.device, "busy", (side, side), format, usage);
    let view = target.create_view(&Default::default());
    let mut encoder = device.device.create_command_encoder(&Default::default());
    crate::gpu::pass::draw(&mut encoder, "busy", &pipeline, &[], &view);
    let begun = Instant::now();
    device.submit_and_wait(encoder)?;
    Ok(begun.elapsed().as_secs_f64())
}

/// A wait must last until the GPU has finished, although wgpu's OpenGL backend itself waits for 2.1 s at most.
#[test]
fn a_wait_lasts_as_long_as_the_work() {
    let options = DeviceOptions { backends: wgpu::Backends::GL, ..Default::default() };
    let device = Device::headless(&options).unwrap();
    // A GPU that is busy for so long would count as hung; a software driver does not.
    assert!(device.caps().software, "tests run on software drivers");
    // The first draw compiles.
    let mut side = 32;
    let mut took = busy(&device, side).unwrap();
    while took < 3.0 && side < 8192 {
        side = (f64::from(side) * (4.0 / took.max(0.01)).sqrt().clamp(1.2, 4.0)) as u32;
        took = busy(&device, side.min(8192)).unwrap();
    }
    println!("{side} texels along a side: {took:.2} s");
    assert!(took > 2.1 || side >= 8192, "work of {took:.2} s tells nothing");
    let after = device.device.poll(wgpu::PollType::Poll).unwrap();
    assert!(after.is_queue_empty(), "work is left after the wait");
}

#[test]
fn an_error_of_wgpu_is_returned_once_and_a_lost_device_is_reported() {
    let device = Device::headless(&DeviceOptions::default()).unwrap();
    let _ = device.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 0, height: 1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    assert_eq!(device.check().unwrap_err().status, Status::Internal);
    assert!(device.check().is_ok());
    device.simulate_loss();
    assert_eq!(device.enter().err().unwrap().status, Status::DeviceLost);
}
