//! Pass that draws the columns of rain areas as translucent volumes into the layer in front of the picture.

use std::sync::Arc;

use glam::{DMat4, DVec3};

use super::{
    light::DropLight,
    shaft::{AreaField, BELOW_M, ColumnUniform, RainColumn},
};
use crate::{
    error::Result,
    falling::{MAX_AREAS, curtain::WAVES},
    gpu::{
        Device, KeptLayer, Layer,
        bind::{self, Slot},
        blocks::UniformBlock,
        is_kept,
        pass::{self, QuadsDesc},
        recent::LruCache,
    },
    moment::Scene,
    particles::{LAYER_FORMAT, layer_pass},
    stage::{Block, Constant, FrameUniform, MergedFrame, Recording, Texture, flag, veiled},
};

/// Uniform block `Columns` of `shaders/rain/area.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct ColumnsUniform {
    count: u32,
    pad: [u32; 3],
    list: [ColumnUniform; MAX_AREAS],
}

/// Uniform block `ShaftUniform` of `shaders/rain/shaft.wgsl`, which describes the fields.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct ShaftUniform {
    above: [f32; 3],
    own: f32,
    below: [f32; 3],
    own_top: f32,
    sun: [f32; 3],
    own_soft: f32,
    to_sun: [f32; 3],
    own_near: f32,
    order: [[u32; 4]; MAX_AREAS / 4],
    rects: [[f32; 4]; MAX_AREAS],
    waves: [[f32; 4]; WAVES],
}

/// Both blocks, `Columns` and `ShaftUniform`, as one upload.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct AreaBlocks {
    columns: ColumnsUniform,
    pad: [u32; SHAFT_AT / 4 - size_of::<ColumnsUniform>() / 4],
    shaft: ShaftUniform,
}

/// Offset of `ShaftUniform` in the upload, bytes: a uniform buffer is bound at multiples of 256.
const SHAFT_AT: usize = size_of::<ColumnsUniform>().next_multiple_of(256);

/// Properties that select the pipeline, in addition to the composition's constants for air, fog and cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ShaftKind {
    /// Whether the host's depth has several samples a pixel.
    pub multi: bool,
    /// Whether the host gives the depth of its picture.
    pub has_depth: bool,
    /// Whether any columns may overlap.
    pub overlaps: bool,
    /// Whether any area is a polygon.
    pub polygons: bool,
}

/// Number of pipelines that a view keeps: enough for a few weathers that alternate.
const MOST_PIPELINES: usize = 16;

/// Pass of a view, created when the view first has rain areas.
pub(super) struct AreaPass {
    blocks: UniformBlock,
    /// Layouts of group 0 for depth with one and with several samples.
    layouts: [wgpu::BindGroupLayout; 2],
    /// Placeholder for a missing depth.
    none: wgpu::TextureView,
    /// Placeholder for a missing layer behind the picture.
    no_layers: wgpu::TextureView,
    pipelines: LruCache<(ShaftKind, Vec<Constant>), wgpu::RenderPipeline, MOST_PIPELINES>,
    /// Bind group, preceded by the depth and by the layer behind the picture that are bound in it.
    bound: Option<(Option<KeptLayer>, Option<wgpu::TextureView>, wgpu::BindGroup)>,
    /// Whether the pass counts how often each pixel is drawn, instead of drawing light.
    counts: bool,
}

fn layout(device: &wgpu::Device, multisampled: bool) -> wgpu::BindGroupLayout {
    // The size of the block `Between` is set by another room, so any size is accepted.
    let slots = [
        (0, Slot::Uniform(size_of::<FrameUniform>())),
        (1, Slot::texels(multisampled)),
        (4, Slot::Uniform(0)),
        (7, Slot::Uniform(size_of::<ColumnsUniform>())),
        (8, Slot::Uniform(size_of::<ShaftUniform>())),
        (11, Slot::FilteredArray),
    ];
    bind::layout(device, "rain areas", wgpu::ShaderStages::VERTEX_FRAGMENT, &slots)
}

/// Returns a rectangle of the picture that contains a column: left, bottom, right, top in normalised device
/// coordinates; `None` if the column is outside the picture. `clip` maps camera-relative east, north, up to clip space.
/// `own_top` is the top of the weather's own rain, camera-relative, m.
fn part_of_picture(column: &RainColumn, own_top: f64, clip: &DMat4) -> Option<[f32; 4]> {
    let r = column.shaft().radius_m;
    let [mut low, mut high] = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    for corner in 0..8u32 {
        let side = |bit: u32| if corner & bit != 0 { 1.0 } else { -1.0 };
        let z = if corner & 4 != 0 { column.top.max(own_top) } else { column.ground - BELOW_M };
        let middle = column.center + column.shaft().lean * (z - column.ground);
        let at = *clip * (middle + glam::DVec2::new(side(1), side(2)) * r).extend(z).extend(1.0);
        if at.w < 1.0 {
            // The column reaches behind the camera, or the camera is inside it.
            return Some([-1.0, -1.0, 1.0, 1.0]);
        }
        let ndc = at.truncate() / at.w;
        (low, high) = (low.min(ndc), high.max(ndc));
    }
    let part = [low.x.max(-1.0), low.y.max(-1.0), high.x.min(1.0), high.y.min(1.0)];
    (part[0] < part[2] && part[1] < part[3]).then(|| part.map(|v| v as f32))
}

/// Columns of one frame.
pub(super) struct Columns<'a> {
    pub field: &'a AreaField,
    pub scene: &'a Scene,
    /// Matrix from camera-relative east, north, up to clip space.
    pub clip: DMat4,
    /// Whether fog is drawn in front of the picture. The fog contains the weather's own rain, which the columns
    /// replace.
    pub veiled: bool,
}

impl Columns<'_> {
    /// Returns the blocks, in which the columns in the picture are ordered from the farthest to the nearest, and the
    /// number of these columns.
    fn blocks(&self) -> (AreaBlocks, u32) {
        let mut blocks: AreaBlocks = bytemuck::Zeroable::zeroed();
        let field = self.field;
        blocks.columns.count = field.columns.len() as u32;
        for (to, column) in blocks.columns.list.iter_mut().zip(&field.columns) {
            *to = column.uniform();
        }
        // The shader applies the exposure.
        let light = DropLight::of(self.scene);
        let v = |d: DVec3| d.as_vec3().to_array();
        let s = &mut blocks.shaft;
        (s.above, s.below, s.sun, s.to_sun) = (v(light.above), v(light.below), v(light.sun), v(light.to_sun));
        (s.own, s.own_soft) = (field.own.liquid_per_m as f32, field.own.soft_m as f32);
        (s.own_top, s.own_near) = (field.own_top as f32, field.own_near as f32);
        if !self.veiled {
            (s.own, s.own_near) = (0.0, 0.0);
        }
        s.waves = field.waves.map(|w| w.map(|v| v as f32));
        let mut seen = [(0.0f64, 0u32, [0.0f32; 4]); MAX_AREAS];
        let mut count = 0;
        for (i, column) in field.columns.iter().enumerate().take(MAX_AREAS) {
            if let Some(part) = part_of_picture(column, field.own_top, &self.clip) {
                seen[count] = (column.center.length_squared(), i as u32, part);
                count += 1;
            }
        }
        seen[..count].sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        for (at, (_, i, part)) in seen[..count].iter().enumerate() {
            s.order[at / 4][at % 4] = *i;
            s.rects[at] = *part;
        }
        (blocks, count as u32)
    }
}

impl AreaPass {
    pub fn new(device: &Device, blocks: &crate::gpu::blocks::Blocks, counts: bool) -> Self {
        let none = bind::nothing(&device.device, wgpu::TextureFormat::Rgba8Unorm);
        Self {
            counts,
            blocks: blocks.block(device, size_of::<AreaBlocks>()),
            layouts: [layout(&device.device, false), layout(&device.device, true)],
            no_layers: bind::no_layers(&device.device),
            none,
            pipelines: LruCache::new(),
            bound: None,
        }
    }

    /// Uploads the columns and binds them for the veil of the host's own shaders. Returns the layout and the bind
    /// group.
    pub fn bound(
        &mut self,
        device: &Device,
        columns: &Columns<'_>,
        merged: &MergedFrame<'_>,
        depth: Option<Layer<'_>>,
    ) -> Option<(wgpu::BindGroupLayout, wgpu::BindGroup)> {
        let (blocks, _) = columns.blocks();
        self.blocks.write(bytemuck::bytes_of(&blocks));
        let multi = depth.is_some_and(Layer::is_multisampled);
        self.bind(device, merged, depth, multi);
        self.bound.as_ref().map(|(.., group)| (self.layouts[usize::from(multi)].clone(), group.clone()))
    }

    /// Clears the layer `target` and draws the columns into it.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn draw(
        &mut self,
        recording: &mut Recording<'_>,
        columns: &Columns<'_>,
        merged: &MergedFrame<'_>,
        depth: Option<Layer<'_>>,
        target: &wgpu::TextureView,
    ) -> Result<()> {
        let (device, composition) = (recording.device, merged.composition);
        let Some((tables_layout, tables)) = composition.tables() else { return Ok(()) };
        let (blocks, count) = columns.blocks();
        self.blocks.write(bytemuck::bytes_of(&blocks));
        let kind = ShaftKind {
            multi: depth.is_some_and(Layer::is_multisampled),
            has_depth: depth.is_some(),
            overlaps: columns.field.columns.iter().any(|c| c.later != 0),
            polygons: blocks.columns.list.iter().any(|c| c.corners > 0),
        };
        self.bind(device, merged, depth, kind.multi);
        let pipeline = self.pipeline(device, tables_layout, kind, composition.least().between.all())?;
        let Some((.., group)) = &self.bound else { return Ok(()) };
        let mut pass = layer_pass(recording.encoder, "rain areas", target, false);
        if count > 0 {
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.set_bind_group(1, tables, &[]);
            pass.draw(0..4, 0..count);
        }
        Ok(())
    }

    fn bind(&mut self, device: &Device, merged: &MergedFrame<'_>, depth: Option<Layer<'_>>, multi: bool) {
        let Some(between) = merged.composition.own_block(Block::Between) else { return };
        let sky_layers = merged.composition.texture(Texture::Behind);
        if self.bound.as_ref().is_some_and(|(d, h, _)| is_kept(depth, d.as_ref()) && h.as_ref() == sky_layers) {
            return;
        }
        let view = depth.map(Layer::view);
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain areas"),
            layout: &self.layouts[usize::from(multi)],
            entries: &[
                merged.block.entry(0),
                bind::view(1, view.as_ref().unwrap_or(&self.none)),
                between.entry(4),
                bind::view(11, sky_layers.unwrap_or(&self.no_layers)),
                self.blocks.part(7, 0, size_of::<ColumnsUniform>()),
                self.blocks.part(8, SHAFT_AT, size_of::<ShaftUniform>()),
            ],
        });
        self.bound = Some((depth.map(Layer::kept), sky_layers.cloned(), group));
    }

    /// Returns the pipeline of a kind, compiled at its first use.
    fn pipeline(
        &mut self,
        device: &Arc<Device>,
        tables: &wgpu::BindGroupLayout,
        kind: ShaftKind,
        constants: &[Constant],
    ) -> Result<wgpu::RenderPipeline> {
        let (columns, counts) = (&self.layouts[usize::from(kind.multi)], self.counts);
        let make = || {
            let name = if kind.multi { "rain/shaft_view.wgsl:multi" } else { "rain/shaft_view.wgsl" };
            let module = device.shader(&veiled(name, constants))?;
            let mut all = constants.to_vec();
            all.extend([
                ("HAS_DEPTH", flag(kind.has_depth)),
                ("OVERLAPS", flag(kind.overlaps)),
                ("POLYGONS", flag(kind.polygons)),
            ]);
            let pipeline = pass::quads(
                device,
                &QuadsDesc {
                    label: "rain areas",
                    vertex: (&module, "shaft_vertex", &[]),
                    fragment: (&module, "shaft_fragment", &all),
                    layouts: &[Some(columns), Some(tables)],
                    buffers: &[],
                    format: LAYER_FORMAT,
                    counts,
                },
            );
            Ok(((kind, constants.to_vec()), pipeline?))
        };
        self.pipelines.get_or_make(|(k, c)| *k == kind && c == constants, make).cloned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    #[test]
    fn offsets_agree_with_the_shader() {
        let text = shader::assemble("rain/shaft.wgsl").unwrap();
        let (size, _) = shader::struct_layout(&text, "Columns").unwrap();
        assert_eq!(size as usize, size_of::<ColumnsUniform>());
        shader::assert_layout!(
            "rain/shaft.wgsl",
            "ShaftUniform",
            ShaftUniform,
            [above, own, below, own_top, sun, own_soft, to_sun, own_near, order, rects, waves]
        );
    }
}
