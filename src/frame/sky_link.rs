//! How the frame asks the sky and the fog for their tables.

use super::Shared;
use crate::{context::Scene, error::Result, gpu::Device};

/// Tables that views share.
pub(super) struct SharedSky {
    layouts: [wgpu::BindGroupLayout; 2],
}

impl SharedSky {
    pub fn new(device: &Device) -> Result<Self> {
        let empty =
            || device.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &[] });
        Ok(Self { layouts: [empty(), empty()] })
    }
    pub fn layouts(&self) -> [&wgpu::BindGroupLayout; 2] {
        [&self.layouts[0], &self.layouts[1]]
    }
}

/// What a view keeps of the sky.
pub(super) struct ViewSky {
    groups: [wgpu::BindGroup; 2],
}

impl ViewSky {
    pub fn new(device: &Device, shared: &Shared) -> Result<Self> {
        let groups = shared.sky().layouts().map(|layout| {
            device.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &[] })
        });
        Ok(Self { groups })
    }
    pub fn prepare(
        &mut self,
        _: &Device,
        _: &Shared,
        _: &mut wgpu::CommandEncoder,
        _: &Scene,
        _cut: bool,
    ) -> Result<u32> {
        Ok(0)
    }
    pub fn write(&self, _: &Device, _: &Scene) {}
    pub fn groups(&self) -> [&wgpu::BindGroup; 2] {
        [&self.groups[0], &self.groups[1]]
    }
    pub fn bytes(&self) -> u64 {
        0
    }
}
