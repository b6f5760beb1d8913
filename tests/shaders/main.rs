//! Rules for all shaders, checked on naga's form of each: operations have defined results (operands.rs), loops end
//! (loops.rs), their code stays small where drivers copy functions into their callers (inlined.rs), and the code that
//! drivers get is valid (written.rs).

mod accepted;
mod arithmetic;
mod drawn;
mod inlined;
mod loops;
mod operands;
mod ranges;
mod value;
mod written;

use welkin::gpu::shader;

/// Names of all shaders with their variants.
fn all_shaders() -> Vec<String> {
    shader::names().flat_map(|name| shader::with_variants(name).expect("a shader")).collect()
}

/// Assembled text of a shader.
fn text(name: &str) -> String {
    shader::assemble(name).expect("a shader")
}
