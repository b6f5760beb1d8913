//! `MetarReport`, the result of reading a report: the weather and its circumstances. Also the options for reading.

use std::ops::Range;

use crate::weather::kinds::CloudAmountRule;
use crate::weather::model::Weather;

/// Longest report that is read, bytes; real reports are shorter than 500.
pub const MAX_METAR_BYTES: usize = 4096;

/// Options for reading a report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MetarOptions {
    /// Rule by which the amounts of cloud groups are read. Default: by the station.
    pub cloud_amounts: CloudAmountRule,
}

impl Default for MetarOptions {
    fn default() -> Self {
        Self { cloud_amounts: CloudAmountRule::ByStation }
    }
}

/// Byte ranges of parts of a report in the report's text. A part that the report lacks has an empty range at 0.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MetarPlaces {
    /// Runway visual ranges, from the first to the last.
    pub runways: Range<usize>,
    /// The trend forecast, with its first word.
    pub trend: Range<usize>,
    /// The remarks, without RMK.
    pub remarks: Range<usize>,
    /// The first word that could not be read.
    pub unread: Range<usize>,
}

/// Content of a report: the weather and its circumstances.
#[derive(Clone, Debug, PartialEq)]
pub struct MetarReport {
    /// The weather. `station_altitude_m` is 0, because reports do not contain it: look up `station` in a list of
    /// airports and set it before use. Cloud bases, visibility and temperature refer to that height.
    pub weather: Weather,
    /// ICAO location indicator, four letters or digits.
    pub station: String,
    /// Day of the month, 1 to 31 (UTC); 0 if the report has no time.
    pub day: u32,
    /// Hour, 0 to 23 (UTC).
    pub hour: u32,
    /// Minute, 0 to 59 (UTC).
    pub minute: u32,
    /// Whether the report is a special one (SPECI).
    pub special: bool,
    /// Whether the report was made without an observer (AUTO).
    pub automatic: bool,
    /// Whether the report is a correction (COR; in Canada CC and a letter).
    pub corrected: bool,
    /// Whether the report gives only a lower bound of the visibility (CAVOK, 9999, 10SM, P6SM), or no visibility.
    /// `weather.visibility_m` is then [`crate::weather::unlimited_visibility_m`] for its humidity and precipitation,
    /// but at least the reported bound. Without a reported visibility it is at most what the reported fog or haze
    /// allows.
    pub visibility_is_minimum: bool,
    /// Lowest visibility in some direction, if the report gives one beside the prevailing visibility (`4000 1500NE`,
    /// `9999 3100`), m. For information only: extinction follows the prevailing one.
    pub lowest_visibility_m: Option<f64>,
    /// Rule by which the cloud amounts were read: sums or layers.
    pub cloud_amounts: CloudAmountRule,
    /// Runway visual ranges, in the report's order, without those marked as missing.
    pub runways: Vec<RunwayVisualRange>,
    /// Fields of `weather`, and the time, that the report leaves out or marks as missing: names from
    /// [`super::ASSUMED_FIELDS`]. The fields hold defaults, or values that the rest of the report makes likely.
    pub assumed: Vec<&'static str>,
    /// Words that are no group of the code, in the report's order. They have no effect.
    pub unread: Vec<String>,
    /// Trend forecast (from NOSIG, BECMG or TEMPO on), empty without one. It is not parsed.
    pub trend: String,
    /// Remarks (after RMK), empty without any. They are not parsed, except for PWINO, which means that the present
    /// weather is unknown.
    pub remarks: String,
    /// Byte ranges of runway visual ranges, trend, remarks and the first unread word in the text.
    pub places: MetarPlaces,
}

/// Runway visual range of one runway.
#[derive(Clone, Debug, PartialEq)]
pub struct RunwayVisualRange {
    /// Runway designator, such as `18R`.
    pub runway: String,
    /// Range, m; the lower value if it varies.
    pub range_m: f64,
    /// Upper value if it varies, m.
    pub up_to_m: Option<f64>,
    /// Whether the range is above what can be measured (P).
    pub is_minimum: bool,
    /// Whether the range is below what can be measured (M).
    pub is_maximum: bool,
    /// Trend: rising (1), falling (-1) or neither (0).
    pub trend: i32,
}
