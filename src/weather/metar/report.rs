//! Reports as they are answered, `MetarReport`: the weather and what surrounds it, and how a report is read.

use std::ops::Range;

use crate::weather::kinds::CloudAmountRule;
use crate::weather::model::Weather;

/// Longest report that is read, bytes; real ones stay below 500.
pub const MAX_METAR_BYTES: usize = 4096;

/// How a report is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MetarOptions {
    /// How the amounts of cloud groups count. Default by the station.
    pub cloud_amounts: CloudAmountRule,
}

impl Default for MetarOptions {
    fn default() -> Self {
        Self { cloud_amounts: CloudAmountRule::ByStation }
    }
}

/// Where parts of a report stand in its text, bytes; empty ranges at 0 where it has none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MetarPlaces {
    /// Runway visual ranges, from the first to the last.
    pub runways: Range<usize>,
    /// The trend forecast, its first word included.
    pub trend: Range<usize>,
    /// The remarks, without RMK.
    pub remarks: Range<usize>,
    /// The first word that could not be read.
    pub unread: Range<usize>,
}

/// Content of a report: the weather, and what surrounds it.
#[derive(Clone, Debug, PartialEq)]
pub struct MetarReport {
    /// The weather. `station_altitude_m` is 0, because reports do not carry it: look `station` up in a list of airports
    /// and set it before use. Cloud bases, visibility and temperature refer to that height.
    pub weather: Weather,
    /// ICAO location indicator, four letters or digits.
    pub station: String,
    /// Day of the month, 1 to 31 (UTC); 0 where the report has no time.
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
    /// The report says only that visibility is at least so much (CAVOK, 9999, 10SM, P6SM). `weather.visibility_m` is
    /// then what [`crate::weather::unlimited_visibility_m`] makes of humidity and precipitation, at least the reported
    /// figure.
    pub visibility_is_minimum: bool,
    /// Lowest visibility in some direction where the report states one beside the prevailing visibility (`4000 1500NE`,
    /// `9999 3100`), m. For information: extinction follows the prevailing one.
    pub lowest_visibility_m: Option<f64>,
    /// Rule by which the amounts of clouds were read: sums or layers.
    pub cloud_amounts: CloudAmountRule,
    /// Runway visual ranges, in the report's order.
    pub runways: Vec<RunwayVisualRange>,
    /// Fields of `weather` that the report leaves out or marks as missing: names from [`super::ASSUMED_FIELDS`]. They
    /// hold defaults, or what the rest of the report makes likely.
    pub assumed: Vec<&'static str>,
    /// Words that are no group of the code, in the report's order. They change nothing.
    pub unread: Vec<String>,
    /// Trend forecast (from NOSIG, BECMG or TEMPO on), empty without one. It is not parsed.
    pub trend: String,
    /// Remarks (after RMK), empty without any. They are not parsed, but for PWINO, which says that the present weather
    /// is unknown.
    pub remarks: String,
    /// Where these parts stand in the text.
    pub places: MetarPlaces,
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
