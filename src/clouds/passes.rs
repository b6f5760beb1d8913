//! GPU resources of the clouds: what shaders look up, the pass that marches some pixels of a picture, and the one that makes a picture of
//! them.

use std::sync::Arc;

use half::f16;

use super::{
    cover::{SOLID_SIZE, solid_settings},
    field::{MAP_SIZE, Map},
    transport::{DEPTHS, LEAKS, Scattering, Table, Transport},
    uniforms::{CloudsUniform, PictureUniform},
};
use crate::{
    error::Result,
    gpu::{
        Device, Layer,
        bind::{self, Slot},
        pass::{self, FullscreenDesc},
    },
    light::{Phase, PhaseLobes},
    noise::NoiseTexture,
    stage::{FrameUniform, Sampling, yes},
};

/// Of what is seen of clouds, and how far away it is.
const SEEN: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
const DISTANCE: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;
/// Change of the sun's cosine after which the tables under its beam are made anew.
const SUN_MOVED: f64 = 2e-3;
/// Asymmetry of ice crystals (Fu 2007: 0.74 to 0.8 by shape).
const ICE_ASYMMETRY: f64 = 0.77;

fn texture(
    device: &Device,
    label: &str,
    (width, height): (u32, u32),
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

fn write_halves(device: &Device, texture: &wgpu::Texture, origin: (u32, u32), width: u32, texels: &[[f32; 4]]) {
    let halves: Vec<u16> = texels.iter().flatten().map(|v| f16::from_f32(*v).to_bits()).collect();
    device.queue.write_texture(
        wgpu::TexelCopyTextureInfo {
            origin: wgpu::Origin3d { x: origin.0, y: origin.1, z: 0 },
            ..texture.as_image_copy()
        },
        bytemuck::cast_slice(&halves),
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(8 * width), rows_per_image: None },
        wgpu::Extent3d { width, height: texels.len() as u32 / width, depth_or_array_layers: 1 },
    );
}

fn view(binding: u32, view: &wgpu::TextureView) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) }
}

fn buffer(binding: u32, buffer: &wgpu::Buffer) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() }
}

fn sampled(binding: u32, sampler: &wgpu::Sampler) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::Sampler(sampler) }
}

pub(super) fn sampler(device: &Device, address: wgpu::AddressMode) -> wgpu::Sampler {
    device.device.create_sampler(&wgpu::SamplerDescriptor {
        address_mode_u: address,
        address_mode_v: address,
        address_mode_w: address,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    })
}

/// Tables of light scattered more than once in two media, as shaders look them up.
pub(super) struct LightTables {
    texture: wgpu::Texture,
    pub media: [Transport; 2],
    /// Cosine of the sun under which they stand.
    under: Option<f64>,
}

impl LightTables {
    pub fn new(device: &Device, media: [Transport; 2]) -> Self {
        let size = (3 * DEPTHS as u32, (2 * LEAKS * DEPTHS) as u32);
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        Self { texture: texture(device, "light in clouds", size, SEEN, usage), media, under: None }
    }

    pub fn view(&self) -> wgpu::TextureView {
        self.texture.create_view(&Default::default())
    }

    /// Exchanges a medium: all tables are made anew.
    fn replace(&mut self, which: usize, medium: Transport) {
        self.media[which] = medium;
        self.under = None;
    }

    /// Brings them up to a sun.
    pub fn update(&mut self, device: &Device, cosine: f64) {
        let cosine = cosine.clamp(-1.0, 1.0);
        if self.under.is_some_and(|c| (c - cosine).abs() < SUN_MOVED) {
            return;
        }
        let (across, rows) = (DEPTHS as u32, (LEAKS * DEPTHS) as u32);
        for (i, medium) in self.media.iter().enumerate() {
            let put = |column: u32, table: Table| {
                write_halves(device, &self.texture, (column * across, i as u32 * rows), across, &table);
            };
            put(0, medium.under_beam(cosine.abs()));
            put(1, medium.under_beam((1.0 - cosine * cosine).sqrt()));
            if self.under.is_none() {
                put(2, medium.under_sky());
            }
        }
        self.under = Some(cosine);
    }
}

/// What shaders look up: map, solid noise, and light.
pub(super) struct CloudTables {
    map: wgpu::TextureView,
    solid: NoiseTexture,
    pub light: LightTables,
    repeating: wgpu::Sampler,
    clamping: wgpu::Sampler,
    liquid_um: f64,
}

fn medium(phase: Phase) -> Transport {
    Transport::new(Scattering::new(PhaseLobes::new(&phase), 1.0))
}

impl CloudTables {
    pub fn new(device: &Arc<Device>, seed: u64) -> Result<Self> {
        let side = MAP_SIZE as u32;
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let map = texture(device, "cloud map", (side, side), SEEN, usage);
        write_halves(device, &map, (0, 0), side, &Map::new(seed).0);
        let liquid_um = 20.0;
        let media =
            [Phase::Droplets { diameter_um: liquid_um }, Phase::HenyeyGreenstein { g: ICE_ASYMMETRY }].map(medium);
        Ok(Self {
            map: map.create_view(&Default::default()),
            solid: NoiseTexture::new(device, [SOLID_SIZE; 3], &[solid_settings(seed)])?,
            repeating: sampler(device, wgpu::AddressMode::Repeat),
            clamping: sampler(device, wgpu::AddressMode::ClampToEdge),
            liquid_um,
            light: LightTables::new(device, media),
        })
    }

    /// Draws what is not drawn yet, and brings the tables up to the sun and to droplets of this diameter.
    pub fn update(&mut self, device: &Device, encoder: &mut wgpu::CommandEncoder, cosine: f64, liquid_um: f64) {
        // At once: clouds that fray later would jump.
        self.solid.step(encoder, u32::MAX);
        if liquid_um != self.liquid_um {
            self.liquid_um = liquid_um;
            self.light.replace(0, medium(Phase::Droplets { diameter_um: liquid_um }));
        }
        self.light.update(device, cosine);
    }
}

impl CloudTables {
    /// What the march is bound to; `blocks` are those of clouds and of the picture.
    fn group(
        &self,
        device: &Device,
        layout: &wgpu::BindGroupLayout,
        of: &CloudFrame<'_>,
        blocks: [&wgpu::Buffer; 2],
        none: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        let (solid, tables) = (self.solid.view(), self.light.view());
        let depth = of.depth.map(Layer::view);
        device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("clouds marched"),
            layout,
            entries: &[
                buffer(0, of.frame),
                buffer(1, blocks[0]),
                view(2, &self.map),
                view(3, &solid),
                view(4, &tables),
                sampled(5, &self.repeating),
                sampled(6, &self.clamping),
                view(7, depth.as_ref().unwrap_or(none)),
                buffer(8, blocks[1]),
            ],
        })
    }
}

/// What distinguishes one pipeline of the march from another.
#[derive(Clone, Copy, PartialEq)]
struct March {
    sampling: Sampling,
    has_depth: bool,
    depth_kinds: f64,
}

/// A picture's size in textures.
struct Picture {
    size: (u32, u32),
    side: u32,
    marched: [wgpu::TextureView; 2],
    whole: [wgpu::TextureView; 2],
    /// Which of the two was written last.
    newest: usize,
    /// What the other is made with, by `newest`.
    resolved: [Option<wgpu::BindGroup>; 2],
}

impl Picture {
    fn new(device: &Device, size: (u32, u32), side: u32) -> Self {
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT;
        let low = (size.0.div_ceil(side), size.1.div_ceil(side));
        let one = |label, size, format| texture(device, label, size, format, usage).create_view(&Default::default());
        Self {
            size,
            side,
            marched: [one("clouds marched", low, SEEN), one("clouds' distance", low, DISTANCE)],
            whole: [one("clouds", size, SEEN), one("clouds", size, SEEN)],
            newest: 0,
            resolved: [const { None }; 2],
        }
    }

    fn bytes(&self) -> u64 {
        let whole = u64::from(self.size.0) * u64::from(self.size.1);
        16 * whole + 10 * whole / u64::from(self.side * self.side)
    }
}

/// The passes of a view.
pub(super) struct CloudPasses {
    pub tables: CloudTables,
    block: wgpu::Buffer,
    picture_block: wgpu::Buffer,
    march_layouts: [wgpu::BindGroupLayout; 2],
    resolve_layout: wgpu::BindGroupLayout,
    march: Option<(March, wgpu::RenderPipeline)>,
    resolve: Option<wgpu::RenderPipeline>,
    none: wgpu::TextureView,
    picture: Option<Picture>,
    /// What the march is bound to, and of which of the host's depth images and tables of the sky that is.
    marched_of: Option<(MarchedOf, wgpu::BindGroup)>,
}

type MarchedOf = (Option<(wgpu::Texture, u32)>, wgpu::BindGroup);

/// What the passes draw from.
pub(super) struct CloudFrame<'a> {
    pub clouds: CloudsUniform,
    pub picture: PictureUniform,
    /// The frame's block, and the sky's tables with their layout.
    pub frame: &'a wgpu::Buffer,
    pub sky: (&'a wgpu::BindGroupLayout, &'a wgpu::BindGroup),
    pub depth: Option<Layer<'a>>,
    pub sampling: Sampling,
    pub depth_kinds: f64,
}

impl CloudFrame<'_> {
    fn is_multisampled(&self) -> bool {
        self.depth.is_some() && self.sampling.multisampled()[1]
    }
}

impl CloudPasses {
    pub fn new(device: &Arc<Device>, seed: u64) -> Result<Self> {
        let march = |multisampled: bool| {
            let slots = [
                (0, Slot::Uniform(size_of::<FrameUniform>())),
                (1, Slot::Uniform(size_of::<CloudsUniform>())),
                (2, Slot::Filtered),
                (3, Slot::FilteredVolume),
                (4, Slot::Filtered),
                (5, Slot::Sampler),
                (6, Slot::Sampler),
                (7, Slot::texels(multisampled)),
                (8, Slot::Uniform(size_of::<PictureUniform>())),
            ];
            bind::layout(&device.device, "clouds marched", wgpu::ShaderStages::FRAGMENT, &slots)
        };
        let resolve = [
            (0, Slot::Uniform(size_of::<FrameUniform>())),
            (1, Slot::Uniform(size_of::<PictureUniform>())),
            (2, Slot::Texels),
            (3, Slot::Texels),
            (4, Slot::Filtered),
            (5, Slot::Sampler),
        ];
        Ok(Self {
            tables: CloudTables::new(device, seed)?,
            block: bind::block(&device.device, "clouds", size_of::<CloudsUniform>()),
            picture_block: bind::block(&device.device, "clouds of a picture", size_of::<PictureUniform>()),
            march_layouts: [march(false), march(true)],
            resolve_layout: bind::layout(&device.device, "clouds", wgpu::ShaderStages::FRAGMENT, &resolve),
            march: None,
            resolve: None,
            none: bind::nothing(&device.device, wgpu::TextureFormat::Rgba8Unorm),
            picture: None,
            marched_of: None,
        })
    }

    /// Makes textures for a picture of this size, and answers whether the last one's are kept.
    pub fn hold(&mut self, device: &Device, size: (u32, u32), side: u32) -> bool {
        if self.picture.as_ref().is_some_and(|p| (p.size, p.side) == (size, side)) {
            return true;
        }
        self.picture = Some(Picture::new(device, size, side));
        false
    }

    /// Lets go what is of a picture's size.
    pub fn forget(&mut self) {
        self.picture = None;
    }

    /// The picture that will hold the clouds once they are drawn.
    pub fn next(&self) -> Option<wgpu::TextureView> {
        self.picture.as_ref().map(|p| p.whole[1 - p.newest].clone())
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        let tables = (8 * MAP_SIZE * MAP_SIZE + 8 * 6 * LEAKS * DEPTHS * DEPTHS) as u64;
        tables + u64::from(SOLID_SIZE).pow(3) + self.picture.as_ref().map_or(0, Picture::bytes)
    }

    fn march_pipeline(&mut self, device: &Device, of: &CloudFrame<'_>) -> Result<wgpu::RenderPipeline> {
        let wanted = March { sampling: of.sampling, has_depth: of.depth.is_some(), depth_kinds: of.depth_kinds };
        if let Some((made, pipeline)) = &self.march
            && *made == wanted
        {
            return Ok(pipeline.clone());
        }
        let several = of.is_multisampled();
        let target = |format| wgpu::ColorTargetState { format, blend: None, write_mask: wgpu::ColorWrites::ALL };
        let desc = FullscreenDesc {
            shader: if several { "clouds/march_view.wgsl:multi" } else { "clouds/march_view.wgsl" },
            entry: "march",
            layouts: &[&self.march_layouts[usize::from(several)], of.sky.0],
            targets: &[target(SEEN), target(DISTANCE)],
            constants: &[("HAS_DEPTH", yes(wanted.has_depth)), ("DEPTH_KINDS", of.depth_kinds)],
            samples: 1,
        };
        let pipeline = pass::fullscreen(device, &desc)?;
        self.march = Some((wanted, pipeline.clone()));
        Ok(pipeline)
    }

    fn resolve_pipeline(&mut self, device: &Device) -> Result<wgpu::RenderPipeline> {
        if let Some(pipeline) = &self.resolve {
            return Ok(pipeline.clone());
        }
        let desc = FullscreenDesc {
            shader: "clouds/resolve.wgsl",
            entry: "resolve",
            layouts: &[&self.resolve_layout],
            targets: &[wgpu::ColorTargetState { format: SEEN, blend: None, write_mask: wgpu::ColorWrites::ALL }],
            constants: &[],
            samples: 1,
        };
        Ok(self.resolve.insert(pass::fullscreen(device, &desc)?).clone())
    }

    /// Marches a frame's pixels and makes the picture of them.
    pub fn draw(&mut self, device: &Device, encoder: &mut wgpu::CommandEncoder, of: &CloudFrame<'_>) -> Result<()> {
        let (march, resolve) = (self.march_pipeline(device, of)?, self.resolve_pipeline(device)?);
        let Some(picture) = &mut self.picture else { return Ok(()) };
        device.queue.write_buffer(&self.block, 0, bytemuck::bytes_of(&of.clouds));
        device.queue.write_buffer(&self.picture_block, 0, bytemuck::bytes_of(&of.picture));
        let frame_of = (of.depth.map(|d| (d.texture.clone(), d.index)), of.sky.1.clone());
        if self.marched_of.as_ref().is_none_or(|(made, _)| *made != frame_of) {
            let group = self.tables.group(
                device,
                &self.march_layouts[usize::from(of.is_multisampled())],
                of,
                [&self.block, &self.picture_block],
                &self.none,
            );
            self.marched_of = Some((frame_of, group));
        }
        let Some((_, marched)) = &self.marched_of else { return Ok(()) };
        let attachment = |view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })
        };
        {
            let [seen, distance] = &picture.marched;
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("clouds marched"),
                color_attachments: &[attachment(seen), attachment(distance)],
                ..Default::default()
            });
            pass.set_pipeline(&march);
            pass.set_bind_group(0, marched, &[]);
            pass.set_bind_group(1, of.sky.1, &[]);
            pass.draw(0..3, 0..1);
        }
        let group = picture.resolved[picture.newest].get_or_insert_with(|| {
            device.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("clouds"),
                layout: &self.resolve_layout,
                entries: &[
                    buffer(0, of.frame),
                    buffer(1, &self.picture_block),
                    view(2, &picture.marched[0]),
                    view(3, &picture.marched[1]),
                    view(4, &picture.whole[picture.newest]),
                    sampled(5, &self.tables.clamping),
                ],
            })
        });
        picture.newest = 1 - picture.newest;
        pass::draw(encoder, "clouds", &resolve, &[group], &picture.whole[picture.newest]);
        Ok(())
    }
}
