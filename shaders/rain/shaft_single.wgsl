// Columns of rain before a host's picture with one sample a pixel.
//!include "rain/shaft.wgsl"

@group(0) @binding(1) var host_depth: texture_2d<f32>;

override HAS_DEPTH: bool = true;

@fragment
fn shaft_fragment(in: ShaftVarying) -> @location(0) vec4f {
    var range = RANGE_SKY;
    if HAS_DEPTH {
        range = view_range(frame.depth, textureLoad(host_depth, vec2i(in.position.xy), 0).r, in.ndc);
    }
    return shaft_veil(in.column, in.ndc, range);
}
