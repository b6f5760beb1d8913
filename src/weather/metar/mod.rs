//! Parser for aerodrome reports (METAR and SPECI, WMO-No. 306 FM 15 and FM 16), from an airport's text to a `Weather`.
//!
//! The parser is Welkin's own. The crate `metar` reads the same code, but it panics on some malformed reports
//! (`010VVRB`), refuses SPECI, winds of three digits and `M1/4SM`, and its errors list the expected text letter by
//! letter. Welkin must not panic, so only its tests use that crate, to compare results.

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
    /// Groups up to the pressure may come in any order. [`MetarReport::assumed`] lists the fields that the report does
    /// not state, and [`MetarReport::unread`] the words that are no group. Rates of precipitation follow from kind,
    /// intensity and, for rain and snow, visibility. Feet, knots, statute miles and inches become SI units.
    ///
    /// The weather's `station_altitude_m` is 0, because no report contains it: set it from a list of airports.
    ///
    /// # Errors
    /// [`crate::Status::Parse`] for a text that is longer than [`MAX_METAR_BYTES`], or has no station, no observation
    /// (NIL), or neither a weather group nor remarks. Unless the text is too long, the message gives line and column
    /// (both from 1, in characters), what was expected there and what was found. Never panics, whatever the text.
    pub fn from_metar(text: &str) -> Result<MetarReport> {
        Self::from_metar_with(text, &MetarOptions::default())
    }

    /// Reads a report with `options`; see [`Weather::from_metar`].
    ///
    /// # Errors
    /// As [`Weather::from_metar`].
    pub fn from_metar_with(text: &str, options: &MetarOptions) -> Result<MetarReport> {
        map::report(parse::parse(text)?, options)
    }
}
