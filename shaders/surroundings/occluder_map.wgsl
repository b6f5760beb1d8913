// A map of the host's, made ready for shaders/surroundings/occluders.wgsl: of each texel the range of distances that
// its surface spans.
//!include "common/fullscreen.wgsl"
//!include "common/depth.wgsl"

// Neighbouring texels are one surface where it is not steeper than this against the map's plane (85 degrees).
const STEEPEST: f32 = 12.0;
// A range that nothing meets.
const NOTHING: vec2f = vec2f(1e12, -1e12);

struct MapUniform {
    depth: DepthUniform,
    // The map's place in the table, texels, and its size.
    origin: vec2f,
    size: vec2f,
    // 1 where row 0 is the map's top, -1 where it is the bottom.
    y_sign: f32,
}

@group(0) @binding(0) var<uniform> map: MapUniform;
@group(0) @binding(1) var host_map: texture_2d<f32>;

// Metres from the map's camera.
fn distance_at(texel: vec2f) -> f32 {
    let at = clamp(texel, vec2f(0.0), map.size - 1.0);
    let uv = (at + 0.5) / map.size;
    let ndc = vec2f(uv.x * 2.0 - 1.0, (1.0 - uv.y * 2.0) * map.y_sign);
    return view_plane(map.depth, textureLoad(host_map, vec2i(at), 0).r, ndc);
}

// Side of a texel at a distance, m.
fn texel_side(distance: f32) -> f32 {
    let parallel = vec2f(length(map.depth.origin_dx), length(map.depth.origin_dy));
    let central = vec2f(length(map.depth.direction_dx), length(map.depth.direction_dy)) / map.depth.plane_scale;
    let sides = 2.0 * (parallel + central * distance) / map.size;
    return max(sides.x, sides.y);
}

@fragment
fn occluder_map(in: FullscreenVarying) -> @location(0) vec2u {
    let texel = floor(in.position.xy - map.origin);
    let d = distance_at(texel);
    if d >= RANGE_SKY {
        return bitcast<vec2u>(NOTHING);
    }
    let side = texel_side(d);
    let steps = vec4f(
        distance_at(texel - vec2f(1.0, 0.0)),
        distance_at(texel + vec2f(1.0, 0.0)),
        distance_at(texel - vec2f(0.0, 1.0)),
        distance_at(texel + vec2f(0.0, 1.0)),
    ) - d;
    let joined = select(vec4f(0.0), steps, abs(steps) <= vec4f(STEEPEST * side));
    let low = min(min(joined.x, joined.y), min(min(joined.z, joined.w), 0.0));
    let high = max(max(joined.x, joined.y), max(max(joined.z, joined.w), 0.0));
    // Half-way to its neighbours, and half a texel more for what the picture is too coarse to tell.
    return bitcast<vec2u>(d + 0.5 * vec2f(low - side, high + side));
}
