//! Reads planet files: from TOML to a checked [`Planet`], or to an error with line, column, key, unit and range.

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::model::{FIELDS, Mie, Planet, PlanetField};
use crate::error::{Error, Result, Status, listed, shown, toml_message};

/// The only optional section. Without it the weather gives the haze.
const HAZE: &str = "mie";

impl Planet {
    /// Reads a planet file (TOML; every field of [`Planet`] as a key of its name, sections `rayleigh`, `mie`,
    /// `absorption`). Without `mie` the haze is the Earth's at the file's wavelengths.
    ///
    /// # Errors
    /// [`crate::Status::Parse`] for a text that is not TOML, and for a key that is missing, unknown or of the wrong
    /// kind; [`crate::Status::InvalidArgument`] for a value that is not finite or out of range, and for two values that
    /// contradict each other. The message names the key, its unit and the accepted range, or for an unknown key the
    /// known ones. It also names line and column, unless a key is missing or two values contradict each other.
    pub fn from_toml(text: &str) -> Result<Self> {
        parse(text)
    }
}

/// Parses and checks a whole planet file.
fn parse(text: &str) -> Result<Planet> {
    let root = DeTable::parse(text).map_err(|e| {
        let at = e.span().map_or(0, |s| s.start);
        file_error(text, at, Error::new(Status::Parse, format!("not TOML: {}", toml_message(&e))))
    })?;
    refuse_unknown(text, root.get_ref(), "")?;
    let mut planet = Planet::earth();
    let has_haze = root.get_ref().contains_key(HAZE);
    for field in FIELDS.iter().filter(|f| has_haze || f.section != HAZE) {
        read_field(text, root.get_ref(), field, &mut planet)?;
    }
    if !has_haze {
        planet.mie = Mie::earth_at(planet.wavelengths_nm);
    }
    planet.check()?;
    Ok(planet)
}

/// Refuses unknown keys and sections: a misspelt key must not silently leave a default in place.
fn refuse_unknown(text: &str, table: &DeTable<'_>, section: &str) -> Result<()> {
    for (key, value) in table.iter() {
        let name = key.get_ref().as_ref();
        let is_section = section.is_empty() && FIELDS.iter().any(|f| f.section == name);
        match (is_section, value.get_ref()) {
            (true, DeValue::Table(inner)) => refuse_unknown(text, inner, name)?,
            (true, _) => {
                let message = format!("`{0}` must be a section, [{0}]", shown(name));
                return Err(file_error(text, value.span().start, Error::new(Status::Parse, message)));
            }
            (false, _) if FIELDS.iter().any(|f| f.section == section && f.key == name) => {}
            (false, _) => {
                let place = if section.is_empty() { "at the top".to_owned() } else { format!("in [{section}]") };
                let known: Vec<&str> = FIELDS.iter().filter(|f| f.section == section).map(|f| f.key).collect();
                let message = format!("unknown key `{}` {place}; known: {}", shown(name), listed(&known));
                return Err(file_error(text, key.span().start, Error::new(Status::Parse, message)));
            }
        }
    }
    Ok(())
}

/// Reads one field into the planet and checks its range.
fn read_field(text: &str, root: &DeTable<'_>, field: &PlanetField, planet: &mut Planet) -> Result<()> {
    let table = match field.section {
        "" => Some(root),
        section => root.get(section).and_then(|v| v.get_ref().as_table()),
    };
    let Some(value) = table.and_then(|t| t.get(field.key)) else {
        let message = format!("planet file: `{}` is missing; it must be {}", field.name(), field.accepted());
        return Err(Error::new(Status::Parse, message));
    };
    let slots = (field.set)(planet);
    let numbers = match (value.get_ref(), slots.len()) {
        (DeValue::Array(list), 3) => numbers_of(list),
        (_, 1) => number(value).map(|n| vec![n]),
        _ => None,
    };
    let Some(numbers) = numbers.filter(|n| n.len() == slots.len()) else {
        let what = value.get_ref().type_str();
        let message = format!("`{}` must be {}, got another {what} or count", field.name(), field.accepted());
        return Err(file_error(text, value.span().start, Error::new(Status::Parse, message)));
    };
    slots.copy_from_slice(&numbers);
    let (lo, hi) = field.range;
    match numbers.iter().find(|v| !(v.is_finite() && (lo..=hi).contains(*v))) {
        None => Ok(()),
        Some(bad) => Err(file_error(text, value.span().start, Error::range(&field.name(), &field.accepted(), bad))),
    }
}

fn numbers_of(list: &DeArray<'_>) -> Option<Vec<f64>> {
    list.iter().map(number).collect()
}

/// Returns a TOML float or integer as a number (`6360000` means the same as `6360000.0`).
fn number(value: &Spanned<DeValue<'_>>) -> Option<f64> {
    match value.get_ref() {
        DeValue::Float(f) => f.as_str().parse().ok(),
        DeValue::Integer(i) if i.radix() == 10 => i.as_str().parse().ok(),
        _ => None,
    }
}

/// Returns an error of a planet file with its place in the text.
pub(crate) fn file_error(text: &str, byte: usize, error: Error) -> Error {
    let before = &text[..byte.min(text.len())];
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    error.found_in(format_args!("planet file, line {line}, column {column}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOLDEN: &str = include_str!("../../examples/data/planet_golden.toml");

    fn refused(old: &str, new: &str, status: Status, needles: &[&str]) {
        assert!(GOLDEN.contains(old), "{old}");
        let e = Planet::from_toml(&GOLDEN.replacen(old, new, 1)).unwrap_err();
        assert_eq!(e.status, status, "{}", e);
        for needle in needles {
            assert!(e.to_string().contains(needle), "`{}` does not say `{needle}`", e);
        }
    }

    #[test]
    fn faults_are_named_with_place_key_unit_and_range() {
        use Status::{InvalidArgument, Parse};
        refused("asymmetry_g = 0.8", "asymmetry = 0.8", Parse, &["line 18, column 1", "`asymmetry`", "[mie]"]);
        refused("[mie]", "[dust]", Parse, &["unknown key `dust`", "at the top"]);
        refused(
            "asymmetry_g = 0.8",
            "asymmetry_g = 1.5",
            InvalidArgument,
            &["line 18, column 15", "mie.asymmetry_g", "[-0.9999, 0.9999]", "1.5"],
        );
        refused(
            "bottom_radius_m = 6360000.0",
            "bottom_radius_m = nan",
            InvalidArgument,
            &["bottom_radius_m", "] m", "NaN"],
        );
        refused("bottom_radius_m = 6360000.0", "bottom_radius_m = -inf", InvalidArgument, &["bottom_radius_m", "-inf"]);
        refused(
            "bottom_radius_m = 6360000.0\n",
            "",
            Parse,
            &["`bottom_radius_m` is missing", "[1000.0, 1000000000.0] m"],
        );
        refused(
            "scale_height_m = 8000.0",
            "scale_height_m = -1",
            InvalidArgument,
            &["rayleigh.scale_height_m", "[0.0, 1000000.0] m"],
        );
        refused("scale_height_m = 8000.0", "scale_height_m = 1000001", InvalidArgument, &["rayleigh.scale_height_m"]);
        refused("[0.1, 0.1, 0.1]", "[0.1, 0.1]", Parse, &["ground_albedo", "three numbers, each in [0.0, 1.0]"]);
        refused("[0.1, 0.1, 0.1]", "0.1", Parse, &["ground_albedo", "three numbers"]);
        refused("8000.0", "\"8 km\"", Parse, &["rayleigh.scale_height_m", "string"]);
        refused(
            "6420000.0",
            "6350000.0",
            InvalidArgument,
            &["top_radius_m must be above bottom_radius_m = 6360000.0 m"],
        );
        refused("[mie]", "[mie", Parse, &["line 14", "not TOML"]);
        refused("[mie]", "[rayleigh]", Parse, &["not TOML"]);
    }

    #[test]
    fn a_file_without_haze_gets_the_weathers_and_a_file_with_haze_keeps_its_own() {
        let (from, to) = (GOLDEN.find("[mie]").unwrap(), GOLDEN.find("[absorption]").unwrap());
        let without = Planet::from_toml(&[&GOLDEN[..from], &GOLDEN[to..]].concat()).unwrap();
        let golden = Planet::from_toml(GOLDEN).unwrap();
        assert_eq!(without, Planet { mie: Mie::earth_at(golden.wavelengths_nm), ..golden });
        assert_eq!((without.own_haze(), golden.own_haze()), (None, Some(golden.mie)));
        // Numbers that differ by rounding, as on another machine, count as the Earth's.
        let mut rounded = without;
        rounded.mie.extinction_per_m[0] *= 1.0 + 1e-14;
        assert_eq!(rounded.own_haze(), None);
        rounded.mie.asymmetry_g = 0.75;
        assert_eq!(rounded.own_haze(), Some(rounded.mie));
        rounded.mie.extinction_per_m = [0.0; 3];
        assert_eq!(rounded.own_haze(), None, "there is none");
        // A section must be complete.
        refused("asymmetry_g = 0.8", "", Status::Parse, &["`mie.asymmetry_g` is missing"]);
    }

    #[test]
    fn integers_and_zero_heights_are_numbers_too() {
        let text = GOLDEN.replacen("6360000.0", "6360000", 1).replacen("8000.0", "0", 1);
        let planet = Planet::from_toml(&text).unwrap();
        assert_eq!((planet.bottom_radius_m, planet.rayleigh.scale_height_m), (6_360_000.0, 0.0));
    }
}
