//! Aerodrome reports (METAR and SPECI, WMO-No. 306 FM 15 and FM 16): from the text of an airport to a `Weather`.
//!
//! The grammar is our own. The crate `metar`, which reads the same code, panics on some malformed reports (`010VVRB`), refuses
//! SPECI, winds of three digits and `M1/4SM`, and says what it expected letter by letter; a library that must neither panic nor
//! print cannot stand on it. It stays as the tests' second opinion.

mod fault;
mod groups;
mod map;
#[cfg(test)]
mod odd_reports;
mod parse;
mod phenomena;

use super::model::Weather;
use crate::error::Result;

/// Longest report that is read, bytes; real ones stay below 500.
pub const MAX_METAR_BYTES: usize = 4096;

/// What a report says: the weather, and what surrounds it.
#[derive(Clone, Debug, PartialEq)]
pub struct MetarReport {
    /// The weather. `station_altitude_m` is 0: reports do not carry it.
    pub weather: Weather,
    /// ICAO location indicator, four letters or digits.
    pub station: String,
    /// Day of the month, 1 to 31 (UTC).
    pub day: u32,
    /// Hour, 0 to 23 (UTC).
    pub hour: u32,
    /// Minute, 0 to 59 (UTC).
    pub minute: u32,
    /// A special report (SPECI).
    pub special: bool,
    /// Made without an observer (AUTO).
    pub automatic: bool,
    /// A correction (COR).
    pub corrected: bool,
    /// The report says only that visibility is at least so much (CAVOK, 9999, 10SM, P6SM). `weather.visibility_m` is then what
    /// [`super::unlimited_visibility_m`] makes of humidity and precipitation, at least the reported figure.
    pub visibility_is_minimum: bool,
    /// Runway visual ranges, in the report's order.
    pub runways: Vec<RunwayVisualRange>,
    /// Fields of `weather` that the report leaves out or marks as missing; they hold defaults.
    pub assumed: Vec<&'static str>,
    /// Trend forecast (from NOSIG, BECMG or TEMPO on), empty without one. It is not parsed.
    pub trend: String,
    /// Remarks (after RMK), empty without any. They are not parsed.
    pub remarks: String,
}

/// Runway visual range of one runway.
#[derive(Clone, Debug, PartialEq)]
pub struct RunwayVisualRange {
    /// Runway designator, such as `18R`.
    pub runway: String,
    /// Range, m; the lower figure where it varies.
    pub range_m: f64,
    /// Upper figure where it varies, m.
    pub up_to_m: Option<f64>,
    /// The range is more than can be measured (P).
    pub is_minimum: bool,
    /// The range is less than can be measured (M).
    pub is_maximum: bool,
    /// It rises (1), falls (-1) or neither (0).
    pub trend: i32,
}

impl Weather {
    /// Reads a METAR or SPECI report of at most [`MAX_METAR_BYTES`].
    ///
    /// Rates of precipitation follow from kind, intensity and, for snow, visibility (see the report's mapping in the manual).
    /// Feet, knots, statute miles and inches become SI units.
    ///
    /// # Errors
    /// [`crate::Status::Parse`]; the message gives line and column (both from 1, in characters) of the group at fault, what
    /// was expected there and what was found. Never panics, whatever the text.
    pub fn from_metar(text: &str) -> Result<MetarReport> {
        map::report(&parse::parse(text)?)
    }
}
