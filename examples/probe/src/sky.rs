//! `probe sky`, `probe aerial`, `probe irradiance`: the drawn sky along rays.

use std::collections::BTreeMap;

use welkin::Result;
use welkin::sky::probe::{Answer, Probe, Question, Ray};

use crate::csv::{Column, Table};

const COLUMNS: [Column; 5] = [
    Column::new("altitude_m", [-1e4, 1e8], "m"),
    Column::new("sun_zenith_deg", [0.0, 180.0], "deg"),
    Column::new("view_zenith_deg", [0.0, 180.0], "deg"),
    Column::new("azimuth_deg", [-360.0, 360.0], "deg"),
    Column::new("distance_m", [0.0, 1e9], "m"),
];

/// Columns that a question reads; other columns may be empty or missing.
fn needed(question: Question) -> &'static [Column] {
    match question {
        Question::Irradiance => &COLUMNS[..2],
        Question::Sky | Question::Ground => &COLUMNS[..4],
        Question::Aerial => &COLUMNS,
    }
}

/// Needs columns `altitude_m,sun_zenith_deg`; for the sky also `view_zenith_deg,azimuth_deg` (of the view, relative to
/// the sun's); for aerial also `distance_m`. Answers `L1,L2,L3,T1,T2,T3`: see [`Question`].
///
/// # Errors
/// [`welkin::Status::Parse`] with line and column for wrong input, before any question is answered; GPU faults.
pub fn rays(probe: &mut Probe, question: Question, text: &str) -> Result<String> {
    let table = Table::read(text, "altitude_m,sun_zenith_deg,..")?;
    // Rows with the same altitude and sun share an observer's tables.
    let mut groups: BTreeMap<[u64; 2], Vec<(usize, Ray)>> = BTreeMap::new();
    let numbers = table.numbers(needed(question))?;
    for (i, [altitude, sun, view, azimuth, distance]) in numbers.into_iter().enumerate() {
        let ray = Ray::at(view.to_radians(), azimuth.to_radians(), distance);
        groups.entry([altitude.to_bits(), sun.to_bits()]).or_default().push((i, ray));
    }
    let mut answers = vec![Answer::default(); table.rows.len()];
    for ([altitude, sun], asked) in groups {
        let rays: Vec<Ray> = asked.iter().map(|(_, r)| *r).collect();
        let sun = f64::from_bits(sun).to_radians();
        let got = probe.under_sun(question, f64::from_bits(altitude), sun, &rays)?;
        asked.iter().zip(got).for_each(|((i, _), a)| answers[*i] = a);
    }
    let shown = |a: Answer| {
        let [l, t] = [a.radiance, a.transmittance];
        [l[0], l[1], l[2], t[0], t[1], t[2]].map(|v| format!("{v:?}")).join(",")
    };
    Ok(table.answered("L1,L2,L3,T1,T2,T3", answers.into_iter().map(shown)))
}
