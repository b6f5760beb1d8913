//! Aerodrome reports (METAR and SPECI, WMO-No. 306 FM 15 and FM 16): from the text of an airport to a `Weather`.
//!
//! The grammar is our own. The crate `metar`, which reads the same code, panics on some malformed reports (`010VVRB`),
//! refuses SPECI, winds of three digits and `M1/4SM`, and says what it expected letter by letter; a library that must
//! neither panic nor print cannot stand on it. It stays as the tests' second opinion.

mod amounts;
mod assumed;
mod fault;
mod groups;
mod map;
#[cfg(test)]
mod odd_reports;
mod parse;
mod phenomena;
mod report;
mod supplements;

use super::model::Weather;
use crate::error::Result;
pub use assumed::ASSUMED_FIELDS;
pub use report::{MAX_METAR_BYTES, MetarOptions, MetarPlaces, MetarReport, RunwayVisualRange};

impl Weather {
    /// Reads a METAR or SPECI report of at most [`MAX_METAR_BYTES`], with cloud amounts by the station's rule.
    ///
    /// What is there is read, in any order up to the pressure. What is not is listed in [`MetarReport::assumed`], words
    /// that are no group in [`MetarReport::unread`]. Rates of precipitation follow from kind, intensity and, for rain
    /// and snow, visibility. Feet, knots, statute miles and inches become SI units.
    ///
    /// The weather's `station_altitude_m` is 0, because no report carries it: set it from a list of airports.
    ///
    /// # Errors
    /// [`crate::Status::Parse`] for a text without a station, without an observation (NIL) or without any group of the
    /// weather; the message gives line and column (both from 1, in characters), what was expected there and what was
    /// found. Never panics, whatever the text.
    pub fn from_metar(text: &str) -> Result<MetarReport> {
        Self::from_metar_with(text, &MetarOptions::default())
    }

    /// Reads a report as `options` say; see [`Weather::from_metar`].
    ///
    /// # Errors
    /// As [`Weather::from_metar`].
    pub fn from_metar_with(text: &str, options: &MetarOptions) -> Result<MetarReport> {
        map::report(parse::parse(text)?, options)
    }
}
