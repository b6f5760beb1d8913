//! One frame of the default sky, including its tables for a new sun and observer, against a march in every pixel with
//! the same multiple scattering, interleaved in one run.

use std::time::Instant;

use bytemuck::cast_slice;
use welkin::gpu::pass::{FullscreenDesc, draw, fullscreen};
use welkin::gpu::{Device, DeviceOptions};
use welkin::sky::{Observer, Planet, SkyModel, SkySettings, SkyTables, SkyVolume};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

const SIZE: (u32, u32) = (640, 360);

struct Sky {
    tables: SkyTables,
    volume: SkyVolume,
    pipeline: wgpu::RenderPipeline,
    camera: wgpu::BindGroup,
    target: wgpu::TextureView,
}

impl Sky {
    fn new(device: &std::sync::Arc<Device>, settings: &SkySettings, planet: &Planet) -> Fallible<Self> {
        let mut tables = SkyTables::new(device, settings)?;
        let mut encoder = device.device.create_command_encoder(&Default::default());
        tables.update(&mut encoder, planet, 1.0)?;
        device.submit_and_wait(encoder)?;
        let volume = SkyVolume::new(&tables)?;
        let layout = device.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let buffer = device.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 16,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        device.queue.write_buffer(&buffer, 0, cast_slice(&[1.0f32, 0.0, 0.0, 360.0 / 640.0]));
        let camera = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        });
        let format = wgpu::TextureFormat::Rgba16Float;
        let desc = FullscreenDesc {
            shader: "sky/picture.wgsl",
            entry: "picture",
            layouts: &[&layout, volume.layout()],
            targets: &[format.into()],
            constants: &tables.pipeline_constants(),
            samples: 1,
        };
        let pipeline = fullscreen(device, &desc)?;
        let target =
            welkin::gpu::flat_texture(&device.device, "sky", SIZE, format, wgpu::TextureUsages::RENDER_ATTACHMENT);
        Ok(Self { tables, volume, pipeline, camera, target: target.create_view(&Default::default()) })
    }

    /// Times of the tables for `observer` and of the picture, ms.
    fn frame(&mut self, device: &Device, observer: &Observer) -> Fallible<(f64, f64)> {
        let start = Instant::now();
        let mut encoder = device.device.create_command_encoder(&Default::default());
        self.volume.prepare(&mut encoder, &self.tables, observer)?;
        device.submit_and_wait(encoder)?;
        let tables = start.elapsed();
        let start = Instant::now();
        let mut encoder = device.device.create_command_encoder(&Default::default());
        let groups = [&self.camera, self.volume.bind_group()];
        draw(&mut encoder, "picture", &self.pipeline, &groups, &self.target);
        device.submit_and_wait(encoder)?;
        Ok((tables.as_secs_f64() * 1e3, start.elapsed().as_secs_f64() * 1e3))
    }
}

/// The minimum of several times: the time needed when nothing else runs.
fn least(times: &[f64]) -> f64 {
    times.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Prints the times and their ratio.
pub fn run() -> Fallible<()> {
    let device = Device::headless(&DeviceOptions::default())?;
    let planet = Planet::earth();
    let start = Instant::now();
    let mut drawn = Sky::new(&device, &SkySettings::default(), &planet)?;
    let first = start.elapsed().as_secs_f64();
    let mut encoder = device.device.create_command_encoder(&Default::default());
    drawn.tables.update(&mut encoder, &planet.with_air_scaled(1.01), 1.0)?;
    let start = Instant::now();
    device.submit_and_wait(encoder)?;
    let build = start.elapsed().as_secs_f64();
    let mut marched = Sky::new(&device, &SkySettings::with_model(SkyModel::BruteForce), &planet)?;
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for i in 0..14 {
        let observer = Observer::under_sun(&planet, 500.0 + 10.0 * f64::from(i), 1.2 + 0.01 * f64::from(i));
        ours.push(drawn.frame(&device, &observer)?);
        if i % 3 == 0 {
            theirs.push(marched.frame(&device, &observer)?.1);
        }
    }
    let tables = least(&ours[2..].iter().map(|t| t.0).collect::<Vec<_>>());
    let picture = least(&ours[2..].iter().map(|t| t.1).collect::<Vec<_>>());
    let march = least(&theirs[1..]);
    println!(
        "sky, 640x360, {}: tables for a moved sun {tables:.1} ms, picture {picture:.1} ms; 64 nodes a pixel {march:.1} ms; \
         frame to march 1/{:.1}; a planet's tables {build:.2} s ({first:.2} s with pipelines)",
        device.caps().adapter_name,
        march / (tables + picture)
    );
    Ok(())
}
