//! Queries of the drawn sky: radiance and transmittance along single rays, through the same look-ups that every picture
//! uses.
//!
//! A query waits for the GPU. It is for programs and tests, not for frames.

use super::observer::Observer;
use super::passes::{bind, layout};
use super::settings::SkySettings;
use super::tables::SkyTables;
use super::volume::SkyVolume;
use super::{Lamp, Planet};
use crate::error::{Error, Result, check_range};
use crate::gpu::bind::Slot;
use crate::gpu::pass::{FullscreenDesc, fullscreen};
use crate::gpu::{Device, flat_texture, readback};

/// Quantity to compute along a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// Radiance of the air along the whole ray, and transmittance to space (0 if the ray meets the ground).
    Sky,
    /// Radiance of the air between the observer and the distance, and transmittance over that path.
    Aerial,
    /// Irradiance on a level surface at the observer: direct light in `radiance`, light of the sky in `transmittance`.
    Irradiance,
    /// Radiance of the visible ground in `radiance`, and of the lamps' discs in `transmittance`.
    Ground,
}

impl Question {
    fn entry(self) -> &'static str {
        match self {
            Self::Sky => "probe_sky",
            Self::Aerial => "probe_aerial",
            Self::Irradiance => "probe_irradiance",
            Self::Ground => "probe_ground",
        }
    }
}

/// A direction and a distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Unit direction in the observer's level frame.
    pub direction: [f64; 3],
    /// Distance, m, `[0, 1e9]`; only [`Question::Aerial`] reads it.
    pub distance_m: f64,
}

impl Ray {
    /// Creates a ray from zenith angle and azimuth (counted from the x axis), rad.
    pub fn at(zenith_angle: f64, azimuth: f64, distance_m: f64) -> Self {
        let (s, c) = zenith_angle.sin_cos();
        Self { direction: [s * azimuth.cos(), s * azimuth.sin(), c], distance_m }
    }
}

/// Answer of the drawn sky, per wavelength of the planet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Answer {
    /// Radiance, W m^-2 sr^-1 nm^-1, for the lamps' irradiance as given. For [`Question::Irradiance`] it is the
    /// irradiance of the direct light, W m^-2 nm^-1.
    pub radiance: [f32; 3],
    /// Transmittance, dimensionless, or the second quantity that the [`Question`] names.
    pub transmittance: [f32; 3],
}

/// Tables and pipelines that answer queries of one planet's sky.
pub struct Probe {
    tables: SkyTables,
    volume: SkyVolume,
    planet: Planet,
    layout: wgpu::BindGroupLayout,
    pipelines: Vec<(Question, wgpu::RenderPipeline)>,
}

/// Number of rays in a row of the texture of one pass.
const WIDTH: u32 = 256;

impl Probe {
    /// Creates a probe and builds the tables of `planet`.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for settings or a planet out of range; GPU faults.
    pub fn new(device: &std::sync::Arc<Device>, settings: &SkySettings, planet: &Planet) -> Result<Self> {
        let mut tables = SkyTables::new(device, settings)?;
        let mut encoder = device.device.create_command_encoder(&Default::default());
        tables.update(&mut encoder, planet, 1.0)?;
        device.submit_and_wait(encoder)?;
        Self::with_tables(tables, planet)
    }

    /// Creates a probe from finished tables of `planet`.
    ///
    /// # Errors
    /// GPU faults.
    pub fn with_tables(tables: SkyTables, planet: &Planet) -> Result<Self> {
        let volume = SkyVolume::new(&tables)?;
        let layout = question_layout(&tables.device);
        Ok(Self { tables, volume, planet: *planet, layout, pipelines: Vec::new() })
    }

    /// Tables that the probe reads.
    pub fn tables(&mut self) -> &mut SkyTables {
        &mut self.tables
    }

    /// Computes the answers under one sun above the x axis at `sun_zenith_angle`, rad, without refraction.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for numbers out of range; GPU faults.
    pub fn under_sun(
        &mut self,
        question: Question,
        altitude_m: f64,
        sun_zenith_angle: f64,
        rays: &[Ray],
    ) -> Result<Vec<Answer>> {
        let lamps = [Some(Lamp::sun_at_zenith_angle(&self.planet, sun_zenith_angle)), None];
        self.ask(question, &Observer { altitude_m, lamps, refraction: 0.0, exact: true }, rays)
    }

    /// Computes the answers for an observer.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for numbers out of range; GPU faults.
    pub fn ask(&mut self, question: Question, observer: &Observer, rays: &[Ray]) -> Result<Vec<Answer>> {
        for ray in rays {
            check_range("distance_m", ray.distance_m, 0.0, 1e9, "m")?;
            if ray.direction.iter().any(|v| !v.is_finite()) {
                return Err(Error::range("direction", "finite", format!("{:?}", ray.direction)));
            }
        }
        let device = self.tables.device.clone();
        let mut encoder = device.device.create_command_encoder(&Default::default());
        self.volume.prepare(&mut encoder, &self.tables, observer)?;
        device.submit_and_wait(encoder)?;
        let mut out = Vec::with_capacity(rays.len());
        for chunk in rays.chunks((WIDTH * WIDTH) as usize) {
            out.extend(self.pass(&device, question, chunk)?);
        }
        Ok(out)
    }

    fn pipeline(&mut self, device: &Device, question: Question) -> Result<wgpu::RenderPipeline> {
        if let Some((_, p)) = self.pipelines.iter().find(|(q, _)| *q == question) {
            return Ok(p.clone());
        }
        let target: wgpu::ColorTargetState = wgpu::TextureFormat::Rgba32Uint.into();
        let desc = FullscreenDesc {
            shader: "sky/probe.wgsl",
            entry: question.entry(),
            layouts: &[&self.layout, self.volume.layout()],
            targets: &[target.clone(), target],
            constants: &self.tables.pipeline_constants(),
            samples: 1,
        };
        let made = fullscreen(device, &desc)?;
        self.pipelines.push((question, made.clone()));
        Ok(made)
    }

    fn pass(&mut self, device: &Device, question: Question, rays: &[Ray]) -> Result<Vec<Answer>> {
        let height = (rays.len() as u32).div_ceil(WIDTH).max(1);
        let texture = |format, usage| flat_texture(&device.device, "probe", (WIDTH, height), format, usage);
        let asked = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let drawn = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let questions = texture(wgpu::TextureFormat::Rgba32Float, asked);
        let answers = [0; 2].map(|_| texture(wgpu::TextureFormat::Rgba32Uint, drawn));
        let mut texels = vec![[0.0f32, 0.0, 1.0, 0.0]; (WIDTH * height) as usize];
        for (t, r) in texels.iter_mut().zip(rays) {
            let [x, y, z] = r.direction.map(|v| v as f32);
            *t = [x, y, z, r.distance_m as f32];
        }
        device.queue.write_texture(
            questions.as_image_copy(),
            bytemuck::cast_slice(&texels),
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(WIDTH * 16), rows_per_image: None },
            questions.size(),
        );
        let pipeline = self.pipeline(device, question)?;
        let group = bind(
            device,
            &self.layout,
            &[wgpu::BindingResource::TextureView(&questions.create_view(&Default::default()))],
        );
        let views = answers.each_ref().map(|t| t.create_view(&Default::default()));
        let mut encoder = device.device.create_command_encoder(&Default::default());
        {
            let targets = views.each_ref().map(|view| {
                Some(wgpu::RenderPassColorAttachment {
                    view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })
            });
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("probe"),
                color_attachments: &targets,
                ..Default::default()
            });
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.set_bind_group(1, self.volume.bind_group(), &[]);
            pass.draw(0..3, 0..1);
        }
        device.submit_and_wait(encoder)?;
        let [l, t] = [readback::bytes(device, &answers[0], 0)?, readback::bytes(device, &answers[1], 0)?];
        let number = |b: &[u8], i: usize| f32::from_le_bytes([b[4 * i], b[4 * i + 1], b[4 * i + 2], b[4 * i + 3]]);
        let answer = |(a, b): (&[u8], &[u8])| Answer {
            radiance: [number(a, 0), number(a, 1), number(a, 2)],
            transmittance: [number(b, 0), number(b, 1), number(b, 2)],
        };
        Ok(l.chunks_exact(16).zip(t.chunks_exact(16)).take(rays.len()).map(answer).collect())
    }
}

fn question_layout(device: &Device) -> wgpu::BindGroupLayout {
    layout(device, "probe", &[Slot::Texels])
}
