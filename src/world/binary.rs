//! Bytes as text in a saved state: base 64 (RFC 4648, section 4), without padding.

const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Returns bytes as base-64 digits.
pub(crate) fn binary_text(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let bits = (0..3).fold(0_u32, |bits, i| bits << 8 | u32::from(group.get(i).copied().unwrap_or(0)));
        text.extend((0..=group.len()).map(|d| char::from(DIGITS[(bits >> (18 - 6 * d)) as usize & 63])));
    }
    text
}

/// Returns the bytes that [`binary_text`] wrote; `None` for a text that it cannot have written.
pub(crate) fn text_binary(text: &str) -> Option<Vec<u8>> {
    let mut values = [u8::MAX; 256];
    DIGITS.iter().zip(0..).for_each(|(digit, value)| values[usize::from(*digit)] = value);
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for group in text.as_bytes().chunks(4) {
        let mut bits = 0_u32;
        for i in 0..4 {
            let value = group.get(i).map_or(0, |digit| values[usize::from(*digit)]);
            bits = bits << 6 | u32::from((value != u8::MAX).then_some(value)?);
        }
        let [_, found @ ..] = bits.to_be_bytes();
        let (used, spare) = found.split_at(group.len().checked_sub(1).filter(|n| *n > 0)?);
        bytes.extend_from_slice(used);
        spare.iter().all(|b| *b == 0).then_some(())?;
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_read_as_written_and_damaged_texts_are_refused() {
        // The examples of RFC 4648, section 10.
        for (bytes, text) in [("", ""), ("f", "Zg"), ("fo", "Zm8"), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            assert_eq!(binary_text(bytes.as_bytes()), text);
            assert_eq!(text_binary(text).unwrap(), bytes.as_bytes());
        }
        let all: Vec<u8> = (0..=255).collect();
        assert_eq!(text_binary(&binary_text(&all)).unwrap(), all);
        for bad in ["Z", "Zg=", "Zh", "Zm9v!", "Z\u{e9}"] {
            assert_eq!(text_binary(bad), None, "{bad}");
        }
    }
}
