//!include "common/fullscreen.wgsl"
// Copies a table texel by texel; with a blending target, fades one into another.

@group(0) @binding(0) var copied: texture_2d<f32>;

@fragment
fn copy(in: FullscreenVarying) -> @location(0) vec4f {
    return textureLoad(copied, vec2u(in.position.xy), 0);
}
