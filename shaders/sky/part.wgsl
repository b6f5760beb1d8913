//!include "common/fullscreen.wgsl"
//!include "sky/air.wgsl"
// Adds the light of one triple of wavelengths to a blending target, converted to the three values that tables keep.

@group(0) @binding(0) var triple: texture_2d<f32>;
@group(0) @binding(1) var<uniform> air: SkyAir;

@fragment
fn part(in: FullscreenVarying) -> @location(0) vec4f {
    return vec4f(air_part(air, textureLoad(triple, vec2i(in.position.xy), 0).rgb), 1.0);
}
