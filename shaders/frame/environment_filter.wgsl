// Filter of the cube map's rougher levels: the reflection in a rough mirror seen along its normal (Karis 2013, Real
// Shading in Unreal Engine 4, eq. 7 and "PrefilterEnvMap"). Each sample reads the level whose texels are as large as
// the sample's part of the sphere (Krivanek and Colbert 2008, Real-time Shading with Filtered Importance Sampling, eq.
// 13).
//!include "common/fullscreen.wgsl"

// One face of a level, and how it is filtered.
struct FilterFace {
    // As in EnvironmentFace, but in the cube's own axes.
    forward: vec3f,
    // Square of the roughness: alpha of the distribution of Trowbridge and Reitz (GGX). 0 halves a level instead: each
    // texel is the mean of four.
    alpha: f32,
    right: vec3f,
    // Number of sample directions.
    samples: f32,
    down: vec3f,
    pad1: f32,
}

const PI: f32 = 3.14159265;
// Edge of a face of level 0, texels.
const FACE: f32 = 64.0;
// Coarsest level of the source.
const COARSEST: f32 = 4.0;

@group(0) @binding(0) var<uniform> face: FilterFace;
@group(0) @binding(1) var source: texture_cube<f32>;
@group(0) @binding(2) var source_sampler: sampler;

@fragment
fn environment_filter(in: FullscreenVarying) -> @location(0) vec4f {
    let at = in.uv * 2.0 - 1.0;
    let n = normalize(face.forward + at.x * face.right + at.y * face.down);
    if face.alpha == 0.0 {
        return textureSampleLevel(source, source_sampler, n, 0.0);
    }
    let side = normalize(cross(select(vec3f(0.0, 0.0, 1.0), vec3f(1.0, 0.0, 0.0), abs(n.z) > 0.9), n));
    let other = cross(n, side);
    let a2 = face.alpha * face.alpha;
    var sum = vec3f(0.0);
    var weight = 0.0;
    for (var i = 0u; i < (u32(face.samples) & 1023u); i++) {
        let x = (f32(i) + 0.5) / face.samples;
        // Lattice of points by the golden ratio.
        let turn = 2.0 * PI * fract(f32(i) * 0.61803399);
        // Normal h of a facet: cos^2 = (1 - x) / (1 + (a^2 - 1) x).
        let cos2 = (1.0 - x) / (1.0 + (a2 - 1.0) * x);
        let c = sqrt(cos2);
        let s = sqrt(1.0 - cos2);
        let h = side * (s * cos(turn)) + other * (s * sin(turn)) + n * c;
        let l = 2.0 * c * h - n;
        let facing = dot(n, l);
        if facing > 0.0 {
            // Probability density of l, D (n h) / (4 (v h)) with v = n; then the sample's part of the sphere in texels
            // of level 0.
            let d = cos2 * (a2 - 1.0) + 1.0;
            let density = a2 / (4.0 * PI * d * d);
            let texels = 6.0 * FACE * FACE / (4.0 * PI * face.samples * density);
            let level = clamp(0.5 * log2(texels), 0.0, COARSEST);
            sum += textureSampleLevel(source, source_sampler, l, level).rgb * facing;
            weight += facing;
        }
    }
    return vec4f(sum / max(weight, 1e-6), 1.0);
}
