// Entry points of flakes in front of a host's picture. Of several samples a pixel, only the first is read.
//!include "common/host.wgsl"
//!include "snow/flakes.wgsl"

@group(0) @binding(1) var host_depth: HostDepth;

// Whether the host gives the depth of its picture.
override HAS_DEPTH: bool = true;

// Returns the depth of the host's picture at a pixel, in the measure of view_depth.
fn shown_at(position: vec4f) -> f32 {
    if HAS_DEPTH {
        let uv = position.xy / vec2f(textureDimensions(host_depth));
        let depth = textureLoad(host_depth, vec2i(position.xy), 0).r;
        return view_depth(flakes.depth, depth, vec2f(uv.x * 2.0 - 1.0, (1.0 - uv.y * 2.0) * flakes.y_sign));
    }
    return RANGE_SKY;
}

// Returns the premultiplied light of a pixel of a flake.
@fragment
fn flake_fragment(in: FlakeVarying) -> @location(0) vec4f {
    return flake_color(in, shown_at(in.position));
}
