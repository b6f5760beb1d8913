//! Khronos textures (Khronos 2020, *KTX File Format Specification*, version 2.0): header, index of the mip levels, data
//! format descriptor, then the levels from the smallest to the largest.

use super::super::image::NoiseImage;
use super::bytes::{bytes_of_level, check_levels, check_size, copy, cut_short, foreign, long, word};
use crate::error::{Error, Result, Status};

pub const MAGIC: [u8; 12] = *b"\xabKTX 20\xbb\r\n\x1a\n";

// Offsets of the fields, bytes.
const AT_FORMAT: usize = 12;
const AT_WIDTH: usize = 20;
const AT_HEIGHT: usize = 24;
const AT_DEPTH: usize = 28;
const AT_LAYERS: usize = 32;
const AT_FACES: usize = 36;
const AT_LEVELS: usize = 40;
const AT_SCHEME: usize = 44;
const AT_INDEX: usize = 80;
/// Size of a level's entry in the index, bytes: offset, length, length without supercompression.
const LEVEL: usize = 24;

/// VK_FORMAT_R8_UNORM.
const R8_UNORM: u32 = 9;

/// Data format descriptor of R8_UNORM (Khronos, *Data Format Specification* 1.3, section 5): its length; a basic block
/// of version 2 with 40 bytes; colour model RGB, primaries of BT.709, linear; one byte per texel; one sample of 8 bits,
/// red, from 0 to 255.
const DESCRIPTOR: [u32; 11] = [44, 0, 2 | 40 << 16, 1 | 1 << 8 | 1 << 16, 0, 1, 0, 7 << 16, 0, 0, 255];
/// Key and value that name the writer: their length, the two themselves, and zeros up to a multiple of 4 bytes.
const WRITER: &[u8] = b"\x11\0\0\0KTXwriter\0Welkin\0\0\0\0";

pub fn read(bytes: &[u8]) -> Result<NoiseImage> {
    if bytes.len() < AT_INDEX {
        return Err(cut_short(AT_INDEX, bytes.len()));
    }
    for (field, at, accepted, name) in [
        ("vkFormat", AT_FORMAT, R8_UNORM..=R8_UNORM, "VK_FORMAT_R8_UNORM (9)"),
        ("supercompressionScheme", AT_SCHEME, 0..=0, "0, none"),
        ("layerCount", AT_LAYERS, 0..=1, "0 or 1"),
        ("faceCount", AT_FACES, 1..=1, "1"),
    ] {
        let got = word(bytes, at)?;
        if !accepted.contains(&got) {
            return Err(foreign(field, name, got));
        }
    }
    // A two-dimensional texture has depth 0.
    let depth = word(bytes, AT_DEPTH)?.max(1);
    let size =
        [("pixelWidth", word(bytes, AT_WIDTH)?), ("pixelHeight", word(bytes, AT_HEIGHT)?), ("pixelDepth", depth)];
    let size = check_size(size)?;
    let count = check_levels("levelCount", word(bytes, AT_LEVELS)?, size)?;
    let levels = (0..count).map(|level| read_level(bytes, size, level)).collect::<Result<_>>()?;
    Ok(NoiseImage::of_levels(size, levels))
}

fn read_level(bytes: &[u8], size: [u32; 3], level: u32) -> Result<Vec<u8>> {
    let entry = AT_INDEX + LEVEL * level as usize;
    let (place, length) = (long(bytes, entry)?, long(bytes, entry + 8)?);
    let expected = bytes_of_level(size, level);
    if length != expected {
        let field = format!("levels[{level}].byteLength");
        return Err(Error::about(Status::Parse, field, format_args!("must be {expected}, got {length}")));
    }
    let end = place.saturating_add(length);
    let part = usize::try_from(place).ok().zip(usize::try_from(end).ok()).and_then(|(from, to)| bytes.get(from..to));
    copy(part.ok_or_else(|| cut_short(end, bytes.len()))?)
}

pub fn write(image: &NoiseImage) -> Vec<u8> {
    let [width, height, depth] = image.size();
    let count = image.levels().len();
    let descriptor_at = AT_INDEX + LEVEL * count;
    let writer_at = descriptor_at + 4 * DESCRIPTOR.len();

    let mut file = MAGIC.to_vec();
    let put = |file: &mut Vec<u8>, values: &[u32]| values.iter().for_each(|v| file.extend_from_slice(&v.to_le_bytes()));
    // Format, size of its type; width, height, depth; no layers, one face; levels; no supercompression.
    let depth = if depth > 1 { depth } else { 0 };
    put(&mut file, &[R8_UNORM, 1, width, height, depth, 0, 1, count as u32, 0]);
    let [at, length] = [descriptor_at, 4 * DESCRIPTOR.len()].map(|n| n as u32);
    // Offsets and lengths of the descriptor, of the keys, and of the data that supercompression would share.
    put(&mut file, &[at, length, writer_at as u32, WRITER.len() as u32, 0, 0, 0, 0]);

    // Levels begin at multiples of 4 bytes, the smallest first.
    let mut places = vec![0; count];
    let mut end = writer_at + WRITER.len();
    for (place, bytes) in places.iter_mut().zip(image.levels()).rev() {
        *place = end.next_multiple_of(4);
        end = *place + bytes.len();
    }
    for (place, bytes) in places.iter().zip(image.levels()) {
        let [place, length] = [*place, bytes.len()].map(|n| n as u64);
        [place, length, length].iter().for_each(|v| file.extend_from_slice(&v.to_le_bytes()));
    }
    put(&mut file, &DESCRIPTOR);
    file.extend_from_slice(WRITER);
    for (place, bytes) in places.iter().zip(image.levels()).rev() {
        file.resize(*place, 0);
        file.extend_from_slice(bytes);
    }
    file
}
