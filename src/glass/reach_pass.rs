//! Pass that tests the host's occluder maps on the GPU: the share of the rain that they let through to each part of the
//! pane.

use super::{
    cell_passes::{WORD, bind, buffer, cells_pipeline, settle_pipelines},
    reach::{NODES, SIZES},
};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::Slot,
        pass::{self, FullscreenDesc},
    },
    surroundings::{HostSurroundings, SurroundingsBlock, layout as around_layout},
};

/// Uniform block `PaneUniform` of `shaders/glass/maps.wgsl`, which describes the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct PaneUniform {
    pub origin: [f32; 4],
    pub along: [f32; 4],
    pub up: [f32; 4],
    pub drops: [[f32; 4]; SIZES],
}

/// Additional pipelines for glass below maps.
pub(super) struct MappedKit {
    layouts: [wgpu::BindGroupLayout; 2],
    reach: wgpu::RenderPipeline,
    pub gather: wgpu::RenderPipeline,
    pub declare: wgpu::RenderPipeline,
    pub settle: [wgpu::RenderPipeline; 2],
}

/// Bindings of a view's occluder maps for its glass.
pub(super) struct MapReach {
    surroundings: SurroundingsBlock,
    uniform: wgpu::Buffer,
    groups: [wgpu::BindGroup; 2],
}

/// Maps of a frame, and the pane below them.
pub(crate) struct Mapped<'a> {
    /// Occluder maps of the host, without boxes and lamps.
    pub around: HostSurroundings<'a>,
    pub pane: PaneUniform,
}

impl MappedKit {
    /// # Errors
    /// A missing shader file.
    pub fn new(device: &Device, step_layout: &wgpu::BindGroupLayout) -> Result<Self> {
        let layout = |slots: &[(u32, Slot)]| {
            crate::gpu::bind::layout(&device.device, "glass below maps", wgpu::ShaderStages::FRAGMENT, slots)
        };
        let layouts = [layout(&[(0, Slot::Uniform(size_of::<PaneUniform>()))]), layout(&[])];
        let reach = pass::fullscreen(
            device,
            &FullscreenDesc {
                shader: "glass/maps.wgsl",
                entry: "reach_by_maps",
                layouts: &[&layouts[0], &layouts[1], &around_layout(&device.device)],
                targets: &[WORD.into()],
                constants: &[("MAPS", 1.0)],
                samples: 1,
            },
        )?;
        let cells = |shader, entry| cells_pipeline(device, (shader, entry), step_layout, &[("MAPPED", 1.0)]);
        Ok(Self {
            layouts,
            reach,
            gather: cells("glass/gather.wgsl", "gather")?,
            declare: cells("glass/declare.wgsl", "declare")?,
            settle: settle_pipelines(device, step_layout, &[("MAPPED", 1.0)])?,
        })
    }
}

impl MapReach {
    pub fn new(device: &Device, kit: &MappedKit) -> Self {
        let uniform = buffer(device, "glass below maps", size_of::<PaneUniform>() as u64);
        let groups =
            [bind(device, &kit.layouts[0], &[uniform.as_entire_binding()]), bind(device, &kit.layouts[1], &[])];
        Self { surroundings: SurroundingsBlock::new(&device.device), uniform, groups }
    }

    /// Draws the shares into `target`, which has [`NODES`] texels.
    pub fn draw(
        &mut self,
        device: &Device,
        kit: &MappedKit,
        encoder: &mut wgpu::CommandEncoder,
        mapped: &Mapped<'_>,
        target: &wgpu::TextureView,
    ) {
        self.surroundings.update(device, &mapped.around);
        device.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&mapped.pane));
        let groups = [&self.groups[0], &self.groups[1], self.surroundings.bind_group()];
        pass::draw(encoder, "glass below maps", &kit.reach, &groups, target);
    }
}

/// Size of the target of [`MapReach::draw`], texels.
pub(super) const SIZE: [u32; 2] = [NODES[0] as u32, NODES[1] as u32];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{glass::reach::ALL, gpu::shader};

    #[test]
    fn offsets_and_numbers_are_those_of_the_shaders() {
        shader::assert_layout!("glass/maps.wgsl", "PaneUniform", PaneUniform, [origin, along, up, drops]);
        let text = shader::assemble("glass/maps.wgsl").unwrap();
        for constant in [format!("SIZES: u32 = {SIZES}u"), format!("ALL_OF_IT: f32 = {ALL}.0")] {
            assert!(text.contains(&constant), "{constant}");
        }
        let [across, up] = NODES;
        assert!(text.contains(&format!("vec2f({}.0, {}.0)", across - 1, up - 1)));
        let cells = shader::assemble("glass/cells.wgsl").unwrap();
        assert!(cells.contains(&format!("vec2u({across}u, {up}u)")));
    }
}
