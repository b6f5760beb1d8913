// The host's picture, its depth and its mask.
//!include "common/host.wgsl"

@group(0) @binding(1) var host_color: HostColor;
@group(0) @binding(2) var host_depth: HostDepth;
@group(0) @binding(3) var host_mask: texture_2d<f32>;

override HAS_DEPTH: bool = true;
override HAS_MASK: bool = false;

// What the host's images say of a pixel, or of one sample of it.
struct Seen {
    pixel: vec2i,
    sample: i32,
    ndc: vec2f,
    // As the host wrote it, along the ray, and from the camera's plane; the latter two are RANGE_SKY where it drew
    // nothing.
    depth: f32,
    range: f32,
    plane: f32,
    // Share of the picture that is left as the host drew it.
    mask: f32,
}
