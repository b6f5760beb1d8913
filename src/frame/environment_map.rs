//! Cube map of the surroundings of the camera, prefiltered by roughness, for reflections in the host's own objects.
//!
//! Created when the host first calls `View::environment`. Each frame draws one face, but all six if nothing of earlier
//! frames may show, or if light, weather or place jump. `shaders/frame/environment.wgsl` uses the composition's own
//! functions; `environment_filter.wgsl` makes the levels.

use glam::{DMat3, DVec3};

use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        pass::{self, FullscreenDesc},
        recent::LruCache,
    },
    moment::Scene,
    stage::{ColorSpace, Constants, DrawContext, Recording, Sampling, veiled},
};

/// Edge of a face, texels.
const SIZE: u32 = 64;
/// Number of levels, down to one texel.
const LEVELS: u32 = 7;
/// Number of sample directions of the filter for a texel of each level; narrow lobes need few.
const SAMPLES: [f32; LEVELS as usize] = [0.0, 16.0, 32.0, 64.0, 64.0, 64.0, 64.0];
/// Number of levels of the unfiltered map, from which the filter reads.
const SOURCE_LEVELS: u32 = 5;
const FACES: u32 = 6;
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Distance from one uniform block to the next, bytes; a multiple of every device's alignment.
const STEP: usize = 256;
/// Largest number of cached pipelines of a view: with and without a low cloud layer, for one host's images.
const MOST_PIPELINES: usize = 4;

/// Middle, right edge and lower edge of each face in the cube's axes (OpenGL 4.6, table 8.19).
const AXES: [[DVec3; 3]; FACES as usize] = [
    [DVec3::X, DVec3::NEG_Z, DVec3::NEG_Y],
    [DVec3::NEG_X, DVec3::Z, DVec3::NEG_Y],
    [DVec3::Y, DVec3::X, DVec3::Z],
    [DVec3::NEG_Y, DVec3::X, DVec3::NEG_Z],
    [DVec3::Z, DVec3::X, DVec3::NEG_Y],
    [DVec3::NEG_Z, DVec3::NEG_X, DVec3::NEG_Y],
];

/// `EnvironmentFace` and `FilterFace` of the shaders, which have the same layout.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct FaceUniform {
    forward: [f32; 3],
    /// For a face: texel value per cd/m^2. For the filter: alpha.
    number: f32,
    right: [f32; 3],
    /// Number of the filter's directions.
    samples: f32,
    down: [f32; 3],
    pad1: f32,
}

impl FaceUniform {
    fn new(face: usize, turn: &DMat3, number: f64) -> Self {
        let [forward, right, down] = AXES[face].map(|axis| (*turn * axis).as_vec3().to_array());
        Self { forward, number: number as f32, right, samples: 0.0, down, pad1: 0.0 }
    }
}

/// Returns the bytes of the blocks, each at a multiple of [`STEP`].
fn apart(blocks: impl Iterator<Item = FaceUniform>) -> Vec<u8> {
    let mut bytes = Vec::new();
    for block in blocks {
        bytes.extend_from_slice(bytemuck::bytes_of(&block));
        bytes.resize(bytes.len().next_multiple_of(STEP), 0);
    }
    bytes
}

/// Light, weather and place at the camera, compared from frame to frame to find jumps.
#[derive(Clone, Copy, PartialEq)]
struct EnvironmentInputs {
    /// Logarithms of quantities that change by factors (illuminances, luminance, visibility); altitude, km; cover of
    /// the deck.
    sizes: [f64; 6],
    /// Unit vector towards the brighter one of sun and moon.
    to_lamp: DVec3,
    world_to_enu: DMat3,
}

/// Limit above which the change of one of the `sizes` between two frames counts as a jump.
const LEAP: f64 = 0.05;
/// Limit, rad, above which the change of a direction between two frames counts as a jump.
const LEAP_RAD: f64 = 0.02;
/// Ratios of adaptation luminance to the map's scale for which half floats are precise enough.
const SCALES: std::ops::Range<f64> = 0.1..10.0;

impl EnvironmentInputs {
    fn of(scene: &Scene) -> Self {
        let light = &scene.ground;
        let doubling = [light.total_lux, light.sky_lux[1], scene.deck_cd_m2[1], scene.conditions.visibility_m()];
        let [total, level, overhead, far] = doubling.map(|v| v.clamp(1e-12, 1e12).ln());
        Self {
            // Over 1 km of altitude the air overhead changes by about a tenth.
            sizes: [total, level, overhead, far, scene.place.altitude_m / 1000.0, scene.deck_cover],
            to_lamp: scene.brighter().direction,
            world_to_enu: scene.world_to_enu,
        }
    }

    /// Whether light, weather or place have jumped since `earlier`.
    fn leaps_from(&self, earlier: &Self) -> bool {
        let turned = (0..3).any(|i| (self.world_to_enu.col(i) - earlier.world_to_enu.col(i)).length() > LEAP_RAD);
        self.sizes.iter().zip(earlier.sizes).any(|(now, earlier)| (now - earlier).abs() > LEAP)
            || (self.to_lamp - earlier.to_lamp).length() > LEAP_RAD
            || turned
    }
}

/// Sampling of the host's images, and the constants of a pipeline that draws every part.
pub(super) type PipelineKind = (Sampling, Constants);

/// Pipeline and bind groups of the filter that makes the levels.
struct Filter {
    pipeline: wgpu::RenderPipeline,
    /// Bind groups for each source level except the last, then one for all source levels.
    groups: Vec<wgpu::BindGroup>,
}

/// Cube map of a view, and the resources that draw it.
pub(super) struct EnvironmentMap {
    pub texture: wgpu::Texture,
    /// Views by face, then by level.
    levels: Vec<wgpu::TextureView>,
    /// Views of the unfiltered map by face, then by level.
    source_levels: Vec<wgpu::TextureView>,
    layout: wgpu::BindGroupLayout,
    blocks: wgpu::Buffer,
    group: wgpu::BindGroup,
    pipelines: LruCache<PipelineKind, wgpu::RenderPipeline, MOST_PIPELINES>,
    filter: Filter,
    /// Light, weather and place when the last face was drawn; `None` makes the next frame draw all faces.
    drawn: Option<EnvironmentInputs>,
    /// Face that the next frame draws.
    next: u32,
    /// Last frame in which faces were drawn.
    pub frame_id: Option<u64>,
    /// Factor from texels to cd/m^2.
    pub cd_m2_per_unit: f64,
    /// Factor from texels to units of the host's colour.
    pub light_scale: f64,
}

fn cube(device: &wgpu::Device, label: &str, levels: u32) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: FACES },
        mip_level_count: levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// Creates a view of each face and level, to draw into.
fn views(texture: &wgpu::Texture) -> Vec<wgpu::TextureView> {
    let view = |face, level| {
        texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            usage: Some(wgpu::TextureUsages::RENDER_ATTACHMENT),
            base_mip_level: level,
            mip_level_count: Some(1),
            base_array_layer: face,
            array_layer_count: Some(1),
            ..Default::default()
        })
    };
    (0..FACES)
        .flat_map(|face| (0..texture.mip_level_count()).map(move |level| (face, level)))
        .map(|(f, l)| view(f, l))
        .collect()
}

/// Returns alpha of a level: the square of its roughness.
fn alpha(level: u32) -> f64 {
    (f64::from(level) / f64::from(LEVELS - 1)).powi(2)
}

impl Filter {
    fn new(device: &Device, source: &wgpu::Texture) -> Result<Self> {
        let gpu = &device.device;
        let slots = [(0, Slot::DynamicUniform(size_of::<FaceUniform>())), (1, Slot::FilteredCube), (2, Slot::Sampler)];
        let layout = bind::layout(gpu, "environment filter", wgpu::ShaderStages::FRAGMENT, &slots);
        let desc = FullscreenDesc {
            shader: "frame/environment_filter.wgsl",
            entry: "environment_filter",
            layouts: &[&layout],
            targets: &[FORMAT.into()],
            constants: &[],
            samples: 1,
        };
        let pipeline = pass::fullscreen(device, &desc)?;
        let blocks = (0..FACES as usize).flat_map(|face| (0..LEVELS).map(move |level| (face, level)));
        let block = |(face, level)| FaceUniform {
            samples: SAMPLES[level as usize],
            ..FaceUniform::new(face, &DMat3::IDENTITY, alpha(level))
        };
        let bytes = apart(blocks.map(block));
        let buffer = bind::block(gpu, "environment filter", bytes.len());
        device.write_buffer(&buffer, 0, &bytes);
        let sampler = gpu.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("environment"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        });
        let group = |first, count| {
            let view = source.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::Cube),
                base_mip_level: first,
                mip_level_count: Some(count),
                ..Default::default()
            });
            let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
            gpu.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("environment filter"),
                layout: &layout,
                entries: &[
                    entry(0, of_one(&buffer)),
                    entry(1, wgpu::BindingResource::TextureView(&view)),
                    entry(2, wgpu::BindingResource::Sampler(&sampler)),
                ],
            })
        };
        let one = (0..SOURCE_LEVELS - 1).map(|level| group(level, 1));
        let groups = one.chain([group(0, SOURCE_LEVELS)]).collect();
        Ok(Self { pipeline, groups })
    }

    /// Draws a level of a face into `target`, from the source in `group`. Level 0 only halves the source's resolution,
    /// for the next level of the unfiltered map.
    fn draw(&self, recording: &mut Recording<'_>, target: &wgpu::TextureView, group: usize, face: u32, level: u32) {
        let mut pass = begin(recording.encoder, "environment filter", &[target]);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.groups[group], &[(face * LEVELS + level) * STEP as u32]);
        pass.draw(0..3, 0..1);
        drop(pass);
        recording.passes += 1;
    }
}

/// Binding of a single block in a buffer with many.
fn of_one(buffer: &wgpu::Buffer) -> wgpu::BindingResource<'_> {
    let size = wgpu::BufferSize::new(size_of::<FaceUniform>() as u64);
    wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size })
}

fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    label: &str,
    targets: &[&wgpu::TextureView],
) -> wgpu::RenderPass<'a> {
    let attach = |view| {
        Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
        })
    };
    let attachments = [targets.first(), targets.get(1)].map(|view| view.and_then(|v| attach(*v)));
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &attachments[..targets.len().min(2)],
        ..Default::default()
    })
}

impl EnvironmentMap {
    pub fn new(device: &Device) -> Result<Self> {
        let gpu = &device.device;
        let (texture, source) = (cube(gpu, "environment", LEVELS), cube(gpu, "environment source", SOURCE_LEVELS));
        let slots = [(0, Slot::DynamicUniform(size_of::<FaceUniform>()))];
        let layout = bind::layout(gpu, "environment face", wgpu::ShaderStages::FRAGMENT, &slots);
        let blocks = bind::block(gpu, "environment faces", FACES as usize * STEP);
        let group = gpu.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("environment face"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: of_one(&blocks) }],
        });
        Ok(Self {
            levels: views(&texture),
            source_levels: views(&source),
            filter: Filter::new(device, &source)?,
            texture,
            layout,
            blocks,
            group,
            pipelines: LruCache::new(),
            drawn: None,
            next: 0,
            frame_id: None,
            cd_m2_per_unit: 0.0,
            light_scale: 0.0,
        })
    }

    /// Returns the size of both cubes with all levels, bytes.
    pub fn bytes(&self) -> u64 {
        let of = |levels: u32| (0..levels).map(|level| u64::from(SIZE >> level).pow(2)).sum::<u64>();
        8 * u64::from(FACES) * (of(LEVELS) + of(SOURCE_LEVELS))
    }

    /// Makes the next frame draw all faces.
    pub fn forget(&mut self) {
        (self.drawn, self.frame_id) = (None, None);
    }

    /// Returns the faces to draw in a frame, and updates the scale and the faces' blocks.
    pub fn faces_due(&mut self, context: &DrawContext<'_>) -> std::ops::Range<u32> {
        let (frame, scene) = (context.frame, &context.now.scene);
        let (now, white) = (EnvironmentInputs::of(scene), scene.ground.adaptation_cd_m2.clamp(1e-6, 1e9));
        let follows = self.drawn.as_ref().is_some_and(|before| !now.leaps_from(before));
        let faces = if follows && !frame.is_pure() && SCALES.contains(&(white / self.cd_m2_per_unit)) {
            self.next..self.next + 1
        } else {
            self.cd_m2_per_unit = white;
            0..FACES
        };
        self.next = faces.end % FACES;
        (self.drawn, self.frame_id) = (Some(now), Some(frame.frame_id));
        self.light_scale = match frame.color_space {
            ColorSpace::SceneLinear => self.cd_m2_per_unit / frame.cd_m2_per_unit,
            ColorSpace::DisplayLinear | ColorSpace::DisplaySrgb => self.cd_m2_per_unit * context.target.exposure,
        };
        let block = |face| FaceUniform::new(face, &scene.world_to_enu, 1.0 / self.cd_m2_per_unit);
        for face in 0..FACES as usize {
            context.device.write_buffer(&self.blocks, (face * STEP) as u64, bytemuck::bytes_of(&block(face)));
        }
        faces
    }

    /// Draws faces with the bind groups of the composition.
    pub fn draw(
        &mut self,
        recording: &mut Recording<'_>,
        faces: std::ops::Range<u32>,
        (sampling, between): PipelineKind,
        layouts: &[&wgpu::BindGroupLayout; 3],
        groups: &[&wgpu::BindGroup; 3],
    ) -> Result<()> {
        let (device, layout) = (recording.device, &self.layout);
        let make = || {
            let mut constants = between;
            constants.push(("DISCS", 0.0));
            let desc = FullscreenDesc {
                shader: &veiled("frame/environment.wgsl", constants.all()),
                entry: "environment",
                layouts: &[layouts[0], layouts[1], layouts[2], layout],
                targets: &[FORMAT.into(), FORMAT.into()],
                constants: constants.all(),
                samples: 1,
            };
            Ok(((sampling, between), pass::fullscreen(device, &desc)?))
        };
        let pipeline = self.pipelines.get_or_make(|made| *made == (sampling, between), make)?;
        let level = |face: u32, level: u32| &self.levels[(face * LEVELS + level) as usize];
        let source = |face: u32, level: u32| &self.source_levels[(face * SOURCE_LEVELS + level) as usize];
        for face in faces.clone() {
            let mut pass = begin(recording.encoder, "environment", &[level(face, 0), source(face, 0)]);
            pass.set_pipeline(pipeline);
            for (i, group) in groups.iter().enumerate() {
                pass.set_bind_group(i as u32, *group, &[]);
            }
            pass.set_bind_group(3, &self.group, &[face * STEP as u32]);
            pass.draw(0..3, 0..1);
            drop(pass);
            recording.passes += 1;
            (1..SOURCE_LEVELS).for_each(|l| self.filter.draw(recording, source(face, l), l as usize - 1, face, 0));
        }
        let whole = self.filter.groups.len() - 1;
        for face in faces {
            (1..LEVELS).for_each(|l| self.filter.draw(recording, level(face, l), whole, face, l));
        }
        Ok(())
    }
}
