//! Size of each shader as drivers compile it: they copy the code of a function to each of its calls. A function with
//! three calls of one that has three calls itself holds nine copies. Large shaders take seconds to compile, in the
//! middle of a run.

use std::collections::HashMap;

use wgpu::naga::{Block, Function, Handle, Module, Statement, front::wgsl};

use super::{all_shaders, text};

/// Greatest number of expressions of an entry point with the code of all that it calls. The picture with fog banks had
/// 193,000 and the diagnostics 534,000 while each Gauss point in a bank's perimeter was a call: a software driver
/// compiled each of six pipelines for twelve seconds.
const MOST_EXPRESSIONS: usize = 120_000;

type Sizes = HashMap<Handle<Function>, usize>;

/// Number of a function's expressions with those of what it calls, as often as it is called.
fn inlined(function: &Function, sizes: &Sizes) -> usize {
    fn calls(block: &Block, sizes: &Sizes) -> usize {
        let of = |statement: &Statement| match statement {
            Statement::Call { function, .. } => sizes[function],
            Statement::Block(block) => calls(block, sizes),
            Statement::If { accept, reject, .. } => calls(accept, sizes) + calls(reject, sizes),
            Statement::Loop { body, continuing, .. } => calls(body, sizes) + calls(continuing, sizes),
            Statement::Switch { cases, .. } => cases.iter().map(|case| calls(&case.body, sizes)).sum(),
            _ => 0,
        };
        block.iter().map(of).sum()
    }
    function.expressions.len() + calls(&function.body, sizes)
}

/// Largest entry point of a shader.
fn largest(module: &Module) -> usize {
    let mut sizes = Sizes::new();
    // Callees stand before their callers.
    for (handle, function) in module.functions.iter() {
        let size = inlined(function, &sizes);
        sizes.insert(handle, size);
    }
    module.entry_points.iter().map(|entry| inlined(&entry.function, &sizes)).max().unwrap_or(0)
}

#[test]
fn no_shader_grows_by_calls_within_calls() {
    let size = |name: String| (largest(&wgsl::parse_str(&text(&name)).expect("valid WGSL")), name);
    let mut found: Vec<(usize, String)> = all_shaders().into_iter().map(size).collect();
    found.sort();
    found.iter().rev().take(40).for_each(|(size, name)| println!("{size:>7} {name}"));
    let (most, name) = found.last().expect("shaders");
    assert!(*most <= MOST_EXPRESSIONS, "{name}: {most} expressions with the code of what it calls");
}
