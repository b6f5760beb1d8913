//! Numbers and texts as JSON.

use crate::wire::Value;

/// Writes a value. Numbers of 32 bits have nine significant digits, so that they read back exactly; JSON has no NaN and
/// no infinity, which become `null`.
pub fn value(value: Value) -> String {
    match value {
        Value::Bool(on) => on.to_string(),
        Value::Int(number) => number.to_string(),
        Value::F32(number) => nine_digits(number),
        Value::F64(number) if number.is_finite() => number.to_string(),
        Value::F64(_) => "null".to_owned(),
    }
}

/// Writes a number with nine significant digits and no zeros at the end, with an exponent where there are more zeros
/// than five before or after the digits.
fn nine_digits(number: f32) -> String {
    if !number.is_finite() {
        return "null".to_owned();
    }
    let text = format!("{number:.8e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let trimmed = |text: &str| text.trim_end_matches('0').trim_end_matches('.').to_owned();
    if (-4..9).contains(&exponent) {
        let text = format!("{:.*}", (8 - exponent) as usize, f64::from(number));
        return if text.contains('.') { trimmed(&text) } else { text };
    }
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{}e{sign}{:02}", trimmed(digits), exponent.abs())
}

/// Writes a text in quotes.
pub fn text(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c < ' ' => out.push_str(&format!("\\u{:04x}", c as u32)),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}
