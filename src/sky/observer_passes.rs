//! Layouts and pipelines of the passes that draw observers' tables.

use super::passes::{TABLE_FORMAT, bind, layout, tex};
use super::settings::{SkyModel, SkySettings};
use crate::error::Result;
use crate::gpu::Device;
use crate::gpu::bind::Slot;
use crate::gpu::pass::{FullscreenDesc, fullscreen};

/// Creates the layout of group 1 of every shader that includes `sky/lookup.wgsl`.
pub(super) fn view_layout(device: &Device) -> wgpu::BindGroupLayout {
    use Slot::{Filtered, FilteredArray, Sampler};
    layout(device, "sky view", &[Slot::Uniform(0), FilteredArray, Filtered, Sampler])
}

/// Layouts of the bind groups that observers use.
pub(crate) struct ObserverLayouts {
    planet: wgpu::BindGroupLayout,
    pub observer: wgpu::BindGroupLayout,
    pub view: wgpu::BindGroupLayout,
}

impl ObserverLayouts {
    pub fn new(device: &Device) -> Self {
        use Slot::{Filtered, Sampler};
        let block = Slot::Uniform(0);
        Self {
            planet: layout(device, "sky of a planet", &[block, block, Filtered, Sampler, Filtered, Filtered, block]),
            observer: layout(device, "sky observer", &[block]),
            view: view_layout(device),
        }
    }

    /// Bind group of a planet's tables for observers: light scattered more than once, and light scattered once by gas
    /// and by haze.
    pub fn planet_group(
        &self,
        device: &Device,
        blocks: [&wgpu::Buffer; 3],
        sampler: &wgpu::Sampler,
        [sources, gas, haze]: [&wgpu::TextureView; 3],
    ) -> wgpu::BindGroup {
        let [air, dims, airs] = blocks.map(wgpu::Buffer::as_entire_binding);
        let sampler = wgpu::BindingResource::Sampler(sampler);
        bind(device, &self.planet, &[air, dims, tex(sources), sampler, tex(gas), tex(haze), airs])
    }
}

/// Pipelines that all observers share.
pub(crate) struct ObserverPasses {
    pub sky: wgpu::RenderPipeline,
    pub air: wgpu::RenderPipeline,
}

impl ObserverPasses {
    pub fn new(device: &Device, settings: &SkySettings, layouts: &ObserverLayouts) -> Result<Self> {
        let layouts = [&layouts.planet, &layouts.observer];
        let make = |entry| pipeline(device, settings, entry, &layouts);
        if settings.model == SkyModel::Table3d {
            return Ok(Self { sky: make("sky_from_table")?, air: make("volume_from_table")? });
        }
        let both = make("observed")?;
        Ok(Self { sky: both.clone(), air: both })
    }
}

fn pipeline(
    device: &Device,
    s: &SkySettings,
    entry: &str,
    layouts: &[&wgpu::BindGroupLayout],
) -> Result<wgpu::RenderPipeline> {
    let target = wgpu::ColorTargetState::from(TABLE_FORMAT);
    let desc = FullscreenDesc {
        shader: "sky/observer.wgsl",
        entry,
        layouts,
        targets: &[target.clone(), target],
        constants: &[("DIRECTIONAL", crate::stage::flag(s.model.is_directional())), ("LAYERS", f64::from(s.layers()))],
        samples: 1,
    };
    fullscreen(device, &desc)
}
