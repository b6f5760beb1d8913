//! The probe for scripts: rays as CSV in, the drawn sky's answers as two triples of columns behind each line.

use std::collections::BTreeMap;

use super::probe::{Answer, Probe, Question, Ray};
use crate::error::{Error, Result, Status};

/// A column of the input: name and accepted range.
struct Column {
    name: &'static str,
    range: (f64, f64),
    unit: &'static str,
}

const COLUMNS: [Column; 5] = [
    Column { name: "altitude_m", range: (-1e4, 1e8), unit: "m" },
    Column { name: "sun_zenith_deg", range: (0.0, 180.0), unit: "deg" },
    Column { name: "view_zenith_deg", range: (0.0, 180.0), unit: "deg" },
    Column { name: "azimuth_deg", range: (-360.0, 360.0), unit: "deg" },
    Column { name: "distance_m", range: (0.0, 1e9), unit: "m" },
];

/// Columns that a question reads; the others may be empty or absent.
fn needed(question: Question) -> usize {
    match question {
        Question::Irradiance => 2,
        Question::Sky | Question::Ground => 4,
        Question::Aerial => 5,
    }
}

fn fault(line: usize, column: usize, what: impl std::fmt::Display) -> Error {
    Error::new(Status::Parse, format!("line {}, column {column}: {what}", line + 1))
}

/// One line's numbers, in the order of [`COLUMNS`]; those that are not needed are 0.
fn numbers(line: &str, number: usize, places: &[Option<usize>; 5], count: usize, needed: usize) -> Result<[f64; 5]> {
    let fields: Vec<&str> = line.split(',').collect();
    if fields.len() != count {
        let what = format!("{} fields, the header has {count}", fields.len());
        return Err(fault(number, line.chars().count() + 1, what));
    }
    let mut out = [0.0; 5];
    for (i, column) in COLUMNS.iter().enumerate().take(needed) {
        let Some(place) = places[i] else { continue };
        let at = 1 + fields[..place].iter().map(|f| f.chars().count() + 1).sum::<usize>();
        let text = fields[place].trim();
        let (lo, hi) = column.range;
        let value = text.parse::<f64>().ok().filter(|v| v.is_finite() && (lo..=hi).contains(v));
        out[i] = value.ok_or_else(|| {
            fault(number, at, format!("{} must be a number in [{lo}, {hi}] {}, got {text:?}", column.name, column.unit))
        })?;
    }
    Ok(out)
}

/// Answers CSV with a header. Needs columns `altitude_m,sun_zenith_deg`, for the sky also `view_zenith_deg,azimuth_deg`
/// (of the view, relative to the sun's), for aerial also `distance_m`, in any order beside any others. Each line comes back
/// with `L1,L2,L3,T1,T2,T3`: see [`Question`]. Empty lines are left out.
///
/// # Errors
/// [`Status::Parse`] with line and column for wrong input, before anything is asked; GPU faults.
pub fn probe_csv(probe: &mut Probe, question: Question, text: &str) -> Result<String> {
    let mut lines = text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty());
    let (first, header) =
        lines.next().ok_or_else(|| fault(0, 1, "a header with altitude_m,sun_zenith_deg,.. is missing"))?;
    let names: Vec<&str> = header.split(',').map(str::trim).collect();
    let needed = needed(question);
    let places = COLUMNS.each_ref().map(|c| names.iter().position(|n| *n == c.name));
    if let Some(i) = (0..needed).find(|i| places[*i].is_none()) {
        return Err(fault(first, 1, format!("no column {} among {names:?}", COLUMNS[i].name)));
    }
    let mut kept = Vec::new();
    // Lines under one altitude and sun share an observer's tables.
    let mut groups: BTreeMap<[u64; 2], Vec<(usize, Ray)>> = BTreeMap::new();
    for (number, line) in lines {
        let [altitude, sun, view, azimuth, distance] = numbers(line, number, &places, names.len(), needed)?;
        let ray = Ray::at(view.to_radians(), azimuth.to_radians(), distance);
        groups.entry([altitude.to_bits(), sun.to_bits()]).or_default().push((kept.len(), ray));
        kept.push(line);
    }
    let mut answers = vec![Answer::default(); kept.len()];
    for ([altitude, sun], asked) in groups {
        let rays: Vec<Ray> = asked.iter().map(|(_, r)| *r).collect();
        let sun = f64::from_bits(sun).to_radians();
        let got = probe.under_sun(question, f64::from_bits(altitude), sun, &rays)?;
        asked.iter().zip(got).for_each(|((i, _), a)| answers[*i] = a);
    }
    let mut out = format!("{header},L1,L2,L3,T1,T2,T3\n");
    for (line, a) in kept.iter().zip(answers) {
        let [l, t] = [a.radiance, a.transmittance];
        let numbers = [l[0], l[1], l[2], t[0], t[1], t[2]].map(|v| format!("{v:?}")).join(",");
        out.push_str(&format!("{line},{numbers}\n"));
    }
    Ok(out)
}
