//! Textures that the composition's bind group was made of.

use crate::gpu::KeptLayer;

/// The textures of one bind group beside the copy of the picture: it is made anew only when the host hands over others.
pub(super) struct Bound {
    pub depth: Option<KeptLayer>,
    pub mask: Option<KeptLayer>,
    pub surface_classes: Option<KeptLayer>,
    pub normals: Option<KeptLayer>,
    pub own: Own,
    /// The group of the effects' textures before these: an effect may draw into two in turns.
    pub before: Option<(Own, wgpu::BindGroup)>,
}

/// Textures of the effects.
pub(super) type Own = [Option<wgpu::TextureView>; 4];
