//! Shader assembly: plain WGSL files, in which the line `//!include "common/x.wgsl"` includes another file, once in
//! each shader.
//!
//! Pipelines of one shader differ by their `override` constants or their entry point. A variant of a shader also has
//! other files in place of some: `rain/drops_view.wgsl:multi` includes `common/host_multi.wgsl` instead of
//! `common/host.wgsl`. Every other file that has a version for the word `multi` is replaced in the same way. A name may
//! have several such words. In this way a host's textures may have other types, and code that a pipeline does not need
//! is not compiled: a driver that finds dead code only after it has inlined everything takes several times as long.
//! There is no preprocessor. A test validates every assembled shader with naga ([`names`] lists them), and compares
//! every uniform's offsets with naga's ([`struct_layout`]).

use std::{cell::Cell, sync::Arc};

use crate::error::{Error, Result, Status};

mod table {
    include!(concat!(env!("OUT_DIR"), "/shader_table.rs"));
}

/// Names of all shader files below `shaders/`, such as `sky/lookup.wgsl`.
pub fn names() -> impl Iterator<Item = &'static str> {
    table::SHADERS.iter().map(|(name, _)| *name)
}

fn source(name: &str) -> Option<&'static str> {
    table::SHADERS.binary_search_by_key(&name, |(n, _)| n).ok().map(|i| table::SHADERS[i].1)
}

/// Words of variants, each with a file. A shader that contains this file has the variant.
const VARIANTS: [(&str, &str); 7] = [
    ("multi", "common/host.wgsl"),
    ("resolved", "common/host.wgsl"),
    ("clear", "frame/composite.wgsl"),
    ("plain", "fog/banks.wgsl"),
    ("dry", "frame/composite.wgsl"),
    ("box", "clouds/probe.wgsl"),
    ("lamps", "clouds/glow_view.wgsl"),
];

/// Returns the names of shader `name` and of its variants with one word of `VARIANTS`. For the composition, also
/// returns some of its other variants, as examples of the rest.
///
/// # Errors
/// The errors of [`assemble`].
pub fn with_variants(name: &str) -> Result<Vec<String>> {
    let text = assemble(name)?;
    let has = |file: &str| text.contains(&format!("// ---- {file}\n"));
    let words = VARIANTS.iter().filter(|(_, file)| has(file)).map(|(word, _)| format!(":{word}"));
    let several = ["", ":multi", ":resolved"].map(|host| format!("{host}:clear:dry"));
    let several = several.into_iter().chain([":plain:dry", ":even", ":dry:even"].map(String::from));
    let several = several.filter(|_| name == "frame/composite_view.wgsl");
    Ok(std::iter::once(String::new()).chain(words).chain(several).map(|words| format!("{name}{words}")).collect())
}

/// Returns the text of shader `name` after the text of its includes, each once, in order of first mention. Words after
/// colons select a variant.
///
/// # Errors
/// [`Status::Internal`] if a file is missing or includes form a cycle, with the chain of includes in the message; also
/// if no file of the shader has a version for one of the words.
pub fn assemble(name: &str) -> Result<String> {
    assemble_from(name, &|n| source(n).map(str::to_owned))
}

/// Assembles as [`assemble`] does, with `common/guarded_checked.wgsl` in place of `common/guarded.wgsl`, so that a NaN
/// stays a NaN.
///
/// # Errors
/// The errors of [`assemble`].
pub fn assemble_checked(name: &str) -> Result<String> {
    let checked = |n: &str| if n == "common/guarded.wgsl" { "common/guarded_checked.wgsl" } else { n }.to_owned();
    assemble_from(name, &|n| source(&checked(n)).map(str::to_owned))
}

/// Assembles as [`assemble`] does, from other files: `lookup` returns a file's text.
///
/// # Errors
/// The errors of [`assemble`].
pub fn assemble_from(name: &str, lookup: &dyn Fn(&str) -> Option<String>) -> Result<String> {
    let mut done = Vec::new();
    let mut out = String::new();
    let mut words = name.split(':');
    let name = words.next().unwrap_or_default();
    let words: Vec<_> = words.map(|word| (word, Cell::new(false))).collect();
    let other = |n: &str| {
        let of_word = |(word, used): &(&str, Cell<bool>)| {
            let found = lookup(&format!("{}_{word}.wgsl", n.strip_suffix(".wgsl")?))?;
            used.set(true);
            Some(found)
        };
        words.iter().find_map(of_word).or_else(|| lookup(n))
    };
    append(name, &other, &mut Vec::new(), &mut done, &mut out)?;
    match words.iter().find(|(_, used)| !used.get()) {
        Some((word, _)) => Err(Error::new(Status::Internal, format!("shader {name} has no variant {word}"))),
        None => Ok(out),
    }
}

fn append(
    name: &str,
    lookup: &dyn Fn(&str) -> Option<String>,
    chain: &mut Vec<String>,
    done: &mut Vec<String>,
    assembled: &mut String,
) -> Result<()> {
    if done.iter().any(|d| d == name) {
        return Ok(());
    }
    let path = || chain.iter().map(String::as_str).chain([name]).collect::<Vec<_>>().join(" -> ");
    if chain.iter().any(|c| c == name) {
        return Err(Error::new(Status::Internal, format!("shader include forms a cycle: {}", path())));
    }
    let Some(text) = lookup(name) else {
        return Err(Error::new(Status::Internal, format!("shader file is missing: {}", path())));
    };
    chain.push(name.to_owned());
    for line in text.lines() {
        if let Some(rest) = line.strip_prefix("//!include ") {
            append(rest.trim().trim_matches('"'), lookup, chain, done, assembled)?;
        }
    }
    chain.pop();
    assembled.push_str(&format!("// ---- {name}\n"));
    for line in text.lines().filter(|l| !l.starts_with("//!include ")) {
        assembled.push_str(line);
        assembled.push('\n');
    }
    done.push(name.to_owned());
    Ok(())
}

/// Returns the names of the `override` constants of an assembled shader.
pub(crate) fn overrides(text: &str) -> Arc<[String]> {
    let name = |line: &str| Some(line.strip_prefix("override ")?.split_once(':')?.0.to_owned());
    text.lines().filter_map(name).collect()
}

/// Returns the size in bytes and the (member, offset) list of a WGSL struct, as naga lays it out.
///
/// # Errors
/// [`Status::Internal`] if the text does not parse or has no such struct.
pub fn struct_layout(wgsl: &str, name: &str) -> Result<(u32, Vec<(String, u32)>)> {
    let module =
        wgpu::naga::front::wgsl::parse_str(wgsl).map_err(|e| Error::new(Status::Internal, e.emit_to_string(wgsl)))?;
    for (_, ty) in module.types.iter() {
        if let (Some(n), wgpu::naga::TypeInner::Struct { members, span }) = (&ty.name, &ty.inner)
            && n == name
        {
            let list = members.iter().map(|m| (m.name.clone().unwrap_or_default(), m.offset)).collect();
            return Ok((*span, list));
        }
    }
    Err(Error::new(Status::Internal, format!("no struct {name} in this shader")))
}

/// Parses and validates an assembled shader, as strictly as WebGPU demands.
///
/// # Errors
/// [`Status::Internal`] with naga's report, which marks the lines.
pub fn validate(wgsl: &str) -> Result<()> {
    use wgpu::naga::{front::wgsl, valid};
    let module = wgsl::parse_str(wgsl).map_err(|e| Error::new(Status::Internal, e.emit_to_string(wgsl)))?;
    valid::Validator::new(valid::ValidationFlags::all(), valid::Capabilities::MULTISAMPLED_SHADING)
        .validate(&module)
        .map(|_| ())
        .map_err(|e| Error::new(Status::Internal, e.emit_to_string(wgsl)))
}

/// Asserts that Rust struct `$type` and WGSL struct `$name` of shader `$shader` have the same size, and that each field
/// of `$type` in the list is at the offset of the WGSL member of the same name. `a.b` is field `b` of field `a`.
#[cfg(test)]
macro_rules! assert_layout {
    ($shader:expr, $name:expr, $type:ident, [$($($field:ident).+),* $(,)?]) => {
        let text = $crate::gpu::shader::assemble($shader).unwrap();
        let (size, members) = $crate::gpu::shader::struct_layout(&text, $name).unwrap();
        assert_eq!(size as usize, size_of::<$type>());
        for (path, at) in [$((stringify!($($field).+), std::mem::offset_of!($type, $($field).+))),*] {
            let field = path.rsplit('.').next().unwrap().trim();
            assert!(members.contains(&(field.into(), at as u32)), "{field} at {at}: {members:?}");
        }
    };
}

#[cfg(test)]
pub(crate) use assert_layout;

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    fn files<'a>(set: &'a [(&'a str, &'a str)]) -> impl Fn(&str) -> Option<String> + 'a {
        move |n| set.iter().find(|(k, _)| *k == n).map(|(_, v)| (*v).to_owned())
    }

    fn valid(name: &str) -> String {
        let text = assemble(name).unwrap();
        validate(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
        text
    }

    #[test]
    fn every_shader_assembles_and_validates() {
        let mut variants = 0;
        for name in names() {
            let text = valid(name);
            for other in &with_variants(name).unwrap()[1..] {
                assert!(valid(other) != text, "{other}");
                variants += 1;
            }
        }
        assert!(variants >= 19, "{variants}");
    }

    #[test]
    fn a_variant_reads_another_file_and_one_that_is_missing_is_named() {
        let set = [
            ("a", "//!include \"common/host.wgsl\"\nA"),
            ("common/host.wgsl", "one"),
            ("common/host_multi.wgsl", "many"),
        ];
        let lines = |name| {
            assemble_from(name, &files(&set)).map(|t| t.lines().filter(|l| !l.starts_with("//")).collect::<String>())
        };
        assert_eq!((lines("a").unwrap(), lines("a:multi").unwrap()), ("oneA".to_string(), "manyA".to_string()));
        assert!(lines("a:odd").unwrap_err().to_string().contains("no variant odd"));
    }

    /// Drivers copy a whole array to the stack of every pixel where a function indexes an array value by a variable.
    /// llvmpipe takes 0.3 s to compile that copy for one of Welkin's blocks. Arrays in blocks must be indexed through
    /// their binding.
    #[test]
    fn no_function_indexes_an_array_of_a_block_that_it_was_given() {
        use wgpu::naga::{Expression as E, Function, Handle, front::wgsl::parse_str};
        fn is_given(function: &Function, expression: Handle<E>) -> bool {
            match function.expressions[expression] {
                E::Access { base, .. } | E::AccessIndex { base, .. } => is_given(function, base),
                E::FunctionArgument(_) => true,
                _ => false,
            }
        }
        let faults = |text: &str| {
            let module = parse_str(text).unwrap();
            let indexes = |f: &Function| {
                f.expressions.iter().any(|(_, e)| match e {
                    E::Access { base, .. } => {
                        matches!(f.expressions[*base], E::AccessIndex { .. }) && is_given(f, *base)
                    }
                    _ => false,
                })
            };
            let named = module.functions.iter().filter(|(_, f)| indexes(f)).map(|(_, f)| f.name.clone());
            named.flatten().collect::<Vec<_>>()
        };
        for name in names() {
            assert_eq!(faults(&assemble(name).unwrap()), [""; 0], "{name}");
        }
        let given = "struct S { a: array<f32, 4> } fn f(s: S, i: u32) -> f32 { return s.a[i]; }";
        assert_eq!(faults(given), ["f"], "one is found");
    }

    /// WebGPU guarantees 16 textures per stage, and tier 0 devices have no more. The limit of 13 leaves three for later
    /// use.
    #[test]
    fn no_shader_reads_more_than_thirteen_textures() {
        use wgpu::naga::{ImageClass, TypeInner, front::wgsl::parse_str};
        let count = |name: &str| {
            let module = parse_str(&assemble(name).unwrap()).unwrap();
            let is_read = |inner: &TypeInner| match inner {
                TypeInner::Image { class, .. } => !matches!(class, ImageClass::Storage { .. }),
                _ => false,
            };
            module.global_variables.iter().filter(|(_, v)| is_read(&module.types[v.ty].inner)).count()
        };
        let all: Vec<String> = names().flat_map(|name| with_variants(name).unwrap()).collect();
        assert!(all.len() >= names().count() + 16, "variants are among them");
        let (most, name) = all.iter().map(|name| (count(name), name)).max().unwrap();
        assert!(most <= 13, "{name}: {most}");
        assert_eq!(count("frame/composite_view.wgsl:even"), most, "the count sees them");
    }

    type Type = wgpu::naga::Handle<wgpu::naga::Type>;

    /// Returns the locations of an entry point's arguments or result.
    fn locations<'a>(
        module: &'a wgpu::naga::Module,
        bound: impl Iterator<Item = (Option<&'a wgpu::naga::Binding>, Type)>,
    ) -> BTreeSet<u32> {
        use wgpu::naga::{Binding, TypeInner};
        let mut all = BTreeSet::new();
        for (binding, ty) in bound {
            let members = match &module.types[ty].inner {
                TypeInner::Struct { members, .. } => members.iter().map(|m| m.binding.as_ref()).collect(),
                _ => vec![binding],
            };
            all.extend(members.into_iter().flatten().filter_map(|b| match b {
                Binding::Location { location, .. } => Some(*location),
                Binding::BuiltIn(_) => None,
            }));
        }
        all
    }

    #[test]
    fn fragments_read_all_that_a_vertex_shader_of_their_file_writes() {
        use wgpu::naga::{ShaderStage, front::wgsl::parse_str};
        for name in names() {
            let module = parse_str(&assemble(name).unwrap()).unwrap();
            let of = |stage| module.entry_points.iter().filter(move |e| e.stage == stage);
            let results = of(ShaderStage::Vertex).filter_map(|e| e.function.result.as_ref());
            let written: Vec<_> =
                results.map(|r| locations(&module, [(r.binding.as_ref(), r.ty)].into_iter())).collect();
            for fragment in of(ShaderStage::Fragment).filter(|_| !written.is_empty()) {
                let arguments = fragment.function.arguments.iter();
                let read = locations(&module, arguments.map(|a| (a.binding.as_ref(), a.ty)));
                assert!(written.contains(&read), "{name}: {} reads {read:?} of {written:?}", fragment.name);
            }
        }
    }

    #[test]
    fn an_include_comes_first_and_once() {
        let set = [("a", "//!include \"b\"\n//!include \"c\"\nA"), ("b", "//!include \"c\"\nB"), ("c", "C")];
        let text = assemble_from("a", &files(&set)).unwrap();
        let order: Vec<&str> = text.lines().filter(|l| !l.starts_with("//")).collect();
        assert_eq!(order, ["C", "B", "A"]);
    }

    #[test]
    fn cycles_and_missing_files_are_named() {
        let set = [("a", "//!include \"b\""), ("b", "//!include \"a\"")];
        assert!(assemble_from("a", &files(&set)).unwrap_err().to_string().contains("a -> b -> a"));
        assert!(assemble_from("x", &files(&set)).unwrap_err().to_string().contains("missing: x"));
    }

    #[test]
    fn layout_and_validation_see_faults() {
        let text = "struct S { a: f32, b: vec3f, } @group(0) @binding(0) var<uniform> s: S;";
        assert_eq!(struct_layout(text, "S").unwrap(), (32, vec![("a".into(), 0), ("b".into(), 16)]));
        assert!(struct_layout(text, "T").is_err());
        assert!(validate("fn f() -> f32 { return 1u; }").is_err());
    }
}
