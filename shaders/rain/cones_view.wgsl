// Entry points of rain on cones in front of a host's picture. Of several samples a pixel, only the first is read.
//!include "common/host.wgsl"
//!include "rain/cones.wgsl"

@group(0) @binding(1) var host_depth: HostDepth;

// Whether the host gives the depth of its picture.
override HAS_DEPTH: bool = true;

// Returns the premultiplied light of the rain on the cones in a pixel.
@fragment
fn cones_fragment(in: FullscreenVarying) -> @location(0) vec4f {
    let ndc = vec2f(in.uv.x * 2.0 - 1.0, (1.0 - in.uv.y * 2.0) * rain.y_sign);
    var range = RANGE_SKY;
    if HAS_DEPTH {
        range = view_range(rain.depth, textureLoad(host_depth, vec2i(in.position.xy), 0).r, ndc);
    }
    return rain_on_cones(view_ray(rain.depth, ndc).direction, in.uv, range);
}

// Counts how often a pixel is drawn, as common/count.wgsl does.
@fragment
fn cones_counted(in: FullscreenVarying) -> @location(0) vec4f {
    return vec4f(1.0, 0.0, 0.0, 0.0);
}
