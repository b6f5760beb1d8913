// Which way a surface faces, from the depth of a pixel and its four neighbours.
//!include "common/depth.wgsl"

struct Facing {
    // Towards the camera's side.
    normal: vec3f,
    // 0 where depth is too coarse to tell, 1 where the normal can be trusted.
    sure: f32,
    // By which angle the normal may be off, rad; more than 1 where nothing is known.
    error: f32,
}

// Error of a normal of which nothing is known, rad.
const UNKNOWN_FACING: f32 = 10.0;

// A pixel: the depth of the surface that it shows, as view_depth counts it, and its place.
struct Beside {
    depth: f32,
    ndc: vec2f,
}

fn beside(u: DepthUniform, depth: f32, ndc: vec2f) -> Beside {
    // Nothing is known beyond the picture's edge.
    return Beside(select(view_depth(u, depth, ndc), RANGE_SKY, any(abs(ndc) > vec2f(1.0))), ndc);
}

// The edge from the pixel at `at` to whichever neighbour on this axis lies nearer in depth: over a silhouette none is
// taken.
fn surface_edge(u: DepthUniform, here: Beside, at: vec3f, before: Beside, after: Beside) -> vec3f {
    let first = abs(before.depth - here.depth) < abs(after.depth - here.depth);
    let nearer = Beside(select(after.depth, before.depth, first), select(after.ndc, before.ndc, first));
    return (view_point(u, nearer.depth, nearer.ndc) - at) * select(1.0, -1.0, first);
}

// `around`: depths to the left, right, above and below; `pixel`: steps of ndc to the right and below; `grain`: by how
// much the host's depth may be off, as a step and as a part of it.
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
    // How far the host's depth may be off, over the distance to the neighbours: the angle by which the normal is.
    let off = abs(view_depth(u, depth + grain.x + grain.y * abs(depth), ndc) - here.depth) * ray.slant;
    let tilt = off * abs(away) / min(length(edge_x), length(edge_y));
    return Facing(select(n, -n, away > 0.0), 1.0 - smoothstep(0.1, 0.4, tilt), min(tilt, UNKNOWN_FACING));
}
