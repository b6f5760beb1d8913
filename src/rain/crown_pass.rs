//! Splashes where there are compute shaders: the place of each slot's crown is sought in the picture's depth once, not once a
//! corner. The draw then only spreads corners.

use super::{cull_pass::listed_pipeline, splash};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        pass::{self, ComputeDesc, Made},
    },
    stage::DepthRead,
};

/// Bytes of a `Crown` of `shaders/rain/splash.wgsl`.
const CROWN_BYTES: u64 = 48;

/// What a view holds to make crowns.
pub(super) struct CrownPass {
    layout: wgpu::BindGroupLayout,
    crowns: wgpu::Buffer,
    group: wgpu::BindGroup,
    makes: Made<CrownKind, wgpu::ComputePipeline>,
    draws: Made<DepthRead, wgpu::RenderPipeline>,
    counts: bool,
}

/// Which shaders a frame needs: for what depth, with rims of areas near, with occluder maps.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct CrownKind {
    pub depth: DepthRead,
    pub areas: bool,
    pub maps: bool,
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
        Self { layout, crowns, group, makes: Made::NONE, draws: Made::NONE, counts }
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
        let CrownKind { depth, areas, maps } = kind;
        let (layout, counts) = (&self.layout, self.counts);
        self.makes.prepare(kind, |_| {
            let flag = |name, on| (name, f64::from(u8::from(on)));
            let [_, kinds] = depth.constants();
            let constants = &[flag("AREAS", areas), flag("OVERLAPS", false), flag("MAPS", maps), kinds];
            let layouts = &[Some(frame), Some(layout), Some(around)];
            let shader = &depth.shader("rain/crowns_view.wgsl");
            pass::compute(device, &ComputeDesc { shader, entry: "make_crowns", layouts, constants })
        })?;
        let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4];
        let listed = (["crown_vertex", "crown_fragment"], &attributes[..], CROWN_BYTES);
        self.draws.prepare(depth, |_| listed_pipeline(device, frame, listed, (depth, counts)))
    }

    /// Makes the crowns of that many slots; `frame` and `around` are bound as groups 0 and 2.
    pub fn make(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        [frame, around]: [&wgpu::BindGroup; 2],
        kind: CrownKind,
        slots: u32,
    ) {
        let Some(make) = self.makes.get(&kind) else { return };
        pass.set_pipeline(make);
        pass.set_bind_group(0, frame, &[]);
        pass.set_bind_group(1, &self.group, &[]);
        pass.set_bind_group(2, around, &[]);
        pass.dispatch_workgroups(slots.div_ceil(64), 1, 1);
    }

    /// Draws them; group 0 is set.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, kind: CrownKind, slots: u32) {
        let Some(draw) = self.draws.get(&kind.depth) else { return };
        pass.set_pipeline(draw);
        pass.set_vertex_buffer(0, self.crowns.slice(..));
        pass.draw(0..4, 0..slots);
    }
}
