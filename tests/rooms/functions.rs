//! Lengths of functions and names of their parameters.

use crate::{code::Sources, files, read};

/// Functions of a file, each with its name and number of lines: a function ends at the line with the indentation of its
/// first.
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

/// Words that place a thing without naming it.
const PREPOSITIONS: [&str; 38] = [
    "about", "above", "across", "after", "against", "along", "among", "around", "at", "before", "behind", "below",
    "beside", "between", "beyond", "by", "down", "from", "inside", "into", "near", "of", "off", "on", "onto", "out",
    "outside", "over", "per", "through", "to", "toward", "under", "until", "up", "when", "with", "within",
];
/// Function whose errors name its parameters as the C API does.
const AS_IN_C: &str = "front/air: between";
/// Greatest number of parts of a tuple among the parameters.
const TUPLE_PARTS: usize = 2;

/// Messages about the parameters of a file's functions that are wide tuples or have a preposition for a name.
fn unnamed_parameters(sources: &Sources) -> Vec<String> {
    let mut found = Vec::new();
    for (module, file) in sources.iter() {
        for function in &file.functions {
            let place = format!("{}: {}", module.join("/"), function.name);
            for parameter in &function.parameters {
                if parameter.tuple_parts > TUPLE_PARTS {
                    found.push(format!("{place} has a tuple of {} parts", parameter.tuple_parts));
                }
                if PREPOSITIONS.contains(&parameter.name.as_str()) && place != AS_IN_C {
                    found.push(format!("{place} has a parameter `{}`", parameter.name));
                }
            }
        }
    }
    found
}

#[test]
fn parameters_are_things_and_no_tuples_of_three_parts() {
    let text = "fn a((b, c): (u8, [u8; 2]), d: &[(u8, u8,)]) -> (u8, u8, u8, u8) {}\n\
                fn e<F: Fn(u8, u8, u8, u8)>(f: F, at: u8) {}\n\
                extern \"C\" fn f(of: u8) {}\n\
                trait T { fn g(&self, h: impl Fn(usize) -> (A, f64, f64, f64)); }\n\
                fn i(j: fn(u8) -> u8, k: (u8, (u8, u8, u8))) {}\n";
    let expected = ["m: e has a parameter `at`", "m: g has a tuple of 4 parts", "m: i has a tuple of 3 parts"];
    assert_eq!(unnamed_parameters(&Sources::of_texts(&[(&["m"], text)])), expected);
    let sources = Sources::read();
    let count: usize = sources.iter().map(|(_, file)| file.functions.len()).sum();
    assert!(count > 2000, "{count} functions found");
    let found = unnamed_parameters(&sources);
    assert!(found.is_empty(), "{} parameters:\n{}", found.len(), found.join("\n"));
}
