//! A host's colour and depth as wgpu textures.
//!
//! | host's image                      | colour                                          | depth                       |
//! |-----------------------------------|-------------------------------------------------|-----------------------------|
//! | texture                           | drawn to and copied directly                    | read and attached directly  |
//! | multisampled texture              | drawn to through a framebuffer of ours          | read directly, attached so  |
//! | renderbuffer                      | drawn to directly                               | attached directly           |
//! | framebuffer (the window's or any) | copied in, drawn to, copied back                | copied in (back, if asked)  |
//!
//! wgpu can neither read renderbuffers nor copy multisampled images on OpenGL: there we copy. Depth each time the
//! target is asked for, so that it can be read as it is at that moment; colour before each draw that reads it.
//!
//! No name of the host is ever deleted: each wgpu texture carries a drop callback, which tells wgpu that it does not
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
    /// The wgpu textures have the host's samples: Welkin draws and reads depth per sample. From OpenGL 4.0 on; not on
    /// OpenGL ES nor on a forced tier 0.
    #[default]
    Each,
    /// The wgpu textures have one sample: colour comes in averaged and goes back to every sample alike, depth is that
    /// of one sample. Not on OpenGL ES.
    Resolve,
}

/// Images that a host asks Welkin to draw into.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct GlTargetDesc {
    /// The picture.
    pub color: GlImage,
    /// Its depth, if it has one.
    pub depth: Option<GlImage>,
    /// Where red is 1 the host's pixel stays: a texture of one sample, if there is one.
    pub mask: Option<GlImage>,
    /// Material of what each pixel shows: a texture of one sample, if there is one.
    pub surface_classes: Option<GlImage>,
    /// Normals of what each pixel shows: a texture of one sample, if there is one.
    pub normals: Option<GlImage>,
    /// Width in pixels; must be the images' own.
    pub width: u32,
    /// Height in pixels; must be the images' own.
    pub height: u32,
    /// A number the host raises when it makes an object anew under an old name.
    pub generation: u64,
    /// Treatment of multisampled images.
    pub multisample: Multisample,
    /// Whether depth may be written: what was copied in is copied back then.
    pub write_depth: bool,
}

/// A target as wgpu textures, valid while the host is entered.
///
/// Row 0 is the host's bottom row, as everywhere in OpenGL, and wgpu counts it as the top: see the room's page on what
/// is upside down.
#[derive(Debug)]
pub struct GlTarget {
    /// Changes whenever the textures do; for caches of views and bind groups.
    pub id: u64,
    /// Colour to draw to (`RENDER_ATTACHMENT`; `COPY_SRC` and `TEXTURE_BINDING` as well where `color_read` is `None`).
    pub color: wgpu::Texture,
    /// The picture to read (`TEXTURE_BINDING`), where wgpu cannot copy `color` itself;
    /// [`HostBinding::refresh`](crate::gpu::HostBinding::refresh) fills it, and
    /// [`View::record`](crate::frame::View::record) does.
    pub color_read: Option<wgpu::Texture>,
    /// Depth to attach.
    pub depth: Option<wgpu::Texture>,
    /// Depth to read, as an unfilterable float texture by `textureLoad`.
    pub depth_read: Option<wgpu::Texture>,
    /// The mask, to read.
    pub mask: Option<wgpu::Texture>,
    /// The classes, to read.
    pub surface_classes: Option<wgpu::Texture>,
    /// The normals, to read.
    pub normals: Option<wgpu::Texture>,
    /// Samples of colour and depth.
    pub samples: u32,
}

/// One side of a target, with what it takes to use it.
pub(super) struct TargetImage {
    pub(super) side: TargetSide,
    pub(super) image: GlImage,
    pub(super) facts: Facts,
    pub(super) parameters: Option<Parameters>,
    /// Copy that wgpu uses instead of the host's image.
    pub(super) copy: Option<Copied>,
    /// Copy that wgpu reads while it draws to colour that it cannot copy.
    pub(super) reading: Option<Copied>,
}

/// Our copy of an image.
pub(super) struct Copied {
    /// Framebuffer with the image: the host's own for [`GlImage::Framebuffer`].
    pub(super) from: BlitEnd,
    /// Framebuffer with our texture.
    pub(super) to: BlitEnd,
    /// Our texture.
    pub(super) texture: u32,
    /// Whether our texture is drawn to, and not the host's image: then it goes back.
    pub(super) drawn_to: bool,
}

/// A target in the cache, with the objects of ours that serve it.
pub(super) struct Entry {
    pub(super) desc: GlTargetDesc,
    pub(super) target: Arc<GlTarget>,
    pub(super) used: u64,
    pub(super) parts: Vec<TargetImage>,
    pub(super) made: TargetObjects,
}

/// Objects of ours that serve a target.
#[derive(Default)]
pub(super) struct TargetObjects {
    pub(super) framebuffers: Vec<u32>,
    pub(super) textures: Vec<u32>,
    /// Attachments that were made: framebuffer, attachment, image.
    pub(super) attached: Vec<(u32, u32, GlObject)>,
}

impl TargetObjects {
    /// Deletes them.
    pub(super) fn delete(&mut self, api: &Api) {
        self.framebuffers.drain(..).for_each(|name| api.delete(Api::DeleteFramebuffers, name));
        self.textures.drain(..).for_each(|name| api.delete(Api::DeleteTextures, name));
    }
}

impl Entry {
    /// Whether the host's objects are still what they were when this was built.
    ///
    /// # Errors
    /// As [`image::facts`].
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
        // Anew, or a framebuffer would hold on to an object that the host has deleted and made again under its name;
        // another context's changes are promised only then, too (OpenGL 4.6 core specification, section 5.3.3, rule 4).
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

    /// Copies the picture as it is now to where it is read.
    ///
    /// # Errors
    /// A refused copy.
    pub(super) fn read_again(&self, api: &Api) -> Result<()> {
        let size = (self.desc.width, self.desc.height);
        let copies = self.parts.iter().filter_map(|part| part.reading.as_ref());
        copies.into_iter().try_for_each(|copy| blit::copy(api, copy.from, copy.to, COLOR_BUFFER_BIT, size))
    }

    /// Copies anew what is only read, after something was drawn since [`Entry::begin`].
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

    /// Whether depth is read from a copy of what is attached.
    pub(super) fn reads_copied_depth(&self) -> bool {
        let is_copied = |part: &TargetImage| part.copy.as_ref().is_some_and(|copy| !copy.drawn_to);
        self.parts.iter().any(|part| part.side == TargetSide::Depth && is_copied(part))
    }

    /// Copies back what was drawn into copies and gives the host's objects back as they were.
    ///
    /// # Errors
    /// A refused copy; everything is given back all the same.
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

    /// The host's images in this target.
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
