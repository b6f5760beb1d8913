// One triangle that covers the target. `uv` has (0, 0) at the top left, as WebGPU's textures do.

// Depth of the triangle, where there is a depth test.
override FULLSCREEN_DEPTH: f32 = 0.0;

struct FullscreenVarying {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
}

// As the vertex shader writes it: several programs draw where depth is equal, so theirs must be the same to the bit. A
// struct of its own, since naga would write `invariant` before a fragment shader's input too, which OpenGL ES refuses.
struct FullscreenVertex {
    @invariant @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn fullscreen_vertex(@builtin(vertex_index) index: u32) -> FullscreenVertex {
    let uv = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    var out: FullscreenVertex;
    out.uv = uv;
    out.position = vec4f(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, FULLSCREEN_DEPTH, 1.0);
    return out;
}
