//! Bytes of a noise file: the numbers in them, and checks of the texture that they describe.

use super::super::{
    image::empty,
    settings::{MOST_TEXELS, levels_of, size_of_level, texels},
};
use crate::error::{Error, Result, Status};

/// Reads a 32-bit little-endian number at an offset.
pub fn word(bytes: &[u8], offset: usize) -> Result<u32> {
    let part = bytes.get(offset..).and_then(|rest| rest.first_chunk());
    part.map(|four| u32::from_le_bytes(*four)).ok_or_else(|| cut_short(offset + 4, bytes.len()))
}

/// Reads a 64-bit little-endian number at an offset.
pub fn long(bytes: &[u8], offset: usize) -> Result<u64> {
    Ok(u64::from(word(bytes, offset)?) | u64::from(word(bytes, offset + 4)?) << 32)
}

pub fn cut_short(needed: impl std::fmt::Display, there: usize) -> Error {
    Error::new(Status::Parse, format!("is cut short: it needs {needed} bytes and has {there}"))
}

/// Returns the error for a field whose value is not that of a noise texture.
pub fn foreign(field: &str, accepted: &str, got: impl std::fmt::Display) -> Error {
    Error::about(Status::Unsupported, field, format_args!("must be {accepted}, got {got}"))
}

/// Checks width, height and depth, given with their names: each is at least 1, and the texture is not too large.
pub fn check_size(named: [(&str, u32); 3]) -> Result<[u32; 3]> {
    if let Some((name, _)) = named.iter().find(|(_, texels)| *texels == 0) {
        return Err(Error::about(Status::Parse, *name, "must be at least 1, got 0"));
    }
    let size = named.map(|(_, texels)| texels);
    // 128 bits hold the product of three 32-bit numbers.
    let product: u128 = size.into_iter().map(u128::from).product();
    if product > u128::from(MOST_TEXELS) {
        let most = format!("such that there are at most {MOST_TEXELS} texels");
        return Err(foreign(named[0].0, &most, format_args!("{} x {} x {}", size[0], size[1], size[2])));
    }
    Ok(size)
}

/// Checks the number of mip levels for a texture of this size, and returns it; 0 means one.
pub fn check_levels(field: &str, levels: u32, size: [u32; 3]) -> Result<u32> {
    let most = levels_of(size);
    if levels > most {
        return Err(Error::about(Status::Parse, field, format_args!("must be in [0, {most}], got {levels}")));
    }
    Ok(levels.max(1))
}

/// Returns the size of a mip level, bytes.
pub fn bytes_of_level(size: [u32; 3], level: u32) -> u64 {
    texels(size_of_level(size, level))
}

/// Copies the bytes; [`Status::OutOfMemory`] if there is no room for them.
pub fn copy(bytes: &[u8]) -> Result<Vec<u8>> {
    let mut room = empty(bytes.len() as u64)?;
    room.extend_from_slice(bytes);
    Ok(room)
}
