//! ESRI ASCII grids (Esri, *Esri ASCII raster format*): keywords with values, then heights from the north-west.

use std::fmt;

use super::{
    super::{
        map::{CELL_RANGE, HeightMap, MAX_HEIGHT_SAMPLES},
        settings::{HeightSettings, RowOrder},
    },
    samples::Samples,
};
use crate::error::{Error, Result, Status, check_range, shown};

/// Keywords of the header, in lower case. GDAL writes `dx` and `dy` where cells are not square.
const KEYWORDS: [&str; 10] =
    ["ncols", "nrows", "xllcorner", "xllcenter", "yllcorner", "yllcenter", "cellsize", "dx", "dy", "nodata_value"];
/// Largest absolute value of a coordinate.
const MOST_PLACE: f64 = 1e12;
/// Bytes that some programs write before a text (Unicode's byte order mark in UTF-8).
const MARK: &[u8] = b"\xef\xbb\xbf";

/// Place of a word in the text; line and column count from 1.
#[derive(Clone, Copy)]
struct TextPlace {
    line: usize,
    column: usize,
}

impl fmt::Display for TextPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}", self.line, self.column)
    }
}

/// Reader of a text, word by word.
struct Words<'a> {
    rest: &'a [u8],
    place: TextPlace,
}

impl<'a> Words<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes.strip_prefix(MARK).unwrap_or(bytes), place: TextPlace { line: 1, column: 1 } }
    }

    /// Moves to the next word and returns it without taking it; empty at the end.
    fn peek(&mut self) -> &'a [u8] {
        while let Some(space) = self.rest.first().filter(|b| b.is_ascii_whitespace()) {
            (self.place.line, self.place.column) =
                if *space == b'\n' { (self.place.line + 1, 1) } else { (self.place.line, self.place.column + 1) };
            self.rest = &self.rest[1..];
        }
        let end = self.rest.iter().position(u8::is_ascii_whitespace).unwrap_or(self.rest.len());
        &self.rest[..end]
    }

    /// Takes the next word.
    fn next(&mut self) -> (&'a [u8], TextPlace) {
        let word = self.peek();
        let place = self.place;
        self.rest = &self.rest[word.len()..];
        self.place.column += word.len();
        (word, place)
    }
}

/// Returns the index of a word among the keywords; `None` for other words.
fn keyword(word: &[u8]) -> Option<usize> {
    KEYWORDS.iter().position(|k| word.eq_ignore_ascii_case(k.as_bytes()))
}

/// Returns whether a file begins like an ESRI ASCII grid.
pub fn is_grid(bytes: &[u8]) -> bool {
    keyword(Words::new(&bytes[..bytes.len().min(1000)]).peek()).is_some()
}

fn parse<T: std::str::FromStr>(word: &[u8], place: TextPlace, what: &str) -> Result<T> {
    std::str::from_utf8(word).ok().and_then(|text| text.parse().ok()).ok_or_else(|| {
        let word = word[..word.len().min(200)].escape_ascii().to_string();
        let got = if word.is_empty() { "the end of the file".into() } else { shown(&word) };
        Error::new(Status::Parse, format!("{place}: must be {what}, got {got}"))
    })
}

/// Value of a keyword, and its place.
#[derive(Clone, Copy)]
struct HeaderValue {
    value: f64,
    place: TextPlace,
}

/// Values of the header, by keyword.
struct Header {
    values: [Option<HeaderValue>; KEYWORDS.len()],
    /// Place of the first height.
    end: TextPlace,
}

impl Header {
    fn read(words: &mut Words<'_>) -> Result<Self> {
        let mut values = [None; KEYWORDS.len()];
        while let Some(key) = keyword(words.peek()) {
            let key_place = words.next().1;
            let (word, place) = words.next();
            let name = KEYWORDS[key];
            let value = match name {
                "ncols" | "nrows" => f64::from(parse::<u32>(word, place, &format!("a whole number for {name}"))?),
                _ => parse(word, place, &format!("a number for {name}"))?,
            };
            if values[key].replace(HeaderValue { value, place }).is_some() {
                let sentence = format!("{key_place}: {name} must be there once, this is another");
                return Err(Error::new(Status::Parse, sentence));
            }
        }
        Ok(Self { values, end: words.place })
    }

    fn value(&self, name: &str) -> Option<HeaderValue> {
        self.values[KEYWORDS.iter().position(|k| *k == name)?]
    }

    /// Returns the value of a keyword that the header must have, checked against a range.
    fn needed(&self, name: &str, low: f64, high: f64) -> Result<f64> {
        let found = self.value(name).ok_or_else(|| {
            let listed = "ncols, nrows and cellsize (or dx and dy)";
            let sentence = format!("{}: {listed} must stand before the heights, {name} is missing", self.end);
            Error::new(Status::Parse, sentence)
        })?;
        let placed = |e: Error| e.with_status(Status::Parse).found_in(found.place);
        check_range(name, found.value, low, high, "").map_err(placed)?;
        Ok(found.value)
    }

    /// Returns the number of columns or rows.
    fn side(&self, name: &str) -> Result<u32> {
        self.needed(name, 1.0, MAX_HEIGHT_SAMPLES as f64).map(|side| side as u32)
    }

    /// Returns the distance between samples to the east and to the north.
    fn cell(&self) -> Result<[f64; 2]> {
        let [low, high] = CELL_RANGE;
        if self.value("dx").is_none() && self.value("dy").is_none() {
            return Ok([self.needed("cellsize", low, high)?; 2]);
        }
        Ok([self.needed("dx", low, high)?, self.needed("dy", low, high)?])
    }

    /// Returns the place of the south-western sample: half a cell from the corner if the header gives the corner, else
    /// the centre that the header gives. `None` unless the header gives one of them in both directions.
    fn south_west(&self, cell: [f64; 2]) -> Result<Option<[f64; 2]>> {
        let side = |corner: &str, center: &str, cell: f64| {
            let moved = |(name, shift): (&str, f64)| {
                let far = MOST_PLACE;
                self.value(name).map(|_| Ok(self.needed(name, -far, far)? + shift)).transpose()
            };
            Ok(moved((corner, 0.5 * cell))?.or(moved((center, 0.0))?))
        };
        let (x, y) = (side("xllcorner", "xllcenter", cell[0])?, side("yllcorner", "yllcenter", cell[1])?);
        Ok(x.zip(y).map(|(x, y)| [x, y]))
    }
}

pub fn read(bytes: &[u8], settings: &HeightSettings) -> Result<HeightMap> {
    let mut words = Words::new(bytes);
    let header = Header::read(&mut words)?;
    let (columns, rows) = (header.side("ncols")?, header.side("nrows")?);
    let cell = header.cell()?;
    let south_west = header.south_west(cell)?;
    // A height has at least one digit and a space.
    let needed = (u64::from(columns) * u64::from(rows)).saturating_mul(2).saturating_sub(1);
    if needed > words.rest.len() as u64 {
        let sentence = format!(
            "{}: {columns} x {rows} heights need at least {needed} bytes, {} are left",
            header.end,
            words.rest.len()
        );
        return Err(Error::new(Status::Parse, sentence));
    }
    let mut samples = Samples::new(columns, rows, settings).map_err(|e| e.found_in(header.end))?;
    samples.own_no_data = header.value("nodata_value").map(|none| none.value);
    let all = u64::from(columns) * u64::from(rows);
    while (samples.len() as u64) < all {
        let (word, place) = words.next();
        samples.take(parse(word, place, &format!("height {} of {all}", samples.len() + 1))?, place)?;
    }
    if !words.peek().is_empty() {
        let sentence = format!("{}: the file must end after {columns} x {rows} heights", words.place);
        return Err(Error::new(Status::Parse, sentence));
    }
    Ok(samples.finish(RowOrder::NorthFirst).placed(Some(cell), south_west))
}
