//! Textures that the composition's bind group refers to.

use crate::gpu::KeptLayer;

/// Textures of one bind group, apart from the copy of the picture. If one of the host's changes, the group is created
/// anew. If one of the effects' changes, the previous group comes back if it has the new textures.
pub(super) struct Bound {
    pub depth: Option<KeptLayer>,
    pub mask: Option<KeptLayer>,
    pub surface_classes: Option<KeptLayer>,
    pub normals: Option<KeptLayer>,
    /// Textures of the effects in the current bind group.
    pub own: Own,
    /// Previous textures of the effects, and the bind group with them, for effects that draw into two textures
    /// alternately.
    pub before: Option<(Own, wgpu::BindGroup)>,
}

/// Textures of the effects.
pub(super) type Own = [Option<wgpu::TextureView>; 4];
