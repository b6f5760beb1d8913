// Prepares a map of the host for shaders/surroundings/occluders.wgsl: computes for each texel the range of distances
// that its surface spans.
//!include "common/fullscreen.wgsl"
//!include "common/depth.wgsl"

// Steepest slope against the map's plane (85 degrees) at which neighbouring texels count as one surface.
const STEEPEST: f32 = 12.0;
// Range of a texel without a surface: no path crosses this range.
const NOTHING: vec2f = vec2f(1e12, -1e12);

// Camera of a host's map, and the rectangle of the table that the map fills.
struct MapUniform {
    // Rays and depth mapping of the map.
    depth: DepthUniform,
    // Origin of the map in the table, and its size, texels.
    origin: vec2f,
    size: vec2f,
    // 1 if row 0 is the map's top, -1 if it is the bottom.
    y_sign: f32,
}

@group(0) @binding(0) var<uniform> map: MapUniform;
@group(0) @binding(1) var host_map: texture_2d<f32>;

// Returns the distance of a texel's surface from the map's camera, m.
fn distance_at(texel: vec2f) -> f32 {
    let at = clamp(texel, vec2f(0.0), map.size - 1.0);
    let uv = (at + 0.5) / map.size;
    let ndc = vec2f(uv.x * 2.0 - 1.0, (1.0 - uv.y * 2.0) * map.y_sign);
    return view_plane(map.depth, textureLoad(host_map, vec2i(at), 0).r, ndc);
}

// Returns the side length of a texel at a distance, m.
fn texel_side(distance: f32) -> f32 {
    let parallel = vec2f(length(map.depth.origin_dx), length(map.depth.origin_dy));
    let central = vec2f(length(map.depth.direction_dx), length(map.depth.direction_dy)) / map.depth.plane_scale;
    let sides = 2.0 * (parallel + central * distance) / map.size;
    return max(sides.x, sides.y);
}

// Returns the range of distances, m, that the surface of a texel spans, as the bits of two floats.
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
    // The range reaches half-way to the neighbours, and half a texel further, because the map does not show where
    // between two texels the surface bends.
    return bitcast<vec2u>(d + 0.5 * vec2f(low - side, high + side));
}
