//! Cache of the textures imported from a host's images.

use super::image::{HostImage, ImageRole};

/// Largest number of imports kept. A host with more images pays for a new import whenever it hands over one whose
/// import was removed.
const MAX_IMPORTS: usize = 64;

/// Host's image, its role and its texture.
pub(super) struct Import {
    pub(super) image: HostImage,
    pub(super) role: ImageRole,
    pub(super) texture: wgpu::Texture,
}

/// Imports kept, in order of their last use: the most recent last.
#[derive(Default)]
pub(super) struct Imports(pub(super) Vec<Import>);

impl Imports {
    /// Returns the texture of an image imported in `role`, and makes this import the most recent; `None` if there is
    /// none.
    pub(super) fn find(&mut self, image: &HostImage, role: ImageRole) -> Option<wgpu::Texture> {
        let at = self.0.iter().position(|i| i.role == role && i.image.same_image(image))?;
        self.0[at..].rotate_left(1);
        self.0.last().map(|i| i.texture.clone())
    }

    /// Keeps an import as the most recent. If there are too many, removes and returns the one that was unused for
    /// longest.
    pub(super) fn keep(&mut self, import: Import) -> Option<Import> {
        let oldest = (self.0.len() >= MAX_IMPORTS).then(|| self.0.remove(0));
        self.0.push(import);
        oldest
    }
}
