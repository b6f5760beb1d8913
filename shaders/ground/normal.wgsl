// Normal of the ground that a pixel shows: from the host's image of normals, else from the host's terrain, else from
// the host's depth.
//!include "common/facing.wgsl"
//!include "common/guarded.wgsl"
//!include "ground/terrain.wgsl"

// Normal and class of the surface that a pixel shows, from the host's depth and images.
struct HostSurface {
    // Normal from the depth.
    facing: Facing,
    // Number of the class in the host's image, 0 for none.
    number: u32,
    // Unit normal in the host's image; w is 0 if the image has none here.
    normal: vec4f,
}

// Root mean square slope that is assumed for paved ground whose slope is unknown.
const LEVEL_SLOPE: f32 = 0.05;

// Returns the normal from depth. `around`: depths to the left, right, above and below.
fn surface_facing(g: GroundUniform, u: DepthUniform, depth: f32, around: vec4f, ndc: vec2f) -> Facing {
    return facing_of(u, depth, around, ndc, g.pixel, vec2f(g.depth_step, g.depth_ulp));
}

// Decodes a normal of the host's image. w is 0 for a cleared texel (all zeros or all ones).
fn given_normal(g: GroundUniform, texel: vec3f) -> vec4f {
    let n = texel * g.normal_x.w + g.normal_y.w;
    let size = length(n);
    let known = size > 0.5 && size < 1.3;
    let local = vec3f(dot(g.normal_x.xyz, n), dot(g.normal_y.xyz, n), dot(g.normal_z.xyz, n));
    return vec4f(local / max(size, 1e-6), select(0.0, 1.0, known));
}

// Returns the normal of the host's image. Without it, returns the terrain's normal where the surface lies on the
// terrain and the depth does not show a wall.
fn known_facing(surface: HostSurface, here: TerrainPoint) -> Facing {
    if surface.normal.w > 0.0 {
        return Facing(surface.normal.xyz, 1.0, 0.0);
    }
    var f = surface.facing;
    if TERRAIN {
        let agrees = smoothstep(0.64, 0.82, dot(f.normal, here.normal));
        let share = here.share * mix(1.0, agrees, f.sure);
        f = Facing(unit_or(mix(f.normal, here.normal, share), here.normal), mix(f.sure, 1.0, share), f.error * (1.0 - share));
    }
    return f;
}

// Returns the normal under the assumption that paved ground is level within LEVEL_SLOPE. If `f` and this assumption
// agree, the result is their mean, weighted by the inverse squares of their errors. `level` is the confidence in the
// assumption.
fn settled_facing(f: Facing, up: vec3f, level: f32) -> Facing {
    let slack = LEVEL_SLOPE + f.error;
    let agrees = 1.0 - smoothstep(slack, 2.0 * slack, length(f.normal - up));
    let e2 = f.error * f.error;
    let share = level * agrees * e2 / (e2 + LEVEL_SLOPE * LEVEL_SLOPE);
    return Facing(normalize(mix(f.normal, up, share)), mix(f.sure, 1.0, share), f.error * (1.0 - share));
}

// Returns the share of a reflection that is kept on a surface of this slope if the surface's normal may be wrong by
// `error`: 1 for errors up to half the slope, 0 for errors from twice the slope on.
fn mirror_left(error: f32, slope: f32) -> f32 {
    return 1.0 - smoothstep(0.5 * slope, 2.0 * slope, error);
}
