// Drops before a host's picture with several samples a pixel: its first stands for them.
//!include "rain/splash.wgsl"

@group(0) @binding(1) var host_depth: texture_multisampled_2d<f32>;

override HAS_DEPTH: bool = true;

fn depth_at(uv: vec2f) -> f32 {
    let size = vec2f(textureDimensions(host_depth));
    return textureLoad(host_depth, vec2i(min(uv * size, size - 1.0)), 0).r;
}

// The crown of a slot.
fn splashed(slot: u32) -> Crown {
    let landing = landing_of(slot);
    var z = splash.ground;
    var surface = vec3f(0.0);
    for (var i = 0u; i < SEARCH; i++) {
        let seen = seen_at(vec3f(landing.xy, z));
        if landing.fade <= 0.0 || seen.z == 0.0 {
            return Crown();
        }
        surface = surface_of(seen.xy, depth_at(uv_of(seen.xy)));
        z = surface.z;
    }
    if !is_found(landing, surface) {
        return Crown();
    }
    return crown_of(landing, z);
}

// Every slot, where there are no compute shaders.
@vertex
fn splash_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) slot: u32) -> RainVarying {
    return crown_corner(splashed(slot), corner);
}

@fragment
fn rain_fragment(in: RainVarying) -> @location(0) vec4f {
    var range = RANGE_SKY;
    if HAS_DEPTH {
        let uv = in.position.xy / vec2f(textureDimensions(host_depth));
        let ndc = vec2f(uv.x * 2.0 - 1.0, (1.0 - uv.y * 2.0) * rain.y_sign);
        range = view_range(rain.depth, depth_at(uv), ndc);
    }
    return streak(in, range);
}
