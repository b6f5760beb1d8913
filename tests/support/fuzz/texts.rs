//! Texts and saved bytes as produced by faulty programs, old files and manual edits.

use super::dice::Dice;

const PLANET: &str = include_str!("../../../examples/data/planet_golden.toml");
const REPORTS: &str = include_str!("../../../examples/data/metar.txt");
const REAL_REPORTS: &str = include_str!("../../weather/data/reports.csv");

/// Changes, cuts, duplicates or appends bytes; occasionally leaves everything as it is.
pub fn damage(dice: &mut Dice, bytes: &mut Vec<u8>) {
    for _ in 0..dice.below(4) {
        if bytes.is_empty() {
            return;
        }
        let at = dice.below(bytes.len());
        match dice.below(6) {
            0 => bytes.truncate(at),
            1 => bytes[at] ^= 1 << dice.below(8),
            2 => bytes[at] = dice.bits() as u8,
            3 => {
                let to = (at + dice.below(64)).min(bytes.len());
                let again = bytes[at..to].to_vec();
                bytes.splice(at..at, again);
            }
            4 => _ = bytes.remove(at),
            _ => bytes.insert(at, dice.pick(b"0123456789.-+eE=[]\"\n ")),
        }
    }
}

/// `text` with some damage, as UTF-8 without zero bytes.
fn damaged(dice: &mut Dice, text: &str) -> String {
    let mut bytes = text.as_bytes().to_vec();
    damage(dice, &mut bytes);
    String::from_utf8_lossy(&bytes).replace('\0', " ")
}

/// A planet file with a number or some bytes changed.
pub fn planet(dice: &mut Dice) -> String {
    if dice.one_in(2) {
        return damaged(dice, PLANET);
    }
    // Replaces a number by another one.
    let lines: Vec<&str> = PLANET.lines().collect();
    let line = dice.below(lines.len());
    let changed = match lines[line].split_once(" = ") {
        Some((name, value)) if value.starts_with('[') => {
            format!("{name} = [{:?}, {:?}, {:?}]", dice.float(), dice.float(), dice.float())
        }
        Some((name, _)) => format!("{name} = {:?}", dice.float()),
        None => String::new(),
    };
    lines.iter().enumerate().map(|(i, l)| if i == line { format!("{changed}\n") } else { format!("{l}\n") }).collect()
}

/// A weather report with groups swapped, duplicated or damaged.
pub fn metar(dice: &mut Dice) -> String {
    let real = REAL_REPORTS.lines().skip(1).filter_map(|l| l.split(',').next());
    let written = REPORTS.lines().filter(|l| !l.starts_with('#') && !l.is_empty());
    let reports: Vec<&str> = if dice.one_in(2) { real.collect() } else { written.collect() };
    let report = dice.pick(&reports);
    let mut groups: Vec<&str> = report.split_whitespace().collect();
    for _ in 0..dice.below(4) {
        let other: Vec<&str> = dice.pick(&reports).split_whitespace().collect();
        let group = dice.pick(&other);
        let at = dice.below(groups.len() + 1);
        groups.insert(at, group);
    }
    let text = groups.join(" ");
    if dice.one_in(2) { damaged(dice, &text) } else { text }
}
