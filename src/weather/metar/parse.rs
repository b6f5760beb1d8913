//! The order of the groups in a report, and which may be left out.

use super::fault::{Word, fault, words};
use super::groups::{self, CloudGroup, Reading, SeaGroup, VisibilityGroup, WindGroup};
use super::phenomena::{self, WeatherGroup};
use super::{MAX_METAR_BYTES, RunwayVisualRange};
use crate::error::{Error, Result, Status};

/// A report as it is written, before it means weather.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Parsed {
    pub special: bool,
    pub automatic: bool,
    pub corrected: bool,
    pub station: String,
    pub day: u32,
    pub hour: u32,
    pub minute: u32,
    pub wind: Reading<WindGroup>,
    pub wind_range: Option<(f64, f64)>,
    pub cavok: bool,
    pub visibility: Reading<VisibilityGroup>,
    pub lowest_visibility_m: Option<f64>,
    pub runways: Vec<RunwayVisualRange>,
    pub weather: Vec<WeatherGroup>,
    pub clouds: Vec<CloudGroup>,
    pub temperature_c: Reading<f64>,
    pub dew_point_c: Reading<f64>,
    pub pressure_hpa: Reading<f64>,
    pub sea: Option<SeaGroup>,
    pub trend: String,
    pub remarks: String,
}

/// The words still to read.
struct Reader<'a> {
    report: &'a str,
    words: Vec<Word<'a>>,
    next: usize,
}

impl<'a> Reader<'a> {
    fn peek(&self, ahead: usize) -> Option<&'a str> {
        self.words.get(self.next + ahead).map(|w| w.text)
    }

    /// Takes the next word if it is `word`.
    fn accept(&mut self, word: &str) -> bool {
        let found = self.peek(0) == Some(word);
        self.next += usize::from(found);
        found
    }

    /// Takes the next word if `read` understands it.
    fn optional<T>(&mut self, read: impl Fn(&str) -> Option<T>) -> Option<T> {
        let value = read(self.peek(0)?)?;
        self.next += 1;
        Some(value)
    }

    /// Takes the next word, which `read` must understand.
    fn required<T>(&mut self, expected: &str, read: impl Fn(&str) -> Option<T>) -> Result<T> {
        self.optional(read).ok_or_else(|| self.refuse(expected))
    }

    /// As [`Self::required`], but a group may be left out where a later one follows: American stations leave out what they could
    /// not measure (FMH-1, 12.6). A report that merely ends is cut short, not complete.
    fn unless_later<T>(
        &mut self,
        expected: &str,
        later: fn(&str) -> bool,
        read: impl Fn(&str) -> Option<Reading<T>>,
    ) -> Result<Reading<T>> {
        if let Some(value) = self.optional(read) {
            return Ok(value);
        }
        if self.peek(0).is_some_and(later) { Ok(None) } else { Err(self.refuse(expected)) }
    }

    fn refuse(&self, expected: &str) -> Error {
        let end = self.words.last().map_or(0, |w| w.at + w.text.len());
        let at = self.words.get(self.next).map_or(end, |w| w.at);
        fault(self.report, at, expected, self.peek(0))
    }

    /// The text from here to before a word that is `stop`, or to the end; takes those words.
    fn rest_before(&mut self, stop: &str) -> String {
        let from = self.next;
        while self.peek(0).is_some_and(|w| w != stop) {
            self.next += 1;
        }
        self.words[from..self.next].iter().map(|w| w.text).collect::<Vec<_>>().join(" ")
    }
}

/// Four letters or digits, the first a letter.
fn station(text: &str) -> Option<String> {
    let good = text.len() == 4 && text.bytes().all(|b| b.is_ascii_uppercase() || b.is_ascii_digit());
    (good && text.as_bytes()[0].is_ascii_uppercase()).then(|| text.into())
}

/// `171853Z`: day, hour and minute.
fn time(text: &str) -> Option<(u32, u32, u32)> {
    let figures = text.strip_suffix('Z').filter(|f| f.len() == 6 && f.bytes().all(|b| b.is_ascii_digit()))?;
    let two = |i: usize| figures[i..i + 2].parse::<u32>().ok();
    let (day, hour, minute) = (two(0)?, two(2)?, two(4)?);
    ((1..=31).contains(&day) && hour < 24 && minute < 60).then_some((day, hour, minute))
}

/// Groups after the pressure that say nothing of the weather now: recent weather, wind shear, runway states, military colours.
fn is_supplement(text: &str) -> bool {
    let colour = matches!(text, "BLU+" | "BLU" | "WHT" | "GRN" | "YLO" | "YLO1" | "YLO2" | "AMB" | "RED");
    let recent = text.strip_prefix("RE").is_some_and(|w| phenomena::weather(w).is_some());
    let runway = text.strip_prefix('R').is_some_and(|r| r.contains('/') || r.starts_with(|c: char| c.is_ascii_digit()));
    // Runway and state in eight figures, an older form: 88490391.
    let figures = text.len() == 8 && text.bytes().all(|b| b.is_ascii_digit() || b == b'/') && text != "////////";
    let shear = matches!(text, "WS" | "ALL" | "RWY" | "TKOF" | "LDG") || text.starts_with("RWY");
    colour
        || text.starts_with("BLACK")
        || recent
        || runway
        || figures
        || shear
        || matches!(text, "$" | "SNOCLO" | "R/SNOCLO")
}

/// Whether a word is a group that stands after the pressure.
fn is_ending(text: &str) -> bool {
    text == "RMK" || is_trend(text) || groups::sea(text).is_some() || is_supplement(text)
}

/// Whether a word is a group that stands after the temperatures.
fn is_after_temperatures(text: &str) -> bool {
    groups::pressure(text).is_some() || text == "RMK"
}

/// Whether a word is a group that stands after the visibility.
fn is_after_visibility(text: &str) -> bool {
    groups::runway_visual_range(text).is_some()
        || phenomena::weather(text).is_some()
        || groups::cloud(text).is_some()
        || groups::temperatures(text).is_some()
}

/// Whether a word is a visibility or a group after it: what stands after the wind.
fn is_after_wind(text: &str) -> bool {
    text == "CAVOK"
        || groups::visibility_metres(text).is_some()
        || groups::visibility_miles(None, text).is_some()
        || is_after_visibility(text)
}

/// Beginning of a trend forecast.
fn is_trend(text: &str) -> bool {
    let from = text.strip_prefix("FM").is_some_and(|t| t.bytes().all(|b| b.is_ascii_digit()));
    matches!(text, "NOSIG" | "BECMG" | "TEMPO" | "INTER") || from || text.starts_with("PROB")
}

/// Reads the groups in their order.
///
/// # Errors
/// [`Status::Parse`] with line, column and what was expected at the first word out of order.
pub(super) fn parse(report: &str) -> Result<Parsed> {
    if report.len() > MAX_METAR_BYTES {
        let message = format!("METAR must be at most {MAX_METAR_BYTES} bytes, got {}", report.len());
        return Err(Error::new(Status::Parse, message));
    }
    let mut r = Reader { report, words: words(report), next: 0 };
    let mut p = Parsed::default();
    heading(&mut r, &mut p)?;
    wind_and_visibility(&mut r, &mut p)?;
    while let Some(range) = r.optional(groups::runway_visual_range) {
        p.runways.extend(range);
    }
    while let Some(group) = r.optional(phenomena::weather) {
        p.weather.extend(group);
    }
    while let Some(cloud) = r.optional(groups::cloud) {
        p.clouds.push(cloud);
    }
    temperature_and_pressure(&mut r, &mut p)?;
    ending(&mut r, &mut p)?;
    Ok(p)
}

fn heading(r: &mut Reader<'_>, p: &mut Parsed) -> Result<()> {
    p.special = r.accept("SPECI");
    if !p.special {
        r.accept("METAR");
    }
    p.corrected = r.accept("COR");
    p.station = r.required("a station of four letters, such as EGLL", station)?;
    (p.day, p.hour, p.minute) = r.required("day and time of the month as DDHHMMZ, such as 171853Z", time)?;
    if r.peek(0) == Some("NIL") {
        return Err(r.refuse("an observation; this station sent none"));
    }
    loop {
        match r.peek(0) {
            Some("AUTO") => p.automatic = true,
            Some("COR") => p.corrected = true,
            // Canada numbers its corrections by letters.
            Some(w) if w.len() == 3 && w.starts_with("CC") => p.corrected = true,
            // Sent late (Canada, United States).
            Some("RTD") => {}
            _ => return Ok(()),
        }
        r.next += 1;
    }
}

fn wind_and_visibility(r: &mut Reader<'_>, p: &mut Parsed) -> Result<()> {
    p.wind = r.unless_later(
        "wind, such as 24009KT, 18018G31KT, VRB02KT or 02003MPS, the gust above the mean",
        is_after_wind,
        groups::wind,
    )?;
    p.wind_range = r.optional(groups::wind_range);
    if r.accept("CAVOK") {
        p.cavok = true;
        return Ok(());
    }
    let expected = "visibility, such as 4500, 9999, 1 1/2SM, 10SM, CAVOK or ////";
    let whole_miles = |w: &&str| w.len() <= 2 && w.bytes().all(|b| b.is_ascii_digit());
    p.visibility = match r.peek(0).filter(whole_miles) {
        Some(whole) => {
            let miles =
                r.peek(1).and_then(|t| groups::visibility_miles(Some(whole), t)).ok_or_else(|| r.refuse(expected))?;
            r.next += 2;
            miles
        }
        None => r.unless_later(expected, is_after_visibility, |t| {
            groups::visibility_miles(None, t).or_else(|| groups::visibility_metres(t))
        })?,
    };
    while let Some(metres) = r.optional(groups::directional_visibility) {
        p.lowest_visibility_m = Some(p.lowest_visibility_m.map_or(metres, |m| m.min(metres)));
    }
    Ok(())
}

fn temperature_and_pressure(r: &mut Reader<'_>, p: &mut Parsed) -> Result<()> {
    let expected = if !p.clouds.is_empty() || p.cavok {
        "cloud, such as SCT042, or temperature and dew point, such as 11/10 or M03/M05 (M90 to 60)"
    } else if !p.weather.is_empty() {
        "present weather, such as -RA or BR, cloud, such as SCT042, VV001 or CLR, or temperature and dew point, such as 11/10"
    } else {
        "runway visual range, such as R18R/0350N, present weather, such as -RA, cloud, such as SCT042, VV001 or CLR, or temperature and dew \
         point, such as 11/10"
    };
    let both = |t: &str| groups::temperatures(t).map(Some);
    (p.temperature_c, p.dew_point_c) = r.unless_later(expected, is_after_temperatures, both)?.unwrap_or((None, None));
    let expected = "pressure, such as Q1009 or A2986, 800 to 1100 hPa";
    p.pressure_hpa = r.unless_later(expected, is_ending, groups::pressure)?;
    // Some stations give both units; the first counts.
    while r.optional(groups::pressure).is_some() {}
    Ok(())
}

fn ending(r: &mut Reader<'_>, p: &mut Parsed) -> Result<()> {
    while let Some(word) = r.peek(0) {
        match word {
            "RMK" => {
                r.next += 1;
                p.remarks = r.rest_before("");
            }
            w if is_trend(w) => p.trend = r.rest_before("RMK"),
            w if groups::sea(w).is_some() => {
                p.sea = groups::sea(w);
                r.next += 1;
            }
            w if is_supplement(w) => r.next += 1,
            _ => {
                let expected = "recent weather, wind shear, the sea, such as W10/S5, a trend, such as NOSIG, or RMK";
                return Err(r.refuse(expected));
            }
        }
    }
    Ok(())
}
