// Normal of a surface, from the depths of a pixel and its four neighbours.
//!include "common/depth.wgsl"

// Normal of a surface, and how far it can be trusted.
struct Facing {
    // Normal on the side of the camera.
    normal: vec3f,
    // 0 where depth is too coarse for a normal, 1 where the normal can be trusted.
    sure: f32,
    // Angle by which the normal may be wrong, rad; more than 1 where nothing is known.
    error: f32,
}

// Error of an unknown normal, rad.
const UNKNOWN_FACING: f32 = 10.0;

// Pixel: depth of its surface in the unit of view_depth, and position in ndc.
struct Beside {
    depth: f32,
    ndc: vec2f,
}

// Neighbour of a pixel, from its depth sample and position.
fn beside(u: DepthUniform, depth: f32, ndc: vec2f) -> Beside {
    // Beyond the picture's edge nothing is known.
    return Beside(select(view_depth(u, depth, ndc), RANGE_SKY, any(abs(ndc) > vec2f(1.0))), ndc);
}

// Vector from the pixel at `at` to the neighbour on this axis whose depth differs less, so that it does not cross a
// silhouette.
fn surface_edge(u: DepthUniform, here: Beside, at: vec3f, before: Beside, after: Beside) -> vec3f {
    let first = abs(before.depth - here.depth) < abs(after.depth - here.depth);
    let nearer = Beside(select(after.depth, before.depth, first), select(after.ndc, before.ndc, first));
    return (view_point(u, nearer.depth, nearer.ndc) - at) * select(1.0, -1.0, first);
}

// Normal at a pixel. `around`: depths to the left, right, above and below. `pixel`: steps of ndc to the right and down.
// `grain`: possible error of the host's depth, as an absolute value and as a fraction of the depth.
fn facing_of(u: DepthUniform, depth: f32, around: vec4f, ndc: vec2f, pixel: vec2f, grain: vec2f) -> Facing {
    let here = beside(u, depth, ndc);
    let at = view_point(u, here.depth, here.ndc);
    let x = vec2f(pixel.x, 0.0);
    let y = vec2f(0.0, pixel.y);
    let edge_x = surface_edge(u, here, at, beside(u, around.x, ndc - x), beside(u, around.y, ndc + x));
    let edge_y = surface_edge(u, here, at, beside(u, around.z, ndc - y), beside(u, around.w, ndc + y));
    let ray = view_ray(u, ndc);
    let across = cross(edge_x, edge_y);
    let area = length(across);
    if !(area > 0.0) || max(length(edge_x), length(edge_y)) > 1e9 {
        return Facing(-ray.direction, 0.0, UNKNOWN_FACING);
    }
    let n = across / area;
    let away = dot(n, ray.direction);
    // Angular error of the normal: the error of the host's depth, divided by the distance to the neighbours.
    let off = abs(view_depth(u, depth + grain.x + grain.y * abs(depth), ndc) - here.depth) * ray.slant;
    let tilt = off * abs(away) / min(length(edge_x), length(edge_y));
    return Facing(select(n, -n, away > 0.0), 1.0 - smoothstep(0.1, 0.4, tilt), min(tilt, UNKNOWN_FACING));
}
