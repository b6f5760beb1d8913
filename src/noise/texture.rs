//! Noise texture drawn on the GPU, slice by slice, by fragment passes that also run on tier 0.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable, bytes_of};

use super::image::{NoiseImage, empty};
use super::reference::{keys_of, rests};
use super::settings::{NoiseKind, NoiseSettings, axes, levels_of, size_of_level};
use crate::error::{Error, Result, Status};
use crate::gpu::bind::{self, Slot};
use crate::gpu::pass::{FullscreenDesc, fullscreen};
use crate::gpu::{Device, readback};

/// Distance from one block to the next in a buffer, bytes; a multiple of every device's alignment.
const STEP: usize = 256;

/// `Slice` of `shaders/noise/slice.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct SliceUniform {
    frequency: [u32; 3],
    z: u32,
    size_log2: [u32; 3],
    pad0: u32,
    gradient_key: u32,
    cellular_key: u32,
    amplitude: f32,
    persistence: f32,
    gradient_rest: f32,
    cellular_rest: f32,
    pad1: [u32; 2],
}

impl SliceUniform {
    fn new(settings: &NoiseSettings, size: [u32; 3], z: u32) -> Self {
        let [gradient_key, cellular_key] = keys_of(settings.seed);
        let [gradient_rest, cellular_rest] = rests(settings, size).map(|rest| rest as f32);
        Self {
            frequency: settings.frequency,
            z,
            size_log2: size.map(u32::ilog2),
            pad0: 0,
            gradient_key,
            cellular_key,
            amplitude: settings.amplitude as f32,
            persistence: settings.persistence as f32,
            gradient_rest,
            cellular_rest,
            pad1: [0; 2],
        }
    }
}

/// `Shrink` of `shaders/noise/shrink.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct ShrinkUniform {
    above: [u32; 3],
    z: u32,
}

/// Noise texture on the GPU with all mip levels and one, two or four channels of 8 bits: R8, RG8 or RGBA8. It can be
/// filtered, and repeats without a seam under `AddressMode::Repeat`.
///
/// Use it from one thread at a time.
pub struct NoiseTexture {
    texture: wgpu::Texture,
    /// Passes that are still to be drawn.
    build: Option<Box<NoiseBuild>>,
}

impl NoiseTexture {
    /// Creates a texture of `size` texels with the noise of one, two or four settings in its channels. Width, height
    /// and depth are powers of two, 8 to 8192 in two dimensions and 8 to 1024 in three, with at most 2^27 texels; a
    /// depth of 1 makes a two-dimensional texture. Nothing is drawn yet: see [`NoiseTexture::step`].
    ///
    /// # Errors
    /// The errors of [`NoiseSettings::check`]; [`crate::Status::InvalidArgument`] for another number of channels;
    /// [`crate::Status::Unsupported`] if the device has no textures of this size; GPU faults.
    pub fn new(device: &Arc<Device>, size: [u32; 3], channels: &[NoiseSettings]) -> Result<Self> {
        let format = match channels.len() {
            1 => wgpu::TextureFormat::R8Unorm,
            2 => wgpu::TextureFormat::Rg8Unorm,
            4 => wgpu::TextureFormat::Rgba8Unorm,
            other => return Err(Error::range("channels", "1, 2 or 4 settings", other)),
        };
        for (i, channel) in channels.iter().enumerate() {
            channel
                .check(size)
                .map_err(|e| e.within(&format!("channels[{i}]")).renamed(&format!("channels[{i}].size"), "size"))?;
        }
        let _entered = device.enter()?;
        let texture = texture(device, size, format, levels_of(size))?;
        let build = NoiseBuild::new(device, &texture, size, channels)?;
        device.check_made()?;
        Ok(Self { texture, build: Some(Box::new(build)) })
    }

    /// Creates the texture as [`NoiseTexture::new`] does, draws it and submits the work, without waiting for it.
    ///
    /// # Errors
    /// The errors of [`NoiseTexture::new`].
    pub fn generate(device: &Arc<Device>, size: [u32; 3], channels: &[NoiseSettings]) -> Result<Self> {
        let mut made = Self::new(device, size, channels)?;
        let _entered = device.enter()?;
        let mut encoder = device.device.create_command_encoder(&Default::default());
        while !made.step(&mut encoder, u32::MAX) {}
        device.submit(encoder);
        device.check_made()?;
        Ok(made)
    }

    /// Creates a texture of one channel with an image's bytes and mip levels, for instance from a file.
    ///
    /// # Errors
    /// [`crate::Status::Unsupported`] if the device has no textures of this size; GPU faults.
    pub fn from_image(device: &Arc<Device>, image: &NoiseImage) -> Result<Self> {
        let _entered = device.enter()?;
        let levels = image.levels().len() as u32;
        let texture = texture(device, image.size(), wgpu::TextureFormat::R8Unorm, levels)?;
        for (level, bytes) in (0..).zip(image.levels()) {
            let size = image.size_of_level(level);
            device.write_texture(
                wgpu::TexelCopyTextureInfo { mip_level: level, ..texture.as_image_copy() },
                bytes,
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(size[0]), rows_per_image: Some(size[1]) },
                extent(size),
            );
        }
        device.check_made()?;
        Ok(Self { texture, build: None })
    }

    /// Records the next passes: rows of slices with about `texels` texels in all channels together, but at least one
    /// row. This lets a frame draw as much as it has time for. Mip levels follow the slices from which they are made.
    /// Returns true when all passes have been recorded. The passes of one call may share a submission with other work;
    /// the calls must be submitted in their order.
    pub fn step(&mut self, encoder: &mut wgpu::CommandEncoder, texels: u32) -> bool {
        if let Some(build) = &mut self.build
            && build.step(encoder, texels)
        {
            self.build = None;
        }
        self.is_drawn()
    }

    /// Whether all passes have been recorded.
    pub fn is_drawn(&self) -> bool {
        self.build.is_none()
    }

    /// Returns the texture; its format says how many channels it has.
    pub fn texture(&self) -> &wgpu::Texture {
        &self.texture
    }

    /// Returns a view of the whole texture, in two or three dimensions.
    pub fn view(&self) -> wgpu::TextureView {
        self.texture.create_view(&Default::default())
    }

    /// Reads one channel back with its mip levels. All passes of [`NoiseTexture::step`] must have been submitted. Waits
    /// for the GPU, so do not call it in a frame.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a channel that the texture does not have; [`crate::Status::WrongOrder`]
    /// before all passes are recorded; [`crate::Status::DeviceLost`], [`crate::Status::OutOfMemory`] or a GPU fault.
    pub fn read(&self, device: &Device, channel: usize) -> Result<NoiseImage> {
        let channels = self.texture.format().components() as usize;
        if channel >= channels {
            return Err(Error::range("channel", &format!("below {channels}"), channel));
        }
        if !self.is_drawn() {
            return Err(Error::new(Status::WrongOrder, "the noise is not drawn yet: call step until it is"));
        }
        let _entered = device.enter()?;
        let extent = self.texture.size();
        let size = [extent.width, extent.height, extent.depth_or_array_layers];
        let mut levels = Vec::new();
        for level in 0..self.texture.mip_level_count() {
            let all = readback::level(device, &self.texture, level)?;
            let mut bytes = empty((all.len() / channels) as u64)?;
            bytes.extend(all.iter().skip(channel).step_by(channels));
            levels.push(bytes);
        }
        Ok(NoiseImage::of_levels(size, levels))
    }
}

fn extent(size: [u32; 3]) -> wgpu::Extent3d {
    wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: size[2] }
}

/// Creates an empty texture.
fn texture(device: &Device, size: [u32; 3], format: wgpu::TextureFormat, levels: u32) -> Result<wgpu::Texture> {
    use wgpu::TextureUsages as U;
    let limits = device.device.limits();
    let is_plane = axes(size) == 2;
    let longest = if is_plane { limits.max_texture_dimension_2d } else { limits.max_texture_dimension_3d };
    if size.iter().any(|texels| *texels > longest) {
        let sentence = format!("noise of {size:?} texels: this device has textures of {longest} at most");
        return Err(Error::unsupported(sentence));
    }
    Ok(device.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("noise"),
        size: extent(size),
        mip_level_count: levels,
        sample_count: 1,
        dimension: if is_plane { wgpu::TextureDimension::D2 } else { wgpu::TextureDimension::D3 },
        format,
        usage: U::TEXTURE_BINDING | U::RENDER_ATTACHMENT | U::COPY_SRC | U::COPY_DST,
        view_formats: &[],
    }))
}

/// Passes of a texture that are still to be drawn.
struct NoiseBuild {
    size: [u32; 3],
    /// Views, one for each mip level.
    levels: Vec<wgpu::TextureView>,
    /// Pipelines that draw the noise, one for each channel.
    noise: Vec<wgpu::RenderPipeline>,
    noise_group: wgpu::BindGroup,
    /// Pipeline that draws a mip level from the next finer one.
    shrink: wgpu::RenderPipeline,
    /// Bind groups in which each level is read to draw the next coarser one.
    shrink_groups: Vec<wgpu::BindGroup>,
    /// Mip level of the next pass.
    level: u32,
    /// Slice of the next pass.
    slice: u32,
    /// First row of the next pass.
    row: u32,
    /// Index of `slice` among the slices of all mip levels but the first.
    shrunk: u32,
}

impl NoiseBuild {
    fn new(device: &Device, texture: &wgpu::Texture, size: [u32; 3], channels: &[NoiseSettings]) -> Result<Self> {
        let format = texture.format();
        let is_plane = axes(size) == 2;
        let layout =
            |label, slots: &[(u32, Slot)]| bind::layout(&device.device, label, wgpu::ShaderStages::FRAGMENT, slots);
        let noise_layout = layout("noise", &[(0, Slot::DynamicUniform(size_of::<SliceUniform>()))]);
        let pipeline_of = |(channel, settings): (usize, &NoiseSettings)| {
            let octaves = [("OCTAVES", f64::from(settings.octaves_in(size)))];
            let (shader, entry) = ("noise/slice.wgsl", entry(settings.kind, is_plane));
            let writes = wgpu::ColorWrites::from_bits_truncate(1 << channel);
            pipeline(device, shader, entry, &octaves, &noise_layout, format, writes)
        };
        let noise = channels.iter().enumerate().map(pipeline_of).collect::<Result<_>>()?;
        let slices = (0..size[2]).flat_map(|z| channels.iter().map(move |s| SliceUniform::new(s, size, z)));
        let noise_group = group(device, &noise_layout, &blocks(device, slices), size_of::<SliceUniform>(), None);

        let level_view = |level| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                base_mip_level: level,
                mip_level_count: Some(1),
                ..Default::default()
            })
        };
        let levels: Vec<_> = (0..texture.mip_level_count()).map(level_view).collect();
        let (at, slot, entry) =
            if is_plane { (1, Slot::Filtered, "shrink_plane") } else { (2, Slot::FilteredVolume, "shrink_volume") };
        let block = (0, Slot::DynamicUniform(size_of::<ShrinkUniform>()));
        let shrink_layout = layout("noise mip level", &[block, (at, slot)]);
        let shader = "noise/shrink.wgsl";
        let shrink = pipeline(device, shader, entry, &[], &shrink_layout, format, wgpu::ColorWrites::ALL)?;
        let shrinks = (1..texture.mip_level_count()).flat_map(|level| {
            let above = size_of_level(size, level - 1);
            (0..size_of_level(size, level)[2]).map(move |z| ShrinkUniform { above, z })
        });
        let buffer = blocks(device, shrinks);
        let group_of = |view| group(device, &shrink_layout, &buffer, size_of::<ShrinkUniform>(), Some((at, view)));
        let shrink_groups = levels[..levels.len() - 1].iter().map(group_of).collect();
        Ok(Self { size, levels, noise, noise_group, shrink, shrink_groups, level: 0, slice: 0, row: 0, shrunk: 0 })
    }

    /// Records passes with about `texels` texels; returns true after the last one.
    fn step(&mut self, encoder: &mut wgpu::CommandEncoder, texels: u32) -> bool {
        let mut left = u64::from(texels.max(1));
        while left > 0 && !self.is_done() {
            let size = size_of_level(self.size, self.level);
            let in_row = u64::from(size[0]) * if self.level == 0 { self.noise.len() as u64 } else { 1 };
            let rows = (left / in_row).clamp(1, u64::from(size[1] - self.row)) as u32;
            self.draw(encoder, size[0], rows);
            left = left.saturating_sub(in_row * u64::from(rows));
            self.advance(size, rows);
        }
        self.is_done()
    }

    fn is_done(&self) -> bool {
        self.level as usize == self.levels.len()
    }

    fn advance(&mut self, size: [u32; 3], rows: u32) {
        self.row += rows;
        if self.row < size[1] {
            return;
        }
        (self.row, self.slice) = (0, self.slice + 1);
        self.shrunk += u32::from(self.level > 0);
        if self.slice == size[2] {
            (self.slice, self.level) = (0, self.level + 1);
        }
    }

    /// Draws rows of the next slice.
    fn draw(&self, encoder: &mut wgpu::CommandEncoder, width: u32, rows: u32) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("noise"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.levels[self.level as usize],
                depth_slice: (axes(self.size) == 3).then_some(self.slice),
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_scissor_rect(0, self.row, width, rows);
        if self.level > 0 {
            pass.set_pipeline(&self.shrink);
            pass.set_bind_group(0, &self.shrink_groups[self.level as usize - 1], &[self.shrunk * STEP as u32]);
            pass.draw(0..3, 0..1);
            return;
        }
        let first = self.slice * self.noise.len() as u32;
        for (block, pipeline) in (first..).zip(&self.noise) {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &self.noise_group, &[block * STEP as u32]);
            pass.draw(0..3, 0..1);
        }
    }
}

/// Returns the entry point in `shaders/noise/slice.wgsl`.
fn entry(kind: NoiseKind, is_plane: bool) -> &'static str {
    match (kind, is_plane) {
        (NoiseKind::Gradient, true) => "gradient_plane",
        (NoiseKind::Gradient, false) => "gradient_volume",
        (NoiseKind::Cellular, true) => "cellular_plane",
        (NoiseKind::Cellular, false) => "cellular_volume",
        (NoiseKind::GradientOverCellular, true) => "both_plane",
        (NoiseKind::GradientOverCellular, false) => "both_volume",
    }
}

fn pipeline(
    device: &Device,
    shader: &str,
    entry: &str,
    constants: &[(&str, f64)],
    layout: &wgpu::BindGroupLayout,
    format: wgpu::TextureFormat,
    write_mask: wgpu::ColorWrites,
) -> Result<wgpu::RenderPipeline> {
    let target = wgpu::ColorTargetState { format, blend: None, write_mask };
    fullscreen(device, &FullscreenDesc { shader, entry, layouts: &[layout], targets: &[target], constants, samples: 1 })
}

/// Creates a buffer with all blocks, [`STEP`] bytes apart.
fn blocks<B: Pod>(device: &Device, all: impl Iterator<Item = B>) -> wgpu::Buffer {
    let mut bytes = Vec::new();
    for block in all {
        bytes.extend_from_slice(bytes_of(&block));
        bytes.resize(bytes.len().next_multiple_of(STEP), 0);
    }
    let buffer = bind::block(&device.device, "noise", bytes.len());
    device.write_buffer(&buffer, 0, &bytes);
    buffer
}

/// Creates a bind group of one block of a buffer and, if given, a texture.
fn group(
    device: &Device,
    layout: &wgpu::BindGroupLayout,
    buffer: &wgpu::Buffer,
    block: usize,
    texture: Option<(u32, &wgpu::TextureView)>,
) -> wgpu::BindGroup {
    let size = wgpu::BufferSize::new(block as u64);
    let block = wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size });
    let mut entries = vec![wgpu::BindGroupEntry { binding: 0, resource: block }];
    entries.extend(
        texture.map(|(binding, view)| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::TextureView(view),
        }),
    );
    device.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("noise"), layout, entries: &entries })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader::assert_layout;

    #[test]
    fn blocks_lie_as_their_shaders_read_them() {
        assert_layout!(
            "noise/slice.wgsl",
            "Slice",
            SliceUniform,
            [frequency, z, size_log2, gradient_key, cellular_key, amplitude, persistence, gradient_rest, cellular_rest]
        );
        assert_layout!("noise/shrink.wgsl", "Shrink", ShrinkUniform, [above, z]);
    }
}
