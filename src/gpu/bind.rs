//! Bind group layouts, described slot by slot, and their entries.

use std::ops::Range;

/// Kind of resource at a shader binding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Slot {
    /// A uniform block of this many bytes; 0 allows any size.
    Uniform(usize),
    /// A uniform block of this many bytes, with its offset in the buffer given at every draw.
    DynamicUniform(usize),
    /// A storage buffer that the shader writes, with elements of this many bytes.
    Storage(u64),
    /// A storage buffer that the shader reads, with elements of this many bytes.
    StorageRead(u64),
    /// A float texture, read texel by texel.
    Texels,
    /// An array of float textures, read texel by texel.
    TexelsArray,
    /// An array of depth textures, compared with a depth.
    ComparedArray,
    /// A multisampled texture.
    Samples,
    /// A texture of unsigned integers.
    Words,
    /// A float texture with linear filtering.
    Filtered,
    /// An array of float textures with linear filtering.
    FilteredArray,
    /// A cube map with linear filtering.
    FilteredCube,
    /// A three-dimensional float texture with linear filtering.
    FilteredVolume,
    /// A filtering sampler.
    Sampler,
    /// A sampler that compares.
    Comparison,
}

impl Slot {
    /// Returns the slot of a texture that is read texel by texel or, if `multisampled`, sample by sample.
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
            Self::TexelsArray => texture(float(false), D::D2Array, false),
            Self::ComparedArray => texture(T::Depth, D::D2Array, false),
            Self::Samples => texture(float(false), D::D2, true),
            Self::Words => texture(T::Uint, D::D2, false),
            Self::Filtered => texture(float(true), D::D2, false),
            Self::FilteredArray => texture(float(true), D::D2Array, false),
            Self::FilteredCube => texture(float(true), D::Cube, false),
            Self::FilteredVolume => texture(float(true), D::D3, false),
            Self::Sampler => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            Self::Comparison => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison),
        }
    }
}

/// Creates a bind group layout of `slots` at their binding numbers, visible to `stages`.
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

/// Creates a buffer for a uniform block of this many bytes, which is rewritten when its contents change.
pub(crate) fn block(device: &wgpu::Device, label: &str, bytes: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Creates the placeholder for a texture that the host does not give: one texel, bound but not read.
pub(crate) fn nothing(device: &wgpu::Device, format: wgpu::TextureFormat) -> wgpu::TextureView {
    let texture = super::flat_texture(device, "nothing", (1, 1), format, wgpu::TextureUsages::TEXTURE_BINDING);
    texture.create_view(&Default::default())
}

/// Creates the placeholder for an array texture that does not exist.
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

/// Creates a view of all layers of a texture, as an array. wgpu's OpenGL backend needs care: a view of a single layer
/// of an array reads as empty, a texture with one layer is no array, and a texture whose number of layers is a multiple
/// of six becomes an array of cube maps.
pub(crate) fn as_layers(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

/// Entry that binds a whole buffer.
pub(crate) fn buffer(binding: u32, buffer: &wgpu::Buffer) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() }
}

/// Entry that binds a range of a buffer. The range begins at a multiple of 256 bytes.
pub(crate) fn part(binding: u32, buffer: &wgpu::Buffer, part: Range<usize>) -> wgpu::BindGroupEntry<'_> {
    let (offset, size) = (part.start as u64, wgpu::BufferSize::new(part.len() as u64));
    wgpu::BindGroupEntry {
        binding,
        resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset, size }),
    }
}

/// Entry that binds a texture.
pub(crate) fn view(binding: u32, view: &wgpu::TextureView) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) }
}

/// Entry that binds a sampler.
pub(crate) fn sampler(binding: u32, sampler: &wgpu::Sampler) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::Sampler(sampler) }
}
