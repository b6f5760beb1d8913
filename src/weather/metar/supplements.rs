//! Groups of a report that do not describe the weather now: recent weather, wind shear, runway states, military colour
//! codes, rainfall.

use super::phenomena;

/// Whether a word is a group that does not describe the weather now. After the pressure (`ended`) every word that
/// begins like a runway state is one; before the pressure, only words that cannot be another group.
pub(super) fn is_supplement(text: &str, ended: bool) -> bool {
    let colour = matches!(text, "BLU+" | "BLU" | "WHT" | "GRN" | "YLO" | "YLO1" | "YLO2" | "AMB" | "RED")
        || text.starts_with("BLACK");
    let recent = text.strip_prefix("RE").is_some_and(|w| phenomena::weather(w).is_some());
    let shear = matches!(text, "WS" | "ALL" | "RWY" | "TKOF" | "LDG") || text.starts_with("RWY");
    let out_of_order = matches!(text, "$" | "RVRNO" | "VISNO" | "SNOCLO" | "R/SNOCLO");
    colour || recent || shear || out_of_order || is_runway_state(text) || (ended && begins_as_runway(text))
}

/// Whether a word is a runway state: `R24/CLRD70`, `R88/290095`, `R01/SNOCLO`, or an older form: `88490391`,
/// `08CLRD62`.
fn is_runway_state(text: &str) -> bool {
    let figures = |t: &str, n: usize| t.len() == n && t.bytes().all(|b| b.is_ascii_digit() || b == b'/');
    if figures(text, 8) {
        return text.bytes().any(|b| b != b'/');
    }
    let digits = |t: &str| t.len() == 2 && t.bytes().all(|b| b.is_ascii_digit());
    if text.split_once("CLRD").is_some_and(|(runway, friction)| digits(runway) && figures(friction, 2)) {
        return true;
    }
    let Some((runway, state)) = text.strip_prefix('R').and_then(|t| t.split_once('/')) else { return false };
    digits(runway.trim_end_matches(['L', 'R', 'C']))
        && (figures(state, 6) || state.starts_with("CLRD") || state == "SNOCLO")
}

/// Whether a word begins with R and then has a digit at once or a slash anywhere. Such words are runway states in local
/// forms, and Australia's rainfall (`RF00.0/016.4`).
fn begins_as_runway(text: &str) -> bool {
    text.strip_prefix('R').is_some_and(|r| r.contains('/') || r.starts_with(|c: char| c.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn supplementary_groups_are_recognised() {
        for text in [
            "RERA",
            "RE//",
            "WS",
            "RWY28",
            "BLU",
            "BLACKGRN",
            "R24/CLRD70",
            "R01/SNOCLO",
            "88490391",
            "08CLRD62",
            "88CLRD//",
            "8829//99",
            "$",
        ] {
            assert!(is_supplement(text, false) && is_supplement(text, true), "{text}");
        }
        for text in ["RF00.0/016.4", "R27/49", "R88/60D", "R09L/D"] {
            assert!(!is_supplement(text, false) && is_supplement(text, true), "{text}");
        }
        for text in ["SLP162", "TEMP0", "CB/NE/E/W", "REXX", "////////", "8849", "8CLRD62", "RA", "R18R/0350N"] {
            assert!(!is_supplement(text, false), "{text}");
        }
    }
}
