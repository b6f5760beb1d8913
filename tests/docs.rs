//! The documents for users: the README's programs are the files that the tests run, its figures are the lab's, and
//! every article is in the manual's contents, ends with where to go next, and names files that exist.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// The first block of a text in this language.
fn block(text: &str, language: &str) -> String {
    let rest = text.split(&format!("```{language}\n")).nth(1).unwrap_or_else(|| panic!("no block of {language}"));
    rest.split("```").next().expect("a part").to_owned()
}

/// Files with this ending in a folder of documents, named from the repository's root.
fn documents(folder: &str) -> Vec<String> {
    let files = fs::read_dir(root().join(folder)).expect("a folder").map(|f| f.expect("a file").file_name());
    let names = files.map(|name| name.into_string().expect("a name")).filter(|name| name.ends_with(".md"));
    let mut names: Vec<String> = names.map(|name| format!("{folder}/{name}")).collect();
    names.sort();
    names
}

/// Returns the targets of a document's links from the repository's root, without links to other sites.
fn links(path: &str) -> Vec<PathBuf> {
    let text = read(path);
    let text: String = text.split("```").step_by(2).collect(); // Code has no links, though a lambda looks like one.
    let folder = Path::new(path).parent().expect("a folder");
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let own = targets.filter(|to| !to.contains("://") && !to.starts_with('#'));
    own.map(|to| folder.join(to.split('#').next().expect("a part"))).collect()
}

#[test]
fn the_readme_has_the_minimal_program_whole() {
    assert_eq!(block(&read("README.md"), "c"), read("examples/minimal.c"));
}

#[cfg(unix)]
#[test]
fn the_readme_s_cpp_class_compiles() {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join("docs-readme");
    fs::create_dir_all(&dir).expect("the target directory is writable");
    let source = dir.join("readme.cpp");
    fs::write(&source, block(&read("README.md"), "cpp")).expect("the folder is ours");
    for language in [&["-std=c++11"][..], &["-std=c++17"], &["-std=c++17", "-fno-exceptions"]] {
        let mut cc = std::process::Command::new("g++");
        cc.args(language).args(["-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only", "-I"]);
        let done = cc.arg(root().join("include")).arg(&source).output().expect("a compiler");
        assert!(done.status.success(), "{language:?}: {}", String::from_utf8_lossy(&done.stderr));
    }
}

/// Milliseconds of a row of the lab's table of a GPU at 1920x1080.
fn gpu_ms(scene: &str) -> f64 {
    let table = read("docs/lab/gpu.md");
    let row = table.lines().find(|l| l.starts_with(&format!("| {scene} |"))).unwrap_or_else(|| panic!("no {scene}"));
    row.split('|').nth(2).expect("a column").trim().parse().expect("a number")
}

#[test]
fn the_readme_s_times_are_the_lab_s() {
    let readme = read("README.md");
    let said = |ms: f64, what: &str| format!("{ms:.1} ms {what}");
    for (scene, what) in [
        ("clear noon", "under a clear sky"),
        ("rain of 5 mm/h", "in rain of 5 mm/h"),
        ("broken cumulus", "under broken cumulus"),
    ] {
        let wanted = said(gpu_ms(scene), what);
        assert!(readme.contains(&wanted), "the README should say {wanted:?}");
    }
}

#[test]
fn the_readme_s_test_commands_are_the_makefile_s() {
    let (readme, makefile) = (read("README.md"), read("Makefile"));
    for target in ["test", "ci"] {
        assert!(readme.contains(&format!("make {target} ")), "{target}");
        assert!(makefile.lines().any(|l| l.starts_with(&format!("{target}:"))), "{target}");
    }
    assert!(makefile.contains("\nci: lint docs test windows drivers "), "all of it, in this order");
}

#[test]
fn the_contents_list_every_article() {
    let listed: BTreeSet<PathBuf> = links("docs/README.md").into_iter().collect();
    let articles = documents("docs").into_iter().chain(documents("docs/sources"));
    let missing: Vec<String> = articles.filter(|d| d != "docs/README.md" && !listed.contains(Path::new(d))).collect();
    assert!(missing.is_empty(), "docs/README.md does not list {missing:?}");
}

#[test]
fn links_lead_somewhere() {
    let own = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "SECURITY.md"].map(str::to_owned);
    let mut dead = Vec::new();
    for document in
        own.into_iter().chain(documents("docs")).chain(documents("docs/lab")).chain(documents("docs/sources"))
    {
        dead.extend(
            links(&document).into_iter().filter(|to| !root().join(to).exists()).map(|to| (document.clone(), to)),
        );
    }
    assert!(dead.is_empty(), "{dead:?}");
}

/// Largest number of words of an article, without its section on where to go next.
const MOST_WORDS: usize = 900;

#[test]
fn articles_are_short_and_say_where_to_go_next() {
    let mut wrong = Vec::new();
    for article in documents("docs").into_iter().filter(|d| d != "docs/README.md") {
        let text = read(&article);
        let (body, next) = text.rsplit_once("\n## ").expect("an article has sections");
        let Some(next) = next.strip_prefix("Where to go next\n") else {
            wrong.push(format!("{article} does not end with where to go next"));
            continue;
        };
        if !next.contains("](") {
            wrong.push(format!("{article} leads nowhere"));
        }
        let words = body.split_whitespace().filter(|word| word.contains(char::is_alphanumeric)).count();
        if words > MOST_WORDS {
            wrong.push(format!("{article} has {words} words, at most {MOST_WORDS}"));
        }
        if text.contains("cargo test") {
            wrong.push(format!("{article} sends users to a test: docs/lab/checks.md is the place"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Numbers of the ids in a row's first cell: `M-05`, `M-38, M-39`, `T-02 to T-23`.
fn ids(cell: &str) -> BTreeSet<String> {
    let number = |id: &str| id.split_once('-').and_then(|(_, n)| n.parse::<u32>().ok()).expect("an id with a number");
    let mut all = BTreeSet::new();
    for part in cell.split(", ") {
        let (first, last) = part.split_once(" to ").unwrap_or((part, part));
        all.extend((number(first)..=number(last)).map(|n| format!("{}-{n:02}", &first[..1])));
    }
    all
}

/// Rows of a source's page: the ids, and what stands for them.
fn rows(text: &str) -> Vec<(BTreeSet<String>, &str)> {
    let rows = text.lines().filter(|line| line.starts_with("| ") && !line.starts_with("| id "));
    rows.map(|row| {
        let cells: Vec<&str> = row.trim_matches('|').split(" | ").map(str::trim).collect();
        (ids(cells[0]), *cells.last().expect("a cell"))
    })
    .collect()
}

#[test]
fn pages_of_sources_have_each_id_once_and_count_them() {
    let pages = documents("docs/sources");
    assert!(pages.len() >= 5, "{pages:?}");
    for page in pages {
        let text = read(&page);
        let (mut seen, mut counts) = (BTreeSet::new(), [0; 3]);
        for (ids, cell) in rows(&text) {
            let kind = if cell.starts_with("none yet") { 2 } else { usize::from(cell.starts_with("partly")) };
            counts[kind] += ids.len();
            for id in ids {
                assert!(seen.insert(id.clone()), "{page} has {id} twice");
            }
        }
        let [built, partly, none] = counts;
        let line = format!("{} ids: {built} built, {partly} partly, {none} none yet.", seen.len());
        assert!(text.contains(&line), "{page} should say: {line}");
        // Numbers of a letter run without a gap.
        for letter in seen.iter().map(|id| &id[..1]).collect::<BTreeSet<_>>() {
            let numbers: Vec<u32> = seen.iter().filter_map(|id| id.strip_prefix(letter)?[1..].parse().ok()).collect();
            assert!(numbers.windows(2).all(|n| n[1] == n[0] + 1), "{page} leaves out one of {letter}: {numbers:?}");
        }
    }
}

/// Text of every Rust and C source of the repository.
fn sources() -> String {
    fn gather(folder: &Path, all: &mut String) {
        for entry in fs::read_dir(folder).expect("a folder").map(|e| e.expect("an entry").path()) {
            if entry.is_dir() {
                gather(&entry, all);
            } else if entry.extension().is_some_and(|e| ["rs", "c", "cpp", "h", "wgsl"].iter().any(|x| e == *x)) {
                all.push_str(&fs::read_to_string(entry).expect("a text"));
            }
        }
    }
    let mut all = String::new();
    for folder in ["src", "tests", "examples", "shaders", "include", "benches"] {
        gather(&root().join(folder), &mut all);
    }
    all
}

#[test]
fn names_on_the_pages_of_sources_stand_in_the_code() {
    let code = sources();
    let words: BTreeSet<&str> = code.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect();
    let mut missing = Vec::new();
    for page in documents("docs/sources").into_iter().chain(["docs/rain-features.md".into()]) {
        let text = read(&page);
        // Files are checked elsewhere; commands and formulas are no names.
        let is_name = |name: &&str| {
            name.contains('_')
                && name.chars().all(|c| c.is_alphanumeric() || "_.:".contains(c))
                && !name.contains(".rs")
        };
        for name in text.split('`').skip(1).step_by(2).filter(is_name) {
            let parts = name.split(['.', ':']).filter(|part| !part.is_empty());
            missing.extend(parts.filter(|part| !words.contains(part)).map(|part| format!("{page}: {part}")));
        }
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}
