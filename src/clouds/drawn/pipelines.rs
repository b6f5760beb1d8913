//! Pipelines of a picture's clouds, and functions that run their passes.

use super::{
    picture::{KINDS, PAIR, SEEN},
    uniforms::{CloudsUniform, PictureUniform, ShadowUniform},
};
use crate::{
    clouds::light::lamps::LampsUniform,
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        pass::{self, FullscreenDesc},
        recent::LruCache,
    },
    stage::{FrameUniform, flag},
};

/// Key of a pipeline that marches rays.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct March {
    /// Fineness of the march ([`crate::clouds::CloudSettings::fineness`]).
    pub fineness: f64,
    /// Whether clouds have local cover ([`crate::clouds::field::placed`]).
    pub is_placed: bool,
    /// Whether shafts of light are drawn.
    pub has_shafts: bool,
    /// Whether some clouds are blurred ([`crate::clouds::field::layers::CloudLayers::is_coarse`]).
    pub is_coarse: bool,
}

/// Key of the pipelines that resolve a whole picture.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Resolve {
    /// Whether the last frame's picture is used.
    pub has_history: bool,
    /// Whether clouds cast shadows on surfaces.
    pub has_shadows: bool,
    /// Whether shafts of light are drawn.
    pub has_shafts: bool,
    /// Whether the host's depth has several samples a pixel.
    pub is_multisampled: bool,
    /// Kinds of depth that the host's depth texture may hold (`Rays::depth_kinds`).
    pub depth_kinds: f64,
    /// Whether a second draw applies the shadows, only to the pixels on which the host drew.
    pub shades_apart: bool,
}

/// Pipelines, and the layouts of their bind groups: for the march, for the passes after it, and for the shadows without
/// and with several depth samples a pixel.
pub(crate) struct Pipelines {
    /// Layout for the passes of a picture after the march.
    pub picture_layout: wgpu::BindGroupLayout,
    /// Layouts for depths of one sample and of several.
    pub shadow_layouts: [wgpu::BindGroupLayout; 2],
    /// Pipelines of the march: the two that were used last, because a view that climbs and sinks again alternates
    /// between two keys.
    march: LruCache<March, wgpu::RenderPipeline, 2>,
    /// Pipeline of the light of lamps and flashes, created at first use.
    glow: LruCache<March, wgpu::RenderPipeline, 1>,
    /// Pipeline that reprojects squares of pixels.
    pub follow: wgpu::RenderPipeline,
    /// Layouts of the march and of the sky. The panorama is marched with them too.
    pub march_layouts: [wgpu::BindGroupLayout; 2],
    /// Pipelines that resolve a picture, for each key: one, or two that draw one after the other.
    resolve: Vec<(Resolve, Vec<wgpu::RenderPipeline>)>,
}

/// Creates a full-screen pipeline with one target for each of `formats`.
fn make(
    device: &Device,
    (shader, entry): (&str, &str),
    layouts: &[&wgpu::BindGroupLayout],
    formats: &[wgpu::TextureFormat],
    constants: &[(&str, f64)],
) -> Result<wgpu::RenderPipeline> {
    let targets: Vec<_> = formats.iter().map(|f| (*f).into()).collect();
    pass::fullscreen(device, &FullscreenDesc { shader, entry, layouts, targets: &targets, constants, samples: 1 })
}

impl Pipelines {
    /// Creates the layouts and the pipeline that reprojects; the others are created at first use.
    pub fn new(device: &Device, sky: &wgpu::BindGroupLayout) -> Result<Self> {
        let layout =
            |slots: &[(u32, Slot)]| bind::layout(&device.device, "clouds", wgpu::ShaderStages::FRAGMENT, slots);
        let march_layout = layout(&[
            (0, Slot::Uniform(size_of::<FrameUniform>())),
            (1, Slot::Uniform(size_of::<CloudsUniform>())),
            (2, Slot::FilteredArray),
            (3, Slot::FilteredVolume),
            (4, Slot::FilteredVolume),
            (5, Slot::Sampler),
            (6, Slot::Sampler),
            (7, Slot::Uniform(size_of::<PictureUniform>())),
            (8, Slot::Filtered),
            (9, Slot::Uniform(size_of::<ShadowUniform>())),
            (10, Slot::Filtered),
            (11, Slot::Uniform(size_of::<LampsUniform>())),
        ]);
        let picture_layout = layout(&[
            (0, Slot::Uniform(size_of::<FrameUniform>())),
            (1, Slot::Uniform(size_of::<PictureUniform>())),
            (2, Slot::Filtered),
            (3, Slot::Filtered),
            (4, Slot::FilteredArray),
            (5, Slot::Sampler),
            (6, Slot::Texels),
            (7, Slot::Texels),
            (8, Slot::Texels),
        ]);
        let shadow_layouts = [false, true].map(|multisampled| {
            layout(&[
                (0, Slot::texels(multisampled)),
                (1, Slot::Uniform(size_of::<ShadowUniform>())),
                (2, Slot::Filtered),
                (3, Slot::Sampler),
            ])
        });
        let march_layouts = [march_layout, sky.clone()];
        let follow = ("clouds/follow.wgsl", "follow");
        Ok(Self {
            march: LruCache::new(),
            march_layouts,
            glow: LruCache::new(),
            follow: make(device, follow, &[&picture_layout], &[SEEN; 3], &[])?,
            resolve: Vec::new(),
            picture_layout,
            shadow_layouts,
        })
    }

    /// Returns the pipeline that marches rays.
    pub fn march(&mut self, device: &Device, key: March) -> Result<wgpu::RenderPipeline> {
        let make = || {
            let march = ("clouds/march_view.wgsl", "march");
            let constants = [
                ("CLOUD_FINENESS", key.fineness),
                ("CLOUD_PLACED", flag(key.is_placed)),
                ("CLOUD_COARSE", flag(key.is_coarse)),
                ("SHAFTS", flag(key.has_shafts)),
            ];
            Ok((key, make(device, march, &self.march_layouts.each_ref(), &[SEEN, PAIR], &constants)?))
        };
        self.march.get_or_make(|made| *made == key, make).cloned()
    }

    /// Returns the pipeline that draws clouds in the light of lamps and flashes.
    pub fn glow(&mut self, device: &Device, key: March) -> Result<wgpu::RenderPipeline> {
        let key = March { has_shafts: false, is_coarse: false, ..key };
        let make = || {
            let glow = ("clouds/glow_view.wgsl:lamps", "glow");
            let constants = [("CLOUD_FINENESS", key.fineness), ("CLOUD_PLACED", flag(key.is_placed))];
            Ok((key, make(device, glow, &self.march_layouts.each_ref(), &[SEEN], &constants)?))
        };
        self.glow.get_or_make(|made| *made == key, make).cloned()
    }

    /// Returns the pipelines that resolve the whole picture: one, or two if shadows have their own draw
    /// ([`Resolve::shades_apart`]).
    pub fn resolve(&mut self, device: &Device, wanted: Resolve) -> Result<&[wgpu::RenderPipeline]> {
        let made = match self.resolve.iter().position(|(made, _)| *made == wanted) {
            Some(made) => made,
            None => {
                let pipelines = self.make_resolve(device, wanted)?;
                self.resolve.push((wanted, pipelines));
                self.resolve.len() - 1
            }
        };
        Ok(&self.resolve[made].1)
    }

    /// Creates the pipelines that resolve a picture: one, or two where the shadows are drawn apart.
    fn make_resolve(&self, device: &Device, wanted: Resolve) -> Result<Vec<wgpu::RenderPipeline>> {
        let shader = if wanted.is_multisampled { "clouds/resolve.wgsl:multi" } else { "clouds/resolve.wgsl" };
        let layouts = [&self.picture_layout, &self.shadow_layouts[usize::from(wanted.is_multisampled)]];
        let make = |entry, shadows, masks: [wgpu::ColorWrites; 2], tested| {
            let targets = masks.map(|write_mask| wgpu::ColorTargetState { write_mask, ..SEEN.into() });
            let constants = [
                ("HISTORY", flag(wanted.has_history)),
                ("SHADOWS", flag(shadows)),
                ("SHAFTS", flag(wanted.has_shafts)),
                ("DEPTH_KINDS", wanted.depth_kinds),
            ];
            let (targets, constants) = (&targets[..], &constants[..]);
            let desc = FullscreenDesc { shader, entry, layouts: &layouts, targets, constants, samples: 1 };
            pass::fullscreen_at(device, &desc, tested)
        };
        let all = [wgpu::ColorWrites::ALL; 2];
        if !wanted.shades_apart {
            return Ok(vec![make("resolve", wanted.has_shadows, all, None)?]);
        }
        let shadow = [wgpu::ColorWrites::empty(), wgpu::ColorWrites::BLUE | wgpu::ColorWrites::ALPHA];
        let kind = pass::depth_test(KINDS, wgpu::CompareFunction::Always, true);
        let drawn = pass::depth_test(KINDS, wgpu::CompareFunction::Equal, false);
        Ok(vec![
            make("resolve_kind", false, all, Some((0.0, kind)))?,
            make("resolve_shadow", true, shadow, Some((1.0, drawn)))?,
        ])
    }
}

/// Returns the colour attachment of a two-dimensional view. The pass stores its content.
fn attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    Some(wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
    })
}

/// Part of a pass's targets: rows from `first_row` on, and the viewport's size, pixels.
#[derive(Clone, Copy)]
pub(crate) struct TargetPart {
    /// First row of the part in the target.
    pub first_row: u32,
    /// Width and height of the part, pixels.
    pub size: (u32, u32),
}

/// Attachments of a pass.
#[derive(Clone, Copy)]
pub(crate) struct PassTargets<'a> {
    /// Views that the pass draws into, in the order of its outputs.
    pub colors: &'a [&'a wgpu::TextureView],
    /// Depth that selects the pixels of each draw of the pass.
    pub kinds: Option<&'a wgpu::TextureView>,
    /// Part of the targets that is drawn; the rest keeps its content. `None` clears the targets and draws all of them.
    pub part: Option<TargetPart>,
}

impl<'a> PassTargets<'a> {
    /// Creates targets that clear these textures and draw all of them.
    pub fn whole(colors: &'a [&'a wgpu::TextureView]) -> Self {
        Self { colors, kinds: None, part: None }
    }
}

/// Runs a pass of one draw.
pub(crate) fn run(
    encoder: &mut wgpu::CommandEncoder,
    targets: PassTargets<'_>,
    pipeline: &wgpu::RenderPipeline,
    groups: &[&wgpu::BindGroup],
) {
    run_each(encoder, targets, std::slice::from_ref(pipeline), groups);
}

/// Runs a pass of several draws.
pub(crate) fn run_each(
    encoder: &mut wgpu::CommandEncoder,
    PassTargets { colors, kinds, part }: PassTargets<'_>,
    pipelines: &[wgpu::RenderPipeline],
    groups: &[&wgpu::BindGroup],
) {
    let load = if part.is_some() { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) };
    let attachments: [_; 3] = std::array::from_fn(|i| colors.get(i).and_then(|t| attachment(t, load)));
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("clouds"),
        color_attachments: &attachments[..colors.len()],
        depth_stencil_attachment: kinds.map(|view| wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    if let Some(TargetPart { first_row, size: (width, height) }) = part {
        pass.set_viewport(0.0, first_row as f32, width as f32, height as f32, 0.0, 1.0);
    }
    for (i, group) in groups.iter().enumerate() {
        pass.set_bind_group(i as u32, *group, &[]);
    }
    for pipeline in pipelines {
        pass.set_pipeline(pipeline);
        pass.draw(0..3, 0..1);
    }
}
