//! The list of things that a picture shows, of all that fall round the camera: a few in a hundred of a lattice.
//!
//! Three passes of compute shaders: each thing is asked whether it can be in the picture (a bit each); those that can
//! are counted off in the order of their numbers (`shaders/falling/order.wgsl`, `list.wgsl`); and what draws each of
//! them, shelter and lamps with it, is found once. The draw then only spreads corners. How many there are stays on the
//! GPU.

use crate::gpu::bind::{self, Slot};

/// Bytes and things of a `Block` of `shaders/falling/list.wgsl`.
const BLOCK_BYTES: u64 = 20;
pub(crate) const BLOCK_THINGS: u32 = 128;
/// Things of a workgroup that marks: 64 threads, a word of 32 bits each.
const MARK_THINGS: u32 = 64 * 32;
/// Bytes of `Found` of `shaders/falling/order.wgsl`, and where the workgroups stand in it.
const FOUND_BYTES: u64 = 32;
const GROUPS_AT: u64 = 16;
/// Room of a list, whatever the lattice: beyond the share of it that [`room`] says.
const LEAST_ROOM: u64 = 16_384;

/// A list, and the buffers it is made in.
pub(crate) struct Listing {
    /// Bytes of what draws a thing.
    thing_bytes: u64,
    /// Layouts of group 1: as things are marked and ordered, and as what draws them is made.
    pub layouts: [wgpu::BindGroupLayout; 2],
    found: wgpu::Buffer,
    held: Option<ListBuffers>,
    /// In place of what follows from the lattice.
    #[cfg(test)]
    pub room: Option<u64>,
}

/// Room for the things of a lattice.
struct ListBuffers {
    blocks: wgpu::Buffer,
    things: wgpu::Buffer,
    groups: [wgpu::BindGroup; 2],
}

/// Blocks for so many things a row. A number that grows makes lists anew now and then, not each frame.
fn blocks_of([things, rows]: [u32; 2]) -> u64 {
    u64::from(things.div_ceil(BLOCK_THINGS).next_power_of_two()) * u64::from(rows)
}

/// Most things that a list has room for, of `blocks`. Within a shell's own reach are half of its things at most, and
/// four in ten of all; a picture 150 degrees wide shows half of those.
pub(crate) fn room(device: &wgpu::Device, blocks: u64, thing_bytes: u64) -> u64 {
    let most = device.limits().max_storage_buffer_binding_size / thing_bytes;
    (blocks * u64::from(BLOCK_THINGS) / 4).max(LEAST_ROOM).min(most)
}

impl Listing {
    pub fn new(device: &wgpu::Device, thing_bytes: u64) -> Self {
        let slots = [(0, Slot::Storage(BLOCK_BYTES)), (1, Slot::Storage(thing_bytes)), (2, Slot::Storage(FOUND_BYTES))];
        let layout = |label, slots: &[(u32, Slot)]| bind::layout(device, label, wgpu::ShaderStages::COMPUTE, slots);
        Self {
            thing_bytes,
            layouts: [layout("list", &slots), layout("listed", &slots[..2])],
            found: buffer(device, "found", FOUND_BYTES, wgpu::BufferUsages::INDIRECT),
            held: None,
            #[cfg(test)]
            room: None,
        }
    }

    /// Bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        self.held.as_ref().map_or(0, |h| h.blocks.size() + h.things.size())
    }

    /// Makes room for so many things a row and so many rows; each row begins a block. A list that is too small is
    /// replaced.
    pub fn make_room(&mut self, device: &wgpu::Device, things: [u32; 2]) {
        let blocks = blocks_of(things);
        if self.held.as_ref().is_some_and(|h| h.blocks.size() >= blocks * BLOCK_BYTES) {
            return;
        }
        let room = room(device, blocks, self.thing_bytes);
        #[cfg(test)]
        let room = self.room.unwrap_or(room);
        let blocks = buffer(device, "list", blocks * BLOCK_BYTES, wgpu::BufferUsages::empty());
        let things = buffer(device, "listed", room * self.thing_bytes, wgpu::BufferUsages::VERTEX);
        let entries = [bind::buffer(0, &blocks), bind::buffer(1, &things), bind::buffer(2, &self.found)];
        let group = |layout, entries: &[wgpu::BindGroupEntry<'_>]| {
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("list"), layout, entries })
        };
        let groups = [group(&self.layouts[0], &entries), group(&self.layouts[1], &entries[..2])];
        self.held = Some(ListBuffers { blocks, things, groups });
    }

    /// Marks the things of each row, orders them, and makes what draws them; the other groups are set.
    pub fn find(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        [mark, order, make]: [&wgpu::ComputePipeline; 3],
        [things, rows]: [u32; 2],
    ) {
        let Some(held) = &self.held else { return };
        pass.set_bind_group(1, &held.groups[0], &[]);
        pass.set_pipeline(mark);
        pass.dispatch_workgroups(things.div_ceil(MARK_THINGS).max(1), rows, 1);
        pass.set_pipeline(order);
        pass.dispatch_workgroups(1, 1, 1);
        pass.set_pipeline(make);
        pass.set_bind_group(1, &held.groups[1], &[]);
        pass.dispatch_workgroups_indirect(&self.found, GROUPS_AT);
    }

    /// Draws a quad for each thing that was found; pipeline and groups are set.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(held) = &self.held {
            pass.set_vertex_buffer(0, held.things.slice(..));
            pass.draw_indirect(&self.found, 0);
        }
    }

    /// Forgets what it holds, which the next frame makes anew.
    #[cfg(test)]
    pub fn forget(&mut self) {
        self.held = None;
    }

    /// Returns the buffers of what is found, and of what draws it.
    #[cfg(test)]
    pub fn buffers(&self) -> [&wgpu::Buffer; 2] {
        [&self.found, &self.held.as_ref().expect("a list was made").things]
    }
}

fn buffer(device: &wgpu::Device, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | usage;
    device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
}
