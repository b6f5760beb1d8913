//! PNG with one channel of grey (ISO/IEC 15948): heights are the grey values, row 0 is the north.

use std::io::Cursor;

use image::{
    ColorType, ExtendedColorType, ImageDecoder as _, ImageEncoder as _, ImageError,
    codecs::png,
    error::{LimitError, LimitErrorKind},
};

use super::{
    super::{
        map::{HeightMap, check_size, room_for},
        settings::{HeightSettings, RowOrder},
    },
    numbers::{in_order, whole_number},
    samples::{Samples, cut_short},
};
use crate::error::{Error, Result, Status};

pub const MAGIC: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// Number of bytes before the first chunk that may hold pixels: signature and header.
const BEFORE_DATA: usize = 33;
// Offsets of the header's fields, bytes.
const AT_WIDTH: usize = 16;
const AT_HEIGHT: usize = 20;
const AT_DEPTH: usize = 24;
const AT_COLOR: usize = 25;
/// Colour type of one channel of grey.
const GREY: u8 = 0;
/// Largest ratio by which the compression of PNG shrinks bytes (Deutsch 1996, RFC 1951: 258 bytes for two bits).
const MOST_SHRUNK: u64 = 1032;

pub fn read(bytes: &[u8], settings: &HeightSettings) -> Result<HeightMap> {
    if bytes.len() < BEFORE_DATA {
        return Err(cut_short("byte 8, IHDR", BEFORE_DATA, bytes.len()));
    }
    let word = |at: usize| u32::from_be_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
    let (columns, rows) = (word(AT_WIDTH), word(AT_HEIGHT));
    check_size(columns, rows).map_err(|e| e.with_status(Status::Parse).found_in(format_args!("byte {AT_WIDTH}")))?;
    let (depth, color) = (bytes[AT_DEPTH], bytes[AT_COLOR]);
    if color != GREY || !matches!(depth, 8 | 16) {
        let sentence = format!(
            "byte {AT_DEPTH}: must be one channel of grey (colour type 0) with 8 or 16 bits, got colour type {color} with \
             {depth} bits"
        );
        return Err(Error::unsupported(sentence));
    }
    let packed = u64::from(columns) * u64::from(rows) * u64::from(depth / 8);
    if packed / MOST_SHRUNK > bytes.len() as u64 {
        return Err(cut_short(format_args!("byte {BEFORE_DATA}"), packed / MOST_SHRUNK, bytes.len()));
    }
    let (pixels, kind) = decoded(bytes).map_err(|e| fault(bytes, &e))?;
    let mut samples = Samples::new(columns, rows, settings)?;
    // Transparency adds a channel that is 0 where a pixel has no height.
    let (size, has_height): (usize, fn(&[u8]) -> bool) = match kind {
        ColorType::L8 => (1, |_| true),
        ColorType::L16 => (2, |_| true),
        ColorType::La8 => (2, |pixel| pixel[1] != 0),
        _ => (4, |pixel| pixel[2] != 0 || pixel[3] != 0),
    };
    for (i, pixel) in pixels.chunks_exact(size).enumerate() {
        let place = format_args!("pixel {i}");
        match has_height(pixel) {
            true if depth == 8 => samples.take(f64::from(pixel[0]), place)?,
            true => samples.take(f64::from(u16::from_ne_bytes([pixel[0], pixel[1]])), place)?,
            false => samples.take_none(place)?,
        }
    }
    Ok(samples.finish(RowOrder::NorthFirst))
}

/// Returns the bytes of all pixels, 16-bit values in the machine's order, and their kind.
fn decoded(bytes: &[u8]) -> std::result::Result<(Vec<u8>, ColorType), ImageError> {
    let full = || ImageError::Limits(LimitError::from_kind(LimitErrorKind::InsufficientMemory));
    let decoder = png::PngDecoder::new(Cursor::new(bytes))?;
    let (size, kind) = (usize::try_from(decoder.total_bytes()).map_err(|_| full())?, decoder.color_type());
    let mut pixels = Vec::new();
    pixels.try_reserve_exact(size).map_err(|_| full())?;
    pixels.resize(size, 0);
    decoder.read_image(&mut pixels)?;
    Ok((pixels, kind))
}

/// Returns the error for a file that cannot be decoded. It names the first chunk that is cut short or whose checksum is
/// wrong, or else the compressed rows.
fn fault(bytes: &[u8], error: &ImageError) -> Error {
    if let ImageError::Limits(_) = error {
        return Error::new(Status::OutOfMemory, format!("byte {BEFORE_DATA}: there is no memory for the pixels"));
    }
    let (mut at, mut data) = (MAGIC.len(), None);
    while let Some(head) = bytes.get(at..at + 8) {
        let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
        let name = head[4..].escape_ascii().to_string();
        let Some(body) = bytes.get(at + 4..at + 8 + length) else {
            return cut_short(format_args!("byte {at}, chunk {name}"), at + 12 + length, bytes.len());
        };
        let Some(sum) = bytes.get(at + 8 + length..at + 12 + length) else {
            return cut_short(format_args!("byte {at}, chunk {name}"), at + 12 + length, bytes.len());
        };
        let (sum, wanted) = (u32::from_be_bytes([sum[0], sum[1], sum[2], sum[3]]), checksum(body));
        if sum != wanted {
            let sentence = format!("byte {at}, chunk {name}: its checksum must be {wanted:#010x}, got {sum:#010x}");
            return Error::new(Status::Parse, sentence);
        }
        if &head[4..] == b"IDAT" && data.is_none() {
            data = Some(at);
        }
        at += 12 + length;
    }
    let place = data.map_or_else(|| format!("byte {at}"), |at| format!("byte {at}, chunk IDAT"));
    let sentence = format!("{place}: must hold the compressed rows of the picture; {error}");
    Error::new(Status::Parse, crate::error::shown(&sentence))
}

/// Returns the checksum of a chunk's name and data (CRC-32, ISO 3309).
fn checksum(bytes: &[u8]) -> u32 {
    let step = |sum: u32, _| (sum >> 1) ^ if sum & 1 == 1 { 0xedb8_8320 } else { 0 };
    !bytes.iter().fold(u32::MAX, |sum, byte| (0..8).fold(sum ^ u32::from(*byte), step))
}

pub fn write(map: &HeightMap, settings: &HeightSettings) -> Result<Vec<u8>> {
    let mut pixels = room_for(2 * map.heights_m().len() as u64)?;
    for index in in_order(map, RowOrder::NorthFirst) {
        pixels.extend((whole_number(map, index, settings, [0, 65_535])? as u16).to_ne_bytes());
    }
    let mut file = Vec::new();
    let written =
        png::PngEncoder::new(&mut file).write_image(&pixels, map.columns(), map.rows(), ExtendedColorType::L16);
    written.map_err(|e| Error::new(Status::Internal, format!("PNG: {e}")))?;
    Ok(file)
}
