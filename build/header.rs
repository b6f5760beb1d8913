//! Writes `welkin.h`: for each section its article, then what cbindgen makes of its Rust files, then the
//! `WK_X_INIT` macros, all in reading order. cbindgen alone would sort constants, types and functions apart.

use std::{fmt::Write as _, path::Path};

use crate::abi::{Enumeration, Model, Section, Struct, type_name};

/// The whole header.
pub fn write(model: &Model, out_dir: &Path, config: &Path, version: &str) -> String {
    println!("cargo:rerun-if-changed={}", config.display());
    let config = cbindgen::Config::from_file(config).expect("cbindgen.toml");
    let mut out = String::new();
    for (i, section) in model.sections.iter().enumerate() {
        let body = bindings(section, out_dir, &config);
        if i == 0 {
            let article: Vec<String> = section.article.iter().cloned().chain(contents(&model.sections[1..])).collect();
            out.push_str(&comment(&article));
            out.push_str(&opening(version));
        } else {
            let _ = write!(out, "\n{}{}", banner(section), arrange(section, &body));
        }
    }
    out.push_str("\n#ifdef __cplusplus\n} /* extern \"C\" */\n#endif\n\n#endif /* WELKIN_H */\n");
    squeeze(&out)
}

/// cbindgen's view of one section.
fn bindings(section: &Section, out_dir: &Path, config: &cbindgen::Config) -> String {
    let inits = out_dir.join(format!("init_{}.rs", section.module));
    let mut config = config.clone();
    config.export.include.extend(section.structs.iter().map(|s| s.name.clone()));
    config.export.include.extend(section.enums.iter().map(|e| e.name.clone()));
    let sources = section.sources.iter().fold(cbindgen::Builder::new(), |builder, path| builder.with_src(path));
    let bindings = sources
        .with_config(config)
        .with_src(inits)
        .generate()
        .unwrap_or_else(|e| panic!("cbindgen, section {}: {e}", section.module));
    let mut text = Vec::new();
    bindings.write(&mut text);
    String::from_utf8(text).expect("cbindgen writes UTF-8")
}

fn opening(version: &str) -> String {
    let mut parts = version.split('.');
    let mut part = || parts.next().unwrap_or("0").to_owned();
    let (major, minor, patch) = (part(), part(), part());
    format!(
        "#ifndef WELKIN_H\n#define WELKIN_H\n\n#include <stddef.h>\n#include <stdint.h>\n\n\
         /** Version of this header; `wk_version` gives the library's. */\n\
         #define WK_VERSION_MAJOR {major}\n#define WK_VERSION_MINOR {minor}\n#define WK_VERSION_PATCH {patch}\n\n\
         /** Define WK_SHARED when linking the shared library on Windows. Elsewhere it is not needed. */\n\
         #ifndef WK_API\n#if defined(_WIN32) && defined(WK_SHARED)\n#define WK_API __declspec(dllimport)\n\
         #else\n#define WK_API\n#endif\n#endif\n\n\
         #ifdef __cplusplus\nextern \"C\" {{\n#endif\n"
    )
}

/// A C block comment of plain lines.
fn comment(lines: &[String]) -> String {
    let mut out = String::from("/*\n");
    // Fences say to rustdoc that what they hold is no Rust.
    for line in lines.iter().filter(|l| !l.trim_start().starts_with("```")) {
        let line = line.strip_prefix(' ').unwrap_or(line).replace("*/", "* /");
        let _ = writeln!(out, "{}", format!(" * {line}").trim_end());
    }
    out.push_str(" */\n");
    out
}

/// Topics of the table of contents, each by the section that it begins with.
const TOPICS: [(&str, &str); 10] = [
    ("status", "What every call answers"),
    ("device", "Devices and hosts"),
    ("weather_kinds", "Weather, place and time"),
    ("conditions", "Questions"),
    ("frame", "Pictures"),
    ("rain", "What falls"),
    ("wind_grid", "Wind, shelter and lamps"),
    ("stars", "Stars, clouds and lightning"),
    ("windscreen", "Glass and ground"),
    ("sea", "The sea"),
];

/// The table of contents: a section's name in brackets, as its banner has it, and its title, under topics.
fn contents(sections: &[Section]) -> Vec<String> {
    let known = |name: &str| sections.iter().any(|s| s.module == name);
    TOPICS.iter().for_each(|(name, topic)| assert!(known(name), "{topic} begins with {name}, which is no section"));
    let mut lines = Vec::new();
    for section in sections {
        let topic = TOPICS.iter().find(|(name, _)| *name == section.module);
        lines.extend(topic.into_iter().flat_map(|(_, topic)| [String::new(), format!(" {topic}")]));
        lines.push(format!("   {:<17} {}", format!("[{}]", section.module), title(section)));
    }
    lines
}

/// A section's title: the first line of its article.
fn title(section: &Section) -> &str {
    section.article.first().expect("a section has an article").trim()
}

fn banner(section: &Section) -> String {
    let rule = "=".repeat(100);
    let mut lines = vec![rule.clone(), format!(" [{}] {}", section.module, title(section))];
    lines.extend(section.article.iter().skip(1).cloned());
    lines.push(rule);
    comment(&lines) + "\n"
}

/// Puts each constant after the type it belongs to, and a one-line comment on one line.
fn arrange(section: &Section, text: &str) -> String {
    let blocks: Vec<String> = text.split("\n\n").map(|b| compact(b.trim_matches('\n'))).collect();
    let defines = |block: &str, name: &str| block.lines().any(|l| l.starts_with(&format!("#define {name} ")));
    let of_enum = |e: &Enumeration, block: &str| e.constants.iter().any(|c| defines(block, c));
    let mut out = String::new();
    for block in blocks.iter().filter(|b| !section.enums.iter().any(|e| of_enum(e, b))) {
        out.push_str(block);
        out.push_str("\n\n");
        let declares = |name: &str| block.ends_with(&format!(" {name};"));
        if let Some(owner) = section.enums.iter().find(|e| declares(&e.name)) {
            for constant in &owner.constants {
                let found = blocks.iter().find(|b| defines(b, constant));
                let found = found.unwrap_or_else(|| panic!("cbindgen wrote no {constant}"));
                out.push_str(&plain_define(found));
                out.push('\n');
            }
            out.push('\n');
        }
        if let Some(owner) = section.structs.iter().find(|s| declares(&s.name) && !s.defaults.is_empty()) {
            out.push_str(&init_macro(owner));
            out.push('\n');
        }
    }
    out
}

/// Comments of one line on one line, and type names without the `struct` that their typedefs make needless.
fn compact(block: &str) -> String {
    let lines: Vec<&str> = block.lines().collect();
    let mut out: Vec<String> = Vec::new();
    let mut i = 0;
    while i < lines.len() {
        let short = lines[i].trim() == "/**" && lines.get(i + 2).is_some_and(|l| l.trim() == "*/");
        if short && lines[i + 1].len() < 114 {
            let indent = &lines[i][..lines[i].len() - lines[i].trim_start().len()];
            out.push(format!("{indent}/** {} */", lines[i + 1].trim().trim_start_matches('*').trim()));
            i += 3;
        } else {
            let typedef = lines[i].trim_start().starts_with("typedef struct");
            out.push(if typedef { lines[i].to_owned() } else { lines[i].replace("struct wk_", "wk_") });
            i += 1;
        }
    }
    out.join("\n")
}

/// A negative number in brackets, so that it stands in any expression; others unsigned as their types are.
fn plain_define(block: &str) -> String {
    let (rest, value) = block.rsplit_once(' ').expect("a define has a value");
    match value.parse::<i64>() {
        Ok(n) if n < 0 => format!("{rest} ({n})"),
        _ => block.to_owned(),
    }
}

/// `#define WK_X_INIT { .. }`: positional, so that C99 and every C++ take it.
fn init_macro(s: &Struct) -> String {
    let name = s.name.to_uppercase();
    let mut out = format!("\n/** Every field of `{}` at its default. */\n#define {name}_INIT {{ \\\n", s.name);
    let last = s.defaults.len() - 1;
    for (i, ((field, value), (_, ty))) in s.defaults.iter().zip(s.fields.iter().map(|f| (&f.name, &f.ty))).enumerate() {
        let comma = if i == last { "" } else { "," };
        let _ = writeln!(out, "    /* {field} */ {}{comma} \\", c_value(&s.name, ty, value));
    }
    out.push_str("}\n");
    out
}

/// A default as C writes it.
fn c_value(owner: &str, ty: &syn::Type, value: &syn::Expr) -> String {
    match value {
        syn::Expr::Lit(l) => c_literal(ty, &l.lit),
        syn::Expr::Unary(u) => format!("-{}", c_value(owner, ty, &u.expr)),
        syn::Expr::Path(p) => {
            let segments: Vec<String> = p.path.segments.iter().map(|s| s.ident.to_string()).collect();
            match segments.as_slice() {
                [one] if one == "None" => "NULL".into(),
                [one] => one.clone(),
                [inner, init] if init == "INIT" => format!("{}_INIT", inner.to_uppercase()),
                other => panic!("{owner}: default {other:?} has no C form"),
            }
        }
        syn::Expr::Call(c) => {
            let syn::Expr::Path(p) = &*c.func else { panic!("{owner}: a call that C cannot make") };
            match p.path.segments.last().map(|s| s.ident.to_string()).as_deref() {
                Some("null" | "null_mut") => "NULL".into(),
                Some("struct_size") => format!("(uint32_t)sizeof({})", sized(p).replace("Self", owner)),
                other => panic!("{owner}: default {other:?}() has no C form"),
            }
        }
        syn::Expr::Array(a) => {
            let syn::Type::Array(t) = ty else { panic!("{owner}: an array for a plain field") };
            let items: Vec<String> = a.elems.iter().map(|e| c_value(owner, &t.elem, e)).collect();
            format!("{{ {} }}", items.join(", "))
        }
        syn::Expr::Repeat(r) => {
            let syn::Type::Array(t) = ty else { panic!("{owner}: an array for a plain field") };
            let syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(n), .. }) = &*r.len else { panic!("{owner}: length") };
            let item = c_value(owner, &t.elem, &r.expr);
            format!("{{ {} }}", vec![item; n.base10_parse().expect("a length")].join(", "))
        }
        _ => panic!("{owner}: a default that has no C form"),
    }
}

/// The `T` of `struct_size::<T>()`.
fn sized(path: &syn::ExprPath) -> String {
    let last = path.path.segments.last().expect("a path has a segment");
    let syn::PathArguments::AngleBracketed(args) = &last.arguments else { panic!("struct_size names its type") };
    match args.args.first() {
        Some(syn::GenericArgument::Type(t)) => type_name(t),
        _ => panic!("struct_size names its type"),
    }
}

fn c_literal(ty: &syn::Type, lit: &syn::Lit) -> String {
    match lit {
        syn::Lit::Int(i) if type_name(ty) == "u64" => format!("UINT64_C({})", i.base10_digits()),
        syn::Lit::Int(i) => i.base10_digits().to_owned(),
        syn::Lit::Float(f) if type_name(ty) == "f32" => format!("{}f", f.base10_digits()),
        syn::Lit::Float(f) => f.base10_digits().to_owned(),
        _ => panic!("a default is a number"),
    }
}

/// At most one empty line in a row, no trailing blanks.
fn squeeze(text: &str) -> String {
    let mut out = String::new();
    let mut empty = 0;
    for line in text.lines().map(str::trim_end) {
        empty = if line.is_empty() { empty + 1 } else { 0 };
        if empty <= 1 {
            out.push_str(line);
            out.push('\n');
        }
    }
    out
}
