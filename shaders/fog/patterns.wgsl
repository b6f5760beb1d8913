// Patches of fog and curtains of rain: the f64 twin and the derivation are in src/fog/patterns.rs.
//!include "fog/uniform.wgsl"

// Half of a path on which a wave of the pattern fades to a half, in its length / 2 pi.
const PATCH_ROW: f32 = 8.0;
// Distance at which curtains of rain begin, m.
const CURTAIN_START: f32 = 30.0;

// Mean of a wave along a ray, and the square of how large it may be there.
fn wave_mean(wave: vec4f, origin: vec3f, direction: vec3f, middle: f32, half: f32) -> vec2f {
    let along = dot(wave.xyz, direction);
    let x = along * half;
    let near = abs(x) < 1e-2;
    let sinc = select(sin(x) / select(x, 1.0, near), 1.0 - x * x / 6.0, near);
    // No row goes on for ever: a ray along one meets others after some.
    let size = sinc * PATCH_ROW / (PATCH_ROW + length(wave.xyz) * half);
    return vec2f(cos(wave.w + dot(wave.xyz, origin) + along * middle) * size, size * size);
}

// Written out: an index that the compiler does not know would copy the whole uniform.
fn patch_mean(u: FogUniform, origin: vec3f, direction: vec3f, first: f32, last: f32) -> f32 {
    let m = 0.5 * (first + last);
    let h = 0.5 * (last - first);
    let sum = wave_mean(u.patch_waves[0], origin, direction, m, h)
        + wave_mean(u.patch_waves[1], origin, direction, m, h)
        + wave_mean(u.patch_waves[2], origin, direction, m, h)
        + wave_mean(u.patch_waves[3], origin, direction, m, h)
        + wave_mean(u.patch_waves[4], origin, direction, m, h)
        + wave_mean(u.patch_waves[5], origin, direction, m, h);
    return max(1.0 + u.patch_amount * 0.5 * sum.x, 0.0);
}

// What curtains add between two distances, over what an even layer has there, and the variance of that.
fn curtain_mean(u: FogUniform, origin: vec3f, direction: vec3f, first: f32, last: f32) -> vec2f {
    let start = max(first, CURTAIN_START);
    let m = 0.5 * (start + last);
    let h = 0.5 * max(last - start, 0.0);
    let part = u.curtain_amount * 2.0 * h / max(last - first, 1e-3);
    let sum = wave_mean(u.curtain_waves[0], origin, direction, m, h)
        + wave_mean(u.curtain_waves[1], origin, direction, m, h)
        + wave_mean(u.curtain_waves[2], origin, direction, m, h)
        + wave_mean(u.curtain_waves[3], origin, direction, m, h)
        + wave_mean(u.curtain_waves[4], origin, direction, m, h)
        + wave_mean(u.curtain_waves[5], origin, direction, m, h)
        + wave_mean(u.curtain_waves[6], origin, direction, m, h)
        + wave_mean(u.curtain_waves[7], origin, direction, m, h);
    return vec2f(part, 0.5 * part * part) * sum;
}
