// Finds the depth nearest to the light in each block of a shadow map, and writes it as the depth of a smaller map.
//!include "common/fullscreen.wgsl"
//!include "land/shadow_block.wgsl"

// Layer of the map.
@group(0) @binding(0) var<uniform> map_layer: vec4u;
@group(0) @binding(1) var map_depths: texture_2d_array<f32>;

@fragment
fn shadow_top(in: FullscreenVarying) -> @builtin(frag_depth) f32 {
    let first = vec2i(in.position.xy) * SHADOW_BLOCK;
    var top = 0.0;
    for (var j = 0; j < SHADOW_BLOCK; j++) {
        for (var i = 0; i < SHADOW_BLOCK; i++) {
            top = max(top, textureLoad(map_depths, first + vec2i(i, j), map_layer.x, 0).r);
        }
    }
    return top;
}
