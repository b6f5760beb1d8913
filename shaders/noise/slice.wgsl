// Draws one slice of a noise texture. The f64 reference is src/noise/reference.rs.
//!include "common/fullscreen.wgsl"
//!include "noise/lattice.wgsl"

// Number of octaves that the texels can show. This constant is not in the block: a software driver compiles another
// shader for each value of a loop's bound in a block, at every draw.
override OCTAVES: u32 = 1u;

struct Slice {
    // Cells of the first octave along each axis; each further octave has twice as many as the one before.
    frequency: vec3u,
    z: u32,
    // Logarithm to base 2 of the texture's size along each axis.
    size_log2: vec3u,
    pad0: u32,
    gradient_key: u32,
    cellular_key: u32,
    // Amplitude of the first octave, and its ratio from one octave to the next.
    amplitude: f32,
    persistence: f32,
    // Sum of the means of the octaves that are too fine for the texels.
    gradient_rest: f32,
    cellular_rest: f32,
    pad1: u32,
    pad2: u32,
}

@group(0) @binding(0) var<uniform> slice: Slice;

struct Place {
    cell: vec3u,
    at: vec3f,
}

// Position of a texel's middle on a lattice with `period` cells across the texture: (2 i + 1) period / (2 size),
// computed in integers.
fn place_of(texel: vec2f, period: vec3u) -> Place {
    let halves = slice.size_log2 + 1u;
    let parts = (2u * vec3u(vec2u(texel), slice.z) + 1u) * period;
    let one = vec3u(1u) << halves;
    return Place(parts >> halves, vec3f(parts & (one - 1u)) / vec3f(one));
}

fn gradient_sum_plane(texel: vec2f) -> f32 {
    var sum = slice.gradient_rest;
    var amplitude = slice.amplitude;
    for (var octave = 0u; octave < OCTAVES; octave++) {
        let period = slice.frequency << vec3u(octave);
        let place = place_of(texel, period);
        let noise = gradient2(place.cell.xy, place.at.xy, period.xy, scramble(slice.gradient_key + octave));
        sum += amplitude * (0.5 + 0.5 * noise);
        amplitude *= slice.persistence;
    }
    return clamp(sum, 0.0, 1.0);
}

fn gradient_sum_volume(texel: vec2f) -> f32 {
    var sum = slice.gradient_rest;
    var amplitude = slice.amplitude;
    for (var octave = 0u; octave < OCTAVES; octave++) {
        let period = slice.frequency << vec3u(octave);
        let place = place_of(texel, period);
        let noise = gradient3(place.cell, place.at, period, scramble(slice.gradient_key + octave));
        sum += amplitude * (0.5 + 0.5 * noise);
        amplitude *= slice.persistence;
    }
    return clamp(sum, 0.0, 1.0);
}

fn cellular_sum_plane(texel: vec2f) -> f32 {
    var sum = slice.cellular_rest;
    var amplitude = slice.amplitude;
    for (var octave = 0u; octave < OCTAVES; octave++) {
        let period = slice.frequency << vec3u(octave);
        let place = place_of(texel, period);
        sum += amplitude * cellular2(place.cell.xy, place.at.xy, period.xy, scramble(slice.cellular_key + octave));
        amplitude *= slice.persistence;
    }
    return clamp(sum, 0.0, 1.0);
}

fn cellular_sum_volume(texel: vec2f) -> f32 {
    var sum = slice.cellular_rest;
    var amplitude = slice.amplitude;
    for (var octave = 0u; octave < OCTAVES; octave++) {
        let period = slice.frequency << vec3u(octave);
        let place = place_of(texel, period);
        sum += amplitude * cellular3(place.cell, place.at, period, scramble(slice.cellular_key + octave));
        amplitude *= slice.persistence;
    }
    return clamp(sum, 0.0, 1.0);
}

// Gradient noise mapped from [0, 1] to [cellular noise, 1] (Schneider 2015, The Real-time Volumetric Cloudscapes of
// Horizon Zero Dawn).
fn gradient_over_cellular(gradient: f32, cellular: f32) -> f32 {
    return cellular + gradient * (1.0 - cellular);
}

@fragment
fn gradient_plane(in: FullscreenVarying) -> @location(0) vec4f {
    return vec4f(gradient_sum_plane(in.position.xy));
}

@fragment
fn gradient_volume(in: FullscreenVarying) -> @location(0) vec4f {
    return vec4f(gradient_sum_volume(in.position.xy));
}

@fragment
fn cellular_plane(in: FullscreenVarying) -> @location(0) vec4f {
    return vec4f(cellular_sum_plane(in.position.xy));
}

@fragment
fn cellular_volume(in: FullscreenVarying) -> @location(0) vec4f {
    return vec4f(cellular_sum_volume(in.position.xy));
}

@fragment
fn both_plane(in: FullscreenVarying) -> @location(0) vec4f {
    return vec4f(gradient_over_cellular(gradient_sum_plane(in.position.xy), cellular_sum_plane(in.position.xy)));
}

@fragment
fn both_volume(in: FullscreenVarying) -> @location(0) vec4f {
    return vec4f(gradient_over_cellular(gradient_sum_volume(in.position.xy), cellular_sum_volume(in.position.xy)));
}
