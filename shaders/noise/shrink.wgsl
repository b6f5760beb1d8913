// Computes a mip level from the next finer one: the mean of 2 x 2 or 2 x 2 x 2 texels in whole bytes, halves rounded
// up. The result equals the CPU's (src/noise/image.rs) to the bit.
//!include "common/fullscreen.wgsl"

struct Shrink {
    // Size of the finer level, texels.
    above: vec3u,
    // Slice of the level that is being drawn.
    z: u32,
}

@group(0) @binding(0) var<uniform> shrink: Shrink;
@group(0) @binding(1) var plane: texture_2d<f32>;
@group(0) @binding(2) var volume: texture_3d<f32>;

fn bytes_of(texel: vec4f) -> vec4u {
    return vec4u(texel * 255.0 + 0.5);
}

@fragment
fn shrink_plane(in: FullscreenVarying) -> @location(0) vec4f {
    let first = 2u * vec2u(in.position.xy);
    let last = min(first + 1u, shrink.above.xy - 1u);
    let sum = bytes_of(textureLoad(plane, vec2i(first), 0)) + bytes_of(textureLoad(plane, vec2i(vec2u(last.x, first.y)), 0))
        + bytes_of(textureLoad(plane, vec2i(vec2u(first.x, last.y)), 0)) + bytes_of(textureLoad(plane, vec2i(last), 0));
    return vec4f((sum + 2u) >> vec4u(2u)) / 255.0;
}

fn sum_of_slice(first: vec2u, last: vec2u, z: u32) -> vec4u {
    return bytes_of(textureLoad(volume, vec3i(vec3u(first, z)), 0)) + bytes_of(textureLoad(volume, vec3i(vec3u(last.x, first.y, z)), 0))
        + bytes_of(textureLoad(volume, vec3i(vec3u(first.x, last.y, z)), 0)) + bytes_of(textureLoad(volume, vec3i(vec3u(last, z)), 0));
}

@fragment
fn shrink_volume(in: FullscreenVarying) -> @location(0) vec4f {
    let first = 2u * vec3u(vec2u(in.position.xy), shrink.z);
    let last = min(first + 1u, shrink.above - 1u);
    let sum = sum_of_slice(first.xy, last.xy, first.z) + sum_of_slice(first.xy, last.xy, last.z);
    return vec4f((sum + 4u) >> vec4u(3u)) / 255.0;
}
