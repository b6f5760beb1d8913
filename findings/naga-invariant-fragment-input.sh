#!/usr/bin/env bash
# naga 30.0.1 (wgpu's shader translator): @invariant on a position that vertex and fragment shader share in one struct.
#
# Expected: WGSL allows @invariant on a position wherever it stands, so a struct that leaves the vertex shader and enters
#           the fragment shader may have it; in GLSL it matters for gl_Position alone, and nothing is written for the
#           fragment shader.
# Seen: naga accepts the module and writes `invariant gl_FragCoord;` into the fragment shader as GLSL ES 3.00, which
#       glslangValidator refuses. A struct of its own for the vertex shader's output avoids it.
# Needs cargo and glslangValidator (Debian's glslang-tools). Fails where that changes.
set -euo pipefail
dir="$(mktemp -d)"
trap 'rm -rf "$dir"' EXIT
mkdir -p "$dir/src"
cat > "$dir/Cargo.toml" <<'TOML'
[package]
name = "finding"
version = "0.0.0"
edition = "2021"

[dependencies]
naga = { version = "=30.0.1", features = ["wgsl-in", "glsl-out"] }
TOML
cat > "$dir/src/main.rs" <<'RS'
use naga::{back::glsl, front::wgsl, proc::BoundsCheckPolicies, valid, ShaderStage};

const SHADER: &str = "
struct Corner {
    @invariant @builtin(position) at: vec4f,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Corner {
    return Corner(vec4f(f32(index), 0.0, 0.0, 1.0));
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
    return corner.at;
}
";

fn main() {
    let module = wgsl::parse_str(SHADER).expect("WGSL");
    let info = valid::Validator::new(valid::ValidationFlags::all(), valid::Capabilities::all())
        .validate(&module)
        .expect("a valid module");
    let options = glsl::Options { version: glsl::Version::new_gles(300), ..Default::default() };
    let entry = glsl::PipelineOptions {
        shader_stage: ShaderStage::Fragment,
        entry_point: "fragment".into(),
        multiview: None,
    };
    let mut text = String::new();
    glsl::Writer::new(&mut text, &module, &info, &options, &entry, BoundsCheckPolicies::default())
        .expect("a writer")
        .write()
        .expect("GLSL");
    println!("{text}");
}
RS
cd "$dir"
cargo run --quiet >"$dir/shader.frag" 2>"$dir/log" || { cat "$dir/log" >&2; exit 1; }
cat "$dir/shader.frag"
written="$(grep -c 'invariant gl_FragCoord' "$dir/shader.frag" || true)"
refused=0
glslangValidator "$dir/shader.frag" || refused=1
echo "written: $written, refused: $refused"
if [ "$written" -ge 1 ] && [ "$refused" = 1 ]; then
    echo "naga-invariant-fragment-input: as seen"
else
    echo "naga-invariant-fragment-input: no longer so" >&2
    exit 1
fi
