//! A small host: targets, a camera on a plain, and pictures to look at.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
    scene::Camera,
    sky::SkySettings,
};

/// A device, a context and one view, with targets of `size`.
pub struct Host {
    pub device: Arc<Device>,
    pub context: Context,
    pub view: View,
    pub color: wgpu::Texture,
    pub depth: wgpu::Texture,
}

pub const SIZE: (u32, u32) = (160, 90);

pub fn texture(device: &Device, format: wgpu::TextureFormat, samples: u32) -> wgpu::Texture {
    use wgpu::TextureUsages as U;
    let mut usage = U::RENDER_ATTACHMENT | U::TEXTURE_BINDING | U::COPY_SRC;
    if samples == 1 {
        usage |= U::COPY_DST;
    }
    device.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE.0, height: SIZE.1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

pub fn camera() -> Camera {
    Camera::look_to(DVec3::new(0.0, 0.0, 2500.0), DVec3::Y, DVec3::Z, 1.0, 160.0 / 90.0, 0.1)
}

/// A coarse sky, built in an instant: these tests ask how frames are composed, not how right the sky is.
pub fn coarse() -> ContextDesc {
    let sky = SkySettings {
        orders: 4,
        suns: 32,
        altitudes: 14,
        zeniths: 11,
        azimuths: 7,
        rule_zeniths: 6,
        rule_azimuths: 8,
        build_panels: 2,
        ..SkySettings::default()
    };
    ContextDesc { sky, ..ContextDesc::default() }
}

impl Host {
    pub fn new(format: wgpu::TextureFormat) -> Self {
        Self::on(Device::headless(&DeviceOptions::default()).expect("a software driver is installed"), format)
    }

    pub fn on(device: Arc<Device>, format: wgpu::TextureFormat) -> Self {
        let shared = Arc::new(Shared::new(&device).unwrap());
        let mut context = Context::new(device.clone(), shared, coarse()).unwrap();
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

    pub fn pixels(&self) -> Vec<[f32; 4]> {
        readback::rgba(&self.device, &self.color).unwrap()
    }
}
