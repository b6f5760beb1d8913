//! Rules for the words of the code: a doc block begins with a noun or a verb, no line of a comment is wider than 120
//! columns, a type name has one meaning, a setter is not named like a question, and the glossary is short.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

/// Most columns of a line of a comment. Tables are as wide as they are.
const COLUMNS: usize = 120;
/// First words of doc blocks that tell neither what a thing is nor what it does.
const OPENINGS: [&str; 6] = ["Of", "The same", "Likewise", "Those", "Which", "What"];

fn files(folders: &[&str]) -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut left: Vec<PathBuf> = folders.iter().map(|folder| root.join(folder)).collect();
    let mut found = Vec::new();
    while let Some(path) = left.pop() {
        if path.is_dir() {
            left.extend(fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        } else if path.extension().is_some_and(|e| e == "rs" || e == "wgsl" || e == "glsl") {
            let text = fs::read_to_string(&path).unwrap();
            found.push((path, text));
        }
    }
    found
}

/// Text of a comment line, if it is one.
fn comment(line: &str) -> Option<&str> {
    line.trim_start().strip_prefix("//")
}

/// Text of a doc line, if it is one.
fn doc(line: &str) -> Option<&str> {
    comment(line).and_then(|c| c.strip_prefix(['/', '!'])).map(str::trim_start)
}

/// First lines of doc blocks with one of the openings.
fn without_a_noun(text: &str) -> Vec<(usize, &str)> {
    let opens = |first: &str| {
        OPENINGS.iter().any(|o| first.strip_prefix(o).is_some_and(|rest| rest.starts_with([' ', ',', ':', '.'])))
    };
    let mut before = None;
    let mut found = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let here = doc(line);
        if let (None, Some(first)) = (before, here)
            && opens(first)
        {
            found.push((i + 1, first));
        }
        before = here;
    }
    found
}

/// Lines of comments that are too wide, other than rows of tables and examples of code, which are indented.
fn too_wide(text: &str) -> Vec<(usize, &str)> {
    let is_prose = |c: &str| !c.trim_start_matches(['/', '!']).trim_start().starts_with('|') && !c.contains("   ");
    let wide = |line: &&str| line.chars().count() > COLUMNS && comment(line).is_some_and(is_prose);
    text.lines().enumerate().filter(|(_, line)| wide(line)).map(|(i, line)| (i + 1, line)).collect()
}

#[test]
fn doc_blocks_begin_with_a_noun_or_a_verb() {
    let text = "/// Of the camera.\nfn a() {}\n/// Velocity.\n/// Of it.\nfn b() {}\n//! What it is.\n/// Offset.\n";
    let found: Vec<usize> = without_a_noun(text).into_iter().map(|(line, _)| line).collect();
    assert_eq!(found, [1, 6], "the rule itself");
    let all: Vec<String> = files(&["src"])
        .iter()
        .flat_map(|(path, text)| without_a_noun(text).into_iter().map(|(i, l)| format!("{}:{i}: {l}", path.display())))
        .collect();
    assert!(all.is_empty(), "{} doc blocks:\n{}", all.len(), all.join("\n"));
}

#[test]
fn comments_are_at_most_120_columns_wide() {
    let wide = "x".repeat(120);
    let text = format!("// {wide}\n/// | {wide}\n//   {wide}\nlet a = \"{wide}\";\n// short\n    /// {wide}\n");
    let found: Vec<usize> = too_wide(&text).into_iter().map(|(line, _)| line).collect();
    assert_eq!(found, [1, 6], "the rule itself");
    let all: Vec<String> = files(&["src", "shaders", "tests", "examples", "benches"])
        .iter()
        .flat_map(|(path, text)| too_wide(text).into_iter().map(|(i, _)| format!("{}:{i}", path.display())))
        .collect();
    assert!(all.is_empty(), "{} lines:\n{}", all.len(), all.join("\n"));
}

/// Names of public types that two public modules share.
const SHARED_NAMES: [&str; 8] = ["Moment", "Place", "Ray", "Span", "Surface", "Table", "View", "Wind"];

/// Names of the types that a file defines outside of its tests and of text in quotes.
fn types(text: &str) -> Vec<&str> {
    let text = text.split("\n#[cfg(test)]\nmod tests {").next().unwrap_or(text);
    let mut in_quotes = false;
    let mut found = Vec::new();
    for line in text.lines() {
        let was_in_quotes = in_quotes;
        in_quotes ^= line.matches('"').count() % 2 == 1;
        let line = line.strip_prefix("pub").map_or(line, |rest| {
            rest.strip_prefix('(').and_then(|r| r.split_once(')')).map_or(rest, |(_, rest)| rest).trim_start()
        });
        let kinds = ["struct ", "enum ", "union ", "trait ", "type "];
        let name = kinds.iter().find_map(|kind| line.strip_prefix(kind));
        if let (Some(rest), false) = (name, was_in_quotes) {
            let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
            found.push(&rest[..end]);
        }
    }
    found
}

#[test]
fn one_name_of_a_type_has_one_meaning() {
    let text = "pub struct A;\nenum B {}\npub(crate) trait C<T> {}\nconst T: &str = \"\nstruct D {\n\";\n    type E = u8;\n\
                \n#[cfg(test)]\nmod tests {\nstruct F;\n";
    assert_eq!(types(text), ["A", "B", "C"], "the rule itself");
    let mut files_of: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (path, text) in files(&["src"]) {
        let path = path.display().to_string();
        if path.contains("/tests") || path.ends_with("tests.rs") || path.ends_with(".wgsl") {
            continue;
        }
        types(&text).into_iter().for_each(|name| files_of.entry(name.to_owned()).or_default().push(path.clone()));
    }
    files_of.retain(|_, files| files.len() > 1);
    let names: Vec<&str> = files_of.keys().map(String::as_str).collect();
    assert_eq!(names, SHARED_NAMES, "{files_of:#?}");
}

#[test]
fn functions_named_as_questions_change_nothing() {
    let asks = |line: &&str| {
        let Some(rest) =
            line.trim_start().trim_start_matches("pub ").trim_start_matches("pub(crate) ").strip_prefix("fn ")
        else {
            return false;
        };
        (rest.starts_with("is_") || rest.starts_with("has_")) && rest.contains("(&mut self")
    };
    assert!(asks(&"    pub fn is_fine(&mut self) {") && !asks(&"    fn is_fine(&self) -> bool {"), "the rule itself");
    let all: Vec<String> = files(&["src"])
        .iter()
        .flat_map(|(path, text)| text.lines().filter(asks).map(move |line| format!("{}: {line}", path.display())))
        .collect();
    assert!(all.is_empty(), "{all:#?}");
}

/// Most rows of the glossary.
const GLOSSARY_WORDS: usize = 50;

/// Rows of a Markdown table whose first cell is a word in lower case, cell by cell.
fn glossary_rows(text: &str) -> Vec<Vec<&str>> {
    let rows =
        text.lines().filter_map(|line| line.strip_prefix("| ")).map(|row| row.split('|').map(str::trim).collect());
    rows.skip(1).filter(|cells: &Vec<&str>| cells[0].starts_with(char::is_lowercase)).collect()
}

#[test]
fn the_glossary_has_a_sentence_for_each_of_few_words() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("docs/glossary.md")).unwrap();
    let rows = glossary_rows(&text);
    assert!((30..=GLOSSARY_WORDS).contains(&rows.len()), "{} words", rows.len());
    assert!(rows.is_sorted_by(|a, b| a[0] < b[0]), "a word stands twice or out of order");
    for cells in rows {
        let [word, meaning, _, room, _] = cells[..] else { panic!("{cells:?}") };
        assert!(meaning.starts_with(char::is_uppercase) && meaning.ends_with('.'), "{word}: {meaning}");
        assert!(!meaning.trim_end_matches('.').contains(". "), "{word} has more than one sentence");
        for room in room.split('`').skip(1).step_by(2) {
            assert!(room == "reference.rs" || root.join(room).exists(), "{word}: {room}");
        }
    }
}
