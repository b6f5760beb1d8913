//! Files and functions that documents name, and the first output of a fragment shader.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

use crate::{files, read, root};

/// Every `` `file` `function` `` pair in the numbered lines of ARCHITECTURE.md.
fn hops() -> Vec<(String, String)> {
    let text = read(&root().join("ARCHITECTURE.md"));
    let is_numbered = |l: &&str| l.split_once(". `").is_some_and(|(n, _)| n.parse::<u32>().is_ok());
    let pairs = |line: &str| {
        let marked: Vec<String> = line.split('`').skip(1).step_by(2).map(str::to_string).collect();
        marked.chunks_exact(2).map(|p| (p[0].clone(), p[1].clone())).collect::<Vec<_>>()
    };
    text.lines().filter(is_numbered).filter(|l| l.contains("` `")).flat_map(pairs).collect()
}

/// Rooms along each way through the code, step by step, from the numbered lines of ARCHITECTURE.md.
fn ways(text: &str) -> Vec<Vec<String>> {
    let mut ways = Vec::new();
    for line in text.lines() {
        if line.starts_with("1. `") {
            ways.push(Vec::new());
        }
        let is_hop = line.split_once(". `").is_some_and(|(n, _)| n.parse::<u32>().is_ok()) && line.contains("` `");
        if let (true, Some(way)) = (is_hop, ways.last_mut()) {
            let path: Vec<&str> = line.split('`').nth(1).unwrap_or_default().split('/').collect();
            way.push(path[..path.len().min(2)].join("/"));
        }
    }
    ways.into_iter().filter(|way| !way.is_empty()).collect()
}

#[test]
fn the_ways_through_the_code_are_short_and_return_to_no_room() {
    let found = ways(&read(&root().join("ARCHITECTURE.md")));
    assert_eq!(found.len(), 7, "{found:?}");
    for way in found {
        assert!((3..=8).contains(&way.len()), "{way:?}");
        let mut passed = way.clone();
        passed.dedup();
        let rooms: BTreeSet<_> = passed.iter().collect();
        assert_eq!(rooms.len(), passed.len(), "{way:?} returns to a room that it left");
    }
    let back = "1. `src/a/x.rs` `f` does;\n2. `src/b.rs` `g` does;\n3. `src/a/y.rs` `h` does.\n";
    assert_eq!(ways(back), [["src/a", "src/b.rs", "src/a"]]);
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

/// Files that a text names with their folder, in the form `src/room/file.rs`: from the repository's root, or from its
/// own package's.
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
    let texts = all.filter(|path| !path.ends_with("tests/rooms/texts.rs"));
    let missing = |path: &PathBuf| {
        let package =
            path.ancestors().find(|folder| folder.join("Cargo.toml").exists()).expect("the library's, if no other");
        let stands = |name: &String| [root(), package].iter().any(|folder| folder.join(name).exists());
        let named = files_named_in(&read(path)).into_iter().filter(|name| !stands(name));
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
