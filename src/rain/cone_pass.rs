//! The cones on the GPU: their texture, their block, one full-screen draw.

use std::sync::Arc;

use super::cones::{ConeUniform, SIDE, texture};
use crate::{
    error::Result,
    gpu::{
        Device,
        pass::{FullscreenDesc, fullscreen},
    },
};

/// What a view holds for rain on cones, made when it first draws them.
pub(super) struct ConePass {
    block: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    bytes: u64,
    pipelines: [Option<wgpu::RenderPipeline>; 8],
}

impl ConePass {
    pub fn new(device: &Device) -> Self {
        let block = device.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("cones"),
            size: size_of::<ConeUniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let layout = layout(&device.device);
        let (streaks, bytes) = upload(device);
        let sampler = device.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("streaks"),
            address_mode_u: wgpu::AddressMode::Repeat,
            address_mode_v: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            // Levels hardly change over a picture; looking at two of them would cost half as much again.
            mipmap_filter: wgpu::MipmapFilterMode::Nearest,
            ..Default::default()
        });
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("cones"),
            layout: &layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: block.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&streaks) },
                wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(&sampler) },
            ],
        });
        Self { block, layout, group, bytes, pipelines: [const { None }; 8] }
    }

    /// Bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Brings the block up and makes the pipeline for a kind of depth, with or without occluder maps, if it is not there.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn prepare(
        &mut self,
        device: &Arc<Device>,
        block: &ConeUniform,
        [frame, around]: [&wgpu::BindGroupLayout; 2],
        (multi, has_depth, maps): (bool, bool, bool),
    ) -> Result<()> {
        device.queue.write_buffer(&self.block, 0, bytemuck::bytes_of(block));
        let slot = &mut self.pipelines[key((multi, has_depth, maps))];
        if slot.is_none() {
            *slot = Some(fullscreen(
                device,
                &FullscreenDesc {
                    shader: if multi { "rain/cones_multi.wgsl" } else { "rain/cones_single.wgsl" },
                    entry: "cones_fragment",
                    layouts: &[frame, &self.layout, around],
                    targets: &[wgpu::ColorTargetState {
                        format: super::passes::FORMAT,
                        // Columns of rain areas may lie in the layer.
                        blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                        write_mask: wgpu::ColorWrites::ALL,
                    }],
                    constants: &[("HAS_DEPTH", f64::from(u8::from(has_depth))), ("MAPS", f64::from(u8::from(maps)))],
                    samples: 1,
                },
            )?);
        }
        Ok(())
    }

    /// Draws what was prepared; the other groups are set.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, kind: (bool, bool, bool)) {
        if let Some(pipeline) = &self.pipelines[key(kind)] {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(1, &self.group, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}

/// Which pipeline draws: for depth of several samples, for depth at all, for occluder maps.
fn key((multi, has_depth, maps): (bool, bool, bool)) -> usize {
    usize::from(maps) * 4 + usize::from(multi) * 2 + usize::from(has_depth)
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("cones"),
        entries: &[
            entry(
                0,
                wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: wgpu::BufferSize::new(size_of::<ConeUniform>() as u64),
                },
            ),
            entry(
                1,
                wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: true },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
            ),
            entry(2, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)),
        ],
    })
}

/// The texture of streaks, and its bytes.
fn upload(device: &Device) -> (wgpu::TextureView, u64) {
    let levels = texture();
    let made = device.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("streaks"),
        size: wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 },
        mip_level_count: levels.len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let mut bytes = 0;
    for (mip_level, texels) in levels.iter().enumerate() {
        let side = SIDE >> mip_level;
        let bits: Vec<u16> = texels.iter().flatten().map(|v| v.to_bits()).collect();
        device.queue.write_texture(
            wgpu::TexelCopyTextureInfo { mip_level: mip_level as u32, ..made.as_image_copy() },
            bytemuck::cast_slice(&bits),
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(8 * side), rows_per_image: None },
            wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
        );
        bytes += 2 * bits.len() as u64;
    }
    (made.create_view(&Default::default()), bytes)
}
