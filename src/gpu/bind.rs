//! Layouts of bind groups, slot by slot.

use std::ops::Range;

/// Kind of resource at a shader binding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Slot {
    /// A block of so many bytes; of 0 any.
    Uniform(usize),
    /// A block of so many bytes whose place in its buffer is said with every draw.
    DynamicUniform(usize),
    /// Elements of so many bytes that the shader writes.
    Storage(u64),
    /// Elements of so many bytes.
    StorageRead(u64),
    /// A texture of floats, read texel by texel.
    Texels,
    /// A texture with several samples a pixel.
    Samples,
    /// A texture of whole numbers.
    Words,
    /// A texture that is looked up between its texels.
    Filtered,
    /// Layers of them.
    FilteredArray,
    /// The six faces of a cube, looked up by direction.
    FilteredCube,
    /// A texture in three dimensions that is looked up between its texels.
    FilteredVolume,
    /// How textures are looked up.
    Sampler,
}

impl Slot {
    /// A texture that is read texel by texel, or sample by sample.
    pub fn texels(multisampled: bool) -> Self {
        if multisampled { Self::Samples } else { Self::Texels }
    }

    fn kind(self) -> wgpu::BindingType {
        use wgpu::{BufferBindingType as B, TextureSampleType as T, TextureViewDimension as D};
        let buffer = |ty, has_dynamic_offset, bytes| wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset,
            min_binding_size: wgpu::BufferSize::new(bytes),
        };
        let texture = |sample_type, view_dimension, multisampled| wgpu::BindingType::Texture {
            sample_type,
            view_dimension,
            multisampled,
        };
        let float = |filterable| T::Float { filterable };
        match self {
            Self::Uniform(bytes) => buffer(B::Uniform, false, bytes as u64),
            Self::DynamicUniform(bytes) => buffer(B::Uniform, true, bytes as u64),
            Self::Storage(bytes) => buffer(B::Storage { read_only: false }, false, bytes),
            Self::StorageRead(bytes) => buffer(B::Storage { read_only: true }, false, bytes),
            Self::Texels => texture(float(false), D::D2, false),
            Self::Samples => texture(float(false), D::D2, true),
            Self::Words => texture(T::Uint, D::D2, false),
            Self::Filtered => texture(float(true), D::D2, false),
            Self::FilteredArray => texture(float(true), D::D2Array, false),
            Self::FilteredCube => texture(float(true), D::Cube, false),
            Self::FilteredVolume => texture(float(true), D::D3, false),
            Self::Sampler => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        }
    }
}

/// A layout of slots at their bindings, seen by `stages`.
pub(crate) fn layout(
    device: &wgpu::Device,
    label: &str,
    stages: wgpu::ShaderStages,
    slots: &[(u32, Slot)],
) -> wgpu::BindGroupLayout {
    let entry = |(binding, slot): &(u32, Slot)| wgpu::BindGroupLayoutEntry {
        binding: *binding,
        visibility: stages,
        ty: slot.kind(),
        count: None,
    };
    let entries: Vec<_> = slots.iter().map(entry).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}

/// A buffer for a uniform block of so many bytes that is written anew when it changes.
pub(crate) fn block(device: &wgpu::Device, label: &str, bytes: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// A texture of one texel that stands for one that the host does not give: bound, not read.
pub(crate) fn nothing(device: &wgpu::Device, format: wgpu::TextureFormat) -> wgpu::TextureView {
    let texture = super::flat_texture(device, "nothing", (1, 1), format, wgpu::TextureUsages::TEXTURE_BINDING);
    texture.create_view(&Default::default())
}

/// Creates the placeholder for a texture of layers that is not there.
pub(crate) fn no_layers(device: &wgpu::Device) -> wgpu::TextureView {
    as_layers(&device.create_texture(&wgpu::TextureDescriptor {
        label: Some("no layers"),
        size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 2 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    }))
}

/// All layers of a texture. With wgpu's OpenGL backend shaders find nothing in a view of one layer of several; and a
/// texture of one layer is no array there, one of a multiple of six is of cubes.
pub(crate) fn as_layers(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

/// A buffer at a binding.
pub(crate) fn buffer(binding: u32, buffer: &wgpu::Buffer) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() }
}

/// A part of a buffer at a binding, from a multiple of 256 on.
pub(crate) fn part(binding: u32, buffer: &wgpu::Buffer, part: Range<usize>) -> wgpu::BindGroupEntry<'_> {
    let (offset, size) = (part.start as u64, wgpu::BufferSize::new(part.len() as u64));
    wgpu::BindGroupEntry {
        binding,
        resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset, size }),
    }
}

/// A texture at a binding.
pub(crate) fn view(binding: u32, view: &wgpu::TextureView) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) }
}

/// A sampler at a binding.
pub(crate) fn sampler(binding: u32, sampler: &wgpu::Sampler) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::Sampler(sampler) }
}
