//! Wind that varies in space, for shaders: a texture that all views of a context share, and the mapping of each camera
//! into the texture. Shaders read the texture with `shaders/surroundings/wind.wgsl`.

use std::sync::{Mutex, PoisonError};

use glam::DVec3;

use crate::{gpu::Device, wind::WindVolume};

/// Mapping from camera-relative places to the texture: `WindMap` of `shaders/surroundings/wind.wgsl`, which describes
/// the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct WindMap {
    pub scale: [f32; 3],
    pad0: u32,
    pub offset: [f32; 3],
    pad1: u32,
    pub first: [f32; 3],
    pad2: u32,
}

impl WindMap {
    /// Creates the mapping for a camera at `eye` in the host's world.
    pub fn new(volume: &WindVolume, eye: DVec3) -> Self {
        let v = |d: DVec3| d.as_vec3().to_array();
        let nodes = DVec3::from(volume.nodes.map(f64::from));
        // Nodes lie in the middle of their texels.
        Self {
            scale: v(1.0 / (volume.cell_m * nodes)),
            offset: v((volume.cells_at(eye) + 0.5) / nodes),
            first: v(0.5 / nodes),
            ..Self::default()
        }
    }
}

/// View of the wind's texture.
#[derive(Clone)]
pub(crate) struct WindView {
    pub view: wgpu::TextureView,
    /// Generation of the texture: it changes if the texture is replaced. Bind groups that contain the texture must then
    /// be recreated.
    pub generation: u64,
}

/// Texture with one texel per node.
struct NodeTexture {
    texture: wgpu::Texture,
    /// Numbers of nodes east, north and up.
    nodes: [u32; 3],
    /// Revision of the values that were last uploaded.
    revision: u64,
    shown: WindView,
}

/// Texture of a context's wind, created when a view first needs it and uploaded again when the wind has changed.
#[derive(Default)]
pub(crate) struct WindTexture {
    held: Mutex<WindState>,
}

/// Texture of the wind and what its upload needs.
#[derive(Default)]
struct WindState {
    /// Texture, once a view has needed one.
    texture: Option<NodeTexture>,
    /// Number of textures created so far.
    generation: u64,
    /// Staging memory for an upload.
    texels: Vec<u16>,
}

impl WindTexture {
    /// Returns the texture with the values of `volume`. Without a volume, returns the last texture or, if there is none
    /// yet, a texture of a single texel. No shader reads the texture then.
    pub fn view(&self, device: &Device, volume: Option<&WindVolume>) -> WindView {
        let state = &mut *self.held.lock().unwrap_or_else(PoisonError::into_inner);
        let nodes = volume.map_or([1; 3], |v| v.nodes);
        // Takes 0 without a volume, because the revisions of volumes begin at 1.
        let revision = volume.map_or(0, WindVolume::revision);
        if let Some(held) = state.texture.as_ref().filter(|t| volume.is_none() || t.revision == revision) {
            return held.shown.clone();
        }
        let mut texture = match state.texture.take().filter(|t| t.nodes == nodes) {
            Some(texture) => texture,
            None => {
                state.generation += 1;
                new_texture(device, nodes, state.generation)
            }
        };
        texture.revision = revision;
        if let Some(volume) = volume {
            state.texels.clear();
            state.texels.extend(volume.values.iter().flatten().map(|x| half::f16::from_f32(*x).to_bits()));
            let rows = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(8 * nodes[0]),
                rows_per_image: Some(nodes[1]),
            };
            let texels = bytemuck::cast_slice(&state.texels);
            device.write_texture(texture.texture.as_image_copy(), texels, rows, extent(nodes));
        }
        let shown = texture.shown.clone();
        state.texture = Some(texture);
        shown
    }
}

/// Returns the size of a texture with these numbers of nodes.
fn extent(nodes: [u32; 3]) -> wgpu::Extent3d {
    wgpu::Extent3d { width: nodes[0], height: nodes[1], depth_or_array_layers: nodes[2] }
}

/// Creates a texture with one texel per node, without values.
fn new_texture(device: &Device, nodes: [u32; 3], generation: u64) -> NodeTexture {
    let texture = device.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("wind"),
        size: extent(nodes),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D3,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let view = texture.create_view(&Default::default());
    NodeTexture { texture, nodes, revision: 0, shown: WindView { view, generation } }
}
