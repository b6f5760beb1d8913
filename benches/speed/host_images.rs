//! Images of a host whose depth Welkin may write, for effects that draw opaque things.

use welkin::{
    context::Context,
    frame::{DepthAccess, Frame, FrameFlags, Stages, View},
    gpu::Device,
    scene::Camera,
};
use welkin_support::{processor::processor_ns, textures::texture};

/// Picture and depth that all scenes draw into.
pub struct HostImages {
    color: wgpu::Texture,
    depth: wgpu::Texture,
}

impl HostImages {
    pub fn new(device: &Device, size: (u32, u32)) -> Self {
        let color = texture(device, size, wgpu::TextureFormat::Rgba16Float, 1);
        Self { color, depth: texture(device, size, wgpu::TextureFormat::Depth32Float, 1) }
    }

    /// Clears colour and depth, as a host does before its own things.
    fn clear(&self, device: &Device) -> Result<(), Box<dyn std::error::Error>> {
        let mut encoder = device.device.create_command_encoder(&Default::default());
        let [color, depth] = [&self.color, &self.depth].map(|t| t.create_view(&Default::default()));
        let store = wgpu::StoreOp::Store;
        drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &color,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store }),
                stencil_ops: None,
            }),
            ..Default::default()
        }));
        device.submit_and_wait(encoder)?;
        Ok(())
    }

    /// Draws a frame into cleared images. Returns its processor time, ns.
    ///
    /// # Errors
    /// The errors of [`View::record`].
    pub fn frame_ns(
        &self,
        device: &Device,
        (view, context): (&mut View, &Context),
        camera: &Camera,
        frame_id: u64,
    ) -> Result<f64, Box<dyn std::error::Error>> {
        self.clear(device)?;
        let mut frame = Frame::new(frame_id, *camera, &self.color, Some(&self.depth));
        (frame.depth_access, frame.flags) = (DepthAccess::ReadWrite, FrameFlags::NO_HISTORY);
        let before = processor_ns();
        view.record(context, &frame, Stages::ALL.without(Stages::TONE))?;
        device.wait()?;
        Ok((processor_ns() - before) as f64)
    }
}
