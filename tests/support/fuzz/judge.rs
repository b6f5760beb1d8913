//! Rules that every answer of the C interface must obey, whatever the call.

use crate::refusals::{PUBLIC, field_fault, message};
use welkin::capi::status::*;

/// Checks an answer against the rules.
pub struct Judge;

/// Words of the implementation, which mean nothing to a host.
const INTERNAL: &[&str] = &[
    "wgpu::",
    "Validation",
    "naga",
    "TextureUsages",
    "Some(",
    "None)",
    "Error {",
    "unwrap",
    "src/",
    ".rs:",
    "Label",
    "overflow",
    "panicked",
    "encoder",
    "bind group",
];

/// Removes from a message what it quotes of an input, because a quotation may have any words. A quotation ends at the
/// last mark of its kind, or at the end of the message if it is cut. All after ", got " is removed too.
fn unquoted(text: &str) -> String {
    let (mut own, mut rest) = (String::new(), text.split(", got ").next().unwrap_or_default());
    while let Some(begin) = rest.find(['"', '`']) {
        own.push_str(&rest[..begin]);
        let mark = &rest[begin..=begin];
        rest = rest.rfind(mark).filter(|end| *end > begin).map_or("", |end| &rest[end + 1..]);
    }
    own + rest
}

/// Word of the implementation in a message's own text. Words that the input has may be in it: names of its fields stand
/// there without quotation marks.
fn internal_word(message: &str, input: &[u8]) -> Option<&'static str> {
    let is_given = |word: &str| input.windows(word.len()).any(|part| part == word.as_bytes());
    let own = unquoted(message);
    INTERNAL.iter().find(|word| own.contains(**word) && !is_given(word)).copied()
}

impl Judge {
    /// The error in an answer of `function`, if any.
    pub fn fault(&self, function: &str, status: wk_status) -> Option<String> {
        self.fault_about(b"", function, status)
    }

    /// The error in an answer of `function` about an input, if any.
    pub fn fault_about(&self, input: &[u8], function: &str, status: wk_status) -> Option<String> {
        if status >= 0 {
            return None;
        }
        let text = message();
        if status == WK_ERROR_INTERNAL || status == WK_ERROR_POISONED || status == WK_ERROR_DEVICE_LOST {
            return Some(format!("status {status}: {text}"));
        }
        let Some(what) = text.strip_prefix(&format!("{function}: ")) else {
            return Some(format!("the message does not begin with the function's name: {text:?}"));
        };
        if let Some(word) = internal_word(what, input) {
            return Some(format!("the message has {word:?} in it: {text:?}"));
        }
        if text.len() >= 300 {
            return Some(format!("the message has {} bytes: {text:?}", text.len()));
        }
        let mut words = what.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        if !words.any(|w| PUBLIC.contains(w)) {
            return Some(format!("the message names no field or parameter of the header: {text:?}"));
        }
        field_fault()
    }
}
