//! Textures that the composition's bind group refers to.

use crate::gpu::KeptLayer;

/// Textures of one bind group, apart from the copy of the picture. The group is created anew only when one of these
/// changes.
pub(super) struct Bound {
    pub depth: Option<KeptLayer>,
    pub mask: Option<KeptLayer>,
    pub surface_classes: Option<KeptLayer>,
    pub normals: Option<KeptLayer>,
    /// Present textures of the effects.
    pub own: Own,
    /// Previous textures of the effects and their bind group, for effects that draw into two textures alternately.
    pub before: Option<(Own, wgpu::BindGroup)>,
}

/// Textures of the effects.
pub(super) type Own = [Option<wgpu::TextureView>; 4];
