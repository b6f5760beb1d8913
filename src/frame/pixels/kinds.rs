//! Kinds of pixels, drawn one after the other, each with only the shader code that it needs.
//!
//! The first draw writes each pixel's kind as a depth. Each draw of the composition then passes the depth test only at
//! pixels of its own kind, before its shader runs. All draws are in one pass. Pixels interpolated from the coarse grid
//! ([`super::even`]) are kinds of their own. All other pixels are divided by what they show, but only on a software
//! driver. Such a driver executes both sides of every branch: a sky pixel would pay for the air in front of objects, an
//! object for the sky behind it, and the sky for the planet's ground below it. A GPU skips the side of a branch that is
//! not taken, so it draws all other pixels with one pipeline.

use super::{
    pixel_kind::{FORMAT, Pixels},
    variant::Variant,
};
use crate::{gpu::flat_texture, stage::Stages};

/// Whether the interpolated pixels on which the host drew have a draw of their own, which reads depth. They have one if
/// water or snow lies on surfaces, or if clouds may be in front of these pixels.
pub(in crate::frame) fn draws_apart(all: &Variant) -> bool {
    all.stages.has(Stages::SURFACE) || all.constants.traits.is_overlaid
}

/// Largest number of draws of a picture, besides the draw that writes the kinds.
pub(in crate::frame) const DRAWS: usize = 5;

/// Returns the draws that together make the picture of `all`. There is a single draw if samples have depths of their
/// own or rays are marched. With a `grid`, interpolated pixels have draws of their own. If `splits`, the other pixels
/// have a draw for each kind, except kinds that the draw would not change.
pub(in crate::frame) fn draws(all: &Variant, grid: bool, splits: bool) -> [Option<Variant>; DRAWS] {
    let (stages, traits) = (all.stages, all.constants.traits);
    let has_depth = all.images[0];
    let veils_all = stages.has(Stages::MEDIUM) && traits.veils_all;
    let veils_drawn = veils_all || stages.has(Stages::MEDIUM) && traits.veils_drawn;
    let everywhere = stages.has(Stages::PARTICLES.with(Stages::TONE));
    let behind = stages.has(Stages::BACKGROUND);
    if all.samples > 1 || traits.is_marched {
        return [Some(*all), None, None, None, None];
    }
    let far = |pixels| Variant {
        stages: stages.without(Stages::SURFACE),
        images: [false, all.images[1], false, false],
        pixels,
        ..*all
    };
    let drawn = Variant { stages: stages.without(Stages::BACKGROUND), pixels: Pixels::Drawn, ..*all };
    let is_far = behind || veils_all || everywhere;
    let is_drawn = has_depth && (veils_drawn || everywhere || stages.has(Stages::SURFACE));
    // A grid covers the whole picture, so it is used only if the weather changes every pixel.
    let grid = grid && is_far && (is_drawn || !has_depth);
    let even = grid.then(|| far(Pixels::Even));
    let even_drawn = (grid && has_depth && draws_apart(all)).then_some(Variant { pixels: Pixels::EvenDrawn, ..*all });
    if !splits {
        let pixels = if grid { Pixels::Uneven } else { Pixels::All };
        return [Some(Variant { pixels, ..*all }), even, even_drawn, None, None];
    }
    [
        is_far.then(|| far(Pixels::Above)),
        is_far.then(|| far(Pixels::Below)),
        is_drawn.then_some(drawn),
        even,
        even_drawn,
    ]
}

/// Depth attachment of a view, with the kinds of its picture's pixels.
pub(in crate::frame) struct KindAttachment {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
}

impl KindAttachment {
    /// Creates the attachment for a picture of this size.
    pub fn new(device: &wgpu::Device, size: wgpu::Extent3d) -> Self {
        let (size, usage) = ((size.width, size.height), wgpu::TextureUsages::RENDER_ATTACHMENT);
        let texture = flat_texture(device, "kinds of pixels", size, FORMAT, usage);
        let view = texture.create_view(&Default::default());
        Self { texture, view }
    }

    /// Whether the attachment has the picture's size.
    pub fn fits(&self, picture: &wgpu::Texture) -> bool {
        (self.texture.width(), self.texture.height()) == (picture.width(), picture.height())
    }

    /// Returns the size in GPU memory, bytes.
    pub fn bytes(&self) -> u64 {
        4 * u64::from(self.texture.width()) * u64::from(self.texture.height())
    }

    /// Records the draw that writes the kinds, then the draws of the composition.
    pub fn draw<'a>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipelines: impl Iterator<Item = &'a wgpu::RenderPipeline>,
        groups: &[&wgpu::BindGroup],
        target: &wgpu::TextureView,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("composite"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.view,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        for (i, group) in groups.iter().enumerate() {
            pass.set_bind_group(i as u32, *group, &[]);
        }
        for pipeline in pipelines {
            pass.set_pipeline(pipeline);
            pass.draw(0..3, 0..1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stage::{Pipeline, Sampling, Traits};

    fn variant(stages: Stages, has_depth: bool, veils_all: bool) -> Variant {
        let traits = Traits { veils_all, veils_drawn: true, ..Traits::default() };
        let constants = Pipeline { traits, ..Pipeline::NONE };
        Variant {
            stages,
            format: wgpu::TextureFormat::Rgba16Float,
            samples: 1,
            sampling: Sampling::Single,
            images: [has_depth, false, false, false],
            constants,
            pixels: Pixels::All,
        }
    }

    fn drawn(all: &Variant) -> Vec<Pixels> {
        draws(all, false, true).iter().flatten().map(|v| v.pixels).collect()
    }

    #[test]
    fn a_draw_is_for_the_pixels_that_its_stages_change() {
        let (behind, between, surfaces) = (Stages::BACKGROUND, Stages::MEDIUM, Stages::SURFACE);
        use Pixels::{Above, All, Below, Drawn};
        for (stages, has_depth, veils_all, expected) in [
            (behind.with(between), true, false, &[Above, Below, Drawn][..]),
            (behind, true, true, &[Above, Below]),
            (behind, false, false, &[Above, Below]),
            (between, true, false, &[Drawn]),
            (between, true, true, &[Above, Below, Drawn]),
            (between, false, true, &[Above, Below]),
            (surfaces, true, true, &[Drawn]),
            (Stages::TONE, true, false, &[Above, Below, Drawn]),
            (Stages::ALL, true, true, &[Above, Below, Drawn]),
        ] {
            let all = variant(stages, has_depth, veils_all);
            assert_eq!(drawn(&all), expected, "{stages:?}, depth {has_depth}, before all {veils_all}");
            assert_eq!(drawn(&Variant { samples: 4, ..all }), [All], "samples have depths of their own");
            let even: Vec<_> =
                draws(&all, true, true).iter().flatten().map(|v| v.pixels).filter(|p| p.are_even()).collect();
            let whole = expected.contains(&Above) && (!has_depth || expected.contains(&Drawn));
            assert_eq!(!even.is_empty(), whole, "{stages:?}: a grid is for all of the picture");
            assert_eq!(even.contains(&Pixels::EvenDrawn), whole && has_depth && stages.has(surfaces));
        }
    }

    #[test]
    fn one_draw_has_all_uneven_pixels_where_they_are_not_split() {
        let of =
            |all: &Variant, grid| draws(all, grid, false).into_iter().flatten().map(|v| v.pixels).collect::<Vec<_>>();
        let (all, behind) = (variant(Stages::ALL, true, true), variant(Stages::BACKGROUND, true, false));
        assert_eq!(of(&all, false), [Pixels::All]);
        assert_eq!(of(&all, true), [Pixels::Uneven, Pixels::Even, Pixels::EvenDrawn]);
        assert_eq!(of(&behind, true), [Pixels::All], "no grid is drawn of a part of the picture");
        assert_eq!(of(&variant(Stages::BACKGROUND, false, false), true), [Pixels::Uneven, Pixels::Even]);
    }

    #[test]
    fn depths_of_kinds_are_those_that_the_shader_writes() {
        let shader = crate::gpu::shader::assemble("frame/kinds_even.wgsl").unwrap();
        for (name, pixels) in [
            ("KIND_ABOVE", Pixels::Above),
            ("KIND_BELOW", Pixels::Below),
            ("KIND_DRAWN", Pixels::Drawn),
            ("KIND_EVEN", Pixels::Even),
            ("KIND_EVEN_DRAWN", Pixels::EvenDrawn),
            ("KIND_UNEVEN", Pixels::Uneven),
        ] {
            let depth = pixels.test().unwrap().0;
            assert!(shader.contains(&format!("const {name}: f32 = {depth:?};")), "{name} {depth}");
        }
    }
}
