//! Groups of figures: wind, visibility, runway visual range, cloud, temperatures, pressure, sea. Each function reads
//! one word and returns `None` if the word is not that group.

use std::ops::RangeInclusive;

use super::super::kinds::CloudKind;
use super::amounts::Amount;
use super::report::RunwayVisualRange;

/// Metres in a foot.
const FOOT_M: f64 = 0.3048;
/// Metres in a statute mile.
const MILE_M: f64 = 1609.344;
/// Metres a second in a knot.
const KNOT_M_S: f64 = 1852.0 / 3600.0;
/// Hectopascals in an inch of mercury (ICAO, at 0 C).
const INCH_HG_HPA: f64 = 33.8639;

/// A figure of a report; `None` if slashes or the letter M mark it as missing, or the report leaves it out.
pub(super) type Reading<T> = Option<T>;

/// Reads all of `text` as a number of 1 to 6 digits.
fn digits(text: &str) -> Option<u32> {
    let plain = !text.is_empty() && text.len() <= 6 && text.bytes().all(|b| b.is_ascii_digit());
    if plain { text.parse().ok() } else { None }
}

/// Whether `text` consists of exactly `n` slashes.
fn missing(text: &str, n: usize) -> bool {
    text.len() == n && text.bytes().all(|b| b == b'/')
}

/// Whether `text` stands for figures that could not be measured: slashes, or the letter M of American stations.
fn unmeasured(text: &str) -> bool {
    !text.is_empty() && (text.bytes().all(|b| b == b'/') || text.bytes().all(|b| b == b'M'))
}

/// Splits after `n` bytes if a character ends there.
fn split(text: &str, n: usize) -> Option<(&str, &str)> {
    (text.is_char_boundary(n) && n <= text.len()).then(|| text.split_at(n))
}

/// Wind of a report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WindGroup {
    pub speed_m_s: f64,
    /// `None`: variable (VRB) or missing.
    pub from_deg: Option<f64>,
    pub gust_m_s: Option<f64>,
    pub variable: bool,
}

/// Reads the speed of a wind in the group's unit: two or three digits. P before them means "more than", and the digits
/// are then taken as the speed.
fn speed(text: &str) -> Option<f64> {
    let figures = text.strip_prefix('P').unwrap_or(text);
    if (2..=3).contains(&figures.len()) { digits(figures).map(f64::from) } else { None }
}

/// Reads a wind: `24009KT`, `18018G31KT`, `VRB02KT`, `02003MPS`, `24109G120KT`, `270P99KT`. The outer `None` is "not a
/// wind", the inner one a missing wind (`/////KT`). Up to six zeros mean calm. A group with a speed above 120 m/s, or
/// with a gust below the speed or above 150 m/s, is not a wind.
pub(super) fn wind(text: &str) -> Option<Reading<WindGroup>> {
    let (figures, unit) = [("KT", KNOT_M_S), ("MPS", 1.0), ("KMH", 1.0 / 3.6), ("KPH", 1.0 / 3.6)]
        .iter()
        .find_map(|(suffix, unit)| text.strip_suffix(suffix).map(|f| (f, *unit)))?;
    if unmeasured(&figures.replace('G', "")) {
        return Some(None);
    }
    if digits(figures) == Some(0) {
        return Some(Some(WindGroup { speed_m_s: 0.0, from_deg: Some(0.0), gust_m_s: None, variable: false }));
    }
    let (direction, rest) = split(figures, 3)?;
    let (mean, gust) = rest.split_once('G').map_or((rest, None), |(m, g)| (m, Some(g)));
    let speed_m_s = if unmeasured(mean) { return Some(None) } else { speed(mean)? * unit };
    let gust_m_s = match gust {
        Some(g) if !unmeasured(g) => Some(speed(g)? * unit),
        _ => None,
    };
    let from_deg = match direction {
        "VRB" | "///" | "MMM" => None,
        d => Some(f64::from(digits(d).filter(|d| *d <= 360)?)),
    };
    let possible = speed_m_s <= 120.0 && gust_m_s.is_none_or(|g| g >= speed_m_s && g <= 150.0);
    possible.then_some(Some(WindGroup { speed_m_s, from_deg, gust_m_s, variable: direction == "VRB" }))
}

/// Reads `160V220`: the range over which the direction varies, degrees.
pub(super) fn wind_range(text: &str) -> Option<(f64, f64)> {
    let (from, to) = text.split_once('V')?;
    let angle = |t: &str| if t.len() == 3 { digits(t).filter(|d| *d <= 360).map(f64::from) } else { None };
    Some((angle(from)?, angle(to)?))
}

/// Visibility of a report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct VisibilityGroup {
    pub metres: f64,
    /// Whether the figure is a lower bound.
    pub at_least: bool,
}

/// Reads `0150`, `9999`, `4500NDV`, `4500SW` (older reports), `12KM`; the inner `None` is missing (`////NDV`). 0000
/// means below 50 m and becomes 25 m. 9999, also in a direction, becomes 10 km. It and 10KM are lower bounds; other
/// numbers of kilometres are exact.
pub(super) fn visibility_metres(text: &str) -> Option<Reading<VisibilityGroup>> {
    if text == "////NDV" {
        return Some(None);
    }
    if let Some(km) = text.strip_suffix("KM").and_then(digits).filter(|km| (1..=999).contains(km)) {
        return Some(Some(VisibilityGroup { metres: f64::from(km) * 1000.0, at_least: km == 10 }));
    }
    let overall = || {
        let figures = text.strip_suffix("NDV").or(text.strip_suffix('M')).unwrap_or(text);
        if figures.len() == 4 { digits(figures) } else { None }
    };
    let group = match directional_visibility(text).or_else(overall)? {
        9999 => VisibilityGroup { metres: 10_000.0, at_least: true },
        0 => VisibilityGroup { metres: 25.0, at_least: false },
        m => VisibilityGroup { metres: f64::from(m), at_least: false },
    };
    Some(Some(group))
}

/// Reads `10SM`, `P6SM`, `1/2SM`, `M1/4SM` in statute miles; `whole` is the previous word if it is a number of miles.
/// 10 is a lower bound, because automatic stations measure no further and most observers report no more (FMH-1, table
/// 12-1); 11 and more are exact. A figure with M (less than) is read as the figure itself, and one with P as a lower
/// bound. The visibility is at least 25 m. More than 500 miles are no visibility. The inner `None` is missing
/// (`////SM`).
pub(super) fn visibility_miles(whole: Option<&str>, text: &str) -> Option<Reading<VisibilityGroup>> {
    let figures = text.strip_suffix("SM")?;
    if whole.is_none() && unmeasured(figures) {
        return Some(None);
    }
    let more = whole.is_none() && figures.starts_with('P');
    let bare = if whole.is_none() { figures.trim_start_matches(['P', 'M']) } else { figures };
    if figures.len() - bare.len() > 1 {
        return None;
    }
    let part = match bare.split_once('/') {
        Some((a, b)) => {
            let below = digits(b).filter(|b| *b > 0)?;
            // The space in a mixed number is often missing: 11/2SM is one and a half, but 11/16SM is a fraction.
            let (glued, above) =
                if whole.is_none() && a.len() == 2 && digits(a)? >= below { split(a, 1)? } else { ("0", a) };
            f64::from(digits(glued)?) + f64::from(digits(above)?) / f64::from(below)
        }
        None if whole.is_some() => return None,
        None => f64::from(digits(bare)?),
    };
    let miles = part + whole.map_or(Some(0.0), |w| digits(w).map(f64::from))?;
    let metres = (miles * MILE_M).max(25.0);
    (miles <= 500.0)
        .then_some(Some(VisibilityGroup { metres, at_least: more || (miles == 10.0 && !figures.starts_with('M')) }))
}

/// Reads `1000SW`, `100NW`: visibility in a direction, metres. The direction is not kept.
fn directional_visibility(text: &str) -> Option<u32> {
    let figures = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let direction = &text[figures.len()..];
    let known = matches!(direction, "N" | "NE" | "E" | "SE" | "S" | "SW" | "W" | "NW");
    if known && (3..=4).contains(&figures.len()) { digits(figures) } else { None }
}

/// Reads `R18R/0350N`, `R04R/2600V5000FT`, `R27L/P1500U`, `R25/1800FT/D`; the inner `None` is missing (`R18R/////`).
pub(super) fn runway_visual_range(text: &str) -> Option<Reading<RunwayVisualRange>> {
    let (runway, rest) = text.strip_prefix('R')?.split_once('/')?;
    let (number, side) = split(runway, 2)?;
    if digits(number).is_none_or(|n| n > 36) || !matches!(side, "" | "L" | "R" | "C" | "LL" | "RR") {
        return None;
    }
    if rest.len() >= 4 && rest.bytes().all(|b| b == b'/') {
        return Some(None);
    }
    let (rest, trend) = [("/U", 1), ("/D", -1), ("/N", 0), ("U", 1), ("D", -1), ("N", 0)]
        .iter()
        .find_map(|(suffix, trend)| rest.strip_suffix(suffix).map(|r| (r, *trend)))
        .unwrap_or((rest, 0));
    let (rest, unit) = rest.strip_suffix("FT").map_or((rest, 1.0), |r| (r, FOOT_M));
    let (low, high) = rest.split_once('V').map_or((rest, None), |(l, h)| (l, Some(h)));
    let figure = |t: &str| {
        let bare = t.strip_prefix(['P', 'M']).unwrap_or(t);
        if bare.len() == 4 { digits(bare).map(|m| (f64::from(m) * unit).max(25.0)) } else { None }
    };
    Some(Some(RunwayVisualRange {
        runway: runway.into(),
        range_m: figure(low)?,
        up_to_m: high.map_or(Some(None), |h| figure(h).map(Some))?,
        is_minimum: low.starts_with('P'),
        is_maximum: low.starts_with('M'),
        trend,
    }))
}

/// Cloud of a report: a layer, a clear sky, or an obscured one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum CloudGroup {
    /// Amount, and base above the station, m; `None` where missing.
    Layer { amount: Reading<Amount>, base_m: Reading<f64>, kind: CloudKind },
    /// No (significant) cloud, or none detected by an instrument.
    Clear,
    /// Obscured sky, with the vertical visibility in m if known.
    Obscured(Reading<f64>),
    /// No cloud information from the instrument (`//////`).
    Missing,
}

/// Reads `SCT042`, `BKN018CB`, `BKN015///`, `///015`, `VV001`, `CLR`, `//////CB`.
pub(super) fn cloud(text: &str) -> Option<CloudGroup> {
    if matches!(text, "SKC" | "CLR" | "NSC" | "NCD") {
        return Some(CloudGroup::Clear);
    }
    let height = |t: &str| match t {
        "///" => Some(None),
        t if t.len() == 3 => digits(t).map(|h| Some(f64::from(h) * 100.0 * FOOT_M)),
        _ => None,
    };
    if let Some(rest) = text.strip_prefix("VV") {
        return height(rest).map(CloudGroup::Obscured);
    }
    let (amount, rest) = split(text, 3)?;
    let (base, kind) = split(rest, 3)?;
    let kind = match kind.trim_end_matches('/') {
        "" => CloudKind::Unknown,
        "CB" => CloudKind::Cumulonimbus,
        "TCU" => CloudKind::ToweringCumulus,
        _ => return None,
    };
    let amount = match amount {
        "FEW" => Some(Amount::Few),
        "SCT" => Some(Amount::Scattered),
        "BKN" => Some(Amount::Broken),
        "OVC" => Some(Amount::Overcast),
        "///" => None,
        _ => return None,
    };
    let base_m = height(base)?;
    let missing = amount.is_none() && base_m.is_none() && kind == CloudKind::Unknown;
    Some(if missing { CloudGroup::Missing } else { CloudGroup::Layer { amount, base_m, kind } })
}

/// Range of temperatures accepted in a report, C: the range of `Weather::temperature_c`.
const CELSIUS: RangeInclusive<f64> = -90.0..=60.0;

/// Reads a temperature of two digits, with M or a minus before them if it is below zero. The inner `None` is missing
/// (`//`, `XX`, `M`, `MM` or nothing).
fn celsius(text: &str) -> Option<Reading<f64>> {
    if matches!(text, "//" | "" | "XX" | "M" | "MM") {
        return Some(None);
    }
    let (figures, sign) = text.strip_prefix(['M', '-']).map_or((text, 1.0), |t| (t, -1.0));
    if figures.len() != 2 {
        return None;
    }
    // M00 means a reading between 0 and -0.5. Adding 0.0 turns its -0.0 into 0.0.
    let t = f64::from(digits(figures)?) * sign + 0.0;
    CELSIUS.contains(&t).then_some(Some(t))
}

/// Reads `11/10`, `M03/M05`, `03/`, `///05`, `M/M`: temperature and dew point.
pub(super) fn temperatures(text: &str) -> Option<(Reading<f64>, Reading<f64>)> {
    let (t, d) = match (text.strip_suffix("///"), text.strip_prefix("///")) {
        (Some(t), _) => (t, "//"),
        (_, Some(d)) => ("//", d),
        _ => text.split_once('/')?,
    };
    // One or two slashes alone are no temperatures: `//` is present weather that an instrument could not identify.
    if text.len() > 2 { Some((celsius(t)?, celsius(d)?)) } else { None }
}

/// Reads `Q1009`, `Q998`, `A2986`, `Q////`: pressure at sea level, hPa, from 800 to 1100.
pub(super) fn pressure(text: &str) -> Option<Reading<f64>> {
    let (unit, figures) = split(text, 1)?;
    let factor = match unit {
        "Q" => 1.0,
        "A" => 0.01 * INCH_HG_HPA,
        _ => return None,
    };
    if unmeasured(figures) {
        return Some(None);
    }
    let complete = figures.len() == 4 || (unit == "Q" && figures.len() == 3);
    let hpa = if complete { f64::from(digits(figures)?) * factor } else { return None };
    (800.0..=1100.0).contains(&hpa).then_some(Some(hpa))
}

/// State of the sea from a report.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct SeaGroup {
    pub temperature_c: Reading<f64>,
    /// State of the sea, WMO code table 3700.
    pub state: Reading<u8>,
    pub wave_height_m: Reading<f64>,
}

/// Reads `W10/S5`, `WM01/S2`, `W///S3`, `W10/S/`, `W19/H75` (height in decimetres), `W///H///`. Slashes stand for
/// values that could not be measured.
pub(super) fn sea(text: &str) -> Option<SeaGroup> {
    let body = text.strip_prefix('W')?;
    let (water, surface) = split(body, if body.starts_with('M') { 3 } else { 2 })?;
    let (kind, figures) = split(surface.strip_prefix('/')?, 1)?;
    let unknown = (1..=3).contains(&figures.len()) && missing(figures, figures.len());
    let temperature_c = celsius(water)?;
    let mut group = SeaGroup { temperature_c, ..SeaGroup::default() };
    match kind {
        "S" if figures == "/" => {}
        "S" if figures.len() == 1 => group.state = Some(u8::try_from(digits(figures)?).ok()?),
        "H" if unknown => {}
        "H" if figures.len() <= 3 => group.wave_height_m = Some(f64::from(digits(figures)?) * 0.1),
        _ => return None,
    }
    let possible = temperature_c.is_none_or(|t| (-3.0..=45.0).contains(&t));
    (possible && group.wave_height_m.is_none_or(|h| h <= 30.0)).then_some(group)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-6
    }

    #[test]
    fn winds_in_every_unit() {
        let knots = wind("18018G31KT").unwrap().unwrap();
        assert!(near(knots.speed_m_s, 9.26) && near(knots.gust_m_s.unwrap(), 15.947_777_777));
        assert_eq!(knots.from_deg, Some(180.0));
        assert!(near(wind("02003MPS").unwrap().unwrap().speed_m_s, 3.0));
        assert!(near(wind("090036KMH").unwrap().unwrap().speed_m_s, 10.0));
        assert!(wind("VRB02KT").unwrap().unwrap().variable);
        assert_eq!(wind("24109G120KT").unwrap().unwrap().from_deg, Some(241.0));
        assert!(near(wind("270P99KT").unwrap().unwrap().speed_m_s, 50.93));
        for missing in ["/////KT", "/////MPS", "/////G//KT", "240//KT", "///////KT", "MMMMMKT"] {
            assert_eq!(wind(missing), Some(None), "{missing}");
        }
        for calm in ["00000KT", "0000KT", "000000KT", "00000MPS"] {
            assert_eq!(wind(calm).unwrap().unwrap().speed_m_s, 0.0, "{calm}");
        }
        assert_eq!(wind("24009G//KT").unwrap().unwrap().gust_m_s, None);
        assert_eq!(wind("///09KT").unwrap().unwrap().from_deg, None);
        for bad in [
            "2409KT",
            "36109KT",
            "24009",
            "24020G10KT",
            "24X09KT",
            "KT",
            "VR02KT",
            "240999KT",
            "24009GKT",
            "é4009KT",
            "/////",
        ] {
            assert_eq!(wind(bad), None, "{bad}");
        }
        assert_eq!(
            (wind_range("160V220"), wind_range("010VVRB"), wind_range("1V2")),
            (Some((160.0, 220.0)), None, None)
        );
    }

    #[test]
    fn visibilities_in_metres_and_miles() {
        let metres = |t| visibility_metres(t).map(|v| v.map(|v| (v.metres, v.at_least)));
        assert_eq!(metres("0150"), Some(Some((150.0, false))));
        assert_eq!(metres("9999"), Some(Some((10_000.0, true))));
        assert_eq!(metres("9999NDV"), Some(Some((10_000.0, true))));
        assert_eq!((metres("9999NE"), metres("0000SW")), (Some(Some((10_000.0, true))), Some(Some((25.0, false)))));
        assert_eq!((metres("////NDV"), metres("0000")), (Some(None), Some(Some((25.0, false)))));
        assert_eq!(metres("10KM"), Some(Some((10_000.0, true))));
        assert_eq!((metres("20KM"), metres("30KM")), (Some(Some((20_000.0, false))), Some(Some((30_000.0, false)))));
        assert_eq!((metres("100NW"), metres("5000M")), (Some(Some((100.0, false))), Some(Some((5000.0, false)))));
        assert_eq!((metres("150"), metres("XX50"), metres("15000")), (None, None, None));
        let miles = |w, t| visibility_miles(w, t).and_then(|v| v.map(|v| (v.metres.round(), v.at_least)));
        assert_eq!(miles(Some("1"), "1/2SM"), Some((2414.0, false)));
        assert_eq!(miles(None, "1/2SM"), Some((805.0, false)));
        assert_eq!((miles(None, "11/2SM"), miles(None, "11/16SM")), (Some((2414.0, false)), Some((1106.0, false))));
        assert_eq!(miles(None, "M1/4SM"), Some((402.0, false)));
        assert_eq!(miles(None, "10SM"), Some((16_093.0, true)));
        assert_eq!((miles(None, "12SM"), miles(None, "15SM")), (Some((19_312.0, false)), Some((24_140.0, false))));
        assert_eq!((miles(None, "M10SM"), miles(None, "P15SM")), (Some((16_093.0, false)), Some((24_140.0, true))));
        assert_eq!(miles(None, "P6SM"), Some((9656.0, true)));
        for bad in ["XXSM", "1/0SM", "SM", "PM6SM", "/SM", "999999SM"] {
            assert_eq!(miles(None, bad), None, "{bad}");
        }
        assert_eq!((metres("1000SW"), metres("1000Q")), (Some(Some((1000.0, false))), None));
    }

    #[test]
    fn runway_ranges() {
        let r = runway_visual_range("R18R/0350N").unwrap().unwrap();
        assert_eq!((r.runway.as_str(), r.range_m, r.trend), ("18R", 350.0, 0));
        assert_eq!(runway_visual_range("R22/0400U").unwrap().unwrap().trend, 1);
        let r = runway_visual_range("R04R/2600V5000FT").unwrap().unwrap();
        assert!(near(r.range_m, 792.48) && near(r.up_to_m.unwrap(), 1524.0));
        assert!(runway_visual_range("R27L/P1500U").unwrap().unwrap().is_minimum);
        assert!(runway_visual_range("R25/M0600FT/D").unwrap().unwrap().is_maximum);
        assert_eq!(runway_visual_range("R18R/////"), Some(None));
        for bad in ["R18R", "R37/0400", "R18/04", "R18X/0400", "R/0400", "18/0400"] {
            assert_eq!(runway_visual_range(bad), None, "{bad}");
        }
    }

    #[test]
    fn clouds_and_hidden_skies() {
        let layer = |amount, feet: f64, kind| Some(CloudGroup::Layer { amount, base_m: Some(feet * FOOT_M), kind });
        assert_eq!(cloud("SCT042"), layer(Some(Amount::Scattered), 4200.0, CloudKind::Unknown));
        assert_eq!(cloud("BKN018CB"), layer(Some(Amount::Broken), 1800.0, CloudKind::Cumulonimbus));
        assert_eq!(cloud("FEW030TCU"), layer(Some(Amount::Few), 3000.0, CloudKind::ToweringCumulus));
        assert_eq!(cloud("BKN015////"), layer(Some(Amount::Broken), 1500.0, CloudKind::Unknown));
        assert_eq!(cloud("///015"), layer(None, 1500.0, CloudKind::Unknown));
        assert_eq!((cloud("CLR"), cloud("VV///")), (Some(CloudGroup::Clear), Some(CloudGroup::Obscured(None))));
        assert_eq!(cloud("VV001"), Some(CloudGroup::Obscured(Some(100.0 * FOOT_M))));
        assert_eq!(cloud("//////"), Some(CloudGroup::Missing));
        assert!(matches!(cloud("//////CB"), Some(CloudGroup::Layer { base_m: None, .. })));
        for bad in ["SCT42", "BKN018XX", "VV1", "OVC", "ABC010", "OVC0é"] {
            assert_eq!(cloud(bad), None, "{bad}");
        }
    }

    #[test]
    fn temperatures_pressures_and_seas() {
        assert_eq!(temperatures("M03/M05"), Some((Some(-3.0), Some(-5.0))));
        assert_eq!(temperatures("00/M01"), Some((Some(0.0), Some(-1.0))));
        assert_eq!((temperatures("03/"), temperatures("03///")), (Some((Some(3.0), None)), Some((Some(3.0), None))));
        assert_eq!((temperatures("M/M"), temperatures("/")), (Some((None, None)), None));
        assert_eq!(
            (temperatures("M05/M"), temperatures("-05/-07")),
            (Some((Some(-5.0), None)), Some((Some(-5.0), Some(-7.0))))
        );
        assert_eq!(temperatures("///M05"), Some((None, Some(-5.0))));
        assert_eq!((temperatures("M90/M90"), temperatures("M91/M95")), (Some((Some(-90.0), Some(-90.0))), None));
        assert_eq!((temperatures("99/10"), temperatures("1/1"), temperatures("11-10")), (None, None, None));
        assert!(near(pressure("A2992").unwrap().unwrap(), 1_013.207_888));
        assert_eq!((pressure("Q0991"), pressure("Q////")), (Some(Some(991.0)), Some(None)));
        assert_eq!((pressure("Q998"), pressure("AMMMM")), (Some(Some(998.0)), Some(None)));
        assert_eq!((pressure("Q0700"), pressure("Q99"), pressure("B1000"), pressure("")), (None, None, None, None));
        assert_eq!(sea("W10/S5"), Some(SeaGroup { temperature_c: Some(10.0), state: Some(5), wave_height_m: None }));
        assert_eq!(sea("WM01/S2").unwrap().temperature_c, Some(-1.0));
        assert_eq!(sea("W///S3"), Some(SeaGroup { temperature_c: None, state: Some(3), wave_height_m: None }));
        assert_eq!(sea("W19/H75").unwrap().wave_height_m, Some(7.5));
        for unknown in ["W///S/", "W///H///", "W///H/"] {
            assert_eq!(sea(unknown), Some(SeaGroup::default()), "{unknown}");
        }
        assert_eq!(sea("W10/S/").unwrap().temperature_c, Some(10.0));
        for bad in ["W10", "W10/S", "W10/S12", "WS", "W/", "W10/X5", "W10/H", "W60/S3", "W10/H999", "WM9/S1", "W///S//"]
        {
            assert_eq!(sea(bad), None, "{bad}");
        }
    }
}
