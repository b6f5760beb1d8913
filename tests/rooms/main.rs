//! Structure of the sources: the rooms that each room of `src/` uses, and the folders that each folder of `shaders/`
//! uses, against the table of ARCHITECTURE.md; no circle, neither of rooms nor of files; lengths of functions, names of
//! parameters, and other rules for the text of the sources.

mod api;
mod bits;
mod circles;
mod code;
mod effects;
mod functions;
mod texts;

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

use code::Sources;

/// Rooms that each room uses.
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

fn rust_arrows() -> Arrows {
    let sources = Sources::read();
    // Files at the top of the crate may use all rooms.
    let rooms: BTreeSet<_> = sources.iter().filter_map(|(module, _)| module.first()).collect();
    let mut arrows = Arrows::new();
    for (module, _) in sources.iter() {
        let Some(room) = module.first() else { continue };
        let used = sources.rooms_named_by(module).into_iter().filter(|used| rooms.contains(used) && used != room);
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

/// Rooms that each room may use, from the rows of the table whose first cells begin with `` `top/ ``.
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

/// Finds a circle: rooms of which each uses the next, and the last uses the first.
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

const EFFECTS: [&str; 12] =
    ["sky", "stars", "clouds", "lightning", "fog", "rain", "snow", "ground", "land", "glass", "bow", "sea"];

#[test]
fn the_effects_are_those_of_the_list() {
    // Rooms that src/effects.rs names for a view of their own, except the plane of tests.
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
    let text = "use crate::{error::{Error, Result}, gpu::Device};\n\
                fn f() { crate::sky::g(super::stars::H, super::b) } // crate::fog\n\
                #[cfg(test)]\nmod tests {\n    use crate::rain;\n}\n";
    let module = ["bow".to_string()];
    let named = Sources::of_texts(&[(&["bow"], text)]).rooms_named_by(&module);
    assert_eq!(named.into_iter().collect::<Vec<_>>(), ["b", "error", "gpu", "sky", "stars"]);
    let arrow = |a: &str, b: &str| (a.to_string(), BTreeSet::from([b.to_string()]));
    assert_eq!(circle(&Arrows::from([arrow("a", "b"), arrow("b", "c")])), None);
    let round = Arrows::from([arrow("a", "b"), arrow("b", "c"), arrow("c", "b")]);
    assert_eq!(circle(&round), Some(vec!["b".to_string(), "c".to_string()]));
}
