//! Cache of the textures imported from a host's images.

use super::image::{HostImage, ImageRole};

/// Largest number of imports kept; a host with more images pays for a new import now and then.
const MAX_IMPORTS: usize = 64;

/// Host's image and its texture.
pub(super) struct Import {
    pub(super) image: HostImage,
    pub(super) role: ImageRole,
    pub(super) texture: wgpu::Texture,
}

/// Imports in use, the most recent last.
#[derive(Default)]
pub(super) struct Imports(pub(super) Vec<Import>);

impl Imports {
    /// Returns the texture of an image imported in `role`, and makes it the most recent.
    pub(super) fn find(&mut self, image: &HostImage, role: ImageRole) -> Option<wgpu::Texture> {
        let at = self.0.iter().position(|i| i.role == role && i.image.same_image(image))?;
        self.0[at..].rotate_left(1);
        self.0.last().map(|i| i.texture.clone())
    }

    /// Keeps an import; returns the oldest one if there are too many.
    pub(super) fn keep(&mut self, import: Import) -> Option<Import> {
        let oldest = (self.0.len() >= MAX_IMPORTS).then(|| self.0.remove(0));
        self.0.push(import);
        oldest
    }
}
