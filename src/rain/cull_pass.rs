//! Drops by a list of those that the picture shows: a few in a hundred of the lattice.
//!
//! Three passes of compute shaders (`shaders/rain/cull.wgsl`, `cull_streaks.wgsl`): each drop is asked whether it can be in the
//! picture; those that can are counted off in the lattice's order, near shells first; and what makes each one's streak,
//! shelter and lamps with it, is found once. The draw then only spreads the streaks' corners. How many there are stays on the GPU.

use super::{
    LocalUniform,
    lattice::SHELLS,
    passes::{COLUMNS_BYTES, FORMAT, LOCAL},
    uniforms::RainUniform,
};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        blocks::BlockView,
        pass::{self, ComputeDesc, QuadsDesc},
    },
    stage::stepping::{STATE_BYTES, source_layout},
};

/// Bytes of a `Streak` of `shaders/rain/drops.wgsl`.
const STREAK_BYTES: u64 = 48;
/// Bytes and drops of a `Block` of `shaders/rain/cull_list.wgsl`.
const BLOCK_BYTES: u64 = 20;
const BLOCK_DROPS: u32 = 128;
/// Bytes of `Found` of `shaders/rain/cull.wgsl`, and where the workgroups stand in it.
const FOUND_BYTES: u64 = 32;
const GROUPS_AT: u64 = 16;
/// Threads of a workgroup, one for 32 drops.
const MARK_DROPS: u32 = 64 * 32;
/// Room of a list, whatever the lattice: beyond the share of it that [`room`] says.
const LEAST_ROOM: u64 = 16_384;

/// What a view holds to draw drops by lists.
pub(super) struct CullPass {
    /// Of the frame's blocks, of the list as it is found and as it is read, and of stepped drops.
    layouts: [wgpu::BindGroupLayout; 4],
    frame: wgpu::BindGroup,
    /// In place of stepped drops.
    unstepped: wgpu::BindGroup,
    found: wgpu::Buffer,
    list: Option<List>,
    /// With and without states.
    marks: [Option<wgpu::ComputePipeline>; 2],
    order: Option<wgpu::ComputePipeline>,
    /// Indexed by whether drops are stepped, and whether area rims and occluder maps are in use.
    makes: [Option<wgpu::ComputePipeline>; 8],
    /// For each kind of depth.
    draws: [Option<wgpu::RenderPipeline>; 4],
    counts: bool,
    #[cfg(test)]
    room: Option<u64>,
}

/// Room for the drops of a lattice.
struct List {
    blocks: wgpu::Buffer,
    streaks: wgpu::Buffer,
    groups: [wgpu::BindGroup; 2],
}

/// The drops of a frame.
#[derive(Clone, Copy)]
pub(super) struct Lattice<'a> {
    pub shells: u32,
    pub per_shell: u32,
    /// Their states, if they are stepped: [`source_layout`].
    pub states: Option<&'a wgpu::BindGroup>,
    /// Whether a rim of a rain area is near, and whether there are occluder maps.
    pub areas: bool,
    pub maps: bool,
}

/// Most drops that a list has room for, of `blocks`. Within a shell's own reach are half of its drops at most, and four in ten
/// of all; a picture 150 degrees wide shows half of those.
fn room(device: &wgpu::Device, blocks: u64) -> u64 {
    let most = device.limits().max_storage_buffer_binding_size / STREAK_BYTES;
    (blocks * u64::from(BLOCK_DROPS) / 4).max(LEAST_ROOM).min(most)
}

fn layouts(device: &wgpu::Device) -> [wgpu::BindGroupLayout; 3] {
    let make = |label, slots: &[(u32, Slot)]| bind::layout(device, label, wgpu::ShaderStages::COMPUTE, slots);
    let frame = [
        (0, Slot::Uniform(size_of::<RainUniform>())),
        (7, Slot::Uniform(COLUMNS_BYTES)),
        (8, Slot::Uniform(size_of::<LocalUniform>() - COLUMNS_BYTES)),
    ];
    let list = [(0, Slot::Storage(BLOCK_BYTES)), (1, Slot::Storage(STREAK_BYTES)), (2, Slot::Storage(FOUND_BYTES))];
    [make("cull frame", &frame), make("cull", &list), make("streaks", &list[..2])]
}

impl CullPass {
    /// Whether `device` can.
    pub fn serves(device: &Device) -> bool {
        device.caps().tier > 0
    }

    /// For the drops of the rain's block, and of its areas'.
    pub fn new(device: &wgpu::Device, (rain, local): (&BlockView, &wgpu::Buffer), counts: bool) -> Self {
        let [frame, found, streaks] = layouts(device);
        let source = source_layout(device);
        let make = |label, size, usage| {
            let usage = wgpu::BufferUsages::STORAGE | usage;
            device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        let group = |layout, entries: &[wgpu::BindGroupEntry<'_>]| {
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("cull"), layout, entries })
        };
        let [eyes, states] = [("no eyes", 16 * SHELLS as u64), ("no drops", STATE_BYTES)]
            .map(|(l, n)| make(l, n, wgpu::BufferUsages::UNIFORM));
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
            layouts: [frame, found, streaks, source],
            found: make("found", FOUND_BYTES, wgpu::BufferUsages::INDIRECT | wgpu::BufferUsages::COPY_SRC),
            list: None,
            marks: [None, None],
            order: None,
            makes: [const { None }; 8],
            draws: [const { None }; 4],
            counts,
            #[cfg(test)]
            room: None,
        }
    }

    /// Bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        self.list.as_ref().map_or(0, |l| l.blocks.size() + l.streaks.size())
    }

    /// Records what finds the drops that the picture shows. The rain's blocks are up.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn find(
        &mut self,
        device: &Device,
        pass: &mut wgpu::ComputePass<'_>,
        (around_layout, around): (&wgpu::BindGroupLayout, &wgpu::BindGroup),
        lattice: Lattice<'_>,
    ) -> Result<()> {
        self.make_room(&device.device, lattice);
        let stepped = lattice.states.is_some();
        let make = key([stepped, lattice.areas, lattice.maps]);
        self.prepare(device, around_layout, lattice)?;
        let (Some(list), Some(mark), Some(order), Some(streaks)) =
            (&self.list, &self.marks[usize::from(stepped)], &self.order, &self.makes[make])
        else {
            return Ok(());
        };
        pass.set_bind_group(0, &self.frame, &[]);
        pass.set_bind_group(1, &list.groups[0], &[]);
        pass.set_bind_group(2, around, &[]);
        pass.set_bind_group(3, lattice.states.unwrap_or(&self.unstepped), &[]);
        pass.set_pipeline(mark);
        pass.dispatch_workgroups(lattice.per_shell.div_ceil(MARK_DROPS).max(1), lattice.shells, 1);
        pass.set_pipeline(order);
        pass.dispatch_workgroups(1, 1, 1);
        pass.set_pipeline(streaks);
        pass.set_bind_group(1, &list.groups[1], &[]);
        pass.dispatch_workgroups_indirect(&self.found, GROUPS_AT);
        Ok(())
    }

    /// Makes the draw's pipeline for a kind of depth (several samples, any at all), if it is not there.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn prepare_draw(&mut self, device: &Device, frame: &wgpu::BindGroupLayout, depth: (bool, bool)) -> Result<()> {
        let slot = &mut self.draws[key([false, depth.0, depth.1])];
        if slot.is_none() {
            let attribute = |shader_location, offset, format| wgpu::VertexAttribute { format, offset, shader_location };
            let attributes = [
                attribute(0, 0, wgpu::VertexFormat::Float32x4),
                attribute(1, 16, wgpu::VertexFormat::Float32x3),
                attribute(2, 32, wgpu::VertexFormat::Float32x4),
            ];
            *slot = Some(listed_pipeline(
                device,
                frame,
                (["listed_vertex", "rain_fragment"], &attributes, STREAK_BYTES),
                (depth, self.counts),
            )?);
        }
        Ok(())
    }

    /// Draws what was found; group 0 is set.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, depth: (bool, bool)) {
        let (Some(pipeline), Some(list)) = (&self.draws[key([false, depth.0, depth.1])], &self.list) else { return };
        pass.set_pipeline(pipeline);
        pass.set_vertex_buffer(0, list.streaks.slice(..));
        pass.draw_indirect(&self.found, 0);
    }

    fn make_room(&mut self, device: &wgpu::Device, lattice: Lattice<'_>) {
        // Rain that grows makes lists anew now and then, not each frame.
        let blocks = u64::from(lattice.per_shell.div_ceil(BLOCK_DROPS).next_power_of_two()) * u64::from(lattice.shells);
        if self.list.as_ref().is_some_and(|l| l.blocks.size() >= blocks * BLOCK_BYTES) {
            return;
        }
        #[cfg(not(test))]
        let room = room(device, blocks);
        #[cfg(test)]
        let room = self.room.unwrap_or_else(|| room(device, blocks));
        let make = |label, size, usage| {
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | usage;
            device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        let blocks = make("cull", blocks * BLOCK_BYTES, wgpu::BufferUsages::empty());
        let streaks = make("streaks", room * STREAK_BYTES, wgpu::BufferUsages::VERTEX);
        let entries = [bind::buffer(0, &blocks), bind::buffer(1, &streaks), bind::buffer(2, &self.found)];
        let group = |layout, entries: &[wgpu::BindGroupEntry<'_>]| {
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("cull"), layout, entries })
        };
        let groups = [group(&self.layouts[1], &entries), group(&self.layouts[2], &entries[..2])];
        self.list = Some(List { blocks, streaks, groups });
    }

    fn prepare(&mut self, device: &Device, around: &wgpu::BindGroupLayout, lattice: Lattice<'_>) -> Result<()> {
        let Lattice { states, areas, maps, .. } = lattice;
        let [frame, found, streaks, source] = &self.layouts;
        let stepped = ("STEPPED", f64::from(u8::from(states.is_some())));
        let mark = &mut self.marks[usize::from(states.is_some())];
        if mark.is_none() {
            let layouts = [Some(frame), Some(found), None, Some(source)];
            let (layouts, constants) = (&layouts, &[stepped]);
            let desc = ComputeDesc { shader: "rain/cull.wgsl", entry: "mark", layouts, constants };
            *mark = Some(pass::compute(device, &desc)?);
        }
        if self.order.is_none() {
            let layouts = [Some(frame), Some(found)];
            let (layouts, constants) = (&layouts, &[]);
            let desc = ComputeDesc { shader: "rain/cull.wgsl", entry: "order", layouts, constants };
            self.order = Some(pass::compute(device, &desc)?);
        }
        let make = &mut self.makes[key([states.is_some(), areas, maps])];
        if make.is_none() {
            let flag = |name, on| (name, f64::from(u8::from(on)));
            // Mixtures take each column by itself: what lies over what is in their order.
            let constants = [stepped, flag("AREAS", areas), flag("OVERLAPS", false), flag("MAPS", maps)];
            let layouts = [Some(frame), Some(streaks), Some(around), Some(source)];
            let (layouts, constants) = (&layouts, &constants);
            let desc = ComputeDesc { shader: "rain/cull_streaks.wgsl", entry: "make_streaks", layouts, constants };
            *make = Some(pass::compute(device, &desc)?);
        }
        Ok(())
    }
}

fn key(bits: [bool; 3]) -> usize {
    bits.into_iter().fold(0, |k, bit| 2 * k + usize::from(bit))
}

/// A draw of what compute shaders have made: what each instance brings to which entry points, in how many bytes.
pub(super) fn listed_pipeline(
    device: &Device,
    frame: &wgpu::BindGroupLayout,
    ([vertex, fragment], attributes, bytes): ([&str; 2], &[wgpu::VertexAttribute], u64),
    ((multi, has_depth), counts): ((bool, bool), bool),
) -> Result<wgpu::RenderPipeline> {
    let module = device.shader(if multi { "rain/drops_view.wgsl:multi" } else { "rain/drops_view.wgsl" })?;
    let constants = [("HAS_DEPTH", f64::from(u8::from(has_depth)))];
    pass::quads(
        device,
        &QuadsDesc {
            label: "listed",
            vertex: (&module, vertex, &[]),
            fragment: (&module, fragment, &constants),
            layouts: &[Some(frame)],
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: bytes,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes,
            })],
            format: FORMAT,
            counts,
        },
    )
}

#[cfg(test)]
mod tests;
