// Fills the whole shadow map from a coarse map. The rows of the shadow map are drawn over it in this and later frames.
//!include "common/fullscreen.wgsl"

// Coarse map.
@group(0) @binding(2) var coarse: texture_2d<f32>;
// Sampler that interpolates linearly and repeats the map.
@group(0) @binding(5) var repeating: sampler;

// Side of the shadow map, texels.
override SHADOW_TEXELS: f32 = 512.0;

// Fills one texel of the shadow map from the coarse map.
@fragment
fn spread(in: FullscreenVarying) -> @location(0) vec4f {
    return textureSampleLevel(coarse, repeating, in.position.xy / SHADOW_TEXELS, 0.0);
}
