//! Terragen terrains (Planetside 2003, *Terragen Terrain file specification*): chunks without lengths, little-endian,
//! rows from the south. A height is `SCAL (base + number scale / 65536)`, with the third scale of the chunk SCAL and
//! the base and scale of the chunk ALTW.

use super::{
    super::{
        map::{HeightMap, check_cell, room_for},
        settings::{HeightSettings, RowOrder},
    },
    samples::{Samples, cut_short},
};
use crate::error::{Error, Result, Status};

pub const MAGIC: &[u8] = b"TERRAGENTERRAIN ";

/// Metres for each unit of a terrain whose file does not give its scale.
const DEFAULT_SCALE: f32 = 30.0;
/// Longest side, in samples, that all programs read; some read it as a signed number.
const LONGEST: u32 = 32_767;
/// Markers of the chunks of fixed size, and the sizes of these chunks including the marker, bytes.
const FIXED: [(&[u8], usize); 7] =
    [(b"SIZE", 8), (b"XPTS", 8), (b"YPTS", 8), (b"SCAL", 16), (b"CRAD", 8), (b"CRVM", 8), (b"EOF ", 4)];
/// Largest size of a written file without its heights, bytes.
const MOST_BEFORE_HEIGHTS: u64 = 128;
/// Marker of the chunk of heights, and the size of its marker, scale and base, bytes.
const HEIGHTS: (&[u8], usize) = (b"ALTW", 8);

/// Fields of the chunks that were read so far.
#[derive(Default)]
struct Fields {
    size: Option<u16>,
    x_points: Option<u16>,
    y_points: Option<u16>,
    scale: Option<[f32; 3]>,
    /// Offset of the chunk of the scale.
    scale_begin: usize,
    /// Offset of the heights' chunk.
    heights: Option<usize>,
    is_ended: bool,
}

impl Fields {
    /// Adds the fields of a chunk of fixed size that begins at byte `begin`.
    fn take(&mut self, marker: &[u8], bytes: &[u8], begin: usize) -> Result<()> {
        let short = |i: usize| u16::from_le_bytes([bytes[i], bytes[i + 1]]);
        let float = |i: usize| f32::from_le_bytes([bytes[i], bytes[i + 1], bytes[i + 2], bytes[i + 3]]);
        let is_again = match marker {
            b"SIZE" => self.size.replace(short(4)).is_some(),
            b"XPTS" => self.x_points.replace(short(4)).is_some(),
            b"YPTS" => self.y_points.replace(short(4)).is_some(),
            b"SCAL" => {
                self.scale_begin = begin;
                self.scale.replace([4, 8, 12].map(float)).is_some()
            }
            b"EOF " => std::mem::replace(&mut self.is_ended, true),
            // The radius and the curvature of a planet change no height.
            _ => false,
        };
        if is_again {
            let sentence = format!("byte {begin}: a terrain has one chunk {}, this is another", marker.escape_ascii());
            return Err(Error::new(Status::Parse, sentence));
        }
        Ok(())
    }

    /// Returns columns and rows if they are known: from XPTS and YPTS, otherwise SIZE + 1.
    fn sides(&self) -> Option<[u32; 2]> {
        let square = self.size.map(|size| u32::from(size) + 1);
        let side = |points: Option<u16>| points.map(u32::from).or(square);
        Some([side(self.x_points)?, side(self.y_points)?])
    }

    /// Returns the size of the heights' chunk, bytes; `None` if columns or rows are not known.
    fn heights_size(&self) -> Option<usize> {
        self.sides().map(|[columns, rows]| HEIGHTS.1 + 2 * columns as usize * rows as usize)
    }
}

/// Returns the marker and the size of the chunk of fixed size with this marker; `None` for other markers.
fn fixed(marker: &[u8]) -> Option<(&'static [u8], usize)> {
    FIXED.into_iter().find(|(name, _)| *name == marker)
}

/// Returns the end of the heights' chunk, which begins at byte `start`. XPTS and YPTS may follow it; they are then
/// found from the end of the file.
fn heights_end(bytes: &[u8], start: usize, fields: &Fields) -> Result<usize> {
    if fields.x_points.is_some() && fields.y_points.is_some() {
        return Ok(start + fields.heights_size().unwrap_or_default());
    }
    let mut known =
        Fields { size: fields.size, x_points: fields.x_points, y_points: fields.y_points, ..Default::default() };
    let mut end = bytes.len();
    loop {
        if let Some(size) = known.heights_size()
            && (end == start + size || end == padded(start + size))
        {
            return Ok(start + size);
        }
        let ends_here = |(name, size): &(&[u8], usize)| {
            end.checked_sub(*size).is_some_and(|begin| begin >= start && bytes[begin..].starts_with(name))
        };
        match FIXED.into_iter().find(ends_here) {
            Some((marker, size)) if known.take(marker, &bytes[end - size..end], end - size).is_ok() => end -= size,
            _ => break,
        }
    }
    // Uses the end that SIZE gives, so that the error is about the first byte that does not fit.
    fields.heights_size().or(known.heights_size()).map(|size| start + size).ok_or_else(|| {
        let sentence =
            format!("byte {start}: ALTW needs a chunk SIZE, or XPTS and YPTS, for the number of its heights");
        Error::new(Status::Parse, sentence)
    })
}

/// Returns an offset rounded up to whole words, to which chunks are aligned.
fn padded(offset: usize) -> usize {
    offset.next_multiple_of(4)
}

/// Reads the chunks of a file.
fn fields(bytes: &[u8]) -> Result<Fields> {
    let mut fields = Fields::default();
    let mut at = MAGIC.len();
    while at < bytes.len() {
        if fields.is_ended {
            let sentence = format!("byte {at}: EOF must be the last chunk, {} bytes follow it", bytes.len() - at);
            return Err(Error::new(Status::Parse, sentence));
        }
        let Some(marker) = bytes.get(at..at + 4) else {
            return Err(cut_short(format_args!("byte {at}, the marker of a chunk"), at + 4, bytes.len()));
        };
        let name = marker.escape_ascii();
        let end = if marker == HEIGHTS.0 {
            if fields.heights.replace(at).is_some() {
                let sentence = format!("byte {at}: a terrain has one chunk ALTW, this is another");
                return Err(Error::new(Status::Parse, sentence));
            }
            heights_end(bytes, at, &fields)?
        } else if let Some((_, size)) = fixed(marker) {
            at + size
        } else {
            let accepted = "SIZE, XPTS, YPTS, SCAL, CRAD, CRVM, ALTW or EOF";
            return Err(Error::new(Status::Parse, format!("byte {at}: a chunk must be {accepted}, got {name}")));
        };
        let Some(chunk) = bytes.get(at..end) else {
            return Err(cut_short(format_args!("byte {at}, chunk {name}"), end, bytes.len()));
        };
        if marker != HEIGHTS.0 {
            fields.take(marker, chunk, at)?;
        }
        // An odd number of heights is followed by two bytes that align the next chunk; some programs leave these bytes
        // out.
        let padding = bytes.get(end..padded(end));
        at = if padding.is_some_and(|p| p.iter().all(|b| *b == 0)) { padded(end) } else { end };
    }
    Ok(fields)
}

pub fn read(bytes: &[u8], settings: &HeightSettings) -> Result<HeightMap> {
    let fields = fields(bytes)?;
    let missing =
        |name: &str| Error::new(Status::Parse, format!("byte {}: the file ends without a chunk {name}", bytes.len()));
    let at = fields.heights.ok_or_else(|| missing("ALTW"))?;
    let [columns, rows] = fields.sides().ok_or_else(|| missing("SIZE"))?;
    let scale = fields.scale.unwrap_or([DEFAULT_SCALE; 3]).map(f64::from);
    for scale in scale {
        if !(scale.is_finite() && scale > 0.0 && scale <= 1e6) {
            let place = format!("byte {}, chunk SCAL,", fields.scale_begin);
            let rest = format!("must have three scales above 0 and up to 1e6 m, got {scale}");
            return Err(Error::about(Status::Parse, place, rest));
        }
    }
    let end = at + fields.heights_size().unwrap_or_default();
    let Some(chunk) = bytes.get(at..end) else {
        return Err(cut_short(format_args!("byte {at}, chunk ALTW"), end, bytes.len()));
    };
    let short = |i: usize| f64::from(i16::from_le_bytes([chunk[i], chunk[i + 1]]));
    let (step, base) = (short(4) / 65_536.0, short(6));
    let mut samples = Samples::new(columns, rows, settings)?;
    for i in (HEIGHTS.1..chunk.len()).step_by(2) {
        samples.take(scale[2] * (base + step * short(i)), format_args!("byte {}", at + i))?;
    }
    let cell = [scale[0], scale[1]];
    Ok(samples.finish(RowOrder::SouthFirst).placed(check_cell(cell).is_ok().then_some(cell), None))
}

/// Scale and base of a chunk of heights.
struct Coding {
    scale: i16,
    base: i16,
}

impl Coding {
    /// Returns the finest coding for heights from `low` to `high`, in units of the terrain.
    fn fitting(low: f64, high: f64) -> Option<Self> {
        let first = ((high - low).ceil().max(1.0)).min(f64::from(i16::MAX) + 1.0) as i32;
        (first..=i32::from(i16::MAX)).find_map(|scale| {
            let (lowest, highest) = (f64::from(scale) * -0.5, f64::from(scale) * 32_767.0 / 65_536.0);
            let base = (high - highest).ceil();
            let fits = base + lowest <= low && (-32_768.0..=32_767.0).contains(&base);
            fits.then_some(Self { scale: scale as i16, base: base as i16 })
        })
    }

    fn number(&self, height: f64) -> i16 {
        // Rounding keeps a fitting height within the ends.
        ((height - f64::from(self.base)) * 65_536.0 / f64::from(self.scale)).round().clamp(-32_768.0, 32_767.0) as i16
    }
}

pub fn write(map: &HeightMap) -> Result<Vec<u8>> {
    let (columns, rows) = (map.columns(), map.rows());
    for (name, side) in [("columns", columns), ("rows", rows)] {
        if side > LONGEST {
            return Err(Error::range(name, &format!("at most {LONGEST} in a Terragen file"), side));
        }
    }
    if let Some(index) = map.heights_m().iter().position(|h| h.is_nan()) {
        let accepted = "known: a Terragen file has no number for a height that is not";
        return Err(Error::range(&format!("heights_m[{index}]"), accepted, f64::NAN));
    }
    let cell = map.cell().filter(|cell| cell[0] == cell[1]).ok_or_else(|| {
        let got = map.cell().map_or("none".into(), |cell| format!("{cell:?}"));
        Error::range("cell", "known and the same in both directions for a Terragen file", got)
    })?;
    let scale = cell[0] as f32;
    let unit = f64::from(scale);
    let [low, high] = map.range_m().unwrap_or_default().map(|h| f64::from(h) / unit);
    let coding = Coding::fitting(low, high).ok_or_else(|| {
        let least = (high - low).max(low.abs()).max(high.abs()) * unit / 32_000.0;
        let accepted = format!("at least {least:.3} for heights from {} to {} m", low * unit, high * unit);
        Error::range("cell", &accepted, cell[0])
    })?;
    let mut file = room_for(MOST_BEFORE_HEIGHTS + 2 * map.heights_m().len() as u64)?;
    file.extend_from_slice(MAGIC);
    for (marker, value) in [(b"SIZE", columns.min(rows) - 1), (b"XPTS", columns), (b"YPTS", rows)] {
        file.extend(marker);
        file.extend(value.to_le_bytes());
    }
    file.extend(b"SCAL");
    (0..3).for_each(|_| file.extend(scale.to_le_bytes()));
    file.extend(HEIGHTS.0);
    file.extend(coding.scale.to_le_bytes());
    file.extend(coding.base.to_le_bytes());
    map.heights_m().iter().for_each(|h| file.extend(coding.number(f64::from(*h) / unit).to_le_bytes()));
    file.resize(padded(file.len()), 0);
    file.extend(b"EOF ");
    Ok(file)
}
