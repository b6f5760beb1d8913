//! Probe of the sea's shaders at single places, for tests.

use glam::DVec2;

use super::{passes::SeaPasses, view::SeaView};
use crate::gpu::{
    Device,
    bind::{self, Slot},
    flat_texture,
    pass::{self, FullscreenDesc},
    readback,
};

/// Widest picture of a probe.
const WIDTH: usize = 128;

impl SeaPasses {
    /// Returns what an entry of `shaders/sea/probe.wgsl` finds at places, m from the anchor.
    fn probe(&self, device: &Device, entry: &str, places: &[[f32; 2]]) -> Vec<[f32; 4]> {
        let made = &device.device;
        let slots = [(2, Slot::Texels)];
        let own = bind::layout(made, "probed places", wgpu::ShaderStages::FRAGMENT, &slots);
        let empty = bind::layout(made, "nothing", wgpu::ShaderStages::FRAGMENT, &[]);
        let size = (WIDTH as u32, places.len().div_ceil(WIDTH) as u32);
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let from = flat_texture(made, "probed places", size, wgpu::TextureFormat::Rgba32Float, usage);
        let mut texels = vec![[0.0f32; 4]; WIDTH * size.1 as usize];
        texels.iter_mut().zip(places).for_each(|(texel, place)| *texel = [place[0], place[1], 0.0, 0.0]);
        let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * size.0), rows_per_image: None };
        device.write_texture(from.as_image_copy(), bytemuck::cast_slice(&texels), rows, from.size());
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let to = flat_texture(made, "probe", size, wgpu::TextureFormat::Rgba32Float, usage);
        let pipeline = pass::fullscreen(
            device,
            &FullscreenDesc {
                shader: "sea/probe.wgsl",
                entry,
                layouts: &[&own, &empty, &self.layout, &self.bands.layout],
                targets: &[to.format().into()],
                constants: &[],
                samples: 1,
            },
        )
        .expect("a pipeline");
        let view = from.create_view(&Default::default());
        let group = made.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &own,
            entries: &[bind::view(2, &view)],
        });
        let nothing = made.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &empty, entries: &[] });
        let mut encoder = made.create_command_encoder(&Default::default());
        let target = to.create_view(&Default::default());
        let whole = self.bands.groups.last().expect("the group of all waves");
        pass::draw(&mut encoder, "probe", &pipeline, &[&group, &nothing, &self.group, whole], &target);
        device.submit_and_wait(encoder).expect("a draw");
        let mut found = readback::rgba(device, &to).expect("a readback");
        found.truncate(places.len());
        found
    }
}

impl SeaView {
    /// Returns what an entry of the probe finds in the last frame that was drawn, at places, m from that frame's
    /// anchor.
    pub(crate) fn probe(&self, device: &Device, entry: &str, places: &[[f32; 2]]) -> Vec<[f32; 4]> {
        self.passes.as_ref().expect("a frame with a sea").probe(device, entry, places)
    }

    /// Returns the camera's place from the anchor, m.
    pub(crate) fn eye_place(&self) -> DVec2 {
        DVec2::from(self.block.eye.map(f64::from))
    }

    /// Returns the number of blocks of the mesh that the last frame showed.
    pub(crate) fn block_count(&self) -> usize {
        self.blocks.len()
    }
}
