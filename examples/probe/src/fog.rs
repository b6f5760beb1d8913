//! `probe fog`: the drawn fog by distance.

use welkin::{Error, Result, error::check_range, fog::probe, gpu::Device};

use crate::csv::Table;

/// Needs a column `distance_m` (\[0, 1e9\] m). Answers with the `contrast` and `transmittance` over that distance in
/// fog of visibility `visibility_m` (\[1, 1e6\] m).
///
/// # Errors
/// [`welkin::Status::Parse`] with line and column, before anything is drawn; [`welkin::Status::InvalidArgument`]; GPU
/// faults.
pub fn distances(device: &Device, visibility_m: f64, text: &str) -> Result<String> {
    let table = Table::read(text, "distance_m")?;
    let place = table.place("distance_m")?;
    let mut distances = Vec::new();
    for row in &table.rows {
        let field = &table.fields(row)?[place];
        let text = field.text.trim();
        let distance: f64 = text.parse().map_err(|_| field.fault(format!("distance_m is no number: {text:?}")))?;
        check_range("distance_m", distance, 0.0, 1e9, "m").map_err(|e: Error| field.fault(e))?;
        distances.push(distance);
    }
    let answers = probe(device, visibility_m, &distances)?;
    let shown = |[contrast, transmittance]: [f64; 2]| format!("{contrast:.7},{transmittance:.7}");
    Ok(table.answered("contrast,transmittance", answers.into_iter().map(shown)))
}
