// Drops before a host's picture with one sample a pixel.
//!include "rain/splash.wgsl"

@group(0) @binding(1) var host_depth: texture_2d<f32>;

override HAS_DEPTH: bool = true;

fn depth_at(uv: vec2f) -> f32 {
    let size = vec2f(textureDimensions(host_depth));
    return textureLoad(host_depth, vec2i(clamp(uv * size, vec2f(0.0), size - 1.0)), 0).r;
}

// The visible surface below a landing, sought from a height on; 1 if it was found.
fn ground_below(landing: Landing, z: f32) -> vec4f {
    var search = search_from(landing, z);
    var surface = vec4f(0.0);
    for (var i = 0u; i < LOOKS && surface.w == 0.0 && search.low < search.high; i++) {
        let p = vec3f(landing.xy, search.z);
        let ndc = seen_at(p).xy;
        let seen = surface_of(ndc, depth_at(uv_of(ndc)));
        surface = vec4f(seen, select(0.0, 1.0, is_found(landing, seen)));
        search = closer(search, gap_of(p, ndc, seen));
    }
    return surface;
}

// The normal of a visible surface, and the height of its plane above the place of a landing.
fn plane_below(landing: Landing, surface: vec3f) -> vec4f {
    let size = vec2f(textureDimensions(host_depth));
    let uv = (floor(uv_of(seen_at(surface).xy) * size) + 0.5) / size;
    let ndc = vec2f(uv.x * 2.0 - 1.0, (1.0 - uv.y * 2.0) * rain.y_sign);
    let x = vec2f(1.0 / size.x, 0.0);
    let y = vec2f(0.0, 1.0 / size.y);
    let depth = depth_at(uv);
    let around = vec4f(depth_at(uv - x), depth_at(uv + x), depth_at(uv - y), depth_at(uv + y));
    let facing = facing_of(rain.depth, depth, around, ndc, vec2f(2.0, -2.0 * rain.y_sign) / size, splash.depth_grain);
    let normal = normalize(mix(vec3f(0.0, 0.0, 1.0), facing.normal, facing.sure) + vec3f(0.0, 0.0, 1e-6));
    let middle = surface_of(ndc, depth);
    let rise = dot(normal.xy, middle.xy - landing.xy) / max(normal.z, STEEPEST);
    return vec4f(normal, middle.z + rise);
}

// The crown of a slot.
fn splashed(slot: u32) -> Crown {
    let arrival = arrival_of(slot);
    let surface = ground_below(arrival.landing, splash.ground);
    if surface.w == 0.0 {
        return Crown();
    }
    let plane = plane_below(arrival.landing, surface.xyz);
    return crown_of(arrival, plane.w, plane.xyz);
}

// Every slot, where there are no compute shaders.
@vertex
fn splash_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) slot: u32) -> CrownVarying {
    return crown_corner(splashed(slot), corner, slot);
}

// Range of the host's picture at a pixel.
fn range_at(position: vec4f) -> f32 {
    if !HAS_DEPTH {
        return RANGE_SKY;
    }
    let uv = position.xy / vec2f(textureDimensions(host_depth));
    let ndc = vec2f(uv.x * 2.0 - 1.0, (1.0 - uv.y * 2.0) * rain.y_sign);
    return view_range(rain.depth, depth_at(uv), ndc);
}

@fragment
fn rain_fragment(in: RainVarying) -> @location(0) vec4f {
    return streak(in, range_at(in.position));
}

@fragment
fn crown_fragment(in: CrownVarying) -> @location(0) vec4f {
    let pixel = fwidth(in.at.y);
    return crown_color(in, range_at(in.position), pixel);
}
