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

struct DepthPoint {
    at: vec3f,
    depth: f32,
}

fn depth_point(u: DepthUniform, depth: f32, ndc: vec2f) -> DepthPoint {
    let ray = view_ray(u, ndc);
    // Nothing is known beyond the picture's edge.
    let w = select(view_depth(u, depth, ndc), RANGE_SKY, any(abs(ndc) > vec2f(1.0)));
    return DepthPoint(ray.origin + ray.direction * (w * ray.slant), w);
}

// The edge from the pixel to whichever neighbour on this axis lies nearer in depth: over a silhouette none is taken.
fn surface_edge(here: DepthPoint, before: DepthPoint, after: DepthPoint) -> vec3f {
    let first = abs(before.depth - here.depth) < abs(after.depth - here.depth);
    return select(after.at - here.at, here.at - before.at, first);
}

// `around`: depths to the left, right, above and below; `pixel`: steps of ndc to the right and below; `grain`: by how much the
// host's depth may be off, as a step and as a part of it.
fn facing_of(u: DepthUniform, depth: f32, around: vec4f, ndc: vec2f, pixel: vec2f, grain: vec2f) -> Facing {
    let here = depth_point(u, depth, ndc);
    let x = vec2f(pixel.x, 0.0);
    let y = vec2f(0.0, pixel.y);
    let edge_x = surface_edge(here, depth_point(u, around.x, ndc - x), depth_point(u, around.y, ndc + x));
    let edge_y = surface_edge(here, depth_point(u, around.z, ndc - y), depth_point(u, around.w, ndc + y));
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
