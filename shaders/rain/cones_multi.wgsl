// Rain on cones before a host's picture with several samples a pixel: its first stands for them.
//!include "rain/cones.wgsl"

@group(0) @binding(1) var host_depth: texture_multisampled_2d<f32>;

override HAS_DEPTH: bool = true;

@fragment
fn cones_fragment(in: FullscreenVarying) -> @location(0) vec4f {
    let ndc = vec2f(in.uv.x * 2.0 - 1.0, (1.0 - in.uv.y * 2.0) * rain.y_sign);
    var range = RANGE_SKY;
    if HAS_DEPTH {
        range = view_range(rain.depth, textureLoad(host_depth, vec2i(in.position.xy), 0).r, ndc);
    }
    return rain_on_cones(view_ray(rain.depth, ndc).direction, in.uv, range);
}
