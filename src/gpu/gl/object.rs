//! OpenGL objects to which wgpu textures refer.

use super::{api::Api, names::*};

/// An OpenGL object to which a wgpu texture refers.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum GlObject {
    /// Name and target.
    Texture(u32, u32),
    Renderbuffer(u32),
    /// One of Welkin's framebuffers, through which wgpu draws to images that it cannot attach itself.
    Framebuffer(u32),
}

impl GlObject {
    pub(super) fn name(self) -> u32 {
        let (Self::Texture(name, _) | Self::Renderbuffer(name) | Self::Framebuffer(name)) = self;
        name
    }

    /// Attaches level 0 of a texture, or a renderbuffer, to the bound framebuffer. Does nothing for a framebuffer.
    pub(super) fn attach(self, api: &Api, attachment: u32) {
        match self {
            Self::Texture(name, target) => api.FramebufferTexture2D(FRAMEBUFFER, attachment, target, name, 0),
            Self::Renderbuffer(name) => api.FramebufferRenderbuffer(FRAMEBUFFER, attachment, RENDERBUFFER, name),
            Self::Framebuffer(_) => {}
        }
    }

    pub(super) fn is_multisampled_texture(self) -> bool {
        matches!(self, Self::Texture(_, TEXTURE_2D_MULTISAMPLE))
    }
}
