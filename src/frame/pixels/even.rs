//! Sky, air and fog at every fourth pixel, interpolated where they vary smoothly.
//!
//! Sky, air and fog change slowly from pixel to pixel, except at edges. A small pass draws what they add, at every
//! fourth pixel of every fourth row. A second pass finds the cells of this grid in which linear interpolation is within
//! a thousandth of the curve through the texels and their neighbours. A pixel in such a cell is interpolated from the
//! cell's four texels if its surface is as far away as theirs. All other pixels are drawn in full: edges, thin objects,
//! the edge of fog, the surroundings of the sun's disc. The grid has no clouds; each pixel composites its own clouds
//! over the interpolated value.

use super::{pixel_kind::Pixels, variant::Variant};
use crate::{
    gpu::{
        Device,
        bind::{self, Slot},
        flat_texture,
    },
    stage::{Sampling, Stages},
};

/// Spacing of the grid's texels, pixels: `EVEN_PIXELS` of `shaders/frame/even.wgsl`.
const PIXELS: u32 = 4;
/// Smallest side of a picture that has a grid, pixels.
const LEAST_SIDE: u32 = 64;
const WEATHER: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
const CELLS: wgpu::TextureFormat = wgpu::TextureFormat::Rg16Float;

/// Whether the picture of `all` may use a grid. It may not if neither BACKGROUND nor MEDIUM is drawn, if the weather
/// has detail from pixel to pixel, if fog lies in front of clouds, or if colour or depth is multisampled.
pub(in crate::frame) fn may_be(all: &Variant) -> bool {
    let weather = all.stages.has(Stages::BACKGROUND) || all.stages.has(Stages::MEDIUM);
    let traits = all.constants.traits;
    let is_fine = traits.is_fine || traits.is_overlaid && traits.veils_all;
    weather && !is_fine && all.samples == 1 && all.sampling == Sampling::Single
}

/// Returns the variant that draws the grid of `all`.
pub(in crate::frame) fn grid_of(all: &Variant) -> Variant {
    Variant {
        stages: all.stages.without(Stages::SURFACE.with(Stages::PARTICLES).with(Stages::TONE)),
        format: WEATHER,
        images: [all.images[0], false, false, false],
        pixels: Pixels::Grid,
        ..*all
    }
}

/// Layouts and sampler for the coarse grids of a device's views.
pub(in crate::frame) struct EvenLayouts {
    /// Layout of the pass that finds the cells.
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

    /// Returns the targets of the pass that draws a grid, and of the pass that finds its cells.
    pub fn targets() -> ([wgpu::ColorTargetState; 2], wgpu::ColorTargetState) {
        ([WEATHER.into(), WEATHER.into()], CELLS.into())
    }
}

/// Coarse grid of a view.
pub(in crate::frame) struct CoarseWeather {
    /// Size of the picture, pixels.
    picture: [u32; 2],
    /// Size of the grid, texels.
    size: [u32; 2],
    /// Light with range, and transmittance, at each texel of the grid.
    weather: [wgpu::TextureView; 2],
    cells: wgpu::TextureView,
    /// Bind group of the pass that finds the cells.
    of_weather: wgpu::BindGroup,
    pub group: wgpu::BindGroup,
}

impl CoarseWeather {
    /// Creates the grid for a picture, if the picture is large enough.
    pub fn new(device: &Device, layouts: &EvenLayouts, picture: &wgpu::Texture) -> Option<Self> {
        let (device, picture) = (&device.device, [picture.width(), picture.height()]);
        if picture.iter().any(|side| *side < LEAST_SIDE) {
            return None;
        }
        // Along each axis the grid has one texel before that of the picture's first pixel, and two after that of its
        // last pixel.
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

    /// Whether the grid is for a picture of this size.
    pub fn fits(&self, picture: &wgpu::Texture) -> bool {
        self.picture == [picture.width(), picture.height()]
    }

    /// Returns the size in GPU memory, bytes.
    pub fn bytes(&self) -> u64 {
        20 * u64::from(self.size[0]) * u64::from(self.size[1])
    }

    /// Records the passes that draw the grid and find its cells.
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
