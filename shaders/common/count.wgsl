// Counts how often a pixel of a layer is drawn, in place of a layer's own fragment shaders: with no cover, what is
// blended adds up.

@fragment
fn count() -> @location(0) vec4f {
    return vec4f(1.0, 0.0, 0.0, 0.0);
}
