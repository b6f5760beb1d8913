//! Draws and times every way to draw fog, and computes the truth.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use welkin::candidates::Method as LibraryMethod;
use welkin::fog::candidates::FogMethod;
use welkin::fog::reference::fog_along;
use welkin::fog::{FogModel, Law, LowAirUniform, Viewpoint};
use welkin::gpu::{Device, flat_texture, pass, readback, shader};
use welkin::scene::depth::RANGE_SKY_M;
use welkin::scene::{Camera, DepthMapping, ViewRays};
use welkin::{Error, Result};
use welkin_support::fullscreen;

use crate::candidates::{Candidate, Method};
use crate::picture::Picture;
use crate::scenes::FogScene;
use crate::timing::{target, timed};

/// Size of the pictures whose error is measured.
pub const SIZE: (u32, u32) = (128, 72);
const FLOAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
const HALF: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// The host's picture: colour and depth.
pub struct Host {
    pub rays: ViewRays,
    size: (u32, u32),
    colour: Vec<[f32; 4]>,
    depth: Vec<f32>,
}

/// A plain with the ground's reflectance, eight masts of 1 m width at different distances, and sky above.
pub fn host(scene: &FogScene, size: (u32, u32)) -> Result<Host> {
    let (s, c) = scene.elevation_deg.to_radians().sin_cos();
    let aspect = f64::from(size.0) / f64::from(size.1);
    let camera = Camera::look_to(DVec3::ZERO, DVec3::new(0.0, c, s), DVec3::Z, 0.9, aspect, 0.1);
    let rays = ViewRays::new(&camera, &DepthMapping { reversed: true, ..Default::default() })?;
    let light = scene.light();
    let lit: [f64; 3] = std::array::from_fn(|i| {
        let e = light.sun_irradiance[i] * light.to_sun.z.max(0.0) + light.sky_irradiance[i];
        light.ground_albedo[i] * e / std::f64::consts::PI
    });
    let (mut colour, mut depth) = (Vec::new(), Vec::new());
    for y in 0..size.1 {
        for x in 0..size.0 {
            let ndc = ndc(x, y, size);
            let ray = rays.view_ray(ndc);
            let d = ray.direction;
            let mut range = if d.z < 0.0 { -scene.altitude_m / d.z } else { f64::INFINITY };
            let mut texel = if d.z < 0.0 { lit } else { light.sky_irradiance.map(|e| e / std::f64::consts::PI) };
            for i in 0..8 {
                // Masts are 12 m high and stand in a fan, each twice as far away as the one before.
                let far = 15.0 * 2f64.powi(i);
                let left = far * (0.11 * f64::from(i) - 0.44);
                let t = far / d.y;
                let (east, height) = (d.x * t, scene.altitude_m + d.z * t);
                let half = 0.5 + 0.004 * far;
                if t < range && (east - left).abs() < half && (0.0..12.0).contains(&height) {
                    (range, texel) = (t, [0.01, 0.01, 0.012]);
                }
            }
            let far = !range.is_finite();
            depth.push(if far { 0.0 } else { rays.depth_at(range, ndc) as f32 });
            let [r, g, b] = texel.map(|v| v as f32);
            colour.push([r, g, b, 1.0]);
        }
    }
    Ok(Host { rays, size, colour, depth })
}

fn ndc(x: u32, y: u32, size: (u32, u32)) -> DVec2 {
    let u = (f64::from(x) + 0.5) / f64::from(size.0);
    let v = (f64::from(y) + 0.5) / f64::from(size.1);
    DVec2::new(2.0 * u - 1.0, 1.0 - 2.0 * v)
}

fn viewpoint(scene: &FogScene) -> Viewpoint {
    Viewpoint { planet_radius_m: 6.371e6, ..Viewpoint::flat(scene.altitude_m) }
}

/// The fog model of a scene with one fog law.
pub fn model(scene: &FogScene, law: &Law) -> Result<FogModel> {
    FogModel::new(law, &scene.light(), &viewpoint(scene))
}

/// The truth: the closed form in f64 at every pixel, from the host's depth.
pub fn truth(scene: &FogScene, host: &Host) -> Result<Picture> {
    let model = model(scene, &Law::Layer(scene.layer))?;
    let texel = |i: usize| {
        let ndc = ndc(i as u32 % host.size.0, i as u32 / host.size.0, host.size);
        let ray = host.rays.view_ray(ndc);
        let depth = f64::from(host.depth[i]);
        let range = host.rays.view_range(depth, ndc).min(RANGE_SKY_M);
        let plane = host.rays.view_plane(depth, ndc);
        let fog = fog_along(&model, ray.origin, ray.direction, range, plane);
        let c = host.colour[i];
        let c = DVec3::new(f64::from(c[0]), f64::from(c[1]), f64::from(c[2]));
        (c * fog.transmittance + fog.radiance).to_array()
    };
    Ok(Picture { width: host.size.0, height: host.size.1, texels: (0..host.colour.len()).map(texel).collect() })
}

/// A GPU bench that draws fog into scenes by the different methods.
pub struct Bench {
    device: Arc<Device>,
    module: wgpu::ShaderModule,
    layouts: [wgpu::BindGroupLayout; 2],
    sampler: wgpu::Sampler,
    wide: bool,
}

/// One way to draw fog into a scene, ready to run.
pub struct FogDraw {
    device: Arc<Device>,
    fill: Option<(wgpu::RenderPipeline, [wgpu::TextureView; 2])>,
    apply: wgpu::RenderPipeline,
    groups: [wgpu::BindGroup; 2],
    target: wgpu::Texture,
}

impl Bench {
    /// Creates shaders and layouts.
    pub fn new(device: &Arc<Device>) -> Result<Self> {
        let gpu = &device.device;
        let text = [shader::assemble("fog/lookup.wgsl")?, shader::assemble("common/fullscreen.wgsl")?];
        let source = wgpu::ShaderSource::Wgsl((text.concat() + include_str!("fog.wgsl")).into());
        let module = gpu.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("lab fog"), source });
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let texture = |filterable| wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let make = |entries: &[wgpu::BindGroupLayoutEntry]| {
            gpu.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("lab fog"), entries })
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let layouts = [
            make(&[entry(0, uniform), entry(4, uniform), entry(1, texture(false)), entry(2, texture(false))]),
            make(&[entry(0, texture(true)), entry(1, texture(true)), entry(2, sampler)]),
        ];
        let linear = gpu.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        // Software OpenGL cannot render to 32-bit floats.
        let usages = device.adapter.get_texture_format_features(FLOAT).allowed_usages;
        let wide = usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT);
        Ok(Self { device: device.clone(), module, layouts, sampler: linear, wide })
    }

    fn pipeline(
        &self,
        entry: &str,
        constants: &[(&str, f64)],
        formats: &[wgpu::TextureFormat],
    ) -> wgpu::RenderPipeline {
        let both = [&self.layouts[0], &self.layouts[1]];
        let groups = if entry == "froxels_apply" { &both[..] } else { &both[..1] };
        let targets: Vec<_> = formats.iter().map(|f| (*f).into()).collect();
        fullscreen::pipeline(
            &self.device.device,
            &self.module,
            (fullscreen::VERTEX, entry, constants),
            groups,
            &targets,
        )
    }

    fn upload(&self, format: wgpu::TextureFormat, size: (u32, u32), bytes: &[u8]) -> wgpu::TextureView {
        let texture = flat_texture(
            &self.device.device,
            "lab fog",
            size,
            format,
            wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        );
        let bytes_per_row = Some(bytes.len() as u32 / size.1);
        let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None };
        self.device.queue.write_texture(texture.as_image_copy(), bytes, rows, texture.size());
        texture.create_view(&Default::default())
    }

    /// Prepares a candidate in a scene.
    pub fn make(&self, candidate: &Candidate, scene: &FogScene, host: &Host) -> Result<FogDraw> {
        let Method::Library(LibraryMethod::Fog(method)) = candidate.method else {
            return Err(Error::range("candidate", "one of the fog", candidate.name));
        };
        let gpu = &self.device.device;
        let model = model(scene, &method.law(&scene.layer))?;
        let mut bytes = bytemuck::bytes_of(&model.uniform()).to_vec();
        bytes.extend_from_slice(bytemuck::bytes_of(&host.rays.uniform()));
        let buffer = gpu.create_buffer(&wgpu::BufferDescriptor {
            label: Some("lab fog"),
            size: bytes.len().max(size_of::<LowAirUniform>()) as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.device.queue.write_buffer(&buffer, 0, &bytes);
        let colour = self.upload(FLOAT, host.size, bytemuck::cast_slice(&host.colour));
        let depth = self.upload(wgpu::TextureFormat::R32Float, host.size, bytemuck::cast_slice(&host.depth));
        let cells = match method {
            FogMethod::Froxels { cells } => cells,
            _ => [1, 1, 1],
        };
        let across = (cells[2] as f32).sqrt().ceil() as u32;
        let atlas = (cells[0] * across, cells[1] * cells[2].div_ceil(across));
        let atlases = [0; 2].map(|_| target(&self.device, atlas, HALF).create_view(&Default::default()));
        let view = |binding, v| wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(v) };
        let bound = |layout, entries: &[wgpu::BindGroupEntry<'_>]| {
            gpu.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries })
        };
        let [first, own] = [0, 4].map(|binding| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() });
        let sampler = wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(&self.sampler) };
        let groups = [
            bound(&self.layouts[0], &[first, own, view(1, &colour), view(2, &depth)]),
            bound(&self.layouts[1], &[view(0, &atlases[0]), view(1, &atlases[1]), sampler]),
        ];
        let kinds = ("DEPTH_KINDS", f64::from(host.rays.depth_kinds()));
        let narrow = [&model.variant().constants()[..], &[kinds]].concat();
        let format = if self.wide { FLOAT } else { HALF };
        let sizes = ["CELLS_X", "CELLS_Y", "CELLS_Z"].map(|n| n.to_owned());
        let sized: Vec<(&str, f64)> = sizes
            .iter()
            .zip(cells)
            .map(|(n, c)| (n.as_str(), f64::from(c)))
            .chain([("ACROSS", f64::from(across))])
            .collect();
        let (fill, apply) = match method {
            FogMethod::Froxels { .. } => {
                let all = [&narrow[..], &sized].concat();
                let fill = self.pipeline("froxels_fill", &all, &[HALF; 2]);
                (Some((fill, atlases)), self.pipeline("froxels_apply", &all, &[format]))
            }
            FogMethod::ExactForAll => (None, self.pipeline("fogged", &[], &[format])),
            _ => (None, self.pipeline("fogged", &narrow, &[format])),
        };
        let target = target(&self.device, host.size, format);
        Ok(FogDraw { device: self.device.clone(), fill, apply, groups, target })
    }
}

impl FogDraw {
    /// Draws one frame and returns its time, ms.
    pub fn frame(&self) -> Result<f64> {
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        if let Some((pipeline, views)) = &self.fill {
            let ops = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
            let attach =
                |view| Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops });
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("froxels"),
                color_attachments: &[attach(&views[0]), attach(&views[1])],
                ..Default::default()
            });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &self.groups[0], &[]);
            pass.draw(0..3, 0..1);
        }
        let groups = [&self.groups[0], &self.groups[1]];
        let used = if self.fill.is_some() { &groups[..] } else { &groups[..1] };
        pass::draw(&mut encoder, "fog", &self.apply, used, &self.target.create_view(&Default::default()));
        timed(&self.device, encoder)
    }

    /// Reads the picture.
    pub fn picture(&self) -> Result<Picture> {
        self.frame()?;
        let texels = readback::rgba(&self.device, &self.target)?;
        let three = |t: &[f32; 4]| [t[0], t[1], t[2]].map(f64::from);
        let (width, height) = (self.target.width(), self.target.height());
        Ok(Picture { width, height, texels: texels.iter().map(three).collect() })
    }
}
