//! Host's images: the properties that OpenGL reports of them, and their parameters while wgpu reads them.

use super::{
    api::Api,
    check::{GlInfo, GlProfile},
    formats::{self, Bits},
    names::*,
    side::TargetSide,
};
use crate::error::{Error, Result, Status};

/// One image of the host, by its OpenGL name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GlImage {
    /// A texture; level 0 is used.
    Texture {
        /// Name from `glGenTextures`.
        name: u32,
        /// `GL_TEXTURE_2D` or `GL_TEXTURE_2D_MULTISAMPLE`.
        target: u32,
    },
    /// A renderbuffer.
    Renderbuffer {
        /// Name from `glGenRenderbuffers`.
        name: u32,
    },
    /// Image that framebuffer `name` draws to; name 0 is the window's framebuffer. It can be used only in the host's
    /// own context, because framebuffers are not shared between contexts. The image is copied in and out.
    Framebuffer {
        /// Name from `glGenFramebuffers`, or 0.
        name: u32,
    },
}

/// Returns the OpenGL target of a texture of Welkin's with this number of samples.
pub(super) fn target_of(samples: u32) -> u32 {
    if samples > 1 { TEXTURE_2D_MULTISAMPLE } else { TEXTURE_2D }
}

/// Properties that OpenGL reports of an image. Queried at every use, because a host may allocate an object anew under
/// its old name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Facts {
    pub(super) width: u32,
    pub(super) height: u32,
    /// Sized internal format.
    pub(super) internal: u32,
    /// 1 for images without multisampling.
    pub(super) samples: u32,
}

/// Inputs of queries about images.
#[derive(Clone, Copy)]
pub(super) struct Ask<'a> {
    pub(super) api: &'a Api,
    pub(super) info: &'a GlInfo,
    /// Welkin's framebuffer for queries, whose attachments are changed.
    pub(super) scratch: u32,
    /// Whether the host draws linear colours to framebuffers that encode them (`GL_FRAMEBUFFER_SRGB`).
    pub(super) encodes: bool,
}

/// Queries `image`. `size` is used for an image whose size OpenGL cannot be asked for: a window's framebuffer, a
/// texture on OpenGL ES before 3.1, and a layer of an array texture or a face of a cube map in a framebuffer.
///
/// # Errors
/// [`Status::InvalidArgument`] if there is no such object, if it was made with another target, or if it lacks storage
/// or the requested buffer; [`Status::Unsupported`] if its target or format cannot be used. The message names the
/// parameter.
pub(super) fn facts(ask: Ask<'_>, image: GlImage, side: TargetSide, size: (u32, u32)) -> Result<Facts> {
    ask.api.take_error(); // so that only errors of the calls below count
    match image {
        GlImage::Texture { name, target } => texture_facts(ask, name, target, side, size),
        GlImage::Renderbuffer { name } => renderbuffer_facts(ask.api, name, side),
        GlImage::Framebuffer { name } => framebuffer_facts(ask, name, side, size),
    }
}

/// Returns the error for a name without an object.
fn dead(side: TargetSide, kind: &str, name: u32) -> Error {
    let accepted = format!("the name of a {kind} of the host's context or its share group");
    Error::range(side.parameter(), &accepted, name)
}

/// Queries a texture.
fn texture_facts(ask: Ask<'_>, name: u32, target: u32, side: TargetSide, size: (u32, u32)) -> Result<Facts> {
    let Ask { api, info, scratch, .. } = ask;
    let multisample = target == TEXTURE_2D_MULTISAMPLE;
    if target != TEXTURE_2D && !(multisample && info.at_least((3, 2), (3, 1))) {
        let or = if info.at_least((3, 2), (3, 1)) { " or GL_TEXTURE_2D_MULTISAMPLE" } else { "" };
        let rest = format!("must be GL_TEXTURE_2D{or}, got {}", spell(target));
        return Err(Error::about(Status::Unsupported, format!("{}.target", side.parameter()), rest));
    }
    if api.IsTexture(name) == 0 {
        return Err(dead(side, "texture", name));
    }
    api.BindTexture(target, name);
    if api.take_error() != NO_ERROR {
        let accepted = format!("the target that texture {name} was made with");
        return Err(Error::range(&format!("{}.target", side.parameter()), &accepted, spell(target)));
    }
    let level = |pname| {
        let mut value = 0;
        // SAFETY: level parameters are one integer each.
        unsafe { api.GetTexLevelParameteriv(target, 0, pname, &mut value) };
        value as u32
    };
    let can_ask = info.at_least((1, 0), (3, 1));
    let (width, height) = if can_ask { (level(TEXTURE_WIDTH), level(TEXTURE_HEIGHT)) } else { size };
    let samples = if multisample { level(TEXTURE_SAMPLES).max(1) } else { 1 };
    let named = if can_ask { level(TEXTURE_INTERNAL_FORMAT) } else { RGBA };
    if can_ask && (width == 0 || height == 0) {
        let rest = format!("must be a texture with storage at level 0, texture {name} has none");
        return Err(Error::invalid(side.parameter(), rest));
    }
    let internal = match named {
        // The format is not a sized name, so the driver chose the bits. They are queried.
        1..=4 | RGB | RGBA | RED | DEPTH_COMPONENT | DEPTH_STENCIL | 0x8C40 | 0x8C42 => {
            let bits = attached_bits(api, name, target, side, scratch);
            sized(bits, side)?
        }
        sized => sized,
    };
    Ok(Facts { width, height, internal, samples })
}

/// Attaches the texture to `scratch` and queries its bits.
fn attached_bits(api: &Api, name: u32, target: u32, side: TargetSide, scratch: u32) -> Bits {
    let attachment = if side == TargetSide::Depth { DEPTH_ATTACHMENT } else { COLOR_ATTACHMENT0 };
    api.BindFramebuffer(READ_FRAMEBUFFER, scratch);
    api.FramebufferTexture2D(READ_FRAMEBUFFER, attachment, target, name, 0);
    let bits = count_bits(api, READ_FRAMEBUFFER, attachment, side);
    api.FramebufferTexture2D(READ_FRAMEBUFFER, attachment, target, 0, 0);
    api.BindFramebuffer(READ_FRAMEBUFFER, 0);
    api.take_error();
    bits
}

/// Queries the bits of a framebuffer's attachment.
fn count_bits(api: &Api, framebuffer: u32, attachment: u32, side: TargetSide) -> Bits {
    let get = |pname| {
        let mut value = 0;
        // SAFETY: attachment parameters are one integer each.
        unsafe { api.GetFramebufferAttachmentParameteriv(framebuffer, attachment, pname, &mut value) };
        value
    };
    if get(FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) == 0 {
        return Bits::default();
    }
    let component = get(FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE) as u32;
    match side {
        TargetSide::Color | TargetSide::Mask | TargetSide::Classes | TargetSide::Normals => Bits {
            red: get(FRAMEBUFFER_ATTACHMENT_RED_SIZE),
            green: get(FRAMEBUFFER_ATTACHMENT_GREEN_SIZE),
            alpha: get(FRAMEBUFFER_ATTACHMENT_ALPHA_SIZE),
            srgb: get(FRAMEBUFFER_ATTACHMENT_COLOR_ENCODING) as u32 == SRGB,
            component,
            ..Bits::default()
        },
        TargetSide::Depth => Bits {
            depth: get(FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE),
            stencil: stencil_bits(api, framebuffer, attachment),
            component,
            ..Bits::default()
        },
    }
}

/// Returns the stencil bits of the attachment that goes with `depth_attachment`.
fn stencil_bits(api: &Api, framebuffer: u32, depth_attachment: u32) -> i32 {
    let attachment = if depth_attachment == DEPTH { 0x1802 } else { STENCIL_ATTACHMENT };
    let mut found = [0; 2];
    // SAFETY: attachment parameters are one integer each.
    unsafe {
        api.GetFramebufferAttachmentParameteriv(
            framebuffer,
            attachment,
            FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE,
            &mut found[0],
        );
        if found[0] != 0 {
            let size = FRAMEBUFFER_ATTACHMENT_STENCIL_SIZE;
            api.GetFramebufferAttachmentParameteriv(framebuffer, attachment, size, &mut found[1]);
        }
    }
    found[1]
}

/// Returns the sized format with these bits.
fn sized(bits: Bits, side: TargetSide) -> Result<u32> {
    let found = if side == TargetSide::Depth { bits.depth() } else { bits.color() };
    found.ok_or_else(|| {
        let rest = format!(
            "must have a format that can be drawn to and has a name, got {} red, {} alpha, {} depth and {} stencil bits",
            bits.red, bits.alpha, bits.depth, bits.stencil
        );
        Error::about(Status::Unsupported, side.parameter(), rest)
    })
}

/// Queries a renderbuffer.
fn renderbuffer_facts(api: &Api, name: u32, side: TargetSide) -> Result<Facts> {
    if api.IsRenderbuffer(name) == 0 {
        return Err(dead(side, "renderbuffer", name));
    }
    api.BindRenderbuffer(RENDERBUFFER, name);
    let get = |pname| {
        let mut value = 0;
        // SAFETY: renderbuffer parameters are one integer each.
        unsafe { api.GetRenderbufferParameteriv(RENDERBUFFER, pname, &mut value) };
        value as u32
    };
    let facts = Facts {
        width: get(RENDERBUFFER_WIDTH),
        height: get(RENDERBUFFER_HEIGHT),
        internal: match get(RENDERBUFFER_INTERNAL_FORMAT) {
            RGBA => RGBA8,
            RGB => RGB8,
            other => other,
        },
        samples: get(RENDERBUFFER_SAMPLES).max(1),
    };
    api.BindRenderbuffer(RENDERBUFFER, 0);
    Ok(facts)
}

/// Queries the image that a framebuffer draws to.
fn framebuffer_facts(ask: Ask<'_>, name: u32, side: TargetSide, size: (u32, u32)) -> Result<Facts> {
    let Ask { api, info, .. } = ask;
    api.BindFramebuffer(FRAMEBUFFER, name);
    if api.take_error() != NO_ERROR {
        return Err(dead(side, "framebuffer", name));
    }
    let status = api.CheckFramebufferStatus(DRAW_FRAMEBUFFER);
    if status != FRAMEBUFFER_COMPLETE {
        let rest = format!("must be a complete framebuffer, framebuffer {name} is {}", spell(status));
        return Err(Error::invalid(side.parameter(), rest));
    }
    let attachment = match (side, name) {
        (TargetSide::Color | TargetSide::Mask | TargetSide::Classes | TargetSide::Normals, _) => {
            match api.uint(DRAW_BUFFER0) {
                NONE => {
                    let rest = format!("must draw to a colour buffer, framebuffer {name} has GL_NONE");
                    return Err(Error::invalid(side.parameter(), rest));
                }
                // In queries of attachments, desktop OpenGL takes a single buffer of the window (GL_BACK_LEFT), OpenGL
                // ES takes GL_BACK.
                BACK if !info.is_es() => BACK_LEFT,
                FRONT | 0x0406 if !info.is_es() => FRONT_LEFT,
                other => other,
            }
        }
        (TargetSide::Depth, 0) => DEPTH,
        (TargetSide::Depth, _) => DEPTH_ATTACHMENT,
    };
    let mut bits = count_bits(api, DRAW_FRAMEBUFFER, attachment, side);
    // With GL_FRAMEBUFFER_SRGB off, a framebuffer that can encode holds values that the host encoded itself.
    bits.srgb &= ask.encodes;
    let samples = api.uint(SAMPLES).max(1);
    let attached_size = if name == 0 { None } else { attached_size(ask, attachment, samples) };
    api.BindFramebuffer(FRAMEBUFFER, 0);
    api.take_error();
    if side == TargetSide::Depth && bits.depth == 0 {
        let rest = format!("must name a framebuffer that has depth, framebuffer {name} has none");
        return Err(Error::invalid(side.parameter(), rest));
    }
    let (width, height) = attached_size.unwrap_or(size);
    Ok(Facts { width, height, internal: sized(bits, side)?, samples })
}

/// Returns the size of the image attached to the bound framebuffer, where OpenGL reports it.
fn attached_size(ask: Ask<'_>, attachment: u32, samples: u32) -> Option<(u32, u32)> {
    let api = ask.api;
    let get = |pname| {
        let mut value = 0;
        // SAFETY: attachment parameters are one integer each.
        unsafe { api.GetFramebufferAttachmentParameteriv(DRAW_FRAMEBUFFER, attachment, pname, &mut value) };
        value
    };
    let name = get(FRAMEBUFFER_ATTACHMENT_OBJECT_NAME) as u32;
    if get(FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) as u32 == RENDERBUFFER {
        return renderbuffer_facts(api, name, TargetSide::Color).ok().map(|f| (f.width, f.height));
    }
    if !ask.info.at_least((1, 0), (3, 1)) {
        return None;
    }
    let (target, level) = (target_of(samples), get(FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL));
    let was = api.uint(if samples > 1 { TEXTURE_BINDING_2D_MULTISAMPLE } else { TEXTURE_BINDING_2D });
    api.BindTexture(target, name);
    // Layers of arrays and faces of cube maps have other targets, so this binding fails for them.
    let size = (api.take_error() == NO_ERROR).then(|| {
        [TEXTURE_WIDTH, TEXTURE_HEIGHT].map(|pname| {
            let mut value = 0;
            // SAFETY: level parameters are one integer each.
            unsafe { api.GetTexLevelParameteriv(target, level, pname, &mut value) };
            value as u32
        })
    });
    api.BindTexture(target, was);
    size.map(|[w, h]| (w, h)).filter(|s| s.0 > 0 && s.1 > 0)
}

/// Texture parameters that change what wgpu reads from a texture. wgpu's backend sets some of them and restores none.
/// They belong to the object, so the host would see the change even across contexts.
#[derive(Clone, Debug)]
pub(super) struct Parameters {
    name: u32,
    target: u32,
    /// (parameter, value that wgpu assumes, the host's value)
    list: Vec<(u32, i32, i32)>,
}

impl Parameters {
    pub(super) fn new(info: &GlInfo, name: u32, target: u32, side: TargetSide) -> Self {
        let mut list = vec![(TEXTURE_BASE_LEVEL, 0), (TEXTURE_MAX_LEVEL, 0)];
        let swizzles = [TEXTURE_SWIZZLE_R, TEXTURE_SWIZZLE_G, TEXTURE_SWIZZLE_B, TEXTURE_SWIZZLE_A];
        list.extend(swizzles.into_iter().zip([RED, GREEN, BLUE, ALPHA].map(|v| v as i32)));
        if target == TEXTURE_2D {
            // With filtering, OpenGL ES takes a depth texture for incomplete and reads it as 0.
            list.extend([(TEXTURE_MIN_FILTER, NEAREST as i32), (TEXTURE_MAG_FILTER, NEAREST as i32)]);
            list.push((TEXTURE_COMPARE_MODE, NONE as i32));
            if info.has("GL_EXT_texture_sRGB_decode") {
                list.push((TEXTURE_SRGB_DECODE_EXT, DECODE_EXT as i32));
            }
        }
        if side == TargetSide::Depth && info.knows((4, 3), (3, 1), &["GL_ARB_stencil_texturing"]) {
            list.push((DEPTH_STENCIL_TEXTURE_MODE, DEPTH_COMPONENT as i32));
        }
        if side == TargetSide::Depth && info.profile == GlProfile::Compatibility {
            list.push((DEPTH_TEXTURE_MODE, RED as i32));
        }
        Self { name, target, list: list.into_iter().map(|(p, fresh)| (p, fresh, fresh)).collect() }
    }

    /// Reads the host's values and sets those that wgpu assumes.
    pub(super) fn take(&mut self, api: &Api) {
        api.BindTexture(self.target, self.name);
        for (pname, fresh, was) in &mut self.list {
            // SAFETY: each of these parameters is one integer.
            unsafe { api.GetTexParameteriv(self.target, *pname, was) };
            if was != fresh {
                api.TexParameteri(self.target, *pname, *fresh);
            }
        }
    }

    /// Restores the host's values.
    pub(super) fn give_back(&self, api: &Api) {
        api.BindTexture(self.target, self.name);
        for (pname, _, was) in &self.list {
            api.TexParameteri(self.target, *pname, *was);
        }
    }
}

/// Creates a texture with storage for level 0; multisampled if `samples` is more than 1.
pub(super) fn make_texture(api: &Api, internal: u32, (width, height): (u32, u32), samples: u32) -> u32 {
    let name = api.one(Api::GenTextures);
    let (w, h) = (width as i32, height as i32);
    let target = target_of(samples);
    api.BindTexture(target, name);
    if samples > 1 {
        api.TexImage2DMultisample(target, samples as i32, internal, w, h, 1);
    } else {
        let (format, ty) = formats::allocation(internal);
        // SAFETY: NULL data allocates without reading.
        unsafe { api.TexImage2D(target, 0, internal as i32, w, h, 0, format, ty, std::ptr::null()) };
        api.TexParameteri(target, TEXTURE_MIN_FILTER, NEAREST as i32);
        api.TexParameteri(target, TEXTURE_MAG_FILTER, NEAREST as i32);
        api.TexParameteri(target, TEXTURE_MAX_LEVEL, 0);
    }
    api.BindTexture(target, 0);
    name
}
