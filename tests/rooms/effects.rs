//! Identifiers that name an effect: `src/frame` and `src/context` may have none.

use std::collections::BTreeSet;

use crate::{EFFECTS, files, read};

/// Words of an identifier, in lower case.
fn words_of(identifier: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before = '_';
    for c in identifier.chars() {
        if c == '_' || (c.is_uppercase() && before.is_lowercase()) {
            words.push(String::new());
        }
        if c != '_' {
            words.last_mut().expect("one at least").extend(c.to_lowercase());
        }
        before = c;
    }
    words
}

/// Words of a Rust file that name an effect, in identifiers and in text literals that are names of effects' shader
/// constants. Comments are ignored.
fn effects_named_in(text: &str, constants: &BTreeSet<String>) -> BTreeSet<String> {
    const NAMES: [&str; 6] = ["star", "stars", "sea", "ground", "windscreen", "mist"];
    // First letters of words such as fogged, clouds, snowy, raining.
    const BEGIN: [&str; 14] = [
        "sky",
        "cloud",
        "deck",
        "fog",
        "haze",
        "rain",
        "hail",
        "snow",
        "flake",
        "glass",
        "lightning",
        "thunder",
        "puddle",
        "soil",
    ];
    // Names of the light at a place, which is no effect.
    const LIGHT: [&str; 6] = ["ground", "ground_albedo", "sky_lux", "GroundLight", "deck_cd_m2", "deck_cover"];
    let code: String = text.lines().map(|l| l.split("//").next().expect("a first part").to_string() + "\n").collect();
    let is_name = |w: &String| NAMES.contains(&w.as_str()) || BEGIN.iter().any(|b| w.starts_with(b));
    let words = code.split(|c: char| !c.is_alphanumeric() && c != '_');
    let names = |i: &&str| words_of(i).iter().any(is_name) && !LIGHT.contains(i);
    let in_texts = code.split('"').skip(1).step_by(2).filter(|text| constants.contains(*text));
    words.filter(names).chain(in_texts).map(str::to_string).collect()
}

/// The `override` constants of the effects' own shaders and of `shaders/between` that the frame's shaders do not have:
/// `FOG`, `AIR`.
fn constants_of_effects() -> BTreeSet<String> {
    let named = |line: &str| Some(line.strip_prefix("override ")?.split(':').next()?.trim().to_string());
    let of = |is_meant: fn(&str) -> bool| -> BTreeSet<String> {
        let texts = files("shaders", "wgsl").into_iter().filter(|f| is_meant(&f.0)).map(|f| read(&f.1));
        texts.flat_map(|text| text.lines().filter_map(named).collect::<Vec<_>>()).collect()
    };
    let theirs = of(|folder| EFFECTS.contains(&folder) || folder == "between");
    // Constants of the surroundings of the camera, which are no effect.
    let around = ["SHELTER", "LAMPS"];
    theirs.difference(&of(|folder| folder == "frame")).filter(|c| !around.contains(&c.as_str())).cloned().collect()
}

#[test]
fn identifiers_that_name_an_effect_are_found() {
    let of = |text: &str| effects_named_in(text, &BTreeSet::from(["AIR".to_string()])).into_iter().collect::<Vec<_>>();
    let text = "let x = self.set_rain_areas(GroundView::new(\"fog\"), sky_lux); // snow\n";
    assert_eq!(of(text), ["GroundView", "fog", "set_rain_areas"]);
    assert_eq!(of("let fogged = value(\"SKY_MARCH\") > 0.0 && start;\n"), ["SKY_MARCH", "fogged"]);
    assert_eq!(of("push((\"AIR\", conditions.air, DeckCover));\n"), ["AIR", "DeckCover"]);
    let constants = constants_of_effects();
    assert!(
        ["AIR", "FOG", "CLOUDS", "SKY_MARCH", "DECK_CLOSED"].iter().all(|c| constants.contains(*c)),
        "{constants:?}"
    );
}

#[test]
fn frame_and_context_name_no_effect() {
    let constants = constants_of_effects();
    for (room, path) in files("src", "rs") {
        if room == "frame" || room == "context" {
            let found = effects_named_in(&read(&path), &constants);
            assert!(
                found.is_empty(),
                "{} names {found:?}: that belongs in an effect's room, src/effects.rs or src/front",
                path.display()
            );
        }
    }
}
