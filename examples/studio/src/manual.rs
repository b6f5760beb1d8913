//! The page of the manual that lists everything that can be set, from the same table as the panel.

use std::fmt::Write as _;

use crate::{
    pages::{PAGES, title},
    panel::written,
    settings::Settings,
    table,
};

/// The page's text.
pub fn page() -> String {
    let mut text = String::from(
        "# Everything that can be set\n\nFrom the header, by `studio --settings-page`. The studio has a slider for each; \
         a settings file and a script name a field as `part.field`.\n",
    );
    let settings = Settings::default();
    for page in &PAGES {
        for part in page.parts(&settings) {
            let _ = write!(text, "\n## {} (`{}`, {})\n\n", title(part), part.structure(), part.key());
            text.push_str("| field | unit | range | default |\n|---|---|---|---|\n");
            for row in table::rows(part.structure()) {
                let range = if !row.choices.is_empty() {
                    row.choices.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", ")
                } else {
                    row.field.range.to_owned()
                };
                let _ = writeln!(text, "| `{}` | {} | {range} | {} |", row.field.name, row.unit, default(row));
            }
        }
    }
    text
}

fn default(row: &table::Row) -> String {
    if row.is_optional() {
        return "Welkin chooses".into();
    }
    let one = |element: usize| {
        let number = row.default(element);
        let named = row.choices.iter().find(|c| c.value as f64 == number);
        named.map_or_else(|| written(number), |c| c.name.clone())
    };
    if row.is_union() && row.default(0) == 0.0 {
        "none".into()
    } else {
        (0..row.field.count).map(one).collect::<Vec<_>>().join(", ")
    }
}
