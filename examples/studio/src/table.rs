//! Table of everything that a host sets, from the C header: fields with unit, range, default and help. The panel, the
//! settings file and the manual's page are made from it.

use std::{
    collections::{BTreeMap, HashMap},
    sync::{Mutex, OnceLock, PoisonError},
};

use welkin::capi::{
    abi::HEADER,
    by_name::{self, NamedField, NamedKind, StructBytes},
};

use crate::bytes;

/// Bit of a struct that says that a field is set.
#[derive(Clone, Copy, Debug)]
pub struct Switch {
    /// Field that holds the bit.
    pub of: NamedField,
    /// Number of the bit's flag.
    pub bit: u64,
}

/// A named value of a field.
#[derive(Clone, Debug)]
pub struct Choice {
    /// Name without what all values of the field share, in lower case.
    pub name: String,
    /// Number.
    pub value: u64,
    /// Documentation of the header.
    pub help: &'static str,
}

/// Field that can be set.
#[derive(Clone, Debug)]
pub struct Row {
    /// Struct that has the field, such as `wk_weather`.
    pub of: &'static str,
    /// Name, offset and kind.
    pub field: NamedField,
    /// Name in words, without its unit.
    pub label: String,
    /// Unit, empty for a number without one.
    pub unit: &'static str,
    /// Numbers that are accepted, if the documentation gives both ends.
    pub limits: Option<[f64; 2]>,
    /// Bit that says that the field is set; `None` where it always is.
    pub switch: Option<Switch>,
    /// Whether 0 leaves the value to the library, though the range does not hold it.
    pub zero_is_automatic: bool,
    /// Named values.
    pub choices: Vec<Choice>,
    /// Documentation of the header.
    pub help: &'static str,
}

impl Row {
    /// Whether a panel can show the field: no pointer, no struct, no size of a list, nothing reserved.
    fn can_be_set(field: &NamedField, all: &[NamedField], switched: &[&str]) -> bool {
        let name = field.name;
        let list = name.strip_suffix("_count").or(name.strip_suffix("_stride"));
        let is_list =
            |f: &NamedField| matches!(f.kind, NamedKind::Pointer) && list.is_some_and(|l| f.name.starts_with(l));
        !all.iter().any(is_list)
            && !name.starts_with("reserved")
            && !switched.contains(&name)
            && !matches!(field.kind, NamedKind::Pointer | NamedKind::Struct(_))
    }

    /// Name in words with its unit.
    pub fn name(&self) -> String {
        if self.unit.is_empty() { self.label.clone() } else { format!("{}, {}", self.label, self.unit) }
    }

    /// Whether the library chooses the value unless the field is set.
    pub fn is_optional(&self) -> bool {
        self.switch.is_some() || self.zero_is_automatic
    }

    /// Whether the field is a union of flags.
    pub fn is_union(&self) -> bool {
        matches!(self.field.kind, NamedKind::Choice { union: true, .. })
    }

    /// Default of an element.
    pub fn default(&self, element: usize) -> f64 {
        by_name::default_of(self.of).map_or(0.0, |bytes| bytes::number(&bytes, &self.field, element))
    }
}

/// Units by the end of a field's name; longer ends come first.
const UNITS: [(&str, &str); 27] = [
    ("_per_m2_s", "1/(m2 s)"),
    ("_per_minute", "/min"),
    ("_per_m", "1/m"),
    ("_m_s", "m/s"),
    ("_deg_s", "deg/s"),
    ("_w_m2", "W/m2"),
    ("_g_m3", "g/m3"),
    ("_g_kg", "g/kg"),
    ("_mm_h", "mm/h"),
    ("_cd_m2", "cd/m2"),
    ("_percent", "%"),
    ("_bytes", "bytes"),
    ("_lux", "lx"),
    ("_hpa", "hPa"),
    ("_deg", "deg"),
    ("_du", "DU"),
    ("_um", "um"),
    ("_mm", "mm"),
    ("_ms", "ms"),
    ("_px", "px"),
    ("_cd", "cd"),
    ("_m2", "m2"),
    ("_c", "deg C"),
    ("_s", "s"),
    ("_m", "m"),
    ("_k", "K"),
    ("_h", "h"),
];

/// Flags whose names do not begin like their fields.
const OTHER_SWITCHES: [(&str, &[&str]); 3] = [
    ("WK_OVERRIDE_CLOUD_LIGHT", &["cloud_direct", "cloud_diffuse"]),
    ("WK_SEA_HAS_HEIGHT", &["significant_height_m"]),
    ("WK_WEATHER_HAS_SEA_WAVE_HEIGHT", &["sea_significant_wave_height_m"]),
];

/// Documentation of the header.
#[derive(Default)]
struct Docs {
    fields: HashMap<(&'static str, String), &'static str>,
    constants: HashMap<String, &'static str>,
}

/// Text of a comment in one line.
fn flowed(comment: &[&str]) -> String {
    comment.iter().map(|line| line.trim()).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}

/// Name that a declaration in C gives: `double center_m[3];`, `const double (*corners_m)[2];`.
fn declared(line: &str) -> Option<&str> {
    let before = line.trim().strip_suffix(';')?;
    let before = before.split('[').next().unwrap_or(before).trim_end_matches(')');
    before.rsplit(|c: char| !(c.is_alphanumeric() || c == '_')).next().filter(|name| !name.is_empty())
}

impl Docs {
    fn of(header: &'static str) -> Self {
        let (mut docs, mut comment, mut inside, mut structure) = (Self::default(), Vec::new(), false, None);
        for line in header.lines() {
            let text = line.trim();
            if let Some(rest) = text.strip_prefix("/**") {
                comment.clear();
                inside = !rest.ends_with("*/");
                comment.push(rest.trim_end_matches("*/"));
            } else if inside {
                inside = !text.ends_with("*/");
                comment.push(text.trim_end_matches("*/").trim_start_matches('*'));
            } else if let Some(name) = text.strip_prefix("typedef struct ").and_then(|t| t.strip_suffix(" {")) {
                structure = Some(name);
            } else if text.starts_with('}') {
                structure = None;
            } else if let Some(name) = text.strip_prefix("#define ").and_then(|t| t.split_whitespace().next()) {
                docs.constants.insert(name.to_owned(), flowed(&comment).leak());
            } else if let (Some(name), Some(field)) = (structure, declared(text)) {
                docs.fields.insert((name, field.to_owned()), flowed(&comment).leak());
            }
        }
        docs
    }
}

/// Documentation, read once: its texts live as long as the program.
fn docs() -> &'static Docs {
    static DOCS: OnceLock<Docs> = OnceLock::new();
    DOCS.get_or_init(|| Docs::of(HEADER))
}

/// Both ends of a range such as `[1000, 8 000 000]`.
fn limits(range: &str) -> Option<[f64; 2]> {
    let inner = range.trim().strip_prefix(['[', '('])?.strip_suffix([']', ')'])?;
    let (low, high) = inner.split_once(',')?;
    let number = |text: &str| match text.trim() {
        "pi" => Some(std::f64::consts::PI),
        digits => digits.chars().filter(|c| !c.is_whitespace()).collect::<String>().parse().ok(),
    };
    Some([number(low)?, number(high)?])
}

/// Choices of a field, with short names.
fn choices(values: &'static [(&'static str, u64)]) -> Vec<Choice> {
    let first = values.first().map_or("", |v| v.0);
    let shared = |n: usize| values.iter().all(|v| v.0.len() > n && v.0[..n] == first[..n]);
    let prefix = if values.len() > 1 {
        first.char_indices().filter(|c| c.1 == '_').map(|c| c.0 + 1).filter(|n| shared(*n)).max().unwrap_or(0)
    } else {
        first.find("_HAS_").map_or(0, |at| at + 5)
    };
    let help = |name: &str| docs().constants.get(name).copied().unwrap_or("");
    let choice = |v: &(&'static str, u64)| Choice {
        name: v.0[prefix..].to_lowercase().replace('_', " "),
        value: v.1,
        help: help(v.0),
    };
    values.iter().map(choice).collect()
}

/// Flag of one of a struct's unions that says that a field is set.
fn switch(all: &[NamedField], field: &NamedField) -> Option<Switch> {
    let unions = all.iter().filter(|f| f.name == "has" || f.name == "set");
    let mut found: Vec<(usize, Switch)> = Vec::new();
    for union in unions {
        let NamedKind::Choice { values, .. } = union.kind else { continue };
        for (name, bit) in values {
            let other = OTHER_SWITCHES.iter().find(|o| o.0 == *name);
            let key = name.split_once("_HAS_").or(name.split_once("_OVERRIDE_")).map_or("", |split| split.1);
            let key = key.to_lowercase();
            let fits = match other {
                Some((_, fields)) => fields.contains(&field.name),
                None => !key.is_empty() && field.name.starts_with(&key),
            };
            if fits {
                found.push((name.len(), Switch { of: *union, bit: *bit }));
            }
        }
    }
    found.into_iter().max_by_key(|f| f.0).map(|f| f.1)
}

/// Name of a field in words, and its unit.
fn worded(name: &str) -> (String, &'static str) {
    let (stem, unit) =
        UNITS.iter().find_map(|(end, unit)| Some((name.strip_suffix(end)?, *unit))).unwrap_or((name, ""));
    (stem.replace('_', " "), unit)
}

/// Returns the rows of a struct, in the header's order; none for an unknown one. They are made once: the panel asks for
/// them in each frame.
pub fn rows(structure: &'static str) -> &'static [Row] {
    static ROWS: Mutex<BTreeMap<&str, &[Row]>> = Mutex::new(BTreeMap::new());
    let mut known = ROWS.lock().unwrap_or_else(PoisonError::into_inner);
    known.entry(structure).or_insert_with(|| made(structure).leak())
}

fn made(structure: &'static str) -> Vec<Row> {
    let all = by_name::fields(structure).unwrap_or_default();
    // Unions all of whose flags switch other fields need no row of their own.
    let mut switched = Vec::new();
    for union in all.iter().filter(|f| f.name == "has" || f.name == "set") {
        let NamedKind::Choice { values, .. } = union.kind else { continue };
        let used: Vec<u64> =
            all.iter().filter_map(|f| switch(&all, f)).filter(|s| s.of.name == union.name).map(|s| s.bit).collect();
        if values.iter().all(|v| used.contains(&v.1)) {
            switched.push(union.name);
        }
    }
    let own = all.iter().filter(|field| Row::can_be_set(field, &all, &switched));
    own.map(|field| {
        let (label, unit) = worded(field.name);
        let choices = if let NamedKind::Choice { values, .. } = field.kind { choices(values) } else { Vec::new() };
        let help = docs().fields.get(&(structure, field.name.to_owned())).copied().unwrap_or("");
        let (limits, switch) = (limits(field.range), switch(&all, field));
        let row =
            Row { of: structure, field: *field, label, unit, limits, switch, zero_is_automatic: false, choices, help };
        let zero_is_automatic = limits.is_some_and(|[low, _]| low > 0.0) && switch.is_none() && row.default(0) == 0.0;
        Row { zero_is_automatic, ..row }
    })
    .collect()
}

/// Whether a row's field is set in a struct.
pub fn is_on(bytes: &[u64], row: &Row) -> bool {
    if row.zero_is_automatic {
        return bytes::number(bytes, &row.field, 0) != 0.0;
    }
    row.switch.is_none_or(|switch| bytes::integer(bytes, &switch.of, 0) & switch.bit == switch.bit)
}

/// Says in a struct whether a row's field is set. A field of which 0 means that it is not gets the lowest number that
/// is accepted.
pub fn turn(bytes: &mut StructBytes, row: &Row, on: bool) {
    if row.zero_is_automatic {
        if on != is_on(bytes, row) {
            let lowest = row.limits.map_or(1.0, |limits| limits[0]);
            bytes::set_number(bytes, &row.field, 0, if on { lowest } else { 0.0 });
        }
        return;
    }
    let Some(switch) = row.switch else { return };
    let flags = bytes::integer(bytes, &switch.of, 0);
    bytes::set_integer(bytes, &switch.of, 0, if on { flags | switch.bit } else { flags & !switch.bit });
}
