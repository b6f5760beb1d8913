//! The longest submissions, in units of work that do not depend on a machine. Windows resets a GPU that works for 2 s
//! on one submission (TDR), so none may grow unnoticed. The test compares them with the table of docs/lab/counts.md.

use std::{fmt::Write, path::Path};

use super::counted::dearest_pixel;
use crate::{
    plan::{Price, Units},
    sky::{SkySettings, candidates::work},
};

/// Number of pixels of the picture in the table.
const PIXELS: f64 = 1920.0 * 1080.0;

fn millions(amount: f64) -> String {
    format!("{:.1}", amount / 1e6)
}

/// Text of the table in docs/lab/counts.md.
fn table() -> String {
    let mut text = String::from(
        "| submission | samples, 10^6 | texels, 10^6 | bytes, 10^6 | together, 10^6 samples |\n|---|---|---|---|---|\n",
    );
    let mut row = |what: &str, units: &Units| {
        let [samples, texels, bytes] = [units.samples, units.texels, units.bytes].map(millions);
        let all = millions(units.at(&Price::default()));
        writeln!(text, "| {what} | {samples} | {texels} | {bytes} | {all} |").expect("a string");
    };
    let settings = SkySettings::default();
    let whole = work(&settings).rebuild;
    row("all tables of the sky: `WK_FRAME_NO_HISTORY`, `WK_FRAME_CUT`, or the first question about light", &whole);
    row("their draft, in a first frame", &work(&settings.draft()).rebuild);
    row("a slice of them, in each frame afterwards", &Units::default().plus(whole, 1.0 / 80.0));
    text.push_str("\n| picture of 1920 x 1080, drawn whole | texels, 10^6 | operations, 10^9 |\n|---|---|---|\n");
    for weather in ["clear", "fog", "rain", "snow", "broken"] {
        let [texels, operations] = dearest_pixel(weather).map(|n| f64::from(n) * PIXELS);
        writeln!(text, "| {weather} | {} | {:.1} |", millions(texels), operations / 1e9).expect("a string");
    }
    text
}

#[test]
fn the_longest_submissions_are_those_of_the_table() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/lab/counts.md");
    let (page, found) = (std::fs::read_to_string(&path).expect("the page"), table());
    let begin = page.find("| submission |").expect("the page has a table");
    let end = begin + page[begin..].find("\n\n- ").map_or(page.len() - begin, |at| at + 1);
    if std::env::var_os("WELKIN_BLESS").is_some() {
        std::fs::write(&path, [&page[..begin], &found, &page[end..]].concat()).expect("the page can be written");
    } else {
        assert_eq!(&page[begin..end], found, "WELKIN_BLESS=1 writes the page anew");
    }
}
