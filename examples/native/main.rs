//! A Rust host with its own `wgpu::Device`. It draws its world, and Welkin draws the weather into the same textures.
//!
//! `cargo run --release --example native [-- FILE.png [METAR]]` writes one picture.

mod world;

use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;

use glam::{DVec3, Mat4, Vec2};
use welkin::{
    context::{Context, ContextDesc, GivenDirection, Scene},
    frame::{Frame, Shared, Stages, View, tone},
    gpu::{Device, readback},
    rain::RainSettings,
    scene::Camera,
    weather::Weather,
};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

const SIZE: (u32, u32) = (640, 360);

/// Camera position on the level floor of the valley, m east and north of the terrain's centre.
const AT: Vec2 = Vec2::new(2604.0, 138.8);

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct HostUniform {
    view_projection: Mat4,
    sun: [f32; 4],
    sun_light: [f32; 4],
    sky_light: [f32; 4],
}

/// Everything the host owns. Welkin sees only `device` and the two targets.
struct Host {
    device: Arc<Device>,
    pipeline: wgpu::RenderPipeline,
    uniform: wgpu::Buffer,
    group: wgpu::BindGroup,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    classes: wgpu::Texture,
    terrain: world::Terrain,
}

/// Creates the host's own instance, adapter, device and queue, and lends them to Welkin.
fn lend_device() -> Fallible<Arc<Device>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
    Ok(Device::adopt(instance, adapter, device, queue, false, None)?)
}

fn target(device: &wgpu::Device, format: wgpu::TextureFormat) -> wgpu::Texture {
    use wgpu::TextureUsages as U;
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE.0, height: SIZE.1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: U::RENDER_ATTACHMENT | U::TEXTURE_BINDING | U::COPY_SRC,
        view_formats: &[],
    })
}

impl Host {
    fn new() -> Fallible<Self> {
        let lent = lend_device()?;
        let device = &lent.device;
        let module = device.create_shader_module(wgpu::include_wgsl!("scene.wgsl"));
        let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32];
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("host"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<world::Vertex>() as u64,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &attributes,
                })],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: wgpu::TextureFormat::Depth32Float,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::TextureFormat::Rgba16Float.into()), Some(wgpu::TextureFormat::R8Unorm.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: size_of::<HostUniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }],
        });
        let color = target(device, wgpu::TextureFormat::Rgba16Float);
        let depth = target(device, wgpu::TextureFormat::Depth32Float);
        let classes = target(device, wgpu::TextureFormat::R8Unorm);
        let terrain = world::Terrain::read("examples/data/jacksboro_dem.png")?;
        Ok(Self { pipeline, uniform, group, color, depth, classes, terrain, device: lent.clone() })
    }

    /// Vertices relative to the camera, so that f32 is precise enough.
    fn vertices(&self, eye: DVec3) -> wgpu::Buffer {
        let mut mesh = world::mesh(&self.terrain, eye.truncate().as_vec2());
        for v in &mut mesh {
            for (p, e) in v.position.iter_mut().zip(eye.to_array()) {
                *p -= e as f32;
            }
        }
        let buffer = self.device.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: size_of_val(&mesh[..]) as u64,
            usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.device.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&mesh));
        buffer
    }

    /// Draws the host's own world, lit by Welkin's answers about sun and sky.
    fn draw(&self, encoder: &mut wgpu::CommandEncoder, camera: &Camera, scene: &Scene, world: &wgpu::Buffer) {
        let pad = |v: [f64; 3]| [v[0] as f32, v[1] as f32, v[2] as f32, 0.0];
        let block = HostUniform {
            view_projection: (camera.projection * camera.view).as_mat4(),
            sun: pad(scene.sun.direction.to_array()),
            sun_light: pad(scene.ground.sun_lux),
            sky_light: pad(scene.ground.sky_lux),
        };
        self.device.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&block));
        let [color, depth, classes] =
            [&self.color, &self.depth, &self.classes].map(|t| t.create_view(&Default::default()));
        let cleared = |view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("host"),
            color_attachments: &[cleared(&color), cleared(&classes)],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_vertex_buffer(0, world.slice(..));
        pass.draw(0..(world.size() / size_of::<world::Vertex>() as u64) as u32, 0..1);
    }
}

/// Draws the host's world with the weather in it.
fn take(host: &Host, shared: &Arc<Shared>, weather: Weather, path: &str) -> Fallible<()> {
    let mut context = Context::new(host.device.clone(), shared.clone(), ContextDesc::default())?;
    let ground = f64::from(host.terrain.height(AT));
    let weather = Weather { station_altitude_m: ground, ..weather };
    context.set_sun(Some(GivenDirection { azimuth_deg: 70.0, elevation_deg: 35.0 }))?;
    context.set_weather(&weather, 0.0, 0.0)?;
    let eye = DVec3::new(f64::from(AT.x), f64::from(AT.y), ground + 1.8);
    let aspect = f64::from(SIZE.0) / f64::from(SIZE.1);
    let forward = DVec3::new(0.14, 0.99, -0.09);
    let camera = Camera::look_to(eye, forward, DVec3::Z, 50_f64.to_radians(), aspect, 0.1);
    let mut view = View::new(&context)?;
    view.set_rain(RainSettings::TRAINER)?;
    let vertices = host.vertices(eye);
    let mut encoder = host.device.device.create_command_encoder(&Default::default());
    let scene = context.scene_at(eye, context.time_s())?;
    host.draw(&mut encoder, &camera, &scene, &vertices);
    // Marks the paved road, which alone reflects.
    let frame = Frame { surface_classes: Some(&host.classes), ..Frame::new(1, camera, &host.color, Some(&host.depth)) };
    view.record_into(&context, &frame, Stages::ALL, &mut encoder)?;
    host.device.submit_and_wait(encoder)?;
    let pixels = readback::rgba(&host.device, &host.color)?;
    let bytes =
        pixels.iter().flat_map(|p| [0, 1, 2].map(|c| (tone::srgb_encode(f64::from(p[c])) * 255.0).round() as u8));
    Ok(welkin_command_line::write_png(Path::new(path), &bytes.collect::<Vec<_>>(), SIZE.into())?)
}

const USAGE: &str =
    "usage: native [FILE.png [METAR]]   one picture of the weather of a report (native.png, rain at Tri-Cities)
       native --help | --version";

/// Draws the picture for the arguments.
fn run(path: &str, metar: &str) -> Fallible<()> {
    let weather = Weather::from_metar(metar)?.weather;
    let host = Host::new()?;
    println!("adapter: {} ({})", host.device.caps().adapter_name, host.device.caps().driver);
    let shared = Arc::new(Shared::new(&host.device)?);
    take(&host, &shared, weather, path)?;
    println!("{path}: {metar}");
    Ok(())
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let Some(text) = welkin_command_line::answered("native", USAGE, arguments.iter().cloned()) {
        print!("{text}");
        return ExitCode::SUCCESS;
    }
    let wrong = arguments.iter().position(|a| a.starts_with('-')).or((arguments.len() > 2).then_some(2));
    if let Some(wrong) = wrong.and_then(|i| arguments.get(i)) {
        let what = if wrong.starts_with('-') { "unknown option" } else { "unexpected argument" };
        eprintln!("native: {what} `{wrong}`\n{USAGE}");
        return ExitCode::from(2);
    }
    let path = arguments.first().map_or("native.png", String::as_str);
    let metar = arguments.get(1).map_or("METAR KTRI 121800Z 24012KT 3SM RA OVC015 12/11 A2978", String::as_str);
    match welkin_command_line::at_work("native", "drawing", || run(path, metar)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("native: {e}");
            ExitCode::FAILURE
        }
    }
}
