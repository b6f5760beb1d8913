//! Elek's table of 2008 as described: single scattering over (altitude, view zenith angle, sun zenith angle), on
//! uniform axes in half floats. Integrals use the trapezoid rule with equal steps; phase functions are applied per
//! pixel.
//!
//! Only what cannot be computed as printed is corrected: haze uses the planet's coefficient (the printed one has no
//! unit), its phase function peaks towards the sun, and a point whose sun is hidden by the planet gets no light. The
//! method's own features are kept: the azimuth is always the sun's, the phase function of gas imitates multiple
//! scattering, haze has one channel and each medium is attenuated only by itself, there is no ozone, and the axes are
//! uniform.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use welkin::Result;
use welkin::gpu::pass::draw;
use welkin::gpu::{Device, readback};
use welkin::plan::{Units, Work};
use welkin::sky::Planet;
use welkin_support::fullscreen;

use super::{Pixel, SkyDraw, Veil, camera_group, camera_layout, moving, sized};
use crate::scenes::{SkyAir, SkyScene};
use crate::timing::{target, timed};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
const WIDTH: u32 = 256;

/// A table of single scattering over (altitude, view zenith angle, sun zenith angle) as in Elek 2008, with uniform
/// axes, half floats, equal steps, the trapezoid rule, and his phase function that imitates multiple scattering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ElekTable {
    /// Texels along each axis; the original came with 128 and 256.
    pub side: u32,
    /// Equal steps of every integral. The author calls 15 acceptable and 50 sufficient.
    pub samples: u32,
}

impl ElekTable {
    /// The cost: a march to the sun at every step of every texel's march.
    pub fn work(&self) -> Work {
        let texels = f64::from(self.side).powi(3);
        let flat = f64::from(self.side).powi(2);
        let n = f64::from(self.samples + 1);
        Work {
            rebuild: Units { samples: texels * n * (n + 1.0) + flat * n, texels: 0.0, bytes: 8.0 * (texels + flat) },
            view: Units::default(),
            // One look-up in the 3-D table; two of the optical depth where the ray meets the ground.
            pixel: Units { samples: 1.0, texels: 2.0, bytes: 8.0 },
            shared_bytes: (8.0 * (texels + flat)) as u64,
            view_bytes: 0,
        }
    }
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Uniform {
    beta: [f32; 3],
    bottom_m: f32,
    irradiance: [f32; 3],
    top_m: f32,
    to_sun: [f32; 3],
    altitude_m: f32,
    haze: f32,
    asymmetry_g: f32,
    scale_m: [f32; 2],
    side: u32,
    samples: u32,
    slice: u32,
    unused: u32,
}

/// The table with its render passes.
pub struct Elek {
    device: Arc<Device>,
    table: ElekTable,
    planet: Planet,
    whole: wgpu::TextureView,
    depth: wgpu::TextureView,
    uniform: wgpu::Buffer,
    build: [wgpu::RenderPipeline; 2],
    picture: wgpu::RenderPipeline,
    probe: wgpu::RenderPipeline,
    build_group: wgpu::BindGroup,
    use_group: wgpu::BindGroup,
    camera: wgpu::BindGroup,
    rays_layout: wgpu::BindGroupLayout,
    target: Option<wgpu::Texture>,
}

impl Elek {
    /// Creates the textures and passes; [`SkyDraw::rebuild`] fills them.
    pub fn new(device: &Arc<Device>, table: ElekTable) -> Result<Self> {
        let gpu = &device.device;
        let source = wgpu::ShaderSource::Wgsl(include_str!("elek.wgsl").into());
        let module = gpu.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("elek"), source });
        let volume = gpu.create_texture(&wgpu::TextureDescriptor {
            label: Some("elek"),
            size: wgpu::Extent3d { width: table.side, height: table.side, depth_or_array_layers: table.side },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D3,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let whole = volume.create_view(&Default::default());
        let depth = target(device, (table.side, table.side), FORMAT).create_view(&Default::default());
        let uniform = gpu.create_buffer(&wgpu::BufferDescriptor {
            label: Some("elek"),
            size: size_of::<Uniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let build_layout = layout(gpu, false);
        let use_layout = layout(gpu, true);
        let camera = camera_layout(device);
        let rays_layout = rays_layout(gpu);
        let pass = |entry, layouts: &[&wgpu::BindGroupLayout], formats: &[wgpu::TextureFormat]| {
            let targets: Vec<_> = formats.iter().map(|format| (*format).into()).collect();
            fullscreen::pipeline(gpu, &module, ("vertex", entry, &[]), layouts, &targets)
        };
        let sampler = gpu.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let texture =
            |binding, view| wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) };
        let bound = |layout, more: &[wgpu::BindGroupEntry<'_>]| {
            let first = wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() };
            let entries = [&[first][..], more].concat();
            gpu.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
        };
        let sampled = wgpu::BindGroupEntry { binding: 3, resource: wgpu::BindingResource::Sampler(&sampler) };
        Ok(Self {
            device: device.clone(),
            table,
            planet: SkyAir::Clear.planet(),
            uniform: uniform.clone(),
            build: [pass("build", &[&build_layout], &[FORMAT]), pass("build_depth", &[&build_layout], &[FORMAT])],
            picture: pass("picture", &[&camera, &use_layout], &[FORMAT]),
            probe: pass("probe", &[&rays_layout, &use_layout], &[wgpu::TextureFormat::Rgba32Float; 2]),
            build_group: bound(&build_layout, &[]),
            use_group: bound(&use_layout, &[texture(1, &whole), texture(2, &depth), sampled]),
            camera: camera_group(device, &camera),
            rays_layout,
            whole,
            depth,
            target: None,
        })
    }

    fn write(&self, altitude_m: f64, to_sun: [f64; 3], slice: u32) {
        let p = &self.planet;
        let f = |v: [f64; 3]| v.map(|x| x as f32);
        let u = Uniform {
            beta: f(p.rayleigh.scattering_per_m),
            bottom_m: p.bottom_radius_m as f32,
            irradiance: f(p.solar_irradiance),
            top_m: p.thickness_m() as f32,
            to_sun: f(to_sun),
            altitude_m: altitude_m as f32,
            haze: p.mie.scattering_per_m[1] as f32,
            asymmetry_g: p.mie.asymmetry_g as f32,
            scale_m: [p.rayleigh.scale_height_m as f32, p.mie.scale_height_m as f32],
            side: self.table.side,
            samples: self.table.samples,
            slice,
            unused: 0,
        };
        self.device.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&u));
    }
}

impl SkyDraw for Elek {
    fn rebuild(&mut self, planet: &Planet) -> Result<f64> {
        self.planet = *planet;
        let mut seconds = 0.0;
        for slice in 0..self.table.side {
            self.write(0.0, [0.0, 0.0, 1.0], slice);
            let mut encoder = self.device.device.create_command_encoder(&Default::default());
            let whole = &self.whole;
            let attach = |view, depth_slice| {
                Some(wgpu::RenderPassColorAttachment {
                    view,
                    depth_slice,
                    resolve_target: None,
                    ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
                })
            };
            let mut one = |pipeline: &wgpu::RenderPipeline, attachment| {
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("elek"),
                    color_attachments: &[attachment],
                    ..Default::default()
                });
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, &self.build_group, &[]);
                pass.draw(0..3, 0..1);
            };
            one(&self.build[0], attach(whole, Some(slice)));
            if slice == 0 {
                one(&self.build[1], attach(&self.depth, None));
            }
            seconds += timed(&self.device, encoder)? * 1e-3;
        }
        Ok(seconds)
    }

    fn veils(&mut self, scene: &SkyScene, pixels: &[Pixel]) -> Result<Vec<Veil>> {
        let device = self.device.clone();
        let (s, c) = scene.sun_zenith_deg.to_radians().sin_cos();
        self.write(scene.altitude_m, [s, 0.0, c], 0);
        let height = (pixels.len() as u32).div_ceil(WIDTH);
        let format = wgpu::TextureFormat::Rgba32Float;
        let rays = target(&device, (WIDTH, height), format);
        let mut texels = vec![[0.0f32, 0.0, 1.0, -1.0]; (WIDTH * height) as usize];
        for (t, p) in texels.iter_mut().zip(pixels) {
            let [x, y, z] = p.direction.map(|v| v as f32);
            *t = [x, y, z, p.ground_m.map_or(-1.0, |d| d as f32)];
        }
        let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(WIDTH * 16), rows_per_image: None };
        device.queue.write_texture(rays.as_image_copy(), bytemuck::cast_slice(&texels), rows, rays.size());
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.rays_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&rays.create_view(&Default::default())),
            }],
        });
        let answers = [0; 2].map(|_| target(&device, (WIDTH, height), format));
        let views = answers.each_ref().map(|t| t.create_view(&Default::default()));
        let mut encoder = device.device.create_command_encoder(&Default::default());
        {
            let ops = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
            let attach =
                |view| Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops });
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("elek"),
                color_attachments: &[attach(&views[0]), attach(&views[1])],
                ..Default::default()
            });
            pass.set_pipeline(&self.probe);
            pass.set_bind_group(0, &group, &[]);
            pass.set_bind_group(1, &self.use_group, &[]);
            pass.draw(0..3, 0..1);
        }
        device.submit_and_wait(encoder)?;
        let [l, t] = [readback::rgba(&device, &answers[0])?, readback::rgba(&device, &answers[1])?];
        let three = |v: &[f32; 4]| [v[0], v[1], v[2]].map(f64::from);
        Ok(l.iter().zip(&t).take(pixels.len()).map(|(l, t)| (three(l), three(t))).collect())
    }

    fn frame(&mut self, size: (u32, u32), step: usize, follows: bool) -> Result<f64> {
        let observer = moving(&self.planet, step, follows);
        let toward = observer.lamps[0].map_or([0.0, 0.0, 1.0], |l| l.toward);
        self.write(observer.altitude_m, toward, 0);
        let view = sized(&mut self.target, &self.device, size);
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        draw(&mut encoder, "elek", &self.picture, &[&self.camera, &self.use_group], &view);
        timed(&self.device, encoder)
    }
}

fn entry(binding: u32, ty: wgpu::BindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None }
}

fn layout(gpu: &wgpu::Device, with_tables: bool) -> wgpu::BindGroupLayout {
    let uniform = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let texture = |view_dimension| wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension,
        multisampled: false,
    };
    let mut entries = vec![entry(0, uniform)];
    if with_tables {
        entries.push(entry(1, texture(wgpu::TextureViewDimension::D3)));
        entries.push(entry(2, texture(wgpu::TextureViewDimension::D2)));
        entries.push(entry(3, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)));
    }
    gpu.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("elek"), entries: &entries })
}

fn rays_layout(gpu: &wgpu::Device) -> wgpu::BindGroupLayout {
    let ty = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    gpu.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &[entry(0, ty)] })
}
