//! The composition pass: one full-screen draw over the host's picture, in the variant that the frame needs.

use std::sync::Arc;

use super::{
    Frame,
    target::{Sampling, Stages},
    uniform::FrameUniform,
};
use crate::{
    error::Result,
    fog::{FogUniform, FogVariant},
    gpu::{
        Device, Layer,
        bind::{self, Slot},
        pass::{self, FullscreenDesc},
        recent::Recent,
    },
    ground::GroundUniform,
    sky::SkyVolume,
    surroundings::{Present, layout as around_layout},
};

/// What distinguishes one compiled variant from another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Variant {
    pub stages: Stages,
    pub format: wgpu::TextureFormat,
    pub samples: u32,
    pub sampling: Sampling,
    pub has_depth: bool,
    pub has_mask: bool,
    pub has_classes: bool,
    pub has_normals: bool,
    /// What the fog must be able to draw, if there is any.
    pub fog: Option<FogVariant>,
    /// Kinds of depth that are read ([`ViewRays::depth_kinds`](crate::scene::ViewRays::depth_kinds)).
    pub depth_kinds: u32,
    /// The sky is marched per pixel instead of looked up.
    pub march: bool,
    /// The host's terrain is drawn on.
    pub terrain: bool,
    /// What the host has told of that keeps the ground dry or lights it.
    pub around: Present,
    /// Air between and clear sky are drawn at all.
    pub air: bool,
    pub sky: bool,
}

/// As an `override` constant.
fn yes(b: bool) -> f64 {
    f64::from(u8::from(b))
}

impl Variant {
    /// Without the parts of which nothing is drawn: cheaper than a branch on a software driver, which takes both ways.
    pub fn reduced(self, [air, fog, sky, _]: [f32; 4]) -> Self {
        Self { air: air > 0.0, sky: sky > 0.0, fog: self.fog.filter(|_| fog > 0.0), ..self }
    }

    /// Those of [`Variant::constants`] that shaders of the veil alone have.
    pub fn veil_constants(&self) -> [(&'static str, f64); 10] {
        let [f0, f1, f2, f3, f4, f5] = self.fog.unwrap_or(FogVariant::ALL).constants();
        [
            ("SKY_MARCH", yes(self.march)),
            ("FOG", yes(self.fog.is_some())),
            ("DEPTH_KINDS", f64::from(self.depth_kinds)),
            ("AIR", yes(self.air)),
            f0,
            f1,
            f2,
            f3,
            f4,
            f5,
        ]
    }

    /// Values of the shader's `override` constants.
    pub fn constants(&self) -> [(&'static str, f64); 24] {
        let [f0, f1, f2, f3, f4, f5] = self.fog.unwrap_or(FogVariant::ALL).constants();
        [
            ("BACKGROUND", yes(self.stages.has(Stages::BACKGROUND))),
            ("SURFACE", yes(self.stages.has(Stages::SURFACE))),
            ("MEDIUM", yes(self.stages.has(Stages::MEDIUM))),
            ("TONE", yes(self.stages.has(Stages::TONE))),
            ("PARTICLES", yes(self.stages.has(Stages::PARTICLES))),
            ("SKY_MARCH", yes(self.march)),
            ("FOG", yes(self.fog.is_some())),
            ("DEPTH_KINDS", f64::from(self.depth_kinds)),
            ("HAS_DEPTH", yes(self.has_depth)),
            ("HAS_MASK", yes(self.has_mask)),
            ("AIR", yes(self.air)),
            ("CLEAR_SKY", yes(self.sky)),
            ("SHELTER", yes(self.around.shelter)),
            ("MAPS", yes(self.around.maps)),
            ("LAMPS", yes(self.around.lamps)),
            ("TERRAIN", yes(self.terrain)),
            ("HAS_CLASSES", yes(self.has_classes)),
            ("HAS_NORMALS", yes(self.has_normals)),
            f0,
            f1,
            f2,
            f3,
            f4,
            f5,
        ]
    }
}

/// Pipelines held for all views of a device, who share them where their formats are the same: those of some stages and weathers. On
/// a software driver one may take more than 10 MB.
const MOST_PIPELINES: usize = 32;

/// Pipelines of the composition, shared by the views of a device.
pub(super) struct Composite {
    /// Of group 0, by [`Sampling`].
    layouts: [wgpu::BindGroupLayout; 3],
    layout_sky: wgpu::BindGroupLayout,
    layout_around: wgpu::BindGroupLayout,
    pipelines: Recent<Variant, wgpu::RenderPipeline, MOST_PIPELINES>,
    none: wgpu::TextureView,
    reads_samples: bool,
}

fn layout(device: &wgpu::Device, sampling: Sampling) -> wgpu::BindGroupLayout {
    let [color, depth] = sampling.multisampled().map(Slot::texels);
    let slots = [
        (0, Slot::Uniform(size_of::<FrameUniform>())),
        (1, color),
        (2, depth),
        (3, Slot::Texels),
        (4, Slot::Uniform(size_of::<FogUniform>())),
        (5, Slot::Texels),
        (6, Slot::Uniform(size_of::<GroundUniform>())),
        (7, Slot::Texels),
        (8, Slot::Texels),
        (9, Slot::Texels),
        (10, Slot::Texels),
    ];
    bind::layout(device, "frame", wgpu::ShaderStages::FRAGMENT, &slots)
}

impl Composite {
    pub fn new(device: &Device) -> Self {
        let multi =
            device.adapter.get_downlevel_capabilities().flags.contains(wgpu::DownlevelFlags::MULTISAMPLED_SHADING);
        Self {
            layouts: Sampling::ALL.map(|sampling| layout(&device.device, sampling)),
            layout_sky: SkyVolume::view_layout(device),
            layout_around: around_layout(&device.device),
            pipelines: Recent::new(),
            none: bind::nothing(&device.device, wgpu::TextureFormat::Rgba8Unorm),
            reads_samples: multi,
        }
    }

    /// Whether multisampled targets can be composed, sample by sample.
    pub fn reads_samples(&self) -> bool {
        self.reads_samples
    }

    /// Layouts of the groups of every shader that composes: the frame's, the sky's, that of what is around.
    pub fn layouts(&self, sampling: Sampling) -> [&wgpu::BindGroupLayout; 3] {
        [&self.layouts[sampling as usize], &self.layout_sky, &self.layout_around]
    }

    /// The bind group of one view's uniforms, the copy of the host's colour and its other textures, the drops before them and
    /// water and surface of the host's terrain.
    pub fn bind(
        &self,
        device: &Device,
        [frame, fog, ground]: [&wgpu::Buffer; 3],
        copy: &wgpu::Texture,
        host: &Frame<'_>,
        [drops, cells, surface]: [Option<&wgpu::TextureView>; 3],
    ) -> wgpu::BindGroup {
        let sampling = Sampling::of(copy, host.depth);
        let color_view = copy.create_view(&Default::default());
        let depth_view = host.depth_layer().map(Layer::view);
        let [mask_view, classes, normals] =
            [host.mask_layer(), host.classes_layer(), host.normals_layer()].map(|l| l.map(Layer::view));
        // Not read where there is no depth. wgpu's OpenGL backend can adopt multisampled textures but not make them.
        let no_depth = if sampling == Sampling::Multi { &color_view } else { &self.none };
        let entry =
            |binding, view| wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) };
        device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &self.layouts[sampling as usize],
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: frame.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 4, resource: fog.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 6, resource: ground.as_entire_binding() },
                entry(1, &color_view),
                entry(2, depth_view.as_ref().unwrap_or(no_depth)),
                entry(3, mask_view.as_ref().unwrap_or(&self.none)),
                entry(5, drops.unwrap_or(&self.none)),
                entry(7, cells.unwrap_or(&self.none)),
                entry(8, surface.unwrap_or(&self.none)),
                entry(9, classes.as_ref().unwrap_or(&self.none)),
                entry(10, normals.as_ref().unwrap_or(&self.none)),
            ],
        })
    }

    /// The pipeline of `variant`, compiled at its first use.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn pipeline(&mut self, device: &Arc<Device>, variant: Variant) -> Result<&wgpu::RenderPipeline> {
        let layouts = [&self.layouts[variant.sampling as usize], &self.layout_sky, &self.layout_around];
        self.pipelines.get_or_make(
            |made| *made == variant,
            || {
                let [(shader, entry), _] = variant.sampling.shaders();
                let desc = FullscreenDesc {
                    shader,
                    entry,
                    layouts: &layouts,
                    targets: &[wgpu::ColorTargetState {
                        format: variant.format,
                        blend: None,
                        write_mask: wgpu::ColorWrites::ALL,
                    }],
                    constants: &variant.constants(),
                    samples: variant.samples,
                };
                Ok((variant, pass::fullscreen(device, &desc)?))
            },
        )
    }
}
