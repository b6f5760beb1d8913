//! The probe for scripts: diameters and kinds as CSV in, fall speeds as a column behind each line.

use crate::{
    error::{Error, Result, Status},
    falling::flakes::FlakeKind,
};

/// Largest diameter that is accepted, mm.
const MOST_MM: f64 = 100.0;

fn fault(line: usize, column: usize, what: impl std::fmt::Display) -> Error {
    Error::new(Status::Parse, format!("line {}, column {column}: {what}", line + 1))
}

/// Answers CSV with columns `diameter_mm` ([0, 100]) and `kind` (a name of [`FlakeKind::NAMES`]) with the terminal speed at sea level,
/// `speed_m_s`.
///
/// # Errors
/// [`Status::Parse`] with line and column for wrong input.
pub fn speed_csv(text: &str) -> Result<String> {
    let mut lines = text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty());
    let (first, header) = lines.next().ok_or_else(|| fault(0, 1, "a header with diameter_mm,kind is missing"))?;
    let names: Vec<&str> = header.split(',').map(str::trim).collect();
    let place = |name: &str| {
        let found = names.iter().position(|n| *n == name);
        found.ok_or_else(|| fault(first, 1, format!("no column {name} among {names:?}")))
    };
    let (diameter_at, kind_at) = (place("diameter_mm")?, place("kind")?);
    let mut out = format!("{header},speed_m_s\n");
    for (number, line) in lines {
        let fields: Vec<&str> = line.split(',').collect();
        if fields.len() != names.len() {
            let what = format!("{} fields, the header has {}", fields.len(), names.len());
            return Err(fault(number, line.chars().count() + 1, what));
        }
        let column = |at: usize| 1 + fields[..at].iter().map(|f| f.chars().count() + 1).sum::<usize>();
        let (diameter, kind) = (fields[diameter_at].trim(), fields[kind_at].trim());
        let d = diameter.parse::<f64>().ok().filter(|v| (0.0..=MOST_MM).contains(v)).ok_or_else(|| {
            let what = format!("diameter_mm must be a number in [0, {MOST_MM}] mm, got {diameter:?}");
            fault(number, column(diameter_at), what)
        })?;
        let of = FlakeKind::from_name(kind).ok_or_else(|| {
            let known = FlakeKind::NAMES.map(|(name, _)| name).join(", ");
            fault(number, column(kind_at), format!("kind must be one of {known}, got {kind:?}"))
        })?;
        out.push_str(&format!("{line},{:?}\n", of.speed_m_s(d)));
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_come_back_behind_their_lines() {
        let out = speed_csv("id,diameter_mm,kind\na,1,unrimed\n\nb, 8 ,densely-rimed\nc,0,graupel\n").unwrap();
        let lines: Vec<&str> = out.lines().collect();
        assert_eq!(
            (lines[0], lines[1], lines[3]),
            ("id,diameter_mm,kind,speed_m_s", "a,1,unrimed,0.8", "c,0,graupel,0.0")
        );
        let b: f64 = lines[2].rsplit(',').next().unwrap().parse().unwrap();
        assert!((b / (0.79 * 8f64.powf(0.27)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn wrong_input_is_named_by_line_and_column() {
        for (text, wanted) in [
            ("", "line 1, column 1: a header with diameter_mm,kind is missing"),
            ("diameter_mm\n1\n", "line 1, column 1: no column kind"),
            ("kind,diameter_mm\nrimed,-1\n", "line 2, column 7: diameter_mm must be a number in [0, 100] mm"),
            ("diameter_mm,kind\n2,slush\n", "line 2, column 3: kind must be one of unrimed, rimed"),
            ("diameter_mm,kind\n2\n", "line 2, column 2: 1 fields, the header has 2"),
        ] {
            let e = speed_csv(text).unwrap_err();
            assert!(e.to_string().starts_with(wanted), "{text:?}: {e}");
        }
    }
}
