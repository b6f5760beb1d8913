//! GPU resources with which the sea is drawn: pipeline, uniform blocks, blocks of the mesh, and textures of the tiles.

use std::sync::Arc;

use half::f16;

use super::{
    drawn::{DrawnTiles, MIPS, MOST_WAVES, TileSlopes, WaveUniform},
    fft::SIDE,
    hull::MAX_SEA_HULLS,
    lace::{LACE_MIPS, LACE_SIDE, lace_levels},
    mesh::{self, LEVELS, MARKS, MOST_BLOCKS, MeshBlock, REGION_MARK, WAKE_MARK},
    outline::MAX_OUTLINE_CORNERS,
    regions::MAX_SEA_REGIONS,
    seen::{SEEN_SIDES, SeaBand, band_of, fill_seen},
    seen_regions::{RegionUniform, SeenRegions},
    seen_wakes::{MOST_TRACK_STATES, SeenWakes, StateUniform, WakeUniform},
    tiles::TILES,
    uniform::SeaUniform,
    water::{TABLE_SIDES, reflectance_table},
};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        counts::DeviceWork,
        flat_texture,
        pass::compiled_once,
    },
    stage::{OpaqueDraw, OpaqueTarget},
};

/// Change of the refractive index from which on the table of reflectances is computed anew.
const INDEX_STEP: f64 = 5e-4;

/// Pipeline of a target.
struct SeaPipeline {
    target: OpaqueTarget,
    constants: [(&'static str, f64); 2],
    pipeline: wgpu::RenderPipeline,
}

/// Resources of a view.
pub(super) struct SeaPasses {
    pub(super) layout: wgpu::BindGroupLayout,
    pub(super) group: wgpu::BindGroup,
    block: wgpu::Buffer,
    waves: wgpu::Buffer,
    blocks: wgpu::Buffer,
    regions: wgpu::Buffer,
    /// Corners of the regions' outlines.
    outlines: wgpu::Texture,
    wakes: wgpu::Buffer,
    /// States of the hulls that raised the wakes.
    tracks: wgpu::Buffer,
    indices: wgpu::Buffer,
    index_count: u32,
    shapes: wgpu::Texture,
    slopes: wgpu::Texture,
    reflectance: wgpu::Texture,
    /// Table of the slopes that pixels show, by distance and direction from the camera.
    seen: wgpu::Texture,
    /// Texels of `seen`.
    seen_texels: Vec<[u16; 4]>,
    pub(super) bands: SeaBands,
    /// Refractive index for which the table of reflectances was computed.
    table_index: Option<f64>,
    pipeline: Option<SeaPipeline>,
}

/// Values of one draw, besides the resources.
pub(super) struct SeaDraw<'a> {
    pub block: &'a SeaUniform,
    pub waves: &'a [WaveUniform],
    pub tiles: &'a [TileSlopes; TILES],
    pub blocks: &'a [MeshBlock],
    pub regions: &'a SeenRegions,
    pub wakes: &'a SeenWakes,
    /// Whether there is sea outside all regions.
    pub is_open: bool,
    /// Refractive index of the water.
    pub index: f64,
}

impl SeaDraw<'_> {
    /// Returns the groups of blocks that are drawn together, each with the number of its band. A group has the blocks
    /// of one level with the same marks.
    fn bands(&self) -> impl Iterator<Item = (usize, &[MeshBlock])> {
        let alike = |a: &MeshBlock, b: &MeshBlock| (a.level, a.marks) == (b.level, b.marks);
        self.blocks.chunk_by(alike).map(|blocks| (MARKS * blocks[0].level as usize + blocks[0].marks as usize, blocks))
    }
}

/// Distance between two bands in the buffer, bytes: the largest alignment that a device may require.
const BAND_STRIDE: usize = 256;
/// Number of bands of all levels.
const BANDS: usize = MARKS * LEVELS as usize;

/// Values of each band, and values with all waves for probes: `sea_band` of `shaders/sea/uniform.wgsl`.
pub(super) struct SeaBands {
    pub layout: wgpu::BindGroupLayout,
    buffer: wgpu::Buffer,
    /// A group for each band, and one with all waves.
    pub groups: Vec<wgpu::BindGroup>,
}

impl SeaBands {
    fn new(device: &Device) -> Self {
        let made = &device.device;
        let slots = [(0, Slot::Uniform(size_of::<SeaBand>()))];
        let layout = bind::layout(made, "bands of the sea", wgpu::ShaderStages::VERTEX_FRAGMENT, &slots);
        let buffer = bind::block(made, "bands of the sea", BAND_STRIDE * (BANDS + 1));
        device.write_buffer(&buffer, (BAND_STRIDE * BANDS) as u64, bytemuck::bytes_of(&SeaBand::WHOLE));
        let group = |band: usize| {
            let from = BAND_STRIDE * band;
            made.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("band of the sea"),
                layout: &layout,
                entries: &[bind::part(0, &buffer, from..from + size_of::<SeaBand>())],
            })
        };
        let groups = (0..=BANDS).map(group).collect();
        Self { layout, buffer, groups }
    }

    fn upload(&self, device: &Device, draw: &SeaDraw<'_>) {
        for (number, blocks) in draw.bands() {
            let marked = |mark: i32, count: usize| if blocks[0].marks & mark != 0 { count as u32 } else { 0 };
            let regions = marked(REGION_MARK, draw.regions.list.len());
            let wakes = marked(WAKE_MARK, draw.wakes.list.len());
            let waves = band_of(draw.block, draw.waves, blocks);
            let band = SeaBand { regions, wakes, is_open: u32::from(draw.is_open), ..waves };
            device.write_buffer(&self.buffer, (BAND_STRIDE * number) as u64, bytemuck::bytes_of(&band));
        }
    }
}

/// Creates the bind group layout of `shaders/sea/uniform.wgsl`.
pub(super) fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let slots = [
        (0, Slot::Uniform(size_of::<SeaUniform>())),
        (1, Slot::Uniform(MOST_WAVES * size_of::<WaveUniform>())),
        (2, Slot::FilteredArray),
        (3, Slot::FilteredArray),
        (4, Slot::Filtered),
        (5, Slot::Sampler),
        (6, Slot::Sampler),
        (7, Slot::FilteredArray),
        (8, Slot::Filtered),
        (9, Slot::Uniform(MAX_SEA_REGIONS * size_of::<RegionUniform>())),
        (10, Slot::Texels),
        (11, Slot::Uniform(MAX_SEA_HULLS * size_of::<WakeUniform>())),
        (12, Slot::Uniform(MOST_TRACK_STATES * size_of::<StateUniform>())),
    ];
    bind::layout(device, "sea", wgpu::ShaderStages::VERTEX_FRAGMENT, &slots)
}

/// Creates the texture of all tiles, with mip levels.
fn tiles_texture(device: &wgpu::Device, label: &str) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: SIDE as u32, height: SIDE as u32, depth_or_array_layers: TILES as u32 },
        mip_level_count: MIPS as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Creates the table of the slopes that pixels show.
fn seen_texture(device: &wgpu::Device) -> wgpu::Texture {
    let [width, height] = SEEN_SIDES.map(|side| side as u32);
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("seen slopes"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 2 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Creates the texture of the pattern of foam.
fn lace_texture(device: &Device) -> wgpu::Texture {
    let side = LACE_SIDE as u32;
    let texture = device.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("lace of foam"),
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
        mip_level_count: LACE_MIPS as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (mip, texels) in (0..).zip(lace_levels()) {
        let side = side >> mip;
        let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(side), rows_per_image: None };
        let size = wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 };
        let to = wgpu::TexelCopyTextureInfo { mip_level: mip, ..texture.as_image_copy() };
        device.write_texture(to, &texels, rows, size);
    }
    texture
}

fn sampler(device: &wgpu::Device, address: wgpu::AddressMode) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("sea"),
        address_mode_u: address,
        address_mode_v: address,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}

impl SeaPasses {
    pub fn new(device: &Device) -> Self {
        let made = &device.device;
        let layout = layout(made);
        let [shapes, slopes] = ["shapes of the sea", "slopes of the sea"].map(|label| tiles_texture(made, label));
        let size = TABLE_SIDES.map(|side| side as u32);
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let format = wgpu::TextureFormat::R16Float;
        let reflectance = flat_texture(made, "reflectance of the sea", (size[0], size[1]), format, usage);
        let seen = seen_texture(made);
        let block = bind::block(made, "sea", size_of::<SeaUniform>());
        let waves = bind::block(made, "waves of the sea", MOST_WAVES * size_of::<WaveUniform>());
        let regions = bind::block(made, "regions of the sea", MAX_SEA_REGIONS * size_of::<RegionUniform>());
        let size = (MAX_OUTLINE_CORNERS as u32, MAX_SEA_REGIONS as u32);
        let outlines = flat_texture(made, "outlines of regions", size, wgpu::TextureFormat::Rg32Float, usage);
        let wakes = bind::block(made, "wakes of the sea", MAX_SEA_HULLS * size_of::<WakeUniform>());
        let tracks = bind::block(made, "tracks of hulls", MOST_TRACK_STATES * size_of::<StateUniform>());
        let indices = mesh::indices();
        let buffer = |label, bytes: usize, usage| {
            made.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes as u64,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let index_buffer = buffer("triangles of the sea", 2 * indices.len(), wgpu::BufferUsages::INDEX);
        device.write_buffer(&index_buffer, 0, bytemuck::cast_slice(&indices));
        let blocks = buffer("blocks of the sea", MOST_BLOCKS * size_of::<MeshBlock>(), wgpu::BufferUsages::VERTEX);
        let group = made.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("sea"),
            layout: &layout,
            entries: &[
                bind::buffer(0, &block),
                bind::buffer(1, &waves),
                bind::view(2, &bind::as_layers(&shapes)),
                bind::view(3, &bind::as_layers(&slopes)),
                bind::view(4, &reflectance.create_view(&Default::default())),
                bind::sampler(5, &sampler(made, wgpu::AddressMode::Repeat)),
                bind::sampler(6, &sampler(made, wgpu::AddressMode::ClampToEdge)),
                bind::view(7, &bind::as_layers(&seen)),
                bind::view(8, &lace_texture(device).create_view(&Default::default())),
                bind::buffer(9, &regions),
                bind::view(10, &outlines.create_view(&Default::default())),
                bind::buffer(11, &wakes),
                bind::buffer(12, &tracks),
            ],
        });
        let index_count = indices.len() as u32;
        Self {
            layout,
            group,
            block,
            waves,
            blocks,
            regions,
            outlines,
            wakes,
            tracks,
            indices: index_buffer,
            index_count,
            shapes,
            slopes,
            reflectance,
            seen,
            seen_texels: Vec::with_capacity(2 * SEEN_SIDES[0] * SEEN_SIDES[1]),
            bands: SeaBands::new(device),
            table_index: None,
            pipeline: None,
        }
    }

    /// Returns the bytes of GPU memory in use.
    pub fn bytes(&self) -> u64 {
        let texels: usize = (0..MIPS).map(|mip| TILES * (SIDE >> mip) * (SIDE >> mip)).sum();
        let wakes = self.wakes.size() + self.tracks.size();
        let buffers = [&self.block, &self.waves, &self.blocks, &self.regions, &self.indices].map(wgpu::Buffer::size);
        let buffers = buffers.iter().sum::<u64>() + wakes;
        let tables = 2 * TABLE_SIDES[0] * TABLE_SIDES[1] + 2 * 8 * SEEN_SIDES[0] * SEEN_SIDES[1];
        let lace: usize = (0..LACE_MIPS).map(|mip| (LACE_SIDE >> mip) * (LACE_SIDE >> mip)).sum();
        let outlines = 8 * MAX_OUTLINE_CORNERS * MAX_SEA_REGIONS;
        (2 * 8 * texels + tables + lace + outlines) as u64 + buffers + self.bands.buffer.size()
    }

    /// Uploads the tiles of another time.
    pub fn upload(&self, device: &Device, tiles: &DrawnTiles) {
        for (texture, levels) in [(&self.shapes, &tiles.shapes), (&self.slopes, &tiles.slopes)] {
            for (mip, texels) in levels.iter().enumerate() {
                let side = (SIDE >> mip) as u32;
                let layout = wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(8 * side),
                    rows_per_image: Some(side),
                };
                let size = wgpu::Extent3d { width: side, height: side, depth_or_array_layers: TILES as u32 };
                let to = wgpu::TexelCopyTextureInfo { mip_level: mip as u32, ..texture.as_image_copy() };
                device.write_texture(to, bytemuck::cast_slice(texels), layout, size);
            }
        }
    }

    fn upload_reflectance(&mut self, device: &Device, index: f64) {
        if self.table_index.is_some_and(|of| (of - index).abs() < INDEX_STEP) {
            return;
        }
        let texels: Vec<u16> = reflectance_table(index).into_iter().map(|v| f16::from_f64(v).to_bits()).collect();
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(2 * TABLE_SIDES[0] as u32),
            rows_per_image: None,
        };
        let bytes = bytemuck::cast_slice(&texels);
        device.write_texture(self.reflectance.as_image_copy(), bytes, layout, self.reflectance.size());
        self.table_index = Some(index);
    }

    fn upload_seen(&mut self, device: &Device, draw: &SeaDraw<'_>) {
        fill_seen(draw.block, draw.waves, draw.tiles, &mut self.seen_texels);
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(8 * SEEN_SIDES[0] as u32),
            rows_per_image: Some(SEEN_SIDES[1] as u32),
        };
        let bytes = bytemuck::cast_slice(&self.seen_texels);
        device.write_texture(self.seen.as_image_copy(), bytes, layout, self.seen.size());
    }

    fn upload_regions(&self, device: &Device, regions: &SeenRegions) {
        if regions.list.is_empty() {
            return;
        }
        device.write_buffer(&self.regions, 0, bytemuck::cast_slice(&regions.list));
        let row = MAX_OUTLINE_CORNERS as u32;
        let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(8 * row), rows_per_image: None };
        let size = wgpu::Extent3d { width: row, height: regions.list.len() as u32, depth_or_array_layers: 1 };
        device.write_texture(self.outlines.as_image_copy(), bytemuck::cast_slice(&regions.corners), rows, size);
    }

    fn upload_wakes(&self, device: &Device, wakes: &SeenWakes) {
        if wakes.list.is_empty() {
            return;
        }
        device.write_buffer(&self.wakes, 0, bytemuck::cast_slice(&wakes.list));
        device.write_buffer(&self.tracks, 0, bytemuck::cast_slice(&wakes.states));
    }

    /// Draws the sea.
    ///
    /// # Errors
    /// [`crate::Status::Internal`] for a missing shader file.
    pub fn draw(
        &mut self,
        device: &Arc<Device>,
        draw: &SeaDraw<'_>,
        opaque: &OpaqueDraw<'_>,
        pass: &mut wgpu::RenderPass<'_>,
    ) -> Result<()> {
        self.upload_reflectance(device, draw.index);
        device.write_buffer(&self.block, 0, bytemuck::bytes_of(draw.block));
        device.write_buffer(&self.waves, 0, bytemuck::cast_slice(draw.waves));
        device.write_buffer(&self.blocks, 0, bytemuck::cast_slice(draw.blocks));
        self.upload_seen(device, draw);
        self.bands.upload(device, draw);
        self.upload_regions(device, draw.regions);
        self.upload_wakes(device, draw.wakes);
        let constants = opaque.tables.constants;
        if self.pipeline.as_ref().is_none_or(|made| made.target != opaque.target || made.constants != constants) {
            let pipeline = pipeline(device, [&self.layout, &self.bands.layout], opaque)?;
            self.pipeline = Some(SeaPipeline { target: opaque.target, constants, pipeline });
        }
        let Some(made) = &self.pipeline else { return Ok(()) };
        pass.set_pipeline(&made.pipeline);
        pass.set_bind_group(1, opaque.tables.group, &[]);
        pass.set_bind_group(2, &self.group, &[]);
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint16);
        let mut from = 0;
        for (number, blocks) in draw.bands() {
            // Instances begin at 0, since OpenGL ES has no first instance.
            pass.set_vertex_buffer(0, self.blocks.slice(from..));
            pass.set_bind_group(3, &self.bands.groups[number], &[]);
            pass.draw_indexed(0..self.index_count, 0, 0..blocks.len() as u32);
            from += size_of_val(blocks) as u64;
        }
        Ok(())
    }
}

/// Creates the pipeline for a target.
fn pipeline(
    device: &Device,
    [layout, bands]: [&wgpu::BindGroupLayout; 2],
    opaque: &OpaqueDraw<'_>,
) -> Result<wgpu::RenderPipeline> {
    let begun = std::time::Instant::now();
    let (target, tables) = (opaque.target, &opaque.tables);
    let module = device.shader("sea/draw.wgsl")?;
    let pipeline_layout = device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("sea"),
        bind_group_layouts: &[Some(opaque.layout), Some(tables.layout), Some(layout), Some(bands)],
        immediate_size: 0,
    });
    let block = wgpu::VertexBufferLayout {
        array_stride: size_of::<MeshBlock>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &[wgpu::VertexAttribute { format: wgpu::VertexFormat::Sint32x4, offset: 0, shader_location: 0 }],
    };
    let options = wgpu::PipelineCompilationOptions { constants: &tables.constants, ..Default::default() };
    let pipeline = device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("sea"),
        layout: Some(&pipeline_layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: options.clone(),
            buffers: &[Some(block)],
        },
        primitive: Default::default(),
        depth_stencil: Some(target.depth_test()),
        multisample: wgpu::MultisampleState { count: target.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(if target.logarithmic { "logarithmic" } else { "plain" }),
            compilation_options: options,
            targets: &[Some(compiled_once(device, target.color_target()))],
        }),
        multiview_mask: None,
        cache: None,
    });
    device.counts.add_timed([DeviceWork::Pipelines, DeviceWork::PipelineTime], begun);
    Ok(pipeline)
}
