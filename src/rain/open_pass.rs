//! Share of the rain that reaches the cones past shelters, on a coarse grid over the picture. For each cell of the grid
//! the four quarters of every stretch of its ray are tested, and every pixel looks the results up. The grid is drawn
//! only if a box or an occluder map near the camera keeps rain off.

use std::sync::Arc;

use super::{
    cones::{ConeUniform, STRETCHES},
    uniforms::RainUniform,
};
use crate::{
    error::Result,
    gpu::{
        Device, Layer,
        bind::{self, Slot},
        blocks::BlockView,
        pass::{FullscreenDesc, fullscreen},
    },
};

/// Side of a cell, pixels.
const CELL: u32 = 10;
/// Smallest number of cells along the width and along the height of the picture.
const FEWEST: u32 = 40;
/// Format of the grid: one channel for each quarter of a stretch.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Grid of a view and its pass, created when it is first needed.
pub(super) struct OpenPass {
    /// Layouts and groups of the rain's block and of the cones' block.
    layouts: [wgpu::BindGroupLayout; 2],
    groups: [wgpu::BindGroup; 2],
    /// Pipelines without and with occluder maps.
    pipelines: [Option<wgpu::RenderPipeline>; 2],
    /// Texture of the grid, with one layer for each stretch.
    grid: wgpu::Texture,
    /// Views of the grid's layers, one for each stretch.
    layers: [wgpu::TextureView; STRETCHES],
}

/// Returns the number of cells of the grid over a picture.
fn cells(picture: wgpu::Extent3d) -> wgpu::Extent3d {
    let along = |pixels: u32| pixels.div_ceil(CELL).max(FEWEST);
    wgpu::Extent3d {
        width: along(picture.width),
        height: along(picture.height),
        depth_or_array_layers: STRETCHES as u32,
    }
}

/// Creates a grid. A grid of one cell is bound if nothing keeps rain off.
pub(super) fn grid(device: &wgpu::Device, size: wgpu::Extent3d) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("open shares"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

fn layer(grid: &wgpu::Texture, index: usize) -> wgpu::TextureView {
    Layer { texture: grid, index: index as u32 }.attached_view()
}

impl OpenPass {
    /// Creates the grid. `blocks` begins with the rain's block; `cones` is the cones' block.
    pub fn new(device: &wgpu::Device, [blocks, cones]: [&BlockView; 2], picture: wgpu::Extent3d) -> Self {
        let sizes = [size_of::<RainUniform>(), size_of::<ConeUniform>()];
        let layouts = sizes
            .map(|size| bind::layout(device, "open shares", wgpu::ShaderStages::FRAGMENT, &[(0, Slot::Uniform(size))]));
        let groups = [(blocks, 0), (cones, 1)].map(|(block, i)| {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("open shares"),
                layout: &layouts[i],
                entries: &[block.part(0, 0, sizes[i])],
            })
        });
        let grid = grid(device, cells(picture));
        let layers = std::array::from_fn(|i| layer(&grid, i));
        Self { layouts, groups, pipelines: [None, None], grid, layers }
    }

    /// Returns the bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        let size = self.grid.size();
        4 * STRETCHES as u64 * u64::from(size.width) * u64::from(size.height)
    }

    /// Returns the grid for a picture of this size, and whether it has been created anew.
    pub fn fit(&mut self, device: &wgpu::Device, picture: wgpu::Extent3d) -> (&wgpu::Texture, bool) {
        let size = cells(picture);
        let anew = self.grid.size() != size;
        if anew {
            self.grid = grid(device, size);
            self.layers = std::array::from_fn(|i| layer(&self.grid, i));
        }
        (&self.grid, anew)
    }

    /// Tests the cells for shelter by the surroundings in the group `around`; `maps` says whether they contain occluder
    /// maps.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn draw(
        &mut self,
        device: &Arc<Device>,
        encoder: &mut wgpu::CommandEncoder,
        (layout, around): (&wgpu::BindGroupLayout, &wgpu::BindGroup),
        maps: bool,
    ) -> Result<()> {
        let slot = &mut self.pipelines[usize::from(maps)];
        if slot.is_none() {
            let target = wgpu::ColorTargetState { format: FORMAT, blend: None, write_mask: wgpu::ColorWrites::ALL };
            let targets = [const { None }; STRETCHES].map(|_: Option<()>| target.clone());
            *slot = Some(fullscreen(
                device,
                &FullscreenDesc {
                    shader: "rain/open.wgsl",
                    entry: "open_fragment",
                    layouts: &[&self.layouts[0], &self.layouts[1], layout],
                    targets: &targets,
                    constants: &[("MAPS", f64::from(u8::from(maps)))],
                    samples: 1,
                },
            )?);
        }
        let attachments = self.layers.each_ref().map(|view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::WHITE), store: wgpu::StoreOp::Store },
            })
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("open shares"),
            color_attachments: &attachments,
            ..Default::default()
        });
        if let Some(pipeline) = slot {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &self.groups[0], &[]);
            pass.set_bind_group(1, &self.groups[1], &[]);
            pass.set_bind_group(2, around, &[]);
            pass.draw(0..3, 0..1);
        }
        Ok(())
    }
}
