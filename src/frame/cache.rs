//! GPU objects that a view keeps between frames: pipelines, bind groups, blocks, and everything of the picture's size.

use std::sync::Arc;

use super::{
    bound::Bound,
    environment_map::EnvironmentMap,
    froxels::Froxels,
    opaque_step::OpaqueStep,
    pixels::{
        composite::SharedComposite,
        draws::{DrawKey, Draws, MOST_DRAWS},
        even::CoarseWeather,
        kinds::KindAttachment,
    },
};
use crate::{
    context::Context,
    error::Result,
    gpu::{Device, KeptView, blocks::Blocks, recent::LruCache},
    stage::FrameUniformBlock,
    surroundings::SurroundingsBlock,
};

/// GPU resources of a view. Optional ones are created when first needed.
pub(super) struct DrawCache {
    /// Pipelines, shared by the views of a device.
    pub composite: Arc<SharedComposite>,
    pub blocks: Blocks,
    /// Uniform block of the frame.
    pub uniform: FrameUniformBlock,
    pub surroundings: SurroundingsBlock,
    /// Copy of the host's picture that shaders read. `target` is the picture that is drawn into.
    pub copy: Option<wgpu::Texture>,
    pub target: KeptView,
    /// Textures that the bind group refers to, and the group.
    pub bound: Option<(Bound, wgpu::BindGroup)>,
    /// Draws of the last calls, with their pipelines.
    pub draws: LruCache<DrawKey, Draws, MOST_DRAWS>,
    /// Depth attachment with the kinds of pixels.
    pub kinds: Option<KindAttachment>,
    /// Coarse grid of the weather.
    pub even: Option<CoarseWeather>,
    pub opaque: Option<OpaqueStep>,
    /// Textures of the veil, once the host has asked for them.
    pub froxels: Option<Froxels>,
    /// Cube map, once the host has asked for it.
    pub environment: Option<Box<EnvironmentMap>>,
}

impl DrawCache {
    /// Creates the cache without anything of a picture's size.
    ///
    /// # Errors
    /// A GPU fault.
    pub fn new(context: &Context, device: &Device) -> Result<Self> {
        let blocks = Blocks::new();
        Ok(Self {
            composite: context.shared().get(|| SharedComposite::new(device))?,
            uniform: FrameUniformBlock::new(device, &blocks),
            blocks,
            surroundings: SurroundingsBlock::new(&device.device),
            copy: None,
            target: KeptView::default(),
            bound: None,
            draws: LruCache::new(),
            kinds: None,
            even: None,
            opaque: None,
            froxels: None,
            environment: None,
        })
    }

    /// Drops everything of the picture's size, and makes the next frame draw all faces of the cube map.
    pub fn forget_images(&mut self) {
        (self.bound, self.copy, self.opaque) = (None, None, None);
        self.target = KeptView::default();
        (self.kinds, self.even) = (None, None);
        self.environment.iter_mut().for_each(|map| map.forget());
    }
}
