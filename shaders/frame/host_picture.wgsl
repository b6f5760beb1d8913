// Host's picture with its depth and mask.
//!include "common/host.wgsl"

@group(0) @binding(1) var host_color: HostColor;
@group(0) @binding(2) var host_depth: HostDepth;
@group(0) @binding(3) var host_mask: texture_2d<f32>;

// Whether the host gives depth, and whether it gives a mask.
override HAS_DEPTH: bool = true;
override HAS_MASK: bool = false;

// Values of the host's images at a pixel, or at one sample of it.
struct Seen {
    pixel: vec2i,
    sample: i32,
    ndc: vec2f,
    // Depth as the host wrote it, distance along the ray, and distance from the camera's plane. The two distances are
    // RANGE_SKY where the host drew nothing.
    depth: f32,
    range: f32,
    plane: f32,
    // Share of the pixel that stays as the host drew it.
    mask: f32,
}
