//! A plan as text, by which other views and later sessions draw equal pictures.
//!
//! The text holds the rungs of the parts and the sky's settings. Views of a context with other settings would draw
//! differently, so they refuse the plan.

use toml::{Table, Value};

use super::parts::Part;
use crate::error::{Error, Result, Status, beginning, listed, toml_fault};

/// Version of the text: 2 since rain has parts, 3 since parts have rungs.
const VERSION: u32 = 3;
/// Largest size of a saved plan, bytes; a usual one has some hundreds.
const MOST_BYTES: usize = 1 << 16;

/// Settings of the context's sky under which a plan was made.
pub(crate) struct PlanSettings<'a> {
    /// Name of the sky's model.
    pub model: &'a str,
    /// Check that refuses a name that no model has.
    pub check_model: fn(&str) -> Result<()>,
    /// Name, value, minimum and maximum of every numeric setting.
    pub numbers: Vec<(&'static str, u32, u32, u32)>,
}

/// Writes the rungs of all parts, with the sky's settings.
pub(crate) fn write(parts: &[Part], rungs: &[usize], sky: &PlanSettings<'_>) -> String {
    let mut text = format!("version = {VERSION}\n\n[sky]\nmodel = \"{}\"\n", sky.model);
    for (name, value, ..) in &sky.numbers {
        text += &format!("{name} = {value}\n");
    }
    text += "\n[drawn]\n";
    for (part, rung) in parts.iter().zip(rungs) {
        text += &format!("{} = \"{}\"\n", part.name, part.rungs[*rung]);
    }
    text
}

/// Reads the rungs of a saved plan whose sky settings are those of this context.
///
/// # Errors
/// [`Status::Parse`] for text that is too long, is not a plan or is of another version. The message names line and
/// column, or the field. [`Status::InvalidArgument`] if the plan's sky settings differ from `sky`.
pub(crate) fn read(bytes: &[u8], parts: &[Part], sky: &PlanSettings<'_>) -> Result<Vec<usize>> {
    if bytes.len() > MOST_BYTES {
        return Err(fault("", format_args!("must have at most {MOST_BYTES} bytes, got {}", bytes.len())));
    }
    let text = std::str::from_utf8(bytes).map_err(|e| unread(&e))?;
    let whole: Table = toml::from_str(text).map_err(|e| unread(&toml_fault(text, &e)))?;
    // Checks the version first, because a text of another version has fields that are unknown here.
    let version = whole.get("version");
    if version != Some(&Value::from(i64::from(VERSION))) {
        return Err(fault(".version", format_args!("must be {VERSION}, got {}", shown(version))));
    }
    only(&whole, "", &["version", "sky", "drawn"])?;
    let (settings, drawn) = (table(&whole, "sky")?, table(&whole, "drawn")?);
    let names: Vec<&str> = std::iter::once("model").chain(sky.numbers.iter().map(|n| n.0)).collect();
    only(settings, ".sky", &names)?;
    let names: Vec<&str> = parts.iter().map(|p| p.name).collect();
    only(drawn, ".drawn", &names)?;
    let rungs = parts.iter().map(|part| rung_of(drawn, part)).collect::<Result<_>>()?;
    let model = text_of(settings, "model")?;
    (sky.check_model)(model).map_err(|e| e.with_status(Status::Parse).within("plan.sky"))?;
    differs("model", model, sky.model)?;
    for &(name, own, lo, hi) in &sky.numbers {
        let found = settings.get(name);
        let value = found.and_then(Value::as_integer).filter(|v| (i64::from(lo)..=i64::from(hi)).contains(v));
        let value = value.ok_or_else(|| {
            let rest = format!("must be a whole number in [{lo}, {hi}], got {}", shown(found));
            fault(&format!(".sky.{name}"), rest)
        })?;
        differs(name, value, i64::from(own))?;
    }
    Ok(rungs)
}

/// Reads the rung of a part by its name.
fn rung_of(drawn: &Table, part: &Part) -> Result<usize> {
    let found = drawn.get(part.name);
    let rung = found.and_then(Value::as_str).and_then(|name| part.rungs.iter().position(|r| *r == name));
    rung.ok_or_else(|| {
        let rest = format!("must be one of {}, got {}", listed(part.rungs), shown(found));
        fault(&format!(".drawn.{}", part.name), rest)
    })
}

/// Builds the error about the field at `path`.
fn fault(path: &str, rest: impl std::fmt::Display) -> Error {
    Error::about(Status::Parse, format!("plan{path}"), rest)
}

/// Builds the error for text that is not TOML.
fn unread(why: &dyn std::fmt::Display) -> Error {
    Error::new(Status::Parse, why.to_string()).within("plan")
}

/// Returns a value as the end of a message: at most 40 characters of it, and dots if there are more. A missing value is
/// "nothing".
fn shown(value: Option<&Value>) -> String {
    value.map_or("nothing".into(), |v| beginning(&v.to_string(), 40).into_owned())
}

/// Refuses fields other than the `known` ones.
fn only(table: &Table, path: &str, known: &[&str]) -> Result<()> {
    let unknown = table.keys().find(|k| !known.contains(&k.as_str()));
    unknown.map_or(Ok(()), |k| {
        Err(fault(
            &format!("{path}.{}", beginning(k, 40)),
            format_args!("is unknown: the fields are {}", listed(known)),
        ))
    })
}

/// Returns the table `name`.
fn table<'a>(whole: &'a Table, name: &str) -> Result<&'a Table> {
    let found = whole.get(name);
    found
        .and_then(Value::as_table)
        .ok_or_else(|| fault(&format!(".{name}"), format_args!("must be a table, got {}", shown(found))))
}

/// Returns the text `name` of the table of the sky's settings.
fn text_of<'a>(table: &'a Table, name: &str) -> Result<&'a str> {
    let found = table.get(name);
    found
        .and_then(Value::as_str)
        .ok_or_else(|| fault(&format!(".sky.{name}"), format_args!("must be a text, got {}", shown(found))))
}

/// Checks that a setting equals the saved one: only views with equal settings of the sky draw equal pictures.
fn differs<T: PartialEq + std::fmt::Display>(name: &str, saved: T, own: T) -> Result<()> {
    if saved == own {
        return Ok(());
    }
    Err(Error::range(&format!("plan.sky.{name}"), &format!("{own} as in this view's context"), saved))
}

#[cfg(test)]
mod tests {
    use super::super::parts::Worth;
    use super::*;

    const fn part(name: &'static str, rungs: &'static [&'static str]) -> Part {
        Part { name, rungs, importance: 0.5, worth: Worth::Composed(0) }
    }

    const PARTS: [Part; 3] =
        [part("air", &["all", "none"]), part("fog", &["all", "none"]), part("rain", &["drops", "cones", "none"])];

    fn settings() -> PlanSettings<'static> {
        let check_model = |name: &str| match name {
            "directional" | "isotropic" => Ok(()),
            _ => Err(Error::range("model", "one of directional, isotropic", name)),
        };
        PlanSettings { model: "directional", check_model, numbers: vec![("suns", 64, 16, 128), ("orders", 5, 1, 16)] }
    }

    #[test]
    fn every_plan_comes_back_as_it_was() {
        for set in 0..12 {
            let rungs = [set % 2, set / 2 % 2, set / 4];
            assert_eq!(read(write(&PARTS, &rungs, &settings()).as_bytes(), &PARTS, &settings()).unwrap(), rungs);
        }
    }

    #[test]
    fn damaged_plans_are_refused_or_read_as_the_same_rungs() {
        let rungs = [0, 1, 1];
        let text = write(&PARTS, &rungs, &settings());
        let mut refused = 0;
        let mut tried = |bytes: &[u8], what: &str| match read(bytes, &PARTS, &settings()) {
            Ok(answer) => assert_eq!(answer, rungs, "{what}"),
            Err(e) => {
                assert!(matches!(e.status, Status::Parse | Status::InvalidArgument), "{what}: {e:?}");
                assert!(e.to_string().starts_with("plan"), "{what}: {}", e);
                refused += 1;
            }
        };
        let bytes = text.as_bytes();
        for end in 0..bytes.len() {
            tried(&bytes[..end], &format!("cut at {end}"));
        }
        for at in 0..bytes.len() {
            for byte in 0..=255 {
                let mut mangled = bytes.to_vec();
                mangled[at] = byte;
                tried(&mangled, &format!("{byte} at {at}"));
            }
            let mut shorter = bytes.to_vec();
            shorter.remove(at);
            tried(&shorter, &format!("without {at}"));
        }
        for line in text.lines() {
            tried(text.replacen(&format!("{line}\n"), "", 1).as_bytes(), &format!("without `{line}`"));
            tried(text.replacen(line, &format!("{line}\n{line}"), 1).as_bytes(), &format!("twice `{line}`"));
        }
        assert!(refused > 25_000, "{refused} refused");
    }

    #[test]
    fn faults_name_the_field_and_what_is_accepted() {
        let text = write(&PARTS, &[0; 3], &settings());
        let read = |bytes: &[u8]| read(bytes, &PARTS, &settings());
        let says = |from: &str, to: &str| read(text.replacen(from, to, 1).as_bytes()).unwrap_err().to_string();
        for (from, to, want) in [
            ("version = 3", "version = 4\nparts = 5", "plan.version must be 3, got 4"),
            ("version = 3", "", "plan.version must be 3, got nothing"),
            ("fog = \"all\"", "fog = 1", "plan.drawn.fog must be one of all, none, got 1"),
            (
                "fog = \"all\"",
                "fog = \"a word of more than forty characters in all\"",
                "plan.drawn.fog must be one of all, none, got \"a word of more than forty characters in...",
            ),
            ("rain = \"drops\"", "rain = \"all\"", "plan.drawn.rain must be one of drops, cones, none, got \"all\""),
            ("fog = \"all\"\n", "", "plan.drawn.fog must be one of all, none, got nothing"),
            (
                "fog = \"all\"",
                "fog = \"all\"\nhail = \"all\"",
                "plan.drawn.hail is unknown: the fields are air, fog, rain",
            ),
            ("[drawn]", "[done]", "plan.done is unknown"),
            ("suns = 64", "suns = 48", "plan.sky.suns must be 64 as in this view's context, got 48"),
            ("suns = 64", "suns = 1e9", "plan.sky.suns must be a whole number in [16, 128], got 1000000000"),
            ("suns = 64", "suns = -3", "plan.sky.suns must be a whole number in [16, 128], got -3"),
            ("\"directional\"", "\"best\"", "plan.sky.model must be one of directional"),
            ("\"directional\"", "\"isotropic\"", "plan.sky.model must be directional as in this view's context"),
            ("[sky]", "[sky", "plan: TOML parse error at line 3"),
        ] {
            assert!(says(from, to).starts_with(want), "{}", says(from, to));
        }
        let deep = format!("version = {}1{}", "[".repeat(20_000), "]".repeat(20_000));
        assert!(read(deep.as_bytes()).unwrap_err().to_string().starts_with("plan: "));
        assert!(read(&[0xff; 8]).unwrap_err().to_string().starts_with("plan: invalid utf-8"));
        assert!(read(&vec![b'#'; MOST_BYTES + 1]).unwrap_err().to_string().contains("at most 65536 bytes"));
        assert!(read(b"").unwrap_err().to_string().contains("plan.version"));
    }
}
