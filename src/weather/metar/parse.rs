//! Assigns the words of a report to groups, one after another, and keeps the words that are no group.
//!
//! Stations leave out what they could not measure (FMH-1, 12.5), mark it (`////`, `M`), join groups without a space,
//! change their order and add words of their own. A word is therefore read as any group that it fits, in any order up
//! to the pressure. Of the words after the pressure, only temperatures, the sea and marks of missing groups still
//! describe the weather at the time of the report. A word that is no group is kept as unread.

use std::ops::Range;

use super::fault::{Word, fault, words};
use super::groups::{self, CloudGroup, Reading, SeaGroup, VisibilityGroup, WindGroup};
use super::phenomena::{self, WeatherGroup};
use super::report::{MAX_METAR_BYTES, MetarPlaces, RunwayVisualRange};
use super::supplements;
use crate::error::{Error, Result, Status};
use crate::weather::model::MAX_CLOUD_LAYERS;

/// A report as written, before it is converted to weather.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Parsed {
    pub special: bool,
    pub automatic: bool,
    pub corrected: bool,
    pub station: String,
    /// Day, hour and minute.
    pub time: Option<(u32, u32, u32)>,
    pub wind: Reading<WindGroup>,
    pub wind_range: Option<(f64, f64)>,
    pub cavok: bool,
    pub visibility: Reading<VisibilityGroup>,
    pub lowest_visibility_m: Option<f64>,
    pub runways: Vec<RunwayVisualRange>,
    pub weather: Vec<WeatherGroup>,
    /// Whether the station could not tell the present weather (`//`, PWINO), or the report has no weather group at all.
    pub weather_unknown: bool,
    pub clouds: Vec<CloudGroup>,
    pub temperature_c: Reading<f64>,
    pub dew_point_c: Reading<f64>,
    pub pressure_hpa: Reading<f64>,
    pub sea: Option<SeaGroup>,
    pub trend: String,
    pub remarks: String,
    /// Words that are no group, in the report's order.
    pub unread: Vec<String>,
    pub places: MetarPlaces,
    /// Whether the words from here on no longer describe the weather at the time of the report.
    ended: bool,
    /// Number of weather groups so far, including those marked as missing.
    groups: usize,
}

/// The words of a report, and the index of the next one to read.
struct Reader<'a> {
    report: &'a str,
    words: Vec<Word<'a>>,
    next: usize,
}

impl<'a> Reader<'a> {
    fn peek(&self, ahead: usize) -> Option<&'a str> {
        self.words.get(self.next + ahead).map(|w| w.text)
    }

    /// Takes the next word if `read` accepts it.
    fn optional<T>(&mut self, read: impl Fn(&str) -> Option<T>) -> Option<T> {
        let value = read(self.peek(0)?)?;
        self.next += 1;
        Some(value)
    }

    /// Returns the byte at which word `index` begins; if there is no such word, the byte at which the last one ends.
    fn at(&self, index: usize) -> usize {
        let end = self.words.last().map_or(0, |w| w.at + w.text.len());
        self.words.get(index).map_or(end, |w| w.at)
    }

    /// Returns the byte range of the words from the index `first` to the last one that has been read.
    fn bytes_since(&self, first: usize) -> Range<usize> {
        match self.words.get(first..self.next) {
            Some([one, .., last]) => one.at..last.at + last.text.len(),
            Some([one]) => one.at..one.at + one.text.len(),
            _ => 0..0,
        }
    }

    fn refuse(&self, index: usize, expected: &str) -> Error {
        fault(self.report, self.at(index), expected, self.words.get(index).map(|w| w.text))
    }

    /// Takes the words that are left, or those before RMK if `up_to_remarks`. Returns their text and byte range.
    fn rest(&mut self, up_to_remarks: bool) -> (String, Range<usize>) {
        let first = self.next;
        while self.peek(0).is_some_and(|w| !(up_to_remarks && is_remarks(w))) {
            self.next += 1;
        }
        let text = self.words[first..self.next].iter().map(|w| w.text).collect::<Vec<_>>().join(" ");
        (text, self.bytes_since(first))
    }
}

/// Reads a station: four letters or digits, the first a letter.
fn station(text: &str) -> Option<String> {
    let good = text.len() == 4 && text.bytes().all(|b| b.is_ascii_uppercase() || b.is_ascii_digit());
    (good && text.as_bytes()[0].is_ascii_uppercase() && text != "AUTO").then(|| text.into())
}

/// Reads `171853Z`: day, hour and minute; some stations leave out the Z.
fn time(text: &str) -> Option<(u32, u32, u32)> {
    let figures = text.strip_suffix('Z').unwrap_or(text);
    if figures.len() != 6 || !figures.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    let two = |i: usize| figures[i..i + 2].parse::<u32>().ok();
    let (day, hour, minute) = (two(0)?, two(2)?, two(4)?);
    ((1..=31).contains(&day) && hour < 24 && minute < 60).then_some((day, hour, minute))
}

/// Whether a word begins the remarks.
fn is_remarks(text: &str) -> bool {
    matches!(text, "RMK" | "RMKS")
}

/// Whether a word begins a trend forecast; TEMP0 is a frequent misspelling.
fn is_trend(text: &str) -> bool {
    let from = text.strip_prefix("FM").is_some_and(|t| t.bytes().all(|b| b.is_ascii_digit()));
    matches!(text, "NOSIG" | "BECMG" | "TEMPO" | "TEMP0" | "INTER") || from || text.starts_with("PROB")
}

/// Reads all groups.
///
/// # Errors
/// [`Status::Parse`] with line, column and what was expected, if there is no station, no observation, or neither a
/// weather group nor remarks. [`Status::Parse`] without line and column, if the text is longer than
/// [`MAX_METAR_BYTES`].
pub(super) fn parse(report: &str) -> Result<Parsed> {
    if report.len() > MAX_METAR_BYTES {
        let message = format!("METAR must be at most {MAX_METAR_BYTES} bytes, got {}", report.len());
        return Err(Error::new(Status::Parse, message));
    }
    let mut r = Reader { report, words: words(report), next: 0 };
    let mut p = Parsed::default();
    heading(&mut r, &mut p)?;
    let (mut first_unread, mut remarked) = (None, false);
    while let Some(word) = r.peek(0) {
        if is_remarks(word) {
            r.next += 1;
            remarked = true;
            (p.remarks, p.places.remarks) = r.rest(false);
        } else if is_trend(word) {
            (p.trend, p.places.trend) = r.rest(true);
        } else if !group(&mut r, &mut p) {
            first_unread.get_or_insert(r.next);
            // After the temperatures an unknown word ends the groups, as the pressure does: a forecast may follow.
            p.ended |= p.temperature_c.is_some();
            p.unread.push(word.into());
            r.next += 1;
        }
    }
    p.places.unread = first_unread.map_or(0..0, |i| r.words[i].at..r.words[i].at + r.words[i].text.len());
    // The sensor for present weather did not work (FMH-1, 12.7.2), or nothing did.
    p.weather_unknown |= p.remarks.split(' ').any(|w| w == "PWINO") || p.groups == 0;
    // A station that could measure nothing still ends its report with remarks.
    if p.groups == 0 && !remarked {
        let expected = "a group of the weather, such as 24009KT, 4500, 10SM, -RA, SCT042, 11/10 or Q1009";
        return Err(r.refuse(first_unread.unwrap_or(r.words.len()), expected));
    }
    Ok(p)
}

fn heading(r: &mut Reader<'_>, p: &mut Parsed) -> Result<()> {
    while let Some(word @ ("METAR" | "SPECI" | "COR")) = r.peek(0) {
        p.special |= word == "SPECI";
        p.corrected |= word == "COR";
        r.next += 1;
    }
    let expected = "a station of four letters, such as EGLL";
    p.station = r.optional(station).ok_or_else(|| r.refuse(r.next, expected))?;
    loop {
        match r.peek(0) {
            Some("NIL") => return Err(r.refuse(r.next, "an observation; this station sent none")),
            Some("AUTO") => p.automatic = true,
            Some("COR") => p.corrected = true,
            // Canada marks its corrections with letters.
            Some(w) if w.len() == 3 && w.starts_with("CC") => p.corrected = true,
            // RTD: sent late (Canada, United States).
            Some("RTD") => {}
            Some(w) if p.time.is_none() && time(w).is_some() => p.time = time(w),
            _ => return Ok(()),
        }
        r.next += 1;
    }
}

/// Takes the next group, of one word or of several. Returns `false` if no group begins with the next word.
fn group(r: &mut Reader<'_>, p: &mut Parsed) -> bool {
    let Some(word) = r.peek(0) else { return false };
    let is_now = !p.ended;
    let words = if missing(word, p) || air(word, p) || (is_now && runway(r, word, p)) {
        1
    } else if is_now && let taken @ 2.. = spaced(r, p) {
        taken
    } else {
        usize::from((is_now && pieces(word, p)) || sea(word, p))
    };
    p.groups += usize::from(words > 0);
    r.next += words;
    if words == 0 && supplements::is_supplement(word, p.ended) {
        r.next += 1;
        return true;
    }
    words > 0
}

fn runway(r: &Reader<'_>, word: &str, p: &mut Parsed) -> bool {
    let Some(range) = groups::runway_visual_range(word) else { return false };
    p.runways.extend(range);
    let start = if p.places.runways.is_empty() { r.at(r.next) } else { p.places.runways.start };
    p.places.runways = start..r.at(r.next) + word.len();
    true
}

/// Reads marks in place of a group that could not be measured: slashes, the letter M of American stations, MISG, or a
/// unit of wind without figures.
fn missing(word: &str, p: &mut Parsed) -> bool {
    let slashes = word.bytes().all(|b| b == b'/');
    // Two slashes stand for the present weather, six and more for the clouds.
    p.weather_unknown |= slashes && word.len() == 2;
    if slashes && word.len() >= 6 {
        p.clouds.push(CloudGroup::Missing);
    }
    slashes || matches!(word, "M" | "MM" | "MMM" | "MMMM" | "MMMMM" | "MISG" | "KT" | "MPS")
}

/// Reads temperatures and pressure, at any place in the report. Some stations give the pressure in both units; the
/// first one is kept.
fn air(word: &str, p: &mut Parsed) -> bool {
    if let Some(pressure) = groups::pressure(word) {
        p.pressure_hpa = p.pressure_hpa.or(pressure);
        p.ended = true;
        return true;
    }
    let unread = p.temperature_c.is_none() && p.dew_point_c.is_none();
    let Some(both) = groups::temperatures(word).filter(|_| unread) else { return false };
    (p.temperature_c, p.dew_point_c) = both;
    true
}

fn sea(word: &str, p: &mut Parsed) -> bool {
    let group = groups::sea(word);
    p.sea = p.sea.or(group);
    group.is_some()
}

/// Reads a group whose figures and unit are separate words (`1 1/2SM`, `1/4 SM`, `24009 KT`). Returns the number of its
/// words, 0 if there is none.
fn spaced(r: &Reader<'_>, p: &mut Parsed) -> usize {
    let (Some(first), Some(second)) = (r.peek(0), r.peek(1)) else { return 0 };
    let third = r.peek(2).unwrap_or("");
    let is_whole = first.len() <= 2 && first.bytes().all(|b| b.is_ascii_digit());
    let whole = |text: &str| if is_whole { groups::visibility_miles(Some(first), text) } else { None };
    let joined = [first, second].concat();
    let mut visibility = |group: Option<Reading<VisibilityGroup>>| {
        let new = group.filter(|_| p.visibility.is_none());
        p.visibility = new.flatten().or(p.visibility);
        new.is_some()
    };
    if third == "SM" && visibility(whole(&[second, third].concat())) {
        return 3;
    }
    let two = visibility(whole(second))
        || (matches!(second, "SM" | "KM") && visibility(visibility_of(&joined)))
        || (matches!(second, "KT" | "MPS" | "KMH") && one(&joined, p));
    if two { 2 } else { 0 }
}

/// Reads a word as a group, or as several groups without a space between them: `SCT120BKN180`.
fn pieces(word: &str, p: &mut Parsed) -> bool {
    if one(word, p) {
        return true;
    }
    let Some(parts) = split(word, false) else { return false };
    let mut all = p.clone();
    let read = parts.iter().all(|part| one(part, &mut all) || air(part, &mut all));
    if read {
        *p = all;
    }
    read
}

/// Longest word that is split into groups, bytes.
const MAX_GLUED_BYTES: usize = 40;

/// Splits a word without spaces into groups. At least one of them must have figures, because letters alone form words
/// of any language. `figures` is whether a group before `word` has figures.
fn split(word: &str, figures: bool) -> Option<Vec<&str>> {
    let has_figures = |t: &str| {
        groups::wind(t).flatten().is_some()
            || groups::wind_range(t).is_some()
            || visibility_of(t).flatten().is_some()
            || matches!(
                groups::cloud(t),
                Some(CloudGroup::Layer { base_m: Some(_), .. } | CloudGroup::Obscured(Some(_)))
            )
            || groups::temperatures(t).is_some_and(|(a, _)| a.is_some())
            || groups::pressure(t).flatten().is_some()
    };
    if word.len() > MAX_GLUED_BYTES || !word.is_ascii() {
        return None;
    }
    (2..word.len().saturating_sub(1)).rev().find_map(|n| {
        let (head, tail) = word.split_at(n);
        let figures = figures || has_figures(head);
        let known = has_figures(head) || phenomena::weather(head).is_some();
        if !known {
            return None;
        }
        if has_figures(tail) || (figures && phenomena::weather(tail).is_some()) {
            return Some(vec![head, tail]);
        }
        let mut parts = split(tail, figures)?;
        parts.insert(0, head);
        Some(parts)
    })
}

fn visibility_of(word: &str) -> Option<Reading<VisibilityGroup>> {
    groups::visibility_miles(None, word).or_else(|| groups::visibility_metres(word))
}

/// Takes one word that gives the present wind, visibility, weather or sky. Returns `false` if the word gives none of
/// these, or cannot be added to what was read before.
fn one(word: &str, p: &mut Parsed) -> bool {
    if word == "CAVOK" {
        p.cavok = true;
    } else if let Some(wind) = groups::wind(word).filter(|_| p.wind.is_none()) {
        p.wind = wind;
    } else if let Some(range) = groups::wind_range(word) {
        p.wind_range = Some(range);
    } else if let Some(sight) = visibility_of(word).filter(|_| p.temperature_c.is_none()) {
        return visibility(word, sight, p);
    } else if let Some(weather) = phenomena::weather(word) {
        p.weather.extend(weather);
    } else if let Some(cloud) = groups::cloud(word).filter(|_| p.clouds.len() < MAX_CLOUD_LAYERS) {
        p.clouds.push(cloud);
    } else {
        return false;
    }
    true
}

/// Reads a visibility. The first one is the prevailing visibility. A further one has a direction, or none if an
/// automatic station cannot tell the direction (`9999 3100`). It must be in metres or kilometres, and stand before all
/// runway visual ranges, weather and clouds. Returns `false` if the visibility cannot be one of these.
fn visibility(word: &str, sight: Reading<VisibilityGroup>, p: &mut Parsed) -> bool {
    if p.visibility.is_none() && !p.cavok {
        p.visibility = sight;
        return true;
    }
    let beside = p.weather.is_empty() && p.clouds.is_empty() && p.runways.is_empty() && !p.cavok;
    let metric = groups::visibility_metres(word).is_some();
    let Some(further) = sight.filter(|_| beside && metric) else { return false };
    p.lowest_visibility_m = Some(p.lowest_visibility_m.map_or(further.metres, |m| m.min(further.metres)));
    true
}
