//! Internal formats of OpenGL that a host's images may have, and wgpu's names for them.

use wgpu::TextureFormat as Format;

use super::{names::*, side::TargetSide};
use crate::error::{Error, Result, Status};

/// Colour formats that a host may hand over.
const COLOR: &[(u32, &str, Format)] = &[
    (RGBA8, "GL_RGBA8", Format::Rgba8Unorm),
    // wgpu need not know that there is no alpha: OpenGL ignores it in writes and returns 1 in reads.
    (RGB8, "GL_RGB8", Format::Rgba8Unorm),
    (SRGB8_ALPHA8, "GL_SRGB8_ALPHA8", Format::Rgba8UnormSrgb),
    (SRGB8, "GL_SRGB8", Format::Rgba8UnormSrgb),
    (RGB10_A2, "GL_RGB10_A2", Format::Rgb10a2Unorm),
    (RGBA16F, "GL_RGBA16F", Format::Rgba16Float),
    (RGB16F, "GL_RGB16F", Format::Rgba16Float),
    (R11F_G11F_B10F, "GL_R11F_G11F_B10F", Format::Rg11b10Ufloat),
    (RGBA32F, "GL_RGBA32F", Format::Rgba32Float),
];

/// Depth formats that a host may hand over.
const DEPTH: &[(u32, &str, Format)] = &[
    (DEPTH_COMPONENT16, "GL_DEPTH_COMPONENT16", Format::Depth16Unorm),
    (DEPTH_COMPONENT24, "GL_DEPTH_COMPONENT24", Format::Depth24Plus),
    // wgpu has no name for this format; it is read as a float in any case.
    (DEPTH_COMPONENT32, "GL_DEPTH_COMPONENT32", Format::Depth32Float),
    (DEPTH_COMPONENT32F, "GL_DEPTH_COMPONENT32F", Format::Depth32Float),
    (DEPTH24_STENCIL8, "GL_DEPTH24_STENCIL8", Format::Depth24PlusStencil8),
    (DEPTH32F_STENCIL8, "GL_DEPTH32F_STENCIL8", Format::Depth32FloatStencil8),
];

/// Formats of a mask or of surface classes; only red is read.
const MASK: &[(u32, &str, Format)] =
    &[(R8, "GL_R8", Format::R8Unorm), (RGBA8, "GL_RGBA8", Format::Rgba8Unorm), (RGB8, "GL_RGB8", Format::Rgba8Unorm)];

/// Formats of normals.
const NORMALS: &[(u32, &str, Format)] = &[
    (RGBA8, "GL_RGBA8", Format::Rgba8Unorm),
    (RGB8, "GL_RGB8", Format::Rgba8Unorm),
    (RGB10_A2, "GL_RGB10_A2", Format::Rgb10a2Unorm),
    (RGBA16F, "GL_RGBA16F", Format::Rgba16Float),
    (RGB16F, "GL_RGB16F", Format::Rgba16Float),
    (RGBA32F, "GL_RGBA32F", Format::Rgba32Float),
];

/// Bits of an attachment, queried for a framebuffer, and for a texture whose internal format is not a sized name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Bits {
    pub(super) red: i32,
    pub(super) green: i32,
    pub(super) alpha: i32,
    pub(super) depth: i32,
    pub(super) stencil: i32,
    /// Component type of the attachment's colour or depth: `GL_FLOAT`, `GL_UNSIGNED_NORMALIZED` and others.
    pub(super) component: u32,
    pub(super) srgb: bool,
}

impl Bits {
    /// Returns the sized colour format with these bits.
    pub(super) fn color(self) -> Option<u32> {
        let float = self.component == FLOAT;
        Some(match (self.red, self.green, self.alpha, float) {
            (8, 8, _, false) if self.srgb => SRGB8_ALPHA8,
            // A window with 5 or 6 bits a channel is drawn in a texture with 8; copying the texture back rounds.
            (1..=8, 1..=8, _, false) => RGBA8,
            (10, 10, _, false) => RGB10_A2,
            (16, 16, _, true) => RGBA16F,
            (11, 11, _, true) => R11F_G11F_B10F,
            (32, 32, _, true) => RGBA32F,
            _ => return None,
        })
    }

    /// Returns the sized depth format with these bits.
    pub(super) fn depth(self) -> Option<u32> {
        Some(match (self.depth, self.stencil > 0) {
            (16, _) => DEPTH_COMPONENT16,
            (24, false) => DEPTH_COMPONENT24,
            (24, true) => DEPTH24_STENCIL8,
            (32, false) if self.component == FLOAT => DEPTH_COMPONENT32F,
            (32, false) => DEPTH_COMPONENT32,
            (32, true) => DEPTH32F_STENCIL8,
            _ => return None,
        })
    }
}

/// Returns wgpu's format for `internal`, the internal format of one of a target's images. `side` says which image:
/// colour, depth, mask, surface classes or normals.
///
/// # Errors
/// [`crate::Status::Unsupported`], which names the parameter, the format and the accepted formats.
pub(super) fn format(internal: u32, side: TargetSide) -> Result<Format> {
    let table = match side {
        TargetSide::Color => COLOR,
        TargetSide::Depth => DEPTH,
        TargetSide::Mask | TargetSide::Classes => MASK,
        TargetSide::Normals => NORMALS,
    };
    if let Some((_, _, format)) = table.iter().find(|(name, ..)| *name == internal) {
        return Ok(*format);
    }
    let names: Vec<_> = table.iter().map(|(_, name, _)| *name).collect();
    let rest =
        format!("must have one of the internal formats {}, got {}", crate::error::listed(&names), spell(internal));
    Err(Error::about(Status::Unsupported, side.parameter(), rest))
}

/// Returns the client format and type with which `internal` can be allocated without data. OpenGL ES accepts only the
/// pairs of its table (OpenGL ES 3.0 specification, table 3.2), so a format without alpha is allocated without alpha.
pub(super) fn allocation(internal: u32) -> (u32, u32) {
    match internal {
        R8 => (RED, UNSIGNED_BYTE),
        RGB8 | SRGB8 => (RGB, UNSIGNED_BYTE),
        RGB16F => (RGB, HALF_FLOAT),
        RGB10_A2 => (RGBA, UNSIGNED_INT_2_10_10_10_REV),
        RGBA16F => (RGBA, HALF_FLOAT),
        RGBA32F => (RGBA, FLOAT),
        R11F_G11F_B10F => (RGB, UNSIGNED_INT_10F_11F_11F_REV),
        DEPTH_COMPONENT16 => (DEPTH_COMPONENT, UNSIGNED_SHORT),
        DEPTH_COMPONENT24 | DEPTH_COMPONENT32 => (DEPTH_COMPONENT, UNSIGNED_INT),
        DEPTH_COMPONENT32F => (DEPTH_COMPONENT, FLOAT),
        DEPTH24_STENCIL8 => (DEPTH_STENCIL, UNSIGNED_INT_24_8),
        DEPTH32F_STENCIL8 => (DEPTH_STENCIL, FLOAT_32_UNSIGNED_INT_24_8_REV),
        _ => (RGBA, UNSIGNED_BYTE),
    }
}

/// Whether a depth format also has stencil.
pub(super) fn has_stencil(internal: u32) -> bool {
    matches!(internal, DEPTH24_STENCIL8 | DEPTH32F_STENCIL8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refused_format_is_named_with_the_accepted_ones() {
        let error = format(0x8057, TargetSide::Color).unwrap_err();
        assert_eq!(error.status, crate::Status::Unsupported);
        for part in ["target.color", "GL_RGB5_A1 (0x8057)", "GL_RGBA8", "GL_RGBA16F"] {
            assert!(error.to_string().contains(part), "{}", error);
        }
        assert!(format(RGBA8, TargetSide::Depth).is_err() && format(DEPTH_COMPONENT16, TargetSide::Mask).is_err());
        // Normals need three channels; a surface class needs a byte, not a float.
        for (bad, side, name) in
            [(R8, TargetSide::Normals, "target.normals"), (RGBA16F, TargetSide::Classes, "target.surface_classes")]
        {
            let error = format(bad, side).unwrap_err();
            assert!(error.to_string().starts_with(name) && error.to_string().contains("GL_RGBA8"), "{}", error);
        }
        assert!(format(RGB16F, TargetSide::Normals).is_ok() && format(R8, TargetSide::Classes).is_ok());
    }

    #[test]
    fn every_accepted_format_is_spelled_by_name() {
        for (internal, name, _) in [COLOR, DEPTH, MASK, NORMALS].concat() {
            assert_eq!(spell(internal), format!("{name} (0x{internal:04X})"));
        }
    }

    #[test]
    fn bits_find_their_format() {
        let window = Bits { red: 8, green: 8, alpha: 0, depth: 24, stencil: 8, component: 0x8C17, srgb: false };
        assert_eq!((window.color(), window.depth()), (Some(RGBA8), Some(DEPTH24_STENCIL8)));
        let srgb = Bits { srgb: true, stencil: 0, ..window };
        assert_eq!((srgb.color(), srgb.depth()), (Some(SRGB8_ALPHA8), Some(DEPTH_COMPONENT24)));
        let half = Bits { red: 16, green: 16, alpha: 16, component: FLOAT, ..window };
        assert_eq!(half.color(), Some(RGBA16F));
        assert_eq!(Bits::default().color(), None);
        assert_eq!(Bits::default().depth(), None);
    }
}
