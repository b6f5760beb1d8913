//! ESRI ASCII grids (Esri, *Esri ASCII raster format*): keywords with values, then heights from the north-west.

use std::fmt;

use super::{
    super::{
        map::{HeightMap, check_cell},
        settings::{HeightSettings, RowOrder},
    },
    samples::Samples,
};
use crate::error::{Error, Result, Status, shown};

/// Keywords of the header, in lower case. GDAL writes `dx` and `dy` where cells are not square.
const KEYWORDS: [&str; 10] =
    ["ncols", "nrows", "xllcorner", "xllcenter", "yllcorner", "yllcenter", "cellsize", "dx", "dy", "nodata_value"];
/// Bytes that some programs put before text (Unicode's mark of byte order in UTF-8).
const MARK: &[u8] = b"\xef\xbb\xbf";

/// Place of a word in the text, from 1.
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

/// Words of a text, one after another.
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

/// Returns the keyword that a word is.
fn keyword(word: &[u8]) -> Option<usize> {
    KEYWORDS.iter().position(|k| word.eq_ignore_ascii_case(k.as_bytes()))
}

/// Returns whether a file begins as a grid does.
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

/// Values of the header, by keyword.
struct Header {
    values: [Option<f64>; KEYWORDS.len()],
    /// Place of the first height.
    end: TextPlace,
}

impl Header {
    fn read(words: &mut Words<'_>) -> Result<Self> {
        let mut values = [None; KEYWORDS.len()];
        while let Some(key) = keyword(words.peek()) {
            let place = words.next().1;
            let (word, value_place) = words.next();
            let name = KEYWORDS[key];
            let value = match name {
                "ncols" | "nrows" => f64::from(parse::<u32>(word, value_place, &format!("a whole number for {name}"))?),
                _ => parse(word, value_place, &format!("a number for {name}"))?,
            };
            if values[key].replace(value).is_some() {
                return Err(Error::new(Status::Parse, format!("{place}: {name} must be there once, this is another")));
            }
        }
        Ok(Self { values, end: words.place })
    }

    fn value(&self, name: &str) -> Option<f64> {
        self.values[KEYWORDS.iter().position(|k| *k == name)?]
    }

    fn needed(&self, name: &str) -> Result<f64> {
        self.value(name).ok_or_else(|| {
            let listed = "ncols, nrows and cellsize (or dx and dy)";
            Error::new(
                Status::Parse,
                format!("{}: {listed} must stand before the heights, {name} is missing", self.end),
            )
        })
    }

    /// Returns the distance between samples.
    fn cell(&self) -> Result<[f64; 2]> {
        let cell = match (self.value("dx"), self.value("dy")) {
            (None, None) => [self.needed("cellsize")?; 2],
            _ => [self.needed("dx")?, self.needed("dy")?],
        };
        let named = |e: Error| e.renamed("cell[0]", "cellsize").renamed("cell[1]", "dy").with_status(Status::Parse);
        check_cell(cell).map_err(|e| named(e).found_in("the header"))?;
        Ok(cell)
    }

    /// Returns the place of the south-western sample: half a cell from the corner, if that is given.
    fn south_west(&self, cell: [f64; 2]) -> Result<Option<[f64; 2]>> {
        let side = |corner: &str, center: &str, cell: f64| {
            let place = self.value(corner).map(|v| v + 0.5 * cell).or(self.value(center));
            if place.is_some_and(|v| !v.is_finite()) {
                let sentence = format!("the header: {corner} or {center} must be finite");
                return Err(Error::new(Status::Parse, sentence));
            }
            Ok(place)
        };
        let (x, y) = (side("xllcorner", "xllcenter", cell[0])?, side("yllcorner", "yllcenter", cell[1])?);
        Ok(x.zip(y).map(|(x, y)| [x, y]))
    }
}

pub fn read(bytes: &[u8], settings: &HeightSettings) -> Result<HeightMap> {
    let mut words = Words::new(bytes);
    let header = Header::read(&mut words)?;
    let (columns, rows) = (header.needed("ncols")? as u32, header.needed("nrows")? as u32);
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
    let mut samples = Samples::new(columns, rows, settings).map_err(|e| e.found_in("the header"))?;
    samples.own_no_data = header.value("nodata_value");
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
