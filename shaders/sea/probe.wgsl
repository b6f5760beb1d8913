// Probe of the drawn sea for tests: each pixel probes one place of the sea at rest.
//!include "common/fullscreen.wgsl"
//!include "sea/light.wgsl"

// Places, m from the anchor.
@group(0) @binding(2) var probed_places: texture_2d<f32>;

fn probed_place(position: vec4f) -> vec2f {
    return textureLoad(probed_places, vec2i(position.xy), 0).xy;
}

// Displacement and height of a vertex, m.
@fragment fn shapes(@builtin(position) position: vec4f, @location(0) uv: vec2f) -> @location(0) vec4f {
    let vertex = sea_vertex(probed_place(position), 1.0);
    return vec4f(vertex.shift, vertex.height, 0.0);
}

// Slope that a pixel shows, variance of the slopes that it does not show (the sum over both axes), and compression.
@fragment fn slopes(@builtin(position) position: vec4f, @location(0) uv: vec2f) -> @location(0) vec4f {
    let at = probed_place(position);
    let here = sea_vertex(at, 1.0);
    let shown = sea_slopes_at(at, here.slope, here.squeeze, 1.0);
    return vec4f(shown.slope, shown.left.x + shown.left.z, shown.compression);
}

// Height of the wakes at a place, their slope, and the share of the place under their foam.
@fragment fn wakes(@builtin(position) position: vec4f, @location(0) uv: vec2f) -> @location(0) vec4f {
    let at = probed_place(position);
    let shapes = wakes_at(at, WakeFilter(1e9, vec2f(0.0), vec2f(0.0), 0.0));
    let shown = wakes_at(at, WakeFilter(0.0, vec2f(0.0), vec2f(0.0), 0.0));
    return vec4f(shapes.height, shapes.slope, shown.foam);
}

// Reflectance towards the eye, the share under foam, and the light of the foam as a share of the light of dense foam.
@fragment fn reflectances(@builtin(position) position: vec4f, @location(0) uv: vec2f) -> @location(0) vec4f {
    let at = probed_place(position);
    let here = sea_vertex(at, 1.0);
    let shown = sea_slopes_at(at, here.slope, here.squeeze, 1.0);
    let point = sea_point(at, 0.0);
    let foam = foam_cover(at, shown, here.left, 0.0);
    return vec4f(sea_facing(point, shown).reflected, foam.share, foam.white, 0.0);
}
