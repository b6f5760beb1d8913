//! A host that draws its pictures on the CPU, exactly, by the ray of each pixel.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
    ground::SurfaceClass,
    scene::{Camera, DepthMapping, ViewRays},
    weather::{Surface, SurfaceState, Weather, Wind},
};
use welkin_support::{coarse_sky::coarse_sky, textures::texture};

pub const SIZE: (u32, u32) = (160, 90);

/// Writes the depths of a texture of floats.
const DEPTH_SHADER: &str = "
@group(0) @binding(0) var depths: texture_2d<f32>;
@vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}
@fragment fn depth(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 {
    return textureLoad(depths, vec2i(at.xy), 0).x;
}
";

/// Point that a ray meets: distance along it, m, and luminance.
pub type Hit = Option<(f64, [f64; 3])>;

pub struct Host {
    pub device: Arc<Device>,
    pub context: Context,
    pub view: View,
    pub color: wgpu::Texture,
    pub depth: wgpu::Texture,
    frame_id: u64,
}

pub fn look(position: DVec3, azimuth_deg: f64, elevation_deg: f64, fov: f64) -> Camera {
    let forward = welkin::sky::sun::direction(azimuth_deg, elevation_deg);
    let up = if elevation_deg < -80.0 { DVec3::Y } else { DVec3::Z };
    Camera::look_to(position, forward, up, fov, f64::from(SIZE.0) / f64::from(SIZE.1), 0.1)
}

/// The direction through pixel (x, y).
pub fn ray(camera: &Camera, x: u32, y: u32) -> DVec3 {
    rays(camera).view_ray(ndc(x, y)).direction
}

/// Returns a changed saved state with a correct checksum, so that later checks must find the change.
pub fn resealed(state: &str) -> Vec<u8> {
    let body = state.split_once('\n').unwrap().1;
    let fold = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    let sum = body.bytes().fold(0xcbf2_9ce4_8422_2325, fold);
    format!("welkin state 2 {sum:016x}\n{body}").into_bytes()
}

fn rays(camera: &Camera) -> ViewRays {
    ViewRays::new(camera, &DepthMapping { reversed: true, ..Default::default() }).unwrap()
}

pub fn ndc(x: u32, y: u32) -> DVec2 {
    let uv = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / DVec2::new(f64::from(SIZE.0), f64::from(SIZE.1));
    DVec2::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y)
}

/// Level ground at altitude 0 under `position`.
pub fn ground(position: DVec3, direction: DVec3, luminance: [f64; 3]) -> Hit {
    (direction.z < -1e-6).then(|| (-position.z / direction.z, luminance))
}

impl Host {
    pub fn new() -> Self {
        Self::on(Device::headless(&DeviceOptions::default()).expect("a software driver is installed"))
    }

    pub fn on(device: Arc<Device>) -> Self {
        let shared = Arc::new(Shared::new(&device).unwrap());
        let mut context =
            Context::new(device.clone(), shared, ContextDesc { sky: coarse_sky(), ..ContextDesc::default() }).unwrap();
        context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg: 40.0 })).unwrap();
        // Most tests need asphalt.
        context.set_default_surface_class(SurfaceClass::Paved);
        let view = View::new(&context).unwrap();
        let color = texture(&device, SIZE, wgpu::TextureFormat::Rgba32Float, 1);
        let depth = texture(&device, SIZE, wgpu::TextureFormat::R32Float, 1);
        Self { device, context, view, color, depth, frame_id: 0 }
    }

    /// Calm weather over ground in this state.
    pub fn ground_is(&mut self, state: SurfaceState) {
        let surface = Surface { state: Some(state), ..Surface::default() };
        let weather = Weather { surface, wind: Wind::of(0.0, 0.0), ..Weather::default() };
        self.context.set_weather(&weather, self.context.time_s(), 0.0).unwrap();
    }

    /// The host's picture, before any weather.
    pub fn paint(&self, camera: &Camera, meet: impl Fn(DVec3) -> Hit) {
        let rays = rays(camera);
        let (mut colors, mut depths) = (Vec::new(), Vec::new());
        for y in 0..SIZE.1 {
            for x in 0..SIZE.0 {
                let hit = meet(rays.view_ray(ndc(x, y)).direction);
                let c = hit.map_or([0.0; 3], |h| h.1);
                colors.push([c[0] as f32, c[1] as f32, c[2] as f32, 1.0]);
                depths.push(hit.map_or(0.0, |h| rays.depth_at(h.0, ndc(x, y)) as f32));
            }
        }
        let layout = |bytes| wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(SIZE.0 * bytes),
            rows_per_image: None,
        };
        let queue = &self.device.queue;
        if self.color.format() == wgpu::TextureFormat::Rgba16Float {
            let halves: Vec<[u16; 4]> = colors.iter().map(|c| c.map(|v| half::f16::from_f32(v).to_bits())).collect();
            let bytes: &[u8] = bytemuck::cast_slice(&halves);
            queue.write_texture(self.color.as_image_copy(), bytes, layout(8), self.color.size());
        } else {
            queue.write_texture(
                self.color.as_image_copy(),
                bytemuck::cast_slice(&colors),
                layout(16),
                self.color.size(),
            );
        }
        queue.write_texture(self.depth.as_image_copy(), bytemuck::cast_slice(&depths), layout(4), self.depth.size());
    }

    /// Writes a picture of the host's, row by row from the top.
    pub fn write(&self, colors: &[[f32; 4]]) {
        let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE.0 * 16), rows_per_image: None };
        let bytes = bytemuck::cast_slice(colors);
        self.device.queue.write_texture(self.color.as_image_copy(), bytes, rows, self.color.size());
    }

    /// Creates an image of the picture's size from its bytes, row by row from the top.
    pub fn image(&self, format: wgpu::TextureFormat, bytes: &[u8]) -> wgpu::Texture {
        let image = texture(&self.device, SIZE, format, 1);
        let bytes_per_row = Some(bytes.len() as u32 / SIZE.1);
        let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None };
        self.device.queue.write_texture(image.as_image_copy(), bytes, rows, image.size());
        image
    }

    /// A depth buffer of 24 bits that holds these depths, row by row from the top.
    pub fn depth_24(&self, depths: &[f64]) -> wgpu::Texture {
        let device = &self.device.device;
        let floats: Vec<f32> = depths.iter().map(|d| *d as f32).collect();
        let source = texture(&self.device, SIZE, wgpu::TextureFormat::R32Float, 1);
        let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE.0 * 4), rows_per_image: None };
        self.device.queue.write_texture(source.as_image_copy(), bytemuck::cast_slice(&floats), rows, source.size());
        let format = wgpu::TextureFormat::Depth24Plus;
        let depth = texture(&self.device, SIZE, format, 1);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(DEPTH_SHADER.into()),
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("depth"),
                compilation_options: Default::default(),
                targets: &[],
            }),
            multiview_mask: None,
            cache: None,
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&source.create_view(&Default::default())),
            }],
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        let view = depth.create_view(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &view,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        self.device.queue.submit([encoder.finish()]);
        depth
    }

    pub fn use_half_floats(&mut self) {
        self.color = texture(&self.device, SIZE, wgpu::TextureFormat::Rgba16Float, 1);
    }

    /// The picture with these stages drawn over it.
    pub fn shoot(&mut self, camera: Camera, stages: Stages, meet: impl Fn(DVec3) -> Hit) -> Vec<[f32; 4]> {
        self.paint(&camera, meet);
        self.frame_id += 1;
        self.record(camera, stages);
        self.pixels()
    }

    pub fn record(&mut self, camera: Camera, stages: Stages) {
        let frame = Frame::new(self.frame_id, camera, &self.color, Some(&self.depth));
        self.view.record(&self.context, &frame, stages).unwrap();
    }

    pub fn next_frame(&mut self) -> u64 {
        self.frame_id += 1;
        self.frame_id
    }

    pub fn pixels(&self) -> Vec<[f32; 4]> {
        readback::rgba(&self.device, &self.color).unwrap()
    }
}
