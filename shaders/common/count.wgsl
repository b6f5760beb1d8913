// Counts how often each pixel of a layer is drawn, in place of the layer's own fragment shaders. The output has alpha
// 0, so that blending adds up.

@fragment
fn count() -> @location(0) vec4f {
    return vec4f(1.0, 0.0, 0.0, 0.0);
}
