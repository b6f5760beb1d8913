//! `probe snow-speed`: the fall speed of flakes.

use welkin::{Result, snow::flakes::FlakeKind};

use crate::csv::{Column, Table};

/// Needs columns `diameter_mm` (\[0, 100\]) and `kind` (a name of [`FlakeKind::NAMES`]). Answers with the terminal
/// speed at sea level, `speed_m_s`.
///
/// # Errors
/// [`welkin::Status::Parse`] with line and column for wrong input.
pub fn speeds(text: &str) -> Result<String> {
    let table = Table::read(text, "diameter_mm,kind")?;
    let diameters = table.numbers(&[Column::new("diameter_mm", [0.0, 100.0], "mm")])?;
    let place = table.place("kind")?;
    let mut answers = Vec::new();
    for (row, [diameter_mm]) in table.rows.iter().zip(diameters) {
        let field = &table.fields(row)?[place];
        let name = field.text.trim();
        let kind = FlakeKind::from_name(name).ok_or_else(|| {
            let known = FlakeKind::NAMES.map(|(name, _)| name).join(", ");
            field.fault(format!("kind must be one of {known}, got {name:?}"))
        })?;
        answers.push(format!("{:?}", kind.speed_m_s(diameter_mm)));
    }
    Ok(table.answered("speed_m_s", answers))
}
