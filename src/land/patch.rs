//! Mesh of a patch, and the instances that place it: what pictures and shadow maps draw.

use std::ops::Range;

use super::{selection::PATCH, uniforms::PatchInstance};
use crate::gpu::Device;

/// Number of indices of a patch, which has two triangles for each square.
const INDICES: u32 = (PATCH * PATCH * 6) as u32;
/// Number of instances for which there is room at first.
const FIRST_INSTANCES: usize = 512;

/// Indices of the triangles of a patch, in rows from the south-west. Each square is split from its south-western to its
/// north-eastern corner.
pub(super) fn patch_indices() -> impl Iterator<Item = u16> {
    let vertices = PATCH as u16 + 1;
    (0..PATCH as u16).flat_map(move |j| {
        (0..PATCH as u16).flat_map(move |i| {
            let low = j * vertices + i;
            let (east, north, far) = (low + 1, low + vertices, low + vertices + 1);
            [low, east, far, low, far, north]
        })
    })
}

/// Layout of the instances' buffer.
pub(super) fn patch_layout() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![0 => Sint32x2, 1 => Uint32x2];
    wgpu::VertexBufferLayout {
        array_stride: size_of::<PatchInstance>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &ATTRIBUTES,
    }
}

/// Buffers of the indices and of the instances.
pub(super) struct PatchMesh {
    indices: wgpu::Buffer,
    instances: wgpu::Buffer,
}

fn buffer(device: &wgpu::Device, bytes: usize, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("land patches"),
        size: bytes as u64,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

impl PatchMesh {
    pub fn new(device: &Device) -> Self {
        let list: Vec<u16> = patch_indices().collect();
        let gpu = &device.device;
        let indices = buffer(gpu, size_of_val(list.as_slice()), wgpu::BufferUsages::INDEX);
        device.write_buffer(&indices, 0, bytemuck::cast_slice(&list));
        let bytes = FIRST_INSTANCES * size_of::<PatchInstance>();
        Self { indices, instances: buffer(gpu, bytes, wgpu::BufferUsages::VERTEX) }
    }

    /// GPU memory, bytes.
    pub fn bytes(&self) -> u64 {
        self.indices.size() + self.instances.size()
    }

    /// Writes the instances of the next submission.
    pub fn write(&mut self, device: &Device, patches: &[PatchInstance]) {
        let bytes: &[u8] = bytemuck::cast_slice(patches);
        if (self.instances.size() as usize) < bytes.len() {
            self.instances = buffer(&device.device, bytes.len().next_power_of_two(), wgpu::BufferUsages::VERTEX);
        }
        device.write_buffer(&self.instances, 0, bytes);
    }

    /// Draws a range of the instances.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, patches: Range<u32>) {
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint16);
        pass.set_vertex_buffer(0, self.instances.slice(..));
        pass.draw_indexed(0..INDICES, 0, patches);
    }
}
