// Which way the ground that a pixel shows faces: as the host's image of normals says, else as its terrain lies, else by
// its depth.
//!include "common/facing.wgsl"
//!include "common/guarded.wgsl"
//!include "ground/terrain.wgsl"

// What is known of the surface that a pixel shows.
struct HostSurface {
    // By its depth.
    facing: Facing,
    // Of the class that the host's image has, 0 for none.
    number: u32,
    // Unit normal of the host's image; w is 0 where it has none.
    normal: vec4f,
}

// Root mean square slope of ground that is marked as paved, where nothing says how it lies.
const LEVEL_SLOPE: f32 = 0.05;

// `around`: depths to the left, right, above and below.
fn surface_facing(g: GroundUniform, u: DepthUniform, depth: f32, around: vec4f, ndc: vec2f) -> Facing {
    return facing_of(u, depth, around, ndc, g.pixel, vec2f(g.depth_step, g.depth_ulp));
}

// A normal of the host's image, from its axes and encoding; a cleared texel, of zeros or of ones, is none.
fn given_normal(g: GroundUniform, texel: vec3f) -> vec4f {
    let n = texel * g.normal_x.w + g.normal_y.w;
    let size = length(n);
    let known = size > 0.5 && size < 1.3;
    let local = vec3f(dot(g.normal_x.xyz, n), dot(g.normal_y.xyz, n), dot(g.normal_z.xyz, n));
    return vec4f(local / max(size, 1e-6), select(0.0, 1.0, known));
}

// The normal in the host's words, else its terrain's where the surface lies on it and depth does not say that it is a
// wall.
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

// Ground that is marked as paved is taken for level, give or take LEVEL_SLOPE, so far as `f` does not tell better: the
// mean of two guesses by the inverse squares of their errors, if they agree. `level`: how sure that is.
fn settled_facing(f: Facing, up: vec3f, level: f32) -> Facing {
    let slack = LEVEL_SLOPE + f.error;
    let agrees = 1.0 - smoothstep(slack, 2.0 * slack, length(f.normal - up));
    let e2 = f.error * f.error;
    let share = level * agrees * e2 / (e2 + LEVEL_SLOPE * LEVEL_SLOPE);
    return Facing(normalize(mix(f.normal, up, share)), mix(f.sure, 1.0, share), f.error * (1.0 - share));
}

// What is left of a mirror of this slope where its normal may be off by `error`: all up to half of what its roughness
// hides, nothing from twice as much on.
fn mirror_left(error: f32, slope: f32) -> f32 {
    return 1.0 - smoothstep(0.5 * slope, 2.0 * slope, error);
}
