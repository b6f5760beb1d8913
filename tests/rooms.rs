//! Rooms and arrows: which room of `src/` and which folder of `shaders/` uses which, held against the table of ARCHITECTURE.md. And how
//! long functions are.

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

#[test]
fn effects_do_not_use_each_other() {
    const EFFECTS: [&str; 7] = ["sky", "stars", "lightning", "fog", "rain", "ground", "glass"];
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
        let most = if path.ends_with("frame/view.rs") { 60 } else { 80 };
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

/// The identifiers of a file of Rust that name an effect; its comments and texts left out.
fn effects_named_in(text: &str) -> BTreeSet<String> {
    const NAMES: [&str; 15] = [
        "sky",
        "star",
        "stars",
        "cloud",
        "clouds",
        "fog",
        "rain",
        "snow",
        "ground",
        "glass",
        "windscreen",
        "sea",
        "lightning",
        "soil",
        "flakes",
    ];
    // What light does at a place is no effect.
    const LIGHT: [&str; 4] = ["ground", "ground_albedo", "sky_lux", "GroundLight"];
    let code: String = text.lines().map(|l| l.split("//").next().expect("a first part").to_string() + "\n").collect();
    let outside_texts: String = code.split('"').step_by(2).collect::<Vec<_>>().join(" ");
    let identifiers = outside_texts.split(|c: char| !c.is_alphanumeric() && c != '_');
    let names = |i: &&str| words_of(i).iter().any(|w| NAMES.contains(&w.as_str()));
    identifiers.filter(names).filter(|i| !LIGHT.contains(i)).map(str::to_string).collect()
}

#[test]
fn identifiers_that_name_an_effect_are_found() {
    let found = effects_named_in("let x = self.set_rain_areas(GroundView::new(\"fog\"), sky_lux); // snow\n");
    assert_eq!(found, BTreeSet::from(["GroundView".to_string(), "set_rain_areas".to_string()]));
}

#[test]
fn frame_and_context_name_no_effect() {
    for (room, path) in files("src", "rs") {
        if room == "frame" || room == "context" {
            let found = effects_named_in(&read(&path));
            assert!(
                found.is_empty(),
                "{} names {found:?}: that belongs in src/effects.rs or src/front",
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
        assert!(text.contains(&format!("fn {function}")), "{file} has no function {function}");
    }
}
