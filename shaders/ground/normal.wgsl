// Which way the ground that a pixel shows faces.
//!include "common/facing.wgsl"
//!include "ground/uniform.wgsl"

// `around`: depths to the left, right, above and below.
fn surface_facing(g: GroundUniform, u: DepthUniform, depth: f32, around: vec4f, ndc: vec2f) -> Facing {
    return facing_of(u, depth, around, ndc, g.pixel, vec2f(g.depth_step, g.depth_ulp));
}
