//! Pipelines of the composition, which is drawn over the host's picture in the variants that a frame needs.

use std::sync::{Arc, Mutex, MutexGuard};

use super::{
    super::wind_picture::WindPicture,
    even::{self, EvenLayouts},
    kinds,
    pixel_kind::Pixels,
    variant::Variant,
};
use crate::{
    effects::{BLOCK_BYTES, tables_layout},
    error::{Error, Result, Status},
    gpu::{
        Device, Layer,
        bind::{self, Slot},
        blocks::BlockView,
        pass::{self, FullscreenDesc},
        recent::LruCache,
    },
    moment::SceneMoment,
    stage::{Block, Composition, Constant, Frame, FrameUniform, Sampling, flag},
    surroundings::layout as around_layout,
};

/// Largest number of cached pipelines of a device. Views with the same formats share them. On a software driver one
/// pipeline may take more than 10 MB.
const MOST_PIPELINES: usize = 96;

/// Largest number of cached pipelines of the coarse grid and of the pixels interpolated from it: two or three for each
/// weather.
const MOST_EVEN: usize = 96;

/// Largest number of cached pipelines that write the kinds of pixels.
const MOST_KINDS: usize = 8;

/// Properties for which a pipeline that writes the kinds of pixels is compiled.
#[derive(Clone, Copy, PartialEq)]
struct KindsPipeline {
    format: wgpu::TextureFormat,
    sampling: Sampling,
    constants: [Constant; 4],
    /// Whether the pixels interpolated from the coarse grid are kinds of their own.
    with_even: bool,
}

/// Composition of a device, for all its views; any thread may lock it.
pub(in crate::frame) struct SharedComposite(Mutex<Composite>);

impl SharedComposite {
    /// Creates the layouts and placeholders that every view needs.
    ///
    /// # Errors
    /// A GPU fault.
    pub fn new(device: &Device) -> Result<Self> {
        let made = Self(Mutex::new(Composite::new(device)));
        device.check_made()?;
        Ok(made)
    }

    /// Locks the composition.
    ///
    /// # Errors
    /// [`Status::Poisoned`] after a panic.
    pub fn lock(&self) -> Result<MutexGuard<'_, Composite>> {
        self.0.lock().map_err(|_| Error::new(Status::Poisoned, "an earlier call panicked while composing"))
    }
}

/// Pipelines of the composition, shared by the views of a device.
pub(in crate::frame) struct Composite {
    /// Layouts of group 0, indexed by [`Sampling`].
    layouts: [wgpu::BindGroupLayout; 3],
    layout_tables: wgpu::BindGroupLayout,
    layout_around: wgpu::BindGroupLayout,
    pipelines: LruCache<Variant, wgpu::RenderPipeline, MOST_PIPELINES>,
    evens: LruCache<Variant, wgpu::RenderPipeline, MOST_EVEN>,
    kinds: LruCache<KindsPipeline, wgpu::RenderPipeline, MOST_KINDS>,
    /// Placeholder for a texture that the host does not give.
    none: wgpu::TextureView,
    /// Placeholder for an array texture.
    no_layers: wgpu::TextureView,
    /// Whether multisampled targets can be composed sample by sample.
    reads_samples: bool,
    wind: WindPicture,
    pub even: EvenLayouts,
    even_cells: Option<wgpu::RenderPipeline>,
}

fn layout(device: &wgpu::Device, sampling: Sampling) -> wgpu::BindGroupLayout {
    let [color, depth] = sampling.multisampled().map(Slot::texels);
    let slots = [
        (0, Slot::Uniform(size_of::<FrameUniform>())),
        (1, color),
        (2, depth),
        (3, Slot::Texels),
        (4, Slot::Uniform(BLOCK_BYTES[0])),
        (5, Slot::Texels),
        (6, Slot::Uniform(BLOCK_BYTES[1])),
        (7, Slot::Texels),
        (8, Slot::Texels),
        (9, Slot::Texels),
        (10, Slot::Texels),
        (11, Slot::FilteredArray),
    ];
    bind::layout(device, "frame", wgpu::ShaderStages::FRAGMENT, &slots)
}

impl Composite {
    pub fn new(device: &Device) -> Self {
        let multi =
            device.adapter.get_downlevel_capabilities().flags.contains(wgpu::DownlevelFlags::MULTISAMPLED_SHADING);
        let none = bind::nothing(&device.device, wgpu::TextureFormat::Rgba8Unorm);
        Self {
            layouts: Sampling::ALL.map(|sampling| layout(&device.device, sampling)),
            layout_tables: tables_layout(device),
            layout_around: around_layout(&device.device),
            pipelines: LruCache::new(),
            evens: LruCache::new(),
            kinds: LruCache::new(),
            no_layers: bind::no_layers(&device.device),
            none,
            reads_samples: multi,
            wind: WindPicture::new(device),
            even: EvenLayouts::new(&device.device),
            even_cells: None,
        }
    }

    /// Whether multisampled targets can be composed sample by sample.
    pub fn reads_samples(&self) -> bool {
        self.reads_samples
    }

    /// Returns the layouts of the bind groups of every composing shader: frame, tables, surroundings.
    pub fn layouts(&self, sampling: Sampling) -> [&wgpu::BindGroupLayout; 3] {
        [&self.layouts[sampling as usize], &self.layout_tables, &self.layout_around]
    }

    /// Creates the bind group of the frame's block, the effects' blocks and textures, the copy of the host's colour,
    /// and the host's other images; `None` unless both blocks of the effects are set.
    pub fn bind(
        &self,
        device: &Device,
        block: &BlockView,
        copy: &wgpu::Texture,
        host: &Frame<'_>,
        composition: &Composition,
    ) -> Option<wgpu::BindGroup> {
        let [Some(between), Some(on_surfaces)] = [Block::Between, Block::OnSurfaces].map(|b| composition.own_block(b))
        else {
            return None;
        };
        let [before, cells, terrain, behind] = composition.textures().each_ref().map(Option::as_ref);
        let sampling = Sampling::of(copy, host.depth);
        let color_view = copy.create_view(&Default::default());
        let depth_view = host.depth_layer().map(Layer::view);
        let [mask_view, classes, normals] =
            [host.mask_layer(), host.classes_layer(), host.normals_layer()].map(|l| l.map(Layer::view));
        // Placeholder for an absent depth; no shader reads it. It must be multisampled if colour is. wgpu's OpenGL
        // backend can adopt multisampled textures but not create them, so colour itself is the placeholder.
        let no_depth = if sampling == Sampling::Multi { &color_view } else { &self.none };
        let entry =
            |binding, view| wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) };
        Some(device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &self.layouts[sampling as usize],
            entries: &[
                block.entry(0),
                between.entry(4),
                on_surfaces.entry(6),
                entry(1, &color_view),
                entry(2, depth_view.as_ref().unwrap_or(no_depth)),
                entry(3, mask_view.as_ref().unwrap_or(&self.none)),
                entry(5, before.unwrap_or(&self.none)),
                entry(7, cells.unwrap_or(&self.none)),
                entry(8, terrain.unwrap_or(&self.none)),
                entry(9, classes.as_ref().unwrap_or(&self.none)),
                entry(10, normals.as_ref().unwrap_or(&self.none)),
                entry(11, behind.unwrap_or(&self.no_layers)),
            ],
        }))
    }

    /// Whether the pipeline of `variant` is compiled.
    pub fn has(&self, variant: &Variant) -> bool {
        let is = |made: &Variant| made == variant;
        if variant.pixels.uses_grid() { self.evens.has(is) } else { self.pipelines.has(is) }
    }

    /// Returns the pixels, the shader and entry point, and the constants of each cached pipeline.
    #[cfg(test)]
    pub fn held(&self) -> Vec<(Pixels, (String, &'static str), crate::stage::Constants)> {
        let all = self.pipelines.keys().chain(self.evens.keys());
        all.map(|variant| (variant.pixels, variant.program(), variant.constants())).collect()
    }

    /// Returns the pipeline of `variant`, compiled at its first use.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn pipeline(&mut self, device: &Arc<Device>, variant: Variant) -> Result<&wgpu::RenderPipeline> {
        let layouts =
            [&self.layouts[variant.sampling as usize], &self.layout_tables, &self.layout_around, &self.even.grid];
        let layouts = if variant.pixels.are_even() { &layouts[..] } else { &layouts[..3] };
        let make = || {
            let ((shader, entry), constants) = (variant.program(), variant.constants());
            let shader = &shader;
            let targets = match variant.pixels {
                Pixels::Grid => EvenLayouts::targets().0.to_vec(),
                _ => vec![variant.target(wgpu::ColorWrites::ALL)],
            };
            let (constants, samples) = (constants.all(), variant.samples);
            let desc = FullscreenDesc { shader, entry, layouts, targets: &targets, constants, samples };
            Ok((variant, pass::fullscreen_at(device, &desc, variant.pixels.test())?))
        };
        let is = |made: &Variant| *made == variant;
        if variant.pixels.uses_grid() { self.evens.get_or_make(is, make) } else { self.pipelines.get_or_make(is, make) }
    }

    /// Returns the pipeline that draws a picture of the wind instead of `variant`'s picture, and its group 1.
    ///
    /// # Errors
    /// A missing shader file; a time that the weather does not cover.
    pub fn wind(
        &mut self,
        device: &Arc<Device>,
        variant: Variant,
        now: &SceneMoment<'_>,
    ) -> Result<(wgpu::RenderPipeline, wgpu::BindGroup)> {
        let group = self.wind.bind(device, now)?;
        let layouts = [&self.layouts[variant.sampling as usize], &self.wind.layout];
        let make = || {
            let of = &variant.constants;
            let constants = [
                ("DEPTH_KINDS", of.between.value("DEPTH_KINDS")),
                ("ENCODED", of.composed.value("ENCODED")),
                ("HAS_DEPTH", flag(variant.images[0])),
                ("HAS_MASK", flag(variant.images[1])),
            ];
            let targets = [variant.target(wgpu::ColorWrites::ALL)];
            let desc = FullscreenDesc {
                shader: variant.sampling.wind_picture(),
                entry: "wind",
                layouts: &layouts,
                targets: &targets,
                constants: &constants,
                samples: variant.samples,
            };
            Ok((variant, pass::fullscreen_at(device, &desc, variant.pixels.test())?))
        };
        let pipeline = self.pipelines.get_or_make(|made| *made == variant, make)?;
        Ok((pipeline.clone(), group))
    }

    /// Returns the pipelines of the coarse grid of `all` and of its cells, compiled at their first use.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn even(&mut self, device: &Arc<Device>, all: &Variant) -> Result<[wgpu::RenderPipeline; 2]> {
        let grid = self.pipeline(device, even::grid_of(all))?.clone();
        if let Some(cells) = &self.even_cells {
            return Ok([grid, cells.clone()]);
        }
        let desc = FullscreenDesc {
            shader: "frame/even_cells.wgsl",
            entry: "even_cells",
            layouts: &[&self.even.weather],
            targets: &[EvenLayouts::targets().1],
            constants: &[],
            samples: 1,
        };
        let cells = self.even_cells.insert(pass::fullscreen(device, &desc)?);
        Ok([grid, cells.clone()])
    }

    /// Returns the pipeline that writes the kinds of the pixels of `variant`, compiled at its first use. If
    /// `with_even`, it also marks the pixels interpolated from the coarse grid.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn kinds(&mut self, device: &Arc<Device>, variant: &Variant, with_even: bool) -> Result<&wgpu::RenderPipeline> {
        let layouts =
            [&self.layouts[variant.sampling as usize], &self.layout_tables, &self.layout_around, &self.even.grid];
        let layouts = if with_even { &layouts[..] } else { &layouts[..3] };
        let between = &variant.constants.between;
        let constants = [
            ("DEPTH_KINDS", between.value("DEPTH_KINDS")),
            ("HAS_DEPTH", flag(variant.images[0])),
            ("APART", flag(kinds::draws_apart(variant))),
            ("SPLITS", flag(device.caps().software)),
        ];
        let kinds = KindsPipeline { format: variant.format, sampling: variant.sampling, constants, with_even };
        self.kinds.get_or_make(
            |made| *made == kinds,
            || {
                let targets = [variant.target(wgpu::ColorWrites::empty())];
                let (shader, entry, constants) = match with_even {
                    true => ("frame/kinds_even.wgsl", "kinds_even", &kinds.constants[..]),
                    false => (variant.sampling.kinds(), "kinds", &kinds.constants[..2]),
                };
                let desc = FullscreenDesc { shader, entry, layouts, targets: &targets, constants, samples: 1 };
                Ok((kinds, pass::fullscreen_at(device, &desc, Some(Pixels::writes()))?))
            },
        )
    }
}
