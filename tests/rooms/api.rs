//! The public Rust API: every item that a user of the crate can name, held against `tests/abi/rust.txt` as the header
//! is against its own lists. `WELKIN_BLESS=1` writes it anew.

use std::{collections::BTreeSet, fs};

use quote::ToTokens;

use crate::{
    code::{ModulePath, Sources, item_name},
    root,
};

/// Public API of a source tree, a line for each named item.
fn api(sources: &Sources) -> BTreeSet<String> {
    let mut reader = ApiReader { sources, lines: BTreeSet::new() };
    reader.take_module(&Vec::new(), &Vec::new());
    reader.lines
}

struct ApiReader<'a> {
    sources: &'a Sources,
    lines: BTreeSet<String>,
}

/// Text of tokens with spaces as a person writes them.
fn text(tokens: impl ToTokens) -> String {
    let mut text = tokens.to_token_stream().to_string();
    for (spaced, plain) in [
        (" :: ", "::"),
        (":: ", "::"),
        (" < ", "<"),
        (" > ", ">"),
        (" >", ">"),
        (" ,", ","),
        ("& ", "&"),
        ("( ", "("),
        (" )", ")"),
        (" (", "("),
        ("[ ", "["),
        (" ]", "]"),
        (" ;", ";"),
        (" :", ":"),
        ("' ", "'"),
        (",)", ")"),
        (">->", "> ->"),
        ("->(", "-> ("),
        ("fn(", "fn("),
    ] {
        text = text.replace(spaced, plain);
    }
    text
}

/// Signature without the names of its parameters, which callers do not say.
fn signature(signature: &syn::Signature) -> String {
    let mut nameless = signature.clone();
    for input in &mut nameless.inputs {
        match input {
            syn::FnArg::Typed(typed) => *typed.pat = syn::parse_quote!(_),
            syn::FnArg::Receiver(receiver) if receiver.reference.is_none() => receiver.mutability = None,
            syn::FnArg::Receiver(_) => {}
        }
    }
    text(nameless).replace("_: ", "")
}

fn is_public(visibility: &syn::Visibility) -> bool {
    matches!(visibility, syn::Visibility::Public(_))
}

/// Whether users of the crate do not see an item: it is hidden, or part of the tests or of the lab.
fn is_hidden(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let text = attribute.meta.to_token_stream().to_string();
        text == "doc (hidden)" || text == "cfg (test)" || text == "cfg (feature = \"lab\")"
    })
}

fn attributes_of(item: &syn::Item) -> &[syn::Attribute] {
    match item {
        syn::Item::Const(i) => &i.attrs,
        syn::Item::Enum(i) => &i.attrs,
        syn::Item::Fn(i) => &i.attrs,
        syn::Item::Mod(i) => &i.attrs,
        syn::Item::Static(i) => &i.attrs,
        syn::Item::Struct(i) => &i.attrs,
        syn::Item::Trait(i) => &i.attrs,
        syn::Item::Type(i) => &i.attrs,
        syn::Item::Union(i) => &i.attrs,
        syn::Item::Use(i) => &i.attrs,
        _ => &[],
    }
}

fn is_public_item(item: &syn::Item) -> bool {
    let visibility = match item {
        syn::Item::Const(i) => &i.vis,
        syn::Item::Enum(i) => &i.vis,
        syn::Item::Fn(i) => &i.vis,
        syn::Item::Mod(i) => &i.vis,
        syn::Item::Static(i) => &i.vis,
        syn::Item::Struct(i) => &i.vis,
        syn::Item::Trait(i) => &i.vis,
        syn::Item::Type(i) => &i.vis,
        syn::Item::Union(i) => &i.vis,
        syn::Item::Use(i) => &i.vis,
        _ => return false,
    };
    is_public(visibility) && !is_hidden(attributes_of(item))
}

impl ApiReader<'_> {
    /// Adds the items of the module `from` as items of the module `shown`, which re-exports them.
    fn take_module(&mut self, shown: &ModulePath, from: &ModulePath) {
        let Some(file) = self.sources.file(from) else { return };
        for item in file.tree.items.iter().filter(|item| is_public_item(item)) {
            match item {
                // The C API has lists of its own.
                syn::Item::Mod(inner) if inner.ident == "capi" => {}
                syn::Item::Mod(inner) => {
                    let child = |parent: &ModulePath| [parent.as_slice(), &[inner.ident.to_string()]].concat();
                    self.lines.insert(format!("{} mod", child(shown).join("::")));
                    self.take_module(&child(shown), &child(from));
                }
                syn::Item::Use(used) => self.take_use([shown, from], &[], &used.tree),
                item => self.take_item(shown, from, item, None),
            }
        }
    }

    /// Adds the items that a `pub use` line of a module adds to it.
    fn take_use(&mut self, modules: [&ModulePath; 2], before: &[String], tree: &syn::UseTree) {
        let [shown, module] = modules;
        let with = |name: &syn::Ident| [before, &[name.to_string()]].concat();
        match tree {
            syn::UseTree::Path(path) => self.take_use(modules, &with(&path.ident), &path.tree),
            syn::UseTree::Group(group) => group.items.iter().for_each(|item| self.take_use(modules, before, item)),
            syn::UseTree::Name(name) => self.take_used(modules, &with(&name.ident), None),
            syn::UseTree::Rename(name) => self.take_used(modules, &with(&name.ident), Some(name.rename.to_string())),
            syn::UseTree::Glob(_) => {
                let Some(from) = self.sources.defining(module, before).cloned() else { return };
                let file = self.sources.file(&from).expect("it was found");
                for item in file.tree.items.iter().filter(|item| is_public_item(item)) {
                    self.take_item(shown, &from, item, None);
                }
            }
        }
    }

    fn take_used(&mut self, [shown, module]: [&ModulePath; 2], path: &[String], alias: Option<String>) {
        let name = path.last().expect("a name");
        let public = [shown.as_slice(), &[alias.clone().unwrap_or_else(|| name.clone())]].concat();
        let Some(from) = self.sources.defining(module, path).cloned() else {
            self.lines.insert(format!("{} = {}", public.join("::"), path.join("::")));
            return;
        };
        let items = &self.sources.file(&from).expect("it was found").tree.items;
        match items.iter().find(|item| item_name(item).as_ref() == Some(name)) {
            Some(item) => self.take_item(shown, &from, item, alias),
            // The path leads to a module.
            None => {
                self.lines.insert(format!("{} mod", public.join("::")));
                self.take_module(&public, &from);
            }
        }
    }

    /// Adds an item that `from` defines and `module` shows.
    fn take_item(&mut self, module: &ModulePath, from: &ModulePath, item: &syn::Item, alias: Option<String>) {
        let Some(name) = item_name(item).filter(|_| !is_hidden(attributes_of(item))) else { return };
        let place = [module.as_slice(), &[alias.unwrap_or_else(|| name.clone())]].concat().join("::");
        let mut add = |line: String| _ = self.lines.insert(line);
        match item {
            syn::Item::Fn(i) => add(format!("{place} {}", signature(&i.sig))),
            syn::Item::Const(i) => add(format!("{place} const: {}", text(&i.ty))),
            syn::Item::Static(i) => add(format!("{place} static: {}", text(&i.ty))),
            syn::Item::Type(i) => add(format!("{place} type = {}", text(&i.ty))),
            syn::Item::Trait(i) => {
                add(format!("{place} trait"));
                i.items.iter().for_each(|inner| match inner {
                    syn::TraitItem::Fn(f) => add(format!("{place}::{} {}", f.sig.ident, signature(&f.sig))),
                    other => add(format!("{place} {}", text(other))),
                });
            }
            syn::Item::Struct(i) => {
                add(format!("{place} struct {}{}", text(&i.generics), derived(&i.attrs)));
                let fields = i.fields.iter().enumerate().filter(|(_, field)| is_public(&field.vis));
                fields.for_each(|(at, field)| {
                    let name = field.ident.as_ref().map_or(at.to_string(), |ident| ident.to_string());
                    add(format!("{place}.{name}: {}", text(&field.ty)));
                });
            }
            syn::Item::Enum(i) => {
                add(format!("{place} enum {}{}", text(&i.generics), derived(&i.attrs)));
                i.variants.iter().for_each(|variant| {
                    let fields: Vec<_> = variant.fields.iter().map(|field| text(&field.ty)).collect();
                    add(format!("{place}::{} variant ({})", variant.ident, fields.join(", ")));
                });
            }
            _ => return,
        }
        self.take_methods(&place, from, &name);
    }

    /// Adds the public methods and constants of a type, in whichever file they are written.
    fn take_methods(&mut self, place: &str, from: &ModulePath, name: &str) {
        for (module, file) in self.sources.iter() {
            let is_of_type = |i: &&syn::ItemImpl| {
                let syn::Type::Path(path) = &*i.self_ty else { return false };
                let names: Vec<_> = path.path.segments.iter().map(|s| s.ident.to_string()).collect();
                i.trait_.is_none()
                    && names.last().is_some_and(|last| last == name)
                    && self.sources.defining(module, &names) == Some(from)
            };
            let blocks = file.tree.items.iter().filter_map(|item| match item {
                syn::Item::Impl(i) => Some(i),
                _ => None,
            });
            for inner in blocks.filter(is_of_type).flat_map(|block| &block.items) {
                let line = match inner {
                    syn::ImplItem::Fn(f) if is_public(&f.vis) && !is_hidden(&f.attrs) => signature(&f.sig),
                    syn::ImplItem::Const(c) if is_public(&c.vis) && !is_hidden(&c.attrs) => {
                        format!("const {}: {}", c.ident, text(&c.ty))
                    }
                    _ => continue,
                };
                self.lines.insert(format!("{place}:: {line}"));
            }
        }
    }
}

/// Traits that a type derives.
fn derived(attributes: &[syn::Attribute]) -> String {
    let lists = attributes.iter().filter(|a| a.path().is_ident("derive")).filter_map(|a| a.meta.require_list().ok());
    let names: Vec<String> = lists.map(|list| text(&list.tokens)).collect();
    if names.is_empty() { String::new() } else { format!(" derives {}", names.join(", ")) }
}

#[test]
fn what_users_can_name_is_found() {
    let sources = Sources::of_texts(&[
        (
            &[],
            "pub mod a; mod b; pub use b::Shown as Known; #[doc(hidden)] pub mod c; #[cfg(feature = \"lab\")] pub mod d;",
        ),
        (
            &["a"],
            "pub use crate::b::*; pub fn f<T: Into<f64>>(of: &[T]) -> Option<(u8, T)> { None } pub(crate) fn g() {}",
        ),
        (
            &["b"],
            "#[derive(Clone, Copy)] pub struct Shown { pub x: f64, y: u8 } struct Own; impl Own { pub fn n() {} }",
        ),
        (&["c"], "pub fn h() {} use crate::b::Shown; impl Shown { pub fn m(&self) {} fn o() {} }"),
        (&["d"], "pub fn i() {}"),
    ]);
    let expected = [
        "Known struct  derives Clone, Copy",
        "Known.x: f64",
        "Known:: fn m(&self)",
        "a mod",
        "a::Shown struct  derives Clone, Copy",
        "a::Shown.x: f64",
        "a::Shown:: fn m(&self)",
        "a::f fn f<T: Into<f64>>(&[T]) -> Option<(u8, T)>",
    ];
    assert_eq!(api(&sources).into_iter().collect::<Vec<_>>(), expected);
}

#[test]
fn the_rust_api_is_the_committed_list() {
    let path = root().join("tests/abi/rust.txt");
    let found: String = api(&Sources::read()).into_iter().map(|line| line + "\n").collect();
    if std::env::var_os("WELKIN_BLESS").is_some() {
        fs::write(&path, &found).expect("a list that can be written");
    }
    let known = fs::read_to_string(&path).unwrap_or_default();
    let (known, found): (BTreeSet<&str>, BTreeSet<&str>) = (known.lines().collect(), found.lines().collect());
    let new: Vec<_> = found.difference(&known).collect();
    let gone: Vec<_> = known.difference(&found).collect();
    assert!(
        new.is_empty() && gone.is_empty(),
        "tests/abi/rust.txt (WELKIN_BLESS=1 writes it)\nnew: {new:#?}\ngone: {gone:#?}"
    );
}
