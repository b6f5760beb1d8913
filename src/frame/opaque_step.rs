//! State of the opaque step between frames: its layout, and the bind group of a frame's images.

use crate::{
    gpu::{
        Device, KeptLayer, KeptView, Layer,
        bind::{self, Slot},
        blocks::BlockView,
        is_kept,
    },
    stage::FrameUniform,
};

/// State that the step keeps between frames.
pub(super) struct OpaqueStep {
    pub layout: wgpu::BindGroupLayout,
    /// Placeholder for a mask that the host does not give.
    none: wgpu::TextureView,
    color: KeptView,
    bound: Option<OpaqueImages>,
}

/// Depth and bind group of a frame's images, created anew only when the host hands over another depth or mask.
pub(super) struct OpaqueImages {
    depth: KeptLayer,
    mask: Option<KeptLayer>,
    pub depth_view: wgpu::TextureView,
    pub group: wgpu::BindGroup,
}

impl OpaqueStep {
    pub fn new(device: &wgpu::Device) -> Self {
        let slots = [(0, Slot::Uniform(size_of::<FrameUniform>())), (1, Slot::Texels)];
        let layout = bind::layout(device, "opaque", wgpu::ShaderStages::VERTEX_FRAGMENT, &slots);
        Self {
            layout,
            none: bind::nothing(device, wgpu::TextureFormat::R8Unorm),
            color: KeptView::default(),
            bound: None,
        }
    }

    /// Drops the view of the picture.
    pub fn forget_color(&mut self) {
        self.color = KeptView::default();
    }

    pub fn bind(
        &mut self,
        device: &Device,
        block: &BlockView,
        [color, depth]: [Layer<'_>; 2],
        mask: Option<Layer<'_>>,
    ) -> (&OpaqueImages, &wgpu::TextureView) {
        let same = |b: &OpaqueImages| depth == b.depth && is_kept(mask, b.mask.as_ref());
        if self.bound.as_ref().is_some_and(|b| !same(b)) {
            self.bound = None;
        }
        let bound = self.bound.get_or_insert_with(|| {
            let mask_view = mask.map(Layer::view);
            let resource = wgpu::BindingResource::TextureView(mask_view.as_ref().unwrap_or(&self.none));
            let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("opaque"),
                layout: &self.layout,
                entries: &[block.entry(0), wgpu::BindGroupEntry { binding: 1, resource }],
            });
            let depth_view = depth.attached_view();
            OpaqueImages { depth: depth.kept(), mask: mask.map(Layer::kept), depth_view, group }
        });
        (bound, self.color.of(color, Layer::attached_view))
    }
}
