//! Clouds as older systems paint them, for comparison: noise on a plane, a shell or a dome, with a cutoff and an
//! exponential law for opacity, and several kinds of shading.
//!
//! Forms, laws and shadings come from two sources. From Tarantilis (2004): planes with soft edges (III.B.3) and a dome
//! cut out of solid noise (III.B.4). From a training simulator for machinery: light traced towards the sun, a normal
//! from the noise, the average with a second texture, a slow fade between noises, and a sky from a picture.
//! Combinations that both lack are added: a shell around the planet instead of a plane, solid noise on it, and the
//! light of a slab. All of them paint over Welkin's own clear sky, in its light.
//!
//! Different methods put clouds in different places, so pictures are compared like those of rain: in blocks over
//! several moments.

use std::sync::Arc;

use welkin::clouds::{CloudModel, candidates::CloudMethod, cover};
use welkin::gpu::{Device, pass, shader};
use welkin::noise::{CloudPreset, NoiseImage, NoiseKind, NoiseSettings, NoiseTexture};
use welkin::{Error, Result};
use welkin_support::fullscreen;

use crate::cloudscapes::{FORMAT, Host, SIZE, UNIT};
use crate::picture::Picture;
use crate::rain::Blocks;
use crate::scenes::CloudScene;
use crate::timing::timed;

/// Number of moments at which pictures are compared, and the time between them, s, in which the clouds have changed.
const MOMENTS: u64 = 16;
const APART_S: f64 = 3700.0;
/// Texels along a side of the solid noise.
const SOLID: u32 = 128;
/// How much lower the sun stood when the sky's picture was taken, which is then used at all later times, degrees.
const TAKEN_LOWER_DEG: f64 = 15.0;

/// Surface that carries the noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// A level plane at the clouds' base.
    Plane,
    /// A plane bent like the planet.
    Shell,
    /// A sphere around the camera, cut out of solid noise.
    Dome,
    /// Solid noise at the point where a ray meets the shell.
    SolidShell,
}

/// Shading of the clouds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shading {
    /// One colour.
    Flat,
    /// By the noise along the path to the sun.
    Traced,
    /// By a normal from the noise's gradient.
    ByNormal,
    /// By the average with a second texture.
    Averaged,
    /// Like a uniform slab with the local optical depth.
    Slab,
}

/// A way to paint clouds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Paint {
    /// Noise.
    Noise { form: Form, shading: Shading, cross_fades: bool, curls: bool },
    /// A picture of the sky, taken once.
    Picture,
    /// None: the library's own clouds.
    Library(CloudMethod),
    /// The truth at other moments.
    TruthAgain,
}

/// All charted ways.
pub fn candidates() -> Vec<(&'static str, Paint)> {
    let noise = |form, shading| Paint::Noise { form, shading, cross_fades: false, curls: false };
    let plane = |cross_fades, curls| Paint::Noise { form: Form::Plane, shading: Shading::Flat, cross_fades, curls };
    vec![
        ("plane", noise(Form::Plane, Shading::Flat)),
        ("plane-traced", noise(Form::Plane, Shading::Traced)),
        ("plane-by-normal", noise(Form::Plane, Shading::ByNormal)),
        ("plane-averaged", noise(Form::Plane, Shading::Averaged)),
        ("plane-cross-fade", plane(true, false)),
        ("plane-curl", plane(false, true)),
        ("shell", noise(Form::Shell, Shading::Flat)),
        ("shell-slab", noise(Form::Shell, Shading::Slab)),
        ("dome", noise(Form::Dome, Shading::Flat)),
        ("solid-shell", noise(Form::SolidShell, Shading::Flat)),
        ("solid-shell-slab", noise(Form::SolidShell, Shading::Slab)),
        ("sky-picture", Paint::Picture),
        ("deck", Paint::Library(CloudMethod { model: CloudModel::Deck, ..CloudMethod::default() })),
        ("volume", Paint::Library(CloudMethod::default())),
        ("truth-again", Paint::TruthAgain),
    ]
}

/// Uniform block of `painted.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Uniform {
    right: [f32; 4],
    up: [f32; 4],
    ahead: [f32; 4],
    to_sun: [f32; 4],
    sun: [f32; 4],
    sky: [f32; 4],
    cloud: [f32; 4],
    offset: [f32; 4],
}

/// Noise from which a scene's clouds are cut, and the cutoff.
struct Cut {
    texture: NoiseTexture,
    cutoff: f64,
    /// Mean height of the noise above the cutoff, where it is above.
    over: f64,
    /// Clouds along a side of the texture.
    frequency: f64,
}

impl Cut {
    fn new(device: &Arc<Device>, size: [u32; 3], settings: &NoiseSettings, cover: f64) -> Result<Self> {
        let texture = NoiseTexture::generate(device, size, &[*settings])?;
        let image = texture.read(device, 0)?;
        let cutoff = image.cutoff_for_cover(cover)?;
        Ok(Self { texture, cutoff, over: mean_over(&image, cutoff), frequency: f64::from(settings.frequency[0]) })
    }
}

fn mean_over(image: &NoiseImage, cutoff: f64) -> f64 {
    let over = image.levels()[0].iter().map(|t| f64::from(*t) / 255.0 - cutoff).filter(|x| *x > 0.0);
    let (sum, count) = over.fold((0.0, 0u32), |(sum, count), x| (sum + x, count + 1));
    sum / f64::from(count.max(1))
}

/// A scene into which clouds are painted.
pub struct Easel {
    device: Arc<Device>,
    scene: CloudScene,
    /// The scene's sky without clouds, and with them.
    clear: Host,
    clouded: Host,
    module: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    /// Two textures for a plane, and a solid one.
    cuts: [Cut; 3],
    /// The pipeline that was timed last.
    last: Option<(Paint, wgpu::RenderPipeline)>,
}

impl Easel {
    /// Creates the easel for a scene.
    ///
    /// # Errors
    /// GPU faults.
    pub fn new(device: &Arc<Device>, scene: &CloudScene, size: (u32, u32)) -> Result<Self> {
        let gpu = &device.device;
        let text = shader::assemble("common/fullscreen.wgsl")? + include_str!("painted.wgsl");
        let source = wgpu::ShaderSource::Wgsl((text + &format!("const UNIT: f32 = {UNIT:.1};\n")).into());
        let module = gpu.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("painted"), source });
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let texture = |view_dimension| wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension,
            multisampled: false,
        };
        let block = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let flat = wgpu::TextureViewDimension::D2;
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let entries = [
            entry(0, block),
            entry(1, texture(flat)),
            entry(2, texture(flat)),
            entry(3, texture(wgpu::TextureViewDimension::D3)),
            entry(4, sampler),
        ];
        let layout = gpu.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
        let sampler = gpu.create_sampler(&wgpu::SamplerDescriptor {
            address_mode_u: wgpu::AddressMode::Repeat,
            address_mode_v: wgpu::AddressMode::Repeat,
            address_mode_w: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        });
        let solid = NoiseSettings { kind: NoiseKind::Gradient, frequency: [6; 3], seed: 3, ..NoiseSettings::default() };
        let plane = |seed| Cut::new(device, CloudPreset::SIZE, &CloudPreset::Broken.noise(seed), scene.cover);
        Ok(Self {
            device: device.clone(),
            scene: *scene,
            clear: Host::new(device, &CloudScene { cover: 0.0, ..*scene }, size)?,
            clouded: Host::new(device, scene, size)?,
            module,
            layout,
            sampler,
            cuts: [plane(1)?, plane(2)?, Cut::new(device, [SOLID; 3], &solid, scene.cover)?],
            last: None,
        })
    }

    fn pipeline(&self, form: Form, shading: Shading, [fades, curls]: [bool; 2]) -> wgpu::RenderPipeline {
        let yes = |b| if b { 1.0 } else { 0.0 };
        let constants = [
            ("FORM", f64::from(form as u32)),
            ("SHADING", f64::from(shading as u32)),
            ("CROSS_FADES", yes(fades)),
            ("CURLS", yes(curls)),
        ];
        let blend = Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING);
        let target = wgpu::ColorTargetState { format: FORMAT, blend, write_mask: wgpu::ColorWrites::ALL };
        let stages = (fullscreen::VERTEX, "painted", &constants[..]);
        fullscreen::pipeline(&self.device.device, &self.module, stages, &[&self.layout], &[target])
    }

    /// The uniform block of a moment; `cut` is the noise of the clouds.
    fn uniform(&self, cut: &Cut, moment: u64) -> Result<Uniform> {
        let (camera, light) = (self.clear.camera(), self.clear.light()?);
        let slab = cover::typical(self.scene.kind, self.scene.cover)?;
        let back = camera.view.inverse();
        let axis = |i: usize, w: f64| {
            let a = back.col(i);
            [a.x, a.y, a.z, w].map(|v| v as f32)
        };
        let reach = [0, 1].map(|i| camera.projection.col(i)[i].recip());
        let ahead = axis(2, 0.0).map(|v| -v);
        let top = if self.scene.height_m > self.scene.base_m { slab.thickness_m } else { 0.0 };
        let height = self.scene.base_m + top - self.scene.height_m;
        let three = |v: [f64; 3], w: f64| [v[0], v[1], v[2], w].map(|v| v as f32);
        // By the golden ratio and similar numbers, so that no position repeats.
        let turn = moment as f64;
        let [a, b, c] = [0.618_034, 0.754_878, 0.569_84].map(|step| (step * turn).fract());
        let density = CloudPreset::Broken.cloud().thickness();
        let share = (0.37 * turn).fract();
        Ok(Uniform {
            right: axis(0, reach[0]),
            up: axis(1, reach[1]),
            ahead,
            to_sun: three(light.sun.direction.to_array(), height),
            sun: three(light.arriving.sun_lux, cut.frequency * slab.scale_m),
            sky: three(light.arriving.sky_lux, self.clear.radius_m() + self.scene.height_m),
            cloud: [cut.cutoff, density, slab.optical_depth / cut.over.max(1e-3), share].map(|v| v as f32),
            offset: [a, b, c, a].map(|v| v as f32),
        })
    }

    /// Paints into the clear sky just drawn, and returns the time, ms.
    fn paint(&self, pipeline: &wgpu::RenderPipeline, cut: &Cut, moment: u64) -> Result<f64> {
        let gpu = &self.device.device;
        let block = self.uniform(cut, moment)?;
        let buffer = gpu.create_buffer(&wgpu::BufferDescriptor {
            label: Some("painted"),
            size: size_of::<Uniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.device.queue.write_buffer(&buffer, 0, bytemuck::bytes_of(&block));
        let views = [0, 1, 2].map(|i| self.cuts[i].texture.view());
        let view = |binding: u32| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::TextureView(&views[binding as usize - 1]),
        };
        let group = gpu.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() },
                view(1),
                view(2),
                view(3),
                wgpu::BindGroupEntry { binding: 4, resource: wgpu::BindingResource::Sampler(&self.sampler) },
            ],
        });
        let mut encoder = gpu.create_command_encoder(&Default::default());
        let target = self.clear.target().create_view(&Default::default());
        pass::draw(&mut encoder, "painted", pipeline, &[&group], &target);
        timed(&self.device, encoder)
    }

    fn cut_of(&self, form: Form) -> &Cut {
        &self.cuts[if matches!(form, Form::Dome | Form::SolidShell) { 2 } else { 0 }]
    }

    fn true_at(&mut self, moment: u64) -> Result<Picture> {
        self.clouded.at(APART_S * moment as f64)?;
        self.clouded.truth()
    }

    /// Blocks of the truth over its moments, and the luminance shown as white.
    ///
    /// # Errors
    /// GPU faults.
    pub fn truth(&mut self) -> Result<(Blocks, f64)> {
        let (mut blocks, mut white) = (Blocks::new(SIZE), 0.0);
        for moment in 0..MOMENTS {
            let picture = self.true_at(moment)?;
            white += picture.white() / MOMENTS as f64;
            blocks.add(&picture.luminances());
        }
        Ok((blocks, white))
    }

    /// Pictures of the scene by one method at several moments, cd/m^2.
    ///
    /// # Errors
    /// GPU faults.
    pub fn pictures(&mut self, paint: Paint, moments: std::ops::Range<u64>) -> Result<Vec<Picture>> {
        match paint {
            Paint::Noise { form, shading, cross_fades, curls } => {
                let pipeline = self.pipeline(form, shading, [cross_fades, curls]);
                let one = |moment| {
                    self.clear.still()?;
                    self.paint(&pipeline, self.cut_of(form), moment)?;
                    self.clear.texels()
                };
                moments.map(one).collect()
            }
            Paint::Picture => {
                let lower = CloudScene { sun_deg: self.scene.sun_deg - TAKEN_LOWER_DEG, ..self.scene };
                let taken = Host::new(&self.device, &lower, SIZE)?.truth()?;
                Ok(moments.map(|_| taken.clone()).collect())
            }
            Paint::Library(method) => {
                let one = |moment| {
                    self.clouded.at(APART_S * moment as f64)?;
                    self.clouded.picture(&method)
                };
                moments.map(one).collect()
            }
            Paint::TruthAgain => moments.map(|moment| self.true_at(MOMENTS + moment)).collect(),
        }
    }

    /// Blocks of the scene by one method.
    ///
    /// # Errors
    /// GPU faults.
    pub fn blocks(&mut self, paint: Paint) -> Result<Blocks> {
        let mut blocks = Blocks::new(SIZE);
        self.pictures(paint, 0..MOMENTS)?.iter().for_each(|p| blocks.add(&p.luminances()));
        Ok(blocks)
    }

    /// Time of a frame while the camera turns, ms.
    ///
    /// # Errors
    /// GPU faults.
    pub fn timed(&mut self, paint: Paint, round: usize) -> Result<f64> {
        let deck = CloudMethod { model: CloudModel::Deck, ..CloudMethod::default() };
        match paint {
            Paint::Noise { form, shading, cross_fades, curls } => {
                let made = match self.last.take() {
                    Some((of, pipeline)) if of == paint => pipeline,
                    _ => self.pipeline(form, shading, [cross_fades, curls]),
                };
                let clear = self.clear.timed(&deck, round == 0)?;
                let painted = self.paint(&made, self.cut_of(form), round as u64)?;
                self.last = Some((paint, made));
                Ok(clear + painted)
            }
            // One texture look-up per pixel, like the cheapest of the others, and no air in front.
            Paint::Picture => self.clear.timed(&deck, round == 0),
            Paint::Library(method) => self.clouded.timed(&method, round == 0),
            Paint::TruthAgain => Err(Error::range("candidate", "one that is timed", "truth-again")),
        }
    }
}
