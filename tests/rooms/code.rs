//! The files of `src/` as the compiler reads them: the paths that each uses, the names that it gives, and its
//! functions. Tests within a file and files of tests are left out.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::PathBuf,
};

use syn::visit::{self, Visit};

/// Place of a file in the tree of modules: `["clouds", "field"]`, empty for `lib.rs`.
pub type ModulePath = Vec<String>;

/// Parsed source file.
pub struct SourceFile {
    pub tree: syn::File,
    /// Paths that its code names, `use` lines included, if they may lead to another file.
    pub used: Vec<Vec<String>>,
    /// Names that `use` lines give to paths.
    named: BTreeMap<String, Vec<String>>,
    /// Paths of which a `use` line takes all names.
    globs: Vec<Vec<String>>,
    /// Names of the items that the file defines at its top.
    defined: BTreeSet<String>,
    /// Functions, except those of `extern` blocks and with a foreign ABI.
    pub functions: Vec<Function>,
}

/// Function with its parameters, except `self`.
pub struct Function {
    pub name: String,
    pub parameters: Vec<Parameter>,
}

/// Parameter of a function.
pub struct Parameter {
    /// Empty for a parameter that is a pattern.
    pub name: String,
    /// Number of parts of the widest tuple in its type, in the types of closures too; 0 without a tuple.
    pub tuple_parts: usize,
}

/// Source tree: each file by its module's path.
pub struct Sources(BTreeMap<ModulePath, SourceFile>);

impl Sources {
    /// Reads all files of `src/` except those of tests.
    pub fn read() -> Self {
        let files = crate::files("src", "rs").into_iter().map(|(_, path)| (module_path(&path), path));
        let files = files.filter(|(module, _)| !module.iter().any(|name| name == "tests"));
        Self(files.map(|(module, path)| (module, parsed(&crate::read(&path), &path))).collect())
    }

    pub fn of_texts(texts: &[(&[&str], &str)]) -> Self {
        let module = |names: &[&str]| names.iter().map(|name| name.to_string()).collect();
        Self(texts.iter().map(|(names, text)| (module(names), parsed(text, &PathBuf::from("a text")))).collect())
    }

    pub fn iter(&self) -> impl Iterator<Item = (&ModulePath, &SourceFile)> {
        self.0.iter()
    }

    /// Other files that define the items a file names; re-exports are followed to the definition.
    pub fn used_by(&self, module: &ModulePath) -> BTreeSet<&ModulePath> {
        let paths = &self.0[module].used;
        paths.iter().filter_map(|path| self.resolved(module, path, 0)).filter(|found| *found != module).collect()
    }

    /// Rooms that a file names after `crate::`, or by as many `super::` as lead to the crate's root.
    pub fn rooms_named_by(&self, module: &[String]) -> BTreeSet<String> {
        let room = |path: &Vec<String>| {
            let steps = path.iter().take_while(|name| *name == "super").count();
            let is_from_top = path.first().is_some_and(|name| name == "crate");
            let at_top = if is_from_top { Some(1) } else { (steps == module.len()).then_some(steps) };
            path.get(at_top?).cloned()
        };
        self.0[module].used.iter().filter_map(room).collect()
    }

    /// The file of a module.
    pub fn file(&self, module: &[String]) -> Option<&SourceFile> {
        self.0.get(module)
    }

    /// File that defines the item to which a path leads from a module; `None` for items of other crates.
    pub fn defining(&self, module: &[String], path: &[String]) -> Option<&ModulePath> {
        self.resolved(module, path, 0)
    }

    fn resolved(&self, module: &[String], path: &[String], depth: usize) -> Option<&ModulePath> {
        // A limit for names that lead round a circle of `use` lines.
        if depth > 16 {
            return None;
        }
        let mut place = module.to_vec();
        let mut rest = path;
        match path.first()?.as_str() {
            "crate" => (place, rest) = (Vec::new(), &path[1..]),
            "self" => rest = &path[1..],
            "super" => {}
            first => {
                let (key, file) = self.0.get_key_value(module)?;
                if file.defined.contains(first) {
                    return Some(key);
                }
                let child = [module, &[first.to_string()]].concat();
                if !self.0.contains_key(&child) {
                    let named = file.named.get(first).filter(|named| *named != path)?;
                    return self.resolved(module, &[named, &path[1..]].concat(), depth + 1);
                }
            }
        }
        while rest.first().is_some_and(|name| name == "super") {
            place.pop()?;
            rest = &rest[1..];
        }
        while let Some((name, after)) = rest.split_first() {
            let child = [place.as_slice(), std::slice::from_ref(name)].concat();
            if self.0.contains_key(&child) {
                (place, rest) = (child, after);
                continue;
            }
            let (key, file) = self.0.get_key_value(&place)?;
            if file.defined.contains(name) {
                return Some(key);
            }
            if let Some(named) = file.named.get(name) {
                return self.resolved(&place, &[named, after].concat(), depth + 1);
            }
            let through = |glob: &Vec<String>| self.resolved(&place, &[glob, rest].concat(), depth + 1);
            return file.globs.iter().find_map(through).or(Some(key));
        }
        self.0.get_key_value(&place).map(|(key, _)| key)
    }
}

fn module_path(path: &std::path::Path) -> ModulePath {
    let below = path.strip_prefix(crate::root().join("src")).expect("below src").with_extension("");
    let names = below.iter().map(|name| name.to_string_lossy().into_owned());
    names.filter(|name| name != "mod" && name != "lib").collect()
}

fn parsed(text: &str, path: &std::path::Path) -> SourceFile {
    let tree = syn::parse_file(text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut reader = Reader::default();
    reader.visit_file(&tree);
    let Reader { used, named, globs, functions, .. } = reader;
    let defined = tree.items.iter().filter_map(item_name).collect();
    SourceFile { tree, used, named, globs, defined, functions }
}

pub fn item_name(item: &syn::Item) -> Option<String> {
    let name = match item {
        syn::Item::Const(i) => &i.ident,
        syn::Item::Enum(i) => &i.ident,
        syn::Item::Fn(i) => &i.sig.ident,
        syn::Item::Macro(i) => i.ident.as_ref()?,
        syn::Item::Static(i) => &i.ident,
        syn::Item::Struct(i) => &i.ident,
        syn::Item::Trait(i) => &i.ident,
        syn::Item::Type(i) => &i.ident,
        syn::Item::Union(i) => &i.ident,
        _ => return None,
    };
    Some(name.to_string())
}

fn is_test(attributes: &[syn::Attribute]) -> bool {
    let is_test = |a: &syn::Attribute| a.parse_args::<syn::Ident>().is_ok_and(|ident| ident == "test");
    attributes.iter().any(|a| a.path().is_ident("cfg") && is_test(a))
}

/// Walk over a file's tree, and what it has found.
#[derive(Default)]
struct Reader {
    used: Vec<Vec<String>>,
    named: BTreeMap<String, Vec<String>>,
    globs: Vec<Vec<String>>,
    functions: Vec<Function>,
    /// Number of modules within the file that enclose the present item.
    depth: usize,
}

impl Reader {
    /// Keeps a path; a path from a module within the file is first changed to one from the file.
    fn keep(&mut self, mut path: Vec<String>) {
        let within = path.iter().take_while(|name| *name == "super").count().min(self.depth);
        path.drain(..within);
        if path.len() > 1 || within == 0 {
            self.used.push(path);
        }
    }

    fn take_use(&mut self, before: &[String], tree: &syn::UseTree) {
        let with = |name: &syn::Ident| [before, &[name.to_string()]].concat();
        // `use a::b::{self}` names b.
        let path = |name: &syn::Ident| if name == "self" { before.to_vec() } else { with(name) };
        match tree {
            syn::UseTree::Path(p) => self.take_use(&with(&p.ident), &p.tree),
            syn::UseTree::Group(g) => g.items.iter().for_each(|item| self.take_use(before, item)),
            syn::UseTree::Glob(_) => self.globs.push(before.to_vec()),
            syn::UseTree::Name(n) => self.take_name(path(&n.ident), None),
            syn::UseTree::Rename(r) => self.take_name(path(&r.ident), Some(r.rename.to_string())),
        }
    }

    fn take_name(&mut self, path: Vec<String>, alias: Option<String>) {
        let name = alias.or_else(|| path.last().cloned()).expect("a name");
        if self.depth == 0 {
            self.named.insert(name, path.clone());
        }
        self.keep(path);
    }
}

impl<'a> Visit<'a> for Reader {
    fn visit_item_mod(&mut self, item: &'a syn::ItemMod) {
        if !is_test(&item.attrs) {
            self.depth += 1;
            visit::visit_item_mod(self, item);
            self.depth -= 1;
        }
    }

    fn visit_item_fn(&mut self, item: &'a syn::ItemFn) {
        if !is_test(&item.attrs) {
            visit::visit_item_fn(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'a syn::ItemUse) {
        if !is_test(&item.attrs) {
            self.take_use(&[], &item.tree);
        }
    }

    /// Skips visibilities: their paths name no used item.
    fn visit_visibility(&mut self, _visibility: &'a syn::Visibility) {}

    fn visit_path(&mut self, path: &'a syn::Path) {
        let names: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
        if names.len() > 1 {
            self.keep(names);
        }
        visit::visit_path(self, path);
    }

    /// Keeps paths in the arguments of a macro, which syn leaves as unparsed tokens.
    fn visit_macro(&mut self, call: &'a syn::Macro) {
        // Text and documentation stand between quotes in these tokens.
        let code: String = call.tokens.to_string().split('"').step_by(2).collect();
        let text = code.replace(" :: ", "::");
        let words = text.split(|c: char| !c.is_alphanumeric() && c != '_' && c != ':');
        for word in words.filter(|word| word.starts_with("crate::") || word.starts_with("super::")) {
            self.keep(word.split("::").map(str::to_string).collect());
        }
    }

    fn visit_signature(&mut self, signature: &'a syn::Signature) {
        if signature.abi.is_none() {
            let typed = signature.inputs.iter().filter_map(|input| match input {
                syn::FnArg::Typed(typed) => Some(typed),
                syn::FnArg::Receiver(_) => None,
            });
            let parameters = typed.map(parameter).collect();
            self.functions.push(Function { name: signature.ident.to_string(), parameters });
        }
        visit::visit_signature(self, signature);
    }
}

fn parameter(typed: &syn::PatType) -> Parameter {
    struct Widest(usize);
    impl<'a> Visit<'a> for Widest {
        fn visit_type_tuple(&mut self, tuple: &'a syn::TypeTuple) {
            self.0 = self.0.max(tuple.elems.len());
            visit::visit_type_tuple(self, tuple);
        }
    }
    let mut widest = Widest(0);
    widest.visit_type(&typed.ty);
    let name = match &*typed.pat {
        syn::Pat::Ident(ident) => ident.ident.to_string(),
        _ => String::new(),
    };
    Parameter { name, tuple_parts: widest.0 }
}
