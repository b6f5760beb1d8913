//!include "common/fullscreen.wgsl"
//!include "common/guarded.wgsl"
//!include "sky/disc.wgsl"
// Plain perspective picture with a field of view of 90 degrees: the sky in its upper half, and in its lower half a dark
// surface 3 km away behind the air. Benchmarks time it.

struct PictureCamera {
    forward: vec3f,
    aspect: f32,
}

@group(0) @binding(0) var<uniform> camera: PictureCamera;

@fragment
fn picture(in: FullscreenVarying) -> @location(0) vec4f {
    let right = unit_or(cross(camera.forward, vec3f(0.0, 0.0, 1.0)), vec3f(1.0, 0.0, 0.0));
    let up = cross(right, camera.forward);
    let ndc = vec2f(in.uv.x * 2.0 - 1.0, (1.0 - in.uv.y * 2.0) * camera.aspect);
    let dir = normalize(camera.forward + ndc.x * right + ndc.y * up);
    let near = aerial(dir, 3000.0);
    return vec4f(select(near.radiance + near.transmittance * 0.05, sky_radiance(dir), in.uv.y < 0.5), 1.0);
}
