// Entry points of columns of rain in front of a host's picture. Of several samples a pixel, only the first is read.
//!include "common/host.wgsl"
//!include "rain/shaft.wgsl"

@group(0) @binding(1) var host_depth: HostDepth;

// Whether the host gives the depth of its picture.
override HAS_DEPTH: bool = true;

// Returns the premultiplied light of a column in a pixel.
@fragment
fn shaft_fragment(in: ShaftVarying) -> @location(0) vec4f {
    var range = RANGE_SKY;
    if HAS_DEPTH {
        range = view_range(frame.depth, textureLoad(host_depth, vec2i(in.position.xy), 0).r, in.ndc);
    }
    return shaft_veil(in.column, vec2i(in.position.xy), in.ndc, range);
}
