//! What all shaders keep to, read from naga's form of each of them: operations have answers (operands.rs), loops end
//! (loops.rs), and what drivers are handed is valid (written.rs).

mod accepted;
mod arithmetic;
mod drawn;
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

/// The text of one, assembled.
fn text(name: &str) -> String {
    shader::assemble(name).expect("a shader")
}
