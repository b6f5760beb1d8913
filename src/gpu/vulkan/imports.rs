//! Imports of a host's images that are kept: the texture of each.

use super::image::{HostImage, ImageRole};

/// Imports kept at once; a host with more images than this pays for a new import now and then.
const MAX_IMPORTS: usize = 64;

/// A host's image with the texture that stands for it.
pub(super) struct Import {
    pub(super) image: HostImage,
    pub(super) role: ImageRole,
    pub(super) texture: wgpu::Texture,
}

/// The imports in use, the most recent last.
#[derive(Default)]
pub(super) struct Imports(pub(super) Vec<Import>);

impl Imports {
    /// The texture of an image imported in `role`, which becomes the most recent.
    pub(super) fn find(&mut self, image: &HostImage, role: ImageRole) -> Option<wgpu::Texture> {
        let at = self.0.iter().position(|i| i.role == role && i.image.same_image(image))?;
        self.0[at..].rotate_left(1);
        self.0.last().map(|i| i.texture.clone())
    }

    /// Keeps an import, and returns the oldest if there are too many.
    pub(super) fn keep(&mut self, import: Import) -> Option<Import> {
        let oldest = (self.0.len() >= MAX_IMPORTS).then(|| self.0.remove(0));
        self.0.push(import);
        oldest
    }
}
