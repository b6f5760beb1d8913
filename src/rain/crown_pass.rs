//! Splashes where there are compute shaders: the place of each slot's crown is sought in the picture's depth once, not once a
//! corner. The draw then only spreads corners.

use super::{cull_pass::listed_pipeline, splash};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        pass::{self, ComputeDesc},
    },
};

/// Bytes of a `Crown` of `shaders/rain/splash.wgsl`.
const CROWN_BYTES: u64 = 48;

/// What a view holds to make crowns.
pub(super) struct CrownPass {
    layout: wgpu::BindGroupLayout,
    crowns: wgpu::Buffer,
    group: wgpu::BindGroup,
    /// Indexed by whether depth has several samples, and whether area rims and occluder maps are in use.
    makes: [Option<wgpu::ComputePipeline>; 8],
    /// For either kind of depth.
    draws: [Option<wgpu::RenderPipeline>; 2],
    counts: bool,
}

/// Which shaders a frame needs: for depth of several samples, with rims of areas near, with occluder maps.
pub(super) type CrownKind = [bool; 3];

fn key(kind: CrownKind) -> usize {
    kind.into_iter().fold(0, |k, bit| 2 * k + usize::from(bit))
}

impl CrownPass {
    pub fn new(device: &wgpu::Device, counts: bool) -> Self {
        let layout = bind::layout(device, "crowns", wgpu::ShaderStages::COMPUTE, &[(0, Slot::Storage(CROWN_BYTES))]);
        let crowns = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("crowns"),
            size: CROWN_BYTES * u64::from(splash::MOST),
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::VERTEX,
            mapped_at_creation: false,
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("crowns"),
            layout: &layout,
            entries: &[bind::buffer(0, &crowns)],
        });
        Self { layout, crowns, group, makes: [const { None }; 8], draws: [None, None], counts }
    }

    /// Bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        self.crowns.size()
    }

    /// Makes the pipelines that a frame needs, if they are not there. `frame` and `around` are the layouts of the drops' own
    /// groups.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn prepare(
        &mut self,
        device: &Device,
        [frame, around]: [&wgpu::BindGroupLayout; 2],
        kind: CrownKind,
    ) -> Result<()> {
        let [multi, areas, maps] = kind;
        let make = &mut self.makes[key(kind)];
        if make.is_none() {
            let shader = if multi { "rain/crowns_view.wgsl:multi" } else { "rain/crowns_view.wgsl" };
            let flag = |name, on| (name, f64::from(u8::from(on)));
            let constants = [flag("AREAS", areas), flag("OVERLAPS", false), flag("MAPS", maps)];
            let layouts = [Some(frame), Some(&self.layout), Some(around)];
            let desc = ComputeDesc { shader, entry: "make_crowns", layouts: &layouts, constants: &constants };
            *make = Some(pass::compute(device, &desc)?);
        }
        let draw = &mut self.draws[usize::from(multi)];
        if draw.is_none() {
            let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4];
            *draw = Some(listed_pipeline(
                device,
                frame,
                (["crown_vertex", "crown_fragment"], &attributes, CROWN_BYTES),
                ((multi, true), self.counts),
            )?);
        }
        Ok(())
    }

    /// Makes the crowns of that many slots; `frame` and `around` are bound as groups 0 and 2.
    pub fn make(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        [frame, around]: [&wgpu::BindGroup; 2],
        kind: CrownKind,
        slots: u32,
    ) {
        let Some(make) = &self.makes[key(kind)] else { return };
        pass.set_pipeline(make);
        pass.set_bind_group(0, frame, &[]);
        pass.set_bind_group(1, &self.group, &[]);
        pass.set_bind_group(2, around, &[]);
        pass.dispatch_workgroups(slots.div_ceil(64), 1, 1);
    }

    /// Draws them; group 0 is set.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, [multi, ..]: CrownKind, slots: u32) {
        let Some(draw) = &self.draws[usize::from(multi)] else { return };
        pass.set_pipeline(draw);
        pass.set_vertex_buffer(0, self.crowns.slice(..));
        pass.draw(0..4, 0..slots);
    }
}
