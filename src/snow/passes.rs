//! Flakes on the GPU: their block, their step if they are stepped, and their draw into the layer in front of the
//! picture.

use super::{stepped, uniforms::FlakesUniform};
use crate::{
    error::Result,
    gpu::{
        Device, KeptLayer, Layer,
        bind::{self, Slot},
        blocks::{BlockView, Blocks, UniformBlock},
        is_kept,
        pass::{self, ComputeDesc, PassPipelines, QuadsDesc},
    },
    particles::{
        DepthRead, LAYER_FORMAT, layer_pass,
        listing::Listing,
        stepping::{STATE_BYTES, StepPass, Stepped},
    },
    scene::ViewRays,
    stage::{Recording, flag},
    surroundings::{self, SurroundingsBlock},
};

/// Size of a `Spot` of `shaders/snow/flakes.wgsl`, bytes.
const SPOT_BYTES: u64 = 64;

/// Inputs and target of one frame's flakes.
pub(super) struct FlakeDraw<'a> {
    pub block: &'a FlakesUniform,
    /// Inputs of the step, if the flakes are stepped.
    pub stepped: Option<&'a Stepped<'a>>,
    /// View rays of the camera.
    pub rays: &'a ViewRays,
    pub surroundings: &'a SurroundingsBlock,
    /// Whether the surroundings contain occluder maps.
    pub maps: bool,
    /// Layer in front of the picture.
    pub target: &'a wgpu::TextureView,
    /// Whether the layer already contains rain; flakes are then drawn in front of it.
    pub over: bool,
    /// The host's depth.
    pub depth: Option<Layer<'a>>,
}

/// GPU resources for the flakes of a view, created when the first ones fall.
pub(super) struct SnowPass {
    block: UniformBlock,
    /// Layout of group 0 for depth with one and with several samples.
    layouts: [wgpu::BindGroupLayout; 2],
    /// Layout of the group of shelters, occluder maps and lamps.
    surroundings: wgpu::BindGroupLayout,
    pipelines: PassPipelines<FlakeVariant, wgpu::RenderPipeline>,
    /// List of the flakes in the picture. Used on devices with compute shaders while flakes are not stepped.
    listed: Option<Box<ListedFlakes>>,
    /// Pass that steps flakes, while they are stepped.
    step: Option<Box<StepPass>>,
    /// Placeholder for a missing depth.
    none: wgpu::TextureView,
    /// Depth to which the bind group of group 0 refers, and the bind group.
    bound: Option<(Option<KeptLayer>, wgpu::BindGroup)>,
    /// Whether the pass counts how often pixels are drawn, instead of showing the flakes' light.
    counts: bool,
}

impl SnowPass {
    pub fn new(device: &Device, blocks: &Blocks, counts: bool) -> Self {
        let own = &device.device;
        let layout = |several: bool| {
            let slots = [(0, Slot::Uniform(size_of::<FlakesUniform>())), (1, Slot::texels(several))];
            bind::layout(own, "snow", wgpu::ShaderStages::VERTEX_FRAGMENT, &slots)
        };
        Self {
            block: blocks.block(device, size_of::<FlakesUniform>()),
            layouts: [layout(false), layout(true)],
            surroundings: surroundings::layout(own),
            pipelines: PassPipelines::NONE,
            listed: None,
            step: None,
            none: bind::nothing(own, wgpu::TextureFormat::Rgba8Unorm),
            bound: None,
            counts,
        }
    }

    /// Returns whether the pass counts how often pixels are drawn.
    pub fn counts(&self) -> bool {
        self.counts
    }

    /// Returns the bytes of GPU memory that the stepped states and the list of flakes take.
    pub fn bytes(&self) -> u64 {
        self.step.as_ref().map_or(0, |step| step.bytes()) + self.listed.as_ref().map_or(0, |l| l.listing.bytes())
    }

    /// Draws all flakes.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn draw(&mut self, recording: &mut Recording<'_>, drawn: &FlakeDraw<'_>) -> Result<()> {
        let device = recording.device;
        self.block.write(bytemuck::bytes_of(drawn.block));
        let depth = DepthRead::of(drawn.depth, drawn.rays);
        self.bind(device, drawn.depth, depth.multi);
        let source = match drawn.stepped {
            Some(_) => FlakeSource::Stepped,
            None if device.caps().tier > 0 => FlakeSource::Listed,
            None => FlakeSource::All,
        };
        let kind = FlakeVariant { depth, maps: drawn.maps, source };
        let layouts = [Some(&self.layouts[usize::from(depth.multi)]), None, Some(&self.surroundings)];
        let counts = self.counts;
        self.pipelines.prepare(kind, |_| pipeline(device, &layouts, kind, counts))?;
        match drawn.stepped {
            Some(by) => {
                let step = self.step.get_or_insert_with(|| Box::new(stepped::pass(device, recording.blocks)));
                step.step(device, recording.encoder, self.block.range(0, self.block.bytes()), by)?;
            }
            None => self.step = None,
        }
        if source == FlakeSource::Listed {
            let list = || Box::new(ListedFlakes::new(&device.device, &self.block));
            let listed = self.listed.get_or_insert_with(list);
            listed.find(recording, drawn, &self.surroundings)?;
        }
        let (Some(pipeline), Some((_, group))) = (self.pipelines.get(&kind), &self.bound) else { return Ok(()) };
        let mut pass = layer_pass(recording.encoder, "snow", drawn.target, drawn.over);
        pass.set_bind_group(0, group, &[]);
        pass.set_bind_group(2, drawn.surroundings.bind_group(), &[]);
        pass.set_pipeline(pipeline);
        match (&self.step, &self.listed) {
            // Draw the farthest shell first.
            (Some(step), _) => step.shells().rev().for_each(|(states, count)| {
                pass.set_vertex_buffer(0, states);
                pass.draw(0..4, 0..count);
            }),
            (None, Some(listed)) => listed.listing.draw(&mut pass),
            (None, None) => pass.draw(0..4, 0..drawn.block.count),
        }
        Ok(())
    }

    fn bind(&mut self, device: &Device, depth: Option<Layer<'_>>, several: bool) {
        if self.bound.as_ref().is_some_and(|(d, _)| is_kept(depth, d.as_ref())) {
            return;
        }
        let view = depth.map(Layer::view);
        let texels = wgpu::BindingResource::TextureView(view.as_ref().unwrap_or(&self.none));
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("snow"),
            layout: &self.layouts[usize::from(several)],
            entries: &[self.block.entry(0), wgpu::BindGroupEntry { binding: 1, resource: texels }],
        });
        self.bound = Some((depth.map(Layer::kept), group));
    }
}

/// Source of the drawn flakes: all flakes of the lattice, the list of those in the picture, or stepped states.
#[derive(Clone, Copy, PartialEq)]
enum FlakeSource {
    All,
    Listed,
    Stepped,
}

/// Properties that select the pipeline: how depth is read, whether there are occluder maps, and the source of the
/// flakes.
#[derive(Clone, Copy, PartialEq)]
struct FlakeVariant {
    depth: DepthRead,
    maps: bool,
    source: FlakeSource,
}

fn pipeline(
    device: &Device,
    layouts: &[Option<&wgpu::BindGroupLayout>],
    FlakeVariant { depth, maps, source }: FlakeVariant,
    counts: bool,
) -> Result<wgpu::RenderPipeline> {
    let module = device.shader(&depth.shader("snow/flakes_view.wgsl"))?;
    // Vertex attributes of a flake's state, and of a listed spot.
    const STATE: [wgpu::VertexAttribute; 3] = wgpu::vertex_attr_array![0 => Uint32x3, 1 => Uint32, 2 => Float32x3];
    const SPOT: [wgpu::VertexAttribute; 4] =
        wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Uint32];
    let each = |array_stride, attributes| {
        [Some(wgpu::VertexBufferLayout { array_stride, step_mode: wgpu::VertexStepMode::Instance, attributes })]
    };
    let (state, spot) = (each(STATE_BYTES, &STATE[..]), each(SPOT_BYTES, &SPOT[..]));
    let (vertex, buffers) = match source {
        FlakeSource::All => ("flake_vertex", &[][..]),
        FlakeSource::Listed => ("listed_vertex", &spot[..]),
        FlakeSource::Stepped => ("stepped_vertex", &state[..]),
    };
    pass::quads(
        device,
        &QuadsDesc {
            label: "snow",
            vertex: (&module, vertex, &[("MAPS", flag(maps))]),
            fragment: (&module, "flake_fragment", &depth.constants()),
            layouts,
            buffers,
            format: LAYER_FORMAT,
            counts,
        },
    )
}

/// List of the flakes in a picture ([`crate::particles::listing`]). Shaders: `shaders/snow/cull.wgsl` and
/// `cull_spots.wgsl`.
struct ListedFlakes {
    layout: wgpu::BindGroupLayout,
    /// Bind group with the flakes' block.
    group: wgpu::BindGroup,
    listing: Listing,
    /// Pipelines of `mark` and `order`.
    mark: Option<[wgpu::ComputePipeline; 2]>,
    /// Pipelines of `make_spots`, by whether there are occluder maps.
    makes: PassPipelines<bool, wgpu::ComputePipeline>,
}

impl ListedFlakes {
    fn new(device: &wgpu::Device, block: &BlockView) -> Self {
        let slots = [(0, Slot::Uniform(size_of::<FlakesUniform>()))];
        let layout = bind::layout(device, "snow list", wgpu::ShaderStages::COMPUTE, &slots);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("snow list"),
            layout: &layout,
            entries: &[block.entry(0)],
        });
        Self { layout, group, listing: Listing::new(device, SPOT_BYTES), mark: None, makes: PassPipelines::NONE }
    }

    /// Records the passes that find the flakes in the picture. The flakes' block is already uploaded.
    fn find(
        &mut self,
        recording: &mut Recording<'_>,
        drawn: &FlakeDraw<'_>,
        surroundings: &wgpu::BindGroupLayout,
    ) -> Result<()> {
        let (device, count) = (recording.device, drawn.block.count);
        self.listing.make_room(&device.device, [count, 1]);
        let [list, made] = &self.listing.layouts;
        let compute = |shader, entry, layouts: &[Option<&wgpu::BindGroupLayout>], constants: &[(&str, f64)]| {
            pass::compute(device, &ComputeDesc { shader, entry, layouts, constants })
        };
        if self.mark.is_none() {
            let layouts = [Some(&self.layout), Some(list)];
            let make = |entry| compute("snow/cull.wgsl", entry, &layouts, &[]);
            self.mark = Some([make("mark")?, make("order")?]);
        }
        let layouts = [Some(&self.layout), Some(made), Some(surroundings)];
        self.makes.prepare(drawn.maps, |maps| {
            compute("snow/cull_spots.wgsl", "make_spots", &layouts, &[("MAPS", flag(*maps))])
        })?;
        let (Some([mark, order]), Some(make)) = (&self.mark, self.makes.get(&drawn.maps)) else { return Ok(()) };
        let mut pass = recording.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_bind_group(2, drawn.surroundings.bind_group(), &[]);
        self.listing.find(&mut pass, [mark, order, make], [count, 1]);
        Ok(())
    }
}
