//! Words of a report with their positions, and the error for a word in the wrong place.

use crate::error::{Error, Status, beginning};

/// One word of the report and the byte at which it begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Word<'a> {
    pub text: &'a str,
    pub at: usize,
}

/// Splits a report into words. An equals sign ends the report, as the end of the text does.
pub(super) fn words(report: &str) -> Vec<Word<'_>> {
    let body = report.split('=').next().unwrap_or("");
    let mut words = Vec::new();
    let mut start = None;
    for (i, c) in body.char_indices().chain([(body.len(), ' ')]) {
        match (c.is_whitespace(), start) {
            (false, None) => start = Some(i),
            (true, Some(s)) => {
                words.push(Word { text: &body[s..i], at: s });
                start = None;
            }
            _ => {}
        }
    }
    words
}

/// Creates the error: position of `byte` in `report` as line and column, what was expected, and what was found.
pub(super) fn fault(report: &str, byte: usize, expected: &str, found: Option<&str>) -> Error {
    let before = &report[..byte.min(report.len())];
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
    // A long or binary word is cut after 24 characters, and after 48 once it is escaped (an escape has up to ten
    // bytes), so that the message stays legible.
    let quoted = |word| beginning(&format!("{:?}", beginning(word, 24)), 48).into_owned();
    let found = found.map_or_else(|| "the end".into(), quoted);
    Error::new(Status::Parse, format!("METAR line {line}, column {column}: expected {expected}, found {found}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_found_with_their_offsets() {
        let w = words("METAR  KDEN\n171853Z= rest");
        let places: Vec<(&str, usize)> = w.iter().map(|w| (w.text, w.at)).collect();
        assert_eq!(places, [("METAR", 0), ("KDEN", 7), ("171853Z", 12)]);
        assert!(words(" \n\t ").is_empty() && words("").is_empty());
    }

    #[test]
    fn columns_count_characters_from_one_on_their_line() {
        let text = "METAR KDEN\nä24009KT";
        assert!(
            fault(text, 13, "a", Some("b")).to_string().starts_with("METAR line 2, column 2: expected a, found \"b\"")
        );
        assert!(fault(text, 999, "a", None).to_string().contains("found the end"));
        let binary = "\u{10ffff}".repeat(1000);
        assert!(fault(&binary, 0, "a", Some(&binary)).to_string().len() < 120);
        let said = |word: &str| fault(word, 0, "a", Some(word)).to_string();
        let words = ["A".repeat(24), "A".repeat(25)];
        assert!(said(&words[0]).ends_with(&format!("found \"{}\"", words[0])), "{}", said(&words[0]));
        assert!(said(&words[1]).ends_with(&format!("found \"{}...\"", words[0])), "{}", said(&words[1]));
        assert!(said(&binary).ends_with("..."), "{}", said(&binary));
    }
}
