//! Circles of files: no room has one, whether a file names another by `crate::`, by `super::` or through other files'
//! `use` lines.

use std::collections::BTreeMap;

use crate::{
    Arrows, circle,
    code::{ModulePath, Sources},
};

fn file_arrows(sources: &Sources) -> Arrows {
    let name = |module: &ModulePath| module.join("/");
    let used = |module: &ModulePath| sources.used_by(module).into_iter().map(name).collect();
    sources.iter().map(|(module, _)| (name(module), used(module))).collect::<BTreeMap<_, _>>()
}

#[test]
fn arrows_between_files_are_found() {
    let sources = Sources::of_texts(&[
        (&[], "pub mod a;"),
        (&["a"], "mod b; mod c; pub use b::B; pub use c::*; struct Own; fn f() { c::g() }"),
        (&["a", "b"], "use super::{C as D, Own as O}; pub struct B(D); mod within { use super::super::C; }"),
        (&["a", "c"], "pub struct C; fn g() { vec![crate::a::B::new()] } #[cfg(test)] mod tests { use super::Own; }"),
    ]);
    let arrows = file_arrows(&sources);
    let of = |file: &str| arrows[file].iter().cloned().collect::<Vec<_>>();
    assert_eq!((of(""), of("a")), (vec![], vec!["a/b".to_string(), "a/c".to_string()]));
    assert_eq!((of("a/b"), of("a/c")), (vec!["a".to_string(), "a/c".to_string()], vec!["a/b".to_string()]));
    assert!(circle(&arrows).is_some());
}

#[test]
fn files_form_no_circle() {
    let arrows = file_arrows(&Sources::read());
    assert!(arrows.len() > 300, "{} files found", arrows.len());
    let count: usize = arrows.values().map(|used| used.len()).sum();
    assert!(count > 1000, "{count} arrows found");
    assert_eq!(circle(&arrows), None, "files form a circle");
}
