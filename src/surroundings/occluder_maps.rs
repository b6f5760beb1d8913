//! Occluder maps on the GPU: one texture for all maps, called the table. Its first rows have, for each texel of each
//! map, the range of distances, m, that the surface in the texel spans. The rows after them have the ranges of cells of
//! 8 x 8 and 64 x 64 texels.

use std::sync::Arc;

use super::occluder::{MAX_OCCLUDER_MAPS, OCCLUDER_MAP_TEXELS, Occluder, OccluderMap, OccluderUniform};
use crate::{
    error::{Error, Result},
    gpu::{
        Device, Layer,
        bind::{self, Slot},
        check_depth_format, flat_texture,
        pass::{self, FullscreenDesc},
    },
    scene::DepthUniform,
};

/// Format of the ranges. A texel holds the bits of two floats, because not all drivers can render to 32-bit floats.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Uint;
/// Value of a texel without a surface: the bits of 1e12 and of -1e12, a range that no path crosses.
const NOTHING: wgpu::Color = wgpu::Color { r: 0x5368_d4a5_u32 as f64, g: 0xd368_d4a5_u32 as f64, b: 0.0, a: 0.0 };

/// Uniform block of the pass that computes one map's texels: `MapUniform` of `shaders/surroundings/occluder_map.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct MapUniform {
    /// Rays and depth of the camera with which the host drew the map.
    depth: DepthUniform,
    /// Origin of the map in the table, texels.
    origin: [f32; 2],
    /// Width and height of the map, texels.
    size: [f32; 2],
    /// Sign of clip y in row 0: 1 if row 0 is the map's top, -1 if it is the bottom.
    y_sign: f32,
    pad: [f32; 3],
}

/// Bytes reserved for one map's uniform block.
const BLOCK: u64 = 256;

/// Table of all maps, and the textures from which it is assembled.
struct OccluderTable {
    /// Ranges of texels and of cells.
    ranges: wgpu::Texture,
    /// Width and height of the part of the table that holds texels; multiples of 64.
    size: [u32; 2],
    /// Ranges of the texels.
    fine: wgpu::Texture,
    /// Ranges of the cells of 8 x 8 texels, and of 64 x 64 texels.
    cells: [wgpu::Texture; 2],
}

/// Map with its place in the table.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Placed {
    /// Map as the host set it.
    occluder: Occluder,
    /// Origin and size in the table, texels.
    part: [[u32; 2]; 2],
}

/// Occluder maps of a context.
pub(crate) struct OccluderMaps {
    /// Layouts for the passes that draw texels and cells.
    layouts: [wgpu::BindGroupLayout; 2],
    /// Pipelines that draw texels and cells.
    pipelines: [wgpu::RenderPipeline; 2],
    /// Buffer with a [`MapUniform`] for each map, every [`BLOCK`] bytes.
    blocks: wgpu::Buffer,
    /// Table of ranges, once the host has set a map.
    table: Option<OccluderTable>,
    /// Maps in use; empty if the host has set none.
    list: Vec<Placed>,
}

/// Creates the layouts of the bind groups of both passes.
fn layouts(device: &wgpu::Device) -> [wgpu::BindGroupLayout; 2] {
    let make = |label, slots: &[(u32, Slot)]| bind::layout(device, label, wgpu::ShaderStages::FRAGMENT, slots);
    let map = [(0, Slot::Uniform(size_of::<MapUniform>())), (1, Slot::Texels)];
    [make("occluder map", &map), make("occluder cells", &[(0, Slot::Words)])]
}

fn pipeline(
    device: &Device,
    layout: &wgpu::BindGroupLayout,
    [shader, entry]: [&str; 2],
) -> Result<wgpu::RenderPipeline> {
    let target = wgpu::ColorTargetState { format: FORMAT, blend: None, write_mask: wgpu::ColorWrites::ALL };
    pass::fullscreen(
        device,
        &FullscreenDesc { shader, entry, layouts: &[layout], targets: &[target], constants: &[], samples: 1 },
    )
}

/// Returns the origins of up to four maps of these sizes in a table of two columns and two rows, and the table's size,
/// texels.
fn placed(sizes: &[[u32; 2]]) -> (Vec<[u32; 2]>, [u32; 2]) {
    let up = |v: u32| v.next_multiple_of(64);
    // Returns the index of a map's column, or of its row.
    type Line = fn(usize) -> usize;
    // Returns the largest size along `axis` of the maps in column or row `n`.
    let most = |axis: usize, which: Line, n: usize| {
        sizes.iter().enumerate().filter(|(i, _)| which(*i) == n).map(|(_, s)| up(s[axis])).max().unwrap_or(0)
    };
    let (column, row): (Line, Line) = (|i| i % 2, |i| i / 2);
    let (wide, high) = (most(0, column, 0), most(1, row, 0));
    let places = (0..sizes.len()).map(|i| [column(i) as u32 * wide, row(i) as u32 * high]).collect();
    (places, [wide + most(0, column, 1), high + most(1, row, 1)])
}

impl OccluderTable {
    fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        use wgpu::TextureUsages as U;
        let make =
            |label, [width, height]: [u32; 2], usage| flat_texture(device, label, (width, height), FORMAT, usage);
        let drawn = U::RENDER_ATTACHMENT | U::TEXTURE_BINDING | U::COPY_SRC;
        let part = |n: u32| size.map(|v| v / n);
        Self {
            ranges: make("occluder ranges", [size[0], size[1] + size[1] / 8], U::TEXTURE_BINDING | U::COPY_DST),
            size,
            fine: make("occluder texels", size, drawn),
            cells: [8, 64].map(|n| make("occluder cells", part(n), drawn)),
        }
    }

    /// Returns the column at which the cells of 64 texels begin in `ranges`, and the row at which all cells begin.
    fn cells_at(&self) -> [u32; 2] {
        [self.size[0] / 8, self.size[1]]
    }

    /// Copies the texels and the cells into the table.
    fn gather(&self, encoder: &mut wgpu::CommandEncoder) {
        let [x, y] = self.cells_at();
        for (from, at) in [(&self.fine, [0, 0]), (&self.cells[0], [0, y]), (&self.cells[1], [x, y])] {
            let to = wgpu::TexelCopyTextureInfo {
                origin: wgpu::Origin3d { x: at[0], y: at[1], z: 0 },
                ..self.ranges.as_image_copy()
            };
            encoder.copy_texture_to_texture(from.as_image_copy(), to, from.size());
        }
    }
}

/// Checks that a texture can be used as a map; the error names the field.
fn check_depth(depth: &wgpu::Texture) -> Result<()> {
    check_depth_format(depth.format())?;
    let (least, most) = OCCLUDER_MAP_TEXELS;
    for (name, v) in [("depth.width", depth.width()), ("depth.height", depth.height())] {
        if !(least..=most).contains(&v) {
            return Err(Error::range(name, &format!("in [{least}, {most}] texels"), v));
        }
    }
    if depth.sample_count() > 1 || depth.depth_or_array_layers() > 1 {
        let given = format!("{} samples and {} layers", depth.sample_count(), depth.depth_or_array_layers());
        return Err(Error::range("depth", "of one sample and one layer", given));
    }
    if !depth.usage().contains(wgpu::TextureUsages::TEXTURE_BINDING) {
        return Err(Error::range("depth.usage", "one with TEXTURE_BINDING", format!("{:?}", depth.usage())));
    }
    Ok(())
}

impl OccluderMaps {
    /// Creates the pipelines, without maps.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn new(device: &Device) -> Result<Self> {
        let layouts = layouts(&device.device);
        let pipelines = [
            pipeline(device, &layouts[0], ["surroundings/occluder_map.wgsl", "occluder_map"])?,
            pipeline(device, &layouts[1], ["surroundings/occluder_cells.wgsl", "occluder_cells"])?,
        ];
        let blocks = device.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("occluder maps"),
            size: MAX_OCCLUDER_MAPS as u64 * BLOCK,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Ok(Self { layouts, pipelines, blocks, table: None, list: Vec::new() })
    }

    /// Records the copy of the content of `maps`. These maps replace the earlier ones.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] or [`crate::Status::Unsupported`] naming the map and its field; the maps then
    /// stay as they were.
    pub fn set(
        &mut self,
        device: &Arc<Device>,
        encoder: &mut wgpu::CommandEncoder,
        maps: &[OccluderMap<'_>],
    ) -> Result<()> {
        if maps.len() > MAX_OCCLUDER_MAPS {
            return Err(Error::range("maps.len", &format!("at most {MAX_OCCLUDER_MAPS}"), maps.len()));
        }
        let mut list = Vec::with_capacity(maps.len());
        for (i, map) in maps.iter().enumerate() {
            let named = |e: Error| e.within(&format!("maps[{i}]"));
            check_depth(map.depth).map_err(named)?;
            list.push(map.taken.check().map_err(named)?);
        }
        let sizes: Vec<_> = maps.iter().map(|m| [m.depth.width(), m.depth.height()]).collect();
        let (places, size) = placed(&sizes);
        let whole = |(occluder, (place, size))| Placed { occluder, part: [place, size] };
        self.list = list.into_iter().zip(places.into_iter().zip(sizes)).map(whole).collect();
        if maps.is_empty() {
            return Ok(());
        }
        let table = match self.table.take() {
            Some(table) if table.size == size => table,
            _ => OccluderTable::new(&device.device, size),
        };
        self.draw_texels(device, encoder, &table, maps);
        for (from, to) in [(&table.fine, &table.cells[0]), (&table.cells[0], &table.cells[1])] {
            self.draw_cells(device, encoder, from, to);
        }
        table.gather(encoder);
        self.table = Some(table);
        Ok(())
    }

    /// Computes the ranges of the texels of all maps.
    fn draw_texels(
        &self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        table: &OccluderTable,
        maps: &[OccluderMap<'_>],
    ) {
        let view = table.fine.create_view(&Default::default());
        let mut pass = begin(encoder, &view);
        pass.set_pipeline(&self.pipelines[0]);
        for (i, (map, placed)) in maps.iter().zip(&self.list).enumerate() {
            let [origin, size] = placed.part.map(|p| p.map(|v| v as f32));
            let block = MapUniform {
                depth: placed.occluder.rays.uniform(),
                origin,
                size,
                y_sign: placed.occluder.y_sign as f32,
                pad: [0.0; 3],
            };
            let at = i as u64 * BLOCK;
            device.write_buffer(&self.blocks, at, bytemuck::bytes_of(&block));
            let depth = Layer { texture: map.depth, index: 0 }.view();
            let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("occluder map"),
                layout: &self.layouts[0],
                entries: &[
                    bind::part(0, &self.blocks, at as usize..at as usize + size_of::<MapUniform>()),
                    bind::view(1, &depth),
                ],
            });
            let [[x, y], [w, h]] = placed.part;
            pass.set_bind_group(0, &group, &[]);
            pass.set_scissor_rect(x, y, w, h);
            pass.draw(0..3, 0..1);
        }
    }

    /// Computes the ranges of the cells of `target`, each from the 8 x 8 texels or finer cells of `source` that the
    /// cell covers.
    fn draw_cells(
        &self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        source: &wgpu::Texture,
        target: &wgpu::Texture,
    ) {
        let [source, target] = [source, target].map(|t| t.create_view(&Default::default()));
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("occluder cells"),
            layout: &self.layouts[1],
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&source) }],
        });
        let mut pass = begin(encoder, &target);
        pass.set_pipeline(&self.pipelines[1]);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Returns the table, if there are maps.
    pub fn ranges(&self) -> Option<&wgpu::Texture> {
        if self.list.is_empty() { None } else { self.table.as_ref().map(|t| &t.ranges) }
    }

    /// Returns the column at which the cells of 64 texels begin in the table, and the row at which all cells begin.
    pub fn cells_at(&self) -> [u32; 2] {
        self.table.as_ref().map_or([0; 2], OccluderTable::cells_at)
    }

    /// Returns the maps as shaders read them, for a camera at `eye` in the host's world, m, with axes `to_enu`.
    /// `time_s` is the simulation time, s, up to which each map has moved with its velocity.
    pub fn uniforms(
        &self,
        eye: glam::DVec3,
        to_enu: glam::DMat3,
        time_s: f64,
    ) -> impl Iterator<Item = OccluderUniform> {
        self.list.iter().map(move |p| p.occluder.uniform(eye, to_enu, time_s, p.part))
    }
}

fn begin<'a>(encoder: &'a mut wgpu::CommandEncoder, view: &wgpu::TextureView) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("occluder maps"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(NOTHING), store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_texel_without_a_surface_holds_a_far_distance_on_both_sides() {
        let bits = |v: f64| f32::from_bits(v as u32);
        assert_eq!((bits(NOTHING.r), bits(NOTHING.g)), (1e12, -1e12));
    }

    #[test]
    fn maps_of_any_sizes_lie_beside_each_other_on_whole_cells() {
        for sizes in [
            vec![[100, 50]],
            vec![[512, 512], [64, 1000]],
            vec![[100, 50], [300, 20], [65, 65], [8, 4096]],
            vec![[4096, 4096]; 4],
        ] {
            let (places, whole) = placed(&sizes);
            let ends: Vec<_> = places.iter().zip(&sizes).map(|(p, s)| [p[0] + s[0], p[1] + s[1]]).collect();
            for (i, (p, e)) in places.iter().zip(&ends).enumerate() {
                assert!(p.iter().all(|v| v % 64 == 0) && e[0] <= whole[0] && e[1] <= whole[1], "{p:?} {whole:?}");
                for (q, f) in places.iter().zip(&ends).skip(i + 1) {
                    assert!(e[0] <= q[0] || f[0] <= p[0] || e[1] <= q[1] || f[1] <= p[1], "{p:?} {q:?}");
                }
            }
        }
    }
}
