//! List of the things (drops, flakes, splashes) that are in the picture: a few percent of those around the camera.
//!
//! There are three compute passes. The first marks each thing that can be in the picture, with one bit. The second
//! assigns the marked things their places in the list, in the order of their numbers (`shaders/falling/order.wgsl`,
//! `list.wgsl`). The third computes the quad of each marked thing once, including shelter and lamps. The draw then only
//! computes corners. The number of listed things stays on the GPU.

use crate::gpu::bind::{self, Slot};

/// Size of a `Block` of `shaders/falling/list.wgsl`, bytes.
const BLOCK_BYTES: u64 = 20;
/// Number of things in a block.
pub(crate) const BLOCK_THINGS: u32 = 128;
/// Number of things per workgroup of the marking pass: 64 threads, a word of 32 bits each.
const MARK_THINGS: u32 = 64 * 32;
/// Size of `Found` of `shaders/falling/order.wgsl`, bytes.
const FOUND_BYTES: u64 = 32;
/// Offset of the number of workgroups in `Found`, bytes.
const GROUPS_AT: u64 = 16;
/// Smallest capacity that [`room`] returns, unless the device's limit is lower.
const LEAST_ROOM: u64 = 16_384;

/// List of things, and the buffers in which it is computed.
pub(crate) struct Listing {
    /// Bytes of one listed thing.
    thing_bytes: u64,
    /// Layouts of group 1: for marking and ordering, and for computing the quads.
    pub layouts: [wgpu::BindGroupLayout; 2],
    /// Buffer of `Found`: the arguments of the draw and of the third pass.
    found: wgpu::Buffer,
    /// Buffers, once there is room for any things.
    held: Option<ListBuffers>,
    /// Capacity to use instead of that derived from the lattice.
    #[cfg(test)]
    pub room: Option<u64>,
}

/// Buffers for the things of a lattice.
struct ListBuffers {
    /// Bits of all things.
    blocks: wgpu::Buffer,
    /// Quads of the listed things.
    things: wgpu::Buffer,
    /// Bind groups for the two layouts of [`Listing::layouts`].
    groups: [wgpu::BindGroup; 2],
}

/// Returns the number of blocks for rows of things. The number for each row is rounded up to a power of two, so that a
/// growing number of things replaces the buffers only now and then.
fn blocks_of([things, rows]: [u32; 2]) -> u64 {
    u64::from(things.div_ceil(BLOCK_THINGS).next_power_of_two()) * u64::from(rows)
}

/// Returns the capacity of a list for a number of blocks: a quarter of the things. Of a shell's cube about half is
/// within its reach, and of the things of all shells four in ten are drawn in some direction. A picture 150 degrees
/// wide shows half of these.
pub(crate) fn room(device: &wgpu::Device, blocks: u64, thing_bytes: u64) -> u64 {
    let most = device.limits().max_storage_buffer_binding_size / thing_bytes;
    (blocks * u64::from(BLOCK_THINGS) / 4).max(LEAST_ROOM).min(most)
}

impl Listing {
    /// Creates an empty list of things of `thing_bytes` each.
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

    /// Returns the bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        self.held.as_ref().map_or(0, |h| h.blocks.size() + h.things.size())
    }

    /// Makes room for a number of things in each row, and a number of rows; each row starts with a new block. Buffers
    /// that are too small are replaced.
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

    /// Marks and orders the things of each row, and computes their quads. The caller has set the other bind groups.
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

    /// Draws a quad for each listed thing. The caller has set the pipeline and the bind groups.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(held) = &self.held {
            pass.set_vertex_buffer(0, held.things.slice(..));
            pass.draw_indirect(&self.found, 0);
        }
    }

    /// Frees the buffers; the next frame creates new ones.
    #[cfg(test)]
    pub fn forget(&mut self) {
        self.held = None;
    }

    /// Returns the buffers of the counts and of the listed things.
    #[cfg(test)]
    pub fn buffers(&self) -> [&wgpu::Buffer; 2] {
        [&self.found, &self.held.as_ref().expect("a list was made").things]
    }
}

/// Creates a storage buffer of `size` bytes, which also has the uses in `usage`.
fn buffer(device: &wgpu::Device, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | usage;
    device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
}
