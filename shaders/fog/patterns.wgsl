// Patches of fog and curtains of rain. The functions read the bound `low_air` and do not take the block as a parameter,
// because indexing a parameter would copy the whole block. The f64 references, with the derivations, are
// src/fog/patterns.rs (patches) and src/fog/curtains.rs (curtains, and the mean of a wave).
//!include "fog/binding.wgsl"

// Half-length of a path along a row of the pattern at which the mean of a wave has fallen to one half (wave_mean), in
// units of the wavelength / (2 pi).
const PATCH_ROW: f32 = 8.0;
// Whether patches flow round obstacles to the wind.
override FOG_DETOUR: bool = false;
// Number of parts into which a ray is cut where it crosses the map of detours.
const DETOUR_PARTS: u32 = 8u;
// Distance at which curtains of rain begin, m.
const CURTAIN_START: f32 = 30.0;

// Returns sin(x) / x.
fn wave_sinc(x: f32) -> f32 {
    let near = abs(x) < 1e-2;
    return select(sin(x) / select(x, 1.0, near), 1.0 - x * x / 6.0, near);
}

// Returns the mean of a wave's cosine along a ray between the distances `middle` - `half` and `middle` + `half`, m.
// Also returns the square of the amplitude of this mean.
fn wave_mean(wave: vec4f, origin: vec3f, direction: vec3f, middle: f32, half: f32) -> vec2f {
    let along = dot(wave.xyz, direction);
    let x = along * half;
    // Rows of the pattern are of finite length: a long ray along one row meets other rows. The mean therefore fades
    // with the length of the ray.
    let size = wave_sinc(x) * PATCH_ROW / (PATCH_ROW + length(wave.xyz) * half);
    return vec2f(cos(wave.w + dot(wave.xyz, origin) + along * middle) * size, size * size);
}

// Returns the lag of the air at a node of the map of detours, m east and north.
fn detour_node(x: u32, y: u32) -> vec2f {
    let node = y * DETOUR_SIDE + x;
    let two = low_air.lags[node / 2u];
    return select(two.zw, two.xy, node % 2u == 0u);
}

// Returns the lag of the air behind the wind at a place relative to the camera, m east and north.
fn detour_lag(place: vec3f) -> vec2f {
    let last = f32(DETOUR_SIDE - 1u);
    let at = clamp(low_air.detour_camera + place.xy * low_air.detour_scale, vec2f(0.0), vec2f(last));
    let low = min(floor(at), vec2f(last - 1.0));
    let part = at - low;
    let node = vec2u(low);
    let south = mix(detour_node(node.x, node.y), detour_node(node.x + 1u, node.y), part.x);
    let north = mix(detour_node(node.x, node.y + 1u), detour_node(node.x + 1u, node.y + 1u), part.x);
    return mix(south, north, part.y) * (1.0 - smoothstep(0.0, 1.0, (place.z - low_air.detour_floor) * low_air.detour_fade));
}

// Returns by how much the lags along a ray change the sum of the means of the patches' waves.
fn detoured(origin: vec3f, direction: vec3f, first: f32, last: f32) -> f32 {
    let at = low_air.detour_camera + origin.xy * low_air.detour_scale;
    let flat_way = direction.xy * low_air.detour_scale;
    let way = select(flat_way, vec2f(1e-9), abs(flat_way) < vec2f(1e-9));
    let a = -at / way;
    let b = (f32(DETOUR_SIDE - 1u) - at) / way;
    let enters = min(a, b);
    let leaves = max(a, b);
    let start = max(max(enters.x, enters.y), first);
    let end = min(min(leaves.x, leaves.y), last);
    if end <= start {
        return 0.0;
    }
    let h = 0.5 * (end - start) / f32(DETOUR_PARTS);
    var lags: array<vec2f, DETOUR_PARTS>;
    for (var n = 0u; n < DETOUR_PARTS; n++) {
        lags[n] = detour_lag(origin + direction * (start + f32(2u * n + 1u) * h));
    }
    var sum = 0.0;
    for (var i = 0u; i < (low_air.fog.waves.x & 7u); i++) {
        let wave = low_air.fog.patch_waves[i];
        let along = dot(wave.xyz, direction);
        let phase = wave.w + dot(wave.xyz, origin) + along * start;
        var part = 0.0;
        for (var n = 0u; n < DETOUR_PARTS; n++) {
            part += cos(phase + along * f32(2u * n + 1u) * h + dot(wave.xy, lags[n]));
        }
        // Subtracts the wave without detours. A wave fades with the length of the whole path from `first` to `last`,
        // not only of its part over the map of detours.
        let half = 0.5 * (end - start);
        let free = cos(phase + along * half) * wave_sinc(along * half) * f32(DETOUR_PARTS);
        sum += (part * wave_sinc(along * h) - free) * PATCH_ROW / (PATCH_ROW + length(wave.xyz) * 0.5 * (last - first));
    }
    return sum * 2.0 * h / (last - first);
}

// Returns the mean of the patches' pattern along a ray between the distances `first` and `last`, m: 1 for an even
// layer. Here and in curtain_mean, the number of waves comes from the block, so that no compiler unrolls the loop. A
// software driver would take longer to compile the sines of an unrolled loop than all the rest of the shader.
fn patch_mean(origin: vec3f, direction: vec3f, first: f32, last: f32) -> f32 {
    let m = 0.5 * (first + last);
    let h = 0.5 * (last - first);
    var sum = 0.0;
    for (var i = 0u; i < (low_air.fog.waves.x & 7u); i++) {
        sum += wave_mean(low_air.fog.patch_waves[i], origin, direction, m, h).x;
    }
    if FOG_DETOUR {
        sum += detoured(origin, direction, first, last);
    }
    return max(1.0 + low_air.fog.patch_amount * 0.5 * sum, 0.0);
}

// Returns the change that curtains make to the optical depth between two distances, relative to the depth of even rain,
// and the variance of this change.
fn curtain_mean(origin: vec3f, direction: vec3f, first: f32, last: f32) -> vec2f {
    let start = max(first, CURTAIN_START);
    let m = 0.5 * (start + last);
    let h = 0.5 * max(last - start, 0.0);
    let part = low_air.fog.curtain_amount * 2.0 * h / max(last - first, 1e-3);
    var sum = vec2f(0.0);
    for (var i = 0u; i < (low_air.fog.waves.y & 15u); i++) {
        sum += wave_mean(low_air.fog.curtain_waves[i], origin, direction, m, h);
    }
    return vec2f(part, 0.5 * part * part) * sum;
}
