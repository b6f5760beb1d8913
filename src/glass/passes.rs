//! GPU resources of the glass: pipelines that all views share, a view's lattice, and the lens over a picture.

use std::sync::Arc;

use super::{
    cell_passes::{CELLS, WORD, bind, buffer, cells_pipeline, settle_pipelines, tex, texture, view},
    lens::{LensFrame, LensUniform},
    reach_pass::{self, MapReach, Mapped, MappedKit},
    step::StepUniform,
};
use crate::{
    error::Result,
    gpu::{
        Device, KeptLayer, Layer,
        bind::Slot,
        is_kept,
        pass::{self, FullscreenDesc},
        recent::LruCache,
    },
    stage::flag,
};

/// Format of the smaller copies of the picture.
const SMALL: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Factor by which width and height of the picture are larger than those of its first copy.
const SMALLER: u32 = 8;
/// Factor by which width and height of the first copy are larger than those of the second.
const SMALLEST: u32 = 4;

/// Properties that select a lens pipeline.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct LensVariant {
    /// Format of the target.
    pub format: wgpu::TextureFormat,
    /// Whether the picture's values are sRGB-encoded.
    pub encoded: bool,
    /// Whether the host gives a mask.
    pub has_mask: bool,
}

/// Largest number of cached lens pipelines. Each [`LensVariant`] in use needs one.
const MOST_LENSES: usize = 16;

/// Pipelines and layouts, one set for each device.
pub(crate) struct GlassKit {
    step_layout: wgpu::BindGroupLayout,
    decide: wgpu::RenderPipeline,
    gather: wgpu::RenderPipeline,
    declare: wgpu::RenderPipeline,
    /// Pipelines of a step and of the declared state of snow.
    settle: [wgpu::RenderPipeline; 2],
    /// Additional pipelines for glass below occluder maps, created when a view first needs them.
    mapped: Option<MappedKit>,
    shrink_layout: wgpu::BindGroupLayout,
    /// Pipelines of the first copy of a linear and of an sRGB-encoded picture, and of the second copy.
    shrink: [wgpu::RenderPipeline; 3],
    lens_layout: wgpu::BindGroupLayout,
    /// Pipelines of the lens.
    lenses: LruCache<LensVariant, wgpu::RenderPipeline, MOST_LENSES>,
    sampler: wgpu::Sampler,
    /// Placeholder for a missing mask; `no_cells` and `no_snow` are those for dry glass.
    no_mask: wgpu::TextureView,
    no_cells: wgpu::TextureView,
    no_snow: wgpu::TextureView,
}

impl GlassKit {
    /// Compiles the pipelines that every lattice needs.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn new(device: &Arc<Device>) -> Result<Self> {
        let layout = |slots: &[(u32, Slot)]| {
            crate::gpu::bind::layout(&device.device, "glass", wgpu::ShaderStages::FRAGMENT, slots)
        };
        let step_layout = layout(&[
            (0, Slot::DynamicUniform(size_of::<StepUniform>())),
            (1, Slot::Words),
            (2, Slot::Words),
            (3, Slot::Words),
            (4, Slot::Words),
        ]);
        let shrink_layout = layout(&[(0, Slot::Texels)]);
        let lens_layout = layout(&[
            (0, Slot::Uniform(size_of::<LensUniform>())),
            (1, Slot::Words),
            (2, Slot::Texels),
            (3, Slot::Filtered),
            (4, Slot::Filtered),
            (5, Slot::Sampler),
            (6, Slot::Texels),
            (7, Slot::Words),
        ]);
        let cells = |shader, entry| cells_pipeline(device, (shader, entry), &step_layout, &[]);
        let shrink = |factor: u32, encoded: f64| {
            let desc = FullscreenDesc {
                shader: "glass/shrink.wgsl",
                entry: "shrink",
                layouts: &[&shrink_layout],
                targets: &[SMALL.into()],
                constants: &[("FACTOR", f64::from(factor)), ("ENCODED", encoded)],
                samples: 1,
            };
            pass::fullscreen(device, &desc)
        };
        Ok(Self {
            decide: cells("glass/decide.wgsl", "decide")?,
            gather: cells("glass/gather.wgsl", "gather")?,
            declare: cells("glass/declare.wgsl", "declare")?,
            settle: settle_pipelines(device, &step_layout, &[])?,
            mapped: None,
            shrink: [shrink(SMALLER, 0.0)?, shrink(SMALLER, 1.0)?, shrink(SMALLEST, 0.0)?],
            lenses: LruCache::new(),
            sampler: device.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("glass"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
            no_mask: view(&texture(device, "no mask", wgpu::TextureFormat::Rgba8Unorm, [1, 1])),
            no_cells: view(&texture(device, "no cells", CELLS, [1, 1])),
            no_snow: view(&texture(device, "no snow", WORD, [1, 1])),
            step_layout,
            shrink_layout,
            lens_layout,
        })
    }

    /// Returns the lens pipeline of a variant, created at first use.
    fn lens(&mut self, device: &Arc<Device>, variant: LensVariant) -> Result<&wgpu::RenderPipeline> {
        let layout = &self.lens_layout;
        self.lenses.get_or_make(
            |made| *made == variant,
            || {
                let desc = FullscreenDesc {
                    shader: "glass/lens.wgsl",
                    entry: "look_through",
                    layouts: &[layout],
                    targets: &[variant.format.into()],
                    constants: &[("ENCODED", flag(variant.encoded)), ("HAS_MASK", flag(variant.has_mask))],
                    samples: 1,
                };
                Ok((variant, pass::fullscreen(device, &desc)?))
            },
        )
    }
}

/// Kind of a step's work on the lattice.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum LatticeWork {
    /// Takes the declared state of a time.
    Declare,
    /// Advances by one step.
    Move,
}

/// Water and snow in the cells of a view's glass, on the GPU.
pub(super) struct PaneLattice {
    /// Columns and rows.
    pub size: [u32; 2],
    /// Water in the cells, in two states: the present one, and the target of the next step.
    cells: [wgpu::Texture; 2],
    views: [wgpu::TextureView; 2],
    /// Motion of each bead in a step, between its two passes.
    moves: wgpu::TextureView,
    /// Snow on the cells, in two states: the present one, and the target of the next step.
    snow: [wgpu::Texture; 2],
    snow_views: [wgpu::TextureView; 2],
    /// Shares of the rain that maps let through to the nodes over the pane.
    mapped: (wgpu::Texture, wgpu::TextureView),
    /// Index of the present state of the cells.
    now: usize,
    /// Index of the present state of the snow.
    snow_now: usize,
    /// Bind groups by the present state of the snow, then of the cells. The first of each two is for the pass that
    /// writes the moves: it has the other state of the cells in place of the moves. The second reads the cells and the
    /// moves.
    groups: [[[wgpu::BindGroup; 2]; 2]; 2],
    /// Uniform blocks of the due steps, every `stride` bytes.
    steps: wgpu::Buffer,
    /// Distance between the blocks of consecutive steps, bytes.
    stride: usize,
    /// Bytes of the steps' uniform blocks, before they are uploaded.
    slots: Vec<u8>,
    /// Work that is due, and whether snow takes part in it.
    due: Vec<(LatticeWork, bool)>,
}

impl PaneLattice {
    /// Creates the textures of a lattice of `size`, (columns, rows), for updates of at most `most_steps` steps.
    pub fn new(device: &Device, kit: &GlassKit, size: [u32; 2], most_steps: usize) -> Self {
        let cells = ["glass 0", "glass 1"].map(|label| texture(device, label, CELLS, size));
        let views = [view(&cells[0]), view(&cells[1])];
        let moves = view(&texture(device, "glass moves", CELLS, size));
        let snow = ["snow on glass 0", "snow on glass 1"].map(|label| texture(device, label, WORD, size));
        let snow_views = [view(&snow[0]), view(&snow[1])];
        let mapped = texture(device, "glass below maps", WORD, reach_pass::SIZE);
        let mapped = (mapped.clone(), view(&mapped));
        let alignment = device.device.limits().min_uniform_buffer_offset_alignment as usize;
        let stride = size_of::<StepUniform>().next_multiple_of(alignment.max(16));
        let steps = buffer(device, "glass steps", (stride * most_steps) as u64);
        let group = |state: usize, moves: &wgpu::TextureView, snow: usize| {
            let numbers = wgpu::BufferBinding {
                buffer: &steps,
                offset: 0,
                size: wgpu::BufferSize::new(size_of::<StepUniform>() as u64),
            };
            let numbers = wgpu::BindingResource::Buffer(numbers);
            let resources = [numbers, tex(&views[state]), tex(moves), tex(&mapped.1), tex(&snow_views[snow])];
            bind(device, &kit.step_layout, &resources)
        };
        let groups = [0, 1].map(|s| [0, 1].map(|i| [group(i, &views[1 - i], s), group(i, &moves, s)]));
        let (slots, due) = (Vec::with_capacity(stride * most_steps), Vec::with_capacity(most_steps));
        Self {
            size,
            cells,
            views,
            moves,
            snow,
            snow_views,
            mapped,
            now: 0,
            snow_now: 0,
            groups,
            steps,
            stride,
            slots,
            due,
        }
    }

    /// Returns the present state of the cells.
    pub fn texture(&self) -> &wgpu::Texture {
        &self.cells[self.now]
    }

    /// Returns the present state of the snow.
    pub fn snow(&self) -> &wgpu::Texture {
        &self.snow[self.snow_now]
    }

    /// Returns the bytes of GPU memory in use.
    pub fn bytes(&self) -> u64 {
        (3 * 16 + 2 * 4) * u64::from(self.size[0]) * u64::from(self.size[1]) + self.steps.size()
    }

    /// Adds work for [`PaneLattice::record`]. A declared state replaces the work that was due before it.
    pub fn add(&mut self, numbers: &StepUniform, (work, has_snow): (LatticeWork, bool)) {
        if work == LatticeWork::Declare {
            self.slots.clear();
            self.due.clear();
        }
        self.slots.extend_from_slice(bytemuck::bytes_of(numbers));
        self.slots.resize(self.stride * (self.due.len() + 1), 0);
        self.due.push((work, has_snow));
    }

    /// Returns the shares of the rain that maps let through, from the last frame that had maps.
    pub fn mapped(&self) -> &wgpu::Texture {
        &self.mapped.0
    }

    /// Records the added work, with the shelter of `maps`. Returns the number of passes.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn record(
        &mut self,
        device: &Device,
        kit: &mut GlassKit,
        encoder: &mut wgpu::CommandEncoder,
        maps: Option<(&mut Option<Box<MapReach>>, &Mapped<'_>)>,
    ) -> Result<u32> {
        if self.due.is_empty() {
            return Ok(0);
        }
        device.write_buffer(&self.steps, 0, &self.slots);
        let mut passes = 0;
        let (mut gather, mut declare, mut settle) = (&kit.gather, &kit.declare, &kit.settle);
        if let Some((reach, mapped)) = maps {
            let more = match &mut kit.mapped {
                Some(more) => more,
                none => none.insert(MappedKit::new(device, &kit.step_layout)?),
            };
            let reach = reach.get_or_insert_with(|| Box::new(MapReach::new(device, more)));
            reach.draw(device, more, encoder, mapped, &self.mapped.1);
            (gather, declare, settle, passes) = (&more.gather, &more.declare, &more.settle, 1);
        }
        for (i, (work, has_snow)) in self.due.iter().enumerate() {
            let offset = (i * self.stride) as u32;
            let (now, next) = (self.now, 1 - self.now);
            let groups = &self.groups[self.snow_now][now];
            let moves = *work == LatticeWork::Move;
            if moves {
                draw(encoder, &kit.decide, (&groups[0], offset), &self.moves);
                passes += 1;
            }
            draw(encoder, if moves { gather } else { declare }, (&groups[1], offset), &self.views[next]);
            passes += 1;
            if *has_snow {
                let target = &self.snow_views[1 - self.snow_now];
                draw(encoder, &settle[usize::from(!moves)], (&groups[1], offset), target);
                self.snow_now = 1 - self.snow_now;
                passes += 1;
            }
            self.now = next;
        }
        self.slots.clear();
        self.due.clear();
        Ok(passes)
    }
}

/// Draws a full-screen pass into a cleared target, with one bind group and the offset of the step's uniforms, bytes.
fn draw(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::RenderPipeline,
    (group, offset): (&wgpu::BindGroup, u32),
    target: &wgpu::TextureView,
) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("glass"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[offset]);
    pass.draw(0..3, 0..1);
}

/// Inputs of a lens to draw.
pub(super) struct LensDraw<'a> {
    pub uniform: &'a LensUniform,
    pub variant: LensVariant,
    pub target: &'a wgpu::TextureView,
}

/// Lens over one picture, with its smaller copies and bind groups. It is created again when the host gives other
/// textures, or when the lattice has another size.
pub(super) struct LensPass {
    picture: wgpu::Texture,
    mask: Option<KeptLayer>,
    /// Smaller copies of the picture.
    smaller: [wgpu::TextureView; 2],
    shrinks: [wgpu::BindGroup; 2],
    uniform: wgpu::Buffer,
    /// Bind groups by the state of the lattice's snow, then of its cells.
    groups: [[wgpu::BindGroup; 2]; 2],
    /// Size of the lattice whose textures the bind groups have.
    lattice: Option<[u32; 2]>,
    /// GPU memory in use, bytes.
    bytes: u64,
}

impl LensPass {
    /// Creates the textures and bind groups for the host's picture, and for a pane's lattice if there is one.
    pub fn new(device: &Device, kit: &GlassKit, frame: &LensFrame<'_>, lattice: Option<&PaneLattice>) -> Self {
        let (picture, mask) = (frame.picture, frame.mask);
        let size = [picture.width().div_ceil(SMALLER), picture.height().div_ceil(SMALLER)];
        let smallest = size.map(|n| n.div_ceil(SMALLEST));
        let smaller =
            [view(&texture(device, "smaller", SMALL, size)), view(&texture(device, "smallest", SMALL, smallest))];
        let source = view(picture);
        let shrinks = [&source, &smaller[0]].map(|v| bind(device, &kit.shrink_layout, &[tex(v)]));
        let uniform = buffer(device, "lens", size_of::<LensUniform>() as u64);
        let mask_view = mask.map_or_else(|| kit.no_mask.clone(), Layer::view);
        let group = |snow: usize, i: usize| {
            let resources = [
                uniform.as_entire_binding(),
                tex(lattice.map_or(&kit.no_cells, |l| &l.views[i])),
                tex(&source),
                tex(&smaller[0]),
                tex(&smaller[1]),
                wgpu::BindingResource::Sampler(&kit.sampler),
                tex(&mask_view),
                tex(lattice.map_or(&kit.no_snow, |l| &l.snow_views[snow])),
            ];
            bind(device, &kit.lens_layout, &resources)
        };
        let groups = [0, 1].map(|snow| [0, 1].map(|i| group(snow, i)));
        let bytes = 8 * u64::from(size[0] * size[1] + smallest[0] * smallest[1]);
        let lattice = lattice.map(|l| l.size);
        Self {
            picture: picture.clone(),
            mask: mask.map(Layer::kept),
            smaller,
            shrinks,
            uniform,
            groups,
            lattice,
            bytes,
        }
    }

    /// Returns whether the lens was created for these textures.
    pub fn serves(&self, frame: &LensFrame<'_>, lattice: Option<&PaneLattice>) -> bool {
        self.picture == *frame.picture
            && is_kept(frame.mask, self.mask.as_ref())
            && self.lattice == lattice.map(|l| l.size)
    }

    /// Returns the GPU memory in use, bytes.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Draws the lens over the finished picture, which is in the texture given to [`LensPass::new`]. Returns the number
    /// of passes.
    pub fn draw(
        &self,
        device: &Arc<Device>,
        kit: &mut GlassKit,
        encoder: &mut wgpu::CommandEncoder,
        &LensDraw { uniform, variant, target }: &LensDraw<'_>,
        lattice: Option<&PaneLattice>,
    ) -> Result<u32> {
        device.write_buffer(&self.uniform, 0, bytemuck::bytes_of(uniform));
        let first = &kit.shrink[usize::from(variant.encoded)];
        pass::draw(encoder, "smaller", first, &[&self.shrinks[0]], &self.smaller[0]);
        pass::draw(encoder, "smallest", &kit.shrink[2], &[&self.shrinks[1]], &self.smaller[1]);
        let (snow, now) = lattice.map_or((0, 0), |l| (l.snow_now, l.now));
        let group = &self.groups[snow][now];
        let pipeline = kit.lens(device, variant)?;
        pass::draw(encoder, "lens", pipeline, &[group], target);
        Ok(3)
    }
}
