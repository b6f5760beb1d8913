// Fog of the composition over a synthetic depth buffer: white target, black target, transmittance.
//!include "common/fullscreen.wgsl"
//!include "fog/lookup.wgsl"

// Camera of the synthetic picture.
@group(0) @binding(0) var<uniform> probe_depth: DepthUniform;
// Depth of the targets.
@group(0) @binding(1) var depth_texture: texture_2d<f32>;

// Returns the white target behind fog, the black target behind it, and the transmittance, at 550 nm.
@fragment
fn fog_probe(in: FullscreenVarying) -> @location(0) vec4f {
    let ndc = vec2f(2.0 * in.uv.x - 1.0, 1.0 - 2.0 * in.uv.y);
    let depth = textureLoad(depth_texture, vec2i(in.position.xy), 0).r;
    let ray = view_ray(probe_depth, ndc);
    let range = view_range(probe_depth, depth, ndc);
    let seen = fog_along(low_air.fog, ray.origin, ray.direction, range, view_plane(probe_depth, depth, ndc));
    let white = fog_apply(seen, vec3f(1.0));
    let black = fog_apply(seen, vec3f(0.0));
    return vec4f(white.g, black.g, seen.transmittance.g, 1.0);
}
