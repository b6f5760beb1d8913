//! `lab report`: one self-contained HTML page.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use welkin::Result;

use crate::command::Options;
use crate::store::io;

const STYLE: &str = "body{font:16px/1.5 sans-serif;max-width:1200px;margin:2em auto;padding:0 1em;color:#282c34}\
    svg,img{max-width:100%;height:auto}table{border-collapse:collapse;font-size:13px}td,th{border:1px solid #ccd;padding:2px 8px}\
    code{background:#f2f3f5;padding:0 3px}";

/// Writes `report.html` from the page and its figures.
///
/// # Errors
/// A missing page; files.
pub fn run(options: &Options) -> Result<()> {
    let directory = &options.out;
    let page = directory.join("README.md");
    let text = fs::read_to_string(&page).map_err(|e| io(&page, &format!("{e}; run `lab chart` first")))?;
    let mut out = format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Welkin's lab</title><style>{STYLE}</style><body>\n"
    );
    let mut table = false;
    for line in text.lines() {
        if line.starts_with('|') {
            let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
            if cells.iter().all(|c| c.trim_matches('-').is_empty() && !c.is_empty()) {
                continue;
            }
            let tag = if table { "td" } else { "th" };
            if !table {
                out.push_str("<table>\n");
            }
            table = true;
            let row: String = cells.iter().map(|c| format!("<{tag}>{}</{tag}>", inline(c))).collect();
            let _ = writeln!(out, "<tr>{row}</tr>");
            continue;
        }
        if std::mem::take(&mut table) {
            out.push_str("</table>\n");
        }
        block(&mut out, line, directory)?;
    }
    if table {
        out.push_str("</table>\n");
    }
    out.push_str("</body></html>\n");
    let path = directory.join("report.html");
    welkin_command_line::write_whole(&path, out.as_bytes())?;
    println!("{}", path.display());
    Ok(())
}

/// Writes a line that is not part of a table.
fn block(out: &mut String, line: &str, directory: &Path) -> Result<()> {
    let heading = line.bytes().take_while(|b| *b == b'#').count();
    if let Some(rest) = line.strip_prefix("![") {
        let file = rest.split_once("](").map_or("", |(_, f)| f.trim_end_matches(')'));
        let path = directory.join(file);
        let svg = fs::read_to_string(&path).map_err(|e| io(&path, &e))?;
        // Leaves out the text before the element, which belongs to a separate file.
        out.push_str(svg.find("<svg").map_or("", |at| &svg[at..]));
        out.push('\n');
    } else if heading > 0 {
        let _ = writeln!(out, "<h{heading}>{}</h{heading}>", inline(line[heading..].trim()));
    } else if let Some(item) = line.strip_prefix("- ") {
        let _ = writeln!(out, "<p>&bull; {}</p>", inline(item));
    } else if !line.trim().is_empty() {
        let _ = writeln!(out, "<p>{}</p>", inline(line));
    }
    Ok(())
}

/// Escapes a text and converts its marks for code and emphasis to elements.
fn inline(text: &str) -> String {
    let safe = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let mut out = String::new();
    for (i, part) in safe.split('`').enumerate() {
        if i % 2 == 1 {
            let _ = write!(out, "<code>{part}</code>");
            continue;
        }
        for (j, piece) in part.split("**").enumerate() {
            let _ = if j % 2 == 1 { write!(out, "<b>{piece}</b>") } else { write!(out, "{piece}") };
        }
    }
    out
}
