// Entry points of drops and splashes in front of a host's picture. Of several samples a pixel, only the first is read.
//!include "common/host.wgsl"
//!include "rain/splash.wgsl"

@group(0) @binding(1) var host_depth: HostDepth;

// Whether the host gives the depth of its picture.
override HAS_DEPTH: bool = true;

// Returns the host's depth in the texel at `uv`.
fn depth_at(uv: vec2f) -> f32 {
    let size = vec2f(textureDimensions(host_depth));
    return textureLoad(host_depth, vec2i(clamp(uv * size, vec2f(0.0), size - 1.0)), 0).r;
}

// Returns the visible surface below a landing, searched for from the height `z`; w is 1 if it was found.
fn ground_below(landing: Landing, z: f32) -> vec4f {
    var look = Look(search_from(landing, z), vec4f(0.0));
    for (var i = 0u; i < LOOKS && is_wanted(look); i++) {
        let ndc = next_look(look, landing);
        look = looked(look, landing, ndc, depth_at(uv_of(ndc)));
    }
    return look.surface;
}

// Returns the splash (crown) of the drop that lands in a slot, one of the fixed places of splash.wgsl in which drops
// land one after another. It is empty if no surface is seen there.
fn splashed(slot: u32) -> Crown {
    let arrival = arrival_of(slot);
    let surface = ground_below(arrival.landing, splash.ground);
    if surface.w == 0.0 {
        return Crown();
    }
    let size = vec2f(textureDimensions(host_depth));
    let uv = pixel_of(surface.xyz, size);
    let x = vec2f(1.0 / size.x, 0.0);
    let y = vec2f(0.0, 1.0 / size.y);
    let around = vec4f(depth_at(uv - x), depth_at(uv + x), depth_at(uv - y), depth_at(uv + y));
    let plane = plane_of(arrival.landing, uv, size, depth_at(uv), around);
    return crown_of(arrival, plane.w, plane.xyz);
}

// Draws every slot, on devices without compute shaders.
@vertex
fn splash_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) slot: u32) -> CrownVarying {
    return crown_corner(splashed(slot), corner);
}

// Returns the depth of the host's picture at a pixel, in the measure of view_depth.
fn shown_at(position: vec4f) -> f32 {
    if HAS_DEPTH {
        let ndc = ndc_of(position.xy / vec2f(textureDimensions(host_depth)));
        return view_depth(rain.depth, textureLoad(host_depth, vec2i(position.xy), 0).r, ndc);
    }
    return RANGE_SKY;
}

// Returns the premultiplied light of a pixel of a streak.
@fragment
fn rain_fragment(in: RainVarying) -> @location(0) vec4f {
    return streak(in, shown_at(in.position));
}

// Returns the premultiplied light of a pixel of a crown.
@fragment
fn crown_fragment(in: CrownVarying) -> @location(0) vec4f {
    return crown_color(in, shown_at(in.position), fwidth(in.at.y));
}
