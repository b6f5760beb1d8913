//! Drops on devices with compute shaders: only the drops in the picture are drawn, by a list
//! ([`crate::particles::listing`]). Shaders: `shaders/rain/cull.wgsl` and `cull_streaks.wgsl`.

use super::{
    local::{COLUMNS_BYTES, LOCAL, LocalUniform},
    shells::SHELLS,
    uniforms::RainUniform,
};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        blocks::BlockView,
        pass::{self, ComputeDesc, PassPipelines, QuadsDesc},
    },
    particles::{
        DepthRead, LAYER_FORMAT,
        listing::Listing,
        stepping::{STATE_BYTES, source_layout},
    },
};

/// Size of a `Streak` of `shaders/rain/drops.wgsl`, bytes.
const STREAK_BYTES: u64 = 48;

/// State that a view holds to draw drops by lists.
pub(super) struct CullPass {
    /// Layouts of the frame's blocks, and of stepped drops.
    layouts: [wgpu::BindGroupLayout; 2],
    /// Bind group of the frame's blocks.
    frame: wgpu::BindGroup,
    /// Bind group of placeholders, bound if no drops are stepped.
    unstepped: wgpu::BindGroup,
    listing: Listing,
    /// Pipelines of `mark`, by whether drops are stepped.
    marks: PassPipelines<bool, wgpu::ComputePipeline>,
    /// Pipeline of `order`.
    order: Option<wgpu::ComputePipeline>,
    /// Pipelines of `make_streaks`, by whether drops are stepped, and whether area rims and occluder maps are in use.
    makes: PassPipelines<[bool; 3], wgpu::ComputePipeline>,
    /// Pipelines of the draw, by how depth is read.
    draws: PassPipelines<DepthRead, wgpu::RenderPipeline>,
    /// Whether the pass counts how often each pixel is drawn, instead of drawing light.
    counts: bool,
}

/// Drops of the lattice that a frame draws.
#[derive(Clone, Copy)]
pub(super) struct DropLattice<'a> {
    /// Number of drawn shells.
    pub shells: u32,
    /// Number of drops in a shell.
    pub per_shell: u32,
    /// Bind group with the states of the drops, if they are stepped. Its layout is [`source_layout`].
    pub states: Option<&'a wgpu::BindGroup>,
    /// Whether a rim of a rain area is near.
    pub areas: bool,
    /// Whether there are occluder maps.
    pub maps: bool,
}

impl CullPass {
    /// Returns whether `device` can draw drops by lists.
    pub fn serves(device: &Device) -> bool {
        device.caps().tier > 0
    }

    /// Creates the state. `rain` is the rain's block, `local` the buffer of [`LocalUniform`].
    pub fn new(device: &wgpu::Device, (rain, local): (&BlockView, &wgpu::Buffer), counts: bool) -> Self {
        let slots = [
            (0, Slot::Uniform(size_of::<RainUniform>())),
            (7, Slot::Uniform(COLUMNS_BYTES)),
            (8, Slot::Uniform(size_of::<LocalUniform>() - COLUMNS_BYTES)),
        ];
        let frame = bind::layout(device, "cull frame", wgpu::ShaderStages::COMPUTE, &slots);
        let source = source_layout(device);
        let make = |label, size| {
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::UNIFORM;
            device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        let group = |layout, entries: &[wgpu::BindGroupEntry<'_>]| {
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("cull"), layout, entries })
        };
        let [eyes, states] =
            [("no eyes", 16 * SHELLS as u64), ("no drops", STATE_BYTES)].map(|(label, bytes)| make(label, bytes));
        Self {
            frame: group(
                &frame,
                &[
                    rain.part(0, 0, size_of::<RainUniform>()),
                    bind::part(7, local, 0..COLUMNS_BYTES),
                    bind::part(8, local, LOCAL),
                ],
            ),
            unstepped: group(&source, &[bind::buffer(0, &eyes), bind::buffer(1, &states)]),
            layouts: [frame, source],
            listing: Listing::new(device, STREAK_BYTES),
            marks: PassPipelines::NONE,
            order: None,
            makes: PassPipelines::NONE,
            draws: PassPipelines::NONE,
            counts,
        }
    }

    /// Returns the bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        self.listing.bytes()
    }

    /// Records the passes that find the drops in the picture. The rain's blocks are already uploaded.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn find(
        &mut self,
        device: &Device,
        pass: &mut wgpu::ComputePass<'_>,
        (around_layout, around): (&wgpu::BindGroupLayout, &wgpu::BindGroup),
        lattice: DropLattice<'_>,
    ) -> Result<()> {
        let drops = [lattice.per_shell, lattice.shells];
        self.listing.make_room(&device.device, drops);
        self.prepare(device, around_layout, lattice)?;
        let stepped = lattice.states.is_some();
        let (Some(mark), Some(order), Some(streaks)) =
            (self.marks.get(&stepped), &self.order, self.makes.get(&[stepped, lattice.areas, lattice.maps]))
        else {
            return Ok(());
        };
        pass.set_bind_group(0, &self.frame, &[]);
        pass.set_bind_group(2, around, &[]);
        pass.set_bind_group(3, lattice.states.unwrap_or(&self.unstepped), &[]);
        self.listing.find(pass, [mark, order, streaks], drops);
        Ok(())
    }

    /// Compiles the pipeline of the draw for a way of reading depth if it does not exist yet.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn prepare_draw(&mut self, device: &Device, frame: &wgpu::BindGroupLayout, depth: DepthRead) -> Result<()> {
        let attribute = |shader_location, offset, format| wgpu::VertexAttribute { format, offset, shader_location };
        let attributes = [
            attribute(0, 0, wgpu::VertexFormat::Float32x4),
            attribute(1, 16, wgpu::VertexFormat::Float32x3),
            attribute(2, 32, wgpu::VertexFormat::Float32x4),
        ];
        let entries = ["listed_vertex", "rain_fragment"];
        let listed = ListedQuads { entries, attributes: &attributes, bytes: STREAK_BYTES };
        self.draws.prepare(depth, |_| listed_pipeline(device, frame, &listed, depth, self.counts))
    }

    /// Draws the listed drops. The caller has set group 0.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, depth: DepthRead) {
        if let Some(pipeline) = self.draws.get(&depth) {
            pass.set_pipeline(pipeline);
            self.listing.draw(pass);
        }
    }

    /// Creates the pipelines that this lattice needs and that do not exist yet.
    fn prepare(
        &mut self,
        device: &Device,
        surroundings: &wgpu::BindGroupLayout,
        lattice: DropLattice<'_>,
    ) -> Result<()> {
        let DropLattice { states, areas, maps, .. } = lattice;
        let ([frame, source], [found, streaks]) = (&self.layouts, &self.listing.layouts);
        let is_stepped = states.is_some();
        let flag = |name, on| (name, f64::from(u8::from(on)));
        let stepped = flag("STEPPED", is_stepped);
        let compute = |shader, entry, layouts: &[Option<&wgpu::BindGroupLayout>], constants: &[(&str, f64)]| {
            pass::compute(device, &ComputeDesc { shader, entry, layouts, constants })
        };
        self.marks.prepare(is_stepped, |_| {
            compute("rain/cull.wgsl", "mark", &[Some(frame), Some(found), None, Some(source)], &[stepped])
        })?;
        if self.order.is_none() {
            self.order = Some(compute("rain/cull.wgsl", "order", &[Some(frame), Some(found)], &[])?);
        }
        self.makes.prepare([is_stepped, areas, maps], |_| {
            // Sets OVERLAPS to false: local_drops mixes one column after another, so later ones cover earlier ones.
            let constants = [stepped, flag("AREAS", areas), flag("OVERLAPS", false), flag("MAPS", maps)];
            let layouts = [Some(frame), Some(streaks), Some(surroundings), Some(source)];
            compute("rain/cull_streaks.wgsl", "make_streaks", &layouts, &constants)
        })
    }
}

/// Quads that compute shaders have written.
pub(super) struct ListedQuads<'a> {
    /// Entry points of the vertex and the fragment shader.
    pub entries: [&'static str; 2],
    /// Vertex attributes of an instance.
    pub attributes: &'a [wgpu::VertexAttribute],
    /// Size of an instance, bytes.
    pub bytes: u64,
}

/// Creates the pipeline that draws listed quads.
pub(super) fn listed_pipeline(
    device: &Device,
    frame: &wgpu::BindGroupLayout,
    &ListedQuads { entries: [vertex, fragment], attributes, bytes }: &ListedQuads<'_>,
    depth: DepthRead,
    counts: bool,
) -> Result<wgpu::RenderPipeline> {
    let module = device.shader(&depth.shader("rain/drops_view.wgsl"))?;
    pass::quads(
        device,
        &QuadsDesc {
            label: "listed",
            vertex: (&module, vertex, &[]),
            fragment: (&module, fragment, &depth.constants()),
            layouts: &[Some(frame)],
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: bytes,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes,
            })],
            format: LAYER_FORMAT,
            counts,
        },
    )
}

#[cfg(test)]
mod tests;
