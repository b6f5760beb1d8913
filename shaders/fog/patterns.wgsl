// Patches of fog and curtains of rain, of the bound `fog`: an index into a copy of it would copy all of it. The f64 twin and the
// derivation are in src/fog/patterns.rs.
//!include "fog/binding.wgsl"

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

// Both sums are loops whose ends no compiler knows: written out, their sines take a software driver longer to compile than all the
// rest of a pixel.
fn patch_mean(origin: vec3f, direction: vec3f, first: f32, last: f32) -> f32 {
    let m = 0.5 * (first + last);
    let h = 0.5 * (last - first);
    var sum = 0.0;
    for (var i = 0u; i < fog.waves.x; i++) {
        sum += wave_mean(fog.patch_waves[i], origin, direction, m, h).x;
    }
    return max(1.0 + fog.patch_amount * 0.5 * sum, 0.0);
}

// What curtains add between two distances, over what an even layer has there, and the variance of that.
fn curtain_mean(origin: vec3f, direction: vec3f, first: f32, last: f32) -> vec2f {
    let start = max(first, CURTAIN_START);
    let m = 0.5 * (start + last);
    let h = 0.5 * max(last - start, 0.0);
    let part = fog.curtain_amount * 2.0 * h / max(last - first, 1e-3);
    var sum = vec2f(0.0);
    for (var i = 0u; i < fog.waves.y; i++) {
        sum += wave_mean(fog.curtain_waves[i], origin, direction, m, h);
    }
    return vec2f(part, 0.5 * part * part) * sum;
}
