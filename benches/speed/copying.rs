//! The unit of cost on a software driver: a copy, a full-screen pass of the picture's size that loads one texel per
//! pixel.

use std::time::Instant;

use welkin::gpu::{
    Device,
    pass::{FullscreenDesc, draw, fullscreen},
};
use welkin_support::{processor::processor_ns, textures::texture};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

/// Copies per submission, enough to make the submission's own cost negligible.
const COPIES: u32 = 16;

/// A pass that loads a texel and writes it.
pub struct Copying {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    target: wgpu::TextureView,
}

impl Copying {
    pub fn new(device: &Device, size: (u32, u32)) -> Fallible<Self> {
        let layout = device.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            }],
        });
        let format = wgpu::TextureFormat::Rgba16Float;
        let desc = FullscreenDesc {
            shader: "surface/copy.wgsl",
            entry: "copy_texels",
            layouts: &[&layout],
            targets: &[format.into()],
            constants: &[],
            samples: 1,
        };
        let pipeline = fullscreen(device, &desc)?;
        let [from, to] = [(); 2].map(|()| texture(device, size, format, 1).create_view(&Default::default()));
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&from) }],
        });
        Ok(Self { pipeline, group, target: to })
    }

    /// Records one copy.
    pub fn copy(&self, encoder: &mut wgpu::CommandEncoder) {
        draw(encoder, "copy", &self.pipeline, &[&self.group], &self.target);
    }

    /// Wall time and processor time of one copy, ns.
    pub fn times_ns(&self, device: &Device) -> Fallible<[f64; 2]> {
        let (wall, processor) = (Instant::now(), processor_ns());
        let mut encoder = device.device.create_command_encoder(&Default::default());
        for _ in 0..COPIES {
            self.copy(&mut encoder);
        }
        device.submit_and_wait(encoder)?;
        let each = |ns: f64| ns / f64::from(COPIES);
        Ok([each(wall.elapsed().as_nanos() as f64), each((processor_ns() - processor) as f64)])
    }

    /// Processor time of one copy, ns.
    pub fn ns(&self, device: &Device) -> Fallible<f64> {
        Ok(self.times_ns(device)?[1])
    }
}
