//! A host's colour and depth as wgpu textures.
//!
//! | host's image | colour | depth |
//! |---|---|---|
//! | texture | drawn to and copied directly | read and attached directly |
//! | multisampled texture | drawn to through Welkin's framebuffer | read directly, attached through that framebuffer |
//! | renderbuffer | drawn to directly | attached directly, read from a copy |
//! | framebuffer (the window's or any other) | copied in, drawn to, copied back | copied in, copied back if asked |
//!
//! A multisampled image that is resolved ([`Multisample::Resolve`]) is copied as a framebuffer is.
//!
//! On OpenGL wgpu can neither read renderbuffers nor copy multisampled images, so Welkin copies them before they are
//! read: a renderbuffer's depth each time the target is requested, and after Welkin has written it; colour before each
//! draw that reads it.
//!
//! Welkin never deletes the host's objects: each wgpu texture has a drop callback, which tells wgpu that it does not
//! own the object.

use std::sync::Arc;

use super::{
    api::Api,
    blit::{self, BlitEnd},
    formats,
    image::{self, Ask, Facts, GlImage, Parameters},
    names::*,
    object::GlObject,
    side::TargetSide,
};
use crate::error::Result;

/// Treatment of multisampled images.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Multisample {
    /// Keep the samples: the wgpu textures have the host's samples, and Welkin draws and reads depth per sample. Needs
    /// OpenGL 4.0; not on OpenGL ES nor on a forced tier 0.
    #[default]
    Each,
    /// Resolve: the wgpu textures have one sample. Colour is averaged on the way in and copied to every sample on the
    /// way out; depth is that of one sample. Not on OpenGL ES, and not for multisampled images with `write_depth`.
    Resolve,
}

/// Images that a host asks Welkin to draw into.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct GlTargetDesc {
    /// Picture.
    pub color: GlImage,
    /// Depth, if there is any.
    pub depth: Option<GlImage>,
    /// Mask, if there is one: a texture with one sample. The host's pixel stays where red is 1.
    pub mask: Option<GlImage>,
    /// Surface class of each pixel's surface, if there are any: a texture with one sample.
    pub surface_classes: Option<GlImage>,
    /// Normals of each pixel's surface, if there are any: a texture with one sample.
    pub normals: Option<GlImage>,
    /// Width in pixels; must be that of the images.
    pub width: u32,
    /// Height in pixels; must be that of the images.
    pub height: u32,
    /// Number that the host raises when it creates an object anew under an old name.
    pub generation: u64,
    /// Treatment of multisampled images.
    pub multisample: Multisample,
    /// Whether depth may be written; depth that was copied in is then copied back.
    pub write_depth: bool,
}

/// Target as wgpu textures, valid while the host is entered.
///
/// Row 0 is the host's bottom row, as always in OpenGL, while wgpu takes it for the top row: see "What is upside down"
/// in this room's documentation.
#[derive(Debug)]
pub struct GlTarget {
    /// Number that changes whenever the textures do; for caches of views and bind groups.
    pub id: u64,
    /// Colour to draw to (`RENDER_ATTACHMENT`; also `COPY_SRC` and `TEXTURE_BINDING` if `color_read` is `None`).
    pub color: wgpu::Texture,
    /// Picture to read (`TEXTURE_BINDING`), if wgpu cannot copy `color` itself.
    /// [`HostBinding::refresh`](crate::gpu::HostBinding::refresh) fills it;
    /// [`View::record`](crate::frame::View::record) calls that function.
    pub color_read: Option<wgpu::Texture>,
    /// Depth to attach.
    pub depth: Option<wgpu::Texture>,
    /// Depth to read, as an unfilterable float texture by `textureLoad`.
    pub depth_read: Option<wgpu::Texture>,
    /// Mask to read.
    pub mask: Option<wgpu::Texture>,
    /// Surface classes to read.
    pub surface_classes: Option<wgpu::Texture>,
    /// Normals to read.
    pub normals: Option<wgpu::Texture>,
    /// Samples per pixel of colour and depth.
    pub samples: u32,
}

/// One image of a target, with the objects that Welkin needs to use it.
pub(super) struct TargetImage {
    pub(super) side: TargetSide,
    pub(super) image: GlImage,
    pub(super) facts: Facts,
    pub(super) parameters: Option<Parameters>,
    /// Copy that wgpu reads in place of the host's image, and draws to if [`Copied::drawn_to`] is set.
    pub(super) copy: Option<Copied>,
    /// Copy that wgpu reads while it draws to a colour image that it cannot copy.
    pub(super) reading: Option<Copied>,
}

/// Welkin's copy of an image.
pub(super) struct Copied {
    /// Framebuffer with the image; for [`GlImage::Framebuffer`] the host's own.
    pub(super) from: BlitEnd,
    /// Framebuffer with Welkin's texture.
    pub(super) to: BlitEnd,
    /// Welkin's texture.
    pub(super) texture: u32,
    /// Whether Welkin draws to its texture, not to the host's image; the texture is then copied back.
    pub(super) drawn_to: bool,
}

/// Target in the cache, with Welkin's objects for it.
pub(super) struct Entry {
    pub(super) desc: GlTargetDesc,
    pub(super) target: Arc<GlTarget>,
    /// Number of the latest use, for dropping the least recently used target.
    pub(super) used: u64,
    pub(super) parts: Vec<TargetImage>,
    pub(super) made: TargetObjects,
}

/// Objects that Welkin created for a target.
#[derive(Default)]
pub(super) struct TargetObjects {
    pub(super) framebuffers: Vec<u32>,
    pub(super) textures: Vec<u32>,
    /// Attachments of the framebuffers: framebuffer, attachment, image.
    pub(super) attached: Vec<(u32, u32, GlObject)>,
}

impl TargetObjects {
    /// Deletes the objects.
    pub(super) fn delete(&mut self, api: &Api) {
        self.framebuffers.drain(..).for_each(|name| api.delete(Api::DeleteFramebuffers, name));
        self.textures.drain(..).for_each(|name| api.delete(Api::DeleteTextures, name));
    }
}

impl Entry {
    /// Whether the host's objects still have the properties that they had when the target was built.
    ///
    /// # Errors
    /// The errors of [`image::facts`].
    pub(super) fn is_current(&self, ask: Ask<'_>) -> Result<bool> {
        let size = (self.desc.width, self.desc.height);
        for part in &self.parts {
            if image::facts(ask, part.image, part.side, size)? != part.facts {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Prepares the host's objects for wgpu and copies in what cannot be used in place.
    ///
    /// # Errors
    /// A refused copy.
    pub(super) fn begin(&mut self, api: &Api) -> Result<()> {
        let size = (self.desc.width, self.desc.height);
        // Attaches again: otherwise a framebuffer would keep an object that the host has deleted and created anew under
        // its name. Only after this attachment does OpenGL guarantee that another context's changes to the object are
        // visible (OpenGL 4.6 core specification, section 5.3.3, rule 4).
        for (framebuffer, attachment, object) in &self.made.attached {
            api.BindFramebuffer(FRAMEBUFFER, *framebuffer);
            object.attach(api, *attachment);
        }
        api.BindFramebuffer(FRAMEBUFFER, 0);
        for part in &mut self.parts {
            if let Some(parameters) = &mut part.parameters {
                parameters.take(api);
            }
            if let Some(copy) = &part.copy {
                blit::copy(api, copy.from, copy.to, mask(part.side, part.facts.internal), size)?;
            }
        }
        Ok(())
    }

    /// Copies the present picture to the texture from which it is read.
    ///
    /// # Errors
    /// A refused copy.
    pub(super) fn read_again(&self, api: &Api) -> Result<()> {
        let size = (self.desc.width, self.desc.height);
        let copies = self.parts.iter().filter_map(|part| part.reading.as_ref());
        copies.into_iter().try_for_each(|copy| blit::copy(api, copy.from, copy.to, COLOR_BUFFER_BIT, size))
    }

    /// Copies again the images that are only read, after something was drawn since [`Entry::begin`].
    ///
    /// # Errors
    /// A refused copy.
    pub(super) fn refresh(&self, api: &Api) -> Result<()> {
        let size = (self.desc.width, self.desc.height);
        for part in &self.parts {
            let only_read = part.copy.as_ref().filter(|copy| !copy.drawn_to);
            if let Some(copy) = only_read {
                blit::copy(api, copy.from, copy.to, mask(part.side, part.facts.internal), size)?;
            }
        }
        Ok(())
    }

    /// Whether depth is read from a copy of the attached depth.
    pub(super) fn reads_copied_depth(&self) -> bool {
        let is_copied = |part: &TargetImage| part.copy.as_ref().is_some_and(|copy| !copy.drawn_to);
        self.parts.iter().any(|part| part.side == TargetSide::Depth && is_copied(part))
    }

    /// Copies back what was drawn into copies, depth only if it may be written, and restores the parameters of the
    /// host's objects.
    ///
    /// # Errors
    /// A refused copy; all parameters are restored in any case.
    pub(super) fn end(&self, api: &Api) -> Result<()> {
        let size = (self.desc.width, self.desc.height);
        let mut outcome = Ok(());
        for part in &self.parts {
            if let Some(copy) = &part.copy
                && copy.drawn_to
                && (part.side == TargetSide::Color || self.desc.write_depth)
            {
                let back = blit::copy(api, copy.to, copy.from, mask(part.side, part.facts.internal), size);
                outcome = outcome.and(back);
            }
            if let Some(parameters) = &part.parameters {
                parameters.give_back(api);
            }
        }
        outcome
    }

    /// Iterates over the host's images in this target.
    pub(super) fn images(&self) -> impl Iterator<Item = GlImage> {
        self.parts.iter().map(|part| part.image)
    }
}

/// Returns the buffer bits that a copy of an image carries.
pub(super) fn mask(side: TargetSide, internal: u32) -> u32 {
    match side {
        TargetSide::Color | TargetSide::Mask | TargetSide::Classes | TargetSide::Normals => COLOR_BUFFER_BIT,
        TargetSide::Depth if formats::has_stencil(internal) => DEPTH_BUFFER_BIT | STENCIL_BUFFER_BIT,
        TargetSide::Depth => DEPTH_BUFFER_BIT,
    }
}
