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
    /// Colour and depth of the host's own world, if it has one.
    world: Option<[wgpu::Texture; 2]>,
}

impl HostImages {
    pub fn new(device: &Device, size: (u32, u32)) -> Self {
        let color = texture(device, size, wgpu::TextureFormat::Rgba16Float, 1);
        Self { color, depth: texture(device, size, wgpu::TextureFormat::Depth32Float, 1), world: None }
    }

    /// Returns images of a host whose own world is what these show now.
    pub fn kept(&self, device: &Device) -> Result<Self, Box<dyn std::error::Error>> {
        let (from, size) = ([&self.color, &self.depth], (self.color.width(), self.color.height()));
        let to = from.map(|image| texture(device, size, image.format(), 1));
        copy(device, from, [&to[0], &to[1]])?;
        Ok(Self { world: Some(to), ..Self::new(device, size) })
    }

    /// Brings colour and depth to what they are before Welkin draws: clear, or the host's own world.
    fn begin(&self, device: &Device) -> Result<(), Box<dyn std::error::Error>> {
        match &self.world {
            Some([color, depth]) => copy(device, [color, depth], [&self.color, &self.depth]),
            None => self.clear(device),
        }
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

    /// Draws a frame over the host's own world. Returns its processor time, ns.
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
        self.begin(device)?;
        let mut frame = Frame::new(frame_id, *camera, &self.color, Some(&self.depth));
        (frame.depth_access, frame.flags) = (DepthAccess::ReadWrite, FrameFlags::NO_HISTORY);
        let before = processor_ns();
        view.record(context, &frame, Stages::ALL.without(Stages::TONE))?;
        device.wait()?;
        Ok((processor_ns() - before) as f64)
    }
}

fn copy(device: &Device, from: [&wgpu::Texture; 2], to: [&wgpu::Texture; 2]) -> Result<(), Box<dyn std::error::Error>> {
    let mut encoder = device.device.create_command_encoder(&Default::default());
    for (from, to) in from.into_iter().zip(to) {
        encoder.copy_texture_to_texture(from.as_image_copy(), to.as_image_copy(), from.size());
    }
    device.submit_and_wait(encoder)?;
    Ok(())
}
