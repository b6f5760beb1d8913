//! DirectDraw surfaces (Microsoft, *Programming Guide for DDS*): a header of 128 bytes, 20 more bytes if its pixel
//! format is "DX10", then the mip levels from the largest to the smallest. Many programs read only files with the
//! shorter header, so that is the default for writing.

use super::super::image::NoiseImage;
use super::bytes::{bytes_of_level, check_levels, check_size, copy, cut_short, foreign, word};
use crate::error::{Error, Result, Status};

pub const MAGIC: [u8; 4] = *b"DDS ";

// Sizes of the parts, bytes.
const HEADER: u32 = 124;
const PIXEL_FORMAT: u32 = 32;
const BEFORE_DATA: usize = 128;
/// Size of the extended header, bytes. It follows the header if the pixel format is [`DX10`].
const MORE: usize = 20;
const DX10: [u8; 4] = *b"DX10";

// Offsets of the fields, bytes.
const AT_SIZE: usize = 4;
const AT_HEIGHT: usize = 12;
const AT_WIDTH: usize = 16;
const AT_DEPTH: usize = 24;
const AT_LEVELS: usize = 28;
const AT_PIXEL_FORMAT: usize = 76;
const AT_PIXEL_FLAGS: usize = 80;
const AT_FOUR_CC: usize = 84;
const AT_BIT_COUNT: usize = 88;
const AT_RED_MASK: usize = 92;
const AT_CAPS_2: usize = 112;
const AT_DXGI_FORMAT: usize = 128;
const AT_DIMENSION: usize = 132;
const AT_MISC: usize = 136;
const AT_ARRAY: usize = 140;

// Bits of dwFlags: caps, height, width, pitch and pixel format; mip levels; depth.
const FLAGS: u32 = 0x1 | 0x2 | 0x4 | 0x8 | 0x1000;
const FLAG_LEVELS: u32 = 0x2_0000;
const FLAG_DEPTH: u32 = 0x80_0000;
// Bits of dwCaps: texture; more than one surface; mip levels.
const CAPS_TEXTURE: u32 = 0x1000;
const CAPS_COMPLEX: u32 = 0x8;
const CAPS_LEVELS: u32 = 0x40_0000;
// Bits of dwCaps2.
const CUBE_MAP: u32 = 0x200;
const VOLUME: u32 = 0x20_0000;
// Flags of the pixel format.
const ALPHA: u32 = 0x2;
const FOUR_CC: u32 = 0x4;
const LUMINANCE: u32 = 0x2_0000;
// Values of DXGI_FORMAT and D3D10_RESOURCE_DIMENSION.
const R8_UNORM: u32 = 61;
const A8_UNORM: u32 = 65;
const NO_DIMENSION: u32 = 0;
const DIMENSION_2D: u32 = 3;
const DIMENSION_3D: u32 = 4;
const MISC_CUBE_MAP: u32 = 0x4;

pub fn read(bytes: &[u8]) -> Result<NoiseImage> {
    if bytes.len() < BEFORE_DATA {
        return Err(cut_short(BEFORE_DATA, bytes.len()));
    }
    for (field, at, size) in [("dwSize", AT_SIZE, HEADER), ("ddspf.dwSize", AT_PIXEL_FORMAT, PIXEL_FORMAT)] {
        let got = word(bytes, at)?;
        if got != size {
            return Err(Error::about(Status::Parse, field, format_args!("must be {size}, got {got}")));
        }
    }
    let caps_2 = word(bytes, AT_CAPS_2)?;
    if caps_2 & CUBE_MAP != 0 {
        return Err(foreign("dwCaps2", "that of a plane or a volume", "a cube map"));
    }
    let says_volume = caps_2 & VOLUME != 0;
    let (is_volume, data) = match longer_header(bytes)? {
        Some(dimension) => (dimension.map_or(says_volume, |d| d == DIMENSION_3D), BEFORE_DATA + MORE),
        None => (says_volume, BEFORE_DATA),
    };
    let depth = if is_volume { word(bytes, AT_DEPTH)? } else { 1 };
    let size =
        check_size([("dwWidth", word(bytes, AT_WIDTH)?), ("dwHeight", word(bytes, AT_HEIGHT)?), ("dwDepth", depth)])?;
    let levels = check_levels("dwMipMapCount", word(bytes, AT_LEVELS)?, size)?;
    let needed = data as u64 + (0..levels).map(|level| bytes_of_level(size, level)).sum::<u64>();
    if needed > bytes.len() as u64 {
        return Err(cut_short(needed, bytes.len()));
    }
    let mut rest = &bytes[data..];
    let mut level_of = |level| {
        let (first, others) = rest.split_at(bytes_of_level(size, level) as usize);
        rest = others;
        copy(first)
    };
    let levels = (0..levels).map(&mut level_of).collect::<Result<_>>()?;
    Ok(NoiseImage::of_levels(size, levels))
}

/// Returns the dimension in the extended header; the inner `None` if it holds none (NVIDIA's exporter writes none), the
/// outer `None` if there is no extended header. Checks that a texel is one byte.
fn longer_header(bytes: &[u8]) -> Result<Option<Option<u32>>> {
    let flags = word(bytes, AT_PIXEL_FLAGS)?;
    if flags & FOUR_CC == 0 {
        let (is_known, bits) = (matches!(flags, ALPHA | LUMINANCE), word(bytes, AT_BIT_COUNT)?);
        if !is_known || bits != 8 {
            let got = format!("flags {flags:#x} with {bits} bits");
            return Err(foreign("ddspf", "alpha or luminance alone with 8 bits (A8, L8), or DX10", got));
        }
        return Ok(None);
    }
    let four_cc = &bytes[AT_FOUR_CC..AT_FOUR_CC + 4];
    if four_cc != DX10 {
        return Err(foreign("ddspf.dwFourCC", "DX10 (or none, with A8 or L8)", four_cc.escape_ascii()));
    }
    if bytes.len() < BEFORE_DATA + MORE {
        return Err(cut_short(BEFORE_DATA + MORE, bytes.len()));
    }
    let format = word(bytes, AT_DXGI_FORMAT)?;
    if !matches!(format, R8_UNORM | A8_UNORM) {
        return Err(foreign("dxgiFormat", "R8_UNORM (61) or A8_UNORM (65)", format));
    }
    if word(bytes, AT_MISC)? & MISC_CUBE_MAP != 0 {
        return Err(foreign("miscFlag", "that of a plane or a volume", "a cube map"));
    }
    let layers = word(bytes, AT_ARRAY)?;
    if layers > 1 {
        return Err(foreign("arraySize", "1", layers));
    }
    match word(bytes, AT_DIMENSION)? {
        known @ (DIMENSION_2D | DIMENSION_3D) => Ok(Some(Some(known))),
        NO_DIMENSION => {
            log::warn!(
                "DDS: resourceDimension is 0, as NVIDIA's exporter writes it; dwCaps2 says whether it is a volume"
            );
            Ok(Some(None))
        }
        other => Err(foreign("resourceDimension", "TEXTURE2D (3) or TEXTURE3D (4)", other)),
    }
}

/// Header and format by which a file says that its texels are bytes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Texels {
    /// Original header, as 8-bit luminance (L8).
    Luminance,
    /// Extended header, as R8_UNORM.
    Red,
}

pub fn write(image: &NoiseImage, texels: Texels) -> Vec<u8> {
    let [width, height, depth] = image.size();
    let (is_volume, levels) = (depth > 1, image.levels().len() as u32);
    let mut header = [0_u8; BEFORE_DATA + MORE];
    header[..4].copy_from_slice(&MAGIC);
    let mut put = |at: usize, value: u32| header[at..at + 4].copy_from_slice(&value.to_le_bytes());
    let has_levels = levels > 1;
    put(AT_SIZE, HEADER);
    put(8, FLAGS | if has_levels { FLAG_LEVELS } else { 0 } | if is_volume { FLAG_DEPTH } else { 0 });
    put(AT_HEIGHT, height);
    put(AT_WIDTH, width);
    // dwPitchOrLinearSize: size of a row, bytes.
    put(20, width);
    put(AT_DEPTH, if is_volume { depth } else { 0 });
    put(AT_LEVELS, levels);
    put(AT_PIXEL_FORMAT, PIXEL_FORMAT);
    let complex = if has_levels || is_volume { CAPS_COMPLEX } else { 0 };
    put(108, CAPS_TEXTURE | complex | if has_levels { CAPS_LEVELS } else { 0 });
    put(AT_CAPS_2, if is_volume { VOLUME } else { 0 });
    match texels {
        Texels::Luminance => {
            put(AT_PIXEL_FLAGS, LUMINANCE);
            put(AT_BIT_COUNT, 8);
            put(AT_RED_MASK, 0xff);
        }
        Texels::Red => {
            put(AT_PIXEL_FLAGS, FOUR_CC);
            put(AT_FOUR_CC, u32::from_le_bytes(DX10));
            put(AT_DXGI_FORMAT, R8_UNORM);
            put(AT_DIMENSION, if is_volume { DIMENSION_3D } else { DIMENSION_2D });
            put(AT_ARRAY, 1);
        }
    }
    let before = if texels == Texels::Red { BEFORE_DATA + MORE } else { BEFORE_DATA };
    let mut file = header[..before].to_vec();
    image.levels().iter().for_each(|level| file.extend_from_slice(level));
    file
}
