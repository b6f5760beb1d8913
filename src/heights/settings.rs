//! Settings by which numbers in files become heights and heights become numbers.

use super::map::{HeightMap, check_size};
use crate::error::{Error, Result, check_range};

/// Height of a number in a file: `base_m + step_m x number`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightScale {
    /// Height difference for a difference of 1 in the number, m; negative where numbers are depths. Its absolute value
    /// is in \[1e-6, 10 000\]. Default 1; 0.3048 for international feet, 1200/3937 for US survey feet.
    pub step_m: f64,
    /// Height of the number 0, m, within 1 000 000. Default 0.
    pub base_m: f64,
}

impl Default for HeightScale {
    fn default() -> Self {
        Self { step_m: 1.0, base_m: 0.0 }
    }
}

impl HeightScale {
    /// Returns the finest scale, with steps of at least 1e-6 m, by which all heights of a map have numbers from 1 to
    /// 65 535. The number 0 stays free and may mean no data.
    pub fn fitting(map: &HeightMap) -> Self {
        let [low, high] = map.range_m().unwrap_or_default().map(f64::from);
        let step_m = ((high - low) / 65_534.0).max(1e-6);
        Self { step_m, base_m: low - step_m }
    }
}

/// Kind of the numbers in a raw file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RawSample {
    /// Whole numbers of 16 bits, 0 to 65 535.
    U16,
    /// Whole numbers of 16 bits, -32 768 to 32 767.
    I16,
    /// Floats of 32 bits (IEEE 754).
    F32,
}

impl RawSample {
    /// Returns the size of a number, bytes.
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::U16 | Self::I16 => 2,
            Self::F32 => 4,
        }
    }
}

/// Order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ByteOrder {
    /// Lowest byte first: what GDAL and most programs write.
    Little,
    /// Highest byte first: SRTM's `.hgt`.
    Big,
}

/// Row with which a file begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowOrder {
    /// Northernmost row first, as in pictures and in most elevation files.
    NorthFirst,
    /// Southernmost row first.
    SouthFirst,
}

/// Layout of a raw file: numbers and nothing else, each row from west to east.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RawHeights {
    /// Number of samples from west to east, at least 1.
    pub columns: u32,
    /// Number of rows, at least 1.
    pub rows: u32,
    /// Kind of the numbers.
    pub sample: RawSample,
    /// Order of the bytes of a number.
    pub byte_order: ByteOrder,
    /// Row with which the file begins.
    pub row_order: RowOrder,
}

/// Settings for reading and writing heights. A map that is written and read with the same settings is the same within
/// half a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeightSettings {
    /// Scale from numbers to heights. In an ESRI ASCII grid the number is the one in the text. In a Terragen file the
    /// number is the height in metres.
    pub scale: HeightScale,
    /// Number in the file that means no data, before it is scaled, such as -9999 or -32768. NaN always means no data,
    /// and so do the number that an ESRI ASCII grid names and transparent pixels of a PNG. Default: none.
    pub no_data: Option<f64>,
    /// Layout of a raw file. With `None`, the default, files have one of the other formats, which are recognised by
    /// their first bytes.
    pub raw: Option<RawHeights>,
}

impl HeightSettings {
    /// Checks every field.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn check(&self) -> Result<()> {
        let step = self.scale.step_m;
        if !(1e-6..=1e4).contains(&step.abs()) {
            return Err(Error::range("scale.step_m", "1e-6 to 10000 m in amount", step));
        }
        check_range("scale.base_m", self.scale.base_m, -1e6, 1e6, "m")?;
        self.raw.map_or(Ok(()), |raw| check_size(raw.columns, raw.rows).map_err(|e| e.within("raw")))
    }

    /// Returns whether a number in a file means no data.
    pub(super) fn is_no_data(&self, number: f64) -> bool {
        number.is_nan() || self.no_data.is_some_and(|none| is_same(none, number))
    }
}

/// Returns whether two numbers are the same as 32-bit floats, the form in which most files hold them.
pub(super) fn is_same(a: f64, b: f64) -> bool {
    a as f32 == b as f32
}
