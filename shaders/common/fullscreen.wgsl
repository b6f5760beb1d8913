// One triangle that covers the target. `uv` is (0, 0) at the top left, as in WebGPU's textures.

// Depth of the triangle, for a depth test.
override FULLSCREEN_DEPTH: f32 = 0.0;

struct FullscreenVarying {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
}

// Output of the vertex shader. Several programs draw at equal depth, so their positions must agree to the bit
// (`invariant`). The fragment shaders have another struct: naga would mark their input as invariant too, which OpenGL
// ES rejects.
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
