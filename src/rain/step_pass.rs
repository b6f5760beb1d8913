//! Drops that are stepped, on the GPU: their states, and the pass that steps them. [`super::cull_pass`] draws them.

use std::sync::Arc;

use super::{
    Classes,
    cull_pass::source_layout,
    integrated::{Left, StepUniform},
    lattice::SHELLS,
    passes::STARTS,
    uniforms::{MovingAir, RainUniform, StreakCamera},
};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        pass::{self, ComputeDesc},
    },
    surroundings::{WindMap, WindView},
};

/// Bytes of one drop: place and word, velocity.
pub(crate) const STATE_BYTES: u64 = 32;
/// Where the camera's places begin in the block.
const EYES: usize = 256;

/// What a view holds for stepped drops, made when it first draws them.
pub(crate) struct StepPass {
    block: wgpu::Buffer,
    states: Option<(u32, wgpu::Buffer)>,
    left: Option<Left>,
    /// The texture of the wind that is bound; one texel where there is none.
    wind: Option<WindView>,
    sampler: wgpu::Sampler,
    layouts: [wgpu::BindGroupLayout; 3],
    /// Without and with a wind that varies in space.
    steps: [Option<wgpu::ComputePipeline>; 2],
    groups: Option<[wgpu::BindGroup; 3]>,
}

/// What a frame steps by.
pub(crate) struct Stepped<'a> {
    pub classes: &'a Classes,
    pub shot: &'a StreakCamera<'a>,
    pub air: &'a MovingAir,
    /// Nothing of earlier frames may show.
    pub anew: bool,
    pub carried: &'a dyn Fn(f64) -> glam::DVec3,
    /// The texture of the wind that varies in space, and where the camera is in it if there is one.
    pub wind: (WindView, Option<WindMap>),
    /// Drops of all shells that there is room for.
    pub most: u32,
}

/// Of the frame's blocks and of its own for the step, and of what draws them.
fn layouts(device: &wgpu::Device) -> [wgpu::BindGroupLayout; 3] {
    let make = |label, slots: &[(u32, Slot)]| bind::layout(device, label, wgpu::ShaderStages::COMPUTE, slots);
    let step = [
        (0, Slot::Uniform(size_of::<StepUniform>())),
        (1, Slot::Storage(STATE_BYTES)),
        (2, Slot::FilteredVolume),
        (3, Slot::Sampler),
    ];
    [make("step frame", &[(0, Slot::Uniform(size_of::<RainUniform>()))]), make("step", &step), source_layout(device)]
}

impl StepPass {
    pub fn new(device: &Device) -> Self {
        Self {
            block: crate::gpu::bind::block(&device.device, "step", EYES + 16 * SHELLS),
            states: None,
            left: None,
            wind: None,
            sampler: device.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("wind"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
            layouts: layouts(&device.device),
            steps: [None, None],
            groups: None,
        }
    }

    /// Bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        self.states.as_ref().map_or(0, |(_, b)| b.size())
    }

    /// Makes room for the drops, takes up the wind, and records the step. The rain's blocks are up.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn step(
        &mut self,
        device: &Arc<Device>,
        encoder: &mut wgpu::CommandEncoder,
        blocks: &wgpu::Buffer,
        stepped: &Stepped<'_>,
    ) -> Result<()> {
        // Near the rims of rain areas a shell holds the most of what falls on either side.
        let room = device.device.limits().max_storage_buffer_binding_size / (STATE_BYTES * SHELLS as u64);
        let wanted = stepped.most.div_ceil(SHELLS as u32).max(stepped.classes.per_shell);
        let capacity = u64::from(wanted).min(room) as u32;
        if self.states.as_ref().is_none_or(|(c, _)| *c < capacity) {
            let buffer = device.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("drops"),
                size: STATE_BYTES * u64::from(capacity) * SHELLS as u64,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            (self.states, self.left, self.groups) = (Some((capacity, buffer)), None, None);
        }
        let capacity = self.states.as_ref().map_or(0, |(c, _)| *c);
        let (view, map) = &stepped.wind;
        if self.wind.as_ref().is_none_or(|bound| bound.generation != view.generation) {
            (self.wind, self.groups) = (Some(view.clone()), None);
        }
        self.bind(device, blocks);
        let left = self.left.filter(|_| !stepped.anew);
        let (shot, air, per_shell) = (stepped.shot, stepped.air, stepped.classes.per_shell.min(capacity));
        self.left = Some(Left { time_s: air.time_s, position_m: shot.position_m, per_shell });
        let made = StepUniform::new(stepped.classes, shot, air, left, stepped.carried, *map, capacity);
        let Some(block) = made else { return Ok(()) };
        let mut bytes = [0; EYES + 16 * SHELLS];
        bytes[..size_of::<StepUniform>()].copy_from_slice(bytemuck::bytes_of(&block));
        bytes[EYES..].copy_from_slice(bytemuck::bytes_of(&block.eye));
        device.queue.write_buffer(&self.block, 0, &bytes);
        let slot = &mut self.steps[usize::from(map.is_some())];
        if slot.is_none() {
            *slot = Some(step_pipeline(device, &self.layouts, map.is_some())?);
        }
        if let (Some(pipeline), Some(groups)) = (slot, &self.groups) {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &groups[0], &[]);
            pass.set_bind_group(1, &groups[1], &[]);
            pass.dispatch_workgroups(per_shell.div_ceil(64).max(1), SHELLS as u32, 1);
        }
        Ok(())
    }

    /// The states as [`source_layout`] binds them, once there are any.
    pub fn states(&self) -> Option<&wgpu::BindGroup> {
        self.groups.as_ref().map(|[.., states]| states)
    }

    fn bind(&mut self, device: &Device, blocks: &wgpu::Buffer) {
        let (None, Some((_, states)), Some(wind)) = (&self.groups, &self.states, &self.wind) else { return };
        let part = |buffer, offset: usize, size: usize| {
            wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer,
                offset: offset as u64,
                size: wgpu::BufferSize::new(size as u64),
            })
        };
        let group = |layout, entries: &[wgpu::BindGroupEntry<'_>]| {
            device.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("step"), layout, entries })
        };
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        self.groups = Some([
            group(&self.layouts[0], &[entry(0, part(blocks, STARTS[0], size_of::<RainUniform>()))]),
            group(
                &self.layouts[1],
                &[
                    entry(0, part(&self.block, 0, size_of::<StepUniform>())),
                    entry(1, states.as_entire_binding()),
                    entry(2, wgpu::BindingResource::TextureView(&wind.view)),
                    entry(3, wgpu::BindingResource::Sampler(&self.sampler)),
                ],
            ),
            group(
                &self.layouts[2],
                &[entry(0, part(&self.block, EYES, 16 * SHELLS)), entry(1, states.as_entire_binding())],
            ),
        ]);
    }
}

fn step_pipeline(
    device: &Arc<Device>,
    layouts: &[wgpu::BindGroupLayout; 3],
    has_wind: bool,
) -> Result<wgpu::ComputePipeline> {
    let desc = ComputeDesc {
        shader: "rain/step.wgsl",
        entry: "step_drops",
        layouts: &[Some(&layouts[0]), Some(&layouts[1])],
        constants: &[("WIND", f64::from(u8::from(has_wind)))],
    };
    pass::compute(device, &desc)
}

#[cfg(test)]
mod tests;
