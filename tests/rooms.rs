//! Rooms and arrows: which room of `src/` and which folder of `shaders/` uses which, held against the table of
//! ARCHITECTURE.md. And how long functions are.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

/// What a room uses.
type Arrows = BTreeMap<String, BTreeSet<String>>;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// All files below a folder, with the room that each is in: the first part of its path.
fn files(top: &str, extension: &str) -> Vec<(String, PathBuf)> {
    let top = root().join(top);
    let mut folders = vec![top.clone()];
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == extension) {
                let below = path.strip_prefix(&top).expect("below it").components().next().expect("a part");
                let room = below.as_os_str().to_string_lossy().trim_end_matches(".rs").to_string();
                found.push((room, path));
            }
        }
    }
    found
}

/// The rooms that a file of Rust names after `crate::`, its tests and comments left out.
fn named_in(text: &str) -> BTreeSet<String> {
    let is_tests = |at: &usize| text[*at..].lines().nth(2).is_some_and(|l| l.contains("mod ") && l.ends_with('{'));
    let end = text.match_indices("\n#[cfg(test)]\n").map(|m| m.0).find(is_tests).unwrap_or(text.len());
    let text = &text[..end];
    let code: String = text.lines().map(|l| l.split("//").next().expect("a first part").to_string() + "\n").collect();
    let word = |s: &str| -> String { s.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect() };
    let mut found = BTreeSet::new();
    for at in code.split("crate::").skip(1) {
        let Some(list) = at.strip_prefix('{') else {
            found.insert(word(at));
            continue;
        };
        let (mut depth, mut begins) = (1, true);
        for (i, c) in list.char_indices() {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 1 => begins = true,
                c if begins && c.is_alphabetic() => {
                    found.insert(word(&list[i..]));
                    begins = false;
                }
                _ => {}
            }
            if depth == 0 {
                break;
            }
        }
    }
    found
}

fn rust_arrows() -> Arrows {
    // Tests of the whole crate stand above all rooms.
    let is_room = |room: &str| room != "lib" && room != "tests";
    let files: Vec<_> =
        files("src", "rs").into_iter().filter(|(room, path)| is_room(room) && !path.ends_with("tests.rs")).collect();
    let rooms: BTreeSet<_> = files.iter().map(|f| f.0.clone()).collect();
    let mut arrows = Arrows::new();
    for (room, path) in files {
        let used = named_in(&read(&path)).into_iter().filter(|r| rooms.contains(r) && *r != room);
        arrows.entry(room.clone()).or_default().extend(used);
    }
    arrows
}

fn shader_arrows() -> Arrows {
    let mut arrows = Arrows::new();
    for (folder, path) in files("shaders", "wgsl") {
        let text = read(&path);
        let used = text.lines().filter_map(|l| l.strip_prefix("//!include \"")?.split('/').next());
        arrows.entry(folder.clone()).or_default().extend(used.map(str::to_string).filter(|f| *f != folder));
    }
    arrows
}

/// The rows of the table whose first cells begin with `` `top/ ``: what each room may use.
fn table(top: &str) -> Arrows {
    let text = read(&root().join("ARCHITECTURE.md"));
    let row = |line: &str| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let room =
            cells.get(1)?.strip_prefix(&format!("`{top}/"))?.trim_end_matches(['`', '/']).trim_end_matches(".rs");
        let used = cells.get(3)?.split(", ").filter(|u| *u != "nothing").map(str::to_string).collect();
        Some((room.to_string(), used))
    };
    text.lines().filter_map(row).collect()
}

/// Rooms of which each uses the next, the last the first.
fn circle(arrows: &Arrows) -> Option<Vec<String>> {
    fn walk(room: &str, arrows: &Arrows, way: &mut Vec<String>, done: &mut BTreeSet<String>) -> bool {
        if let Some(at) = way.iter().position(|r| r == room) {
            way.drain(..at);
            return true;
        }
        if !done.contains(room) {
            way.push(room.to_string());
            if arrows.get(room).is_some_and(|used| used.iter().any(|u| walk(u, arrows, way, done))) {
                return true;
            }
            way.pop();
            done.insert(room.to_string());
        }
        false
    }
    let mut done = BTreeSet::new();
    arrows.keys().find_map(|room| {
        let mut way = Vec::new();
        walk(room, arrows, &mut way, &mut done).then_some(way)
    })
}

fn hold(arrows: &Arrows, allowed: &Arrows) {
    assert!(arrows.len() > 5, "{arrows:?}");
    assert_eq!(circle(arrows), None, "rooms form a circle");
    let rooms = |a: &Arrows| a.keys().cloned().collect::<Vec<_>>();
    assert_eq!(rooms(arrows), rooms(allowed), "the table has a row for every room and no other");
    for (room, used) in arrows {
        let beyond: Vec<_> = used.difference(&allowed[room]).collect();
        assert!(beyond.is_empty(), "{room} uses {beyond:?}, which its row in ARCHITECTURE.md does not name");
        let idle: Vec<_> = allowed[room].difference(used).collect();
        assert!(idle.is_empty(), "the row of {room} names {idle:?}, which it does not use");
    }
}

#[test]
fn rooms_use_what_their_rows_name_and_form_no_circle() {
    hold(&rust_arrows(), &table("src"));
}

#[test]
fn folders_of_shaders_use_what_their_rows_name_and_form_no_circle() {
    hold(&shader_arrows(), &table("shaders"));
}

const EFFECTS: [&str; 10] = ["sky", "stars", "clouds", "lightning", "fog", "rain", "snow", "ground", "glass", "bow"];

#[test]
fn the_effects_are_those_of_the_list() {
    // Rooms with a view of their own that src/effects.rs names; the test's plane is none.
    let text = read(&root().join("src/effects.rs"));
    let fields =
        text.split("pub(crate) struct Effects {").nth(1).expect("the list").split("\n}").next().expect("its fields");
    let fields: BTreeSet<&str> = fields
        .lines()
        .filter_map(|l| l.trim().strip_prefix("pub ")?.split(':').next())
        .filter(|f| *f != "plane")
        .collect();
    assert_eq!(fields, BTreeSet::from(EFFECTS));
    let named = format!("where an effect ({})", EFFECTS.join(", "));
    assert!(read(&root().join("ARCHITECTURE.md")).replace('\n', " ").contains(&named), "ARCHITECTURE.md: {named}");
}

#[test]
fn rooms_of_effects_have_the_same_files_or_say_why_not() {
    for room in EFFECTS {
        let folder = root().join("src").join(room);
        let text = read(&folder.join("mod.rs"));
        let said: String = text.lines().filter_map(|l| l.strip_prefix("//!")).collect::<String>().to_lowercase();
        for file in ["view", "passes", "reference", "candidates", "held"] {
            let stands = folder.join(format!("{file}.rs")).exists() || folder.join(file).join("mod.rs").exists();
            let is_missed = said.contains(&format!("no `{file}.rs`")) || said.contains(&format!("no {file}"));
            assert!(stands || is_missed, "src/{room} has no {file}.rs, and its mod.rs does not say why");
            assert!(!(stands && said.contains(&format!("no `{file}.rs`"))), "src/{room} has a {file}.rs after all");
        }
    }
}

#[test]
fn effects_do_not_use_each_other() {
    for (room, used) in rust_arrows().iter().filter(|(room, _)| EFFECTS.contains(&room.as_str())) {
        let others: Vec<_> = used.iter().filter(|u| EFFECTS.contains(&u.as_str())).collect();
        assert!(others.is_empty(), "{room} uses {others:?}");
    }
}

#[test]
fn arrows_and_circles_are_found() {
    let text = "use crate::{\n    error::{Error, Result},\n    gpu::Device,\n};\nfn f() { crate::sky::g() } // crate::fog\n\
                #[cfg(test)]\nmod tests {\n    use crate::rain;\n}\n";
    assert_eq!(named_in(text).into_iter().collect::<Vec<_>>(), ["error", "gpu", "sky"]);
    let arrow = |a: &str, b: &str| (a.to_string(), BTreeSet::from([b.to_string()]));
    assert_eq!(circle(&Arrows::from([arrow("a", "b"), arrow("b", "c")])), None);
    let round = Arrows::from([arrow("a", "b"), arrow("b", "c"), arrow("c", "b")]);
    assert_eq!(circle(&round), Some(vec!["b".to_string(), "c".to_string()]));
}

/// Functions of a file by their first lines' indentation: name and number of lines.
fn functions(text: &str) -> Vec<(String, usize)> {
    let mut open: Option<(String, usize, usize)> = None;
    let mut found = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let indent = line.len() - line.trim_start().len();
        let code = line.trim_start();
        let before = ["pub ", "pub(super) ", "pub(crate) ", "pub(in crate::capi) ", "const ", "unsafe "];
        let before = before.into_iter().chain(["extern \"C\" ", "extern \"system\" "]);
        let begins = before.fold(code, |rest, word| rest.strip_prefix(word).unwrap_or(rest)).starts_with("fn ");
        if begins && open.is_none() && !code.ends_with(['}', ';']) {
            let after = code.split("fn ").nth(1).unwrap_or("");
            let name = after.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            open = Some((name, i, indent));
        } else if let Some((name, start, at)) = &open
            && indent == *at
            && code == "}"
        {
            found.push((name.clone(), i - start + 1));
            open = None;
        }
    }
    found
}

#[test]
fn functions_fit_a_screen() {
    let mut count = 0;
    for (_, path) in files("src", "rs").into_iter().filter(|(_, path)| !path.ends_with("tests.rs")) {
        let text = read(&path);
        let code = text.split("#[cfg(test)]\nmod tests").next().expect("a first part");
        let most = if text.contains("\nimpl View {") { 60 } else { 80 };
        for (name, lines) in functions(code) {
            assert!(lines <= most, "{}: {name} has {lines} lines", path.display());
            count += 1;
        }
    }
    assert!(count > 1000, "{count} functions found");
    let two =
        functions("impl A {\n    pub fn a(\n    ) {\n        b();\n    }\n}\n\nunsafe extern \"C\" fn c() {\n}\n");
    assert_eq!(two, [("a".to_string(), 4), ("c".to_string(), 2)]);
}

/// The most parts of a tuple in the parameters of each function of a file, those in the types of closures too.
fn widest_tuples(text: &str) -> Vec<(String, usize)> {
    let code: String = text.lines().map(|l| l.split("//").next().expect("a first part").to_string() + "\n").collect();
    // So that every '>' closes a '<'.
    let code = code.replace("->", "  ");
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut found = Vec::new();
    for (at, _) in code.match_indices("fn ").filter(|(at, _)| !code[..*at].ends_with(is_word)) {
        let rest = &code[at + 3..];
        let name: String = rest.chars().take_while(|c| is_word(*c)).collect();
        if name.is_empty() {
            continue;
        }
        // Of each open bracket: whether it is a tuple's, and its parts so far, the one after a comma only once it
        // begins.
        let mut open: Vec<(char, bool, usize, bool)> = Vec::new();
        let (mut widest, mut before, mut word) = (0, 'a', name.clone());
        let mut is_past_parameters = false;
        for c in rest[name.len()..].chars() {
            if open.is_empty() && (matches!(c, '{' | ';') || (is_past_parameters && !c.is_whitespace())) {
                break;
            }
            match c {
                '(' | '[' | '<' | '{' => {
                    open.last_mut().into_iter().for_each(|o| (o.2, o.3) = (o.2 + usize::from(o.3), false));
                    let is_list = is_word(before) || before == '>';
                    let is_call = matches!(word.as_str(), "Fn" | "FnMut" | "FnOnce" | "fn") || open.is_empty();
                    open.push((c, c == '(' && !(is_list && is_call), 0, true));
                }
                ')' | ']' | '>' | '}' => {
                    let closed = open.pop().expect("an open bracket");
                    widest = widest.max(if closed.1 { closed.2 } else { 0 });
                    is_past_parameters |= open.is_empty() && c == ')';
                }
                ',' => open.last_mut().into_iter().for_each(|o| o.3 = true),
                c if !c.is_whitespace() => {
                    open.last_mut().into_iter().for_each(|o| (o.2, o.3) = (o.2 + usize::from(o.3), false));
                }
                _ => {}
            }
            if is_word(c) {
                if !is_word(before) {
                    word.clear();
                }
                word.push(c);
            }
            before = c;
        }
        found.push((name, widest));
    }
    found
}

#[test]
fn parameters_have_names_and_no_tuples_of_more_than_three_parts() {
    let text = "fn a((b, c): (u8, [u8; 2]), d: &[(u8, u8,)]) -> (u8, u8, u8, u8) {}\nfn e<F: Fn(u8, u8, u8, u8)>(f: F, g: u8, h: u8, i: u8, j: u8) {}\n\
                fn g(h: impl Fn(usize) -> (A, f64,\n    f64, f64)) {}\nfn i(j: fn(u8) -> u8, k: (u8, (u8, u8, u8), u8)) {}\n";
    let expected = [("a", 2), ("e", 0), ("g", 4), ("i", 3)].map(|(name, n)| (name.to_string(), n));
    assert_eq!(widest_tuples(text), expected);
    let mut count = 0;
    for (_, path) in files("src", "rs") {
        for (name, parts) in widest_tuples(&read(&path)) {
            assert!(parts <= 3, "{}: {name} has a tuple of {parts} parts among its parameters", path.display());
            count += 1;
        }
    }
    assert!(count > 2000, "{count} functions found");
}

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

/// The words of a file of Rust that name an effect or what only one has, in identifiers and in texts: messages, labels,
/// names of shaders' constants. Its comments are left out.
fn effects_named_in(text: &str, constants: &BTreeSet<String>) -> BTreeSet<String> {
    const NAMES: [&str; 6] = ["star", "stars", "sea", "ground", "windscreen", "mist"];
    // What they begin with: fogged, clouds, snowy, raining.
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
    // What light does at a place is no effect.
    const LIGHT: [&str; 6] = ["ground", "ground_albedo", "sky_lux", "GroundLight", "deck_cd_m2", "deck_cover"];
    let code: String = text.lines().map(|l| l.split("//").next().expect("a first part").to_string() + "\n").collect();
    let is_name = |w: &String| NAMES.contains(&w.as_str()) || BEGIN.iter().any(|b| w.starts_with(b));
    let words = code.split(|c: char| !c.is_alphanumeric() && c != '_');
    let names = |i: &&str| words_of(i).iter().any(is_name) && !LIGHT.contains(i);
    let in_texts = code.split('"').skip(1).step_by(2).filter(|text| constants.contains(*text));
    words.filter(names).chain(in_texts).map(str::to_string).collect()
}

/// The `override` constants that the effects' own shaders have and those of what lies between, and the frame's do not:
/// `FOG`, `AIR`.
fn constants_of_effects() -> BTreeSet<String> {
    let named = |line: &str| Some(line.strip_prefix("override ")?.split(':').next()?.trim().to_string());
    let of = |is_meant: fn(&str) -> bool| -> BTreeSet<String> {
        let texts = files("shaders", "wgsl").into_iter().filter(|f| is_meant(&f.0)).map(|f| read(&f.1));
        texts.flat_map(|text| text.lines().filter_map(named).collect::<Vec<_>>()).collect()
    };
    let theirs = of(|folder| EFFECTS.contains(&folder) || folder == "between");
    // What stands about the camera is of the surroundings.
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

/// Every `` `file` `function` `` of a numbered line of ARCHITECTURE.md.
fn hops() -> Vec<(String, String)> {
    let text = read(&root().join("ARCHITECTURE.md"));
    let is_numbered = |l: &&str| l.split_once(". `").is_some_and(|(n, _)| n.parse::<u32>().is_ok());
    let pairs = |line: &str| {
        let marked: Vec<String> = line.split('`').skip(1).step_by(2).map(str::to_string).collect();
        marked.chunks_exact(2).map(|p| (p[0].clone(), p[1].clone())).collect::<Vec<_>>()
    };
    text.lines().filter(is_numbered).filter(|l| l.contains("` `")).flat_map(pairs).collect()
}

#[test]
fn the_ways_through_the_code_lead_past_functions_that_stand_there() {
    let hops = hops();
    assert!(hops.len() > 15, "{hops:?}");
    for (file, function) in hops {
        let text = read(&root().join(&file));
        let stands = ['(', '<'].iter().any(|next| text.contains(&format!("fn {function}{next}")));
        assert!(stands, "{file} has no function {function}");
    }
}

/// The files of this repository that a text names with their folder, in the form `src/room/file.rs`.
fn files_named_in(text: &str) -> BTreeSet<String> {
    const FOLDERS: [&str; 9] =
        ["src/", "shaders/", "docs/", "tests/", "examples/", "benches/", "include/", "scripts/", "packaging/"];
    let is_path = |c: char| c.is_alphanumeric() || "_-./".contains(c);
    let words = text.split(|c: char| !is_path(c)).map(|word| word.trim_end_matches('.'));
    let named = words.filter(|word| FOLDERS.iter().any(|folder| word.starts_with(folder)));
    named.filter(|word| Path::new(word).extension().is_some_and(|e| e != "so")).map(str::to_string).collect()
}

#[test]
fn files_that_texts_name_stand_where_they_say() {
    let some =
        "as in `src/rain/gone.rs`, (docs/lab/README.md). A crate's own: ../src/lib.rs, other/src/x.rs, src/rain.";
    assert!(files_named_in(some).into_iter().eq(["docs/lab/README.md", "src/rain/gone.rs"]));
    let own = ["src", "shaders", "docs", "tests", "examples", "benches", "include"];
    let kinds = ["rs", "wgsl", "md", "c", "h", "hpp", "toml"];
    let below = own.iter().flat_map(|top| kinds.iter().flat_map(|kind| files(top, kind)));
    let all = below.map(|(_, path)| path).chain(["README.md", "ARCHITECTURE.md"].map(|name| root().join(name)));
    let texts = all.filter(|path| !path.ends_with("tests/rooms.rs"));
    let missing = |path: &PathBuf| {
        let named = files_named_in(&read(path)).into_iter().filter(|name| !root().join(name).exists());
        named.map(|name| format!("{} names {name}", path.display())).collect::<Vec<_>>()
    };
    let missing: Vec<String> = texts.flat_map(|path| missing(&path)).collect();
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}

/// virgl sends the output of a fragment shader that has none at location 0 to the first image (docs/drivers.md).
#[test]
fn a_fragment_shader_names_the_first_output() {
    let at_fault = files("shaders", "wgsl").into_iter().flat_map(|(_, path)| {
        let text = read(&path);
        let alone = |line: &str| line.split_once("-> @location(").is_some_and(|(_, rest)| !rest.starts_with('0'));
        let lines: Vec<_> = text.lines().filter(|line| alone(line)).map(str::to_string).collect();
        lines.into_iter().map(move |line| format!("{}: {line}", path.display()))
    });
    assert_eq!(at_fault.collect::<Vec<_>>(), Vec::<String>::new());
}

/// Rooms in which states are stepped and what they are stepped by is found.
const SAME_BITS: [&str; 14] = [
    "almanac",
    "chance",
    "context",
    "falling",
    "flow",
    "ground",
    "planet",
    "snowpack",
    "surroundings",
    "terrain",
    "weather",
    "wind",
    "world",
    "scene",
];

/// Files of them that only draw or measure light, which is rounded before it decides a state.
const LIGHT_ALONE: [&str; 5] =
    ["scene/camera.rs", "scene/depth.rs", "scene/light.rs", "planet/spectral.rs", "planet/mod.rs"];

/// Functions of the standard library and of glam whose last bits are the platform's.
const PLATFORMS: [&str; 30] = [
    "sin(",
    "cos(",
    "tan(",
    "asin(",
    "acos(",
    "atan(",
    "atan2(",
    "sin_cos(",
    "exp(",
    "exp2(",
    "exp_m1(",
    "ln(",
    "ln_1p(",
    "log10(",
    "log2(",
    "log(",
    "powf(",
    "cbrt(",
    "hypot(",
    "sinh(",
    "cosh(",
    "tanh(",
    "mul_add(",
    "from_rotation_x(",
    "from_rotation_y(",
    "from_rotation_z(",
    "from_axis_angle(",
    "from_angle(",
    "angle_between(",
    "angle_to(",
];

#[test]
fn what_decides_a_state_takes_its_functions_from_libm() {
    let mut found = Vec::new();
    for (room, path) in files("src", "rs") {
        let name = path.strip_prefix(root().join("src")).expect("below it").to_string_lossy().replace('\\', "/");
        let tests = name.ends_with("tests.rs") || name.contains("/tests/");
        if !SAME_BITS.contains(&room.as_str()) || LIGHT_ALONE.contains(&name.as_str()) || tests {
            continue;
        }
        let text = read(&path);
        let code = text.split("mod tests {").next().unwrap_or_default();
        for (number, line) in code.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//")) {
            let line = line.replace("libm::", "libm ");
            let calls = |call: &&&str| line.contains(&format!(".{call}")) || line.contains(&format!("::{call}"));
            if let Some(call) = PLATFORMS.iter().find(calls) {
                found.push(format!("src/{name}:{}: {call}", number + 1));
            }
        }
    }
    assert!(found.is_empty(), "other machines find other bits; use libm:\n{}", found.join("\n"));
}
