//! Shadow map of the clouds that pictures read: a window around the camera in a level plane at the altitude of the
//! weather's station. It moves with the air that carries the clouds, so a frame has to refresh only some of its rows. A
//! new map begins coarse, because a whole fine map would cost as much as ten frames.

use super::shadow_projection::{HistoryUse, ShadowInputs, ShadowProjection, TEXELS};
use crate::{
    clouds::drawn::{
        rows::{self, MapRows, RowSpan, Turn},
        tables::CloudTables,
        uniforms::{CloudsUniform, ShadowUniform},
    },
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        blocks::{BlockView, Blocks, UniformBlock},
        flat_texture,
        pass::{self, FullscreenDesc},
    },
    stage::flag,
};

/// Side of the coarse map, texels. It has a quarter as many texels as the rows that a frame refreshes.
const COARSE: u32 = 64;
/// Rows refreshed in a frame. A frame refreshes them once as many rows are old, or while some of the map is coarse.
/// Sixteen frames refresh all rows.
const ROWS: u32 = 32;
/// Shadow map with the passes that draw it.
pub(crate) struct ShadowMap {
    /// Map, which pictures or the host read.
    pub view: wgpu::TextureView,
    /// Block with [`ShadowUniform`].
    pub block: UniformBlock,
    /// Pipeline that draws rows of the whole map.
    pipeline: wgpu::RenderPipeline,
    /// Bind group of the clouds, for both the map and the coarse map.
    clouds: wgpu::BindGroup,
    /// Coarse map, drawn first.
    coarse: Coarse,
    /// Inputs of the last frame.
    inputs: Option<ShadowInputs>,
    /// Progress of the refresh.
    rows: MapRows,
    /// Number of rows that still come from the coarse map.
    coarse_rows: u32,
}

/// Coarse map, with the pass that draws it and the pass that copies it to the whole map.
struct Coarse {
    /// View of the coarse map.
    view: wgpu::TextureView,
    /// Pipeline that draws the coarse map.
    pipeline: wgpu::RenderPipeline,
    /// Pipeline that fills the whole map from the coarse one.
    spread: wgpu::RenderPipeline,
    /// Bind group with the coarse map, for `spread`.
    group: wgpu::BindGroup,
}

/// Format of the map: one share of the direct light.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// Creates the texture of a map with `side` texels along a side.
fn texture(device: &Device, side: u32) -> wgpu::Texture {
    let usage =
        wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
    flat_texture(&device.device, "shadows of clouds", (side, side), FORMAT, usage)
}

/// Creates a full-screen pipeline that writes one map.
fn pipeline(
    device: &Device,
    (shader, entry): (&str, &str),
    layout: &wgpu::BindGroupLayout,
    constants: &[(&str, f64)],
) -> Result<wgpu::RenderPipeline> {
    let (layouts, targets) = ([layout], [FORMAT.into()]);
    let of = FullscreenDesc { shader, entry, layouts: &layouts, targets: &targets, constants, samples: 1 };
    pass::fullscreen(device, &of)
}

/// Creates the pipeline that draws a map with `side` texels along a side.
fn shadow_pipeline(
    device: &Device,
    layout: &wgpu::BindGroupLayout,
    (side, is_placed): (u32, bool),
) -> Result<wgpu::RenderPipeline> {
    let constants = [("SHADOW_TEXELS", f64::from(side)), ("CLOUD_PLACED", flag(is_placed))];
    pipeline(device, ("clouds/shadow.wgsl", "shadow"), layout, &constants)
}

impl Coarse {
    fn new(
        device: &Device,
        (shadow, is_placed): (&wgpu::BindGroupLayout, bool),
        repeating: &wgpu::Sampler,
    ) -> Result<Self> {
        let slots = [(2, Slot::Filtered), (5, Slot::Sampler)];
        let layout = bind::layout(&device.device, "coarse shadows", wgpu::ShaderStages::FRAGMENT, &slots);
        let view = texture(device, COARSE).create_view(&Default::default());
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("coarse shadows"),
            layout: &layout,
            entries: &[bind::view(2, &view), bind::sampler(5, repeating)],
        });
        Ok(Self {
            pipeline: shadow_pipeline(device, shadow, (COARSE, is_placed))?,
            spread: pipeline(
                device,
                ("clouds/shadow_spread.wgsl", "spread"),
                &layout,
                &[("SHADOW_TEXELS", f64::from(TEXELS))],
            )?,
            view,
            group,
        })
    }
}

impl ShadowMap {
    /// Creates the texture of a map.
    pub fn texture(device: &Device) -> wgpu::Texture {
        texture(device, TEXELS)
    }

    /// Creates the map in a texture. The clouds come from `tables` and the uniform block `clouds`.
    pub fn new(
        (device, blocks): (&Device, &Blocks),
        tables: &CloudTables,
        (clouds, is_placed): (&BlockView, bool),
        target: &wgpu::Texture,
    ) -> Result<Self> {
        let slots = [
            (1, Slot::Uniform(size_of::<CloudsUniform>())),
            (2, Slot::FilteredArray),
            (3, Slot::FilteredVolume),
            (5, Slot::Sampler),
            (7, Slot::Uniform(size_of::<ShadowUniform>())),
            (8, Slot::Filtered),
        ];
        let layout = bind::layout(&device.device, "shadows of clouds", wgpu::ShaderStages::FRAGMENT, &slots);
        let block = blocks.block(device, size_of::<ShadowUniform>());
        let solid = tables.solid.view();
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadows of clouds"),
            layout: &layout,
            entries: &[
                clouds.entry(1),
                bind::view(2, &tables.map),
                bind::view(3, &solid),
                bind::sampler(5, &tables.repeating),
                block.entry(7),
                bind::view(8, &tables.placed),
            ],
        });
        Ok(Self {
            view: target.create_view(&Default::default()),
            pipeline: shadow_pipeline(device, &layout, (TEXELS, is_placed))?,
            coarse: Coarse::new(device, (&layout, is_placed), &tables.repeating)?,
            clouds: group,
            block,
            inputs: None,
            rows: MapRows::default(),
            coarse_rows: 0,
        })
    }

    /// Bytes of GPU memory.
    pub const BYTES: u64 = TEXELS as u64 * TEXELS as u64 + COARSE as u64 * COARSE as u64;

    /// Refreshes some rows once enough of them are old. If the whole map is out of date, or the host cuts to another
    /// picture, the whole map is first drawn coarsely. A frame that is a pure function of view and time draws all rows.
    /// Returns the number of passes.
    pub fn draw(&mut self, encoder: &mut wgpu::CommandEncoder, projection: &ShadowProjection, past: HistoryUse) -> u32 {
        let here = projection.inputs;
        self.block.write(bytemuck::bytes_of(&projection.uniform()));
        let before = self.inputs.replace(here);
        let begins = past == HistoryUse::Cut || past == HistoryUse::Kept && before.is_none_or(|b| here.leaps_from(&b));
        if begins {
            self.coarse_rows = TEXELS;
        }
        let turn = Turn {
            rests: past != HistoryUse::Cut && before == Some(here),
            holds: past != HistoryUse::None,
            aged: before.map_or(1.0, |b| here.aged_since(&b)),
            waits: false,
            is_coarse: self.coarse_rows > 0,
        };
        let due = self.rows.due((TEXELS, ROWS), &turn);
        let Some((first, count)) = due else { return 0 };
        self.coarse_rows = self.coarse_rows.saturating_sub(count);
        if begins {
            let coarse = &self.coarse;
            let all = |side| RowSpan { width: side, first: 0, count: side };
            rows::draw(encoder, &coarse.view, all(COARSE), &coarse.pipeline, &[&self.clouds]);
            rows::draw(encoder, &self.view, all(TEXELS), &coarse.spread, &[&coarse.group]);
        }
        rows::draw(encoder, &self.view, RowSpan { width: TEXELS, first, count }, &self.pipeline, &[&self.clouds]);
        1 + 2 * u32::from(begins)
    }
}
