//! Reads the sections of `src/capi` into a model of the C interface: sections in header order, structs with typed
//! fields, enumerations with their constants, functions. From it come the header (`header.rs`) and the table that the
//! boundary uses at run time to check every struct and number by name.

use std::{
    collections::BTreeMap,
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};

/// One struct of the interface.
pub struct Struct {
    pub name: String,
    pub fields: Vec<Field>,
    /// The fields of its `const INIT`, if it has one.
    pub defaults: Vec<(String, syn::Expr)>,
}

/// One field of a struct.
pub struct Field {
    pub name: String,
    pub ty: syn::Type,
    /// What follows `Range` in its documentation, such as `[0, 1]`; empty if that says none.
    pub range: String,
}

/// An integer type with named constants.
pub struct Enumeration {
    pub name: String,
    pub constants: Vec<String>,
}

/// One public module of `src/capi`: one section of the header.
pub struct Section {
    pub module: String,
    /// Its files, in the order of their items in the header.
    pub sources: Vec<PathBuf>,
    pub article: Vec<String>,
    pub structs: Vec<Struct>,
    pub enums: Vec<Enumeration>,
    pub functions: Vec<String>,
}

/// The whole interface.
pub struct Model {
    pub sections: Vec<Section>,
    pub aliases: BTreeMap<String, syn::Type>,
}

/// Reads the sections that `src/capi/mod.rs` declares `pub mod`, in that order.
pub fn read(dir: &Path) -> Model {
    let root = parse(&dir.join("mod.rs"));
    let mut model = Model { sections: Vec::new(), aliases: BTreeMap::new() };
    for item in &root.items {
        let syn::Item::Mod(m) = item else { continue };
        // `#[doc(hidden)]` modules are public for the tests only.
        if matches!(m.vis, syn::Visibility::Public(_)) && m.attrs.is_empty() {
            let section = section(m.ident.to_string(), dir, &mut model.aliases);
            model.sections.push(section);
        }
    }
    model
}

fn parse(path: &Path) -> syn::File {
    println!("cargo:rerun-if-changed={}", path.display());
    let text = fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    syn::parse_file(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The lines of the doc comments among `attrs`.
fn doc_lines(attrs: &[syn::Attribute]) -> Vec<String> {
    let mut lines = Vec::new();
    for attr in attrs {
        if let syn::Meta::NameValue(nv) = &attr.meta
            && nv.path.is_ident("doc")
            && let syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(s), .. }) = &nv.value
        {
            lines.extend(s.value().lines().map(str::to_owned));
            if s.value().is_empty() {
                lines.push(String::new());
            }
        }
    }
    lines
}

/// A section: the files whose items its own file takes over whole, and that file, which has the article.
fn section(module: String, dir: &Path, aliases: &mut BTreeMap<String, syn::Type>) -> Section {
    let own = dir.join(format!("{module}.rs"));
    let file = parse(&own);
    let article = doc_lines(&file.attrs);
    let mut sources: Vec<PathBuf> = file.items.iter().filter_map(|item| taken_over(item, dir)).collect();
    let others: Vec<syn::File> = sources.iter().map(|path| parse(path)).collect();
    sources.push(own);
    let mut section = Section { module, sources, article, structs: vec![], enums: vec![], functions: vec![] };
    for item in others.iter().chain([&file]).flat_map(|f| &f.items) {
        match item {
            syn::Item::Struct(s) => section.structs.extend(structure(s)),
            syn::Item::Type(t) => {
                let name = t.ident.to_string();
                aliases.insert(name.clone(), (*t.ty).clone());
                section.enums.push(Enumeration { name, constants: vec![] });
            }
            syn::Item::Const(c) => constant(c, &mut section.enums),
            syn::Item::Fn(f) if f.sig.abi.is_some() && matches!(f.vis, syn::Visibility::Public(_)) => {
                section.functions.push(f.sig.ident.to_string());
            }
            syn::Item::Impl(i) => defaults(i, &mut section.structs),
            _ => {}
        }
    }
    section.enums.retain(|e| !e.constants.is_empty());
    section
}

/// The file `dir/a/b.rs` of an item `pub use super::a::b::*`.
fn taken_over(item: &syn::Item, dir: &Path) -> Option<PathBuf> {
    let syn::Item::Use(syn::ItemUse { vis: syn::Visibility::Public(_), tree, .. }) = item else { return None };
    let syn::UseTree::Path(first) = tree else { return None };
    if first.ident != "super" {
        return None;
    }
    let (mut path, mut rest) = (dir.to_owned(), &*first.tree);
    while let syn::UseTree::Path(part) = rest {
        path.push(part.ident.to_string());
        rest = &part.tree;
    }
    matches!(rest, syn::UseTree::Glob(_)).then(|| path.with_extension("rs"))
}

/// A `#[repr(C)]` struct; handles are opaque and have no fields to list.
fn structure(s: &syn::ItemStruct) -> Option<Struct> {
    s.attrs.iter().find(|a| a.path().is_ident("repr"))?;
    let field = |f: &syn::Field| Field {
        name: f.ident.as_ref().expect("named field").to_string(),
        ty: f.ty.clone(),
        range: range(&doc_lines(&f.attrs)),
    };
    Some(Struct { name: s.ident.to_string(), fields: s.fields.iter().map(field).collect(), defaults: vec![] })
}

/// The interval behind the word `Range` of a field's documentation.
fn range(doc: &[String]) -> String {
    let doc: Vec<_> = doc.iter().map(|line| line.trim()).collect();
    let doc = doc.join(" ");
    let interval = doc.split_once("Range ").map_or("", |d| d.1);
    if !interval.starts_with(['[', '(']) {
        return String::new();
    }
    interval.find([']', ')']).map_or(String::new(), |end| interval[..=end].to_owned())
}

fn constant(c: &syn::ItemConst, enums: &mut [Enumeration]) {
    let ty = type_name(&c.ty);
    if let Some(e) = enums.iter_mut().find(|e| e.name == ty) {
        e.constants.push(c.ident.to_string());
    }
}

/// Takes the fields of `const INIT: Self = Self { .. }`.
fn defaults(item: &syn::ItemImpl, structs: &mut [Struct]) {
    let name = type_name(&item.self_ty);
    let Some(target) = structs.iter_mut().find(|s| s.name == name) else { return };
    for part in &item.items {
        if let syn::ImplItem::Const(c) = part
            && c.ident == "INIT"
            && let syn::Expr::Struct(literal) = &c.expr
        {
            for field in &literal.fields {
                let syn::Member::Named(ident) = &field.member else { panic!("{name}: named fields only") };
                target.defaults.push((ident.to_string(), field.expr.clone()));
            }
        }
    }
    if !target.defaults.is_empty() {
        let order = |list: Vec<&String>| list.into_iter().cloned().collect::<Vec<_>>();
        let declared = order(target.fields.iter().map(|f| &f.name).collect());
        let given = order(target.defaults.iter().map(|f| &f.0).collect());
        assert!(declared == given, "{name}::INIT must name every field in order: {declared:?} against {given:?}");
    }
}

/// The last path segment of a plain type.
pub fn type_name(ty: &syn::Type) -> String {
    match ty {
        syn::Type::Path(p) => p.path.segments.last().expect("a path has a segment").ident.to_string(),
        _ => String::new(),
    }
}

/// A field's kind as the run-time table writes it, and how many elements it has.
fn kind(model: &Model, ty: &syn::Type) -> (String, usize) {
    match ty {
        syn::Type::Array(a) => {
            let syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(n), .. }) = &a.len else {
                panic!("array lengths in the C interface are plain numbers")
            };
            let (kind, inner) = kind(model, &a.elem);
            (kind, inner * n.base10_parse::<usize>().expect("a length"))
        }
        syn::Type::Ptr(_) => ("FieldKind::Pointer".into(), 1),
        _ => (plain_kind(model, &type_name(ty)), 1),
    }
}

fn plain_kind(model: &Model, name: &str) -> String {
    let simple = match name {
        "u8" | "c_char" => "U8",
        "u16" => "U16",
        "u32" => "U32",
        "i32" => "I32",
        "u64" | "usize" => "U64",
        "i64" => "I64",
        "f32" => "F32",
        "f64" => "F64",
        "Option" => "Pointer",
        _ => "",
    };
    if !simple.is_empty() {
        return format!("FieldKind::{simple}");
    }
    let is = |list: &[String]| list.iter().any(|n| n == name);
    let enums: Vec<String> = model.sections.iter().flat_map(|s| &s.enums).map(|e| e.name.clone()).collect();
    let structs: Vec<String> = model.sections.iter().flat_map(|s| &s.structs).map(|s| s.name.clone()).collect();
    if is(&enums) {
        return format!("FieldKind::Enum(&{})", name.to_uppercase());
    }
    if is(&structs) {
        return format!("FieldKind::Struct(&{})", name.to_uppercase());
    }
    let target = model.aliases.get(name).unwrap_or_else(|| panic!("no type {name} in the C interface"));
    kind(model, target).0
}

/// Writes the Rust table: `StructInfo` and `EnumInfo` statics, `Layout` impls and the `wk_*_init` functions.
pub fn write_table(model: &Model) -> String {
    let mut out = String::from("// Written by build.rs from src/capi; do not edit.\n");
    for section in &model.sections {
        let module = &section.module;
        for e in &section.enums {
            let flags = e.name.ends_with("_flags");
            let wide = model.aliases.get(&e.name).is_some_and(|t| type_name(t) == "u64");
            let values: String =
                e.constants.iter().map(|c| format!("(\"{c}\", crate::capi::{module}::{c} as u64), ")).collect();
            let upper = e.name.to_uppercase();
            let _ = writeln!(
                out,
                "pub(crate) static {upper}: EnumInfo = EnumInfo {{ name: \"{}\", flags: {flags}, wide: {wide}, values: &[{values}] }};",
                e.name
            );
        }
        for s in &section.structs {
            let path = format!("crate::capi::{module}::{}", s.name);
            let upper = s.name.to_uppercase();
            let _ = writeln!(
                out,
                "pub(crate) static {upper}: StructInfo = StructInfo {{ name: \"{}\", size: size_of::<{path}>(), align: align_of::<{path}>(), has_init: {}, fields: &[",
                s.name,
                !s.defaults.is_empty()
            );
            for Field { name: field, ty, range } in &s.fields {
                let (kind, count) = kind(model, ty);
                let _ = writeln!(
                    out,
                    "    LayoutField {{ name: \"{field}\", offset: std::mem::offset_of!({path}, {field}), kind: {kind}, count: {count}, range: \"{range}\" }},"
                );
            }
            out.push_str("] };\n");
            if !s.defaults.is_empty() {
                let _ = writeln!(
                    out,
                    "unsafe impl Layout for {path} {{ const INFO: &'static StructInfo = &{upper}; const DEFAULT: Self = Self::INIT; }}"
                );
            }
        }
    }
    out.push_str(&write_inits_by_name(model));
    let list = |f: &dyn Fn(&Section) -> Vec<String>| model.sections.iter().flat_map(f).collect::<Vec<_>>().join(", ");
    let structs = list(&|s| s.structs.iter().map(|x| format!("&{}", x.name.to_uppercase())).collect());
    let functions = list(&|s| s.all_functions().iter().map(|f| format!("\"{f}\"")).collect());
    let _ = writeln!(out, "pub(crate) static STRUCTS: &[&StructInfo] = &[{structs}];");
    let _ = writeln!(out, "pub(crate) static FUNCTIONS: &[&str] = &[{functions}];");
    out
}

/// Calls any `wk_x_init` by its struct's name, for the tests.
fn write_inits_by_name(model: &Model) -> String {
    let mut out = String::from(
        "/// # Safety\n/// `p` points to `size` writable bytes.\n\
         pub(crate) unsafe fn init_by_name(name: &str, p: *mut c_void, size: u32) -> wk_status {\n    match name {\n",
    );
    for section in &model.sections {
        for s in section.structs.iter().filter(|s| s.is_tagged()) {
            let (module, name) = (&section.module, &s.name);
            let _ =
                writeln!(out, "        \"{name}\" => unsafe {{ crate::capi::{module}::{name}_init(p.cast(), size) }},");
        }
    }
    out.push_str("        _ => WK_ERROR_UNSUPPORTED,\n    }\n}\n");
    out
}

/// The `wk_x_init` functions of a section, as Rust: compiled into the library, and read by cbindgen for the header.
pub fn write_inits(section: &Section) -> String {
    let mut out = String::new();
    for s in section.structs.iter().filter(|s| s.is_tagged()) {
        let (name, upper) = (&s.name, s.name.to_uppercase());
        let _ = write!(
            out,
            "/// Writes the default of every field: the same bytes as `{upper}_INIT`. `struct_size` is `sizeof({name})`\n\
             /// as the caller was compiled, and is stored in the struct.\n\
             #[unsafe(no_mangle)]\n\
             pub unsafe extern \"C\" fn {name}_init(out: *mut {name}, struct_size: u32) -> wk_status {{\n    \
             // SAFETY: the caller owns `struct_size` bytes at `out`, as the header says.\n    \
             unsafe {{ init_struct::<{name}>(\"{name}_init\", out, struct_size) }}\n}}\n"
        );
    }
    out
}

impl Struct {
    /// Whether it begins with `struct_size`, `struct_type`, `next`.
    pub fn is_tagged(&self) -> bool {
        self.fields.first().is_some_and(|f| f.name == "struct_size")
    }
}

impl Section {
    /// Functions written by hand and generated.
    pub fn all_functions(&self) -> Vec<String> {
        let inits = self.structs.iter().filter(|s| s.is_tagged()).map(|s| format!("{}_init", s.name));
        self.functions.iter().cloned().chain(inits).collect()
    }
}
