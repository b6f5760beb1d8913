//! Sky, air and fog at every fourth pixel, interpolated where they vary smoothly.
//!
//! Sky, air and fog change slowly from pixel to pixel, but for edges. A small pass draws what they add to every fourth
//! pixel of every fourth row, another one finds the cells in which straight lines between texels are within a
//! thousandth of the curve through them and their neighbours. A pixel of such a cell takes what the four say if what it
//! shows is as far away as what they show. All others are drawn as ever: edges, thin things, the edge of fog, the
//! neighbourhood of the sun's disc. The grid has no clouds: each pixel lays its own over what it looks up.

use super::{pixel_kind::Pixels, variant::Variant};
use crate::{
    gpu::{
        Device,
        bind::{self, Slot},
        flat_texture,
    },
    stage::{Sampling, Stages},
};

/// Pixels from texel to texel: EVEN_PIXELS of `shaders/frame/even.wgsl`.
const PIXELS: u32 = 4;
/// Smallest side of a picture for which a grid is drawn.
const LEAST_SIDE: u32 = 64;
const WEATHER: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
const CELLS: wgpu::TextureFormat = wgpu::TextureFormat::Rg16Float;

/// Whether a grid may stand for parts of the picture of `all`: not where something in it changes from pixel to pixel,
/// nor where samples have depths of their own.
pub(in crate::frame) fn may_be(all: &Variant) -> bool {
    let weather = all.stages.has(Stages::BACKGROUND) || all.stages.has(Stages::MEDIUM);
    let traits = all.constants.traits;
    let is_fine = traits.is_fine || traits.is_overlaid && traits.veils_all;
    weather && !is_fine && all.samples == 1 && all.sampling == Sampling::Single
}

/// The variant that draws the grid of `all`.
pub(in crate::frame) fn grid_of(all: &Variant) -> Variant {
    Variant {
        stages: all.stages.without(Stages::SURFACE.with(Stages::PARTICLES).with(Stages::TONE)),
        format: WEATHER,
        images: [all.images[0], false, false, false],
        pixels: Pixels::Grid,
        ..*all
    }
}

/// Layouts and sampler with which grids are made, for all views of a device.
pub(in crate::frame) struct EvenLayouts {
    /// Layout of what the cells are found from.
    pub weather: wgpu::BindGroupLayout,
    /// Layout of the grid and its cells, group 3 of the draws.
    pub grid: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
}

impl EvenLayouts {
    pub fn new(device: &wgpu::Device) -> Self {
        let layout = |label, slots: &[(u32, Slot)]| bind::layout(device, label, wgpu::ShaderStages::FRAGMENT, slots);
        Self {
            weather: layout("weather's grid", &[(0, Slot::FilteredArray)]),
            grid: layout("even weather", &[(0, Slot::FilteredArray), (1, Slot::Sampler), (2, Slot::Texels)]),
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("even weather"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
        }
    }

    /// Targets of the pass that draws a grid, and of the one that finds its cells.
    pub fn targets() -> ([wgpu::ColorTargetState; 2], wgpu::ColorTargetState) {
        ([WEATHER.into(), WEATHER.into()], CELLS.into())
    }
}

/// The grid of a view.
pub(in crate::frame) struct CoarseWeather {
    picture: [u32; 2],
    size: [u32; 2],
    weather: [wgpu::TextureView; 2],
    cells: wgpu::TextureView,
    of_weather: wgpu::BindGroup,
    pub group: wgpu::BindGroup,
}

impl CoarseWeather {
    /// For a picture, if that is large enough.
    pub fn new(device: &Device, layouts: &EvenLayouts, picture: &wgpu::Texture) -> Option<Self> {
        let (device, picture) = (&device.device, [picture.width(), picture.height()]);
        if picture.iter().any(|side| *side < LEAST_SIDE) {
            return None;
        }
        // One texel before the picture, and two after the last pixel's.
        let size = picture.map(|side| (side - 1) / PIXELS + 4);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let weather = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("even weather"),
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 2 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: WEATHER,
            usage,
            view_formats: &[],
        });
        let cells = flat_texture(device, "even cells", size.into(), CELLS, usage).create_view(&Default::default());
        let all = bind::as_layers(&weather);
        let group = |layout, entries: &[wgpu::BindGroupEntry<'_>]| {
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("even"), layout, entries })
        };
        let of_weather = group(&layouts.weather, &[bind::view(0, &all)]);
        let sampler = bind::sampler(1, &layouts.sampler);
        let group = group(&layouts.grid, &[bind::view(0, &all), sampler, bind::view(2, &cells)]);
        let weather = [0, 1].map(|layer| {
            weather.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            })
        });
        Some(Self { picture, size, weather, cells, of_weather, group })
    }

    /// Whether it is for a picture of this size.
    pub fn fits(&self, picture: &wgpu::Texture) -> bool {
        self.picture == [picture.width(), picture.height()]
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        20 * u64::from(self.size[0]) * u64::from(self.size[1])
    }

    /// Records the passes that draw it and find its cells.
    pub fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        [grid, cells]: [&wgpu::RenderPipeline; 2],
        groups: &[&wgpu::BindGroup],
    ) {
        let attachment = |view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })
        };
        let mut pass =
            |label, targets: &[Option<wgpu::RenderPassColorAttachment<'_>>], pipeline, groups: &[&wgpu::BindGroup]| {
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some(label),
                    color_attachments: targets,
                    ..Default::default()
                });
                pass.set_pipeline(pipeline);
                for (i, group) in groups.iter().enumerate() {
                    pass.set_bind_group(i as u32, *group, &[]);
                }
                pass.draw(0..3, 0..1);
            };
        pass("even grid", &self.weather.each_ref().map(attachment), grid, groups);
        pass("even cells", &[attachment(&self.cells)], cells, &[&self.of_weather]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grid_is_that_of_the_shader() {
        let shader = crate::gpu::shader::assemble("frame/even.wgsl").expect("there");
        assert!(shader.contains(&format!("const EVEN_PIXELS: i32 = {PIXELS};")));
    }
}
