//! A small host: targets, a camera 2500 m above the origin, and reading of pictures.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
    scene::Camera,
};

use crate::{coarse_sky::coarse_sky, textures};

/// A device, a context and one view, with targets of [`SIZE`].
pub struct Host {
    pub device: Arc<Device>,
    pub context: Context,
    pub view: View,
    pub color: wgpu::Texture,
    pub depth: wgpu::Texture,
}

/// Width and height of the targets, pixels.
pub const SIZE: (u32, u32) = (160, 90);

pub fn texture(device: &Device, format: wgpu::TextureFormat, samples: u32) -> wgpu::Texture {
    textures::texture(device, SIZE, format, samples)
}

/// Returns a camera 2500 m above the origin that looks level to the north, with a vertical field of view of 1 rad.
pub fn camera() -> Camera {
    Camera::look_to(DVec3::new(0.0, 0.0, 2500.0), DVec3::Y, DVec3::Z, 1.0, 160.0 / 90.0, 0.1)
}

/// A coarse sky that is built quickly: these tests check how frames are composed, not how accurate the sky is.
pub fn coarse() -> ContextDesc {
    ContextDesc { sky: coarse_sky(), ..ContextDesc::default() }
}

impl Host {
    pub fn new(format: wgpu::TextureFormat) -> Self {
        Self::on(Device::headless(&DeviceOptions::default()).expect("a software driver is installed"), format)
    }

    pub fn on(device: Arc<Device>, format: wgpu::TextureFormat) -> Self {
        Self::of(device, format, coarse())
    }

    /// Creates a host of a context with this description; the sun stands in the south-east, 40 degrees high.
    pub fn of(device: Arc<Device>, format: wgpu::TextureFormat, desc: ContextDesc) -> Self {
        let shared = Arc::new(Shared::new(&device).unwrap());
        let mut context = Context::new(device.clone(), shared, desc).unwrap();
        context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg: 40.0 })).unwrap();
        let view = View::new(&context).unwrap();
        let color = texture(&device, format, 1);
        let depth = texture(&device, wgpu::TextureFormat::Depth32Float, 1);
        Self { device, context, view, color, depth }
    }

    /// Clears colour and depth as a host would: `depth` 0 is far in the reversed mapping of `Frame::new`.
    pub fn clear(&self, color: [f64; 4], depth: f32) {
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        let [r, g, b, a] = color;
        let (cv, dv) = (self.color.create_view(&Default::default()), self.depth.create_view(&Default::default()));
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &cv,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &dv,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(depth), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        self.device.submit_and_wait(encoder).unwrap();
    }

    pub fn record(&mut self, frame_id: u64, stages: Stages) -> welkin::Result<()> {
        let frame = Frame::new(frame_id, camera(), &self.color, Some(&self.depth));
        self.view.record(&self.context, &frame, stages)
    }

    /// Returns the picture, row by row from the top.
    pub fn pixels(&self) -> Vec<[f32; 4]> {
        readback::rgba(&self.device, &self.color).unwrap()
    }
}
