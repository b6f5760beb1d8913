//! Building of targets: the framebuffers and copies that a target needs, and the wgpu textures for the host's images.

use std::num::NonZeroU32;
use std::sync::Arc;

use wgpu::hal::{MemoryFlags, api::Gles, gles};

use super::{
    api::Api,
    blit::{self, BlitEnd},
    formats,
    image::{self, Ask, Facts, GlImage, Parameters, target_of},
    names::*,
    object::GlObject,
    side::TargetSide,
    target::{Copied, Entry, GlTarget, GlTargetDesc, Multisample, TargetImage, TargetObjects, mask},
};
use crate::error::{Error, Result, Status};

/// Context and device with which targets are built.
pub(super) struct TargetBuilder<'a> {
    pub(super) ask: Ask<'a>,
    pub(super) device: &'a wgpu::Device,
    /// Whether the host forces tier 0: the device then draws as on OpenGL 3.3 or OpenGL ES 3.0.
    pub(super) tier0: bool,
}

/// Image attached to one of Welkin's framebuffers.
#[derive(Clone, Copy)]
struct Attachment {
    side: TargetSide,
    object: GlObject,
    /// Internal format.
    internal: u32,
}

const ATTACH: wgpu::TextureUsages = wgpu::TextureUsages::RENDER_ATTACHMENT;
const READ: wgpu::TextureUsages = wgpu::TextureUsages::TEXTURE_BINDING;
const COPIES: wgpu::TextureUsages = wgpu::TextureUsages::COPY_SRC.union(wgpu::TextureUsages::COPY_DST);

impl TargetImage {
    /// Returns wgpu's format for the image.
    fn format(&self) -> Result<wgpu::TextureFormat> {
        formats::format(self.facts.internal, self.side)
    }

    /// Returns the object that Welkin draws to.
    fn attached(&self, samples: u32) -> GlObject {
        match (self.image, &self.copy) {
            (_, Some(copy)) if copy.drawn_to => GlObject::Texture(copy.texture, target_of(samples)),
            (GlImage::Texture { name, target }, _) => GlObject::Texture(name, target),
            (GlImage::Renderbuffer { name }, _) => GlObject::Renderbuffer(name),
            (GlImage::Framebuffer { name }, _) => GlObject::Framebuffer(name),
        }
    }

    /// Returns the attachment of `object`, which is this image or Welkin's copy of it.
    fn attachment(&self, object: GlObject) -> Attachment {
        Attachment { side: self.side, object, internal: self.facts.internal }
    }

    /// Returns the object that shaders read, if there is one.
    fn readable(&self, samples: u32) -> Option<GlObject> {
        match (self.image, &self.copy) {
            (_, Some(copy)) => Some(GlObject::Texture(copy.texture, target_of(samples))),
            (GlImage::Texture { name, target }, None) => Some(GlObject::Texture(name, target)),
            _ => None,
        }
    }
}

impl TargetBuilder<'_> {
    /// Builds a target for `desc`.
    ///
    /// # Errors
    /// An image that cannot be used; the message names the parameter.
    pub(super) fn build(&self, desc: GlTargetDesc, id: u64) -> Result<Entry> {
        let mut made = TargetObjects::default();
        match self.assemble(desc, id, &mut made) {
            Ok((target, parts)) => Ok(Entry { desc, target: Arc::new(target), used: id, parts, made }),
            Err(e) => {
                made.delete(self.ask.api);
                Err(e)
            }
        }
    }

    fn assemble(&self, desc: GlTargetDesc, id: u64, made: &mut TargetObjects) -> Result<(GlTarget, Vec<TargetImage>)> {
        if desc.depth == Some(desc.color) && !matches!(desc.color, GlImage::Framebuffer { .. }) {
            return self.only_depth(desc, id, made);
        }
        let mut parts = vec![self.part(desc, desc.color, TargetSide::Color)?];
        if let Some(image) = desc.depth {
            parts.push(self.part(desc, image, TargetSide::Depth)?);
        }
        let samples = parts[0].facts.samples;
        // If the picture has one sample, multisampled depth is copied to depth of one sample. OpenGL ES cannot do that.
        let resolved = samples == 1 && !self.ask.info.is_es();
        if let Some(other) = parts.iter().find(|p| p.facts.samples != samples && !resolved) {
            let accepted = format!("an image with as many samples as color, {samples}");
            return Err(Error::range("target.depth", &accepted, other.facts.samples));
        }
        let resolve = self.resolves(desc.multisample, samples)?;
        if desc.write_depth {
            check_written_back(&parts, resolve)?;
        }
        let read = |image: Option<GlImage>, side| image.map(|image| self.read_part(desc, image, side)).transpose();
        let mask_part = read(desc.mask, TargetSide::Mask)?;
        let classes_part = read(desc.surface_classes, TargetSide::Classes)?;
        let normals_part = read(desc.normals, TargetSide::Normals)?;
        let samples = if resolve { 1 } else { samples };
        for part in &mut parts {
            self.provide_copy(part, part.facts.samples > samples, samples, made)?;
        }
        // wgpu cannot attach multisampled textures: colour and depth together need a framebuffer of Welkin's.
        let attached = || parts.iter().map(|p| p.attachment(p.attached(samples)));
        let framebuffer = if attached().any(|a| a.object.is_multisampled_texture()) {
            Some(GlObject::Framebuffer(self.framebuffer(&attached().collect::<Vec<_>>(), made)?))
        } else {
            None
        };
        let (color, color_read) = self.color(&mut parts[0], samples, framebuffer, made)?;
        let (depth, depth_read) = match parts.get(1) {
            Some(part) => self.depth(part, samples, framebuffer)?,
            None => (None, None),
        };
        let mut wrap = |part: Option<TargetImage>| {
            let Some(part) = part else { return Ok(None) };
            let texture = self.wrap(part.attached(1), part.format()?, part.facts, 1, READ)?;
            parts.push(part);
            Ok(Some(texture))
        };
        let (mask, surface_classes, normals) = (wrap(mask_part)?, wrap(classes_part)?, wrap(normals_part)?);
        let target = GlTarget { id, color, color_read, depth, depth_read, mask, surface_classes, normals, samples };
        Ok((target, parts))
    }

    /// Builds a target that is only read: its depth texture also serves as its colour texture.
    fn only_depth(
        &self,
        desc: GlTargetDesc,
        id: u64,
        made: &mut TargetObjects,
    ) -> Result<(GlTarget, Vec<TargetImage>)> {
        let mut part = self.part(desc, desc.color, TargetSide::Depth)?;
        if part.facts.samples != 1 {
            return Err(Error::range("target.depth", "an image of one sample", part.facts.samples));
        }
        self.provide_copy(&mut part, false, 1, made)?;
        let object = part
            .readable(1)
            .ok_or_else(|| Error::about(Status::Unsupported, "target.depth", "must be an image that can be read"))?;
        let texture = self.wrap(object, part.format()?, part.facts, 1, READ)?;
        let target = GlTarget {
            id,
            color: texture.clone(),
            color_read: None,
            depth: None,
            depth_read: Some(texture),
            mask: None,
            surface_classes: None,
            normals: None,
            samples: 1,
        };
        Ok((target, vec![part]))
    }

    /// Queries an image that is only read: mask, classes or normals.
    fn read_part(&self, desc: GlTargetDesc, image: GlImage, side: TargetSide) -> Result<TargetImage> {
        if !matches!(image, GlImage::Texture { target: TEXTURE_2D, .. }) {
            let rest = "must be a texture of target GL_TEXTURE_2D";
            return Err(Error::about(Status::Unsupported, side.parameter(), rest));
        }
        self.part(desc, image, side)
    }

    /// Whether multisampled images are copied to images of one sample.
    ///
    /// # Errors
    /// [`Status::Unsupported`] for multisampled images on OpenGL ES, and for [`Multisample::Each`] before OpenGL 4.0 or
    /// on a forced tier 0.
    fn resolves(&self, multisample: Multisample, samples: u32) -> Result<bool> {
        let es = self.ask.info.is_es();
        match multisample {
            _ if samples == 1 => Ok(false),
            // On OpenGL ES wgpu's shaders for samples do not compile: its translator takes gl_SampleID for unsigned,
            // and only GLSL 4.00 converts it implicitly. OpenGL ES cannot copy to multisampled images either.
            _ if es => {
                let rest = format!("must have 1 sample on OpenGL ES, got {samples}: resolve it before this call");
                Err(Error::about(Status::Unsupported, "target.color", rest))
            }
            Multisample::Each if self.tier0 || !self.ask.info.at_least((4, 0), (4, 0)) => {
                let rest = format!(
                    "must be resolve before OpenGL 4.0 and on tier 0, whose shaders cannot run per sample, for an image \
                     with {samples} samples"
                );
                Err(Error::about(Status::Unsupported, "target.multisample", rest))
            }
            Multisample::Each => Ok(false),
            Multisample::Resolve => Ok(true),
        }
    }

    /// Queries one image, and checks its size, samples and format.
    fn part(&self, desc: GlTargetDesc, image: GlImage, side: TargetSide) -> Result<TargetImage> {
        let size = (desc.width, desc.height);
        if let (TargetSide::Depth, GlImage::Framebuffer { .. }) = (side, image)
            && image != desc.color
        {
            return Err(Error::invalid("target.depth", "must be the same framebuffer as color where it is one"));
        }
        let facts = image::facts(self.ask, image, side, size)?;
        if (facts.width, facts.height) != size || size.0 == 0 || size.1 == 0 {
            let (w, h) = (facts.width, facts.height);
            let field = if size.0 == w && w > 0 { "target.height" } else { "target.width" };
            let accepted = format!("of the size of the {} image, {w} x {h}", side.noun());
            return Err(Error::range(field, &accepted, format!("{} x {}", size.0, size.1)));
        }
        let most = self.device.limits().max_texture_dimension_2d;
        if size.0.max(size.1) > most {
            let field = if size.0 > most { "target.width" } else { "target.height" };
            return Err(Error::range(field, &format!("at most {most}"), size.0.max(size.1)));
        }
        if !matches!(facts.samples, 1 | 2 | 4 | 8 | 16) {
            return Err(Error::range(side.parameter(), "an image with 1, 2, 4, 8 or 16 samples", facts.samples));
        }
        formats::format(facts.internal, side)?;
        let parameters = match image {
            GlImage::Texture { name, target } => Some(Parameters::new(self.ask.info, name, target, side)),
            _ => None,
        };
        Ok(TargetImage { side, image, facts, parameters, copy: None, reading: None })
    }

    /// Creates the copy that an image needs, if it needs one, with the framebuffers at both ends of the copy. `resolve`
    /// says that the image has more samples than `samples`, those of the copy.
    fn provide_copy(
        &self,
        part: &mut TargetImage,
        resolve: bool,
        samples: u32,
        made: &mut TargetObjects,
    ) -> Result<()> {
        let drawn_to = resolve || matches!(part.image, GlImage::Framebuffer { .. });
        // wgpu can read only textures, and depth is always read.
        let read = part.side == TargetSide::Depth && matches!(part.image, GlImage::Renderbuffer { .. });
        if !drawn_to && !read {
            return Ok(());
        }
        let source = match part.image {
            GlImage::Framebuffer { name } => BlitEnd { framebuffer: name, hosts: true },
            GlImage::Texture { name, target } => self.end(part.attachment(GlObject::Texture(name, target)), made)?,
            GlImage::Renderbuffer { name } => self.end(part.attachment(GlObject::Renderbuffer(name)), made)?,
        };
        // Only the number of bits of a window's depth is known, and drivers differ in the depth formats to which they
        // copy it, so several formats are tried. A copy of colour converts between formats.
        let others: &[u32] = match (part.image, part.side) {
            (GlImage::Framebuffer { .. }, TargetSide::Depth) => {
                &[DEPTH24_STENCIL8, DEPTH_COMPONENT24, DEPTH_COMPONENT32F, DEPTH32F_STENCIL8, DEPTH_COMPONENT16]
            }
            _ => &[],
        };
        let size = (part.facts.width, part.facts.height);
        let mut outcome = Ok(());
        for internal in std::iter::once(part.facts.internal).chain(others.iter().copied()) {
            let texture = self.storage(part.side, internal, size, samples, made)?;
            let object = GlObject::Texture(texture, target_of(samples));
            let destination = self.end(Attachment { side: part.side, object, internal }, made)?;
            outcome = blit::copy(self.ask.api, source, destination, mask(part.side, internal), size);
            if outcome.is_ok() {
                part.copy = Some(Copied { from: source, to: destination, texture, drawn_to });
                break;
            }
        }
        outcome
    }

    /// Creates a texture of Welkin's for the copy of one of the host's images.
    fn storage(
        &self,
        side: TargetSide,
        internal: u32,
        size: (u32, u32),
        samples: u32,
        made: &mut TargetObjects,
    ) -> Result<u32> {
        let api = self.ask.api;
        api.take_error();
        let texture = image::make_texture(api, internal, size, samples);
        made.textures.push(texture);
        let error = api.take_error();
        if error == NO_ERROR { Ok(texture) } else { Err(refused(side, internal, "copy", error)) }
    }

    fn end(&self, attachment: Attachment, made: &mut TargetObjects) -> Result<BlitEnd> {
        Ok(BlitEnd { framebuffer: self.framebuffer(&[attachment], made)?, hosts: false })
    }

    /// Creates a framebuffer with the given images.
    fn framebuffer(&self, attachments: &[Attachment], made: &mut TargetObjects) -> Result<u32> {
        let api = self.ask.api;
        let framebuffer = api.one(Api::GenFramebuffers);
        made.framebuffers.push(framebuffer);
        api.BindFramebuffer(FRAMEBUFFER, framebuffer);
        for Attachment { side, object, internal } in attachments {
            let attachment = match side {
                TargetSide::Color | TargetSide::Mask | TargetSide::Classes | TargetSide::Normals => COLOR_ATTACHMENT0,
                TargetSide::Depth if formats::has_stencil(*internal) => DEPTH_STENCIL_ATTACHMENT,
                TargetSide::Depth => DEPTH_ATTACHMENT,
            };
            object.attach(api, attachment);
            made.attached.push((framebuffer, attachment, *object));
        }
        if attachments.iter().all(|a| a.side == TargetSide::Depth) {
            let none = NONE;
            // SAFETY: one value is passed.
            unsafe { api.DrawBuffers(1, &none) };
            api.ReadBuffer(NONE);
        }
        let status = api.CheckFramebufferStatus(FRAMEBUFFER);
        api.BindFramebuffer(FRAMEBUFFER, 0);
        let error = api.take_error();
        if status == FRAMEBUFFER_COMPLETE && error == NO_ERROR {
            return Ok(framebuffer);
        }
        let Attachment { side, internal, .. } = attachments[0];
        Err(refused(side, internal, "draw to", if error == NO_ERROR { status } else { error }))
    }

    /// Creates wgpu textures for the picture: one to draw to and, if wgpu cannot copy that, one to read.
    fn color(
        &self,
        part: &mut TargetImage,
        samples: u32,
        framebuffer: Option<GlObject>,
        made: &mut TargetObjects,
    ) -> Result<(wgpu::Texture, Option<wgpu::Texture>)> {
        let format = part.format()?;
        let object = part.attached(samples);
        if framebuffer.is_none() {
            self.check_attachable(part, object)?;
        }
        if let (GlObject::Texture(..), None) = (object, framebuffer) {
            return Ok((self.wrap(object, format, part.facts, samples, ATTACH | READ | COPIES)?, None));
        }
        let internal = part.facts.internal;
        let source = self.end(Attachment { side: TargetSide::Color, object, internal }, made)?;
        let size = (part.facts.width, part.facts.height);
        let texture = self.storage(TargetSide::Color, internal, size, samples, made)?;
        let ours = GlObject::Texture(texture, target_of(samples));
        let destination = self.end(Attachment { side: TargetSide::Color, object: ours, internal }, made)?;
        part.reading = Some(Copied { from: source, to: destination, texture, drawn_to: false });
        let read = self.wrap(ours, format, part.facts, samples, READ)?;
        let color = self.wrap(framebuffer.unwrap_or(object), format, part.facts, samples, ATTACH)?;
        Ok((color, Some(read)))
    }

    /// Creates wgpu textures for depth: one to attach and one to read. There are two even if both refer to one object,
    /// because wgpu refuses to read a texture that is attached.
    fn depth(
        &self,
        part: &TargetImage,
        samples: u32,
        framebuffer: Option<GlObject>,
    ) -> Result<(Option<wgpu::Texture>, Option<wgpu::Texture>)> {
        let format = part.format()?;
        let object = part.attached(samples);
        if framebuffer.is_none() {
            self.check_attachable(part, object)?;
        }
        let read = part.readable(samples).map(|o| self.wrap(o, format, part.facts, samples, READ)).transpose()?;
        let depth = self.wrap(framebuffer.unwrap_or(object), format, part.facts, samples, ATTACH)?;
        Ok((Some(depth), read))
    }

    /// Checks that the driver can draw to the object that wgpu will attach.
    fn check_attachable(&self, part: &TargetImage, object: GlObject) -> Result<()> {
        let mut probe = TargetObjects::default();
        let outcome = self.framebuffer(&[part.attachment(object)], &mut probe);
        probe.delete(self.ask.api);
        outcome.map(|_| ())
    }

    /// Creates a wgpu texture that refers to an OpenGL object without owning it.
    fn wrap(
        &self,
        object: GlObject,
        format: wgpu::TextureFormat,
        facts: Facts,
        samples: u32,
        usage: wgpu::TextureUsages,
    ) -> Result<wgpu::Texture> {
        let size = wgpu::Extent3d { width: facts.width, height: facts.height, depth_or_array_layers: 1 };
        let uses = first_use(format, usage);
        let desc = wgpu::hal::TextureDescriptor {
            label: None,
            size,
            mip_level_count: 1,
            sample_count: samples,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: uses,
            memory_flags: MemoryFlags::empty(),
            view_formats: Vec::new(),
        };
        let name = NonZeroU32::new(object.name());
        // SAFETY: only the backend's own functions are called on the guard.
        let hal_device = unsafe { self.device.as_hal::<Gles>() };
        let (Some(name), Some(hal_device)) = (name, hal_device) else {
            return Err(Error::new(Status::Internal, "an OpenGL image without name or device"));
        };
        // A drop callback tells wgpu that it does not own the object, so wgpu never deletes the object.
        let keep: Option<wgpu::hal::DropCallback> = Some(Box::new(|| {}));
        // SAFETY: the name is alive and has this format and size, as OpenGL has just reported. The target is corrected
        // for multisampled textures, which the backend does not know.
        let texture = unsafe {
            match object {
                GlObject::Renderbuffer(_) => hal_device.texture_from_raw_renderbuffer(name, &desc, keep),
                GlObject::Texture(_, target) => {
                    let mut texture = hal_device.texture_from_raw(name, &desc, keep);
                    if let gles::TextureInner::Texture { target: t, .. } = &mut texture.inner {
                        *t = target;
                    }
                    texture
                }
                GlObject::Framebuffer(_) => {
                    let mut texture = hal_device.texture_from_raw(name, &desc, keep);
                    let inner = glow::NativeFramebuffer(name);
                    texture.inner = gles::TextureInner::ExternalNativeFramebuffer { inner };
                    texture
                }
            }
        };
        drop(hal_device);
        let desc = wgpu::TextureDescriptor {
            label: Some("host image"),
            size,
            mip_level_count: 1,
            sample_count: samples,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        };
        // SAFETY: this device made the texture, and the texture matches the description and holds the host's pixels.
        Ok(unsafe { self.device.create_texture_from_hal::<Gles>(texture, &desc, uses) })
    }
}

/// Checks that depth which is written keeps its samples: with fewer samples the samples' own depths would be lost.
fn check_written_back(parts: &[TargetImage], resolve: bool) -> Result<()> {
    if resolve {
        let rest = "must be each where depth is written: of the depths of a pixel's samples only one would be left";
        return Err(Error::about(Status::Unsupported, "target.multisample", rest));
    }
    let samples = parts[0].facts.samples;
    match parts.get(1).filter(|depth| depth.facts.samples != samples) {
        Some(depth) => {
            let accepted = format!("an image with as many samples as color, {samples}, where it is written");
            Err(Error::range("target.depth", &accepted, depth.facts.samples))
        }
        None => Ok(()),
    }
}

/// Returns the error for an image that this context refuses. The message names a format that always works.
fn refused(side: TargetSide, internal: u32, verb: &str, answer: u32) -> Error {
    let parameter = side.parameter();
    let (internal, answer_text) = (spell(internal), spell(answer));
    if answer == OUT_OF_MEMORY {
        let text = format!("there is no memory to {verb} {parameter}, an image of {internal}");
        return Error::new(Status::OutOfMemory, text);
    }
    let serves = if side == TargetSide::Depth { "GL_DEPTH_COMPONENT24" } else { "GL_RGBA8" };
    let rest = format!(
        "must be an image that this context can {verb} ({serves} always is one), {internal} gives {answer_text}"
    );
    Error::about(Status::Unsupported, parameter, rest)
}

/// Returns the state in which wgpu first finds a texture; the usage must allow this state.
fn first_use(format: wgpu::TextureFormat, usage: wgpu::TextureUsages) -> wgpu::TextureUses {
    if !usage.contains(ATTACH) {
        wgpu::TextureUses::RESOURCE
    } else if format.is_depth_stencil_format() {
        wgpu::TextureUses::DEPTH_STENCIL_WRITE
    } else {
        wgpu::TextureUses::COLOR_TARGET
    }
}
