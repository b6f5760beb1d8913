//! Welkin and other systems in one run, and Welkin before and after its frames were optimised: a recorded table, its
//! plot and its part of the page.
//!
//! Other systems are not part of this repository, and older versions cannot run any more, so `peers.csv` keeps what was
//! measured once. For Welkin's current times run the benchmarks (`cargo bench --bench speed -- copies falling clouds`).

use std::fmt::Write as _;
use std::path::Path;

use welkin::Result;

use crate::plot::{Move, Titles, moves, short};
use crate::store::Table;

/// Time of a measurement, in the table and on the page: others, Welkin 0.1 as first measured, Welkin now.
const WHEN: [(&str, &str); 3] = [("peer", "others"), ("before", "before"), ("now", "now")];

/// Effects of the table, in its order.
fn effects(table: &Table) -> Vec<&str> {
    let mut all = Vec::new();
    for row in &table.rows {
        if !all.contains(&row[0].as_str()) {
            all.push(row[0].as_str());
        }
    }
    all
}

fn row<'a>(table: &'a Table, effect: &str, when: &str) -> Option<&'a [String]> {
    table.rows.iter().find(|r| r[0] == effect && r[1] == when).map(Vec::as_slice)
}

/// Draws the plot of the recorded table.
///
/// # Errors
/// Files.
pub fn chart(directory: &Path) -> Result<()> {
    let Some(table) = Table::read(&directory.join("peers.csv"))? else { return Ok(()) };
    let place = |effect: &str, when: &str| {
        let row = row(&table, effect, when)?;
        let n = |column| table.number(row, column);
        Some([n("cost")?, n("cost_low")?, n("cost_high")?, n("error")?])
    };
    let all: Vec<Move> = effects(&table)
        .into_iter()
        .map(|name| Move { name: name.to_owned(), at: WHEN.map(|(when, _)| place(name, when)) })
        .collect();
    let titles = Titles {
        title: "Frames and their error: others, Welkin 0.1, Welkin now",
        x: "processor time of a frame over a copy's, 640x360 on a software driver; of rain: beyond the dry frame",
        y: "relative error",
        note: "hollow: before; full: now, at the end of the line; square: another system",
    };
    moves(&all, &titles).save(&directory.join("peers"))
}

/// Writes its part of the page.
pub fn section(out: &mut String, table: &Table) {
    out.push_str(
        "## Beside others, and before\n\n![frames and their error](peers.svg)\n\n\
         Copies of a picture of 640x360: the processor time of a frame over that of a full-screen pass that loads a texel. Others were timed in one \
         run with Welkin 0.1, by turns; what Welkin takes now is printed by `cargo bench --bench speed -- copies falling clouds`. Errors in brackets.\n\n\
         | what | others | Welkin 0.1 as first measured | Welkin now | |\n|---|---|---|---|---|\n",
    );
    for effect in effects(table) {
        let _ = write!(out, "| {effect} ");
        let mut says = Vec::new();
        for (when, title) in WHEN {
            let Some(row) = row(table, effect, when) else {
                out.push_str("| ");
                continue;
            };
            let n = |column| table.number(row, column);
            let (low, high) = (n("cost_low").unwrap_or(0.0), n("cost_high").unwrap_or(0.0));
            let error = n("error").map_or(String::new(), |e| format!(" ({} %)", short(100.0 * e)));
            let cost = if low == high { format!("{low}") } else { format!("{low} to {high}") };
            let _ = write!(out, "| {cost}{error} ");
            says.extend(row.last().filter(|said| !said.is_empty()).map(|said| format!("{title}: {said}")));
        }
        let _ = writeln!(out, "| {} |", says.join(". "));
    }
    out.push('\n');
}
