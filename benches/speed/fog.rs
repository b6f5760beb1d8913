//! Cost of fog per pixel: a full-screen pass that reads colour and depth and applies fog, against one that only copies
//! the colour.

use std::time::Instant;

use glam::DVec3;
use welkin::{
    fog::{
        CompatibilityLaw, DistanceKind, FogLayer, FogLight, FogModel, Law, LowAirUniform, Patches, Phase, Profile,
        Viewpoint, laws::Curve,
    },
    gpu::{Device, DeviceOptions, shader},
    scene::{Camera, DepthMapping, ViewRays},
};
use welkin_support::fullscreen;

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

const SIZE: wgpu::Extent3d = wgpu::Extent3d { width: 640, height: 360, depth_or_array_layers: 1 };

const PASSES: &str = "
struct Both { fog: FogUniform, depth: DepthUniform }
@group(0) @binding(0) var<uniform> u: Both;
@group(0) @binding(1) var colour: texture_2d<f32>;
@group(0) @binding(2) var depth: texture_2d<f32>;
fn copied(p: vec4f) -> vec4f { return textureLoad(colour, vec2i(p.xy), 0) + u.fog.first.x * 0.0 + textureLoad(depth, vec2i(p.xy), 0).r * 0.0; }
@fragment fn copy(in: FullscreenVarying) -> @location(0) vec4f { return copied(in.position); }
@fragment fn fogged(in: FullscreenVarying) -> @location(0) vec4f {
    let ndc = vec2f(2.0 * in.uv.x - 1.0, 1.0 - 2.0 * in.uv.y);
    let d = textureLoad(depth, vec2i(in.position.xy), 0).r;
    let ray = view_ray(u.depth, ndc);
    let w = view_depth(u.depth, d, ndc);
    let fog = fog_along(u.fog, ray.origin, ray.direction, min(w * ray.slant, RANGE_SKY), w);
    return vec4f(fog_apply(fog, copied(in.position).rgb), 1.0);
}";

struct Bench {
    device: std::sync::Arc<Device>,
    layout: wgpu::BindGroupLayout,
    module: wgpu::ShaderModule,
    colour: wgpu::Texture,
    depth: wgpu::Texture,
    target: wgpu::TextureView,
}

impl Bench {
    fn new() -> Fallible<Self> {
        let device = Device::headless(&DeviceOptions::default())?;
        let gpu = &device.device;
        let texture = |format| {
            use wgpu::TextureUsages as U;
            let usage = U::RENDER_ATTACHMENT | U::TEXTURE_BINDING | U::COPY_DST;
            welkin::gpu::flat_texture(gpu, "fog", (SIZE.width, SIZE.height), format, usage)
        };
        let (colour, depth) = (texture(wgpu::TextureFormat::Rgba16Float), texture(wgpu::TextureFormat::R32Float));
        let target = texture(wgpu::TextureFormat::Rgba16Float).create_view(&Default::default());
        // Ground in the lower half, sky in the upper.
        let texels: Vec<f32> = (0..SIZE.width * SIZE.height)
            .map(|i| (i / SIZE.width) as f32 / 180.0 - 1.0)
            .map(|s| if s > 0.0 { 0.1 * s / 3.0 } else { 0.0 })
            .collect();
        device.queue.write_texture(
            depth.as_image_copy(),
            bytemuck::cast_slice(&texels),
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE.width * 4), rows_per_image: None },
            SIZE,
        );
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let texture_type = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let buffer_type = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let layout = gpu.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[entry(0, buffer_type), entry(4, buffer_type), entry(1, texture_type), entry(2, texture_type)],
        });
        let text = [shader::assemble("fog/lookup.wgsl")?, shader::assemble("common/fullscreen.wgsl")?, PASSES.into()];
        let source = wgpu::ShaderSource::Wgsl(text.concat().into());
        let module = gpu.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        Ok(Self { layout, module, colour, depth, target, device })
    }

    fn pipeline(&self, entry: &str, constants: &[(&str, f64)]) -> wgpu::RenderPipeline {
        let stages = (fullscreen::VERTEX, entry, constants);
        let targets = [wgpu::TextureFormat::Rgba16Float.into()];
        fullscreen::pipeline(&self.device.device, &self.module, stages, &[&self.layout], &targets)
    }

    /// Time of a pass, ms.
    fn time(&self, pipeline: &wgpu::RenderPipeline, model: &FogModel) -> Fallible<f64> {
        let gpu = &self.device.device;
        let mut bytes = bytemuck::bytes_of(&model.uniform()).to_vec();
        bytes.extend_from_slice(bytemuck::bytes_of(&rays()?.uniform()));
        let buffer = gpu.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes.len().max(size_of::<LowAirUniform>()) as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.device.queue.write_buffer(&buffer, 0, &bytes);
        let view = |t: &wgpu::Texture| t.create_view(&Default::default());
        let (colour, depth) = (view(&self.colour), view(&self.depth));
        let texture = |binding, v| wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(v) };
        let group = gpu.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 4, resource: buffer.as_entire_binding() },
                texture(1, &colour),
                texture(2, &depth),
            ],
        });
        let mut times = Vec::new();
        for _ in 0..41 {
            let mut encoder = gpu.create_command_encoder(&Default::default());
            welkin::gpu::pass::draw(&mut encoder, "fog", pipeline, &[&group], &self.target);
            let start = Instant::now();
            self.device.submit_and_wait(encoder)?;
            times.push(start.elapsed().as_secs_f64() * 1e3);
        }
        // The minimum is the time of the work itself; longer times include other load on the machine.
        Ok(times.into_iter().fold(f64::INFINITY, f64::min))
    }
}

fn rays() -> welkin::Result<ViewRays> {
    let camera = Camera::look_to(DVec3::ZERO, DVec3::Y, DVec3::Z, 0.9, 16.0 / 9.0, 0.1);
    ViewRays::new(&camera, &DepthMapping { reversed: true, ..Default::default() })
}

fn laws() -> Vec<(&'static str, Law)> {
    let slab = FogLayer::ground_fog(0.01, 60.0, 20.0);
    let patches = Patches { amount: 1.0, size_m: 80.0, seed: 1, drift_m: [0.0; 2] };
    let exponential = Profile::Exponential { reference_m: 0.0, scale_height_m: 80.0 };
    let law = CompatibilityLaw {
        curve: Curve::Exponential { density_per_m: 0.01 },
        distance: DistanceKind::Range,
        colour: None,
        sky_band: 0.2,
    };
    vec![
        ("clear", Law::Clear),
        ("exponential law", Law::Compatibility(law)),
        ("fog layer", Law::Layer(slab)),
        ("fog in patches", Law::Layer(FogLayer { patches: Some(patches), ..slab })),
        (
            "dust layer",
            Law::Layer(FogLayer { albedo: [0.96, 0.9, 0.8], phase: Phase::HenyeyGreenstein { g: 0.7 }, ..slab }),
        ),
        ("exponential layer", Law::Layer(FogLayer { profile: exponential, ..slab })),
    ]
}

pub fn run() -> Fallible<()> {
    let bench = Bench::new()?;
    let light = FogLight {
        to_sun: DVec3::new(0.6, 0.0, 0.8),
        sun_irradiance: [1.0; 3],
        sky_irradiance: [0.2; 3],
        ground_albedo: [0.15; 3],
    };
    let view = Viewpoint { planet_radius_m: 6.371e6, ..Viewpoint::flat(1.7) };
    let (copy, all) = (bench.pipeline("copy", &[]), bench.pipeline("fogged", &[]));
    let clear = FogModel::new(&Law::Clear, &light, &view)?;
    let base = bench.time(&copy, &clear)?;
    let depth = ("DEPTH_KINDS", f64::from(rays()?.depth_kinds()));
    println!("fog, 640 x 360 ({}): copying pass {base:.2} ms", bench.device.caps().adapter_name);
    for (name, law) in laws() {
        let model = FogModel::new(&law, &light, &view)?;
        let constants = [&model.variant().constants()[..], &[depth]].concat();
        let narrow = bench.time(&bench.pipeline("fogged", &constants), &model)?;
        let wide = bench.time(&all, &model)?;
        println!(
            "  {name}: ratio {:.2} ({narrow:.2} ms), by the pipeline for all laws {:.2}",
            narrow / base,
            wide / base
        );
    }
    Ok(())
}
